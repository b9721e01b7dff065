'use strict'

const KEY = Symbol('aftermath')

/** An acknowledgement may be late by this at least, ms: until then nothing goes out that it could be taken for. */
const LEAST_HOLD = 1000

/**
 * What the messages that went out leave behind on a wire: a pause, an acknowledgement that may still come, a message that was cut off. In the pool's
 * memory of the wire: the other side knows nothing of a redeploy.
 */
class Aftermath {
  #clock
  #memory
  /** what ends a torn message has gone out, and nothing after that */
  #ended = false

  /** @param {any} clock @param {Map<any, any>} memories of the wire */
  constructor(clock, memories) {
    this.#clock = clock
    if (!memories.has(KEY)) memories.set(KEY, { freeAt: -Infinity, late: null, tornAt: null })
    this.#memory = memories.get(KEY)
  }

  /** Nothing new before this, ms. @param {{ wait: number }} torn silence of ours after a torn message, ms */
  until({ wait }) {
    const { freeAt, late, tornAt } = this.#memory
    return Math.max(freeAt, late?.until ?? 0, tornAt === null ? 0 : tornAt + wait)
  }

  /** @param {number} at ms: nothing before */
  pause(at) {
    this.#memory.freeAt = Math.max(this.#memory.freeAt, at)
  }

  // --- an acknowledgement that may still come

  /** @param {any} letter that was not answered */
  expect({ match, timeout, piece }) {
    if (!match || !piece) return
    this.#memory.late = { match, until: Math.max(this.#clock.now(), piece.end) + Math.max(timeout, LEAST_HOLD) }
  }

  /** Whether this message is that one. @param {any} message */
  isLate(message) {
    const { late } = this.#memory
    if (!late || this.#clock.now() > late.until || !guarded(late.match, message)) return false
    this.#memory.late = null
    return true
  }

  // --- a message that was cut off, and nothing has gone out since

  tear() {
    this.#memory.tornAt = this.#clock.now()
  }

  /** What has to go out before the next message, or null. @param {{ first: Buffer|null }} torn */
  first({ first }) {
    return this.#memory.tornAt !== null && !this.#ended ? first : null
  }

  /** What ends it goes out now: until something else does it counts as torn, since that may be lost, too. */
  end() {
    this.#ended = true
  }

  /** The connection was lost: whether what ended it has arrived is not known. */
  lost() {
    this.#ended = false
  }

  /** Something else goes out. */
  over() {
    this.#memory.tornAt = null
    this.#ended = false
  }
}

/** A recogniser that throws recognises nothing. */
const guarded = (match, message) => {
  try {
    return match(message)
  } catch {
    return false
  }
}

module.exports = { Aftermath }
