'use strict'

/** How far the wire's true speed may lie from the configured one. */
const SPEED = 0.97
/** Answers that are remembered: one that comes again may be the last one of its station, and others were asked since. */
const MOST = 32
/** So many steps in a row that failed after an answer was dropped: it was no repetition, the speed is another one. */
const MISTAKES = 2

/**
 * Answers that come twice. One that follows the first without a pause is still in the adapter's buffer while the next query goes out, and where
 * nothing in a frame tells which query it answers, it would be taken. But a frame that began before the query was sent does not answer it: the
 * wire's time tells. So one that was taken lately, and comes that early, is old.
 *
 * Programs that answer without a wire, and serial servers that are faster than their configuration says, are always early: there the wire's time
 * tells nothing. The first answer after an opening shows it, or an early one that is new.
 */
class Repeats {
  #character
  /** @type {Buffer[]} */
  #taken = []
  /** @type {boolean | null} whether answers take the wire's time; null: not known yet */
  #paced = null
  #dropped = false
  #mistakes = 0

  /** @param {number} character ms that one takes on the wire */
  constructor(character) {
    this.#character = character
  }

  /** The port was opened: another line may be behind it. */
  reset() {
    this.#taken = []
    this.#paced = null
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
    if (!this.#paced || !this.#isEarly(frame, query) || !this.#taken.some(each => each.equals(frame))) return false
    this.#dropped = true
    return true
  }

  #isEarly(frame, { length, sentAt, now }) {
    const character = SPEED * this.#character
    return now - frame.length * character < sentAt + length * character
  }

  /** The query was answered. @param {Buffer} frame @param {{ length: number, sentAt: number, now: number }} query */
  answered(frame, query) {
    if (this.#isEarly(frame, query)) this.#paced = false
    else this.#paced ??= true
    this.#mistakes = 0
    this.#taken.push(frame)
    if (this.#taken.length > MOST) this.#taken.shift()
  }

  /** It was not. */
  failed() {
    if (!this.#dropped) return
    this.#mistakes++
    if (this.#mistakes >= MISTAKES) this.#paced = false
  }
}

module.exports = { Repeats }
