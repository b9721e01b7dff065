'use strict'
const { PlcError } = require('../../error')
const { EXCEPTION, functionOf } = require('./functions')
const { exceptionError } = require('./exceptions')
const { spanOf, TABLES } = require('./address')
const { closed, countOf, crcFits, encodeQuery, packBits, unpackBits, unpackWords } = require('./query')

/**
 * Answers, both ways, as RTU frames; panel manual appendix A.
 * @typedef {import('./query').Query} Query
 * @typedef {{ length: number, header: Buffer }} Expected bytes of the whole RTU frame, and those that must be equal: station, function and byte
 *   count, or for a write the echoed address and value or quantity
 */

/** Station, function, number, CRC. */
const EXCEPTION_LENGTH = 5

// by the kind of the answer: [bytes of the frame, bytes of the header]
const SHAPE = {
  bits: count => [5 + Math.ceil(count / 8), 3],
  words: count => [5 + 2 * count, 3],
  echo: () => [8, 6]
}

/**
 * What the right answer to a request looks like.
 * @param {Query} query
 * @param {number} station
 * @returns {Expected}
 */
function expectedAnswer(query, station) {
  const row = functionOf(query.fn)
  const [length, size] = SHAPE[row.answer](countOf(query))
  const header =
    row.answer === 'echo' ? encodeQuery(query, station).subarray(0, size) : Buffer.from([station, query.fn, length - 5])
  return { length, header }
}

/**
 * The values of a complete answer. All that tells right from wrong is looked at again: checksum, station, function, byte count, echo.
 * @param {Query} query
 * @param {Buffer} frame RTU, with its CRC
 * @param {{ station?: number, name?: (query: Query) => string }} [options] `station`: who was asked; `name`: how an error calls the addresses
 * @returns {boolean[] | number[] | true} true for a write
 * @throws {PlcError} MODBUS_… the station's exception; CRC_ERROR, BAD_ANSWER
 */
function decodeAnswer(query, frame, { station = frame[0], name = describeQuery } = {}) {
  if (!crcFits(frame, 0, frame.length)) throw new PlcError('CRC_ERROR', { station, got: frame.toString('hex') })
  if (isException(query, frame, station))
    throw exceptionError(frame[2], { station, fn: query.fn, address: name(query) })
  const { length, header } = expectedAnswer(query, station)
  if (frame.length !== length || header.compare(frame, 0, header.length) !== 0) {
    throw new PlcError('BAD_ANSWER', {
      station,
      reason: `${frame.toString('hex')} does not answer ${describeQuery(query)}`
    })
  }
  const { answer } = functionOf(query.fn)
  if (answer === 'echo') return true
  const data = frame.subarray(3, length - 2)
  return answer === 'bits' ? unpackBits(data, countOf(query)) : unpackWords(data, countOf(query))
}

const isException = ({ fn }, frame, station) =>
  frame.length === EXCEPTION_LENGTH && frame[0] === station && frame[1] === (fn | EXCEPTION)

/**
 * The addresses of a request in words, for errors.
 * @param {Query} query
 * @returns {string} `holding register, wire addresses 107–109 (006Bh–006Dh)`
 */
function describeQuery(query) {
  const { table } = functionOf(query.fn)
  const row = TABLES.find(each => each.table === table)
  return `${row?.name}, ${spanOf(query.base, query.base + countOf(query) - 1)}`
}

/**
 * The answer to a request: the simulator's side.
 * @param {Query} query
 * @param {number} station
 * @param {ReadonlyArray<boolean> | ReadonlyArray<number> | true} values as many as the request asks for; true for a write
 * @returns {Buffer}
 * @throws {PlcError} BAD_COUNT
 */
function encodeAnswer(query, station, values) {
  const { length, header } = expectedAnswer(query, station)
  const { answer } = functionOf(query.fn)
  if (answer === 'echo') return closed(header)
  const count = countOf(query)
  const given = values === true ? [] : [...values]
  if (given.length !== count) {
    const reason = 'the request asks for another number'
    throw new PlcError('BAD_COUNT', { count: given.length, unit: 'values', reason, least: count, most: count })
  }
  const data =
    answer === 'bits'
      ? packBits(given.map(Boolean))
      : given.flatMap(value => [Number(value) >> 8, Number(value) & 0xff])
  return closed(Buffer.concat([header, Buffer.from(data)], length - 2))
}

/**
 * The exception that a station answers: the simulator's side.
 * @param {number} fn of the request
 * @param {number} station
 * @param {number} number 0..255
 * @returns {Buffer}
 */
const encodeException = (fn, station, number) => closed(Buffer.from([station, fn | EXCEPTION, number]))

module.exports = {
  EXCEPTION_LENGTH,
  decodeAnswer,
  describeQuery,
  encodeAnswer,
  encodeException,
  expectedAnswer
}
