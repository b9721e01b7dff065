'use strict'

/** What the users of a safety run do, and what is checked of it. */

const M0 = 0xc0
const K0 = 0x140
const W0 = 0x200
const STEP = 20 // ms that a value lasts

const STATIONS = [
  { station: 1, steps: 2 },
  { station: 2, steps: 4 },
  { station: 7, steps: 2, soleMaster: true, turnaround: [0, 15] },
  { station: 191, steps: 4, soleMaster: true, turnaround: [2, 40] }
]

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

module.exports = { STATIONS, STEP, checkWrites, noteWrites, step }
