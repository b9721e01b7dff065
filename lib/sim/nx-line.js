'use strict'

const { createRealClock } = require('./clock')
const { createFaults } = require('./faults')
const { createNxPlc } = require('./nx-plc')
const { createRandom } = require('./random')
const { createWire } = require('./wire')

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
 * A whole simulated line: NX stations, faults and the wire that joins them.
 * @param {{ stations?: (number | Record<string, any>)[], baudRate?: number, turnaround?: number | number[], rates?: import('./faults').Fault[],
 *   seed?: number, echo?: boolean, quiet?: boolean, clock?: any, [wire: string]: any }} [settings] stations: numbers, or settings of
 *   nx-plc.js; quiet: no live values; what else stands here is the wire's (wire.js)
 * @returns {{ wire: import('./wire').Wire, plcs: import('./nx-plc').NxPlc[], faults: import('./faults').Faults, clock: any }}
 * @throws {PlcError} BAD_STATION, BAD_SETTING, BAD_AREA, BAD_ADDRESS, BAD_TYPE
 */
function createNxLine(settings = {}) {
  const {
    stations = [1],
    turnaround = 2,
    rates = [],
    seed = 1,
    quiet = false,
    clock = createRealClock(),
    ...rest
  } = settings
  const gap = settings.clock ? {} : { gap: REAL_GAP }
  const random = createRandom(seed)
  const faults = createFaults({ random: random.fork(), rates })
  const wire = createWire({ ...rest, clock, faults, random: random.fork() })
  const plcs = stations.map(each => {
    const own = typeof each === 'number' ? { station: each } : each
    const plc = createNxPlc({ turnaround, behaviour: quiet ? [] : DEMO, random: random.fork(), clock, ...gap, ...own })
    if (!quiet && !own.behaviour) plc.set('K10', 600)
    wire.add(plc)
    return plc
  })
  return { wire, plcs, faults, clock }
}

module.exports = { createNxLine, DEMO }
