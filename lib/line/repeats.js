'use strict'

/** How far the wire's true speed may lie from the configured one. */
const SPEED = 0.97
/**
 * After so many answers that took the wire's time, a copy of one of them is old if it comes early; after so many, whatever comes early is. A
 * pseudo-terminal, an adapter that has no speed, or a serial server may be slow by chance; a simulated wire has its speed always.
 */
const SURE = Object.freeze({ copies: 4, all: 20 })
const SURE_SIMULATED = Object.freeze({ copies: 1, all: 3 })
/** So many steps in a row that failed after an answer was dropped: it was none that is old, the speed is another one. */
const MISTAKES = 2

/**
 * Answers that are old: a second copy, or one that was lost and comes behind another. What follows an answer without a pause is still in the
 * adapter's buffer while the next query goes out, and where nothing in a frame tells which query it answers, it would be taken. But a frame that
 * began before the query was sent does not answer it: the wire's time tells.
 *
 * Programs that answer without a wire, and serial servers that are faster than their configuration says, are always early: there the wire's time
 * tells nothing. The first answers after an opening show it; as long as they are few, only a frame that was taken lately is held to be old.
 */
class Repeats {
  #character
  #sure
  /** the first answers @type {Buffer[]} */
  #taken = []
  /** answers that took the wire's time since the port was opened */
  #timely = 0
  /** whether one was too fast for the wire */
  #unpaced = false
  #dropped = false
  #mistakes = 0

  /** @param {{ character: number, simulated: boolean }} wire character: ms that one takes */
  constructor({ character, simulated }) {
    this.#character = character
    this.#sure = simulated ? SURE_SIMULATED : SURE
  }

  /** The port was opened: another line may be behind it. */
  reset() {
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
    const { copies, all } = this.#sure
    if (this.#unpaced || this.#timely < copies || !this.#isEarly(frame, query)) return false
    if (this.#timely < all && !this.#taken.some(each => each.equals(frame))) return false
    this.#dropped = true
    return true
  }

  #isEarly(frame, { length, sentAt, now }) {
    const character = SPEED * this.#character
    return now - frame.length * character < sentAt + length * character
  }

  /** The query was answered. @param {Buffer} frame @param {{ length: number, sentAt: number, now: number }} query */
  answered(frame, query) {
    if (this.#isEarly(frame, query)) this.#unpaced = true
    else this.#timely++
    this.#mistakes = 0
    if (this.#taken.length < this.#sure.all) this.#taken.push(frame)
  }

  /** It was not. */
  failed() {
    if (!this.#dropped) return
    this.#mistakes++
    if (this.#mistakes >= MISTAKES) this.#unpaced = true
  }
}

module.exports = { Repeats }
