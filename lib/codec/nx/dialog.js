'use strict'
const { PlcError } = require('../../error')
const { answerLength, readAnswer } = require('./answer')
const { openFrame } = require('./frame')
const { functionOf } = require('./functions')
const { DEFAULT_IDS, masterIds } = require('./ids')
const { check, LIMITS } = require('./limits')
const { answerTo } = require('./match')
const { encodeResponseRequest, queryBytes } = require('./query')

/**
 * Conversations as generators; contract in docs/architecture.md, manual "Communication steps".
 * @typedef {import('./query').Query} Query
 * @typedef {{ take: () => number, ok: (id: number) => void, failed: (id: number) => void, resting?: () => number[] }} Ids
 * @typedef {object} Facts
 * @property {number} attempts Q and RR tries so far
 * @property {number} [master] ID that the last Q was sent from
 * @property {number} [seenStation] number that the answer came from
 * @property {boolean} nonStandard a write was acknowledged with $A2 (see {@link Options.nonStandardAck})
 * @property {boolean} repeated the values came by an RR alone
 * @typedef {object} Options
 * @property {number} station 0..191, 255: the only PLC of the line
 * @property {2|4} [steps]
 * @property {number} [timeout] ms from the end of sending to the first byte of the answer; the manual says 3000
 * @property {number} [attempts] of a read, Q and RR together; a write has one
 * @property {number} [gap] ms of silence before a Q and an RR; before an RR at least 5
 * @property {Ids} [ids] the allocator of the master's ID, see ids.js
 * @property {Record<string, number>} [limits] see limits.js
 * @property {boolean} [nonStandardAck] take $A2 for word and mixed writes; only if no unanswered bit write to the station precedes
 * @property {number} [again] repeat the read by an RR alone: the `master` of the result of the same read, if nothing else went to the station
 *   since and the line has no other master; whatever fails, a Q follows
 * @property {string} [item] what is written, for the text of an error
 * @property {Partial<Facts>} [facts] an object to be kept up to date, also when the conversation fails
 */

const TIMEOUT = 3000
const ATTEMPTS = 3
const GAP = 10
// manual: "For the internal processing of the PLC CPU send RR at least 5 msec after receiving QA"
const LEAST_GAP_BEFORE_REQUEST = 5
const GLOBAL_STATION = 255
const LAST_STATION = 191
/** @type {number[]} */
const NONE = []

/** Nothing of use came: asking again can help. */
const LOST = new Set(['TIMEOUT', 'INCOMPLETE', 'CRC_ERROR', 'BAD_ANSWER'])

/**
 * A read: Q R, or Q QA RR R. What is lost or damaged, and error 4 (the CPU did not perform it), is asked again, within `attempts`; in 4-step, once
 * the QA is there, by another RR.
 * @param {Query} query readBits, readWords or readMixed
 * @param {Options} options
 * @returns {Generator<any, { values: Array<boolean | number> } & Facts, Buffer>}
 * @throws {PlcError} PLC_…, TIMEOUT, INCOMPLETE, CRC_ERROR, BAD_ANSWER, whatever the line throws; before anything is sent BAD_STATION,
 *   BAD_MASTER_ID and those of `check` (limits.js)
 */
function* readDialog(query, options) {
  const talk = prepare(query, options)
  if (!functionOf(query.ask).repeatable) throw new PlcError('FUNCTION_REFUSED', { function: `${query.ask} as a read` })
  const { facts } = talk
  const values = options.again === undefined ? null : yield* repeat(talk, options.again)
  if (values) return resultOf(values, facts)
  const most = facts.attempts + talk.attempts
  for (;;) {
    try {
      return resultOf(yield* ask(talk, most), facts)
    } catch (/** @type {any} */ error) {
      const again = LOST.has(error.code) || error.code === 'PLC_NOT_PERFORMED'
      if (!again || facts.attempts >= most) throw error
    }
  }
}

/**
 * A write: Q R, or Q QA RR R. Nothing is ever sent twice: a repeated Q or RR makes the PLC carry the query out again.
 * @param {Query} query writeBits, writeWords or writeMixed
 * @param {Options} options
 * @returns {Generator<any, { values: true } & Facts, Buffer>}
 * @throws {PlcError} PLC_… refused; WRITE_UNKNOWN the Q went out, its outcome is not known (`cause`); what the line throws with
 *   `details.sent === false`: it never went out; before anything is sent as {@link readDialog}
 */
function* writeDialog(query, options) {
  const talk = prepare(query, options)
  if (functionOf(query.ask).repeatable) throw new PlcError('FUNCTION_REFUSED', { function: `${query.ask} as a write` })
  try {
    return resultOf(yield* ask(talk, 0), talk.facts)
  } catch (/** @type {any} */ error) {
    const neverOut = talk.reached === 'nothing' || (talk.reached === 'query' && error.details?.sent === false)
    if (isRefusal(error) || neverOut) throw error
    const reason = error.code ?? error.message
    throw new PlcError('WRITE_UNKNOWN', {
      station: talk.station,
      item: options.item ?? place(query),
      reason,
      cause: error
    })
  }
}

