'use strict'

const { crc16 } = require('../codec/crc16')
const { encodeAcknowledge, encodeAnswer, encodeError, encodeNoService } = require('../codec/nx/answer')
const { parseAddress } = require('../codec/nx/address')
const { limitsOf } = require('../codec/nx/limits')
const { answerInfoLength, decodeQuery } = require('../codec/nx/query')
const { createMemory } = require('./nx-memory')
const { createNxReceiver } = require('./nx-receiver')
const { checkStation, createStation, emptyCounts, noteWrite, turnaroundOf } = require('./station')

const GLOBAL_STATION = 255
const STATIONS = { least: 0, most: 191, what: 'a PLC' }
const ERROR = { FUNCTION: 1, RANGE: 2, STRUCTURE: 3, NOT_PERFORMED: 4, TOO_LONG: 5 }

/**
 * A simulated OE MAX NX PLC: what its manual says, and, as settings, what the manual leaves open or a CPU may do otherwise.
 *
 * - `station` 0..191; it also answers 255
 * - `steps` both (default), 2 or 4: the other one's functions are unknown to it
 * - `turnaround` ms from the end of a query to the start of the answer, a number or [least, most]
 * - `gap` ms of silence after which a half-received frame is forgotten (4)
 * - `limits` rows as in codec/nx/limits.js; beyond them error 5. `writeWords` is 127 here
 * - `mode` `run` (default) or `program`: writes are not performed (error 4); `protect` ranges such as `['F0..F15']`: likewise
 * - `noService` unknown functions are answered with FN 00 instead of error 1
 * - `errorForm` `printed` ($8X) or `function` (the query's code + $80); `errorsAt` `query` (in place of the QA) or `response`
 * - `noRepeat` an RR alone, which asks for a repetition: `silent` or `error` (1)
 * - `printedAck` every write is acknowledged with $A2 / $82, as the manual prints it
 * - `answersAs` the sender of an answer to 255: `own` number or `asked` (255)
 * - `onlyMaster` ignores every other sender
 * - `areas`, `behaviour`, `history` see nx-memory.js and behaviour.js
 * - `onExecute({ at, query, master })` after each query carried out; a repetition by RR counts again
 *
 * @param {{ station?: number, clock: { now: () => number }, random?: import('./random').Random, [setting: string]: any }} settings
 * @returns {NxPlc}
 * @throws {PlcError} BAD_STATION, BAD_SETTING, BAD_AREA, BAD_ADDRESS, BAD_TYPE
 */
function createNxPlc(settings) {
  const plc = prepare(settings)
  const station = createStation(plc, {
    receiver: createNxReceiver({ gap: plc.gap, isMine: to => isMine(plc, to), counts: plc.counts }),
    isForMe: frame => isForMe(plc, frame),
    answer: createAnswerer(plc),
    disguise
  })
  return { ...station, setMode: mode => void (plc.mode = mode) }
}

/** The answer to a frame that has come in, computed when the PLC gets to it; null: silence. */
function createAnswerer(plc) {
  /** @type {any} the query that an RR makes the PLC carry out */
  let last = null

  return (frame, refuse) => {
    const asked = decodeQuery(frame)
    const replay = 'responseRequest' in asked
    if (replay && !last) return null
    const again = replay && last.served
    if (again && plc.noRepeat === 'silent') return null
    if (!replay) last = { fn: frame.fn, ...asked }
    // a 4-step query is carried out by its RR; the next one repeats
    last.served = replay || last.steps === 2
    return carryOut(plc, last, { frame, replay, refuse: again && plc.noRepeat ? ERROR.FUNCTION : refuse })
  }
}

function carryOut(plc, last, { frame, replay, refuse }) {
  const { query, fn, steps } = last
  const ends = { station: sender(plc, frame.to), master: frame.from, fn, steps }
  const early = steps === 4 && !replay
  const error = refuse ?? (early && plc.errorsAt !== 'query' ? 0 : judge(plc, last))
  if (error) return fail(plc, error, ends)
  if (early) return encodeAcknowledge(ends)
  const values = execute(plc, query)
  plc.onExecute?.({ at: plc.clock.now(), query, master: frame.from })
  return acknowledged(plc, query, { values, ends })
}

