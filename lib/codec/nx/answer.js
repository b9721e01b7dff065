'use strict'
const { PlcError } = require('../../error')
const { encodeFrame, OVERHEAD } = require('./frame')
const { ACKNOWLEDGE, ANSWER, ERRORS, NO_SERVICE, answerCode, functionOf } = require('./functions')
const { answerInfoLength, decodeValues, encodeValues } = require('./query')

/**
 * @typedef {import('./query').Query} Query
 * @typedef {import('./query').Ends} Ends
 * @typedef {'query'|'request'} Phase what the answer follows: a Q, or an RR
 * @typedef {{ fn: number, length: number, kind: 'values'|'acknowledge'|'nonStandard'|'error'|'noService', accepts: (info: number) => boolean }} Expected
 */

const any = () => true
const isZero = info => info === 0
const isError = info => info >= 1 && info <= 5
const upToError = info => info <= 5

/**
 * The headers that an answer to a query may have, with the LEN of each; docs/nx.md "What is accepted as an answer".
 * @param {Query} query
 * @param {{ steps?: 2|4, phase?: Phase, nonStandardAck?: boolean }} [options]
 * @returns {Expected[]} `accepts` judges the one byte of INFO of a short frame
 */
function expectedAnswers(query, { steps = 2, phase = 'query', nonStandardAck = false } = {}) {
  const row = functionOf(query.ask)
  const length = answerInfoLength(query)
  // one list serves all queries that differ in their addresses alone
  const key = (((row.two * 512 + length) * 8 + steps) * 2 + Number(phase === 'query')) * 2 + Number(nonStandardAck)
  let list = known.get(key)
  if (!list) known.set(key, (list = listAnswers(row, length, { steps, phase, nonStandardAck })))
  return list
}

/**
 * Bytes of the answer to a query, if it is no error.
 * @param {Query} query
 * @param {{ steps?: 2|4, phase?: Phase }} [options]
 * @returns {number}
 */
const answerLength = (query, options) => expectedAnswers(query, options)[0].length + OVERHEAD

/** @type {Map<number, Expected[]>} */
const known = new Map()

function listAnswers(row, infoLength, { steps, phase, nonStandardAck }) {
  const code = answerCode(row, steps)
  /** @type {Expected[]} */
  const list = []
  const add = (kind, fn, length, accepts) => list.push({ kind, fn, length, accepts })
  if (steps === 4 && phase === 'query') add('acknowledge', ACKNOWLEDGE, 1, isZero)
  else {
    add('values', code, infoLength, any)
    // the manual prints $A2 as the answer to every write
    const printed = answerCode(functionOf('writeBits'), steps)
    if (nonStandardAck && !row.repeatable && code !== printed) add('nonStandard', printed, 1, isZero)
  }
  // an error's FN is printed as $8X: with the low nibble of the query or 0, and, as some CPUs may do, on top of the 2-step code
  for (const fn of new Set([0x80 | (code & 0x0f), 0xa0 | (code & 0x0f), 0x80, 0xa0])) add('error', fn, 1, isError)
  add('noService', NO_SERVICE, 1, upToError)
  return list
}

/**
 * What a complete answer says, as accepted by `answerTo` (match.js).
 * @param {import('./frame').Frame} frame
 * @param {Query} query
 * @param {{ steps?: 2|4, phase?: Phase, nonStandardAck?: boolean, station?: number }} [options]
 * @returns {{ values: Array<boolean|number>|true|null, nonStandard: boolean }} values null: a QA, the values come after an RR
 * @throws {PlcError} PLC_WRONG_FUNCTION, PLC_OUT_OF_RANGE, PLC_WRONG_FRAME, PLC_NOT_PERFORMED, PLC_FRAME_TOO_LONG, PLC_NO_SERVICE,
 *   BAD_ANSWER
 */
function readAnswer(frame, query, options = {}) {
  const { fn, info, from } = frame
  const found = classify({ fn, first: info[0], length: info.length }, expectedAnswers(query, options))
  const station = options.station ?? from
  if (!found) throw new PlcError('BAD_ANSWER', { station, reason: `function ${hex(fn)} with ${info.length} bytes` })
  if (found.kind === 'error') throw plcError(info[0], { station, query })
  if (found.kind === 'noService') throw new PlcError('PLC_NO_SERVICE', { station })
  if (found.kind === 'acknowledge') return { values: null, nonStandard: false }
  if (found.kind === 'nonStandard') return { values: true, nonStandard: true }
  return { values: decodeValues(query, info, station), nonStandard: false }
}

/**
 * Which expected answer a frame is: a short one whose INFO fits before the awaited values, so that `A1 01 02` is error 2 and no bit.
 * @param {{ fn: number, first: number, length: number }} frame the first byte of INFO, and how many there are
 * @param {Expected[]} expected
 * @returns {Expected | undefined}
 */
function classify({ fn, first, length }, expected) {
  let values
  for (const each of expected) {
    if (each.fn !== fn || each.length !== length) continue
    if (each.accepts === any) values = each
    else if (each.accepts(first)) return each
  }
  return values
}

function plcError(number, { station, query }) {
  const first = query.base ?? (query.addresses ?? query.writes)[0].address
  const kind = query.ask.endsWith('Bits') ? 'bit' : query.ask.endsWith('Words') ? 'word' : 'first'
  return new PlcError(ERRORS[number], { station, address: `${kind} address ${hex(first, 4)}h`, ask: query.ask })
}

const hex = (value, digits = 2) => value.toString(16).toUpperCase().padStart(digits, '0')

/**
 * The R of a query: the simulator's side.
 * @param {Query} query
 * @param {ReadonlyArray<boolean | number> | true} values
 * @param {Ends} ends
 * @returns {Buffer}
 */
function encodeAnswer(query, values, { station, master, steps = 2 }) {
  const fn = answerCode(functionOf(query.ask), steps)
  return encodeFrame({ to: master, from: station, fn, info: encodeValues(query, values) })
}

/**
 * The QA of the 4-step method.
 * @param {Ends} ends
 * @returns {Buffer}
 */
const encodeAcknowledge = ({ station, master }) =>
  encodeFrame({ to: master, from: station, fn: ACKNOWLEDGE, info: [0] })

/**
 * An error frame.
 * @param {1|2|3|4|5} error
 * @param {Ends & { fn: number, printed?: boolean }} ends `fn` the code of the query; `printed`: $8X as the manual prints it, also for a
 *   2-step query, instead of the query's code + $80
 * @returns {Buffer}
 */
function encodeError(error, { station, master, fn, printed = true }) {
  const code = printed ? ANSWER | (fn & 0x0f) : (ANSWER | fn) & 0xff
  return encodeFrame({ to: master, from: station, fn: code, info: [error] })
}

/**
 * The refusal "no service".
 * @param {Ends} ends
 * @returns {Buffer}
 */
const encodeNoService = ({ station, master }) => encodeFrame({ to: master, from: station, fn: NO_SERVICE, info: [0] })

module.exports = {
  answerLength,
  expectedAnswers,
  classify,
  readAnswer,
  encodeAnswer,
  encodeAcknowledge,
  encodeError,
  encodeNoService
}
