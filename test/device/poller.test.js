'use strict'

const assert = require('node:assert/strict')
const { nxNotation, parseItem } = require('../../lib')
const { Grid } = require('../../lib/device/phases')
const { Poller } = require('../../lib/device/poller')
const { Subscription } = require('../../lib/device/subscription')
const { createVirtualClock } = require('../../lib/sim')
const { bench } = require('./support')

/** A poller whose station takes `ms` for each point, and says its address. */
const open = ({ ms = 1, line = {}, station = 1, clock = createVirtualClock(), early = 0 } = {}) => {
  const reads = []
  const overrun = []
  const hasty = { ...clock, setTimer: (fn, wait) => clock.setTimer(fn, Math.max(0, wait - early)) }
  const poller = new Poller({
    clock: hasty,
    random: () => 0,
    grid: new Grid(line, station),
    read: points =>
      new Promise(resolve => {
        reads.push({ at: clock.now(), points: points.map(({ address }) => address - M0) })
        const at = clock.wall()
        clock.setTimer(() => resolve(points.map(({ address }) => ({ raw: [address - M0], at }))), ms * points.length)
      }),
    estimate: points => ms * points.length,
    overrun: member => overrun.push(member)
  })
  const add = (addresses, interval, { callback = () => {}, immediately = true } = /** @type {any} */ ({})) => {
    const seen = []
    const heard = (results, cycle) => {
      seen.push({ at: clock.now(), values: results.map(({ value }) => value), ...cycle })
      callback(results, cycle)
    }
    const subscription = new Subscription({ clock, items: itemsOf(addresses), interval, callback: heard })
    subscription.repeat = own => poller.now([own])
    poller.add(subscription, { immediately })
    const stop = () => {
      subscription.stopped = true
      poller.remove(subscription)
    }
    return { seen, subscription, stop, times: () => seen.map(({ at }) => at) }
  }
  return { clock, poller, reads, overrun, add }
}

const notation = nxNotation({ areas: [] })
const M0 = 0xc0
const itemsOf = addresses => addresses.map(address => parseItem(`M${address}`, notation))

