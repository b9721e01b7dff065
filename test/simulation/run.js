'use strict'

/**
 * The safety run: a whole system (pool, line, devices, simulated stations on a faulty wire) in virtual time, from a seed.
 * Whatever the faults are, it checks only: no wrong value is accepted, every request settles exactly once, no write is
 * doubled, and what an outcome says is what the station did.
 *
 * Wrong: a value delivered as good that the station did not hold there at any moment between request and answer. All values
 * that are read change all the time, each address by its own sequence, so a stale or foreign one shows.
 */

const { createPool } = require('../../lib/line')
const { createLine, createRandom, createVirtualClock } = require('../../lib/sim')
const { NX, checkWrites, createDevice, read, simulated, step, write } = require('./workload')

/** 30 % of all answers: each kind of fault that the claim of zero wrong values covers. */
const FAULTS = [
  ['late', 0.04],
  ['silent', 0.03],
  ['lost', 0.02],
  ['error', 0.02],
  ['crc', 0.04],
  ['truncated', 0.03],
  ['duplicated', 0.03],
  ['foreign', 0.03],
  ['before', 0.015],
  ['after', 0.015],
  ['echo', 0.015],
  ['merged', 0.013],
  ['off', 0.002]
].map(([kind, rate]) => ({ kind: String(kind), rate: Number(rate) }))

/**
 * @param {object} options
 * @param {number} options.seed
 * @param {Record<string, any>[]} [options.stations] rows of workload.js
 * @param {number} [options.exchanges] queries and RRs that the stations hear at least
 * @param {{ kind: string, rate: number, argument?: number }[]} [options.faults]
 * @param {boolean} [options.collisions] see lib/sim/wire.js
 * @param {boolean} [options.echo] the adapter hears itself
 * @param {number} [options.unplugs] rate of unplugging and of redeploying per request
 * @param {boolean} [options.uniform] only one word at a time is read, from one station: answers differ in nothing but the value
 * @param {boolean} [options.recovery] whether the faults end at last, and all stations must come back
 * @param {Record<string, any>} [options.device] further settings of the devices
 * @param {Record<string, any>} [options.wire] further settings of the line
 * @returns {Promise<Report>}
 */
async function safetyRun(options) {
  const { seed, exchanges = 5000, stations: rows = NX, faults = FAULTS, collisions = true, echo = false } = options
  const { unplugs = 0.001, uniform = false, recovery = true, device, wire } = options
  const random = createRandom(seed)
  const clock = createVirtualClock()
  const writes = new Map()
  const line = createLine({
    clock,
    echo,
    collisions,
    seed: random.integer(0, 2 ** 32 - 1),
    baudRate: 38400,
    rates: faults,
    chunk: () => random.pick([1, 3, 16, 64]),
    stations: rows.map(row => simulated(row, writes))
  })
  const report = emptyReport(seed)
  const system = {
    rows,
    clock,
    line,
    random,
    writes,
    report,
    unplugs,
    device,
    wire,
    uniform,
    serial: 0,
    pool: createPool({ clock, random: random.next })
  }
  const open = () => openSystem(system)
  await clock.run(drive(system, { open, exchanges }), { name: `safety run ${seed}` })
  const count = { ...line.faults.counts }
  if (recovery) await clock.run(recover(system), { name: 'recovery' })
  await clock.run(system.close(), { name: 'closing' })
  await clock.drain()
  checkWrites(system)
  return Object.assign(report, {
    open: system.pool.lines().length,
    timers: clock.pending(),
    exchanges: heard(line),
    virtualMs: Math.round(clock.now()),
    faults: count
  })
}

const heard = ({ stations }) => stations.reduce((sum, { counts }) => sum + counts.queries, 0)

