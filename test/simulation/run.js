'use strict'

/**
 * The safety run: a whole system (pool, line, devices, simulated stations on a faulty wire) in virtual time, from a seed.
 * Whatever the faults are, it checks only: no wrong value is accepted, every request settles exactly once, no write is
 * doubled, and what an outcome says is what the station did.
 *
 * With `polls` groups are polled beside it, and `phases` times the faults stop and begin again (liveness): then every station and every group must
 * be well within the bound that the settings promise.
 *
 * Wrong: a value delivered as good that the station did not hold there at any moment between request and answer. All values
 * that are read change all the time, each address by its own sequence, so a stale or foreign one shows.
 */

const { createPool } = require('../../lib/line')
const { createLine, createRandom, createVirtualClock } = require('../../lib/sim')
const { drawGroups, startPolls } = require('./polls')
const { recover, resume } = require('./recover')
const { NX, checkWrites, createDevice, simulated, step } = require('./workload')

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
 * @param {boolean} [options.polls] whether groups are polled, too
 * @param {number} [options.phases] how often the faults stop and all must come back; the exchanges are shared among them
 * @param {number} [options.pause] ms that a user waits at most between two requests
 * @param {Record<string, any>} [options.device] further settings of the devices
 * @param {Record<string, any>} [options.wire] further settings of the line
 * @returns {Promise<Report>}
 */
async function safetyRun(options) {
  const { seed, exchanges = 5000, recovery = true, phases = 1 } = options
  const { system, open } = createSystem(options)
  const { clock, line, report } = system
  let count = {}
  for (let phase = 1; phase <= phases; phase++) {
    const until = Math.ceil((exchanges * phase) / phases)
    await clock.run(drive(system, { open, until }), { name: `safety run ${seed}` })
    count = { ...line.faults.counts }
    if (recovery) await clock.run(recover(system), { name: 'recovery' })
    if (phase < phases) resume(system)
  }
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

const ADAPTER = 16 // ms: an adapter gives what it has at the latest then (docs/wiring.md, latency timer)

function createSystem(options) {
  const { seed, stations: rows = NX, faults = FAULTS, collisions = true, echo = false, baudRate = 38400 } = options
  const { unplugs = 0.001, uniform = false, polls = false, pause = 20, device, wire } = options
  const random = createRandom(seed)
  const clock = createVirtualClock()
  const writes = new Map()
  const line = createLine({
    clock,
    echo,
    collisions,
    seed: random.integer(0, 2 ** 32 - 1),
    baudRate,
    rates: faults,
    chunk: () => Math.min(random.pick([1, 3, 16, 64]), Math.max(1, Math.floor((ADAPTER * baudRate) / 10000))),
    stations: rows.map(row => simulated(row, writes))
  })
  const pool = createPool({ clock, random: random.next })
  const report = emptyReport(seed)
  const system = { rows, clock, line, random, writes, report, faults, baudRate, unplugs, pause, device, wire, uniform }
  Object.assign(system, { serial: 0, pool, groups: [] })
  if (polls) system.groups = drawGroups(system)
  const open = () => openSystem(system)
  open()
  return { system, open }
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
  cycles: 0,
  repeats: 0,
  late: 0,
  events: {},
  recovered: 0,
  bound: Infinity,
  overdue: [],
  relapses: 0
})

/** A demoted station is asked again soon: virtual time that passes without exchanges proves little. */
const HEALTH = { probeFirst: 300, probeMost: 2400 }
const TIMEOUT = 150

/** What users hold: one lease, one device per station and its polls; closing gives all back. */
function openSystem(system) {
  const { pool, line, clock, random, rows, baudRate, report } = system
  const settings = {
    transport: 'simulated',
    path: 'safety',
    wire: line.wire,
    baudRate,
    openGrace: 500,
    ...system.wire
  }
  const lease = pool.open(settings, { id: 'safety', name: 'safety run' })
  lease.on('event', ({ event }) => {
    report.events[event] = (report.events[event] ?? 0) + 1
    if (event === 'late') report.late++
  })
  const health = { ...HEALTH, timeout: TIMEOUT, attempts: 2, ...system.device }
  const common = { lease, clock, random: random.next, access: 'write', ...health }
  const devices = rows.map(row => createDevice(row, common))
  Object.assign(system, { lease, devices, common: health })
  startPolls(system)
  system.close = async () => {
    report.repeats += devices.reduce((sum, { stats }) => sum + (stats.repeats ?? 0), 0)
    devices.forEach(device => device.close())
    await lease.release()
  }
}

/** Two users per station ask without a pause, until the stations have heard enough. */
async function drive(system, { open, until }) {
  const { line } = system
  const user = async index => {
    while (heard(line) < until) {
      await step(system, index)
      await chaos(system, open)
    }
  }
  const users = system.uniform ? [0, 0] : system.rows.flatMap((_, index) => [index, index])
  await Promise.all(users.map(user))
}

/** An adapter is pulled, or a flow is deployed anew, in the middle of whatever the others do. */
async function chaos(system, open) {
  const { random, unplugs, line, clock, report, pause } = system
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
  // a line that is down, or a station that is, refuses at once: let time pass
  await new Promise(resolve => clock.setTimer(() => resolve(undefined), random.integer(0, pause)))
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
 * @property {number} cycles of polled groups
 * @property {number} repeats reads that came by an RR alone
 * @property {number} late late answers that the line has told of
 * @property {Record<string, number>} events of the line, by name
 * @property {number} recovered ms until every station and group gave good values, after the faults had stopped: the longest of all phases
 * @property {number} bound ms that this may take by the settings
 * @property {any[]} overdue phases that took longer
 * @property {number} relapses reads and writes that failed after that
 * @property {number} open lines left open
 * @property {number} timers left
 * @property {number} virtualMs
 * @property {Record<string, number>} faults
 * @property {number} redeploys
 * @property {number} unplugged
 */

module.exports = { safetyRun, createSystem, FAULTS }
