'use strict'

/** The image of a message in the C24's buffer memory: count and words, low byte first (user's manual, 6.1.1 and 6.2). Pure. */

const { PlcError } = require('../../error')
const { bytesToWords } = require('./convert')

/** Words behind the count: the receive area of CH1 is 600H to 7FFH. */
const AREA = 511
const EMPTY = Buffer.alloc(0)

/**
 * What the C24 holds at 600H (received) or 400H (to send) for a message.
 *
 * An odd byte gets 00H in the upper half of its word. In word units the count is rounded up; with user frames it is rounded down,
 * so that the last byte is not counted (application manual, 11.2). Whether the receive complete code is stored and counted is not
 * settled: the data list of the user's manual says no, the application manual's example says yes. So it is a setting.
 * @param {Uint8Array} body without its end code
 * @param {{ unit?: 'word'|'byte', end?: Uint8Array, storeEnd?: boolean, userFrames?: boolean, most?: number }} [options]
 *   most: words behind the count
 * @returns {number[]} count, then the words
 * @throws {PlcError} FRAME_TOO_LONG
 */
const toBufferMemory = (
  body,
  { unit = 'word', end = EMPTY, storeEnd = false, userFrames = false, most = AREA } = {}
) => {
  const bytes = storeEnd ? Buffer.concat([body, end]) : Buffer.from(body)
  const words = bytesToWords(bytes)
  if (words.length > most) {
    throw new PlcError('FRAME_TOO_LONG', { what: 'the message', got: bytes.length, most: most * 2 })
  }
  const counted = userFrames ? Math.floor(bytes.length / 2) : words.length
  return [unit === 'byte' ? bytes.length : counted, ...words]
}

const isWord = value => Number.isInteger(value) && value >= 0 && value <= 0xffff

/**
 * The message of an image. In word units an odd last byte cannot be told from a pair with 00H, unless its end code is stored.
 * @param {number[]} image count, then words, which may be more than counted (the rest of the area)
 * @param {{ unit?: 'word'|'byte', end?: Uint8Array, storeEnd?: boolean }} [options] as for {@link toBufferMemory}
 * @returns {Buffer} the body without its end code
 * @throws {PlcError} BAD_VALUE: not words, or fewer than counted
 */
const fromBufferMemory = (image, { unit = 'word', end = EMPTY, storeEnd = false } = {}) => {
  const bad = reason => new PlcError('BAD_VALUE', { item: 'the buffer memory', value: image, reason })
  if (!Array.isArray(image) || image.length === 0 || !image.every(isWord)) throw bad('a count and words are needed')
  const [count, ...words] = image
  const length = unit === 'byte' ? count : count * 2
  if (words.length < Math.ceil(length / 2)) throw bad(`${count} ${unit}s are counted, ${words.length} words are there`)
  const bytes = Buffer.alloc(words.length * 2)
  words.forEach((word, n) => bytes.writeUInt16LE(word, 2 * n))
  const stored = bytes.subarray(0, length)
  return storeEnd ? withoutEnd(stored, Buffer.from(end), unit) : stored
}

const withoutEnd = (stored, end, unit) => {
  const padded = Buffer.concat([end, Buffer.of(0)])
  const tails = unit === 'word' ? [end, padded] : [end]
  for (const tail of tails) {
    const at = stored.length - tail.length
    if (end.length > 0 && at >= 0 && stored.subarray(at).equals(tail)) return stored.subarray(0, at)
  }
  return stored
}

module.exports = { AREA, fromBufferMemory, toBufferMemory }
