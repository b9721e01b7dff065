'use strict'

/** Values of messages <-> bytes: text, bytes, or words with their low byte first. Pure. */

const { PlcError } = require('../../error')

const FORMATS = Object.freeze(['text', 'bytes', 'words'])

/** Encodings of one or two bytes a character that Node.js can only decode: the table is turned round at the first use. */
const TWO_BYTES = Object.freeze({
  'euc-kr': { leads: [[0x81, 0xfe]], singles: null },
  // ED and EE repeat characters of FA to FC
  // prettier-ignore
  shift_jis: { leads: [[0x81, 0x9f], [0xe0, 0xec], [0xef, 0xfc]], singles: [0xa1, 0xdf] }
})
/** @type {Record<string, number>} */
const HIGHEST = { ascii: 0x7f, latin1: 0xff }
const ENCODINGS = Object.freeze(['latin1', 'utf8', 'ascii', ...Object.keys(TWO_BYTES)])
const REPLACEMENT = '\ufffd'
const LINE_END = 0x0a

const bad = (value, reason) => new PlcError('BAD_VALUE', { item: 'the message', value, reason })

const decoderOf = encoding => new TextDecoder(encoding, { ignoreBOM: true })

/** The code points of an encoding -> its bytes. */
const turnedRound = encoding => {
  const { leads, singles } = TWO_BYTES[encoding]
  const rows = []
  for (let byte = 0; byte < 0x80; byte++) if (byte !== LINE_END) rows.push([byte])
  for (let byte = singles?.[0] ?? 1; byte <= (singles?.[1] ?? 0); byte++) rows.push([byte])
  for (const [from, to] of leads) {
    for (let lead = from; lead <= to; lead++) for (let trail = 0x40; trail <= 0xfe; trail++) rows.push([lead, trail])
  }
  // line ends keep the rows apart, also behind a pair that does not exist
  const texts = decoderOf(encoding)
    .decode(Buffer.from(rows.flatMap(row => [...row, LINE_END])))
    .split('\n')
  const table = new Map([['\n', [LINE_END]]])
  rows.forEach((row, n) => {
    const text = texts[n]
    if ([...text].length === 1 && text !== REPLACEMENT && !table.has(text)) table.set(text, row)
  })
  return table
}

const tables = new Map()
const tableOf = encoding => {
  if (!tables.has(encoding)) tables.set(encoding, turnedRound(encoding))
  return tables.get(encoding)
}

/**
 * @param {string} text
 * @param {string} encoding one of ENCODINGS
 * @returns {Buffer}
 * @throws {PlcError} BAD_VALUE: a character that the encoding does not have
 */
const encodeText = (text, encoding) => {
  const missing = character => bad(text, `"${character}" cannot be written in ${encoding}`)
  if (encoding === 'utf8') {
    // half of a pair of surrogates would go out as a replacement character
    if (/\p{Surrogate}/u.test(text)) throw bad('text', 'it has half a character')
    return Buffer.from(text, 'utf8')
  }
  if (HIGHEST[encoding] !== undefined) {
    for (const character of text) if (Number(character.codePointAt(0)) > HIGHEST[encoding]) throw missing(character)
    return Buffer.from(text, 'latin1')
  }
  const table = tableOf(encoding)
  const bytes = []
  for (const character of text) {
    const row = table.get(character)
    if (!row) throw missing(character)
    bytes.push(...row)
  }
  return Buffer.from(bytes)
}

/**
 * @param {Buffer} bytes
 * @param {string} encoding one of ENCODINGS
 * @returns {{ text: string, valid: boolean }} not valid: some bytes are no characters of the encoding
 */
const decodeText = (bytes, encoding) => {
  if (encoding === 'latin1') return { text: bytes.toString('latin1'), valid: true }
  if (encoding === 'ascii') {
    const valid = bytes.every(byte => byte < 0x80)
    // Node.js would drop the eighth bit and show another character
    return {
      text: valid ? bytes.toString('latin1') : bytes.toString('latin1').replace(/[\x80-\xff]/g, REPLACEMENT),
      valid
    }
  }
  const text = decoderOf(encoding).decode(bytes)
  return { text, valid: !text.includes(REPLACEMENT) || encodesBack(text, bytes, encoding) }
}

