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

  /**
   * Listens to messages. All listeners of a line share one framing and one way of using it; each message goes to each of them.
   *
   * @param {{ key: string, create: () => any }} framing of a codec: same key, same framing. `create()` → a splitter, see docs/architecture.md
   * @param {(message: any, facts: { at: number }) => any} onMessage `at`: epoch ms; a Buffer that it returns (ACK, NAK) goes out at once
   * @param {object} [options] how the line is used
   * @param {'none'|'dc'} [options.flow] dc: the other side stops us by DC3 (13h) and lets us go on by DC1 (11h)
   * @param {number|null} [options.transparent] the byte before a DC1 or DC3 that is data; null: none
   * @param {number} [options.room] bytes that the other side still takes after it has said stop; 64
   * @param {number} [options.latency] ms until the adapter brings what the other side has sent; 16
   * @param {number} [options.stallLimit] ms that a message may be stopped; 30000
   * @param {{ wait?: number, first?: Buffer|null, apart?: boolean }} [options.torn] after a message that was cut off: silence of ours in ms, bytes
   *   before the next; apart: the `after` of that one comes between them
   * @returns {{ close: () => void, pause: () => void, resume: () => void }} pause and resume tell the other side (flow dc)
   * @throws {PlcError} LINE_USE: the line asks stations, or listens in another way; BAD_SETTING; LINE_CLOSED
   */
  listen(framing, onMessage, options = {}) {
    if (this.#released) throw new PlcError('LINE_CLOSED', { line: this.#line.name, sent: false })
    if (typeof framing?.key !== 'string' || typeof framing.create !== 'function')
      throw new TypeError('a framing is needed')
    if (typeof onMessage !== 'function') throw new TypeError('a function that takes the messages is needed')
    return this.#line.listen(this, framing, { onMessage, options })
  }

  /**
   * Sends bytes as they are, after all that was given before.
   *
   * @param {Buffer} bytes
   * @param {object} [options] times in ms
   * @param {number} [options.quiet] silence on the line before it (half duplex); 0
   * @param {number} [options.after] nothing of ours follows it for so long; 0
   * @param {(message: any, times?: { since: number, now: number }) => boolean} [options.match] tells the message that answers it, which no listener
   *   gets; `since` this one is on the wire (ms of the clock; none: it is not any more, and would be answered late)
   * @param {number} [options.timeout] until that message, from the end of sending; needed with match
   * @param {number} [options.deadline] that it may wait for its turn; 0: no limit
   * @param {string} [options.label] for the trace
   * @returns {Promise<{ ms: number, answer: any, attempts: 1 }>} when its last byte has left by the wire's time, or its answer has come;
   *   ms since the call. Rejects with LINE_USE, QUEUE_FULL, DEADLINE, TIMEOUT, WRITE_STALLED, LINE_…, PORT_…, CONNECT_FAILED;
   *   `details.sent` of `details.of` bytes went out (0: none)
   */
  send(bytes, { quiet = 0, after = 0, match, timeout = 0, deadline = 0, label = '' } = {}) {
    if (!Buffer.isBuffer(bytes) || bytes.length === 0) return Promise.reject(new TypeError('bytes to send are needed'))
    if (match && !(timeout > 0)) return Promise.reject(new TypeError('an answer needs a timeout'))
    if (this.#released) {
      return Promise.reject(new PlcError('LINE_CLOSED', { line: this.#line.name, sent: 0, of: bytes.length }))
    }
    return this.#line.send(this, bytes, { quiet, after, match: match ?? null, timeout, deadline, label })
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
    // another lease may hear with the same function
    if (at < 0) return this
    this.#listeners.splice(at, 1)
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
