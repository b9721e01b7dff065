'use strict'

const { encodeAnswer, encodeException } = require('../codec/modbus/answer')
const { fromAscii, toAscii } = require('../codec/modbus/ascii')
const { EXCEPTION, FUNCTIONS, functionByNumber, LOOPBACK } = require('../codec/modbus/functions')
const { closed, countOf, decodeQuery } = require('../codec/modbus/query')
const { createModbusMemory } = require('./modbus-memory')
const { createAsciiReceiver, createRtuReceiver } = require('./modbus-receiver')
const { checkStation, createStation, emptyCounts, noteWrite, turnaroundOf } = require('./station')
const { PlcError } = require('../error')

const BROADCAST = 0
const STATIONS = { least: 1, most: 247, what: 'a regulator' }
const CODE = { FUNCTION: 1, ADDRESS: 2, VALUE: 3 }
const FAST = 19200 // above this speed the silence of 3.5 characters is a fixed time
const FAST_SILENCE = 1.75
const ASCII_GAP = 1000

/**
 * A simulated CHINO thyristor regulator: MODBUS RTU or ASCII, four tables of 65536 addresses, and a heater.
 *
 * - `station` 1..247; it carries out broadcasts, too, without an answer
 * - `protocol` `rtu` (default) or `ascii`; `baudRate` (19200) and `bitsPerByte` (10) give the 3.5 characters of silence of RTU
 * - `turnaround` ms from the end of a query to the start of the answer, a number or [least, most]; RTU at least 3.5 characters
 * - `gap` ms of silence after which a half-received frame is forgotten (3.5 characters, in ASCII 1000)
 * - `functions` those that it has (1, 2, 3, 4, 5, 6, 8, 15, 16); others: exception 01. Of 08 it knows sub-function 0000: the query comes back
 * - `limits` items per frame by function, as in `{ 3: 32 }`; beyond them, or with 0 items: exception 03
 * - `tables` what a table has, as in `{ hr: ['400001..400100', 'hr200'], ir: [] }`; the rest of it: exception 02
 * - `protect` addresses that cannot be written, as in `['400010..400019', 'co5']`: exception `protectError` (3)
 * - `ranges` rows `{ at: '400001', least, most }`: what a register takes; else exception 03
 * - `values` rows `{ at, as, value }` at the start; `heating` the model of heating.js (on, unless `behaviour` is given)
 * - `addressMode` `1-base` (default) or `0-base`: how the addresses of these settings are meant
 * - `behaviour`, `history` see behaviour.js and words.js
 * - `onExecute({ at, query, station })` after each query carried out
 *
 * @param {{ station?: number, clock: { now: () => number }, random?: import('./random').Random, [setting: string]: any }} settings
 * @returns {ChinoRegulator}
 * @throws {PlcError} BAD_STATION, BAD_SETTING, BAD_ADDRESS, BAD_BIT, OUT_OF_AREA, BAD_TYPE
 */
function createChinoRegulator(settings) {
  const chino = prepare(settings)
  const ascii = chino.protocol === 'ascii'
  const shown = rtu => (ascii ? toAscii(rtu) : rtu)
  const hidden = bytes => (ascii ? /** @type {Buffer} */ (fromAscii(bytes)) : bytes)
  const station = createStation(chino, {
    receiver: ascii ? createAsciiReceiver(chino) : createRtuReceiver(chino),
    isForMe: frame => isForMe(chino, frame),
    answer(frame, refuse) {
      const rtu = answerTo(chino, frame.rtu, refuse)
      return rtu && shown(rtu)
    },
    disguise: (bytes, context) => shown(disguise(hidden(bytes), context))
  })
  return /** @type {any} */ ({ ...station, breakHeater: chino.memory.breakHeater })
}

function prepare(settings) {
  const { station, protocol = 'rtu', functions, limits = {}, protectError = CODE.VALUE } = settings
  checkStation(station, STATIONS)
  oneOf('protocol', protocol, ['rtu', 'ascii'])
  oneOf('protectError', protectError, [3, 4])
  const silence = silenceOf(settings)
  const ascii = protocol === 'ascii'
  const turnaround = turnaroundOf(settings)
  return {
    gap: ascii ? ASCII_GAP : silence,
    ...settings,
    station: Number(station),
    protocol,
    protectError,
    functions: new Set(functions ?? [...FUNCTIONS.map(({ fn }) => fn), LOOPBACK]),
    limits,
    turnaround: () => Math.max(turnaround(), ascii ? 0 : silence),
    memory: createModbusMemory({ heating: !settings.behaviour, ...settings, now: settings.clock.now }),
    counts: { ...emptyCounts(), broadcasts: 0 },
    writes: new Map()
  }
}

