'use strict'
const { PlcError } = require('../../error')
const { crc16 } = require('../crc16')

/**
 * `DA SA FN LEN INFO[LEN] CRC-L CRC-H`; manual "Structure of Communication Frames".
 * @typedef {{ to: number, from: number, fn: number, info: Buffer }} Frame
 */

const HEADER = 4
const OVERHEAD = 6
const MOST_INFO = 256
const SHORTEST = OVERHEAD + 1
const LONGEST = OVERHEAD + MOST_INFO

/**
 * The bytes of one frame.
 * @param {{ to: number, from: number, fn: number, info: ArrayLike<number> }} frame bytes 0..255; `info` 1..256 bytes
 * @returns {Buffer} 7..262 bytes
 * @throws {PlcError} FRAME_TOO_LONG, BAD_SETTING
 */
function encodeFrame({ to, from, fn, info }) {
  byte('to', to)
  byte('from', from)
  byte('fn', fn)
  const length = info.length
  if (!(length >= 1))
    throw new PlcError('BAD_SETTING', { setting: 'info', value: 'empty', reason: 'LEN 0 means 256 bytes' })
  if (length > MOST_INFO) throw new PlcError('FRAME_TOO_LONG', { what: 'INFO', got: length, most: MOST_INFO })
  const bytes = Buffer.allocUnsafe(length + OVERHEAD)
  bytes[0] = to
  bytes[1] = from
  bytes[2] = fn
  bytes[3] = length & 0xff // 256 becomes 0
  bytes.set(info, HEADER)
  bytes.writeUInt16LE(crc16(bytes, 0, length + HEADER), length + HEADER)
  return bytes
}

function byte(setting, value) {
  if (!Number.isInteger(value) || value < 0 || value > 0xff) {
    throw new PlcError('BAD_SETTING', { setting, value, reason: 'it must be a byte, 0 to 255' })
  }
}

/**
 * How long a frame is that begins at `start`.
 * @param {Uint8Array} bytes
 * @param {number} [start]
 * @returns {number} 7..262 bytes, or 0 while LEN has not come
 */
function frameLength(bytes, start = 0) {
  return bytes.length - start < HEADER ? 0 : (bytes[start + 3] || MOST_INFO) + OVERHEAD
}

/**
 * Whether the CRC of a complete frame fits.
 * @param {Uint8Array} bytes
 * @param {number} start
 * @param {number} length of the frame
 * @returns {boolean}
 */
function crcFits(bytes, start, length) {
  const end = start + length - 2
  return crc16(bytes, start, end) === (bytes[end] | (bytes[end + 1] << 8))
}

/**
 * The frame that begins at `start`; bytes after it are left alone.
 * @param {Uint8Array} bytes
 * @param {number} [start]
 * @returns {Frame & { length: number } | null} `length` in bytes; `info` shares memory with `bytes`; null: incomplete ({@link frameLength}
 *   tells) or damaged
 */
function decodeFrame(bytes, start = 0) {
  const length = frameLength(bytes, start)
  return length > 0 && bytes.length - start >= length && crcFits(bytes, start, length) ? openFrame(bytes, start) : null
}

/**
 * The same for a frame that a match has accepted: its length and its CRC are not looked at again.
 * @param {Uint8Array} bytes
 * @param {number} [start]
 * @returns {Frame & { length: number }}
 */
function openFrame(bytes, start = 0) {
  const length = frameLength(bytes, start)
  const info = Buffer.from(bytes.buffer, bytes.byteOffset + start + HEADER, length - OVERHEAD)
  return { to: bytes[start], from: bytes[start + 1], fn: bytes[start + 2], info, length }
}

module.exports = {
  SHORTEST,
  LONGEST,
  MOST_INFO,
  HEADER,
  OVERHEAD,
  encodeFrame,
  frameLength,
  crcFits,
  decodeFrame,
  openFrame
}
