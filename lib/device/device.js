'use strict'
const { PlcError } = require('../error')
const { PRIORITY, realClock } = require('../line')
const { elementsOf } = require('../tag/convert')
const { distinctNames, parseItem, splitType } = require('../tag/item')
const { Lists } = require('./lists')
const { Load } = require('./load')
const { checkTotal, resultsOf, widthOf } = require('./points')
const { Grid } = require('./phases')
const { Poller } = require('./poller')
const { Reader } = require('./reader')
const { Subscription } = require('./subscription')
const { Turnaround } = require('./turnaround')
const { Writer } = require('./writer')

const MOST_ITEMS = 1000
const MOST_KNOWN = 100000

/** One station on a line: items, reading, writing, polling. What its protocol is stands in its settings and its talk. */
class Device {
  #settings
  #clock
  #talk
  #health
  #reader
  #writer
  /** @type {Set<Subscription>} */
  #subscriptions = new Set()
  #poller
  #load
  #known = new Map()
  #lists = new Lists(items => this.#readable(items))
  #weight = 0
  #closed = false

  /**
   * @param {object} options
   * @param {any} options.settings read and checked; what any protocol needs of them is in docs/architecture.md, "Device"
   * @param {any} options.line of the lease: what is remembered about the station, and who is told what becomes of writes
   * @param {any} options.talk requests over the line: `read(request, { priority })`, `write(take, { priority })`, `probing(request)`, `counts`, `close()`
   * @param {import('./health').Health} options.health
   * @param {any} [options.clock]
   * @param {() => number} [options.random] 0 to 1
   */
  constructor({ settings, line, talk, health, clock = realClock, random = Math.random }) {
    this.#settings = settings
    this.#clock = clock
    this.#talk = talk
    this.#health = health
    health.serve({ talk, wake: () => this.#poller.now([...this.#subscriptions].filter(each => each.again())) })
    const turnaround = new Turnaround(line.memory(settings.station))
    this.#reader = new Reader({ talk, settings, clock, turnaround })
    const poll = { priority: PRIORITY.POLL, fresh: false }
    const read = points => this.#reader.read(points, poll)
    const overrun = member => health.now.state === 'online' && this.#load.overrun(member)
    const grid = new Grid(line, settings.station)
    const estimate = points => this.#load.msOf(points)
    this.#poller = new Poller({ clock, random, grid, read, estimate, overrun })
    const groups = () => this.#poller.groups
    this.#load = new Load({ clock, line, settings, reader: this.#reader, groups, members: () => this.#subscriptions })
    const parse = text => this.item(text)
    this.#writer = new Writer({ talk, reader: this.#reader, line, clock, settings, parse })
  }

  get name() {
    return this.#settings.name
  }

  get station() {
    return this.#settings.station
  }

  /** `read` or `write`: whether writing is allowed at all. */
  get access() {
    return this.#settings.access
  }

  /** ms of its monotonic clock. */
  get time() {
    return this.#clock.now()
  }

  /** How the station is: `{ state: 'online'|'suspect'|'demoted', since, probe }`, epoch ms or null. */
  get health() {
    return this.#health.now
  }

  /**
   * What its polls are expected to take of the line: `{ percent, busyPercent, cycles }`, with the silences before frames and without; `cycles`:
   * `[{ intervals, every, ms, requests }]`.
   */
  get cost() {
    const { percent, busyPercent, cycles } = this.#load.all()
    return { percent, busyPercent, cycles }
  }

  /** A timeout that would do for this station, ms; null: no answer came late, or nearly so. */
  get advice() {
    return this.#health.advice
  }

  /** Who it is on its line, for `mixedConflict`: `{ protocol, station, masterIds, name }`. */
  get member() {
    const { protocol, station, masterIds = [], name } = this.#settings
    return { protocol, station, masterIds, name }
  }

  /** Counters: those of its talk, `overruns` and `subscriptions`. */
  get stats() {
    const overruns = [...this.#subscriptions].reduce((sum, subscription) => sum + subscription.overruns, 0)
    return { ...this.#talk.counts, overruns, subscriptions: this.#subscriptions.size }
  }

  /**
   * An item of this station: a tag's name or an address expression.
   * @param {unknown} text `M0`, `K127.12`, `W10:float32`, `M0..M127`, `boiler_temp`
   * @returns {import('../tag/item').Item}
   * @throws {PlcError} BAD_ITEMS, BAD_ADDRESS, UNKNOWN_AREA, OUT_OF_AREA, BAD_BIT, BAD_COUNT, BAD_TYPE
   */
  item(text) {
    const known = typeof text === 'string' ? this.#known.get(text) : undefined
    if (known) return known
    const item = parseItem(text, this.#settings.notation)
    // bounded by what the items weigh: a range holds an object per address
    this.#weight += item.count
    if (this.#weight > MOST_KNOWN) {
      this.#known.clear()
      this.#weight = item.count
    }
    this.#known.set(item.text, item)
    return item
  }

  /**
   * What goes out for an item, in one line, for dialogs.
   * @param {unknown} text
   * @param {{ write?: boolean }} [options]
   * @returns {{ name: string, type: string, goesOut: string, certainty: string, writable: boolean }} `function 23, word
   *   addresses 020Ah–020Bh (522–523)`
   * @throws {PlcError} as {@link Device.item}
   */
  describe(text, { write = false } = {}) {
    const { notation } = this.#settings
    const item = this.item(text)
    const address = /** @type {any} */ (notation.parse(splitType(item.tag ? item.tag.address : item.text.trim())[0]))
    const whole = { ...address, count: item.count * widthOf(item) }
    const goesOut = this.#settings.describe(whole, { write })
    return { name: item.name, type: item.type.name, goesOut, certainty: address.certainty, writable: address.writable }
  }

  /**
   * Checks a write without sending anything: for a target that is fixed in a node, at deploy.
   * @param {unknown} text
   * @param {{ fixed?: boolean }} [options]
   * @returns {import('../tag/item').Item}
   * @throws {PlcError} READ_ONLY, NOT_WRITABLE, and those of {@link Device.item}
   */
  checkTarget(text, { fixed = true } = {}) {
    const item = this.item(text)
    this.#writer.checkTarget(item, { fixed })
    return item
  }

  /**
   * Items with names that differ.
   * @param {unknown} items array of texts
   * @returns {import('../tag/item').Item[]}
   * @throws {PlcError} BAD_ITEMS, TOO_MANY, and those of {@link Device.item}
   */
  items(items) {
    if (!Array.isArray(items)) throw new PlcError('BAD_ITEMS', { reason: 'it is no array' })
    if (items.length === 0) throw new PlcError('BAD_ITEMS', { reason: 'it is empty' })
    if (items.length > MOST_ITEMS)
      throw new PlcError('TOO_MANY', { count: items.length, unit: 'items', most: MOST_ITEMS })
    const parsed = elementsOf(items).map(text => this.item(text))
    checkTotal(parsed)
    return distinctNames(parsed)
  }

  #readable(items) {
    const parsed = this.items(items)
    this.#settings.checkRead?.(parsed)
    return parsed
  }

  /**
   * Reads any mix of items.
   * @param {unknown} items array of texts, at most 1000 and 20,000 addresses
   * @param {{ priority?: number }} [options] PRIORITY.ASK (default) or PRIORITY.POLL; a poll leaves addresses that the
   *   station said it does not have alone for 30 s
   * @returns {Promise<import('./points').Result[]>} one per item, in order; what went wrong stands in the results
   * @throws {PlcError} (rejects) only for what is wrong with the request: BAD_ITEMS, TOO_MANY, FRAME_TOO_LONG (for all of them), and those of
   *   {@link Device.item}
   */
  async read(items, { priority = PRIORITY.ASK } = {}) {
    const list = this.#lists.of(items)
    const fresh = priority !== PRIORITY.POLL
    return resultsOf(list.items, await this.#reader.read(list.points, { priority, fresh }))
  }

  /**
   * Writes values; all are checked before the first is sent.
   * @param {{ item: string, value: any, fixed?: boolean }[]} entries at most 1000; `fixed` of one as in the options
   * @param {object} [options]
   * @param {boolean} [options.fixed] the targets were fixed by the flow's author, not by a message
   * @param {boolean} [options.verify] read back and compare; confirms also an unanswered write that reads so
   * @param {boolean} [options.coalesce] a write of the same items that still waits is replaced (its outcome: SUPERSEDED); it waits for the
   *   write interval
   * @param {import('./audit').By} [options.by] who asked, for the event `audit`
   * @returns {Promise<import('./outcome').Outcome>} never rejects
   */
  write(entries, { fixed = false, verify = false, coalesce = false, by } = {}) {
    return this.#writer.write(entries, { fixed, verify, coalesce, by })
  }

  /**
   * Tells of a write that its owner refuses before it gets here (a retained message): the event `audit`, nothing else.
   * @param {{ item: any, value: any }[]} entries as far as they are known
   * @param {any} error why
   * @param {{ by?: import('./audit').By }} [options]
   * @returns {import('./outcome').Outcome} refused
   */
  refused(entries, error, { by } = {}) {
    return this.#writer.refused(entries, error, { by })
  }

  /**
   * Polls items.
   * @param {{ items: any[], interval: number, immediately?: boolean, name?: string }} group interval in ms, 10 to a day; `immediately`
   *   (default): the first cycle at once; name: of who asks, for who looks on
   * @param {(results: import('./points').Result[], cycle: import('./subscription').Cycle) => void} callback per cycle
   * @returns {Polling}
   * @throws {PlcError} BAD_SETTING, LINE_CLOSED, and those of {@link Device.items}
   */
  subscribe({ items, interval, immediately = true, name }, callback) {
    if (this.#closed) throw new PlcError('LINE_CLOSED', { line: this.name })
    const clock = this.#clock
    const subscription = new Subscription({ clock, items: this.#readable(items), interval, callback, name })
    subscription.repeat = own => this.#poller.now([own])
    this.#subscriptions.add(subscription)
    this.#poller.add(subscription, { immediately })
    this.#load.changed()
    return this.#handleOf(subscription)
  }

  #handleOf(subscription) {
    const load = this.#load
    return {
      stop: () => this.#unsubscribe(subscription),
      setItems: next => {
        subscription.setItems(this.#readable(next))
        this.#poller.changed()
        load.changed()
      },
      get overruns() {
        return subscription.overruns
      },
      get cost() {
        return load.costOf(subscription)
      }
    }
  }

  #unsubscribe(subscription) {
    subscription.stopped = true
    this.#subscriptions.delete(subscription)
    this.#poller.remove(subscription)
    this.#load.changed()
  }

  /** Ends its subscriptions. The lease is its owner's to release: that ends what still waits. Any number of times. */
  close() {
    this.#closed = true
    for (const subscription of this.#subscriptions) this.#unsubscribe(subscription)
    this.#load.close()
    this.#writer.close()
    this.#health.close()
    this.#talk.close()
  }
}

/**
 * @typedef {object} Polling
 * @property {() => void} stop
 * @property {(items: any[]) => void} setItems
 * @property {number} overruns cycles that were left out
 * @property {{ ms: number, percent: number, requests: number, linePercent: number, advice: string | null }} cost what a cycle takes by itself, and what
 *   percent of the line's time that is; linePercent: of all who poll on the line; advice: where that is too much and this one asks for most
 */

module.exports = { Device }
