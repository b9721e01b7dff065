'use strict'

/** How far the wire's true speed may lie from the configured one. */
const SPEED = 0.97
/** After so many answers that took the wire's time, an early copy of one of them is old; after so many, whatever comes early is. */
const SURE = Object.freeze({ copies: 1, all: 3 })
const SURE_LATER = Object.freeze({ copies: 4, all: 20 })
/** Where there may be no wire at all, an answer proves its time only if query and answer take so long (ms) that no program is as slow by chance. */
const LONG = 50

/** Pseudo-terminals and adapters that have no speed of their own, on Linux and macOS: what is behind them may be a program. */
const NO_WIRE = /^\/dev\/(pts\/|ttys\d|ttyACM|ttyGS|cu\.usbmodem|tty\.usbmodem)/

/**
 * So many steps that failed after an answer was dropped: it was none that is old, the speed is another one. On a wire they count in a row; elsewhere
 * only the right answer behind a dropped one shows that dropping was right.
 */
const MISTAKES = 2

/**
 * Answers that are old: a second copy, or one that was lost and comes behind another. What follows an answer without a pause is still in the
 * adapter's buffer while the next query goes out, and where nothing in a frame tells which query it answers, it would be taken. But a frame that
 * began before the query was sent does not answer it: the wire's time tells.
 *
 * A serial port has the speed that it was opened with, and so has a simulated wire. Programs that answer without a wire, and serial servers that are
 * faster than their configuration says, are early: there the wire's time tells nothing. Answers show it; as long as they are few, only a frame that
 * was taken lately is held to be old.
 */
class Repeats {
  #character
  #transport
  /** whether it is known that there is a wire */
  #wire = false
  /** the first answers @type {Buffer[]} */
  #taken = []
  /** answers that took the wire's time since the port was opened */
  #timely = 0
  /** whether one was too fast for the wire */
  #unpaced = false
  #dropped = false
  #mistakes = 0

  /** @param {{ character: number, transport: string }} line character: ms that one takes */
  constructor({ character, transport }) {
    this.#character = character
    this.#transport = transport
  }

  /** The port was opened: another line may be behind it. @param {unknown} [id] what the transport claims: the real path of a serial port */
  opened(id) {
    this.#wire = this.#transport === 'simulated' || (this.#transport === 'serial' && !NO_WIRE.test(String(id)))
    this.#taken = []
    this.#timely = 0
    this.#unpaced = false
    this.#mistakes = 0
  }

  /** A query goes out. */
  sent() {
    this.#dropped = false
  }

  /**
   * @param {Buffer} frame that has just come, whole
   * @param {{ length: number, sentAt: number, now: number }} query its length and when its first byte went out, ms
   * @returns {boolean} whether it is an old answer
   */
  isOld(frame, query) {
    const { copies, all } = this.#sure()
    if (this.#unpaced || this.#timely < copies || !this.#isEarly(frame, query)) return false
    if (this.#timely < all && !this.#taken.some(each => each.equals(frame))) return false
    this.#dropped = true
    return true
  }

  #sure() {
    return this.#wire ? SURE : SURE_LATER
  }

  #isEarly(frame, { length, sentAt, now }) {
    const character = SPEED * this.#character
    return now - frame.length * character < sentAt + length * character
  }

  /** The query was answered. @param {Buffer} frame @param {{ length: number, sentAt: number, now: number }} query */
  answered(frame, query) {
    if (this.#isEarly(frame, query)) this.#unpaced = true
    else if (this.#wire || (frame.length + query.length) * this.#character >= LONG) this.#timely++
    if (this.#wire || this.#dropped) this.#mistakes = 0
    if (this.#taken.length < this.#sure().all) this.#taken.push(frame)
  }

  /** It was not. */
  failed() {
    if (!this.#dropped) return
    this.#mistakes++
    if (this.#mistakes >= MISTAKES) this.#unpaced = true
  }
}

module.exports = { Repeats }
