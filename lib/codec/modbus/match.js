'use strict'
const { EXCEPTION_LENGTH, expectedAnswer } = require('./answer')
const { asciiAnswerTo } = require('./match-ascii')
const { EXCEPTION, functionByNumber, LOOPBACK } = require('./functions')
const { crcFits } = require('./query')

/**
 * Verdicts of a match; contract in docs/architecture.md.
 * @typedef {{ need: number, ours?: boolean } | { take: number } | { skip: number } | { bad: string, length: number }} Verdict
 * @typedef {{ kind: 'nothing'|'begins'|'ours'|'other', length: number }} Candidate `length`: of the whole frame
 * @typedef {(bytes: Uint8Array, at: number) => Candidate} Look
 */

const LAST_STATION = 247
const MOST_DATA = 250
const HEADER = 3

const NOTHING = Object.freeze({ kind: /** @type {const} */ ('nothing'), length: 0 })
const BEGINS = Object.freeze({ kind: /** @type {const} */ ('begins'), length: 0 })
const other = length => ({ kind: /** @type {const} */ ('other'), length })
const ours = length => ({ kind: /** @type {const} */ ('ours'), length })

/**
 * Recognises the answer to a request among the bytes received: exact station, function and byte count, for writes the echoed address and value or
 * quantity; or an exception of this station to this function. A frame of the station that is still incomplete keeps what stands behind it
 * waiting: nothing inside its data is ever taken for a frame. Whole frames of anybody else are stepped over, and our own echo, damaged or not.
 * @param {import('./query').Query} query
 * @param {object} options
 * @param {number} options.station 1..247
 * @param {'rtu'|'ascii'} [options.protocol]
 * @param {Uint8Array} [options.sent] own bytes, as they went out
 * @returns {(bytes: Uint8Array) => Verdict}
 */
function answerTo(query, { station, protocol = 'rtu', sent }) {
  return frameTo(expectedAnswer(query, station), { station, fn: query.fn, protocol, sent })
}

/**
 * The same for a frame that is known by its length and beginning.
 * @param {import('./answer').Expected} expected
 * @param {{ station: number, fn: number, protocol: 'rtu'|'ascii', sent?: Uint8Array }} options
 * @returns {(bytes: Uint8Array) => Verdict}
 */
function frameTo(expected, { station, fn, protocol, sent }) {
  if (protocol === 'ascii') return asciiAnswerTo(expected, { station, fn, sent })
  const look = looker(expected, { station, fn, sent })
  return bytes => judge(bytes, look)
}

/** @returns {Look} */
function looker({ length, header }, { station, fn, sent }) {
  return (bytes, at) => {
    const left = bytes.length - at
    if (sent && isEcho(bytes, at, sent, { length, header })) return other(sent.length)
    if (bytes[at] === station) {
      if (left === 1) return BEGINS
      if (bytes[at + 1] === (fn | EXCEPTION)) return ours(EXCEPTION_LENGTH)
      const equal = equalBytes(bytes, at, header)
      if (equal === header.length) return ours(length)
      if (equal === left) return BEGINS
    }
    return lookOther(bytes, at, station)
  }
}

/** How many bytes at `at` equal those of `pattern`, from its first one on. */
function equalBytes(bytes, at, pattern) {
  let i = 0
  while (i < pattern.length && at + i < bytes.length && bytes[at + i] === pattern[i]) i++
  return i
}

/**
 * Our own frame, heard by the adapter: all of it, or so far, with up to a quarter of its bytes damaged. It may begin like the answer.
 */
