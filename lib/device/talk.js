'use strict'
const { masterIds } = require('../codec/nx/ids')
const { readDialog, writeDialog } = require('../codec/nx/dialog')
const { realClock } = require('../line')
const { announced } = require('./announced')
const { createMasterWatch } = require('./master-watch')
const { remembered } = require('./remembered')
const { RepeatWatch } = require('./repeat-watch')

/**
 * One query of an NX station over the line: the master's ID, the repeat by RR, and what is remembered about the station.
 * What must survive a redeploy lies in the line's memory of the station.
 */

const memoryOf = (lease, station) => {
  const memory = lease.line.memory(station)
  memory.nx ??= { ids: {}, master: {}, lastRead: null, openBitWrite: false }
  return memory.nx
}

class Talk {
  #lease
  #health
  #settings
  #memory
  #ids
  #watch
  #repeatWatch
  #counts = { requests: 0, answers: 0, nonStandardAcks: 0, repeats: 0, seenStation: /** @type {number|null} */ (null) }
  // a repeat by RR has no ID of its own that tells late from right, so whatever disturbs the line ends it
  #forget = () => void (this.#memory.lastRead = null)
  // what a write has come to is no trouble of the line
  #disturbed = ({ event }) => void (event === 'audit' || this.#forget())

  /**
   * @param {{ lease: any, clock?: any, health: import('./health').Health, settings: any, random: () => number }} options random: 0 to 1, for the
   *   first master ID
   */
  constructor({ lease, clock = realClock, health, settings, random }) {
    this.#lease = lease
    this.#health = health
    this.#settings = settings
    this.#memory = memoryOf(lease, settings.station)
    const { masterIds: ids } = settings
    this.#ids = masterIds({ ids, start: Math.floor(random() * ids.length), memory: this.#memory.ids })
    this.#watch = createMasterWatch({ memory: this.#memory.master, found: id => this.#tellFixed(id) })
    this.#repeatWatch = new RepeatWatch({ clock, memory: this.#memory, found: () => this.#tellNoRepeat() })
    lease.on('state', this.#forget)
    lease.on('event', this.#disturbed)
  }

  #tellFixed(id) {
    const { station } = this.#settings
    const shown = `0x${id.toString(16).toUpperCase()} (${id})`
    const cause = `station ${station} answers to the master ID ${shown} only`
    const remedy = `Set the master IDs of the PLC to ${shown} alone.`
    this.#lease.line.report({ event: 'fixedMasterId', station, id, cause, remedy })
  }

  #tellNoRepeat() {
    const { station } = this.#settings
    const cause = `station ${station} does not repeat a read by an RR alone: it is asked by queries, which takes some bytes more`
    const remedy = 'Nothing is lost. Without "sole master" in its configuration the repeat is not even tried.'
    this.#lease.line.report({ event: 'noRepeat', station, cause, remedy })
  }

  /** `{ requests, answers, nonStandardAcks, repeats, seenStation }` */
  get counts() {
    return { ...this.#counts }
  }

  /**
   * @param {any} query
   * @param {{ priority: number }} options
   * @returns {Promise<(boolean|number)[]>} raw values in order
   */
  read(query, { priority }) {
    const key = keyOf(query)
    const { station, deadline } = this.#settings
    const options = { station, priority, key, deadline, label: key, request: query }
    return this.#health.run(() => ({ request: query, dialog: this.#reading(query, key) }), options)
  }

  /** Whether reads may be repeated by their short form at all. */
  get repeating() {
    return this.#settings.soleMaster && this.#repeatWatch.allowed
  }

  /** Whether the station would repeat this read by its short form, as it stands. @param {any} query */
  repeats(query) {
    return this.repeating && this.#isLast(this.#memory.lastRead, keyOf(query))
  }

  #isLast(last, key) {
    return last !== null && last.key === key && last.stray === this.#lease.line.strays
  }

