'use strict'

const assert = require('node:assert')
const { createPool, createNxPlc, createChinoRegulator } = require('../../lib')
const { createLine, createRandom, createVirtualClock } = require('../../lib/sim')
const { isHeld } = require('./workload')

const MINUTE = 60000
const BITS = 0x200000 // coils, as absolute addresses
const INPUT = 0x10000

/** What is polled, as `isHeld` takes it, and what is written meanwhile. */
const NX_ITEMS = [
  { text: 'M0..M9', unit: 'word', address: 0xc0, count: 10 },
  { text: 'W3', unit: 'word', address: 0x203, count: 1 },
  { text: 'M20.5', unit: 'bit', address: 0xd4 * 16 + 5, count: 1 }
]
const CHINO_ITEMS = [
  { text: '300001..300010', unit: 'word', address: INPUT, count: 10 },
  { text: '400006', unit: 'word', address: 5, count: 1 },
  { text: '400008.03', unit: 'bit', address: 7 * 16 + 3, count: 1 },
  { text: '000004..000021', unit: 'bit', address: BITS + 3, count: 18 }
]

const rowsOf = (names, seed) => names.map(at => ({ at, as: 'uint16', kind: 'random', every: 20, seed }))
const numbered = (text, count) => Array.from({ length: count }, (_, n) => `${text}${n}`)
const nx = {
  device: 'nx',
  station: 1,
  behaviour: rowsOf([...numbered('M', 32), 'W3'], 1),
  items: NX_ITEMS,
  interval: 400,
  target: 'K'
}
const chino = (station, interval) => ({
  device: 'chino',
  station,
  behaviour: rowsOf([...numbered('ir', 16), ...numbered('hr', 16), 'co0', 'co16'], station),
  items: CHINO_ITEMS,
  interval,
  target: 'hr5'
})
const MEMBERS = [nx, chino(11, 500), chino(12, 800), chino(13, 1500)]

/** The line, a device and a poll for each station. */
function openLine(protocol, baudRate) {
  const clock = createVirtualClock()
  const stations = MEMBERS.map(({ device, station, behaviour }) => ({ device, station, behaviour, history: true }))
  const line = createLine({ clock, baudRate, protocol, turnaround: [2, 8], seed: 60, stations })
  const random = createRandom(61)
  const pool = createPool({ clock, random: random.next })
  const settings = { transport: 'simulated', path: 'mixed', wire: line.wire, baudRate }
  const lease = pool.open(settings, { id: 'mixed', name: 'mixed line' })
  const devices = MEMBERS.map(({ device, station }) => {
    const common = { lease, clock, random: random.next, station, access: 'write', latenessBound: 1000 }
    if (device === 'nx') return createNxPlc({ ...common, writableRanges: 'K0..K127' })
    return createChinoRegulator({ ...common, protocol, writableRanges: 'hr50..hr59' })
  })
  return { clock, line, random, lease, devices }
}

/** Polls every station at its rate; gives what it has seen. */
function poll({ clock, line, devices }) {
  return MEMBERS.map(({ items, interval }, index) => {
    const seen = {
      cycles: 0,
      good: 0,
      bad: [],
      wrong: [],
      overruns: () => subscription.overruns,
      stop: () => subscription.stop()
    }
    const callback = (results, { ms }) => {
      const to = clock.now()
      seen.cycles++
      results.forEach(({ quality, code, value }, n) => {
        if (quality !== 'good') return seen.bad.push(code)
        seen.good++
        const held = isHeld(line.stations[index], items[n], { value, from: to - ms, to })
        if (!held) seen.wrong.push({ item: items[n].text, to, value })
      })
    }
    const subscription = devices[index].subscribe({ items: items.map(({ text }) => text), interval }, callback)
    return seen
  })
}

/** Load: somebody asks and sets, every station in turn, all the time. */
async function load({ clock, random, devices, line }, until) {
  const outcomes = { confirmed: 0 }
  let value = 0
  while (clock.now() < until) {
    const index = random.integer(0, MEMBERS.length - 1)
    const item = `${MEMBERS[index].target}${random.integer(0, 9)}`
    const { outcome } = await devices[index].write([{ item, value: ++value }])
    outcomes[outcome] = (outcomes[outcome] ?? 0) + 1
    assert.strictEqual(line.stations[index].get(item), value)
    const [result] = await devices[index].read([item])
    assert.deepStrictEqual([result.quality, result.value], ['good', value])
    await new Promise(resolve => clock.setTimer(() => resolve(undefined), random.integer(20, 100)))
  }
  return outcomes
}

describe('an NX PLC and three regulators on one RS-485 line for a minute, under load', function () {
  this.timeout(30000)
  // ASCII needs twice the characters, and gets twice the speed
  for (const [protocol, baudRate] of [
    ['rtu', 19200],
    ['ascii', 38400]
  ]) {
    it(`${protocol}: no wrong value, each polled at its rate`, async () => {
      const system = openLine(protocol, baudRate)
      const { clock, line, lease, devices } = system
      // after opening, each station waits its bound of lateness
      const warm = Promise.all(devices.map((device, n) => device.read([MEMBERS[n].items[1].text])))
      await clock.run(warm)
      const start = clock.now()
      const seen = poll(system)
      const outcomes = await clock.run(load(system, start + MINUTE), { name: 'load' })
      const minutes = (clock.now() - start) / MINUTE
      const { busy } = lease.line.stats()
      seen.forEach(({ cycles, good, bad, wrong, overruns }, n) => {
        const { station, interval, items } = MEMBERS[n]
        assert.deepStrictEqual([bad, wrong, overruns()], [[], [], 0], `station ${station}`)
        assert.strictEqual(good, cycles * items.length)
        const expected = (minutes * MINUTE) / interval
        assert.ok(Math.abs(cycles - expected) <= 2, `station ${station}: ${cycles} cycles of ${expected}`)
      })
      assert.deepStrictEqual(Object.keys(outcomes), ['confirmed'])
      assert.ok(outcomes.confirmed > 200, String(outcomes.confirmed))
      // "under load": most of the minute the wire is in use
      assert.ok(busy > 0.5 * MINUTE, `${busy} ms of ${MINUTE}`)
      assert.deepStrictEqual([line.wire.counts.collisions, lease.line.stats().timeouts], [0, 0])
      seen.forEach(each => each.stop())
      devices.forEach(device => device.close())
      await clock.run(lease.release())
      await clock.drain()
    })
  }
})
