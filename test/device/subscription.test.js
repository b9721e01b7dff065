'use strict'

const assert = require('node:assert/strict')
const { createThrottle, openNxPlc, createPool } = require('../../lib')
const { createNxLine, createVirtualClock } = require('../../lib/sim')
const { bench } = require('./support')

const code = expected => error => error.code === expected

describe('NX PLC: polling', () => {
  let b
  const start = options => (b = bench(options))
  afterEach(async () => {
    await b.close()
    assert.equal(b.clock.pending(), 0, 'a timer is left')
  })

  it('comes at once, then at the interval without drift', async () => {
    start()
    const times = []
    b.device.subscribe({ items: ['M0'], interval: 100 }, results => {
      assert.equal(results[0].quality, 'good')
      times.push(b.clock.now())
    })
    await b.clock.advance(60000)
    assert.equal(times.length, 600)
    // the time of one exchange may differ a little, but no delay adds up
    times.forEach((time, at) => assert.ok(Math.abs(time - times[0] - at * 100) < 5, `${at}: ${time}`))
  })

  it('or after one interval', async () => {
    start()
    let count = 0
    b.device.subscribe({ items: ['M0'], interval: 1000, immediately: false }, () => count++)
    await b.clock.advance(990)
    assert.equal(count, 0)
    await b.clock.advance(100)
    assert.equal(count, 1)
  })

  it('a jump of the wall clock changes nothing', async () => {
    start()
    let count = 0
    b.device.subscribe({ items: ['M0'], interval: 100 }, () => count++)
    await b.clock.advance(1000)
    b.clock.jumpWall(-3600000)
    await b.clock.advance(1000)
    b.clock.jumpWall(7200000)
    await b.clock.advance(1000)
    assert.equal(count, 30)
  })

  it('cycles that come too early are counted and left out, not piled up', async () => {
    start()
    let count = 0
    const subscription = b.device.subscribe({ items: ['M0..M127'], interval: 20 }, () => count++)
    await b.clock.advance(10000)
    assert.ok(subscription.overruns > 300, `${subscription.overruns} overruns`)
    assert.ok(Math.abs(count + subscription.overruns - 500) <= 2)
    assert.equal(b.device.stats.overruns, subscription.overruns)
    assert.ok(b.lease.line.stats().waiting <= 1)
  })

  it('a timer that fires a little early makes no cycle of its own', async () => {
    start()
    // as Node.js does now and then
    const clock = { ...b.clock, setTimer: (fn, ms) => b.clock.setTimer(fn, Math.max(0, ms - 0.8)) }
    let count = 0
    const device = b.make({ clock })
    const subscription = device.subscribe({ items: ['M0'], interval: 100 }, () => count++)
    await b.clock.advance(10000)
    assert.deepEqual([count, subscription.overruns], [100, 0])
    device.close()
  })

  it('an error is news once, and so is its end', async () => {
    start({ plc: { attempts: 1, timeout: 50 } })
    const news = []
    b.device.subscribe({ items: ['M0', 'K5'], interval: 1000 }, (results, { changed, failure }) => {
      if (changed) news.push(failure?.code ?? results.map(({ quality }) => quality).join())
    })
    await b.clock.advance(3000)
    b.wire.setOff(1, true)
    await b.clock.advance(10000)
    b.wire.setOff(1, false)
    await b.clock.advance(10000)
    assert.deepEqual(news, ['good,good', 'TIMEOUT', 'STATION_DEMOTED', 'good,good'])
  })

  it('one bad item of several is no failure of the cycle, and a cycle has its duration', async () => {
    start()
    const cycles = []
    b.device.subscribe({ items: ['K5', 'M0', '@0x1800'], interval: 1000 }, (results, cycle) =>
      cycles.push([results.map(({ quality }) => quality).join(), cycle.failure, cycle.ms > 0 && cycle.ms < 500])
    )
    await b.clock.advance(2500)
    assert.ok(cycles.length >= 2)
    for (const cycle of cycles) assert.deepEqual(cycle, ['good,good,bad', null, true])
  })

  it('recovers by itself when the adapter comes back', async () => {
    start()
    const seen = []
    b.device.subscribe({ items: ['M0'], interval: 500 }, ([result]) => seen.push(result.quality))
    await b.clock.advance(2000)
    b.wire.unplug()
    await b.clock.advance(5000)
    assert.equal(seen.at(-1), 'bad')
    b.wire.plug()
    await b.clock.advance(10000)
    assert.equal(seen.at(-1), 'good')
  })

  it('takes other items, and stops for good', async () => {
    start()
    const seen = []
    const subscription = b.device.subscribe({ items: ['M0'], interval: 100 }, results => seen.push(results[0].name))
    await b.clock.advance(250)
    subscription.setItems(['K1'])
    await b.clock.advance(200)
    assert.throws(() => subscription.setItems(['X1']), code('UNKNOWN_AREA'))
    subscription.stop()
    await b.clock.advance(1000)
    assert.deepEqual([...new Set(seen)], ['M0', 'K1'])
    assert.equal(b.device.stats.subscriptions, 0)
    assert.equal(seen.length, 5)
  })

  it('nothing is reported after the end', async () => {
    start()
    let count = 0
    b.device.subscribe({ items: ['M0..M127'], interval: 1000 }, () => count++)
    await b.clock.advance(60)
    b.device.close()
    await b.clock.advance(1000)
    assert.equal(count, 0)
    assert.throws(() => b.device.subscribe({ items: ['M0'], interval: 1000 }, () => {}), code('LINE_CLOSED'))
  })

  it('refuses what cannot be polled', () => {
    start()
    for (const interval of [0, 9, -1, NaN, Infinity, 86400001, 'soon', undefined]) {
      assert.throws(
        () => b.device.subscribe({ items: ['M0'], interval }, () => {}),
        code('BAD_SETTING'),
        String(interval)
      )
    }
    assert.throws(() => b.device.subscribe({ items: ['M999'], interval: 100 }, () => {}), code('OUT_OF_AREA'))
    assert.throws(() => b.device.subscribe({ items: [], interval: 100 }, () => {}), code('BAD_ITEMS'))
  })

  it('a write goes before the polls that wait', async () => {
    start({ plc: { access: 'write' } })
    for (let n = 0; n < 10; n++) b.device.subscribe({ items: [`M${n * 10}..M${n * 10 + 9}`], interval: 50 }, () => {})
    await b.clock.advance(1000)
    const outcome = await b.run(b.device.write([{ item: 'K0', value: 1 }], { fixed: true }))
    assert.equal(outcome.outcome, 'confirmed')
    assert.ok(outcome.ms < 120, `${outcome.ms} ms`)
  })
})

