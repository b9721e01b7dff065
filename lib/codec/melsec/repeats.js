'use strict'

/**
 * Frames of the bidirectional protocol that come twice. Pure: times are given.
 *
 * If our ACK is lost, the other side sends the same frame again, and nothing in it tells it from a new message with the same bytes. What can be
 * known: it repeats only after it has waited for the ACK in vain (`after` ms, the module's timer 1 and its program's own), or after our NAK. So
 * * other bytes than in the frame that was accepted last: new;
 * * the same bytes, begun earlier than `after` or later than `within` ms after our ACK: new;
 * * the same bytes in between: a repetition, **or** a new message that happens to be equal. Exactly once is proven only where messages that follow
 *   each other differ (a counter, a time) or equal ones are never sent in that span.
 */
class Repeats {
  #after
  #within
  /** @type {Buffer|null} */
  #last = null
  #acknowledged = 0
  /** @type {number|null} when the attempt began that we refused */
  #refused = null

  /** @param {{ after: number, within: number }} options ms; within 0: nothing is a repetition */
  constructor({ after, within }) {
    this.#after = after
    this.#within = within
  }

  /** A damaged frame was answered by NAK: what follows is its repetition, and began then. @param {number} at ms */
  refuse(at) {
    this.#refused ??= at
  }

  /**
   * A frame came whole and is acknowledged.
   * @param {Buffer} bytes @param {number} at ms
   * @returns {boolean} whether it is, as far as can be known, the one accepted last
   */
  accept(bytes, at) {
    const waited = (this.#refused ?? at) - this.#acknowledged
    const again = this.#last !== null && waited >= this.#after && waited <= this.#within && this.#last.equals(bytes)
    this.#last = bytes
    this.#acknowledged = at
    this.#refused = null
    return again
  }
}

module.exports = { Repeats }
