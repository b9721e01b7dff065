'use strict'
const { PlcError } = require('../error')
const { PRIORITY } = require('../line')

/**
 * Polling of a group of items, by the monotonic clock: no drift, no pile-up. A cycle that still runs when the next is due
 * is counted as an overrun, and that next one is left out.
 */

const LEAST = 10
const MOST = 86400000
const EARLY = 2 // ms: timers of Node.js may fire a little before their time, which must not count as a cycle of its own
const MOST_JITTER = 100 // ms: many groups that start together do not stay together

/** The failure of a whole cycle: every item is bad, for one reason. */
const failureOf = results => {
  const [first] = results
  if (!first || !results.every(({ quality, code }) => quality === 'bad' && code === first.code)) return null
  return { code: first.code, text: first.text }
}

const stateOf = results => results.map(({ code = '' }) => code).join()

/** @returns {number} ms */
const readInterval = value => {
  const interval = typeof value === 'string' ? Number(value) : value
  if (Number.isFinite(interval) && interval >= LEAST && interval <= MOST) return interval
  throw new PlcError('BAD_SETTING', { setting: 'interval', value, reason: `${LEAST} to ${MOST} ms are possible` })
}

class Subscription {
  #plc
  #clock
  #callback
  #items
  #interval
  #timer = null
  #first = 0
  #running = false
  #stopped = false
  #state = ''
  #failed = false
  #again = false
  #overruns = 0

  /**
   * @param {object} options
   * @param {{ read: (items: any[], options: { priority: number }) => Promise<any[]> }} options.plc
   * @param {any} options.clock
   * @param {() => number} options.random
   * @param {any[]} options.items
   * @param {unknown} options.interval ms, 10 to a day
   * @param {boolean} [options.immediately] the first cycle at once (default), or after one interval
   * @param {(results: any[], cycle: Cycle) => void} options.callback
   * @throws {PlcError} BAD_SETTING
   */
  constructor({ plc, clock, random, items, interval, immediately = true, callback }) {
    this.#plc = plc
    this.#clock = clock
    this.#callback = callback
    this.#items = items
    this.#interval = readInterval(interval)
    const wait = immediately ? random() * Math.min(MOST_JITTER, this.#interval / 10) : this.#interval
    this.#first = clock.now() + wait
    this.#timer = clock.setTimer(() => this.#tick(), wait)
  }

  /** Cycles that were left out because the one before still ran. */
  get overruns() {
    return this.#overruns
  }

  get items() {
    return this.#items
  }

  /** Other items from the next cycle on. @param {any[]} items */
  setItems(items) {
    this.#items = items
    this.#state = ''
  }

  /** No callback comes any more. */
  stop() {
    this.#stopped = true
    this.#clock.clearTimer(this.#timer)
  }

  /** The station may answer again: what failed is asked for at once, and not after what may be a long interval. */
  again() {
    if (this.#stopped) return
    this.#again = this.#running
    if (!this.#running && this.#failed) this.#cycle()
  }

  #tick() {
    // from the first one on, so that no delay adds up; after a stall the missed ones are left out
    const done = Math.floor((this.#clock.now() - this.#first + EARLY) / this.#interval)
    const next = this.#first + (done + 1) * this.#interval
    this.#timer = this.#clock.setTimer(() => this.#tick(), Math.max(0, next - this.#clock.now()))
    if (this.#running) this.#overruns++
    else this.#cycle()
  }

  #cycle() {
    const start = this.#clock.now()
    this.#running = true
    this.#plc.read(this.#items, { priority: PRIORITY.POLL }).then(
      results => this.#report(results, start),
      error => this.#report([], start, error)
    )
  }

  /** @param {any[]} results @param {number} start @param {any} [error] */
  #report(results, start, error = null) {
    this.#running = false
    if (this.#stopped) return
    const failure = error ?? failureOf(results)
    const state = error ? error.code : stateOf(results)
    const changed = state !== this.#state
    this.#state = state
    this.#failed = failure !== null
    const again = this.#again && this.#failed
    this.#again = false
    this.#callback(results, { failure, changed, ms: this.#clock.now() - start, overruns: this.#overruns })
    if (again && !this.#stopped) this.#cycle()
  }
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