describe('poller', () => {
  it('reads what is due at the same moment by one plan, and gives each its own', async () => {
    const { clock, reads, add } = open()
    const one = add([1, 2], 1000)
    const two = add([2, 3], 1000)
    await clock.advance(2500)
    assert.deepEqual(
      reads.map(({ points }) => points),
      Array(3).fill([1, 2, 2, 3])
    )
    assert.deepEqual(
      [one, two].map(({ seen }) => seen.map(({ values }) => values)),
      [Array(3).fill([1, 2]), Array(3).fill([2, 3])]
    )
  })

  it('different intervals come together where they meet', async () => {
    const { clock, reads, add } = open()
    add([1], 100)
    add([2], 300)
    await clock.advance(950)
    assert.deepEqual(
      reads.map(({ at, points }) => [at, points]),
      [
        [0, [1, 2]],
        [100, [1]],
        [200, [1]],
        [300, [1, 2]],
        [400, [1]],
        [500, [1]],
        [600, [1, 2]],
        [700, [1]],
        [800, [1]],
        [900, [1, 2]]
      ]
    )
  })

  it('who comes later comes onto the same grid', async () => {
    const { clock, reads, add } = open()
    add([1], 1000)
    await clock.advance(1300)
    const late = add([2], 1000)
    await clock.advance(5000)
    // at once, then three quarters of an interval later at least
    assert.deepEqual(late.times().slice(0, 3), [1301, 3002, 4002])
    assert.equal(late.subscription.overruns, 0)
    assert.ok(reads.filter(({ at }) => at >= 3000).every(({ points }) => points.length === 2))
  })

  it('a slow group does not hold up a fast one', async () => {
    const { clock, reads, add } = open({ ms: 10 })
    const fast = add([1], 100)
    const slow = add([2, 3, 4, 5, 6, 7, 8, 9], 1000)
    await clock.advance(3050)
    assert.deepEqual(
      fast.seen.map(({ ms }) => ms),
      Array(31).fill(10)
    )
    assert.equal(fast.subscription.overruns, 0)
    assert.equal(slow.seen.length, 3)
    assert.deepEqual(
      reads.filter(({ points }) => points.length > 1).map(({ points }) => points[0]),
      [2, 2, 2, 2]
    )
    // but with less to read they share: 40 of 100 ms
    const { clock: other, reads: few, add: more } = open({ ms: 10 })
    more([1], 100)
    more([2, 3, 4], 1000)
    await other.advance(50)
    assert.deepEqual(
      few.map(({ points }) => points),
      [[1, 2, 3, 4]]
    )
  })

  it('keeps its times for an hour, whatever the timers do', async () => {
    const early = 0.9
    const { clock, reads, add } = open({ early, ms: 3 })
    const { subscription } = add([1], 1000)
    await clock.advance(3600000 - 1)
    assert.deepEqual([reads.length, subscription.overruns], [3600, 0])
    const last = reads.at(-1) ?? { at: 0 }
    assert.ok(Math.abs(last.at - 3599000) <= early, `${last.at}`)
  })

  it('counts the cycles that do not fit, and tells of each', async () => {
    const { clock, overrun, add } = open({ ms: 250 })
    const { seen, subscription } = add([1], 100)
    await clock.advance(1000)
    // at 0, 300, 600, 900; each lasts over two more
    assert.deepEqual([seen.length, subscription.overruns, overrun.length], [3, 7, 7])
    assert.deepEqual(
      seen.map(({ overruns }) => overruns),
      [2, 4, 6]
    )
  })

  it('a process that stood still leaves cycles out, counts them, and does not catch up', async () => {
    const clock = createVirtualClock()
    let still = 0
    const own = { ...clock, now: () => clock.now() + still }
    const { seen, subscription } = open({ clock: /** @type {any} */ (own) }).add([1], 100)
    await clock.advance(1010)
    assert.equal(seen.length, 11)
    still = 1000
    await clock.advance(500)
    assert.deepEqual([seen.length, subscription.overruns], [16, 10])
  })

  it('other items in the middle of a cycle, of one or of all: each value stays with its item', async () => {
    const { clock, poller, add } = open({ ms: 20 })
    const one = add([1], 1000)
    const two = add([2, 3], 1000)
    await clock.advance(30)
    one.subscription.setItems(itemsOf([7, 8, 9]))
    poller.changed()
    await clock.advance(1200)
    assert.deepEqual(
      [one, two].map(({ seen }) => seen.map(({ values }) => values)),
      [
        [[1], [7, 8, 9]],
        [
          [2, 3],
          [2, 3]
        ]
      ]
    )
  })

  it('stop in a callback, of oneself or of another', async () => {
    const { clock, add } = open()
    /** @type {any} */
    let two = null
    const one = add([1], 100, {
      callback() {
        one.stop()
        two.stop()
      }
    })
    two = add([2], 100)
    const three = add([3], 100)
    await clock.advance(350)
    assert.deepEqual([one.seen.length, two.seen.length, three.seen.length], [1, 0, 4])
    three.stop()
    await clock.advance(100)
    assert.equal(clock.pending(), 0)
  })

  it('a callback that throws does not keep the others from being told', async () => {
    const { clock, add } = open()
    const warnings = []
    const warned = warning => warnings.push(warning.message)
    process.on('warning', warned)
    add([1], 100, {
      callback() {
        throw new Error('broken')
      }
    })
    const two = add([2], 100)
    await clock.advance(250)
    await new Promise(resolve => setImmediate(resolve))
    process.off('warning', warned)
    assert.equal(two.seen.length, 3)
    assert.deepEqual(warnings, Array(3).fill('a callback of a subscription failed: broken'))
  })

  it('also where it throws no error, but anything', async () => {
    const { clock, add } = open()
    const warnings = []
    const warned = warning => warnings.push(warning.message)
    process.on('warning', warned)
    for (const thrown of ['text', null]) {
      add([1], 100, {
        callback() {
          throw thrown
        }
      })
    }
    await clock.advance(50)
    await new Promise(resolve => setImmediate(resolve))
    process.off('warning', warned)
    const said = text => `a callback of a subscription failed: ${text}`
    assert.deepEqual(warnings, [said('text'), said('null')])
  })

  it('many groups of members, one after the other: each is read as it should be', async () => {
    const { clock, poller, reads, add } = open({ ms: 0.01 })
    const members = Array.from({ length: 12 }, (_, n) => add([n], 86400000, { immediately: false }).subscription)
    const expected = []
    for (let one = 0; one < 12; one++) {
      for (let other = one + 1; other < 12; other++) {
        expected.push([one, other])
        poller.now(/** @type {any} */ ([members[one], members[other]]))
        await clock.advance(1)
      }
    }
    assert.deepEqual(
      reads.map(({ points }) => points),
      expected
    )
  })

  it('an interval that is no multiple of a second keeps to itself', async () => {
    const { clock, add } = open()
    const { times } = add([1], 12345.5)
    await clock.advance(50000)
    const [, second, ...rest] = times()
    assert.ok(rest.length >= 2)
    rest.forEach((at, n) => assert.ok(Math.abs(at - second - 12345.5 * (n + 1)) < 1e-6))
  })

  it('a grid of more intervals than it keeps is the same afterwards', () => {
    const grid = new Grid({}, 1)
    const before = grid.after(0, 7)
    for (let interval = 1009; interval < 1009 + 250; interval++) grid.after(0, interval)
    const moments = (grid.after(7000, 7) - before) / 7
    assert.ok(Math.abs(moments - Math.round(moments)) < 1e-6, String(moments))
  })

  it('asked for at once it comes beside its times, and not while it runs', async () => {
    const { clock, poller, add } = open({ ms: 10 })
    const { seen, subscription } = add([1], 1000)
    await clock.advance(500)
    poller.now([/** @type {any} */ (subscription), /** @type {any} */ (subscription)].slice(0, 1))
    poller.now([/** @type {any} */ (subscription)])
    await clock.advance(700)
    assert.deepEqual(
      seen.map(({ at }) => at),
      [10, 510, 1010]
    )
  })
})

