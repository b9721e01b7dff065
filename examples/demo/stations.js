'use strict'

const { createLine } = require('../../lib/sim')
const { offer } = require('./offer')

const BAUD_RATE = 38400
const TANK_PERIOD = 90000

const { sin, cos, PI } = Math
const tankFills = time => cos((2 * PI * time) / TANK_PERIOD) < 0

/** What the processes of the two PLCs do: rows of lib/sim/behaviour.js. The regulators bring their own, a heated zone. */
const FURNACE = [
  { at: 'M10', as: 'int16', kind: 'follows', of: 'K0', ofAs: 'int16', from: 250, tau: 12000, ripple: 3, every: 100 },
  { at: 'M11', kind: 'follows', of: 'K0', gain: 0.24, from: 0, tau: 2500, ripple: 9, every: 100 },
  { at: 'M12', as: 'float32', kind: 'counter', step: 0.004, every: 500 },
  { at: 'M0.0', kind: 'toggle', period: 6000 }
]
const TANK = [
  { at: 'M10', as: 'float32', kind: 'sine', from: 25, to: 90, period: TANK_PERIOD, every: 100 },
  { at: 'M12', as: 'float32', kind: time => (tankFills(time) ? 4.2 + 0.15 * sin(time / 700) : 0), every: 100 },
  { at: 'M14', as: 'int32', kind: 'counter', every: 7000 },
  { at: 'M0.0', kind: time => Number(tankFills(time)), every: 100 }
]

/**
 * Two simulated NX PLCs (stations 1 and 2) and two thyristor regulators (11 and 12, MODBUS RTU) on one line at 38400 bit/s: behind a
 * virtual serial port, or behind TCP where there is none.
 * @returns {Promise<{ address: string, settings: object, line: object, close(): Promise<void> }>} settings: properties of `plc-line`;
 *   line: `stations` in the order of their numbers
 */
async function startStations() {
  const line = createLine({
    stations: [
      { device: 'nx', station: 1, behaviour: FURNACE },
      { device: 'nx', station: 2, behaviour: TANK },
      { device: 'chino', station: 11 },
      { device: 'chino', station: 12 }
    ],
    baudRate: BAUD_RATE
  })
  const [furnace, tank, zone1, zone2] = line.stations
  furnace.set('K0', 1500)
  tank.set('K0', 30)
  zone1.set('400001', 250)
  zone2.set('400001', 600)
  return { line, ...(await offer({ wire: line.wire, name: 'nx-line', baudRate: BAUD_RATE })) }
}

module.exports = { startStations }
