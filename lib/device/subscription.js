'use strict'
const { PlcError } = require('../error')
const { pointsOf, resultsOf } = require('./points')

const LEAST = 10
const MOST = 86400000

/** The failure of a whole cycle: every item is bad, for one reason. */
const failureOf = results => {
  const first = results[0]
  if (first?.quality !== 'bad' || !results.every(({ quality, code }) => quality === 'bad' && code === first.code))
    return null
  return { code: first.code, text: first.text }
}

/** What is bad, and why; equal if that is so. Where nothing is, a number, which is compared at once. @returns {string | number} */
const stateOf = results => {
  for (const { code } of results) if (code) return results.map(each => each.code ?? '').join()
  return results.length > 1 ? results.length : ''
}

/** @returns {number} ms */
const readInterval = value => {
  const interval = typeof value === 'string' ? Number(value) : value
  if (Number.isFinite(interval) && interval >= LEAST && interval <= MOST) return interval
  throw new PlcError('BAD_SETTING', { setting: 'interval', value, reason: `${LEAST} to ${MOST} ms are possible` })
}

/** A group of items that is polled, and who hears of it. When, the poller decides. */
class Subscription {
  #clock
  #callback
  #items
  /** Those of the cycle that runs. */
  #asked
  /** @type {string | number} */
  #state = ''
  #start = 0
  #again = false
  running = false
  /** ms that the last cycle took */
  took = 0
  stopped = false
  /** Whether the last cycle failed as a whole. */
  failed = false
  /** Cycles that were left out because the one before still ran, or the process stood still. */
  overruns = 0

  /**
   * @param {object} options
   * @param {any} options.clock
   * @param {import('../tag/item').Item[]} options.items
   * @param {unknown} options.interval ms, 10 to a day
   * @param {(results: any[], cycle: Cycle) => void} options.callback
   * @param {string} [options.name] of who asks, for who looks on
   * @throws {PlcError} BAD_SETTING
   */
  constructor({ clock, items, interval, callback, name = '' }) {
    this.name = name
    this.#clock = clock
    this.#callback = callback
    this.#items = items
    this.#asked = items
    this.interval = readInterval(interval)
    this.points = pointsOf(items)
  }

  /** Other items from the next cycle on. @param {import('../tag/item').Item[]} items */
  setItems(items) {
    this.#items = items
    this.points = pointsOf(items)
    this.#state = ''
  }

  /** The station may answer again. @returns {boolean} whether it is to be asked at once, and not after what may be a long interval */
  again() {
    this.#again = this.running
    return !this.running && this.failed
  }

  /** @param {number} cycles that were left out */
  missed(cycles) {
    this.overruns += cycles
  }

  begin() {
    this.running = true
    this.#start = this.#clock.now()
    this.#asked = this.#items
  }

  /** @param {any[]} readings one per point of the items that were asked for */
  end(readings) {
    this.#report(resultsOf(this.#asked, readings), null)
  }

  /** @param {any} error nothing was read */
  fail(error) {
    this.#report([], error)
  }

  #report(results, error) {
    this.running = false
    this.took = this.#clock.now() - this.#start
    if (this.stopped) return
    const failure = error ?? failureOf(results)
    const state = error ? error.code : stateOf(results)
    const changed = state !== this.#state
    this.#state = state
    this.failed = failure !== null
    const again = this.#again && this.failed
    this.#again = false
    this.#callback(results, { failure, changed, ms: this.took, overruns: this.overruns })
    if (again && !this.stopped) this.repeat(this)
  }

  /** Set by its owner: asks for another cycle at once. @type {(own: Subscription) => void} */
  repeat = () => {}
}

/**
 * @typedef {object} Cycle
 * @property {{ code: string, text?: string, message?: string } | null} failure all items are bad for this one reason
 * @property {boolean} changed other items are bad, or for other reasons, than in the cycle before (an error is worth a report
 *   only then)
 * @property {number} ms that the cycle took
 * @property {number} overruns so far
 */

module.exports = { Subscription }