describe('phases of the stations of a line', () => {
  const spread = (count, interval) => {
    const line = {}
    const moments = Array.from({ length: count }, (_, station) => new Grid(line, station).after(0, interval) % interval)
    const sorted = [...moments].sort((a, b) => a - b)
    return sorted.map((moment, at) => (sorted[at + 1] ?? sorted[0] + interval) - moment)
  }

  it('lie apart, however many there are', () => {
    for (const count of [2, 3, 5, 10, 30, 100]) {
      const gaps = spread(count, 1000)
      assert.ok(Math.min(...gaps) > 0.35 * (1000 / count), `${count}: ${Math.min(...gaps)}`)
      assert.ok(Math.max(...gaps) < 2.7 * (1000 / count), `${count}: ${Math.max(...gaps)}`)
    }
  })

  it('the intervals of one station meet, in whatever order they come', () => {
    const orders = [
      [100, 200, 1000],
      [1000, 200, 100],
      [200, 1000, 100]
    ]
    for (const order of orders) {
      const line = {}
      const first = new Grid(line, 1)
      first.after(0, 100)
      const grid = new Grid(line, 2)
      const [a, b, c] = [...order].map(interval => [interval, grid.after(17, interval)]).sort((x, y) => x[0] - y[0])
      const aside = (moment, base, step) => Math.abs((moment - base) / step - Math.round((moment - base) / step))
      assert.ok(aside(b[1], a[1], a[0]) < 1e-9 && aside(c[1], b[1], b[0]) < 1e-9, String(order))
    }
  })

  it('a long interval is moved by seconds, not by hours', () => {
    const line = {}
    new Grid(line, 1).after(0, 86400000)
    for (const station of [1, 2, 3]) {
      const due = 5000000
      const next = new Grid(line, station).after(due, 86400000)
      const moved = next - due - 86400000
      assert.ok(moved >= -2500 && moved <= 7500, `${moved}`)
    }
  })

  it('a station keeps its place over a redeploy', () => {
    const line = {}
    new Grid(line, 1).after(0, 1000)
    const moment = new Grid(line, 2).after(100, 1000)
    new Grid(line, 3).after(100, 1000)
    assert.equal(new Grid(line, 2).after(100, 1000), moment)
  })

  it('polls of ten stations do not wait for each other', async () => {
    const clock = createVirtualClock()
    const line = {}
    let running = 0
    let most = 0
    const all = []
    for (let station = 0; station < 10; station++) {
      const { add, poller } = open({ clock, line, station })
      const { subscription, times } = add([1], 1000)
      all.push({ subscription, times })
      const begin = subscription.begin.bind(subscription)
      const end = subscription.end.bind(subscription)
      subscription.begin = () => {
        if (clock.now() > 2000) most = Math.max(most, ++running)
        begin()
      }
      subscription.end = readings => {
        if (clock.now() > 2001) running--
        end(readings)
      }
      assert.ok(poller)
    }
    await clock.advance(10000)
    assert.equal(most, 1)
    for (const { subscription, times } of all) {
      const [first, second] = times()
      assert.ok(second - first >= 749 && second - first <= 1751, `${second - first}`)
      assert.equal(subscription.overruns, 0)
    }
  })
})

