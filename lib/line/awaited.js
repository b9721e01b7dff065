'use strict'

/** So much later (ms) an error may be seen than it has come; always long before its time is over. More where the last answer was none. */
const MOST_LATER = 25
const MOST_AFTER_GOOD = 60

/** How many bytes of an answer are worth reading: not the shortest error first, where the whole answer is hardly longer. */
class Awaited {
  #times
  /** whether the last answer was as long as usual */
  #isUsual = false

  /** @param {{ character: number, slack: number }} times of the line, ms */
  constructor(times) {
    this.#times = times
  }

  /**
   * @param {{ usual?: number, timeout: number }} step usual: bytes of its answer, if it is no error; timeout in ms
   * @param {number} need bytes of the shortest answer
   * @param {number} echo bytes of ours that come before it
   * @returns {number}
   */
  bytes({ usual, timeout }, need, echo) {
    if (!usual) return need
    const whole = usual + echo
    const later = (whole - need) * this.#times.character
    return later > 0 && later <= this.#mostLater(timeout) ? whole : need
  }

  #mostLater(timeout) {
    return this.#isUsual ? Math.min(MOST_AFTER_GOOD, timeout / 4) : Math.min(MOST_LATER, this.#times.slack / 2)
  }

  /** @param {Buffer} frame @param {{ usual?: number }} step */
  answered(frame, { usual }) {
    this.#isUsual = frame.length === usual
  }

  /** The step failed, or the port was opened: who knows what comes now. */
  forget() {
    this.#isUsual = false
  }
}

module.exports = { Awaited }
