'use strict'
const { PlcError } = require('../error')
const { TABLES, describeAddress } = require('../codec/modbus/address')
const { planTableWrites, planTables } = require('../plan')
const { modbusNotation } = require('../tag/modbus-notation')
const { TURNAROUND, blank, choice, isOn, nameOf, readHealth, readRanges, wholeNumber } = require('./options')

/** The configuration of a CHINO regulator, read and checked before anything is sent. Panel manual, driver settings. */

const LAST_STATION = 247
const MOST_SINGLES = 123 // frames in one conversation: a longer one would hold up the other stations

/** Whole numbers: [setting, default, least, most]. Counts are the protocol's own limits at most. */
const NUMBERS = Object.freeze(
  /** @type {[string, number, number, number][]} */ ([
    ['timeout', 1000, 10, 600000],
    ['sendWait', 0, 0, 10000],
    ['attempts', 3, 1, 20],
    ['coilRead', 2000, 1, 2000],
    ['coilUnit', 1, 1, 2000],
    ['coilWrite', 1968, 1, 1968],
    ['discreteRead', 2000, 1, 2000],
    ['discreteUnit', 1, 1, 2000],
    ['inputRead', 125, 1, 125],
    ['holdingRead', 125, 1, 125],
    ['holdingWrite', 123, 1, 123],
    ['turnaround', 100, 0, 10000],
    ['writeInterval', 0, 0, 3600000],
    ['deadline', 0, 0, 3600000]
  ])
)

/** Choices: the first one is the default. */
const CHOICES = Object.freeze({
  protocol: ['rtu', 'ascii'],
  addressMode: ['1-base', '0-base'],
  coilFunction: ['0F', '05', 'auto'],
  holdingFunction: ['10', '06', 'auto'],
  wordOrder: ['low', 'high'],
  byteOrder: ['high', 'low'],
  access: ['read', 'write']
})

/**
 * @param {unknown} value
 * @param {boolean} broadcast whether 0 is allowed
 * @returns {number} 0..247
 * @throws {PlcError} BAD_STATION, BROADCAST_REFUSED
 */
const readStation = (value, broadcast) => {
  const number = typeof value === 'string' && /^\s*\d{1,3}\s*$/.test(value) ? Number(value) : value
  if (typeof number !== 'number' || !Number.isInteger(number) || number < 0 || number > LAST_STATION) {
    throw new PlcError('BAD_STATION', { station: value, reason: 'it must be 1 to 247, or 0 for a broadcast' })
  }
  if (number === 0 && !broadcast) {
    throw new PlcError('BROADCAST_REFUSED', { what: 'station 0', reason: 'broadcasts are not allowed here' })
  }
  return number
}

/** Each of `wholeNumber` and `choice`. @returns {Record<string, any>} */
const plainSettings = given => {
  /** @type {Record<string, any>} */
  const settings = {}
  for (const [name, fallback, least, most] of NUMBERS) {
    settings[name] = wholeNumber(name, given[name], { fallback, least, most })
  }
  for (const [name, known] of Object.entries(CHOICES)) settings[name] = choice(name, readable(given[name]), known)
  for (const [unit, read] of [
    ['coilUnit', 'coilRead'],
    ['discreteUnit', 'discreteRead']
  ]) {
    if (settings[unit] <= settings[read]) continue
    const reason = `it is more than the max read count, ${settings[read]}`
    throw new PlcError('BAD_SETTING', { setting: unit, value: settings[unit], reason })
  }
  return settings
}

/** JSON may hold 10 for '10', 5 for '05'; flows hold texts in any case. */
const readable = value => {
  if (typeof value !== 'number' && typeof value !== 'string') return value
  const text = String(value).trim()
  const same = each => each.toLowerCase() === text.toLowerCase() || each === text.padStart(2, '0')
  return Object.values(CHOICES).flat().find(same) ?? value
}

const readCount = (most, unit = 1) => most - (most % unit)

/** The four tables with the limits of this station: what it is asked for at once stays inside them also when it is rounded up. */
const tablesOf = (settings, costs) => {
  const { coilRead, coilUnit, discreteRead, discreteUnit, inputRead, holdingRead } = settings
  // a function of one value has a frame for each: the count of one frame does not bind it
  const write = (chosen, count) => (chosen === '05' || chosen === '06' ? MOST_SINGLES : count)
  const limits = {
    co: {
      unit: coilUnit,
      read: readCount(coilRead, coilUnit),
      write: write(settings.coilFunction, settings.coilWrite)
    },
    di: { unit: discreteUnit, read: readCount(discreteRead, discreteUnit), write: 0 },
    ir: { read: inputRead, write: 0 },
    hr: { read: holdingRead, write: write(settings.holdingFunction, settings.holdingWrite) }
  }
  return TABLES.map(({ table, kind, base, size }) => ({
    kind,
    from: base,
    to: base + size,
    ...costs,
    ...limits[table]
  }))
}

