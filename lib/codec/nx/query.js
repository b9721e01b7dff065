'use strict'
const { PlcError } = require('../../error')
const { encodeFrame, MOST_INFO } = require('./frame')
const { functionOf, functionByCode, queryCode, RESPONSE_REQUEST } = require('./functions')
const { check, LIMITS } = require('./limits')

/**
 * A query is plain data; reads answer with an array of booleans (bits) and numbers 0..65535 (words) in order, writes with `true`.
 * @typedef {{ kind: 'bit'|'word', address: number }} Place
 * @typedef {{ ask: 'readBits'|'readWords', base: number, count: number }
 *   | { ask: 'readMixed', addresses: Place[] }
 *   | { ask: 'writeBits', base: number, values: boolean[] }
 *   | { ask: 'writeWords', base: number, values: number[] }
 *   | { ask: 'writeMixed', writes: Array<Place & { value: boolean | number }> }} Query
 * @typedef {{ station: number, master: number, steps?: 2|4 }} Ends
 */

const ON = 0xff
const OFF = 0x00
// the two top bits of an address in a mixed frame: 00 bit, 01 word, 1x unused
const WORD_MARK = 0x4000
const UNUSED_MARK = 0x8000

const low = value => value & 0xff
const high = value => value >> 8
const marked = ({ kind, address }) => (kind === 'word' ? address | WORD_MARK : address)
const data = value => (typeof value === 'boolean' ? [value ? ON : OFF] : [low(value), high(value)])
const sizeOf = each => (each.kind === 'bit' ? 1 : 2)

// INFO of each query; manual: the pages "Read bits" to "Write bits and words"
const INFO = {
  readBits: ({ base, count }) => [low(base), high(base), count],
  readWords: ({ base, count }) => [low(base), high(base), count],
  writeBits: ({ base, values }) => [low(base), high(base), ...values.flatMap(data)],
  writeWords: ({ base, values }) => [low(base), high(base), ...values.flatMap(data)],
  readMixed: ({ addresses }) => addresses.map(marked).flatMap(at => [low(at), high(at)]),
  writeMixed: ({ writes }) => writes.flatMap(one => [low(marked(one)), high(marked(one)), ...data(one.value)])
}

/**
 * The bytes of a Q.
 * @param {Query} query
 * @param {Ends & { limits?: Record<string, number> }} ends `station` 0..191 or 255, `master` the sender's ID
 * @returns {Buffer}
 * @throws {PlcError} FUNCTION_REFUSED, BAD_COUNT, BAD_VALUE, BAD_ADDRESS, FRAME_TOO_LONG
 */
function encodeQuery(query, { station, master, steps = 2, limits = LIMITS }) {
  const row = check(query, limits)
  return encodeFrame({ to: station, from: master, fn: queryCode(row, steps), info: INFO[row.name](query) })
}

/** @type {WeakMap<Query, { station: number, steps: number, limits: any, frames: Map<number, Buffer> }>} */
const made = new WeakMap()

/**
 * The same as {@link encodeQuery}; a read that comes again and again is encoded once for each ID. Neither the query nor the bytes may be changed.
 * @param {Query} query
 * @param {{ station: number, steps: 2|4, limits: Record<string, number> }} ends
 * @param {number} master
 * @returns {Buffer}
 * @throws {PlcError} as encodeQuery
 */
function queryBytes(query, { station, steps, limits }, master) {
  if (!functionOf(query.ask).repeatable) return encodeQuery(query, { station, master, steps, limits })
  let known = made.get(query)
  if (known?.station !== station || known.steps !== steps || known.limits !== limits) {
    known = { station, steps, limits, frames: new Map() }
    made.set(query, known)
  }
  let bytes = known.frames.get(master)
  if (!bytes) known.frames.set(master, (bytes = encodeQuery(query, { station, master, steps, limits })))
  return bytes
}

/**
 * The bytes of an RR: asks for the R of a 4-step query, or makes the PLC carry its last query out again.
 * @param {Ends} ends
 * @returns {Buffer}
 */
const encodeResponseRequest = ({ station, master }) =>
  encodeFrame({ to: station, from: master, fn: RESPONSE_REQUEST, info: [0] })

/**
 * What a frame asks a PLC for: the simulator's side. Limits are the PLC's own business, so they are not looked at: `count` may be 0.
 * @param {import('./frame').Frame} frame
 * @returns {{ query: Query, steps: 2|4 } | { responseRequest: true } | { error: 1|3, steps?: 2|4 }} error 1: function unknown or
 *   without description; 3: INFO makes no sense
 */
function decodeQuery({ fn, info }) {
  if (fn === RESPONSE_REQUEST) return info.length === 1 && info[0] === 0 ? { responseRequest: true } : { error: 3 }
  const found = functionByCode(fn)
  if (!found || !found.row.sendable) return { error: 1 }
  const query = READ_INFO[found.row.name](info)
  return query ? { query, steps: found.steps } : { error: 3, steps: found.steps }
}

const wordAt = (info, i) => info[i] | (info[i + 1] << 8)
const isBit = value => value === ON || value === OFF
const block = ask => info => (info.length === 3 ? { ask, base: wordAt(info, 0), count: info[2] } : null)

