'use strict'

const { createRealClock } = require('./clock')
const { createChinoRegulator } = require('./chino-regulator')
const { createFaults } = require('./faults')
const { createNxPlc } = require('./nx-plc')
const { createRandom } = require('./random')
const { createWire } = require('./wire')
const { PlcError } = require('../error')

// Real programs and kernels make pauses inside a frame that are none on a wire
const REAL_GAP = 25

// A process that shows something: W10 is a temperature (float32) behind its set point K10 (int16, tenths of a degree),
// K127.12 switches a pump whose feedback is M1.0; M0 counts seconds
const DEMO = [
  { at: 'M0', kind: 'counter', every: 1000 },
  { at: 'M1.0', kind: 'follows', of: 'K127.12', tau: 1 },
  { at: 'M1.1', kind: 'toggle', period: 4000 },
  { at: 'M2', kind: 'ramp', from: 0, to: 1000, period: 60000 },
  { at: 'M3', as: 'int16', kind: 'sine', from: -500, to: 500, period: 30000 },
  { at: 'W10', as: 'float32', kind: 'follows', of: 'K10', ofAs: 'int16', gain: 0.1, from: 20, tau: 8000, ripple: 0.15 },
  { at: 'W12', as: 'float32', kind: 'sine', from: 0.8, to: 1.2, period: 20000 }
]

/**
 * The kinds of stations: numbers they can have, the highest error they answer, and how one is made.
 * @type {Record<string, { least: number, most: number, errors: number, make: (own: any, line: { common: any, quiet: boolean }) => any }>}
 */
const DEVICES = {
  nx: { least: 0, most: 191, errors: 5, make: makeNx },
  chino: { least: 1, most: 247, errors: 255, make: makeChino }
}

function makeNx(own, { common, quiet }) {
  const plc = createNxPlc({ behaviour: quiet ? [] : DEMO, ...common, ...own })
  if (!quiet && !own.behaviour) plc.set('K10', 600)
  return plc
}

function makeChino(own, { common: { gap, ...common }, quiet }) {
  const settings = { ...(quiet ? { heating: false } : {}), ...common, ...own }
  // the pauses of programs lie within what ASCII allows between two characters
  return createChinoRegulator(settings.protocol === 'ascii' || !gap ? settings : { gap, ...settings })
}

/**
 * A whole simulated line: stations of any kind, faults and the wire that joins them.
 * @param {{ stations?: (number | Record<string, any>)[], device?: string, protocol?: 'rtu'|'ascii', baudRate?: number,
 *   turnaround?: number | number[], rates?: import('./faults').Fault[], seed?: number, echo?: boolean, quiet?: boolean, clock?: any,
 *   [wire: string]: any }} [settings] stations: numbers, or `{ device: 'nx'|'chino', station, … }` with settings of nx-plc.js or
 *   chino-regulator.js; device: what a station is that does not say it (nx); protocol: of the regulators that do not say it (rtu);
 *   quiet: no live values; what else stands here is the wire's (wire.js)
 * @returns {{ wire: import('./wire').Wire, stations: any[], faults: import('./faults').Faults, clock: any }} stations in the order of the settings
 * @throws {PlcError} BAD_STATION, BAD_SETTING, BAD_AREA, BAD_ADDRESS, BAD_TYPE
 */
function createLine(settings = {}) {
  const {
    stations = [1],
    device = 'nx',
    protocol = 'rtu',
    turnaround = 2,
    rates = [],
    seed = 1,
    quiet = false,
    clock = createRealClock(),
    ...rest
  } = settings
  const rows = stations.map(each => ({ device, ...(typeof each === 'number' ? { station: each } : each) }))
  const kinds = rows.map(row => kindOf(row.device))
  const random = createRandom(seed)
  const errors = Math.min(...kinds.map(kind => kind.errors))
  const faults = createFaults({ random: random.fork(), rates, errors })
  const wire = createWire({ ...rest, clock, faults, random: random.fork() })
  const { baudRate, bitsPerByte } = rest
  const common = { turnaround, protocol, baudRate, bitsPerByte, clock, ...(settings.clock ? {} : { gap: REAL_GAP }) }
  const made = rows.map((row, n) => kinds[n].make(row, { common: { ...common, random: random.fork() }, quiet }))
  made.forEach(wire.add)
  return { wire, stations: made, faults, clock }
}

function kindOf(device) {
  if (Object.hasOwn(DEVICES, device)) return DEVICES[device]
  const reason = `known are ${Object.keys(DEVICES).join(', ')}`
  throw new PlcError('BAD_SETTING', { setting: 'device', value: device, reason })
}

/** What a kind of station allows, for those who read settings of users. */
const simulatedDevices = () =>
  Object.entries(DEVICES).map(([device, { least, most, errors }]) => ({ device, least, most, errors }))

/**
 * The same with NX stations alone, which are called `plcs`.
 * @param {Parameters<typeof createLine>[0]} [settings]
 * @returns {{ wire: import('./wire').Wire, plcs: import('./nx-plc').NxPlc[], faults: import('./faults').Faults, clock: any }}
 * @throws {PlcError} BAD_STATION, BAD_SETTING, BAD_AREA, BAD_ADDRESS, BAD_TYPE
 */
function createNxLine(settings) {
  const { stations, ...line } = createLine(settings)
  return { ...line, plcs: stations }
}

module.exports = { createLine, createNxLine, simulatedDevices, DEMO }
