'use strict'

/**
 * What a simulated thyristor regulator drives: a heater of 8 ohm on 400 V, and the oven around it. The register map is the
 * simulator's own and that of no real regulator; docs/simulator.md lists it.
 */

const { sin, exp, sqrt, min, max, round } = Math

const MAINS = 400 // V
const COLD = 8 // ohm at room temperature
const PER_KELVIN = 0.0005 // the heater's resistance rises with its temperature
const ROOM = 20 // °C
const KELVIN_PER_WATT = 0.06 // full power ends at about 860 °C
const LAG = 60000 // ms
const TOO_HOT = 800 // °C
const LEAST_STEP = 200 // ms of the integration
const MOST_STEPS = 2000 // however long nobody has looked

const clamp = value => min(1000, max(0, value))
const register = value => min(0xffff, max(0, round(value)))

/** Written by the master; numbers on the wire, so that the address mode does not matter. */
const INPUTS = Object.freeze([
  { at: 'hr0', value: 350, least: 0, most: 1000 }, // manual output, 0.1 %
  { at: 'hr1', value: 1000, least: 0, most: 1000 }, // gradient, 0.1 %
  { at: 'hr2', as: 'int16', value: 0 }, // elevation, 0.1 %
  { at: 'co1000', value: true } // output on
])

/** Computed from them. */
const OUTPUTS = Object.freeze([
  { at: 'ir0', of: state => register(state.output) }, // 0.1 %
  { at: 'ir1', of: state => register(10 * state.voltage) }, // 0.1 V
  { at: 'ir2', of: state => register(10 * state.current) }, // 0.1 A
  { at: 'ir3', of: state => register(state.power) }, // W
  { at: 'ir4', of: state => (state.broken ? 0xffff : register(100 * state.resistance)) }, // 0.01 ohm
  { at: 'ir5', as: 'int16', of: state => round(10 * state.temperature) }, // 0.1 °C
  { at: 'ir6', as: 'uint32', of: state => Math.floor(state.energy) }, // Wh
  { at: 'di1000', of: state => Number(state.broken && state.output > 50) }, // heater break
  { at: 'di1001', of: state => Number(state.temperature > TOO_HOT) } // over-temperature
])

/**
 * @param {(text: string, type?: string) => number | boolean} get what the master has written
 * @returns {{ behaviour: Record<string, any>[], values: ReadonlyArray<Record<string, any>>, ranges: ReadonlyArray<Record<string, any>>,
 *   breakHeater: (broken?: boolean) => void }} behaviour, values, ranges: as in the settings of chino-regulator.js
 */
function createHeating(get) {
  const state = {
    time: 0,
    temperature: ROOM,
    energy: 0,
    broken: false,
    output: 0,
    voltage: 0,
    current: 0,
    power: 0,
    resistance: COLD
  }
  const at = time => {
    advance(state, wanted(get), time)
    return state
  }
  const behaviour = OUTPUTS.map(({ of, ...row }) => ({ ...row, kind: time => of(at(time)), pure: false }))
  const ranges = INPUTS.filter(({ least }) => least !== undefined)
  return { behaviour, values: INPUTS, ranges, breakHeater: (broken = true) => void (state.broken = broken) }
}

/** manual output × gradient + elevation, in 0.1 %. */
function wanted(get) {
  if (!get('co1000')) return 0
  return clamp((Number(get('hr0')) * Number(get('hr1'))) / 1000 + Number(get('hr2', 'int16')))
}

function advance(state, output, time) {
  const step = max(LEAST_STEP, (time - state.time) / MOST_STEPS)
  while (state.time < time) {
    const until = min(time, state.time + step)
    heat(state, until - state.time)
    state.time = until
    drive(state, output)
  }
  // at the same moment, too: what was written shows at once
  drive(state, output)
}

function heat(state, ms) {
  const goal = ROOM + KELVIN_PER_WATT * state.power
  state.temperature = goal + (state.temperature - goal) * exp(-ms / LAG)
  state.energy += (state.power * ms) / 3600000
}

/** The power is proportional to the output; the mains sways a little. */
function drive(state, output) {
  state.output = output
  state.resistance = COLD * (1 + PER_KELVIN * (state.temperature - ROOM))
  state.voltage = MAINS * (1 + 0.01 * sin(state.time / 7000)) * sqrt(output / 1000)
  state.current = state.broken ? 0 : state.voltage / state.resistance
  state.power = state.voltage * state.current
}

module.exports = { createHeating }
