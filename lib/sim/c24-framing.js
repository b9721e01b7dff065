'use strict'

const { ACK, CODES, ENQ, fromHex, NAK, plain, toHex } = require('./c24-bytes')

/**
 * Non-procedure protocol: where a message ends. Receive complete code or last user frame, receive data count, or `cut` (timer 0),
 * whichever is first. With a first user frame, what comes before it is skipped. With ASCII-binary conversion the complete code is looked for
 * behind the conversion, user frames before it.
 */
class FreeFraming {
  #settings
  #counts
  #frames
  #close
  #most
  #taken
  #length = 0
  #open

  /** @param {any} settings of c24-settings.js @param {{ skipped: number }} counts */
  constructor(settings, counts) {
    const { first, last, end, asciiBinary, mostBytes } = settings
    this.#settings = settings
    this.#counts = counts
    this.#frames = first.length + last.length > 0
    this.#close = this.#frames ? last : asciiBinary ? toHex(end) : end
    this.#most = asciiBinary ? mostBytes * 2 : mostBytes
    this.#taken = new Uint16Array(this.#most + first.length)
    this.#open = first.length === 0
  }

  /** @param {number} value a byte, or LITERAL + a byte @returns {Taken | null} */
  feed(value) {
    this.#taken[this.#length++] = this.#settings.asciiBinary ? plain(value) : value
    if (!this.#open) return this.#seek()
    if (this.#endsWith(this.#close)) return this.#whole(this.#frames ? 'frame' : 'code')
    return this.#length >= this.#most ? this.#whole('count') : null
  }

  /** @returns {Taken | null} */
  cut() {
    return this.#open && this.#length > 0 ? this.#whole('timer') : null
  }

  reset() {
    this.#length = 0
    this.#open = this.#settings.first.length === 0
  }

  #seek() {
    const { first } = this.#settings
    const isFirst = this.#endsWith(first)
    if (!isFirst && this.#length < this.#taken.length) return null
    this.#counts.skipped += this.#length - first.length
    this.#taken.copyWithin(0, this.#length - first.length, this.#length)
    this.#length = isFirst ? 0 : first.length
    this.#open = isFirst
    return null
  }

  #endsWith(pattern) {
    const start = this.#length - pattern.length
    if (pattern.length === 0 || start < 0) return false
    for (let n = 0; n < pattern.length; n++) if (this.#taken[start + n] !== pattern[n]) return false
    // half a byte too few or too many hides the complete code
    return !this.#settings.asciiBinary || this.#frames || this.#length % 2 === 0
  }

  #whole(by) {
    const { asciiBinary, storeEnd, last, end } = this.#settings
    const closed = by === 'code' || by === 'frame'
    const length = this.#length - (closed ? this.#close.length : 0)
    const body = Buffer.from(Array.from(this.#taken.subarray(0, length), plain))
    this.reset()
    const bytes = asciiBinary ? fromHex(body) : body
    const stored = closed && storeEnd ? [this.#frames ? last : end] : []
    return { by, bytes: bytes && Buffer.concat([bytes, ...stored]), frames: this.#frames }
  }
}

/**
 * Bidirectional protocol: `ENQ, length (2, low first), data, sum (2, low first)` and the answers to our own messages. Only the sum is neither
 * converted nor made transparent; it counts the characters as they are sent, without transparent codes.
 */
class BidirectionalFraming {
  #settings
  #counts
  /** characters a byte */
  #wide
  /** @type {number[]} */
  #taken = []
  /** of the data, in bytes; -1: not known yet */
  #size = -1

  /** @param {any} settings of c24-settings.js @param {{ skipped: number }} counts */
  constructor(settings, counts) {
    this.#settings = settings
    this.#counts = counts
    this.#wide = settings.asciiBinary ? 2 : 1
  }

  /**
   * @param {number} value a byte, or LITERAL + a byte
   * @returns {any} a message `{ by: 'length', bytes }`, `{ refuse: code }`, or an answer `{ answer: 'ack' }`, `{ answer: 'nak', code }`
   */
  feed(value) {
    if (this.#taken.length === 0) return this.#begin(value)
    this.#taken.push(plain(value))
    if (this.#taken[0] === ENQ) return this.#message()
    if (this.#taken.length < this.#headEnd) return null
    return this.#finish({ answer: 'nak', code: this.#part(1, this.#headEnd)?.readUInt16LE(0) ?? 0 })
  }

  cut() {
    return this.#finish(this.#taken[0] === ENQ ? { refuse: CODES.timeout } : null)
  }

  reset() {
    this.#finish(null)
  }

  /** Whether this byte is the first one of a message. @param {number} value */
  starts(value) {
    return this.#taken.length === 0 && value === ENQ
  }

  /** Whether the next byte is one of a sum. */
  bare() {
    return this.#size >= 0 && this.#taken.length >= this.#dataEnd
  }

  get #headEnd() {
    return 1 + 2 * this.#wide
  }

  get #dataEnd() {
    return this.#headEnd + this.#size * this.#wide
  }

  #finish(result) {
    this.#taken = []
    this.#size = -1
    return result
  }

  #part(from, to) {
    const characters = Buffer.from(this.#taken.slice(from, to))
    return this.#settings.asciiBinary ? fromHex(characters) : characters
  }

  #begin(value) {
    if (value === ACK) return { answer: 'ack' }
    if (value === ENQ || value === NAK) this.#taken = [value]
    else this.#counts.skipped++
    return null
  }

  #measure() {
    const { unit, mostBytes } = this.#settings
    const head = this.#part(1, this.#headEnd)
    if (!head) return this.#finish({ refuse: CODES.hex })
    this.#size = head.readUInt16LE(0) * (unit === 'word' ? 2 : 1)
    if (this.#size === 0) return this.#finish({ refuse: CODES.head })
    return this.#size > mostBytes ? this.#finish({ refuse: CODES.length }) : null
  }

  #message() {
    const { sumCheck } = this.#settings
    if (this.#size < 0) return this.#taken.length < this.#headEnd ? null : this.#measure()
    if (this.#taken.length < this.#dataEnd + (sumCheck ? 2 : 0)) return null
    const sum = this.#taken.slice(1, this.#dataEnd).reduce((total, byte) => total + byte, 0) & 0xffff
    const [low, high] = sumCheck ? this.#taken.slice(-2) : [sum & 255, sum >> 8]
    if (low + high * 256 !== sum) return this.#finish({ refuse: CODES.sum })
    const bytes = this.#part(this.#headEnd, this.#dataEnd)
    return this.#finish(bytes ? { by: 'length', bytes } : { refuse: CODES.hex })
  }
}

/**
 * @typedef {{ by: 'code'|'frame'|'count'|'timer'|'length', bytes: Buffer | null, frames?: boolean }} Taken null: cannot be converted
 */

module.exports = { BidirectionalFraming, FreeFraming }