/** The replacement character itself may stand in UTF-8. */
const encodesBack = (text, bytes, encoding) => encoding === 'utf8' && Buffer.from(text, 'utf8').equals(bytes)

const numbersOf = (value, { what, least, most }) =>
  value.map(number => {
    if (Number.isInteger(number) && number >= least && number <= most) return number
    throw bad(value, `${what} are whole numbers from ${least} to ${most}`)
  })

/**
 * Words as bytes, low byte first; negative numbers as two's complement.
 * @param {number[]} words -32768 to 65535 each
 * @returns {Buffer}
 * @throws {PlcError} BAD_VALUE
 */
const wordsToBytes = words => {
  const checked = numbersOf(words, { what: 'words', least: -0x8000, most: 0xffff })
  const bytes = Buffer.alloc(checked.length * 2)
  checked.forEach((word, n) => bytes.writeUInt16LE(word & 0xffff, n * 2))
  return bytes
}

/**
 * Bytes as words, low byte first; an odd last byte gets 00H as its upper one, as the module does (user's manual, 6.1.1).
 * @param {Buffer} bytes
 * @returns {number[]}
 */
const bytesToWords = bytes =>
  Array.from({ length: Math.ceil(bytes.length / 2) }, (_, n) => bytes[2 * n] | ((bytes[2 * n + 1] ?? 0) << 8))

const isList = value => Array.isArray(value) || (ArrayBuffer.isView(value) && !(value instanceof DataView))

/** By their places: what a list says of its own iteration may never end. */
const listOf = value => (isList(value) ? Array.from({ length: value.length }, (_, n) => value[n]) : null)

/** Bytes that a value needs at least: before anything of it is copied, since an array may be long on paper only. */
const leastBytes = (value, format) => {
  if (typeof value === 'string' || value instanceof Uint8Array) return value.length
  return isList(value) ? value.length * (format === 'words' ? 2 : 1) : 0
}

/** @type {Record<string, (value: any, encoding: string) => Buffer>} */
const READERS = {
  text: (value, encoding) => {
    if (typeof value === 'string') return encodeText(value, encoding)
    if (typeof value === 'number' && Number.isFinite(value)) return encodeText(String(value), encoding)
    throw bad(value, 'text, a number or a Buffer is needed; for an array of numbers choose the format bytes or words')
  },
  bytes: value => {
    const list = listOf(value)
    if (!list) throw bad(value, 'a Buffer or an array of bytes is needed')
    return Buffer.from(numbersOf(list, { what: 'bytes', least: 0, most: 255 }))
  },
  words: value => {
    const list = typeof value === 'number' ? [value] : listOf(value)
    if (!list) throw bad(value, 'an array of words, one word or a Buffer is needed')
    return wordsToBytes(list)
  }
}

/**
 * What a flow wants to send, as bytes. A Buffer (or Uint8Array) is taken as it is in every format.
 * @param {unknown} value text: a string or a number; bytes: an array of 0 to 255; words: an array of -32768 to 65535, or one
 * @param {{ format: string, encoding: string, most?: number }} options of FORMATS and ENCODINGS; most: bytes of a message
 * @returns {Buffer}
 * @throws {PlcError} BAD_VALUE, FRAME_TOO_LONG
 */
const valueToBytes = (value, { format, encoding, most = Infinity }) => {
  const got = leastBytes(value, format)
  if (got > most) throw new PlcError('FRAME_TOO_LONG', { what: 'the message', got, most })
  if (value instanceof Uint8Array) return Buffer.from(value)
  return READERS[format](value, encoding)
}

/**
 * The body of a message as the value a flow gets.
 * @param {Buffer} bytes
 * @param {{ format: string, encoding: string }} options
 * @returns {{ value: string | Buffer | number[], text: string, valid: boolean }}
 */
const bytesToValue = (bytes, { format, encoding }) => {
  const { text, valid } = decodeText(bytes, encoding)
  if (format === 'text') return { value: text, text, valid }
  return { value: format === 'words' ? bytesToWords(bytes) : bytes, text, valid: true }
}

module.exports = {
  ENCODINGS,
  FORMATS,
  bytesToValue,
  bytesToWords,
  decodeText,
  encodeText,
  valueToBytes,
  wordsToBytes
}
