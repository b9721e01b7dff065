'use strict'
const { DEMO, createNxPlc, createRealClock, createWire } = require('../lib/sim/index.js')

// what the examples show beside the simulator's own demo values: K0 is a set value in tenths, M10 follows it, M11 is a load
const EXAMPLES = [
  { at: 'M10', as: 'int16', kind: 'follows', of: 'K0', ofAs: 'int16', from: 250, tau: 20000, ripple: 4, every: 100 },
  { at: 'M11', as: 'uint16', kind: 'sine', from: 200, to: 900, period: 60000, every: 100 }
]
const SET_VALUES = { K0: 1800, K10: 600 }
const ONLY_PLC = 255

const newStation = (station, { areas, clock }) => {
  const plc = createNxPlc({ station, clock, areas, behaviour: [...DEMO, ...EXAMPLES] })
  for (const [address, value] of Object.entries(SET_VALUES)) plc.set(address, value)
  return plc
}

/**
 * The wire of a simulated line. A station keeps its values while the line's configuration lives; one that is not configured
 * any more has no power.
 * @param {{ baudRate: number }} settings
 */
const simulatedWire = ({ baudRate }) => {
  const clock = createRealClock()
  const wire = createWire({ clock, baudRate })
  // the only PLC of a line has a number of its own behind 255
  const numberOf = station => (station === ONLY_PLC ? 1 : station)
  const find = station => wire.stations().find(plc => plc.station === numberOf(station))
  return {
    wire,
    find,
    /** @param {{ station: number, areas: any[] }} settings of nx-config */
    add({ station, areas }) {
      if (find(station)) wire.setOff(numberOf(station), false)
      else wire.add(newStation(numberOf(station), { areas, clock }))
    },
    /** @param {number} station */
    remove: station => wire.setOff(numberOf(station), true)
  }
}

module.exports = { simulatedWire }