function prepare(settings) {
  const { station, clock, limits = {}, protect = [] } = settings
  checkStation(station, STATIONS)
  const memory = createMemory({ ...settings, now: clock.now })
  return {
    steps: 'both',
    mode: 'run',
    errorForm: 'printed',
    errorsAt: 'query',
    answersAs: 'own',
    gap: 4,
    ...settings,
    limits: limitsOf({ writeWords: 127, ...limits }),
    station: Number(station),
    turnaround: turnaroundOf(settings),
    protectedWords: protectedWords(protect, memory.areas),
    memory,
    counts: emptyCounts(),
    writes: new Map()
  }
}

function protectedWords(ranges, areas) {
  return ranges.map(text => {
    const { kind, address, count } = parseAddress(text, areas)
    const last = address + count - 1
    return kind === 'bit' ? { first: address >> 4, last: last >> 4 } : { first: address, last }
  })
}

const isMine = ({ station }, to) => to === station || to === GLOBAL_STATION

function isForMe(plc, frame) {
  const { onlyMaster, counts } = plc
  // not: an answer on the way to a master, a frame for another station
  if (!isMine(plc, frame.to) || frame.fn >= 0x80 || (onlyMaster != null && frame.from !== onlyMaster)) {
    counts.foreign++
    return false
  }
  counts.queries++
  return true
}

const sender = ({ station, answersAs }, asked) => (answersAs === 'asked' ? asked : station)

function fail({ counts, noService, errorForm }, error, ends) {
  counts.errors++
  if (error === ERROR.FUNCTION && noService) return encodeNoService(ends)
  return encodeError(error, { ...ends, printed: errorForm === 'printed' })
}

/** The number of the error that the manual's table asks for, 0: none. */
function judge(plc, { query, steps, error }) {
  if (error === ERROR.FUNCTION || (plc.steps !== 'both' && steps !== plc.steps)) return ERROR.FUNCTION
  if (error) return error
  const places = placesOf(query)
  if (places.length === 0) return ERROR.STRUCTURE
  if (places.length > plc.limits[query.ask] || answerInfoLength(query) > plc.limits.info) return ERROR.TOO_LONG
  if (!places.every(({ kind, address }) => plc.memory.has(kind, address))) return ERROR.RANGE
  return query.ask.startsWith('write') && isGuarded(plc, places) ? ERROR.NOT_PERFORMED : 0
}

function isGuarded({ mode, protectedWords: ranges }, places) {
  if (mode !== 'run') return true
  if (ranges.length === 0) return false
  return places.some(({ kind, address }) => {
    const word = kind === 'bit' ? address >> 4 : address
    return ranges.some(({ first, last }) => word >= first && word <= last)
  })
}

/** Every bit and word that a query touches, with the value to be written. */
function placesOf(query) {
  if (query.addresses) return query.addresses
  if (query.writes) return query.writes
  const kind = query.ask.endsWith('Bits') ? 'bit' : 'word'
  const count = query.values ? query.values.length : query.count
  return Array.from({ length: count }, (_, n) => ({ kind, address: query.base + n, value: query.values?.[n] }))
}

function execute({ memory, writes, counts }, query) {
  counts.executed++
  const places = placesOf(query)
  if (!query.ask.startsWith('write')) {
    return places.map(({ kind, address }) => (kind === 'bit' ? memory.readBit(address) : memory.readWord(address)))
  }
  for (const { kind, address, value } of places) {
    if (kind === 'bit') memory.writeBit(address, value)
    else memory.writeWord(address, value)
    noteWrite(writes, `${kind}:${address}`)
  }
  return true
}

function acknowledged({ printedAck }, query, { values, ends }) {
  if (!printedAck || values !== true) return encodeAnswer(query, values, ends)
  return encodeAnswer({ ask: 'writeBits', base: 0, values: [] }, true, ends)
}

const isBit = byte => byte === 0x00 || byte === 0xff

/** Like another station's answer, perhaps one that is on the line: an NX frame tells a query from an answer. */
function disguise(bytes, { random }) {
  const copy = Buffer.from(bytes)
  const end = copy.length - 2
  copy[1] = (copy[1] + random.integer(1, 7)) % (STATIONS.most + 1)
  // one byte of INFO is an acknowledgement or an error: it stays
  for (let n = 4; n < end && end > 5; n++) copy[n] = isBit(copy[n]) ? random.pick([0x00, 0xff]) : random.integer(1, 254)
  copy.writeUInt16LE(crc16(copy, 0, end), end)
  return copy
}

/**
 * @typedef {import('./station').Station & { memory: import('./nx-memory').Memory, setMode: (mode: 'run'|'program') => void }} NxPlc
 *   `get('W10', 'float32')`; `writes` by `word:447`, `bit:7164`
 */

module.exports = { createNxPlc }
