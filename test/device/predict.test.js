'use strict'

const assert = require('node:assert/strict')
const { createPool, predict } = require('../../lib')
const { createNxLine, createVirtualClock } = require('../../lib/sim')
const { bench } = require('./support')

const near = (got, expected, share = 1e-6) =>
  assert.ok(Math.abs(got - expected) <= share * expected, `${got} instead of ${expected}`)

const nx = (subscriptions, settings = {}) => ({ settings: { station: 1, ...settings }, subscriptions })
const LINE = { baudRate: 38400 }
const CHARACTER = 10 / 38.4

describe('predict', () => {
  it('NX, ten words: a query of 9 bytes, an answer of 26, 10 ms of silence, 5 of the station', () => {
    const subscriptions = [{ items: ['W0..W9'], interval: 1000, name: 'oven' }]
    const ms = 35 * CHARACTER + 15
    const { percent, busyPercent, asksMost, stations } = predict({ line: LINE, stations: [nx(subscriptions)] })
    near(percent, ms / 10)
    near(busyPercent, (ms - 10) / 10)
    near(stations[0].cycles[0].ms, ms)
    assert.deepEqual([asksMost?.name, asksMost?.requests, asksMost?.station], ['oven', 1, 1])
    // 4-step: 14 bytes, a silence and a wait more
    const four = predict({ line: LINE, stations: [nx(subscriptions, { steps: 4 })] })
    near(four.stations[0].cycles[0].ms, 49 * CHARACTER + 30)
    near(four.busyPercent, (49 * CHARACTER + 10) / 10)
    // repeated by an RR of 7 bytes
    const sole = predict({ line: LINE, stations: [nx(subscriptions, { soleMaster: true })] })
    near(sole.percent, (33 * CHARACTER + 15) / 10)
  })

  it('MODBUS, ten registers: 8 bytes and 25, 3.5 characters of silence; ASCII twice as many and more', () => {
    const character = 10 / 9.6
    const station = protocol => ({
      device: /** @type {const} */ ('chino'),
      settings: { station: 11, protocol },
      subscriptions: [{ items: ['hr0..hr9'], interval: 500 }]
    })
    const cycle = protocol => predict({ line: { baudRate: 9600 }, stations: [station(protocol)] }).stations[0].cycles[0]
    near(cycle('rtu').ms, (33 + 3.5) * character + 5)
    near(cycle('rtu').busy, 33 * character + 5)
    // `:` 12 digits of the query CR LF, `:` and 8 + 40 digits CR LF
    near(cycle('ascii').ms, (17 + 51) * character + 5 + 3.5 * character)
  })

  it('intervals that meet are read together, the same item once', () => {
    const one = { items: ['W0..W9'], interval: 1000 }
    const same = predict({ line: LINE, stations: [nx([one, one, one])] })
    near(same.percent, predict({ line: LINE, stations: [nx([one])] }).percent)
    const { stations } = predict({ line: LINE, stations: [nx([one, { items: ['W10..W19'], interval: 4000 }])] })
    const [{ cycles }] = stations
    assert.deepEqual(
      cycles.map(({ intervals, every, requests }) => [intervals, every, requests]),
      [
        [[1000, 4000], 4000, 1],
        [[1000], 4000 / 3, 1]
      ]
    )
    near(cycles[0].ms, 55 * CHARACTER + 15)
  })

  it('a slow group does not hold up a fast one: it is read apart', () => {
    const fast = { items: ['W0'], interval: 50 }
    const slow = { items: ['M0..M127', 'K0..K127'], interval: 5000 }
    const [{ cycles }] = predict({ line: LINE, stations: [nx([fast, slow])] }).stations
    assert.ok(cycles.every(({ intervals }) => intervals.length === 1))
  })

  it('names who asks for most, of all stations', () => {
    const row = (name, interval) => ({ items: ['W0..W9'], interval, name })
    const stations = [nx([row('a', 1000), row('b', 300)]), nx([row('c', 200)], { station: 2 }), nx([], { station: 3 })]
    const { asksMost } = predict({ line: LINE, stations })
    assert.deepEqual([asksMost?.name, asksMost?.station], ['c', 2])
    assert.equal(predict({ line: LINE, stations: [nx([])] }).asksMost, null)
  })

  it('the silence of the line counts where it is longer', () => {
    const stations = [nx([{ items: ['W0..W9'], interval: 1000 }])]
    near(predict({ line: { ...LINE, gap: 30 }, stations }).percent, (35 * CHARACTER + 35) / 10)
  })

  it('says what is wrong', () => {
    const bad = items => () => predict({ line: LINE, stations: [nx([{ items, interval: 1000 }])] })
    assert.throws(bad(['X0']), { code: 'UNKNOWN_AREA' })
    assert.throws(() => predict({ line: LINE, stations: [nx([], { station: 200 })] }), { code: 'BAD_STATION' })
    const unknown = /** @type {any} */ ({ ...nx([]), device: 'plc' })
    assert.throws(() => predict({ line: LINE, stations: [unknown] }), { code: 'BAD_SETTING' })
  })
})

