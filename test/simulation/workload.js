'use strict'

/** What the users of a safety run do, and what is checked of it. */

const chino = require('./chino-user')
const nx = require('./nx-user')

const USERS = { nx, chino }
const STEP = 20 // ms that a value lasts

const NX = [
  { device: 'nx', station: 1, steps: 2 },
  { device: 'nx', station: 2, steps: 4 },
  { device: 'nx', station: 7, steps: 2, soleMaster: true, turnaround: [0, 15] },
  { device: 'nx', station: 191, steps: 4, soleMaster: true, turnaround: [2, 40] }
]

/** All may repeat by an RR alone; frames are so short that a poll takes several of them. */
const SOLE = NX.map(row => ({
  ...row,
  soleMaster: true,
  settings: { limits: { readWords: 5, readBits: 20, readMixed: 4 } }
}))

/** Regulators in one protocol: every write function, a read bit unit, short frames. */
const regulators = protocol =>
  [
    { station: 11 },
    { station: 12, settings: { coilFunction: '05', holdingFunction: '06', coilUnit: 8, discreteUnit: 16 } },
    { station: 20, settings: { coilFunction: 'auto', holdingFunction: 'auto' }, turnaround: [0, 15] },
    { station: 247, settings: { inputRead: 7, holdingRead: 5, holdingWrite: 2 }, turnaround: [2, 40] }
  ].map(row => ({ device: 'chino', protocol, ...row }))

/** Both on one line; a regulator must not have a number that a PLC's master uses (192 to 254). */
const mixed = protocol => [...NX.slice(0, 3), ...regulators(protocol).slice(0, 3)]

/** What a station of the simulated line is made of. */
const simulated = (row, writes) => ({
  device: row.device,
  station: row.station,
  turnaround: row.turnaround ?? 2,
  protocol: row.protocol ?? 'rtu',
  history: true,
  behaviour: USERS[row.device].LIVE.map(live => ({ ...live, kind: 'random', every: STEP, seed: row.station })),
  onExecute: ({ query }) => noteWrites(writes, row, query)
})

const createDevice = (row, common) => USERS[row.device].createDevice(row, { ...common, station: row.station })

const step = (system, index) =>
  !system.uniform && system.random.chance(0.25) ? write(system, index) : read(system, index)

const drawItem = ({ random, rows }, index) => USERS[rows[index].device].randomItem(random)

/** @returns {Promise<boolean>} whether every value was good */
async function read(system, index) {
  const { clock, random, report, devices, rows } = system
  const { randomItem, randomWord } = USERS[rows[index].device]
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
  const asked = names.map(name => items.find(({ text }) => text === name))
  results.forEach((result, n) => judge(system, { index, item: asked[n], result, from, to: clock.now() }))
  return results.length > 0 && results.every(({ quality }) => quality === 'good')
}

const EVIDENCE = 2 // wrong values that are shown with the frames before them
const FRAMES = 200

function judge({ report, rows, line, lease }, { index, item, result: { quality, code, value }, from, to }) {
  if (quality === 'bad') {
    report.bad++
    report.codes[code] = (report.codes[code] ?? 0) + 1
    return
  }
  report.good++
  if (isHeld(line.stations[index], item, { value, from, to })) return
  const frames = report.wrong.length < EVIDENCE ? lease.line.trace().slice(-FRAMES) : []
  report.wrong.push({ station: rows[index].station, item: item.text, from, to, got: value, frames })
}

/** Whether the station held this value there, at some moment. */
function isHeld(station, { unit, address, count }, { value, from, to }) {
  const values = unit === 'packed' ? bitsOf(value) : count === 1 ? [value] : value
  return values.every((one, n) => {
    if (unit === 'word') return station.heldBetween(address + n, from, to).includes(one)
    const bit = address + n
    return station.heldBetween(bit >> 4, from, to).some(each => ((each >> (bit & 15)) & 1) === Number(one))
  })
}

const bitsOf = word => Array.from({ length: 16 }, (_, n) => (word >> n) & 1)

/** @returns {Promise<string>} the outcome */
async function write(system, index) {
  const { random, report, devices, rows } = system
  const first = random.integer(0, 100)
  const entries = Array.from({ length: random.integer(1, 3) }, (_, n) => newEntry(system, rows[index], first + 2 * n))
  report.asked++
  const outcome = await devices[index].write(entries.map(({ item, value }) => ({ item, value })))
  report.settled++
  report.outcomes[outcome.outcome]++
  outcome.items.forEach((item, n) =>
    system.writes.set(entries[n].key, { ...entryOf(system, entries[n].key), said: item.outcome })
  )
  return outcome.outcome
}

function newEntry(system, { device, station }, number) {
  for (;;) {
    const entry = USERS[device].newEntry({ random: system.random, serial: () => ++system.serial }, number)
    const key = `${station}:${entry.key}`
    if (!system.writes.has(key)) return { ...entry, key }
  }
}

const entryOf = ({ writes }, key) => writes.get(key) ?? { times: 0 }

function noteWrites(writes, { device, station }, query) {
  for (const each of USERS[device].keysOf(query)) {
    const key = `${station}:${each}`
    const entry = writes.get(key) ?? { times: 0 }
    writes.set(key, { ...entry, times: entry.times + 1 })
  }
}

const TIMES = { confirmed: [1], unknown: [0, 1], refused: [0], failed: [0], notSent: [0] }

function checkWrites({ writes, report, line }) {
  for (const [key, { times, said }] of writes) {
    if (times > 1) report.doubled.push(key)
    if (!TIMES[said]?.includes(times)) report.misreported.push({ key, times, said })
  }
  // the stations' own count of what was written where
  report.executed = line.stations.reduce((sum, each) => [...each.writes.values()].reduce((a, b) => a + b, sum), 0)
}

module.exports = {
  NX,
  SOLE,
  checkWrites,
  createDevice,
  isHeld,
  judge,
  mixed,
  drawItem,
  read,
  regulators,
  simulated,
  step,
  write
}
