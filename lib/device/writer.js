'use strict'
const { PlcError } = require('../error')
const { encodeValue } = require('../tag/value')
const { createAudit } = require('./audit')
const { Delivery } = require('./delivery')
const { createGuard } = require('./guard')
const { Intervals, writtenOf } = require('./interval')
const { unsent } = require('./outcome')
const { MOST_POINTS, widthOf, writePointsOf } = require('./points')

/**
 * Writes: guarded before anything is sent, in as few frames as possible, each one told to those who listen to the line.
 *
 * @typedef {object} Prepared
 * @property {any[]} entries `{ item, value, from, to }`
 * @property {any[]} points `{ kind, address, values, text }`
 * @property {any[]} requests of the plan
 * @property {(import('./step').Step & { index: number })[]} steps whose size is checked; `index`: of the point
 */

const MOST_ENTRIES = 1000

const checkEntries = entries => {
  if (!Array.isArray(entries) || entries.length === 0) {
    throw new PlcError('NOTHING_TO_WRITE', { reason: 'there is no entry' })
  }
  if (entries.length > MOST_ENTRIES) {
    throw new PlcError('TOO_MANY', { count: entries.length, unit: 'values to write', most: MOST_ENTRIES })
  }
}

const checkPoints = entries => {
  const count = entries.reduce((sum, { item, values }) => sum + values.length * (item.packed ? widthOf(item) : 1), 0)
  if (count > MOST_POINTS) throw new PlcError('TOO_MANY', { count, unit: 'values to write', most: MOST_POINTS })
}

/** What was asked for, as far as it can be told. */
const given = entries => {
  try {
    return entries.slice(0, MOST_ENTRIES).map(({ item, value }) => ({ item: nameOf(item), value }))
  } catch {
    return []
  }
}

/** Only what cannot fail when it becomes text. */
const nameOf = item => (['object', 'function', 'symbol'].includes(typeof item) ? `(${typeof item})` : item)

class Writer {
  #clock
  #settings
  #parse
  #guard
  #audit
  #delivery

  /** @param {{ talk: any, reader: any, line: any, clock: any, settings: any, parse: (text: any) => any }} options */
  constructor({ talk, reader, line, clock, settings, parse }) {
    const { name, station, writeInterval } = settings
    this.#clock = clock
    this.#settings = settings
    this.#parse = parse
    this.#guard = createGuard(settings)
    this.#audit = createAudit({ line, device: name, station })
    const intervals = new Intervals({ written: writtenOf(line.memory(station)), interval: writeInterval, clock })
    this.#delivery = new Delivery({ talk, reader, clock, settings, intervals })
  }

  /** @param {import('../tag/item').Item} item @param {{ fixed?: boolean }} options @throws {PlcError} READ_ONLY, NOT_WRITABLE */
  checkTarget(item, options) {
    this.#guard.checkItem(item, options)
  }

  /**
   * @param {{ item: string, value: any, fixed?: boolean }[]} entries
   * @param {{ fixed?: boolean, verify?: boolean, coalesce?: boolean, by?: import('./audit').By }} options
   * @returns {Promise<import('./outcome').Outcome>} never rejects
   */
  async write(entries, { by, ...options }) {
    const start = this.#clock.now()
    const since = this.#clock.wall()
    const { error, ...outcome } = await this.#outcome(entries, options)
    const whole = { ...outcome, ms: this.#clock.now() - start }
    this.#audit.write(whole, { since, by, error })
    return whole
  }

  /**
   * @param {{ item: any, value: any }[]} entries
   * @param {any} why
   * @param {{ by?: import('./audit').By }} options
   * @returns {import('./outcome').Outcome}
   */
  refused(entries, why, { by }) {
    const { item, value } = why?.details ?? {}
    // of a message that cannot be read the error may know what it was about
    const known = entries.length === 0 && item !== undefined ? [{ item, value }] : given(entries)
    const { error, ...outcome } = unsent(why, known)
    this.#audit.write(outcome, { since: this.#clock.wall(), by, error })
    return outcome
  }

  #outcome(entries, options) {
    try {
      const prepared = this.#prepare(entries, options)
      this.#settings.checkWrite?.(prepared, options)
      if (!options.coalesce) this.#delivery.checkInterval(prepared.points)
      return this.#delivery.write(prepared, options)
    } catch (error) {
      return unsent(error, given(entries))
    }
  }

  /** @returns {Prepared} @throws {PlcError} whatever forbids the write */
  #prepare(entries, { fixed }) {
    checkEntries(entries)
    const parsed = entries.map(entry => this.#entry(entry, fixed))
    const points = []
    const steps = []
    checkPoints(parsed)
    for (const entry of parsed) {
      entry.from = points.length
      points.push(...writePointsOf(entry))
      entry.to = points.length
      steps.push(...entry.steps.map(({ at, ...step }) => ({ ...step, index: entry.from + at })))
    }
    return { entries: parsed, points, steps, requests: this.#settings.plan.writes(points) }
  }

  #entry(entry, fixed) {
    if (entry === null || typeof entry !== 'object')
      throw new PlcError('NOTHING_TO_WRITE', { reason: 'an entry has no item' })
    const item = this.#parse(entry.item)
    // the flow's author may fix single targets of a message, too
    this.#guard.checkItem(item, { fixed: fixed || entry.fixed === true })
    const values = encodeValue(item, entry.value)
    const steps = this.#guard.checkValues(item, values)
    return { item, value: entry.value, values, steps, from: 0, to: 0 }
  }

  /** What waits for the write interval fails. */
  close() {
    this.#delivery.close()
  }
}

module.exports = { Writer }
