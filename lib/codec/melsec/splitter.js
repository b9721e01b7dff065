'use strict'

/** Bytes of a C24 port -> messages of the non-procedure protocol. Pure: no clock. */

const { hexDigit, toAscii } = require('./ascii-binary')

/** Bytes that are kept of what is not part of a message, before the last of them are looked at again. */
const SLACK = 64

const HUNT = 'hunt' // for the first frame
const BODY = 'body'
const SKIP = 'skip' // the rest of a message that was given up

/** Bytes that grow at the end, up to what a message may have. */
class Tail {
  #bytes
  length = 0
  /** how many of the last bytes stand as they came: no additional code made them data */
  #plain = 0

  constructor() {
    this.#bytes = Buffer.alloc(256)
  }

  add(byte, literal) {
    if (this.length === this.#bytes.length) this.#bytes = Buffer.concat([this.#bytes, Buffer.alloc(this.length)])
    this.#bytes[this.length++] = byte
    this.#plain = literal ? 0 : this.#plain + 1
  }

  /** @param {Buffer} marker */
  endsWith(marker) {
    const { length } = marker
    if (length === 0 || this.#plain < length || this.#bytes[this.length - 1] !== marker[length - 1]) return false
    for (let n = 2; n <= length; n++) if (this.#bytes[this.length - n] !== marker[length - n]) return false
    return true
  }

  /** @param {number} length of the first bytes */
  copy(length) {
    return Buffer.from(this.#bytes.subarray(0, Math.min(length, this.length)))
  }

  /** All but the last bytes are forgotten. @param {number} count */
  keep(count) {
    const kept = Math.min(count, this.length)
    this.#bytes.copyWithin(0, this.length - kept, this.length)
    this.length = kept
  }

  clear() {
    this.length = 0
    this.#plain = 0
    if (this.#bytes.length > 65536) this.#bytes = Buffer.alloc(256)
  }
}

/**
 * @typedef {object} Message
 * @property {'data'|'damaged'} kind
 * @property {Buffer} bytes the body: without end code, user frames and additional codes
 * @property {boolean} complete
 * @property {string} [reason] of what is not complete: `silence` it stopped, `closed` the port did, `tooLong`, `notHex` (ASCII-binary), `odd`
 *   (half a byte, or an additional code, at its end), `cut` a first frame stands inside, `stray` bytes outside a message
 * @property {boolean} [afterOpen] the first one after the port was opened: where no first frame is used, its beginning may be missing
 */

class MessageSplitter {
  #format
  #marker
  #first
  #hexMarker
  #hexFirst
  #tail = new Tail()
  #state = BODY
  #begun = false
  #escape = false
  #nibble = -1
  #afterOpen = true
  /** @type {Message[]} */
  #out = []

  /** @param {any} format of `messageFormat` */
  constructor(format) {
    this.#format = format
    this.#marker = format.marker
    this.#first = format.first
    this.#hexMarker = toAscii(format.marker)
    this.#hexFirst = toAscii(format.first)
    this.silence = format.silence
    this.#start()
  }

  /** Bytes of a message that has begun. */
  get held() {
    const half = (this.#nibble >= 0 ? 1 : 0) + (this.#escape ? 1 : 0)
    return this.#tail.length + half + (this.#state === SKIP || this.#begun ? 1 : 0)
  }

  /** @param {Buffer} bytes @returns {Message[]} */
  push(bytes) {
    const { additional, asciiBinary } = this.#format
    for (const byte of bytes) {
      const literal = this.#escape
      this.#escape = !literal && byte === additional
      // hexadecimal characters are data already: conversion comes behind the removal of additional codes
      if (!this.#escape) this.#character(byte, literal && !asciiBinary)
    }
    return this.#taken()
  }

  /** `silence` ms have passed without a byte. @returns {Message[]} */
  flush() {
    const whole = this.#format.framing === 'gap' && !this.#escape && this.#nibble < 0
    if (whole && this.#state === BODY && this.#tail.length > 0) this.#complete(0)
    else this.#giveUp(this.#nibble >= 0 || this.#escape ? 'odd' : 'silence')
    return this.#taken()
  }

  /** The port was opened anew: what is held is not continued. @returns {Message[]} */
  reset() {
    this.#giveUp('closed')
    this.#afterOpen = true
    return this.#taken()
  }

  #taken() {
    const out = this.#out
    this.#out = []
    return out
  }

  #start(state = this.#first.length > 0 ? HUNT : BODY) {
    this.#tail.clear()
    this.#state = state
    this.#begun = false
    this.#escape = false
    this.#nibble = -1
  }

  #emit(kind, bytes, more) {
    const afterOpen = this.#afterOpen && this.#first.length === 0 ? { afterOpen: true } : {}
    this.#out.push({ kind, bytes, ...more, ...afterOpen })
    this.#afterOpen = false
  }

  #complete(behind) {
    this.#emit('data', this.#tail.copy(this.#tail.length - behind), { complete: true })
    this.#start()
  }

  #damaged(reason, length = this.#tail.length) {
    const most = Math.min(length, this.#format.most)
    this.#emit('damaged', this.#tail.copy(most), { complete: false, reason })
  }

  #giveUp(reason) {
    if (this.#state === HUNT && this.#tail.length > 0) this.#damaged('stray')
    if (this.#state === BODY && this.held > 0) this.#damaged(reason)
    this.#start()
  }

  /** With ASCII-binary conversion only a body is converted: where one begins or ends is looked for at every character. */
  #character(byte, literal) {
    if (this.#state === HUNT) return this.#hunt(byte, literal)
    if (this.#state === SKIP) return this.#skip(byte, literal)
    if (!this.#format.asciiBinary) return this.#body(byte, literal)
    const digit = hexDigit(byte)
    if (digit < 0) {
      this.#damaged('notHex')
      this.#start(SKIP)
    } else if (this.#nibble < 0) {
      this.#nibble = digit
    } else {
      const whole = (this.#nibble << 4) | digit
      this.#nibble = -1
      this.#body(whole, literal)
    }
  }

  #ended(length) {
    if (length <= this.#format.most) return this.#complete(this.#marker.length)
    this.#damaged('tooLong', length)
    this.#start()
  }

  #hunt(byte, literal) {
    const first = this.#format.asciiBinary ? this.#hexFirst : this.#first
    const { most } = this.#format
    this.#tail.add(byte, literal)
    if (this.#tail.endsWith(first)) {
      const stray = this.#tail.length - first.length
      if (stray > 0) this.#damaged('stray', stray)
      this.#start(BODY)
      this.#begun = true
    } else if (this.#tail.length >= most + first.length) {
      this.#damaged('stray', most)
      this.#tail.keep(first.length)
    }
  }

  #skip(byte, literal) {
    const { asciiBinary, framing } = this.#format
    const [marker, first] = asciiBinary ? [this.#hexMarker, this.#hexFirst] : [this.#marker, this.#first]
    this.#tail.add(byte, literal)
    if (this.#tail.endsWith(marker)) return this.#start()
    if (framing === 'end' && this.#tail.endsWith(first)) {
      this.#start(BODY)
      this.#begun = true
    } else if (this.#tail.length > SLACK + marker.length + first.length) {
      this.#tail.keep(Math.max(marker.length, first.length))
    }
  }

  #body(byte, literal) {
    const { framing, count, most } = this.#format
    const marker = this.#marker
    this.#tail.add(byte, literal)
    const { length } = this.#tail
    if (this.#tail.endsWith(marker)) return this.#ended(length - marker.length)
    if (framing === 'count' && length === count) return this.#complete(0)
    if (marker.length > 0 && framing !== 'count' && this.#tail.endsWith(this.#first)) {
      this.#damaged('cut', length - this.#first.length)
      this.#start(BODY)
      this.#begun = true
    } else if (length > most + marker.length) {
      this.#damaged('tooLong', most)
      this.#skipRest()
    }
  }

  /** Its last bytes may be the first ones of what ends it, or of the next first frame. */
  #skipRest() {
    const kept = Math.max(this.#marker.length, this.#first.length)
    this.#tail.keep(kept)
    this.#begun = false
    this.#state = SKIP
    if (!this.#format.asciiBinary) return
    const characters = toAscii(this.#tail.copy(kept))
    this.#tail.clear()
    for (const character of characters) this.#tail.add(character, false)
  }
}

module.exports = { MessageSplitter }
