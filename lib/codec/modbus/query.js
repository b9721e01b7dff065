'use strict'
const { PlcError } = require('../../error')
const { crc16 } = require('../crc16')
const { functionByNumber, functionOf } = require('./functions')

/**
 * Requests as plain data, and as RTU frames; panel manual appendix A.
 * @typedef {{ fn: 1|2|3|4, base: number, count: number }
 *   | { fn: 5, base: number, value: boolean }
 *   | { fn: 6, base: number, value: number }
 *   | { fn: 15, base: number, values: boolean[] }
 *   | { fn: 16, base: number, values: number[] }} Query `base`: the number on the wire, 0..65535
 */

const LAST_STATION = 247
const SIZE = 0x10000
const ON = 0xff00
const OFF = 0x0000

/**
 * The RTU frame of a request.
 * @param {Query} query
 * @param {number} station 1..247; 0: broadcast, writes only
 * @returns {Buffer} with its CRC
 * @throws {PlcError} FUNCTION_REFUSED, BAD_COUNT, BAD_ADDRESS, BAD_VALUE, BAD_STATION, BROADCAST_REFUSED
 */
function encodeQuery(query, station) {
  const row = check(query)
  checkStation(station, row)
  return closed(BODY[row.request](/** @type {any} */ (query), row, station))
}

/** The bytes before the CRC, by the kind of the request. */
const BODY = {
  block: ({ fn, base, count }, row, station) => Buffer.from([station, fn, ...word(base), ...word(count)]),
  single: ({ fn, base, value }, row, station) => {
    const data = row.unit === 'bits' ? (value ? ON : OFF) : value
    return Buffer.from([station, fn, ...word(base), ...word(data)])
  },
  multiple: ({ fn, base, values }, row, station) => {
    const data = row.unit === 'bits' ? packBits(values) : values.flatMap(word)
    return Buffer.from([station, fn, ...word(base), ...word(values.length), data.length, ...data])
  }
}

const word = value => [value >> 8, value & 0xff]

/**
 * Bits as bytes: the lowest one is the least significant bit of the first byte.
 * @param {ReadonlyArray<boolean>} values
 * @returns {number[]} filled up with 0
 */
function packBits(values) {
  const bytes = new Array(Math.ceil(values.length / 8)).fill(0)
  values.forEach((on, i) => {
    if (on) bytes[i >> 3] |= 1 << (i & 7)
  })
  return bytes
}

/** @param {Uint8Array} bytes @param {number} count @returns {boolean[]} the inverse of {@link packBits} */
const unpackBits = (bytes, count) => Array.from({ length: count }, (_, i) => Boolean((bytes[i >> 3] >> (i & 7)) & 1))

/** @param {Uint8Array} bytes @param {number} count @returns {number[]} registers: high byte first */
const unpackWords = (bytes, count) => Array.from({ length: count }, (_, i) => (bytes[2 * i] << 8) | bytes[2 * i + 1])

/**
 * A body with its CRC, low byte first.
 * @param {Uint8Array} body
 * @returns {Buffer}
 */
function closed(body) {
  const frame = Buffer.allocUnsafe(body.length + 2)
  frame.set(body)
  frame.writeUInt16LE(crc16(body), body.length)
  return frame
}

/**
 * Whether the CRC of bytes[start..start + length) fits.
 * @param {Uint8Array} bytes
 * @param {number} start
 * @param {number} length of the frame
 * @returns {boolean}
 */
function crcFits(bytes, start, length) {
  const end = start + length - 2
  return length >= 4 && crc16(bytes, start, end) === (bytes[end] | (bytes[end + 1] << 8))
}

/**
 * How many items a request is for.
 * @param {Query} query
 * @returns {number}
 */
const countOf = query => ('count' in query ? query.count : 'values' in query ? query.values.length : 1)