  /**
   * @param {() => { query: any, item: string, before?: (ask: (query: any) => Generator<any, any[], Buffer>) => Generator<any, () => void, Buffer> }} take
   *   called when its turn has come: the latest value goes out; `before` comes first, in the same conversation, may read, and returns what is to
   *   be called when a frame goes out
   * @param {{ priority: number }} options
   * @returns {Promise<true>}
   */
  async write(take, { priority }) {
    const { station, deadline } = this.#settings
    const make = () => {
      const { query, item, before } = take()
      return { request: query, dialog: this.#writing(query, { item, before }) }
    }
    return (await this.#health.run(make, { station, priority, deadline, label: 'write' })).values
  }

  /** @param {any} request a read of one address @returns {Generator<any, any, Buffer>} sent once */
  probing(request) {
    return this.#reading(request, '', 1)
  }

  /** Raw values. @param {any} query @param {string} key '': not to be repeated by an RR @param {number} [attempts] */
  *#reading(query, key, attempts = this.#settings.attempts) {
    const last = this.#begin()
    const { masterIds: row } = this.#settings
    // with one ID there is nothing to find out
    const trial = row.length > 1 ? this.#watch.trial() : undefined
    const same = this.repeating && key !== '' && this.#isLast(last, key)
    const options = this.#options(trial)
    options.attempts = attempts
    options.again = same ? last.master : undefined
    let result
    try {
      result = yield* readDialog(query, options)
    } catch (/** @type {any} */ error) {
      this.#watch.note({ id: options.facts.master, trial: trial !== undefined, code: error.code })
      throw error
    }
    this.#watch.note({ id: result.master, trial: trial !== undefined })
    this.#note(result)
    if (same) this.#repeatWatch.note(result.repeated)
    if (this.repeating) this.#memory.lastRead = { key, master: result.master, stray: this.#lease.line.strays }
    return result.values
  }

  /** A read inside of a write. */
  *#values(query) {
    this.#counts.requests++
    const result = yield* readDialog(query, this.#options())
    this.#note(result)
    return result.values
  }

  *#writing(query, { item, before }) {
    this.#begin()
    const sent = before && (yield* before(each => this.#values(each)))
    const nonStandardAck = !this.#memory.openBitWrite
    if (query.ask === 'writeBits') this.#memory.openBitWrite = true
    const result = yield* announced(writeDialog(query, { ...this.#options(), item, nonStandardAck }), sent)
    this.#note(result)
    return result
  }

  /** @param {number} [fixed] the one ID to send from @returns {any} */
  #options(fixed) {
    const { station, steps, timeout, attempts, gap, limits } = this.#settings
    const ids = fixed === undefined ? this.#ids : { ...this.#ids, take: () => fixed }
    /** @type {{ master?: number }} */
    const facts = {}
    return { station, steps, timeout, attempts, gap, limits, ids, facts, again: undefined }
  }

  /** The line begins a run of a station only when no older answer can come any more. */
  #begin() {
    const { lastRead } = this.#memory
    this.#ids.free()
    this.#counts.requests++
    this.#forget()
    return lastRead
  }

  #note(result) {
    this.#counts.answers++
    if (result.nonStandard) this.#counts.nonStandardAcks++
    if (result.repeated) this.#counts.repeats++
    this.#counts.seenStation = result.seenStation ?? this.#counts.seenStation
    this.#memory.openBitWrite = false
  }

  close() {
    this.#lease.off('state', this.#forget)
    this.#lease.off('event', this.#disturbed)
  }
}

/** Equal for equal queries: the same read that still waits is not queued twice. */
const keyOf = remembered((/** @type {any} */ query) => {
  if (query.ask !== 'readMixed') return `${query.ask} ${query.base} ${query.count}`
  return `readMixed ${query.addresses.map(({ kind, address }) => `${kind[0]}${address}`).join(' ')}`
})

module.exports = { Talk }