describe('predicted and measured', () => {
  /** Both, of a line with two stations. */
  const run = async ({ settings, baudRate, groups }) => {
    const clock = createVirtualClock()
    const { wire } = createNxLine({ clock, baudRate, quiet: true, stations: [1, 2], turnaround: 5 })
    const pool = createPool({ clock, random: () => 0.5 })
    const line = { transport: 'simulated', path: 'x', wire, baudRate, echo: 'off' }
    const { createNxPlc } = require('../../lib')
    const lease = pool.open(line, { id: 'a', name: 'a' })
    const monitor = pool.monitor(line)
    const devices = [1, 2].map(station => createNxPlc({ lease, clock, random: () => 0, station, ...settings }))
    const subscriptions = groups.map(({ at, ...group }) => devices[at].subscribe(group, () => {}))
    await clock.advance(20000)
    monitor.statistics()
    await clock.advance(60000)
    const seen = monitor.statistics()
    const costs = subscriptions.map(({ cost }) => cost)
    devices.forEach(device => device.close())
    const after = monitor.statistics().predicted
    monitor.stop()
    await clock.run(lease.release())
    await clock.advance(1000)
    return { seen, costs, after, given: { line: { baudRate }, settings, groups } }
  }
  const items = ['W0..W9', 'M3.4', 'K100', 'W300..W305']
  const groups = [
    { at: 0, items, interval: 500, name: 'a' },
    { at: 0, items: ['M0..M20'], interval: 1000, name: 'b' },
    { at: 1, items, interval: 700, name: 'c' }
  ]

  for (const [name, settings] of Object.entries({
    '2-step': {},
    '4-step': { steps: 4 },
    'by RR': { soleMaster: true }
  })) {
    it(`agree within 3 %: ${name}`, async () => {
      const own = name === 'by RR' ? [groups[0], groups[2]] : groups
      const { seen, costs, after } = await run({ settings, baudRate: 9600, groups: own })
      near(seen.busyPercent, seen.predicted.busyPercent, 0.03)
      assert.ok(seen.predicted.percent > seen.predicted.busyPercent)
      assert.equal(seen.predicted.asksMost, 'a')
      assert.deepEqual(after, { busyPercent: 0, percent: 0, asksMost: '' })
      assert.ok(costs.every(({ advice, linePercent }) => advice === null && linePercent === seen.predicted.percent))
    })
  }

  it('too much is said by the one that asks for most, with an interval that fits', async () => {
    const b = bench({ line: { baudRate: 4800 }, sim: { baudRate: 4800 } })
    const events = []
    b.lease.on('event', event => event.event === 'overrun' && events.push(event))
    const most = b.device.subscribe({ items: ['W0..W127'], interval: 400, name: 'most' }, () => {})
    const less = b.device.subscribe({ items: ['M0'], interval: 800 }, () => {})
    const { advice, percent } = most.cost
    // 9 and 262 bytes, 10 + 5 ms
    near(percent, (100 * (271 * (10 / 4.8) + 15)) / 400, 0.01)
    assert.equal(less.cost.advice, null)
    const [, fits] = /Poll every (\d+) ms/.exec(String(advice)) ?? []
    await b.clock.advance(58000)
    assert.equal(events.length, 1)
    const [{ station, interval, ms, missed, cause, remedy, fits: told }] = events
    assert.deepEqual([station, interval, missed, Math.round(ms / 10)], [1, 400, 3, 58])
    assert.ok(/every 400 ms/.test(cause) && remedy.includes(`${told} ms`))
    await b.clock.advance(60000)
    assert.equal(events.length, 2)
    most.stop()
    less.stop()
    // and it does fit
    const { length } = events
    const again = b.device.subscribe({ items: ['W0..W127'], interval: Number(fits) }, () => {})
    b.device.subscribe({ items: ['M0'], interval: 800 }, () => {})
    assert.equal(again.cost.advice, null)
    // the cycle that was under way holds up the first ones
    await b.clock.advance(5000)
    const { overruns } = b.device.stats
    await b.clock.advance(115000)
    assert.deepEqual([events.length, b.device.stats.overruns], [length, overruns])
    await b.close()
  })

  it('a silent station is no overrun to be told of', async () => {
    const b = bench({ plc: { timeout: 3000, probeFirst: 300 } })
    const events = []
    b.lease.on('event', ({ event }) => events.push(event))
    b.device.subscribe({ items: ['M0'], interval: 100 }, () => {})
    await b.clock.advance(1000)
    b.wire.setOff(1, true)
    await b.clock.advance(60000)
    assert.ok(b.device.stats.overruns > 10 && !events.includes('overrun'), events.join())
    await b.close()
  })
})