const READ_INFO = {
  readBits: block('readBits'),
  readWords: block('readWords'),
  writeBits(info) {
    const values = [...info.subarray(2)]
    if (values.length === 0 || !values.every(isBit)) return null
    return { ask: 'writeBits', base: wordAt(info, 0), values: values.map(value => value === ON) }
  },
  writeWords(info) {
    if (info.length < 4 || info.length % 2) return null
    const values = Array.from({ length: info.length / 2 - 1 }, (_, i) => wordAt(info, 2 * i + 2))
    return { ask: 'writeWords', base: wordAt(info, 0), values }
  },
  readMixed(info) {
    if (info.length % 2) return null
    const addresses = Array.from({ length: info.length / 2 }, (_, i) => place(wordAt(info, 2 * i)))
    return addresses.every(Boolean) ? { ask: 'readMixed', addresses } : null
  },
  writeMixed(info) {
    const writes = []
    for (let i = 0; i < info.length;) {
      const at = i + 2 < info.length ? place(wordAt(info, i)) : null
      if (!at || i + 2 + sizeOf(at) > info.length) return null
      const value = at.kind === 'bit' ? info[i + 2] : wordAt(info, i + 2)
      if (at.kind === 'bit' && !isBit(value)) return null
      writes.push({ ...at, value: at.kind === 'bit' ? value === ON : value })
      i += 2 + sizeOf(at)
    }
    return { ask: 'writeMixed', writes }
  }
}

/** @returns {Place | null} */
function place(marks) {
  if (marks & UNUSED_MARK) return null
  return { kind: marks & WORD_MARK ? 'word' : 'bit', address: marks & (WORD_MARK - 1) }
}

/**
 * What stands in the answer's INFO, in order; null for writes, whose answer is one byte 00.
 * @param {Query} query
 * @returns {Place['kind'][] | null}
 */
function answerKinds(query) {
  if (query.ask === 'readBits') return new Array(query.count).fill('bit')
  if (query.ask === 'readWords') return new Array(query.count).fill('word')
  return query.ask === 'readMixed' ? query.addresses.map(each => each.kind) : null
}

/**
 * Bytes of INFO in the answer to a query.
 * @param {Query} query
 * @returns {number} 1..256
 */
function answerInfoLength(query) {
  if (query.ask === 'readBits') return query.count
  if (query.ask === 'readWords') return query.count * 2
  return query.ask === 'readMixed' ? query.addresses.reduce((sum, each) => sum + sizeOf(each), 0) : 1
}

/**
 * The values in the INFO of an answer.
 * @param {Query} query
 * @param {Uint8Array} info of the length {@link answerInfoLength}
 * @param {number} [station] for the text of the error
 * @returns {Array<boolean | number> | true}
 * @throws {PlcError} BAD_ANSWER a bit neither FF nor 00, an acknowledgement not 00
 */
function decodeValues(query, info, station) {
  if (query.ask === 'readWords') return wordsOf(info)
  if (query.ask === 'readBits') return Array.from(info, value => bitOf(value, station))
  if (query.ask === 'readMixed') return mixedOf(query, info, station)
  if (info[0] !== 0) throw wrong(`acknowledgement ${hex(info[0])} instead of 00`, station)
  return true
}

function wordsOf(info) {
  const words = []
  for (let i = 0; i < info.length; i += 2) words.push(wordAt(info, i))
  return words
}

function mixedOf({ addresses }, info, station) {
  let i = 0
  return addresses.map(({ kind }) => {
    if (kind === 'bit') return bitOf(info[i++], station)
    i += 2
    return wordAt(info, i - 2)
  })
}

function bitOf(value, station) {
  if (!isBit(value)) throw wrong(`bit value ${hex(value)} instead of 00 or FF`, station)
  return value === ON
}

const wrong = (reason, station) => new PlcError('BAD_ANSWER', { station, reason })
const hex = value => value.toString(16).toUpperCase().padStart(2, '0')

/**
 * The INFO of the answer to a query: the simulator's side.
 * @param {Query} query
 * @param {ReadonlyArray<boolean | number> | true} values as many as the query asks for; true for writes
 * @returns {Buffer} 1..256 bytes
 * @throws {PlcError} BAD_COUNT, FRAME_TOO_LONG
 */
function encodeValues(query, values) {
  const kinds = answerKinds(query)
  if (!kinds) return Buffer.of(0)
  const given = values === true ? 0 : values.length
  if (given !== kinds.length) {
    const reason = 'the query asks for another number'
    throw new PlcError('BAD_COUNT', { count: given, unit: 'values', reason, least: kinds.length, most: kinds.length })
  }
  const info = Buffer.from(kinds.flatMap((kind, i) => data(kind === 'bit' ? Boolean(values[i]) : Number(values[i]))))
  if (info.length > MOST_INFO)
    throw new PlcError('FRAME_TOO_LONG', { what: 'the answer', got: info.length, most: MOST_INFO })
  return info
}

/**
 * Whether the PLC may be asked again without harm.
 * @param {Query} query
 * @returns {boolean} true for reads
 */
const isRepeatable = query => functionOf(query.ask).repeatable

module.exports = {
  encodeQuery,
  queryBytes,
  encodeResponseRequest,
  decodeQuery,
  answerInfoLength,
  decodeValues,
  encodeValues,
  isRepeatable
}
