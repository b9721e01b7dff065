'use strict'
const { PlcError } = require('../../error')
const { readAcknowledged } = require('./acknowledge')
const { OVERHEAD, START, missingBetween, seal, unseal } = require('./check')

/**
 * Lines of text from and to an INCON-M84/M86/M86R, section 2.14.3 "Send and Receive". They end with a line feed; a carriage return before it
 * does not belong to the text, and an empty line is none. The controller's buffers hold 256 bytes.
 *
 * @typedef {object} Message
 * @property {'data'|'damaged'|'ack'|'start'} kind damaged: some of its bytes are certainly not what was sent; ack, start: acknowledge.js
 * @property {Buffer} bytes without line end; in the checked format without number and check, unless damaged
 * @property {boolean} complete that it is one whole line, as far as can be known
 * @property {Reason} [reason] why it is not
 * @property {number|null} [number] checked format: of the line, or null if it has none
 * @property {number} [lost] checked format: lines that are missing before this one
 * @property {boolean} [repeated] checked format: it is the line before once more
 * @typedef {'silence'|'full'|'tail'|'noLineFeed'|'unprintable'|'noCheck'|'check'|'number'|'reopened'} Reason silence: no line feed within the silence;
 *   full: as many bytes as a buffer holds, without one; tail: the rest of such a line; noLineFeed: a carriage return without one
 */

const LF = 0x0a
const CR = 0x0d
const TAB = 0x09
const BUFFER = 256
const MOST_SENT = 255 // with line end: the manual's strCopy writes past its array at 256
const END = Buffer.of(CR, LF)

const isPrintable = byte => byte >= 0x20 && byte <= 0x7e

/** What a line becomes in the plain format. With `ascii` other bytes can only be damage. @returns {Message} */
const plain = (bytes, reason, { ascii }) => {
  const printable = !ascii || bytes.every(byte => isPrintable(byte) || byte === TAB)
  if (!printable) return { kind: 'damaged', bytes, complete: false, reason: reason ?? 'unprintable' }
  return reason ? { kind: 'data', bytes, complete: false, reason } : { kind: 'data', bytes, complete: true }
}

/** The checked format: remembers the line before. */
const createChecker = () => {
  /** @type {{ number: number|null, text: Buffer } | null} */
  let last = null
  /** @returns {Message} */
  const read = (bytes, reason) => {
    if (reason) return { kind: 'damaged', bytes, complete: false, reason }
    const opened = unseal(bytes)
    if ('reason' in opened) return { kind: 'damaged', bytes, complete: false, reason: opened.reason }
    const { text, number } = opened
    // two starts may well begin with the same words
    const again = number !== null && number !== START && number === last?.number && text.equals(last.text)
    if (again) return { kind: 'data', bytes: text, complete: true, number, lost: 0, repeated: true }
    const lost = missingBetween(last?.number ?? null, number)
    if (number !== null) last = { number, text }
    return { kind: 'data', bytes: text, complete: true, number, lost }
  }
  return read
}

/** The acknowledged format: what a line says is judged by the device, whose memory outlives the splitter. @returns {Message} */
const acknowledged = (bytes, reason) => {
  if (reason) return { kind: 'damaged', bytes, complete: false, reason }
  const opened = readAcknowledged(bytes)
  if (opened.kind === 'damaged') return { kind: 'damaged', bytes, complete: false, reason: opened.reason }
  const { kind, number } = opened
  if (kind === 'line') return { kind: 'data', bytes: opened.text, complete: true, number }
  return { kind, bytes, complete: true, number }
}

/** Cuts what comes from a controller into lines. Made by {@link createLineSplitter}. */
class LineSplitter {
  #most
  #read
  /** @type {number[]} */
  #line = []
  #isTail = false

  /** @param {{ most: number, silence: number, read: (bytes: Buffer, reason?: Reason) => Message }} options */
  constructor({ most, silence, read }) {
    this.#most = most
    this.#read = read
    this.silence = silence
  }

  /** Bytes of a line that is not over. */
  get held() {
    return this.#line.length
  }