/** Written out: there may be dozens of them each second. @param {any} values @param {Facts} facts @returns {any} */
const resultOf = (values, { attempts, nonStandard, repeated, master, seenStation }) => ({
  values,
  attempts,
  nonStandard,
  repeated,
  master,
  seenStation
})

const isRefusal = error => typeof error?.code === 'string' && error.code.startsWith('PLC_')

function prepare(query, options) {
  const { station, steps = 2, timeout = TIMEOUT, attempts = ATTEMPTS, gap = GAP, limits = LIMITS } = options
  if (!Number.isInteger(station) || station < 0 || (station > LAST_STATION && station !== GLOBAL_STATION)) {
    throw new PlcError('BAD_STATION', { station, reason: 'it must be 0 to 191, or 255 for the only PLC of the line' })
  }
  check(query, limits)
  const facts = begun(options.facts ?? {})
  const ids = options.ids ?? masterIds({ ids: DEFAULT_IDS })
  const reached = /** @type {'nothing'|'query'|'answer'} */ ('nothing')
  return {
    reached,
    query,
    station,
    steps,
    timeout,
    attempts,
    gap,
    limits,
    ids,
    facts,
    nonStandardAck: options.nonStandardAck ?? false
  }
}

/** @returns {Facts} the same object, as nothing has been sent yet */
function begun(facts) {
  facts.attempts = 0
  facts.nonStandard = false
  facts.repeated = false
  if (facts.master !== undefined) delete facts.master
  if (facts.seenStation !== undefined) delete facts.seenStation
  return facts
}

/** One Q with all that follows it; `most` attempts bound the RRs. */
function* ask(talk, most) {
  const { ids, facts, steps } = talk
  const master = newId(talk)
  let finished = false
  try {
    facts.attempts++
    let answer = taken(talk, 'query', yield stepOf(talk, 'query', master))
    if (steps === 4) answer = yield* request(talk, master, most)
    finished = true
    return answer.values
  } catch (/** @type {any} */ error) {
    finished = isRefusal(error)
    throw error
  } finally {
    if (finished) ids.ok(master)
    else ids.failed(master)
  }
}

/** The RR that answers the QA; sent again while R is missing. */
function* request(talk, master, most) {
  for (;;) {
    try {
      return taken(talk, 'request', yield stepOf(talk, 'request', master))
    } catch (/** @type {any} */ error) {
      if (!LOST.has(error.code) || talk.facts.attempts >= most) throw error
      talk.facts.attempts++
    }
  }
}

/** An RR alone: the PLC carries out its last query again. Returns null where a Q must follow. */
function* repeat(talk, master) {
  const { ids, facts } = talk
  facts.master = master
  let finished = false
  try {
    facts.attempts++
    const { values } = taken(talk, 'request', yield stepOf(talk, 'request', master))
    finished = true
    facts.repeated = true
    return values
  } catch (/** @type {any} */ error) {
    finished = isRefusal(error)
    if (!finished && !LOST.has(error.code)) throw error
    return null
  } finally {
    if (!finished) ids.failed(master)
  }
}

function newId({ ids, station, facts }) {
  const master = ids.take()
  if (master === station) {
    throw new PlcError('BAD_MASTER_ID', { id: master, reason: 'the station has this number' })
  }
  facts.master = master
  return master
}

/** Bytes that go out, and what is awaited. */
function stepOf(talk, phase, master) {
  const { query, station, steps, timeout, nonStandardAck, facts } = talk
  const send = phase === 'query' ? queryBytes(query, talk, master) : encodeResponseRequest({ station, master })
  const gap = phase === 'query' ? talk.gap : Math.max(talk.gap, LEAST_GAP_BEFORE_REQUEST)
  const late = othersOf(talk.ids.resting?.() ?? NONE, master)
  const { seenStation } = facts
  const match = answerTo(query, { station, master, steps, phase, nonStandardAck, seenStation, sent: send, late })
  if (talk.reached === 'nothing') talk.reached = 'query'
  return { send, match, timeout, gap, usual: answerLength(query, { steps, phase }) }
}

const othersOf = (resting, master) => (resting.length === 0 ? resting : resting.filter(id => id !== master))

/** The answer to a step. */
function taken(talk, phase, bytes) {
  const { query, station, steps, nonStandardAck, facts } = talk
  talk.reached = 'answer'
  const frame = openFrame(bytes)
  facts.seenStation = frame.from
  const answer = readAnswer(frame, query, { steps, phase, nonStandardAck, station })
  if (answer.nonStandard) facts.nonStandard = true
  return answer
}

function place(query) {
  const { kind, address } = query.writes?.[0] ?? {
    kind: query.ask === 'writeBits' ? 'bit' : 'word',
    address: query.base
  }
  const count = (query.writes ?? query.values).length
  const first = `${kind} ${address.toString(16).toUpperCase().padStart(4, '0')}h`
  return count === 1 ? first : `${first} and ${count - 1} more`
}

module.exports = { readDialog, writeDialog }
