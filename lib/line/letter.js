'use strict'

const { copyOf } = require('./run')

/** Something to send on a listening line, waiting or on its way. Its promise settles exactly once. */
class Letter {
  #resolve
  #reject
  /** @type {any} */
  deadlineTimer = null
  /** when it began to wait for silence, ms */
  /** @type {any} */
  waitsFrom = null
  /** when its first byte went out, ms */
  /** @type {any} */
  at = null
  /** what goes out: the message, behind what ends a torn one */
  wire
  #before = 0
  /** bytes handed to the port */
  out = 0
  /** @type {any} the last of its pieces: `{ at, from, end, taken }` */
  piece = null
  /** inside the call that hands a piece to the port */
  writing = false
  /** bytes that had come when it began to wait */
  heard = 0
  /** the answer that it awaits, if it came early */
  /** @type {any} */
  answer = null
  left = false

  /** @param {any} lease @param {{ bytes: Buffer, options: any, now: number }} what options: of `lease.send` */
  constructor(lease, { bytes, options, now }) {
    this.lease = lease
    this.since = now
    this.wire = Buffer.from(bytes)
    this.length = bytes.length
    this.quiet = options.quiet
    this.after = options.after
    this.match = options.match
    this.timeout = options.timeout
    this.label = options.label
    this.promise = new Promise((resolve, reject) => {
      this.#resolve = resolve
      this.#reject = reject
    })
  }

  /** Nothing of it has gone out. */
  get waits() {
    return this.at === null
  }

  get handedOver() {
    return !this.waits && this.out === this.wire.length
  }

  /** When it has waited long enough for the other side. @param {number} stoppedAt @param {number} limit ms */
  stallsAt(stoppedAt, limit) {
    return Math.max(stoppedAt, this.since) + limit
  }

  /** @param {number} now @param {Buffer|null} before what has to go out first */
  begin(now, before) {
    this.at = now
    if (!before) return
    this.#before = before.length
    this.wire = Buffer.concat([before, this.wire])
  }

  /** Bytes that have left by the wire's own time. What a port has not taken may have left but for the last one. */
  #gone(now, character) {
    const { piece } = this
    if (!piece) return 0
    if (piece.taken && now >= piece.end) return this.out
    const most = this.out - piece.from - (piece.taken ? 0 : 1)
    return piece.from + Math.max(1, Math.min(most, Math.floor((now - piece.at) / character)))
  }

  /** Whether it is cut off at this moment: a part of it has left, the rest has not. */
  isTorn(now, character) {
    return this.piece !== null && !(this.piece.taken && this.#gone(now, character) === this.wire.length)
  }

  /** Bytes of the message that have left; 0: the port got none of them. @param {number} now @param {number} character ms of one */
  sent(now, character) {
    const gone = this.#gone(now, character) - this.#before
    return Math.min(this.length, Math.max(this.given > 0 ? 1 : 0, gone))
  }

  /** Bytes of the message that the port has got. */
  get given() {
    return Math.max(0, this.out - this.#before)
  }

  /** Nobody waits for it any more; it goes out all the same. */
  abandoned() {
    this.lease = null
    this.match = null
  }

  /** It went out, and was answered if it wanted to. @param {number} now @param {any} answer */
  resolve(now, answer) {
    this.#resolve({ ms: now - this.since, answer, attempts: 1 })
  }

  /** @param {any} error @param {number} sent bytes of the message that went out */
  reject(error, sent) {
    const known = error?.name === 'PlcError'
    this.#reject(known ? copyOf(error, { sent, of: this.length }) : error)
  }
}

module.exports = { Letter }
