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
const { createNxPlc } = require('../../lib/device/nx-plc')
const { createNxLine, createRandom, createVirtualClock } = require('../../lib/sim')

const M0 = 0xc0
const K0 = 0x140
const W0 = 0x200
const STEP = 20 // ms that a value lasts

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

const STATIONS = [
  { station: 1, steps: 2 },
  { station: 2, steps: 4 },
  { station: 7, steps: 2, soleMaster: true, turnaround: [0, 15] },
  { station: 191, steps: 4, soleMaster: true, turnaround: [2, 40] }
]

/**
 * @param {object} options
 * @param {number} options.seed
 * @param {number} [options.exchanges] queries and RRs that the stations hear at least
 * @param {{ kind: string, rate: number, argument?: number }[]} [options.faults]
 * @param {boolean} [options.collisions] see lib/sim/wire.js
 * @param {boolean} [options.echo] the adapter hears itself
 * @param {number} [options.unplugs] rate of unplugging and of redeploying per request
 * @param {boolean} [options.uniform] only one word at a time is read, from one station: answers differ in nothing but the value
 * @param {Record<string, any>} [options.device] further settings of the devices
 * @param {Record<string, any>} [options.wire] further settings of the line
 * @returns {Promise<Report>}
 */
async function safetyRun(options) {
  const {
    seed,
    exchanges = 5000,
    faults = FAULTS,
    collisions = true,
    echo = false,
    unplugs = 0.001,
    uniform = false,
    device,
    wire
  } = options
  const random = createRandom(seed)
  const clock = createVirtualClock()
  const writes = new Map()
  const live = Array.from({ length: 128 }, (_, n) => [`M${n}`, `W${n}`]).flat()
  const line = createNxLine({
    clock,
    echo,
    collisions,
    seed: random.integer(0, 2 ** 32 - 1),
    baudRate: 38400,
    rates: faults,
    chunk: () => random.pick([1, 3, 16, 64]),
    stations: STATIONS.map(({ station, turnaround = 2 }) => ({
      station,
      turnaround,
      history: true,
      behaviour: live.map(at => ({ at, kind: 'random', every: STEP, seed: station })),
      onExecute: ({ query }) => noteWrites(writes, station, query)
    }))
  })
  const report = emptyReport(seed)
  const system = {
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
  await clock.run(system.close(), { name: 'closing' })
  await clock.drain()
  checkWrites(system)
  return Object.assign(report, {
    open: system.pool.lines().length,
    timers: clock.pending(),
    exchanges: heard(line),
    virtualMs: Math.round(clock.now()),
    faults: line.faults.counts
  })
}

const heard = ({ plcs }) => plcs.reduce((sum, { counts }) => sum + counts.queries, 0)

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
  misreported: []
})

