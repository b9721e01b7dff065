'use strict'

const KEY = Symbol('torn')

/** A message that was cut off on this wire, and nothing has gone out since. In the pool's memory of the wire: a redeploy does not end it. */
class Torn {
  #memories
  /** what ends it has gone out, and nothing after that */
  #ended = false

  /** @param {Map<any, any>} memories of the wire */
  constructor(memories) {
    this.#memories = memories
  }

  /** @param {number} at when it was cut off, ms */
  mark(at) {
    this.#memories.set(KEY, { at })
  }

  /** Nothing goes out before this, ms. @param {number} wait of silence of ours, ms */
  until(wait) {
    const torn = this.#memories.get(KEY)
    return torn ? torn.at + wait : -Infinity
  }

  /** What has to go out before the next message, or null. @param {{ first: Buffer|null }} options */
  first({ first }) {
    return this.#memories.has(KEY) && !this.#ended ? first : null
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
    this.#memories.delete(KEY)
    this.#ended = false
  }
}

module.exports = { Torn }
