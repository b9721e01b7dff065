'use strict'
const { classify, expectedAnswers } = require('./answer')
const { crcFits, HEADER, MOST_INFO, OVERHEAD, SHORTEST } = require('./frame')

/**
 * Verdicts of a match; contract in docs/architecture.md.
 * @typedef {{ need: number, ours?: boolean } | { take: number } | { skip: number } | { bad: string, length: number }} Verdict
 * @typedef {import('./query').Query} Query
 * @typedef {'nothing'|'begins'|'ours'|'other'} Candidate
 */

const GLOBAL_STATION = 255
const LAST_STATION = 191
/** @type {readonly number[]} */
const NONE = []

/**
 * Recognises the answer to a query among the bytes received. Only the exact header is looked for (receiver, sender, function and length), and
 * a candidate that is still incomplete keeps the ones behind it waiting: what stands inside its data is never taken for a frame.
 * @param {Query} query
 * @param {object} options
 * @param {number} options.station 0..191, or 255: then the answer comes from 255 or from the PLC's own number
 * @param {number} options.master ID that the query was sent from; answers to any other are not ours
 * @param {2|4} [options.steps]
 * @param {'query'|'request'} [options.phase] what the answer follows: a Q, or an RR
 * @param {boolean} [options.nonStandardAck] take $A2 ($82) for a word or mixed write, as the manual prints it; only if no bit write to the
 *   station is unanswered
 * @param {number} [options.seenStation] number under which station 255 was seen to answer in this conversation
 * @param {Uint8Array} [options.sent] own bytes: their echo is stepped over, also where it is damaged, with all that it holds
 * @param {readonly number[]} [options.late] older master IDs to which an answer may still come: stepped over as whole frames
 * @returns {(bytes: Uint8Array) => Verdict}
 */
function answerTo(query, options) {
  const { station, master, seenStation, sent, late = NONE } = options
  const own = { station, master, seenStation, sent, late, expected: expectedAnswers(query, options) }
  return bytes => judge(bytes, own)
}

/**
 * What is looked for.
 * @typedef {{ station: number, master: number, seenStation?: number, sent?: Uint8Array, late: readonly number[],
 *   expected: import('./answer').Expected[] }} Own
 */

/** @param {Uint8Array} bytes @param {number} at @param {Own} own @returns {Candidate} */
function look(bytes, at, own) {
  const left = bytes.length - at
  if (bytes[at] === own.master) {
    if (left > 1 && !isStation(bytes[at + 1], own)) return 'nothing'
    if (left > 2 && !isFunction(bytes[at + 2], own)) return 'nothing'
    if (left < HEADER) return 'begins'
    return isHeader(bytes[at + 2], bytes[at + 3], own) ? 'ours' : 'nothing'
  }
  if (own.sent && startsLike(bytes, at, own.sent)) return left < HEADER ? 'begins' : 'other'
  return own.late.includes(bytes[at]) ? lookLate(bytes, at, own) : 'nothing'
}

/** @param {number} id @param {Own} own */
const isStation = (id, { station, seenStation }) =>
  station === GLOBAL_STATION && seenStation === undefined
    ? id === GLOBAL_STATION || id <= LAST_STATION
    : id === station || id === seenStation

function isFunction(fn, { expected }) {
  for (const each of expected) if (each.fn === fn) return true
  return false
}

function isHeader(fn, length, { expected }) {
  for (const each of expected) if (each.fn === fn && (each.length & 0xff) === length) return true
  return false
}

const accepts = (bytes, at, { length, own }) =>
  classify({ fn: bytes[at + 2], first: bytes[at + HEADER], length: length - OVERHEAD }, own.expected) !== undefined

const lengthAt = (bytes, at) => (bytes[at + 3] || MOST_INFO) + OVERHEAD

function startsLike(bytes, at, sent) {
  for (let i = 0; i < HEADER && at + i < bytes.length; i++) if (bytes[at + i] !== sent[i]) return false
  return true
}

// only reads: the answers to writes hold no data in which a frame could stand
const LATE_READS = [0x81, 0x83, 0x85, 0xa1, 0xa3, 0xa5]

/** @returns {Candidate} */
function lookLate(bytes, at, own) {
  const left = bytes.length - at
  if (left > 1 && !isStation(bytes[at + 1], own)) return 'nothing'
  if (left > 2 && !LATE_READS.includes(bytes[at + 2])) return 'nothing'
  return left < HEADER ? 'begins' : 'other'
}

/** @param {Uint8Array} bytes @param {Own} own @returns {Verdict} */
function judge(bytes, own) {
  let at = 0
  /** @type {Candidate} */
  let candidate = 'nothing'
  while (at < bytes.length && (candidate = look(bytes, at, own)) === 'nothing') at++
  if (at > 0) return { skip: at }
  if (bytes.length === 0 || candidate === 'begins') return { need: SHORTEST }
  const length = lengthAt(bytes, 0)
  if (bytes.length < length) return { need: length, ours: candidate === 'ours' }
  if (candidate === 'other') return { skip: length }
  if (!crcFits(bytes, 0, length)) return afterDamage(bytes, length, own)
  return accepts(bytes, 0, { length, own }) ? { take: length } : { skip: length }
}

// What looked like the answer is damaged. It may have been noise before the real one, so later candidates are tried; but an error frame that
// lies wholly inside is part of the damaged data.
function afterDamage(bytes, length, own) {
  for (let at = 1; at < bytes.length; at++) {
    if (look(bytes, at, own) !== 'ours') continue
    const end = at + lengthAt(bytes, at)
    if (end > bytes.length) return { need: end, ours: true }
    if (end > length && crcFits(bytes, at, end - at) && accepts(bytes, at, { length: end - at, own }))
      return { skip: at }
  }
  return { bad: 'CRC', length }
}

module.exports = { answerTo }
