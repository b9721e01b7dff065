'use strict'
const { PlcError, isRefusal } = require('../error')
const { placeOf } = require('../codec/modbus/address')
const { describeQuery } = require('../codec/modbus/answer')
const { readDialog, writeDialog } = require('../codec/modbus/dialog')
const { readFunction, writeFunction } = require('../codec/modbus/functions')
const { announced } = require('./announced')
const { Clearing } = require('./modbus-clearing')
const { exchangeOf } = require('./modbus-exchange')
const { remembered } = require('./remembered')

/**
 * Requests of a MODBUS station over the line: absolute addresses -> what goes out, by the functions that its configuration chooses. What must
 * survive a redeploy lies in the line's memory of the station.
 */

const LEAST_GAP = 1.75 // ms: the fixed silence above 19200 bit/s (MODBUS over serial line, 2.5.1.1); below, 3.5 characters are longer
const MOST_EXACT = 1000

const memoryOf = (lease, station) => {
  const memory = lease.line.memory(station)
  memory.modbus ??= { exact: new Set() }
  return memory.modbus
}

/** @param {{ framing: string, sendWait: number }} settings @param {number} character ms */
const gapOf = ({ framing, sendWait }, character) =>
  framing === 'rtu' ? Math.max(sendWait, LEAST_GAP, 3.5 * character) : sendWait

const KINDS = { readBits: 'bit', readWords: 'word', writeBits: 'bit', writeWords: 'word', writeBitsOfWord: 'word' }
const wireOf = ({ ask, base }) => placeOf(KINDS[ask], base)

/** What reads a request of a plan: the query of the codec, and a name that is the same for equal requests. */
const readingOf = remembered((/** @type {any} */ request) => {
  const { ask, base, count } = request
  const { table, wire } = wireOf(request)
  return { query: /** @type {any} */ ({ fn: readFunction(table), base: wire, count }), name: `${ask} ${base} ${count}` }
})

const isSingle = (chosen, count) => chosen === '05' || chosen === '06' || (chosen === 'auto' && count === 1)

/** What writes, as the codec's dialog takes it. @returns {import('../codec/modbus/dialog').Write} */
const writeOf = (request, functions) => {
  const { table, wire } = wireOf(request)
  const chosen = functions[table]
  if (request.ask === 'writeBitsOfWord') {
    const { mask, value } = request
    return { bits: { base: wire, mask, value }, single: isSingle(chosen, 1) }
  }
  const { values } = request
  const single = isSingle(chosen, values.length)
  const fn = writeFunction(table, { single })
  const frames = single ? values.map((value, at) => ({ fn, base: wire + at, value })) : [{ fn, base: wire, values }]
  return { frames: /** @type {any} */ (frames) }
}

class ModbusTalk {
  #lease
  #health
  #settings
  #memory
  #clearing
  #counts = { requests: 0, answers: 0, exceptions: 0, broadcasts: 0 }

  /** @param {{ lease: any, health: import('./health').Health, settings: any, random?: () => number }} options random: 0 to 1, for function 08 */
  constructor({ lease, health, settings, random = Math.random }) {
    this.#lease = lease
    this.#health = health
    this.#settings = settings
    this.#memory = memoryOf(lease, settings.station)
    this.#clearing = new Clearing({ lease, settings, health, memory: this.#memory, random })
  }

  /** `{ requests, answers, exceptions, broadcasts }` */
  get counts() {
    return { ...this.#counts }
  }

  /**
   * @param {any} request `readBits` or `readWords` of the plan
   * @param {{ priority: number }} options
   * @returns {Promise<(boolean|number)[]>} raw values in order
   * @throws {PlcError} (rejects) MODBUS_…, TIMEOUT, INCOMPLETE, CRC_ERROR, BAD_ANSWER, those of the line
   */
  async read(request, { priority }) {
    const { station, deadline, framing } = this.#settings
    const label = readingOf(request).name
    const key = `modbus ${framing} ${label}`
    const make = () => ({ request, dialog: this.#cleared(this.#reading(request)) })
    return this.#health.run(make, { station, priority, key, deadline, label, request })
  }

  /** @param {any} request a read of one address @returns {Generator<any, any, Buffer>} sent once */
  probing(request) {
    return this.#reading(request, 1)
  }

  /**
   * @param {() => { query: any, item: string, before?: (ask: (request: any) => Generator<any, any[], Buffer>) => Generator<any, () => void, Buffer> }} take
   *   called when its turn has come: the latest value goes out; `before` comes first, in the same conversation, may read, and returns what is to
   *   be called when a frame goes out
   * @param {{ priority: number }} options
   * @returns {Promise<true>}
   * @throws {PlcError} (rejects) MODBUS_…, WRITE_UNKNOWN, BROADCAST_UNCONFIRMED; `details.sent` of others: whether a frame that writes went out
   */
  async write(take, { priority }) {
    const { station, deadline } = this.#settings
    const facts = { writes: 0 }
    const make = () => {
      const taken = take()
      return { request: taken.query, dialog: this.#cleared(this.#writing(taken, facts)) }
    }
    try {
      return await this.#health.run(make, { station, priority, deadline, label: 'write' })
    } catch (/** @type {any} */ error) {
      // the line knows only that a byte went out: before the first frame that writes it was one that reads
      if (facts.writes > 0 || error.details?.sent !== true) throw error
      throw new PlcError(error.code, { ...error.details, sent: false, cause: error })
    }
  }

  *#reading(request, attempts = this.#settings.attempts) {
    const { query, name } = readingOf(request)
    const { units } = this.#settings
    const { exact } = this.#memory
    const unit = exact.has(name) ? 1 : units[query.fn]
    const facts = { exact: false }
    const result = yield* this.#counted(readDialog(query, this.#options({ attempts, unit, facts })))
    if (facts.exact) {
      if (exact.size >= MOST_EXACT) exact.clear()
      exact.add(name)
    }
    return result.values
  }

  *#writing({ query: request, item, before = /** @type {any} */ (null) }, facts) {
    const sent = before && (yield* before(each => this.#reading(each)))
    const { functions, station, broadcast } = this.#settings
    const write = writeOf(request, functions)
    // an answer that equals the query proves nothing while the adapter may hear itself
    const probe = this.#lease.line.echo === 'unknown'
    const names = request.points.length === 1 ? () => item : describeQuery
    const options = { ...this.#options({ facts }), item, probe, names, ...(broadcast ? { broadcast } : {}) }
    const result = yield* this.#counted(announced(writeDialog(write, options), sent))
    if (station !== 0) return result.values
    this.#counts.broadcasts++
    throw new PlcError('BROADCAST_UNCONFIRMED', { item, line: this.#lease.line.name })
  }

  #cleared(dialog) {
    return this.#clearing.watch(dialog, this.#gap)
  }

  get #gap() {
    return gapOf(this.#settings, this.#lease.line.times?.character ?? 0)
  }

  #options({ attempts = this.#settings.attempts, unit = 1, facts }) {
    const { station, framing: protocol, timeout } = this.#settings
    return { station, protocol, timeout, attempts, gap: this.#gap, unit, facts, exchange: exchangeOf }
  }

  *#counted(dialog) {
    this.#counts.requests++
    try {
      const result = yield* dialog
      if (this.#settings.station !== 0) this.#counts.answers++
      return result
    } catch (/** @type {any} */ error) {
      if (isRefusal(error) || isRefusal(error.cause)) this.#counts.exceptions++
      throw error
    }
  }

  close() {
    this.#clearing.close()
  }
}

module.exports = { ModbusTalk }