describe('openNxPlc', () => {
  it('reads, writes and closes in a few lines', async () => {
    const clock = createVirtualClock()
    const { wire, plcs } = createNxLine({ clock, quiet: true, stations: [1] })
    const pool = createPool({ clock, random: () => 0.5 })
    const options = { pool, clock, transport: 'simulated', path: 'x', wire, echo: 'off', station: 1 }
    const plc = openNxPlc({ ...options, access: 'write' })
    const [outcome] = await clock.run(Promise.all([plc.write({ K0: 5, 'K127.12': true })]))
    assert.equal(outcome.outcome, 'confirmed')
    assert.equal(plcs[0].get('K127.12'), true)
    const results = await clock.run(plc.read(['K0', 'K127.12']))
    assert.deepEqual(
      results.map(({ value }) => value),
      [5, true]
    )
    assert.equal((await clock.run(plc.read('K0')))[0].value, 5)
    const second = openNxPlc({ ...options, station: '1' })
    assert.equal((await clock.run(second.write({ K0: 6 }))).code, 'READ_ONLY')
    await clock.run(Promise.all([plc.close(), second.close(), plc.close()]))
    assert.equal(clock.pending(), 0)
    assert.deepEqual(pool.lines(), [])
  })

  it('gives the line back if the settings are wrong', async () => {
    const clock = createVirtualClock()
    const { wire } = createNxLine({ clock, quiet: true })
    const pool = createPool({ clock })
    assert.throws(
      () => openNxPlc({ pool, clock, transport: 'simulated', path: 'x', wire, station: 200 }),
      code('BAD_STATION')
    )
    assert.throws(() => openNxPlc({ pool, clock, station: 1 }), code('BAD_SETTING'))
    await clock.drain()
    assert.deepEqual(pool.lines(), [])
  })
})

describe('throttle', () => {
  it('passes the first value at once and of several the last one', async () => {
    const clock = createVirtualClock()
    const seen = []
    const call = createThrottle({ interval: 1000, clock }, value => seen.push([clock.now(), value]))
    call(1)
    await clock.advance(100)
    call(2)
    call(3)
    await clock.advance(5000)
    call(4)
    call(5)
    call.cancel()
    await clock.advance(5000)
    assert.deepEqual(seen, [
      [0, 1],
      [1000, 3],
      [5100, 4]
    ])
    assert.equal(clock.pending(), 0)
  })
})
