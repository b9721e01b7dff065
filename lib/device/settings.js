'use strict'
const { PlcError } = require('../error')
const { masterIdList } = require('../codec/nx/ids')
const { limitsOf } = require('../codec/nx/limits')
const { nxNotation } = require('../tag/nx-notation')
const { describeAddress } = require('../codec/nx/address')
const { planReads, planWrites } = require('../plan')
const { TURNAROUND, choice, isOn, nameOf, readHealth, readRanges, wholeNumber } = require('./options')

/** The configuration of an NX PLC, read and checked before anything is sent. */

const LAST_STATION = 191
const ANY_STATION = 255
const GAP = 10 // ms: what the manual's own program waits before each Q and RR

/**
 * @param {unknown} value
 * @returns {number} 0..191, or 255 for the only PLC of a line
 * @throws {PlcError} BAD_STATION
 */
const readStation = value => {
  const number = typeof value === 'string' && /^\s*\d{1,3}\s*$/.test(value) ? Number(value) : value
  if (typeof number !== 'number' || !Number.isInteger(number) || number < 0 || number > 255) {
    throw new PlcError('BAD_STATION', {
      station: value,
      reason: 'it must be 0 to 191, or 255 for the only PLC of a line'
    })
  }
  if (number > LAST_STATION && number !== ANY_STATION) {
    throw new PlcError('BAD_STATION', { station: number, reason: '192 to 254 are numbers of masters' })
  }
  return number
}

// `E2..E9` as hex without a mark: a number with a letter cannot be decimal
const markHex = value =>
  typeof value === 'string' ? value.replace(/(?<![$\w])(?=\d?[a-f])[\da-f]{2}(?!\w)/gi, '0x$&') : value

/**
 * The master IDs of a configuration, as numbers.
 * @param {unknown} value as the option `masterIds`: `E2..E9`
 * @param {number[]} [stations] of the line
 * @returns {readonly number[]}
 * @throws {PlcError} BAD_MASTER_ID
 */
const masterIdsOf = (value, stations = []) => masterIdList(markHex(value), { stations })

/** Absolute word addresses at which an area begins or ends. */
const boundsOf = areas => areas.list.flatMap(({ base, words }) => [base, base + words])

/** Words whose bits are the same memory: a bit may be read with its word. */
const jointOf = areas => areas.list.filter(({ as }) => as === 'both').map(({ base, words }) => [base, base + words])

/**
 * What a request costs beside its INFO, in byte times: heads and CRC of the frames, gaps, the station's time. `again`: repeated by an RR, where
 * nobody else may have asked the station meanwhile.
 */
const costsOf = ({ steps, gap, character, turnaround, repeats }) => {
  const wait = (gap + turnaround) / character
  const frameCost = steps === 4 ? 26 + 2 * wait : 12 + wait
  return repeats ? { frameCost, again: 13 + wait } : { frameCost }
}

const SPLITS = new Set(['PLC_OUT_OF_RANGE', 'PLC_FRAME_TOO_LONG'])
const ABSENT = new Set(['PLC_OUT_OF_RANGE'])
const UNKNOWN_FUNCTION = new Set(['PLC_WRONG_FUNCTION', 'PLC_NO_SERVICE'])

/**
 * How points become requests; a CPU without the mixed read is asked without it.
 * @param {any} given limits: those of the planner
 * @param {{ steps: 2|4, gap: number, character: number, soleMaster: boolean }} wire
 * @returns {import('./options').Plan}
 */
const planOf = (given, { soleMaster, ...wire }) => {
  let limits = given
  const costs = ({ turnaround = TURNAROUND, repeats = true }) =>
    costsOf({ ...wire, turnaround, repeats: soleMaster && repeats })
  return {
    gap: wire.gap,
    silences: wire.steps === 4 ? 2 : 1,
    reads: (points, facts = {}) => planReads(points, { ...limits, ...costs(facts), holes: facts.holes }),
    writes: points => planWrites(points, limits),
    splits: SPLITS,
    absent: ABSENT,
    simpler: ({ ask }, { code }) => {
      if (ask !== 'readMixed' || !UNKNOWN_FUNCTION.has(code)) return false
      limits = { ...limits, readMixed: 0 }
      return true
    }
  }
}

const REASONS = Object.freeze({
  area: 'its area is unconfirmed or not for writing; confirm its row in the area table first',
  throughWord: 'its area has only words: a single bit of it cannot be written'
})

/**
 * @param {Record<string, any>} given see `createNxPlc`
 * @param {number} character ms that one character takes on the line
 * @param {number} [lineGap] ms of silence that the line keeps before each frame
 * @throws {PlcError} BAD_STATION, BAD_MASTER_ID, BAD_SETTING, BAD_AREA, BAD_TAG, BAD_ADDRESS and its like for the ranges
 */
const readSettings = (given, character, lineGap = 0) => {
  const station = readStation(given.station)
  const steps = /** @type {2|4} */ (choice('steps', given.steps, [2, 4]))
  const gap = wholeNumber('gap', given.gap, { fallback: GAP, least: 0, most: 10000 }) || GAP
  const wordOrder = choice('wordOrder', given.wordOrder, ['low', 'high'])
  const byteOrder = choice('byteOrder', given.byteOrder, ['low', 'high'])
  const notation = nxNotation({ areas: given.areas || [], tags: given.tags, wordOrder, byteOrder })
  const stations = [...(given.stations ?? []), station]
  const limits = limitsOf(given.limits)
  const soleMaster = isOn(given.soleMaster)
  const memory = { bounds: boundsOf(notation.areas), joint: jointOf(notation.areas) }
  return {
    protocol: 'nx',
    station,
    steps,
    gap,
    name: nameOf(given.name, station),
    timeout: wholeNumber('timeout', given.timeout, { fallback: 3000, least: 10, most: 600000 }),
    attempts: wholeNumber('attempts', given.attempts, { fallback: 3, least: 1, most: 20 }),
    ...readHealth(given),
    masterIds: masterIdsOf(given.masterIds, stations),
    soleMaster,
    access: choice('access', given.access, ['read', 'write']),
    ranges: readRanges(given.writableRanges, notation),
    writeInterval: wholeNumber('writeInterval', given.writeInterval, { fallback: 0, least: 0, most: 3600000 }),
    deadline: wholeNumber('deadline', given.deadline, { fallback: 0, least: 0, most: 3600000 }),
    notation,
    limits,
    reasons: REASONS,
    describe: (place, { write }) => describeAddress(place, { steps, write }),
    plan: planOf({ ...limits, ...memory }, { steps, gap: Math.max(gap, lineGap), character, soleMaster })
  }
}

module.exports = { masterIdsOf, readSettings, readStation }
