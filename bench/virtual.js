'use strict'

/** A simulated NX PLC on a line in virtual time, read by our device with our plan or with another planner's. */

const { createPool, predict } = require('../lib')
const { limitsOf } = require('../lib/codec/nx/limits')
const { Device } = require('../lib/device/device')
const { Health } = require('../lib/device/health')
const { readSettings } = require('../lib/device/settings')
const { Talk } = require('../lib/device/talk')
const { createNxLine, createVirtualClock } = require('../lib/sim')

const BAUD = 38400
const TURNAROUND = 5
const GAP = 10
const CHARACTER = 10000 / BAUD

/** What a request costs beside its INFO, by the protocol: 12 bytes of heads and CRC, 26 in 4-step; each time the gap and the station's own. */
const frameCost = steps =>
  steps === 4 ? 26 + 2 * ((GAP + TURNAROUND) / CHARACTER) : 12 + (GAP + TURNAROUND) / CHARACTER

/** @param {number} steps @param {any} settings of the device @returns {import('./planners').Limits} */
const limitsFor = (steps, { notation }) => ({
  ...limitsOf(),
  frameCost: frameCost(steps),
  bounds: notation.areas.list.flatMap(({ base, words }) => [base, base + words])
})

const silence = () => 0.5

/** @param {{ lease: any, clock: any, planner?: Function, [setting: string]: any }} options planner: another one than ours */
const openDevice = ({ lease, clock, planner, ...given }) => {
  const settings = readSettings({ station: 1, timeout: 500, ...given }, CHARACTER)
  if (planner) {
    const limits = limitsFor(settings.steps, settings)
    settings.plan = { ...settings.plan, reads: points => planner(points, limits) }
  }
  const health = new Health({ lease, clock, settings, random: silence })
  const talk = new Talk({ lease, health, settings, random: silence })
  return new Device({ settings, line: lease.line, talk, health, clock, random: silence })
}

/** What our own plan says that a cycle takes, ms. @param {string[]} items @param {{ steps?: 2|4, soleMaster?: boolean }} [options] */
const predictedOf = (items, { steps = 2, soleMaster = false } = {}) => {
  const station = { settings: { station: 1, steps, soleMaster, gap: GAP }, subscriptions: [{ items, interval: 60000 }] }
  const [{ cycles }] = predict({ line: { baudRate: BAUD }, stations: [station] }).stations
  return cycles[0].ms
}

const checked = results => {
  const bad = results.find(({ quality }) => quality !== 'good')
  if (bad) throw new Error(`${bad.name}: ${bad.text}`)
  return results
}

/** Another value in each word, so that no planner can serve a wrong one unnoticed. */
const fill = memory => {
  for (const { base, words } of memory.areas.list)
    for (let word = base; word < base + words; word++) memory.writeWord(word, (word * 40503) & 0xffff)
}

/**
 * Reads items over and over, without a pause.
 * @param {string[]} items
 * @param {{ steps?: 2|4, soleMaster?: boolean, planner?: Function }} [options]
 * @returns {Promise<{ measured: number, requests: number, values: any[] }>} ms and requests of a cycle; the values of all items
 */
const cycleOf = async (items, { steps = 2, soleMaster = false, planner } = {}) => {
  const clock = createVirtualClock()
  const { wire, plcs } = createNxLine({ clock, baudRate: BAUD, turnaround: TURNAROUND, quiet: true, stations: [1] })
  fill(plcs[0].memory)
  const pool = createPool({ clock, random: silence })
  const line = { transport: 'simulated', path: 'bench', wire, baudRate: BAUD, echo: 'off' }
  const lease = pool.open(line, { id: 'bench', name: 'bench' })
  const device = openDevice({ lease, clock, planner, steps, soleMaster, gap: GAP })
  const read = async () => checked(await clock.run(device.read(items)))
  // with RR the order of requests turns each cycle
  const cycles = soleMaster ? 4 : 1
  try {
    await read()
    const { requests: before } = device.stats
    const from = clock.now()
    for (let n = 0; n < cycles; n++) await read()
    const measured = (clock.now() - from) / cycles
    const requests = (device.stats.requests - before) / cycles
    const values = (await read()).map(({ value }) => value)
    return { measured, requests, values }
  } finally {
    device.close()
    await clock.run(lease.release())
  }
}

module.exports = { cycleOf, predictedOf }