const emptyReport = seed => ({
  seed,
  asked: 0,
  settled: 0,
  exchanges: 0,
  good: 0,
  bad: 0,
  rejected: {},
  outcomes: { confirmed: 0, unknown: 0, refused: 0, failed: 0 },
  codes: {},
  redeploys: 0,
  unplugged: 0,
  wrong: [],
  doubled: [],
  misreported: [],
  executed: 0,
  recovered: 0,
  relapses: 0
})

/** What users hold: one lease and one device per station; closing gives all back. */
function openSystem(system) {
  const { pool, line, clock, random, rows } = system
  const settings = {
    transport: 'simulated',
    path: 'safety',
    wire: line.wire,
    baudRate: 38400,
    openGrace: 500,
    ...system.wire
  }
  const lease = pool.open(settings, { id: 'safety', name: 'safety run' })
  const common = { lease, clock, random: random.next, timeout: 150, attempts: 2, access: 'write', ...system.device }
  const devices = rows.map(row => createDevice(row, common))
  system.devices = devices
  system.close = async () => {
    devices.forEach(device => device.close())
    await lease.release()
  }
}

/** Two users per station ask without a pause, until the stations have heard enough. */
async function drive(system, { open, exchanges }) {
  const { line } = system
  open()
  const user = async index => {
    while (heard(line) < exchanges) {
      await step(system, index)
      await chaos(system, open)
    }
  }
  const users = system.uniform ? [0, 0] : system.rows.flatMap((_, index) => [index, index])
  await Promise.all(users.map(user))
}

const PATIENCE = 10000 // ms: the longest back-off, a dark station, the bound of lateness

/** Liveness: the faults stop. Everything must come back by itself, and then nothing may be bad any more. */
async function recover(system) {
  const { clock, line, report, rows } = system
  line.faults.clear()
  line.wire.plug()
  const start = clock.now()
  const pause = () => new Promise(resolve => clock.setTimer(() => resolve(undefined), 50))
  await Promise.all(
    rows.map(async (_, index) => {
      while (!(await read(system, index)) && clock.now() - start < PATIENCE) await pause()
    })
  )
  report.recovered = clock.now() - start
  for (let n = 0; n < 5 * rows.length; n++) {
    const index = n % rows.length
    if (!(await read(system, index))) report.relapses++
    if ((await write(system, index)) !== 'confirmed') report.relapses++
  }
}

/** An adapter is pulled, or a flow is deployed anew, in the middle of whatever the others do. */
async function chaos(system, open) {
  const { random, unplugs, line, clock, report } = system
  if (random.chance(unplugs)) {
    report.unplugged++
    line.wire.unplug()
    clock.setTimer(() => line.wire.plug(), random.integer(0, 600))
  }
  if (random.chance(unplugs)) {
    report.redeploys++
    const { close } = system
    const closing = close()
    open()
    await closing
  }
  // a line that is down refuses at once: let time pass
  await new Promise(resolve => clock.setTimer(() => resolve(undefined), random.integer(0, 20)))
}

/**
 * @typedef {object} Report
 * @property {number} seed replays the run
 * @property {number} asked requests
 * @property {number} settled requests that ended: the same number
 * @property {number} exchanges queries and RRs that stations heard
 * @property {number} good values delivered as good
 * @property {number} bad values delivered as bad
 * @property {Record<string, number>} rejected reads that rejected, by code
 * @property {Record<string, number>} outcomes of writes
 * @property {Record<string, number>} codes of bad values
 * @property {any[]} wrong
 * @property {any[]} doubled writes that a station carried out more than once
 * @property {any[]} misreported writes whose outcome contradicts what the station did
 * @property {number} executed values that stations wrote, by their own count
 * @property {number} recovered ms until every station gave good values, after the faults had stopped
 * @property {number} relapses reads and writes that failed after that
 * @property {number} open lines left open
 * @property {number} timers left
 * @property {number} virtualMs
 * @property {Record<string, number>} faults
 * @property {number} redeploys
 * @property {number} unplugged
 */

module.exports = { safetyRun, FAULTS, PATIENCE }