/** 3.5 characters in ms (MODBUS over serial line, 2.5.1.1). */
const silenceOf = ({ baudRate = FAST, bitsPerByte = 10 }) =>
  baudRate > FAST ? FAST_SILENCE : (3.5 * bitsPerByte * 1000) / baudRate

function oneOf(setting, value, known) {
  if (known.includes(value)) return
  throw new PlcError('BAD_SETTING', { setting, value, reason: `it must be ${known.join(' or ')}` })
}

function isForMe({ station, counts }, { rtu }) {
  const [to, fn] = rtu
  const row = functionByNumber(fn)
  // not: an answer on its way, a frame for another station; nobody answers a broadcast, so only a write makes sense
  if ((to !== station && to !== BROADCAST) || fn >= EXCEPTION || (to === BROADCAST && (!row || row.reads))) {
    counts.foreign++
    return false
  }
  counts.queries++
  if (to === BROADCAST) counts.broadcasts++
  return true
}

/** @returns {Buffer | null} RTU; null: silence */
function answerTo(chino, rtu, refuse) {
  const { station, counts } = chino
  if (rtu[1] === LOOPBACK) return loopbackOf(chino, rtu, refuse)
  const asked = decodeQuery(rtu)
  const silent = asked.station === BROADCAST
  const exception = refuse ?? judge(chino, asked)
  if (exception) {
    counts.errors++
    return silent ? null : encodeException(rtu[1], station, exception)
  }
  const { query } = /** @type {{ query: import('../codec/modbus/query').Query }} */ (asked)
  const values = execute(chino, query)
  chino.onExecute?.({ at: chino.clock.now(), query, station })
  return silent ? null : encodeAnswer(query, station, values)
}

/** Sub-function 0000 of 08 ("MODBUS application protocol" 6.8); another one is unknown: exception 01. */
function loopbackOf({ station, counts, functions }, rtu, refuse) {
  const known = functions.has(LOOPBACK) && rtu[2] === 0 && rtu[3] === 0
  const exception = refuse ?? (known ? 0 : CODE.FUNCTION)
  if (exception) counts.errors++
  else counts.executed++
  return exception ? encodeException(LOOPBACK, station, exception) : closed(rtu.subarray(0, -2))
}

/** The exception that "MODBUS application protocol" 6 asks for, in its order: function, count, address, then the device's own; 0: none. */
function judge({ functions, limits, memory, protectError }, asked) {
  const fn = asked.query?.fn ?? asked.fn
  const row = functionByNumber(fn)
  if (!row || !functions.has(fn)) return CODE.FUNCTION
  if (asked.exception) return asked.exception
  const { query } = asked
  const count = countOf(query)
  if (count < 1 || count > Math.min(row.most, limits[fn] ?? Infinity)) return CODE.VALUE
  if (!memory.has(row.table, query.base, count)) return CODE.ADDRESS
  if (row.reads) return 0
  if (memory.isProtected(row.table, query.base, count)) return protectError
  return valuesOf(query).every((value, n) => memory.takes(row.table, query.base + n, value)) ? 0 : CODE.VALUE
}

const valuesOf = query => query.values ?? [query.value]

function execute({ memory, writes, counts }, query) {
  counts.executed++
  const { table, reads } = /** @type {import('../codec/modbus/functions').FunctionRow} */ (functionByNumber(query.fn))
  if (reads) return Array.from({ length: query.count }, (_, n) => memory.read(table, query.base + n))
  valuesOf(query).forEach((value, n) => {
    memory.write(table, query.base + n, value)
    noteWrite(writes, `${table}${query.base + n}`)
  })
  return true
}

/** Like another station's answer. Its number is nobody's on this line: the answer to 05 and 06 is a query to whoever has it. */
function disguise(rtu, { random, taken }) {
  const body = Buffer.from(rtu.subarray(0, -2))
  const first = body[0] + random.integer(1, 7)
  const numbers = Array.from({ length: STATIONS.most }, (_, n) => ((first + n - 1) % STATIONS.most) + 1)
  body[0] = numbers.find(number => !taken.includes(number)) ?? body[0]
  const data = body[1] >= EXCEPTION ? body.length : functionByNumber(body[1])?.reads ? 3 : 2
  for (let n = data; n < body.length; n++) body[n] = random.integer(1, 254)
  return closed(body)
}

/**
 * @typedef {Omit<import('./station').Station, 'counts' | 'memory'> & {
 *   memory: import('./modbus-memory').ModbusMemory,
 *   counts: import('./station').Station['counts'] & { broadcasts: number },
 *   breakHeater: (broken?: boolean) => void
 * }} ChinoRegulator `get('400001')`, `get('300007', 'uint32')`, `get('co1000')`; `writes` by explicit address: `hr107`, `co19`;
 *   `heldBetween` takes absolute words (codec/modbus/address.js); breakHeater: the heating model's heater breaks, or is mended
 */

module.exports = { createChinoRegulator }