/** Silence before a frame: 3.5 characters in RTU, 1.75 ms at least (MODBUS over serial line, 2.5.1.1). ms */
const LEAST_GAP = 1.75
const gapOf = ({ framing, sendWait }, { character, gap = 0 }) =>
  Math.max(gap, sendWait, framing === 'ascii' ? 0 : Math.max(LEAST_GAP, 3.5 * character))

/** What a request costs beside its data, in byte times: the frames' own bytes, silence, the station's time. ASCII has two characters for a byte. */
const costsOf = (framing, { gap, character, turnaround }) => {
  const wait = (gap + turnaround) / character
  // query 8 and answer 5 bytes; ASCII: 17 and 11 characters
  return framing === 'ascii' ? { frameCost: 28 - 3 + wait, scale: 2 } : { frameCost: 13 - 3 + wait }
}

const SPLITS = new Set(['MODBUS_ILLEGAL_ADDRESS', 'MODBUS_ILLEGAL_VALUE'])
const ABSENT = new Set(['MODBUS_ILLEGAL_ADDRESS'])

/** @param {any} settings @param {{ character: number, gap?: number }} times @returns {import('./options').Plan} */
const planOf = (settings, times) => {
  const gap = gapOf(settings, times)
  const { character } = times
  const tablesFor = turnaround => tablesOf(settings, costsOf(settings.framing, { gap, character, turnaround }))
  const tables = tablesFor(TURNAROUND)
  return {
    gap,
    silences: 1,
    reads: (points, { holes, turnaround = TURNAROUND } = {}) => planTables(points, tablesFor(turnaround), { holes }),
    writes: points => planTableWrites(points, tables),
    splits: SPLITS,
    absent: ABSENT,
    simpler: () => false
  }
}

const REASONS = Object.freeze({ area: 'discrete inputs and input registers can only be read', throughWord: '' })

const refuseBroadcast = (what, reason) => {
  throw new PlcError('BROADCAST_REFUSED', { what, reason })
}

/** What cannot be done to all stations at once. */
const broadcastChecks = station => {
  if (station !== 0) return {}
  return {
    checkRead: () => refuseBroadcast('a read', 'no station answers a broadcast'),
    checkWrite: ({ points, steps }, { verify }) => {
      if (steps.length > 0) refuseBroadcast(steps[0].text, 'its largest step needs what each station holds now')
      const bit = points.find(({ through }) => through)
      if (bit) refuseBroadcast(bit.text, 'one bit of a register is written by reading the register first')
      if (verify) refuseBroadcast('a write that is read back', 'no station answers a broadcast')
    }
  }
}

/**
 * @param {Record<string, any>} given see `createChinoRegulator`
 * @param {number} [character] ms that one character takes on the line
 * @param {number} [lineGap] ms of silence that the line keeps before each frame
 * @throws {PlcError} BAD_STATION, BROADCAST_REFUSED, BAD_SETTING, BAD_TAG, BAD_ADDRESS and its like for the ranges
 */
const readSettings = (given, character = 0.52, lineGap = 0) => {
  const broadcast = isOn(given.broadcast)
  const station = readStation(given.station, broadcast)
  const { protocol: framing, ...settings } = plainSettings(given)
  const { addressMode, wordOrder, byteOrder, coilFunction, holdingFunction, turnaround } = settings
  const notation = modbusNotation({ addressMode, tags: given.tags, wordOrder, byteOrder })
  return {
    ...settings,
    ...readHealth(given),
    protocol: 'modbus',
    framing,
    station,
    name: blank(given.name) && station === 0 ? 'all stations' : nameOf(given.name, station),
    probe08: isOn(given.probe08),
    broadcast: broadcast ? { turnaround } : null,
    ranges: readRanges(given.writableRanges, notation),
    notation,
    reasons: REASONS,
    functions: { co: coilFunction, hr: holdingFunction },
    units: { 1: settings.coilUnit, 2: settings.discreteUnit },
    describe: (place, { write }) => describeAddress(place, { write, coilFunction, holdingFunction }),
    plan: planOf({ ...settings, framing }, { character, gap: lineGap }),
    ...broadcastChecks(station)
  }
}

module.exports = { readSettings, readStation }
