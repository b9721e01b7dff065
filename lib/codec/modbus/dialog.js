'use strict'
const { PlcError } = require('../../error')
const { decodeAnswer, describeQuery, expectedAnswer } = require('./answer')
const { asciiLength, fromAscii, toAscii } = require('./ascii')
const { exceptionByCode, exceptionError } = require('./exceptions')
const { EXCEPTION, functionOf, readFunction } = require('./functions')
const { answerTo } = require('./match')
const { check, closed, encodeQuery } = require('./query')
const { roundUp } = require('./unit')

/**
 * Conversations as generators; contract in docs/architecture.md.
 * @typedef {import('./query').Query} Query
 * @typedef {{ frames: Query[] } | { bits: { base: number, mask: number, value: number }, single?: boolean }} Write `frames` go out in this order;
 *   `bits`: the bits of `mask` of holding register `base` become those of `value`, the others stay: read, change, write; `single`: by 06, not 10
 * @typedef {{ send: Buffer, read: (frame: Buffer) => unknown, kept?: object }} Exchange RTU frames both; kept: an empty object, of one that is used
 *   again and again: what the conversation makes of it stays there
 * @typedef {{ attempts: number, writes: number, exact: boolean }} Facts frames sent so far; those of them that write; `exact`: a read that was
 *   rounded up to the read bit unit was refused (exception 02) and asked exactly
 * @typedef {object} Options
 * @property {number} station 1..247, 0: broadcast
 * @property {'rtu'|'ascii'} [protocol]
 * @property {number} [timeout] ms from the end of sending to the first byte of the answer; default 1000
 * @property {number} [attempts] of a read, default 3; a write has one
 * @property {number} [gap] ms of silence before each frame
 * @property {(query: Query, station: number) => Exchange} [exchange] makes the bytes and reads the answer; default: this codec
 * @property {number} [unit] read bit unit: bits are asked for in whole multiples of it
 * @property {number} [most] bits in one read, which rounding up does not exceed; default what the function allows
 * @property {Partial<Facts>} [facts] an object to be kept up to date, also when the conversation fails
 * @property {string} [item] what is written, for the text of an error
 * @property {boolean} [probe] read before a write whose answer equals it (05, 06): it is not known yet whether the adapter hears itself
 * @property {{ turnaround?: number }} [broadcast] allows station 0; ms to wait after each frame
 * @property {(query: Query) => string} [names] how errors call the addresses of a request
 */

const TIMEOUT = 1000
const ATTEMPTS = 3
const TURNAROUND = 100
const LAST_STATION = 247

/** Nothing of use came: asking again can help. */
const LOST = new Set(['TIMEOUT', 'INCOMPLETE', 'CRC_ERROR', 'BAD_ANSWER'])

/**
 * A read. What is lost, damaged, busy (06) or still being done (05) is asked again, within `attempts`.
 * @param {Query} query of a function that reads
 * @param {Options} options
 * @returns {Generator<any, { values: Array<boolean | number>, attempts: number }, Buffer>} as many values as `query.count`
 * @throws {PlcError} MODBUS_…, TIMEOUT, INCOMPLETE, CRC_ERROR, BAD_ANSWER, whatever the line throws; before anything is sent BAD_STATION,
 *   BROADCAST_REFUSED, FUNCTION_REFUSED, BAD_COUNT, BAD_ADDRESS
 */
function* readDialog(query, options) {
  const talk = prepare(options)
  if (!check(query).reads) throw new PlcError('FUNCTION_REFUSED', { function: `${query.fn} as a read` })
  if (talk.station === 0) throw broadcastRefused('a read', 'no station may answer it')
  return { values: yield* readValues(query, talk), attempts: talk.facts.attempts }
}

