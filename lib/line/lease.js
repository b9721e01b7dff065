'use strict'

const { PlcError } = require('../error')
const { PRIORITY } = require('./queue')

/** @type {Set<number>} */
const CLASSES = new Set(Object.values(PRIORITY))

/** One user's share of a line. */
class Lease {
  #line
  #release
  /** @type {any} */
  #released = null
  #listeners = []

  /** @param {{ line: any, owner: { id: string, name: string }, release: (done: () => void) => void }} options */
  constructor({ line, owner, release }) {
    this.#line = line
    this.#release = release
    this.owner = owner
  }

  /** The line: `state`, `reason`, `stats()`, `trace()`, `memory(station)`, `times`. */
  get line() {
    return this.#line
  }

  get released() {
    return this.#released !== null
  }

  /**
   * Has a conversation carried out.
   *
   * @param {() => Generator<any, any, Buffer>} make makes the conversation when its turn has come
   * @param {object} options
   * @param {string|number} options.station the unit of turns and of quarantine
   * @param {number} [options.priority] one of PRIORITY; default ASK
   * @param {string} [options.key] a run of the same station, priority and key that still waits is shared (never a write)
   * @param {number} [options.deadline] ms that it may wait for its turn; 0: no limit
   * @param {number} [options.gap] ms of silence before each of its steps, at least
   * @param {number} [options.latenessBound] ms that an answer of this station may be late at most; 0: learnt
   * @param {string} [options.label] for the trace
   * @returns {Promise<any>} what the conversation returns; rejects with what it throws, or with the line's own codes:
   *   LINE_CLOSED, LINE_DOWN, LINE_JAMMED, QUEUE_FULL, DEADLINE, PORT_…, CONNECT_FAILED, WIRE_IN_USE; `details.sent`
   *   tells whether a byte of it went out
   */
  run(make, { station, priority = PRIORITY.ASK, key, deadline = 0, gap = 0, latenessBound = 0, label = '' }) {
    if (this.#released) {
      return Promise.reject(new PlcError('LINE_CLOSED', { line: this.#line.name, sent: false }))
    }
    if (!CLASSES.has(priority)) return Promise.reject(new TypeError(`unknown priority ${priority}`))
    const share = key === undefined || priority === PRIORITY.WRITE ? null : `${priority} ${station} ${key}`
    return this.#line.run(this, make, { station, priority, share, deadline, gap, latenessBound, label })
  }

  /** Listens to `state` (state, reason) and `event` ({ event, station, … }) of the line, until it is released. */
  on(event, listener) {
    if (this.#released) return this
    this.#listeners.push([event, listener])
    this.#line.on(event, listener)
    return this
  }

  off(event, listener) {
    const at = this.#listeners.findIndex(([name, fn]) => name === event && fn === listener)
    if (at >= 0) this.#listeners.splice(at, 1)
    this.#line.off(event, listener)
    return this
  }

  /**
   * Gives the line back: what only this lease waits for ends with LINE_CLOSED; the last one closes the port.
   * @returns {Promise<void>} within 2 s, and never rejects; calling it again gives the same promise
   */
  release() {
    if (!this.#released) {
      for (const [event, listener] of this.#listeners) this.#line.off(event, listener)
      this.#listeners = []
      this.#released = new Promise(resolve => this.#release(() => resolve(undefined)))
    }
    return this.#released
  }
}

module.exports = { Lease }