function isEcho(bytes, at, sent, { length, header }) {
  const left = Math.min(bytes.length - at, sent.length)
  const equal = equalBytes(bytes, at, sent)
  if (equal === sent.length) return sent.length !== length || equalBytes(sent, 0, header) < header.length
  if (left < HEADER || (equal < left && differences(bytes, at, sent) > left >> 2)) return false
  if (bytes[at + 1] === (sent[1] | EXCEPTION)) return isNot(EXCEPTION_LENGTH, bytes, at)
  if (equalBytes(bytes, at, header) < Math.min(header.length, bytes.length - at)) return true
  // so far it is the answer, too: of 0F and 10 that one is over where the echo's values begin
  return length < sent.length && isNot(length, bytes, at) && (bytes[at + 6] === sent[6] || bytes[at + 7] === sent[7])
}

/** Whether a frame of this length would be complete, and is damaged. */
const isNot = (length, bytes, at) => bytes.length - at >= length && !crcFits(bytes, at, length)

function differences(bytes, at, sent) {
  let count = 0
  for (let i = 0; i < sent.length && at + i < bytes.length; i++) if (bytes[at + i] !== sent[i]) count++
  return count
}

/**
 * Frames of others, and of this station to other requests. One of this station counts from its header on, one of another only as a whole: noise
 * looks like a header too often.
 * @returns {Candidate}
 */
function lookOther(bytes, at, station) {
  const own = bytes[at] === station
  if (!own && (bytes[at] === 0 || bytes[at] > LAST_STATION)) return NOTHING
  const length = lengthAt(bytes, at)
  if (length === 0) return NOTHING
  if (length === undefined) return own ? BEGINS : NOTHING
  if (at + length > bytes.length) return own ? other(length) : NOTHING
  return own || crcFits(bytes, at, length) ? other(length) : NOTHING
}

/** Bytes of the answer that seems to begin here; 0: none does; undefined: its byte count has not come. */
function lengthAt(bytes, at) {
  const fn = bytes[at + 1]
  if (fn === undefined) return undefined
  const row = functionByNumber(fn & ~EXCEPTION)
  if (!row && (fn & ~EXCEPTION) !== LOOPBACK) return 0
  if (fn & EXCEPTION) return EXCEPTION_LENGTH
  if (!row) return 8
  if (row.answer === 'echo') return 8
  const count = bytes[at + 2]
  if (count === undefined) return undefined
  const possible = count >= 1 && count <= MOST_DATA && (row.answer === 'bits' || count % 2 === 0)
  return possible ? EXCEPTION_LENGTH + count : 0
}

/**
 * @param {Uint8Array} bytes
 * @param {Look} look
 * @returns {Verdict}
 */
function judge(bytes, look) {
  let at = 0
  /** @type {Candidate} */
  let candidate = NOTHING
  while (at < bytes.length && (candidate = look(bytes, at)).kind === 'nothing') at++
  if (at > 0) return { skip: at }
  if (bytes.length === 0 || candidate.kind === 'begins') return { need: Math.max(EXCEPTION_LENGTH, bytes.length + 1) }
  const { kind, length } = candidate
  if (bytes.length < length) return { need: length, ours: kind === 'ours' }
  if (crcFits(bytes, 0, length)) return kind === 'ours' ? { take: length } : { skip: length }
  return afterDamage(bytes, candidate, look)
}

// What looked like a frame is damaged, or was noise before the real answer: later candidates are tried, but what lies wholly inside is part of
// the damaged data.
function afterDamage(bytes, { kind, length }, look) {
  const last = kind === 'other' ? length : bytes.length
  for (let at = 1; at < last; at++) {
    const candidate = look(bytes, at)
    const end = candidate.kind === 'begins' ? bytes.length + 1 : at + candidate.length
    // one byte alone is too little to wait for
    const waits = candidate.kind === 'ours' || (candidate.kind === 'begins' && at + 1 < bytes.length)
    if (!waits || end <= length) continue
    if (end > bytes.length) return kind === 'other' ? { skip: at } : { need: end, ours: true }
    if (crcFits(bytes, at, candidate.length)) return { skip: at }
  }
  return kind === 'other' ? { skip: length } : { bad: 'CRC', length }
}

module.exports = { answerTo, frameTo }