function* readValues(query, talk) {
  const { unit, most, facts } = talk
  const wide = roundUp(query, { unit, most })
  try {
    const values = yield* readAgain(wide, talk)
    return values.slice(0, query.count)
  } catch (/** @type {any} */ error) {
    if (error.code !== 'MODBUS_ILLEGAL_ADDRESS' || wide.count === query.count) throw error
    // the station has what was asked for, perhaps, but not what the unit added
    facts.exact = true
    return yield* readAgain(query, talk)
  }
}

function* readAgain(query, talk) {
  for (let tries = 1; ; tries++) {
    try {
      const values = yield* exchange(query, talk)
      if (Array.isArray(values) && values.length >= query.count) return values
      throw new PlcError('BAD_ANSWER', { station: talk.station, reason: 'it has other values than were asked for' })
    } catch (/** @type {any} */ error) {
      const again = LOST.has(error.code) || exceptionByCode(error.code)?.again
      if (!again || tries >= talk.attempts) throw error
    }
  }
}

/**
 * A write. Nothing is sent twice. The first frame that is not confirmed ends it.
 * @param {Write} write
 * @param {Options} options
 * @returns {Generator<any, { values: true, attempts: number }, Buffer>} of a broadcast: it went out, no more
 * @throws {PlcError} MODBUS_… refused, nothing was carried out; WRITE_UNKNOWN (`cause`): a frame may have been carried out, or some of several were
 *   (`details.done` of `details.frames`); what has `details.sent === false` never went out; before anything is sent as {@link readDialog}
 */
function* writeDialog(write, options) {
  const talk = prepare(options)
  if (talk.station === 0) checkBroadcast(write, options)
  const { facts } = talk
  const frames = 'bits' in write ? [yield* changed(write, talk)] : write.frames
  checkWrites(frames)
  if (!('bits' in write)) yield* probe(frames, options, talk)
  for (let done = 0; done < frames.length; done++) {
    try {
      yield* writeOne(frames[done], options, talk)
    } catch (/** @type {any} */ error) {
      throw meaning(error, { done, frames, item: options.item, talk })
    }
  }
  return { values: true, attempts: facts.attempts }
}

/** The register with its new bits, as a frame to write. What fails here has written nothing. */
function* changed({ bits: { base, mask, value }, single = false }, talk) {
  const query = /** @type {Query} */ ({ fn: readFunction('hr'), base, count: 1 })
  check(query)
  const [old] = yield* nothingWritten(readAgain(query, talk))
  const next = (old & ~mask) | (value & mask)
  return /** @type {Query} */ (single ? { fn: 6, base, value: next } : { fn: 16, base, values: [next] })
}

/** Any answer, an exception too, tells whether the adapter hears itself: only then the echo of the write can be told from its answer. */
function* probe(frames, options, talk) {
  const { station } = talk
  const alike = station !== 0 && options.probe && frames.find(query => answersItself(query, station))
  if (!alike) return
  const query = /** @type {Query} */ ({ fn: readFunction(functionOf(alike.fn).table), base: alike.base, count: 1 })
  try {
    yield* nothingWritten(readAgain(query, talk))
  } catch (/** @type {any} */ error) {
    if (!exceptionByCode(error.code)) throw error
  }
}

/** Whether a frame begins with its own answer: 05 and 06 always, another one by its CRC. */
function answersItself(query, station) {
  const answer = closed(expectedAnswer(query, station).header)
  return encodeQuery(query, station).subarray(0, answer.length).equals(answer)
}

/** @template T @param {Generator<any, T, Buffer>} reading @returns {Generator<any, T, Buffer>} */
function* nothingWritten(reading) {
  try {
    return yield* reading
  } catch (/** @type {any} */ error) {
    if (!(error instanceof PlcError)) throw error
    const { details, cause } = error
    throw new PlcError(/** @type {any} */ (error).code, { ...details, sent: false, cause })
  }
}

function* writeOne(query, options, talk) {
  const { station, facts, gap, timeout, protocol } = talk
  facts.writes++
  if (station !== 0) return yield* exchange(query, talk)
  facts.attempts++
  const { send } = talk.exchange(query, station)
  const turnaround = options.broadcast?.turnaround ?? TURNAROUND
  yield { send: protocol === 'ascii' ? toAscii(send) : send, match: null, timeout, gap, turnaround }
}