/**
 * Refuses, before anything is sent, what a frame cannot hold.
 * @param {any} query
 * @returns {import('./functions').FunctionRow} the function of the query
 * @throws {PlcError} FUNCTION_REFUSED, BAD_COUNT, BAD_ADDRESS, BAD_VALUE
 */
function check(query) {
  const row = functionOf(query?.fn)
  const { base } = query
  const values = row.request === 'single' ? [query.value] : row.request === 'multiple' ? query.values : []
  if (!Array.isArray(values)) throw badCount('no', row)
  const count = row.request === 'block' ? query.count : values.length
  if (!whole(count, row.most) || count === 0) throw badCount(count, row)
  if (!whole(base, SIZE - 1)) throw badAddress(base, `the numbers on the wire are 0 to ${SIZE - 1}`)
  if (base + count > SIZE)
    throw badAddress(base, `${count} ${row.unit} from there end after the last number ${SIZE - 1}`)
  Array.from(values).forEach((value, i) => checkValue(row, base + i, value))
  return row
}

function checkValue(row, at, value) {
  if (row.unit === 'bits' ? typeof value === 'boolean' : whole(value, 0xffff)) return
  const reason = row.unit === 'bits' ? 'a coil is true or false' : 'a register is a whole number from 0 to 65535'
  throw new PlcError('BAD_VALUE', { item: `wire address ${at}`, value: String(value), reason })
}

function checkStation(station, row) {
  if (!whole(station, LAST_STATION))
    throw new PlcError('BAD_STATION', { station, reason: 'it must be 1 to 247, or 0 for a broadcast' })
  if (station === 0 && row.reads)
    throw new PlcError('BROADCAST_REFUSED', { what: 'a read', reason: 'no station may answer it' })
}

function badCount(count, row) {
  const reason =
    count === 0 ? 'there is nothing to ask for' : whole(count, Infinity) ? 'too many for one frame' : 'no count'
  return new PlcError('BAD_COUNT', { count, unit: row.unit, reason, least: 1, most: row.most })
}

const whole = (value, most) => Number.isInteger(value) && value >= 0 && value <= most
const badAddress = (address, reason) => new PlcError('BAD_ADDRESS', { address: String(address), reason })

/**
 * What an RTU frame asks a station for: the simulator's side. What a station may refuse with exception 02 or 03 is left to it: `count` may be 0
 * or too large and `base + count` beyond the end.
 * @param {Uint8Array} frame with its CRC, which is not looked at
 * @returns {{ station: number, query: Query } | { station: number, fn: number, exception: 1|3 }} 1: no such function; 3: the frame makes no sense
 */
function decodeQuery(frame) {
  const [station, fn] = frame
  const row = functionByNumber(fn)
  if (!row) return { station, fn, exception: 1 }
  const info = frame.subarray(2, frame.length - 2)
  const query = info.length < 4 ? null : /** @type {Query} */ (READ[row.request](fn, info, row))
  return query ? { station, query } : { station, fn, exception: 3 }
}

const wordAt = (bytes, i) => (bytes[i] << 8) | bytes[i + 1]

const READ = {
  block: (fn, info) => (info.length === 4 ? { fn, base: wordAt(info, 0), count: wordAt(info, 2) } : null),
  single: (fn, info, row) => {
    const value = wordAt(info, 2)
    if (info.length !== 4 || (row.unit === 'bits' && value !== ON && value !== OFF)) return null
    return { fn, base: wordAt(info, 0), value: row.unit === 'bits' ? value === ON : value }
  },
  multiple: (fn, info, row) => {
    const count = wordAt(info, 2)
    const data = info.subarray(5)
    const size = row.unit === 'bits' ? Math.ceil(count / 8) : count * 2
    if (info[4] !== size || data.length !== size) return null
    return {
      fn,
      base: wordAt(info, 0),
      values: row.unit === 'bits' ? unpackBits(data, count) : unpackWords(data, count)
    }
  }
}

module.exports = { check, closed, countOf, crcFits, decodeQuery, encodeQuery, packBits, unpackBits, unpackWords }
