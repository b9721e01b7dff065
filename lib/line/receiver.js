'use strict'

const EMPTY = Buffer.alloc(0)

/** Longer than two of the longest frames with their echo; what does not fit is no answer. */
const LIMIT = 4096

/** Received and not yet consumed bytes, and when the first of them came. Bounded. */
class Receiver {
  /** @type {Buffer} */
  bytes = EMPTY
  #chunks = []

  /** @param {Buffer} bytes @param {number} at ms @returns {Buffer} what had to be thrown away, oldest first */
  push(bytes, at) {
    this.bytes = this.bytes.length === 0 ? bytes : Buffer.concat([this.bytes, bytes])
    this.#chunks.push({ length: bytes.length, at })
    return this.bytes.length > LIMIT ? this.take(this.bytes.length - LIMIT) : EMPTY
  }

  /** Removes and returns the first n bytes, as a copy: the chunk may be part of a reader's large pool. */
  take(n) {
    if (n >= this.bytes.length) return this.takeAll()
    const taken = Buffer.from(this.bytes.subarray(0, n))
    this.bytes = this.bytes.subarray(taken.length)
    let rest = taken.length
    while (rest > 0 && this.#chunks.length > 0) {
      const [first] = this.#chunks
      const part = Math.min(first.length, rest)
      first.length -= part
      rest -= part
      if (first.length === 0) this.#chunks.shift()
    }
    return taken
  }

  takeAll() {
    if (this.bytes.length === 0) return EMPTY
    const taken = Buffer.from(this.bytes)
    this.bytes = EMPTY
    this.#chunks = []
    return taken
  }

  /** When the chunk of the first byte came, ms. */
  get firstAt() {
    return this.#chunks.length > 0 ? this.#chunks[0].at : Infinity
  }
}

module.exports = { EMPTY, Receiver }