/** What users hold: one lease and one device per station; closing gives all back. */
function openSystem(system) {
  const { pool, line, clock, random } = system
  const settings = {
    transport: 'simulated',
    path: 'safety',
    wire: line.wire,
    baudRate: 38400,
    openGrace: 500,
    ...system.wire
  }
  const lease = pool.open(settings, { id: 'safety', name: 'safety run' })
  const devices = STATIONS.map(({ station, steps, soleMaster }) =>
    createNxPlc({
      lease,
      clock,
      random: random.next,
      station,
      steps,
      soleMaster,
      timeout: 150,
      attempts: 2,
      access: 'write',
      writableRanges: 'K0..K127',
      ...system.device
    })
  )
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
  const users = system.uniform ? [0, 0] : STATIONS.flatMap((_, index) => [index, index])
  await Promise.all(users.map(user))
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

const step = (system, index) =>
  !system.uniform && system.random.chance(0.25) ? write(system, index) : read(system, index)

async function read(system, index) {
  const { clock, random, report, line, devices } = system
  const items = system.uniform
    ? [randomWord(random)]
    : Array.from({ length: random.integer(1, 6) }, () => randomItem(random))
  const names = [...new Set(items.map(({ text }) => text))]
  const from = clock.now()
  report.asked++
  const results = await devices[index].read(names, { priority: random.pick([1, 2]) }).catch(error => {
    report.rejected[error.code ?? error.message] = (report.rejected[error.code ?? error.message] ?? 0) + 1
    return []
  })
  report.settled++
  const to = clock.now()
  results.forEach((result, n) => {
    if (result.quality === 'bad') return noteCode(report, result.code)
    report.good++
    const item = items.find(({ text }) => text === names[n])
    const held = check(line.plcs[index], item, { value: result.value, from, to })
    if (held) report.wrong.push({ station: STATIONS[index].station, item: item?.text, from, to, got: result.value })
  })
}

function noteCode(report, code) {
  report.bad++
  report.codes[code] = (report.codes[code] ?? 0) + 1
}

function randomWord(random) {
  const number = random.integer(0, 127)
  return { text: `W${number}`, word: W0 + number, bit: null, count: 1 }
}

function randomItem(random) {
  const [area, base] = random.pick([
    ['M', M0],
    ['W', W0],
    ['K', K0]
  ])
  const number = random.integer(0, 110)
  if (area !== 'W' && random.chance(0.3)) {
    const bit = random.integer(0, 15)
    return { text: `${area}${number}.${bit}`, word: base + number, bit, count: 1 }
  }
  const count = random.chance(0.3) ? random.integer(2, 16) : 1
  const text = count === 1 ? `${area}${number}` : `${area}${number}..${area}${number + count - 1}`
  return { text, word: base + number, bit: null, count }
}

/** @returns {boolean} whether the value is wrong */
function check(plc, { word, bit, count }, { value, from, to }) {
  const values = count === 1 ? [value] : value
  return values.some((one, n) => {
    const held = plc.heldBetween(word + n, from, to)
    return bit === null ? !held.includes(one) : !held.some(each => ((each >> bit) & 1) === Number(one))
  })
}

/** Writes a value that was never written before, so that each write can be told from all others. */
async function write(system, index) {
  const { random, report, devices } = system
  const { station } = STATIONS[index]
  const first = random.integer(0, 100)
  const entries = Array.from({ length: random.integer(1, 3) }, (_, n) => newEntry(system, station, first + 2 * n))
  report.asked++
  const outcome = await devices[index].write(entries.map(({ item, value }) => ({ item, value })))
  report.settled++
  report.outcomes[outcome.outcome]++
  outcome.items.forEach((item, n) =>
    system.writes.set(entries[n].key, { ...entryOf(system, entries[n].key), said: item.outcome })
  )
}

function newEntry(system, station, number) {
  for (;;) {
    const value = ++system.serial & 0xffff
    const key = `${station}:${K0 + number}:${value}`
    if (!system.writes.has(key)) return { item: `K${number}`, value, key }
  }
}

const entryOf = ({ writes }, key) => writes.get(key) ?? { times: 0 }

function noteWrites(writes, station, query) {
  if (!query.ask.startsWith('write')) return
  const places = query.writes ?? query.values.map((value, n) => ({ address: query.base + n, value }))
  for (const { address, value } of places) {
    const key = `${station}:${address}:${value}`
    const entry = writes.get(key) ?? { times: 0 }
    writes.set(key, { ...entry, times: entry.times + 1 })
  }
}

const TIMES = { confirmed: [1], unknown: [0, 1], refused: [0], failed: [0], notSent: [0] }

function checkWrites({ writes, report }) {
  for (const [key, { times, said }] of writes) {
    if (times > 1) report.doubled.push(key)
    if (!TIMES[said]?.includes(times)) report.misreported.push({ key, times, said })
  }
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
 * @property {number} open lines left open
 * @property {number} timers left
 * @property {number} virtualMs
 * @property {Record<string, number>} faults
 * @property {number} redeploys
 * @property {number} unplugged
 */

module.exports = { safetyRun, FAULTS }
