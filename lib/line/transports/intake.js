'use strict'

/** Bytes that a line takes at once: more than the longest frame with its echo. */
const PIECE = 1024
/** Then others get their turn, ms. So a line takes up to a megabyte a second, and no wire brings a tenth of it. */
const PAUSE = 1
/** A message costs who gets it as much as so many bytes cost us: sixteen of them at once, as many as 115200 bit/s bring of one byte each. */
const MESSAGE = 64
/** Bytes that a line of messages takes in one go: they may be as many messages. */
const STEP = 64

/**
 * What comes in, in pieces: however much the other side sends at once, the process has time for others after each of them. Meanwhile the source is
 * held, so that nothing is collected here.
 */
class Intake {
  #clock
  #data
  #hold
  /** @type {Buffer[]} */
  #waiting = []
  #left = PIECE
  #step = PIECE
  #since = -Infinity
  /** @type {any} */
  #timer = null
  #over = false

  /**
   * @param {{ clock: import('../clock').Clock, data: (bytes: Buffer, at?: number) => any, hold: (held: boolean) => void }} options
   *   data: gets when they came (ms of the clock), where that is not now, and returns how many messages they were, where the line listens; hold: stops the source, and lets it go on; a chunk that comes all the same is
   *   kept
   */
  constructor({ clock, data, hold }) {
    this.#clock = clock
    this.#data = data
    this.#hold = hold
  }

  /** @param {Buffer} bytes as they came */
  take(bytes) {
    this.#waiting.push(bytes)
    if (this.#timer !== null) return
    const now = this.#clock.now()
    if (now - this.#since >= PAUSE) this.#renew(now)
    this.#deliver(now)
    if (this.#timer !== null) this.#hold(true)
  }

  /** Whether bytes have come that nobody has seen yet. */
  get waiting() {
    return this.#waiting.length > 0
  }

  #renew(now) {
    this.#since = now
    this.#left = Math.min(PIECE, this.#left + PIECE)
  }

  /** As much as may be taken now; the rest waits. @param {number} [at] when all of it came */
  #deliver(at) {
    while (this.#waiting.length > 0) {
      if (this.#left <= 0) {
        this.#timer = this.#clock.setTimer(() => this.#goOn(), PAUSE)
        return
      }
      const messages = this.#data(this.#next(), at)
      this.#step = messages === undefined ? PIECE : STEP
      this.#left -= (messages ?? 0) * MESSAGE
    }
  }

  #next() {
    const [first] = this.#waiting
    const piece = first.subarray(0, Math.min(this.#left, this.#step))
    if (piece.length < first.length) this.#waiting[0] = first.subarray(piece.length)
    else this.#waiting.shift()
    this.#left -= piece.length
    return piece
  }

  #goOn() {
    this.#timer = null
    this.#renew(this.#clock.now())
    this.#deliver()
    if (this.#timer === null && !this.#over) this.#hold(false)
  }

  /** The source is gone: what waits is dropped. */
  stop() {
    this.#clock.clearTimer(this.#timer)
    this.#timer = null
    this.#waiting = []
    this.#over = true
  }
}

module.exports = { Intake, PIECE }
