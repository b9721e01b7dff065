'use strict'

const MOST = 200

/** How long a station took lately until its first byte came, ms: what its timeout must cover. Bounded. */
class Waits {
  #rows = new Float64Array(MOST)
  #count = 0
  #sum = 0

  /** How many are known, 200 at most. */
  get size() {
    return Math.min(this.#count, MOST)
  }

  /** @param {number} ms */
  add(ms) {
    const at = this.#count++ % MOST
    this.#sum += ms - this.#rows[at]
    this.#rows[at] = ms
  }

  /** ms; null: there was none. */
  get mean() {
    return this.#count === 0 ? null : this.#sum / this.size
  }

  /** What 99 of 100 answers did not exceed, ms; null: there was none. */
  get p99() {
    const { size } = this
    if (size === 0) return null
    const sorted = this.#rows.slice(0, size).sort()
    return sorted[Math.ceil(size * 0.99) - 1]
  }
}

/** A timeout that would do for a station that took so long. @param {number} ms @returns {number} ms, in hundreds */
const timeoutFor = ms => Math.ceil((ms * 1.5) / 100) * 100

module.exports = { Waits, timeoutFor }
