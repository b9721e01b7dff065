'use strict'
const { PlcError, isRefusal } = require('../error')
const { PRIORITY } = require('../line')
const { encodeValue } = require('../tag/value')
const { createGuard } = require('./guard')
const { outcomeOf, unsent, wordFor } = require('./outcome')
const { asPlcError } = require('./failure')
const { MOST_POINTS, widthOf, writePointsOf } = require('./points')
const { verifyWritten } = require('./verify')

/**
 * Writes: guarded before anything is sent, in as few frames as possible, never repeated. The first frame that is not
 * confirmed ends the write.
 *
 * @typedef {object} Prepared
 * @property {any[]} entries `{ item, value, from, to }`
 * @property {any[]} points `{ kind, address, values, text }`
 * @property {any[]} requests of the plan
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

/** A broadcast is never confirmed: what comes after it goes out all the same. */
const goesOn = error => !error || error.code === 'BROADCAST_UNCONFIRMED'

class Writer {
  #talk
  #reader
  #clock
  #settings
  #parse
  #guard
  /** Writes of the latest value that still wait for their turn: key -> job. */
  #waiting = new Map()

  /** @param {{ talk: any, reader: any, clock: any, settings: any, parse: (text: any) => any }} options */
  constructor({ talk, reader, clock, settings, parse }) {
    this.#talk = talk
    this.#reader = reader
    this.#clock = clock
    this.#settings = settings
    this.#parse = parse
    this.#guard = createGuard(settings)
  }

  /** @param {import('../tag/item').Item} item @param {{ fixed?: boolean }} options @throws {PlcError} READ_ONLY, NOT_WRITABLE */
  checkTarget(item, options) {
    this.#guard.checkItem(item, options)
  }

  /**
   * @param {{ item: string, value: any, fixed?: boolean }[]} entries
   * @param {{ fixed?: boolean, verify?: boolean, coalesce?: boolean }} options
   * @returns {Promise<import('./outcome').Outcome>} never rejects
   */
  async write(entries, options) {
    const start = this.#clock.now()
    const outcome = await this.#outcome(entries, options)
    return { ...outcome, ms: this.#clock.now() - start }
  }

  #outcome(entries, options) {
    try {
      const prepared = this.#prepare(entries, options)
      this.#settings.checkWrite?.(prepared, options)
      return options.coalesce ? this.#latest(prepared, options) : this.#carryOut({ prepared }, options)
    } catch (error) {
      const given = Array.isArray(entries) ? entries.slice(0, MOST_ENTRIES) : []
      return unsent(
        error,
        given.map(entry => ({ item: entry?.item, value: entry?.value }))
      )
    }
  }

  /** @returns {Prepared} @throws {PlcError} whatever forbids the write */
  #prepare(entries, { fixed }) {
    checkEntries(entries)
    const parsed = entries.map(entry => this.#entry(entry, fixed))
    const points = []
    checkPoints(parsed)
    for (const entry of parsed) {
      entry.from = points.length
      points.push(...writePointsOf(entry))
      entry.to = points.length
    }
    return { entries: parsed, points, requests: this.#settings.plan.writes(points) }
  }

  #entry(entry, fixed) {
    if (entry === null || typeof entry !== 'object')
      throw new PlcError('NOTHING_TO_WRITE', { reason: 'an entry has no item' })
    const item = this.#parse(entry.item)
    // the flow's author may fix single targets of a message, too
    this.#guard.checkItem(item, { fixed: fixed || entry.fixed === true })
    const values = encodeValue(item, entry.value)
    this.#guard.checkValues(item, values)
    return { item, value: entry.value, values, from: 0, to: 0 }
  }

  /** Of several writes of the same items that wait, only the latest goes out, in the place of the first. */
  #latest(prepared, options) {
    const key = JSON.stringify([prepared.entries.map(({ item }) => item.text), Boolean(options.verify)])
    const job = this.#waiting.get(key)
    if (!job) return this.#firstOf(key, prepared, options)
    const { entries } = job.prepared
    job.settle(unsent(new PlcError('SUPERSEDED', { item: entries[0].item.text }), entries))
    job.prepared = prepared
    return new Promise(resolve => (job.settle = resolve))
  }

  #firstOf(key, prepared, options) {
    const job = { prepared, settle: /** @type {(outcome: any) => void} */ (() => {}), begin: () => {} }
    job.begin = () => void (this.#waiting.get(key) === job && this.#waiting.delete(key))
    this.#waiting.set(key, job)
    const promise = new Promise(resolve => (job.settle = resolve))
    this.#carryOut(job, options).then(outcome => {
      job.begin()
      job.settle(outcome)
    })
    return promise
  }

  /** @param {any} job its `prepared` may be replaced until its first frame goes out */
  async #carryOut(job, { verify }) {
    const done = []
    let attempts = 0
    let error = null
    for (let next = 0; next < job.prepared.requests.length && goesOn(error); next++) {
      const take = () => {
        job.begin?.()
        const request = job.prepared.requests[next]
        attempts++
        return { query: request, item: job.prepared.points[request.points[0]].text }
      }
      error = await this.#send(take)
      done.push(error ? { outcome: wordFor(error), error } : { outcome: 'confirmed' })
    }
    const { entries, points, requests } = job.prepared
    const fates = points.map(() => ({ outcome: 'notSent' }))
    requests.forEach((request, index) => {
      if (done[index]) for (const point of request.points) fates[point] = done[index]
    })
    if (verify) await verifyWritten({ reader: this.#reader, station: this.#settings.station, points, fates })
    return { ...outcomeOf(entries, fates, this.#settings.station), attempts }
  }

  /** @returns {Promise<PlcError|null>} */
  async #send(take) {
    let item = ''
    try {
      await this.#talk.write(
        () => {
          const taken = take()
          item = taken.item
          return taken
        },
        { priority: PRIORITY.WRITE }
      )
      return null
    } catch (caught) {
      return this.#meaning(asPlcError(caught, this.#settings.station), item)
    }
  }

  /** What the line broke off after a byte of it went out may have been carried out. */
  #meaning(error, item) {
    const { code, details } = error
    if (code === 'WRITE_UNKNOWN' || isRefusal(error) || details.sent !== true) return error
    return new PlcError('WRITE_UNKNOWN', { station: this.#settings.station, item, reason: code, cause: error })
  }
}

module.exports = { Writer }
