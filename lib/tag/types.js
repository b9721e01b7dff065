'use strict'
const { PlcError } = require('../error')
const { toBoolean, toNumber, toText } = require('./convert')

/**
 * The data types: what raw words and bits mean. Pure, and without Buffer: the editor bundles this file.
 * A 32-bit value has its low word first unless `wordOrder` is `high`; a string has its low byte first unless
 * `byteOrder` is `high` (docs/nx.md, "Addresses").
 *
 * @typedef {{ wordOrder?: 'low'|'high', byteOrder?: 'low'|'high' }} Order
 * @typedef {object} Type
 * @property {string} name as written after the colon: `float32`, `string[8]`
 * @property {'bit'|'word'} kind of the addresses it stands on
 * @property {number} words how many words one value takes (a bit: 1 bit)
 * @property {number} [least] smallest value of a number
 * @property {number} [most] largest value of a number
 * @property {boolean} numeric may be scaled
 * @property {boolean} integer takes whole numbers only
 * @property {(raw: any[], order?: Order) => { value: any } | { bad: string }} decode raw words (or one bit) -> value
 * @property {(value: unknown, options?: Order & { item?: string, rounds?: boolean }) => any[]} encode value -> raw
 *   words (or one bit); throws BAD_VALUE or VALUE_OUT_OF_RANGE. `rounds`: a fraction is rounded, not refused.
 */

const MOST_STRING = 256 // 128 words: what one frame can read

const WORD_BYTES = 2
const LONGEST_NUMBER = 2 // words

/** Where numbers are put together, one after the other: thousands are decoded each second. */
const VIEWS = Array.from(
  { length: LONGEST_NUMBER + 1 },
  (_, words) => new DataView(new ArrayBuffer(words * WORD_BYTES))
)

/** To be read at once: the next call writes over it. */
const viewOf = (words, order) => {
  const { length } = words
  const view = VIEWS[length]
  for (let index = 0; index < length; index++) {
    view.setUint16(index * WORD_BYTES, words[order === 'high' ? length - 1 - index : index], true)
  }
  return view
}

const wordsOf = (view, order) => {
  const words = []
  for (let at = 0; at < view.byteLength; at += 2) words.push(view.getUint16(at, true))
  return order === 'high' ? words.reverse() : words
}

const bcdValue = (raw, digits) => {
  let value = 0
  for (let place = digits - 1; place >= 0; place--) {
    const digit = Math.floor(raw / 16 ** place) % 16
    if (digit > 9) return { bad: `${raw.toString(16).toUpperCase().padStart(digits, '0')}h is not BCD` }
    value = value * 10 + digit
  }
  return { value }
}

const bcdRaw = value => parseInt(String(value), 16)

const float = number => {
  if (Number.isFinite(number)) return { value: number }
  return { bad: Number.isNaN(number) ? 'the bits are not a number (NaN)' : 'the bits mean infinity' }
}

// the largest double that still rounds to a finite float32
const MOST_FLOAT = 3.4028234663852886e38

/** @type {[string, number, number, number, boolean, (v: DataView) => any, (v: DataView, x: number) => void][]} */
const NUMBERS = [
  // name, words, least, most, whole, read, write
  ['int16', 1, -0x8000, 0x7fff, true, v => ({ value: v.getInt16(0, true) }), (v, x) => v.setInt16(0, x, true)],
  ['uint16', 1, 0, 0xffff, true, v => ({ value: v.getUint16(0, true) }), (v, x) => v.setUint16(0, x, true)],
  ['int32', 2, -0x80000000, 0x7fffffff, true, v => ({ value: v.getInt32(0, true) }), (v, x) => v.setInt32(0, x, true)],
  ['uint32', 2, 0, 0xffffffff, true, v => ({ value: v.getUint32(0, true) }), (v, x) => v.setUint32(0, x, true)],
  ['float32', 2, -MOST_FLOAT, MOST_FLOAT, false, v => float(v.getFloat32(0, true)), (v, x) => v.setFloat32(0, x, true)],
  ['bcd16', 1, 0, 9999, true, v => bcdValue(v.getUint16(0, true), 4), (v, x) => v.setUint16(0, bcdRaw(x), true)],
  ['bcd32', 2, 0, 99999999, true, v => bcdValue(v.getUint32(0, true), 8), (v, x) => v.setUint32(0, bcdRaw(x), true)]
]