describe('devices poll together', () => {
  /** @type {any} */
  let b
  afterEach(async () => {
    await b.close()
    assert.equal(b.clock.pending(), 0, 'a timer is left')
  })

  it('items of several nodes go out in one request, the same one once', async () => {
    b = bench()
    b.station.set('M0', 11)
    b.station.set('M5', 55)
    b.station.set('M9', 99)
    const seen = [[], [], []]
    const groups = [['M0', 'M5'], ['M5'], ['M9', 'M0']]
    groups.forEach((items, at) =>
      b.device.subscribe({ items, interval: 200 }, results => seen[at].push(results.map(({ value }) => value).join()))
    )
    await b.clock.advance(1150)
    assert.deepEqual(seen, [Array(6).fill('11,55'), Array(6).fill('55'), Array(6).fill('99,11')])
    assert.deepEqual(
      b.queries.map(({ addresses }) => addresses.map(({ address }) => address - M0).join()),
      Array(6).fill('0,5,9')
    )
  })

  it('a station that comes back is asked at once by all that failed', async () => {
    b = bench({ plc: { attempts: 1, timeout: 50, probeFirst: 300, probeMost: 300 } })
    const seen = [[], []]
    for (const at of [0, 1]) {
      b.device.subscribe({ items: [`M${at}`], interval: 60000 }, ([{ quality, code }]) =>
        seen[at].push(code ?? quality)
      )
    }
    const third = []
    b.device.subscribe({ items: ['M7'], interval: 500 }, ([{ quality, code }]) => third.push(code ?? quality))
    b.wire.setOff(1, true)
    await b.clock.advance(3000)
    assert.deepEqual(seen, [['TIMEOUT'], ['TIMEOUT']])
    b.wire.setOff(1, false)
    await b.clock.advance(1000)
    assert.deepEqual(seen, [
      ['TIMEOUT', 'good'],
      ['TIMEOUT', 'good']
    ])
    assert.equal(third.at(-1), 'good')
  })

  it('one of two gets other items while its cycle runs: no value of the one comes to the other', async () => {
    b = bench()
    b.station.set('M1', 1)
    b.station.set('M2', 2)
    b.station.set('M3', 3)
    const seen = []
    const one = b.device.subscribe({ items: ['M1'], interval: 1000 }, () => {})
    b.device.subscribe({ items: ['M2', 'M3'], interval: 1000 }, results =>
      seen.push(results.map(({ item, value }) => `${item}=${value}`).join())
    )
    await b.clock.advance(1)
    one.setItems(['M3', 'M2', 'M1'])
    await b.clock.advance(1500)
    assert.deepEqual(seen, ['M2=2,M3=3', 'M2=2,M3=3'])
  })
})
