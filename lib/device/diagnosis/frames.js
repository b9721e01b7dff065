'use strict'
const { crc16 } = require('../../codec/crc16')
const { decodeFrame } = require('../../codec/nx/frame')

/**
 * Frames of any protocol among bytes that nobody asked for. Hunting for whatever a checksum fits is no way to read values (a false frame in
 * 65,536 places); for a diagnosis, which only says who may be speaking, it is.
 *
 * @typedef {object} Found
 * @property {'nx'|'rtu'|'ascii'} protocol
 * @property {number} station who speaks; in a query: who is asked
 * @property {boolean} query a master sent it
 * @property {number} [to] NX: whom it is for
 * @property {7} [dataBits] it was sent with 7 data bits and parity, and read with 8
 * @property {number} at @property {number} length
 */

const ANSWER = 0x80
const LEAST_MASTER = 192
const MOST_STATION = 247
const READS = [1, 2, 3, 4]
const WRITES = [15, 16]
const KNOWN = [...READS, 5, 6, ...WRITES]

const fits = (bytes, at, length) => {
  const end = at + length - 2
  return end + 2 <= bytes.length && crc16(bytes, at, end) === (bytes[end] | (bytes[end + 1] << 8))
}

/** @returns {Found | null} */
function nxAt(bytes, at) {
  const frame = decodeFrame(bytes, at)
  if (!frame) return null
  // answers have the highest bit; but "no service" is 00, and so is the RR of a master
  const query = frame.fn < ANSWER && frame.to < LEAST_MASTER
  const station = query ? frame.to : frame.from
  return { protocol: 'nx', station, query, to: frame.to, at, length: frame.length }
}

/** Lengths that a frame of this function may have, and whether it is a query then. */
function* rtuLengths(bytes, at) {
  const fn = bytes[at + 1]
  if (fn >= 0x80) return KNOWN.includes(fn - 0x80) ? yield [5, false] : undefined
  if (!KNOWN.includes(fn)) return
  // an answer to 05 and 06 equals its query
  if (READS.includes(fn) && bytes[at + 2] > 0) yield [5 + bytes[at + 2], false]
  yield [8, READS.includes(fn)]
  if (WRITES.includes(fn)) yield [9 + bytes[at + 6], true]
}

/** @returns {Found | null} */
function rtuAt(bytes, at) {
  if (bytes.length - at < 5 || bytes[at] > MOST_STATION) return null
  for (const [length, query] of rtuLengths(bytes, at)) {
    if (fits(bytes, at, length)) return { protocol: 'rtu', station: bytes[at], query, at, length }
  }
  return null
}

const ASCII = /:((?:[0-9A-F]{2}){4,})\r\n/gi

/** @returns {Found[]} */
function asciiIn(bytes, more = {}) {
  const text = Buffer.from(bytes).toString('latin1')
  return [...text.matchAll(ASCII)].flatMap(({ 0: whole, 1: hex, index: at }) => {
    const body = Buffer.from(hex, 'hex')
    if (body.reduce((sum, byte) => (sum + byte) & 0xff, 0) !== 0) return []
    const query = READS.includes(body[1]) && body.length === 7 && body[2] !== 3
    return [{ protocol: 'ascii', station: body[0], query, at, length: whole.length, ...more }]
  })
}

/**
 * @param {Uint8Array} bytes
 * @param {'nx'|'rtu'|'ascii'} expected where bytes can be both, they are this one's
 * @returns {Found[]} in order
 */
function findFrames(bytes, expected) {
  const ascii = asciiIn(bytes)
  // characters of 7 bits with parity, read as 8
  const stripped =
    ascii.length > 0
      ? []
      : asciiIn(
          bytes.map(byte => byte & 0x7f),
          { dataBits: 7 }
        )
  if (ascii.length + stripped.length > 0) return [...ascii, ...stripped]
  const order = expected === 'nx' ? [nxAt, rtuAt] : [rtuAt, nxAt]
  const found = []
  for (let at = 0; at < bytes.length;) {
    const frame = order.reduce((first, look) => first ?? look(bytes, at), /** @type {Found | null} */ (null))
    if (frame) found.push(frame)
    at += frame?.length ?? 1
  }
  return found
}

module.exports = { findFrames }