/** What a failed frame means for the whole write. */
function meaning(error, { done, frames, item, talk }) {
  const row = exceptionByCode(error.code)
  const notDone = error.details?.sent === false || row?.write === 'refused'
  if (notDone && done === 0) return error
  const { station } = talk
  const why = error.code ?? error.message
  const fate = station === 0 ? 'went out' : done === 1 ? 'was carried out' : 'were carried out'
  const reason = done === 0 ? why : `${done} of ${frames.length} frames ${fate}, then ${why}`
  const details = { station, item: item ?? describeQuery(frames[done]), reason, done, frames: frames.length }
  return new PlcError('WRITE_UNKNOWN', { ...details, cause: error })
}

/** One step: bytes out, the answer in. */
/** What goes out, and what recognises the answer. */
function wireOf(made, query, { station, protocol }) {
  const { kept = {} } = made
  return (kept[protocol] ??= wireFor(made.send, query, { station, protocol }))
}

function wireFor(rtu, query, { station, protocol }) {
  const send = protocol === 'ascii' ? toAscii(rtu) : rtu
  const { length } = expectedAnswer(query, station)
  const usual = protocol === 'ascii' ? asciiLength(length) : length
  return { send, usual, match: answerTo(query, { station, protocol, sent: send }) }
}

function* exchange(query, talk) {
  const { station, protocol, timeout, gap, facts, names } = talk
  const made = talk.exchange(query, station)
  const { send, match, usual } = wireOf(made, query, talk)
  facts.attempts++
  const bytes = yield { send, match, timeout, gap, usual }
  const frame = protocol === 'ascii' ? fromAscii(bytes) : bytes
  if (!frame) throw new PlcError('BAD_ANSWER', { station, reason: 'it is no frame' })
  if (frame[1] & EXCEPTION) throw exceptionError(frame[2], { station, fn: query.fn, address: names(query) })
  return readFrame(made.read, frame, station)
}

function readFrame(read, frame, station) {
  try {
    return read(frame)
  } catch (/** @type {any} */ error) {
    if (error instanceof PlcError) throw error
    throw new PlcError('BAD_ANSWER', { station, reason: String(error?.message ?? error), cause: error })
  }
}

/** @returns {Exchange} the bytes by this codec alone */
const ownExchange = (query, station) => ({
  send: encodeQuery(query, station),
  read: frame => decodeAnswer(query, frame, { station })
})

function prepare(options) {
  const { station, protocol = 'rtu', timeout = TIMEOUT, attempts = ATTEMPTS, gap = 0 } = options
  const { exchange: make = ownExchange, unit = 1, most, names = describeQuery } = options
  if (!Number.isInteger(station) || station < 0 || station > LAST_STATION) {
    throw new PlcError('BAD_STATION', { station, reason: 'it must be 1 to 247, or 0 for a broadcast' })
  }
  /** @type {Facts} */
  const facts = Object.assign(options.facts ?? {}, { attempts: 0, writes: 0, exact: false })
  return { station, protocol, timeout, attempts, gap, exchange: make, unit, most, names, facts }
}

function checkWrites(frames) {
  const reading = frames.find(query => check(query).reads)
  if (reading) throw new PlcError('FUNCTION_REFUSED', { function: `${reading.fn} as a write` })
  if (frames.length === 0) throw new PlcError('NOTHING_TO_WRITE', { reason: 'there is no frame' })
}

function checkBroadcast(write, /** @type {Options} */ { broadcast }) {
  if ('bits' in write) throw broadcastRefused('a bit of a register', 'the register would have to be read first')
  if (!broadcast) throw broadcastRefused('a write', 'it is not allowed here')
}

const broadcastRefused = (what, reason) => new PlcError('BROADCAST_REFUSED', { what, reason })

module.exports = { readDialog, writeDialog }