  /** @param {Uint8Array} bytes @returns {Message[]} */
  push(bytes) {
    return Array.from(bytes).flatMap(byte => this.#take(byte))
  }

  /** The silence is over: what is held is a torn line. */
  flush() {
    return this.#close('silence')
  }

  /** The port was opened anew. */
  reset() {
    return this.#close('reopened')
  }

  #take(byte) {
    if (byte === LF) return this.#close(this.#isTail ? 'tail' : undefined)
    const line = this.#line
    // a line feed was lost here: what follows is another line
    const before = line[line.length - 1] === CR ? this.#close(this.#isTail ? 'tail' : 'noLineFeed') : []
    this.#line.push(byte)
    if (this.#line.length < this.#most) return before
    const full = [...before, ...this.#close('full')]
    this.#isTail = true
    return full
  }

  /** @param {Reason} [reason] why it is not a whole line @returns {Message[]} */
  #close(reason) {
    const line = this.#line
    if (line[line.length - 1] === CR) line.pop()
    this.#line = []
    this.#isTail = false
    return line.length > 0 ? [this.#read(Buffer.from(line), reason)] : []
  }
}

/**
 * @typedef {object} Cut how lines are cut
 * @property {number} [most] bytes of a line with its end (256)
 * @property {number} [silence] ms after which a line is taken as torn (200; 0: never)
 * @property {boolean} [ascii] only printable ASCII can come (true)
 * @property {boolean} [checked] `#NN text*HH` (check.js)
 * @property {boolean} [acknowledge] checked, and acknowledged (acknowledge.js)
 */

/** @param {Cut} [options] */
const createLineSplitter = ({
  most = BUFFER,
  silence = 200,
  ascii = true,
  checked = false,
  acknowledge = false
} = {}) => {
  const read = (bytes, reason) => plain(bytes, reason, { ascii })
  return new LineSplitter({ most, silence, read: acknowledge ? acknowledged : checked ? createChecker() : read })
}

/**
 * How lines are cut, for `lease.listen`. The same key means the same lines.
 * @param {Cut} [options]
 * @returns {{ key: string, create: () => LineSplitter }}
 */
const inconFraming = ({ most = BUFFER, silence = 200, ascii = true, checked = false, acknowledge = false } = {}) => {
  const more = [...(ascii ? ['ASCII'] : []), ...(acknowledge ? ['acknowledged'] : checked ? ['checked'] : [])]
  return {
    key: [`INCON lines of ${most} bytes`, `torn after ${silence} ms`, ...more].join(', '),
    create: () => createLineSplitter({ most, silence, ascii, checked, acknowledge })
  }
}

const refusal = (value, reason) => new PlcError('BAD_VALUE', { item: 'the line', value, reason })

const nameOf = byte => `${byte.toString(16).toUpperCase().padStart(2, '0')}h`

/** @returns {Buffer} the bytes of a text or of bytes, without the line end that it may have */
const bodyOf = (value, encoding) => {
  if (typeof value === 'number' && Number.isFinite(value)) return Buffer.from(String(value))
  if (typeof value !== 'string' && !(value instanceof Uint8Array)) {
    throw refusal(value, 'it must be text, a number or bytes')
  }
  if (typeof value !== 'string') return withoutEnd(Buffer.from(value))
  // half of a pair of surrogates would go out as a replacement character
  if (/\p{Surrogate}/u.test(value)) throw refusal('text', 'it has half a character')
  const text = withoutEnd(Buffer.from(value, encoding === 'ascii' ? 'utf8' : encoding))
  const strange = text.find(byte => byte < 0x20 || byte === 0x7f || (encoding === 'ascii' && byte > 0x7e))
  if (strange !== undefined)
    throw refusal(
      value,
      `${strange > 0x7f ? 'a letter beyond ASCII' : nameOf(strange)} is no printable ASCII; send it as bytes`
    )
  if (encoding === 'latin1' && text.toString('latin1') !== value.replace(/\r?\n$/, '')) {
    throw refusal(value, 'it has letters that latin1 does not have')
  }
  return text
}

const withoutEnd = bytes => {
  if (bytes[bytes.length - 1] !== LF) return bytes
  return bytes.subarray(0, bytes[bytes.length - 2] === CR ? -2 : -1)
}

/**
 * One line for the controller, closed by CR LF.
 *
 * @param {string|number|Uint8Array} value text, or bytes as they are; one line end at its end is taken off
 * @param {{ encoding?: 'ascii'|'latin1'|'utf8', checked?: boolean, number?: number }} [options] encoding of text ('ascii'); number: of the line
 *   in the checked format, 0..99
 * @returns {Buffer} at most 255 bytes
 * @throws {PlcError} BAD_VALUE (empty, a NUL or line feed inside, text that is not printable), FRAME_TOO_LONG
 */
const encodeLine = (value, { encoding = 'ascii', checked = false, number = START } = {}) => {
  const most = MOST_SENT - END.length - (checked ? OVERHEAD : 0)
  const tooLong = got => new PlcError('FRAME_TOO_LONG', { what: 'the line', got, most })
  // what is far too long is not even looked at
  const given = typeof value === 'string' || value instanceof Uint8Array ? value.length : 0
  if (given > MOST_SENT) throw tooLong(given)
  const body = bodyOf(value, encoding)
  if (body.length === 0) throw refusal(value, 'an empty line is no message')
  // the manual's strCopy ends at a NUL, and the controller at a line feed
  const forbidden = body.find(byte => byte === 0 || byte === LF)
  if (forbidden !== undefined)
    throw refusal(value, `${nameOf(forbidden)} (${forbidden ? 'line feed' : 'NUL'}) cannot be inside a line`)
  if (body.length > most) throw tooLong(body.length)
  return Buffer.concat([checked ? seal(body, number) : body, END])
}

module.exports = { BUFFER, MOST_SENT, createLineSplitter, encodeLine, inconFraming }