// half away from zero: what an engineer expects of -0.5, and not what Math.round does
const round = number => (number < 0 ? -Math.round(-number) || 0 : Math.round(number))

/** @returns {Type} */
const numberType = ([name, words, least, most, integer, read, write]) => {
  /** @type {Type['encode']} */
  const encode = (value, { item = name, wordOrder, rounds = false } = {}) => {
    const given = toNumber(value, item)
    const number = integer && rounds ? round(given) : given
    if (integer && !Number.isInteger(number)) {
      throw new PlcError('BAD_VALUE', { item, value, reason: `${name} takes whole numbers` })
    }
    if (number < least || number > most) throw new PlcError('VALUE_OUT_OF_RANGE', { item, value, least, most })
    const view = new DataView(new ArrayBuffer(words * 2))
    write(view, number)
    return wordsOf(view, wordOrder)
  }
  const decode = (raw, order = {}) => read(viewOf(raw, order.wordOrder))
  return Object.freeze({ name, kind: 'word', words, least, most, numeric: true, integer, decode, encode })
}

/** @type {Type} */
const BOOL = Object.freeze({
  name: 'bool',
  kind: 'bit',
  words: 1,
  numeric: false,
  integer: false,
  decode: raw => ({ value: raw[0] }),
  encode: (value, { item = 'bool' } = {}) => [toBoolean(value, item)]
})

/**
 * Bytes up to the first NUL, one character each; written texts are filled up with NUL.
 * @param {number} length bytes
 * @returns {Type}
 */
const stringType = length => {
  const words = Math.ceil(length / 2)
  /** @type {Type['decode']} */
  const decode = (raw, { byteOrder } = {}) => {
    let text = ''
    for (let at = 0; at < length; at++) {
      const high = at % 2 === (byteOrder === 'high' ? 0 : 1)
      const byte = high ? raw[at >> 1] >> 8 : raw[at >> 1] & 0xff
      if (byte === 0) break
      text += String.fromCharCode(byte)
    }
    return { value: text }
  }
  /** @type {Type['encode']} */
  const encode = (value, { item = 'string', byteOrder } = {}) => {
    const text = toText(value, item, length)
    const raw = new Array(words).fill(0)
    for (let at = 0; at < text.length; at++) {
      const high = at % 2 === (byteOrder === 'high' ? 0 : 1)
      raw[at >> 1] |= text.charCodeAt(at) << (high ? 8 : 0)
    }
    return raw
  }
  return Object.freeze({
    name: `string[${length}]`,
    kind: 'word',
    words,
    numeric: false,
    integer: false,
    decode,
    encode
  })
}

/** @type {Map<string, Type>} */
const TYPES = new Map()
TYPES.set('bool', BOOL)
for (const row of NUMBERS) TYPES.set(row[0], numberType(row))

/** The names that may stand after the colon, for texts and for the editor's list. */
const TYPE_NAMES = Object.freeze([...TYPES.keys(), 'string[n]'])

/**
 * The type of a name: `bool`, `int16`, `uint16`, `int32`, `uint32`, `float32`, `bcd16`, `bcd32`, `string[n]` with n = 1
 * to 256 bytes. Capitals and blanks around are accepted.
 * @param {unknown} text
 * @returns {Type}
 * @throws {PlcError} BAD_TYPE
 */
const parseType = text => {
  const name = typeof text === 'string' ? text.trim().toLowerCase() : ''
  const known = TYPES.get(name)
  if (known) return known
  const string = /^string\s*\[\s*(\d+)\s*\]$/.exec(name)
  const length = string ? Number(string[1]) : 0
  if (length >= 1 && length <= MOST_STRING) return stringType(length)
  const reason = name.startsWith('string')
    ? `write string[n] with n = 1 to ${MOST_STRING} bytes`
    : 'there is no such type'
  throw new PlcError('BAD_TYPE', { type: text, reason, known: TYPE_NAMES.join(', ') })
}

module.exports = { parseType, round }
