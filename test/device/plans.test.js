'use strict'

const assert = require('node:assert/strict')
const { Plans } = require('../../lib/device/plans')
const { Turnaround } = require('../../lib/device/turnaround')
const { readSettings } = require('../../lib/device/settings')
const { readSettings: readChino } = require('../../lib/device/chino-settings')
const { Waits } = require('../../lib/line/waits')
const { bench } = require('./support')

const M0 = 0xc0
const words = (...addresses) =>
  addresses.map(address => ({
    kind: /** @type {const} */ ('word'),
    address: M0 + address,
    count: 1,
    text: `M${address}`
  }))

describe('plans of a device', () => {
  /** Counts how often it is planned, and with what. */
  const open = () => {
    const { plan } = readSettings({ station: 1, soleMaster: true }, 0.26)
    const facts = []
    const turnaround = { ms: 5 }
    const talk = { repeating: true }
    const counted = {
      ...plan,
      reads(points, given) {
        facts.push(given)
        return plan.reads(points, given)
      }
    }
    const plans = new Plans({ talk, settings: { station: 1, plan: counted }, turnaround })
    return { plans, facts, turnaround, talk }
  }

  it('are made once for a list, until something is learnt', () => {
    const { plans, facts, turnaround, talk } = open()
    const points = words(0, 1, 100)
    const first = plans.prepared(points)
    for (let n = 0; n < 5; n++) assert.equal(plans.prepared(points), first)
    assert.equal(facts.length, 1)
    turnaround.ms = 40
    plans.prepared(points)
    talk.repeating = false
    plans.prepared(points)
    plans.learnt()
    plans.prepared(points)
    assert.deepEqual(
      facts.map(each => [each.turnaround, each.repeats]),
      [
        [5, true],
        [40, true],
        [40, false],
        [40, false]
      ]
    )
    plans.prepared(words(0, 1, 100))
    assert.equal(facts.length, 5)
  })

  it('are kept also while an address is known to be absent', () => {
    const { plans, facts } = open()
    const points = words(0, 1, 2)
    plans.absent.set('word 193 1', { hole: { kind: 'word', start: 193, end: 194 } })
    plans.learnt()
    const { requests, absent } = plans.prepared(points)
    assert.deepEqual(absent, [1])
    // no block over it
    assert.ok(requests.every(({ ask, count }) => ask === 'readMixed' || count === 1))
    for (let n = 0; n < 5; n++) plans.prepared(points)
    assert.equal(facts.length, 1)
  })

  it('a value that fits into no request is bad alone, and is not planned again and again', () => {
    const { plans, facts } = open()
    const long = { kind: /** @type {const} */ ('word'), address: M0, count: 200, text: 'M0:string400' }
    const points = [...words(0), long]
    const { requests, misfits } = plans.prepared(points)
    assert.deepEqual(
      misfits.map(({ index, error }) => [index, error.code]),
      [[1, 'FRAME_TOO_LONG']]
    )
    assert.equal(requests.length, 1)
    const { length } = facts
    plans.prepared(points)
    assert.equal(facts.length, length)
    assert.throws(() => plans.prepared([long]), { code: 'FRAME_TOO_LONG' })
  })

  it('a slow station is asked seldom for much, a quick one often for little', () => {
    // 40 words lie between them: 80 bytes, 21 ms at 38400 bit/s
    const points = [...words(0), ...words(41)].map(point => ({ ...point, count: 2 }))
    const nx = readSettings({ station: 1, gap: 1 }, 10 / 38.4).plan
    const modbus = readChino({ station: 1 }, 10 / 38.4).plan
    assert.equal(modbus.reads(points, { turnaround: 5 }).length, 2)
    assert.equal(modbus.reads(points, { turnaround: 30 }).length, 1)
    const quick = nx.reads(points, { turnaround: 0 })[0]
    const slow = nx.reads(points, { turnaround: 30 })[0]
    // 30 ms more
    assert.ok(Math.abs(slow.cost - quick.cost - 115.2) < 1e-6)
  })
})

describe('turnaround of a station', () => {
  it('is measured, in steps of 5 ms that do not flutter', () => {
    const memory = { waits: /** @type {any} */ (undefined) }
    const turnaround = new Turnaround(memory)
    assert.equal(turnaround.ms, 5)
    memory.waits = new Waits()
    const add = (ms, times) => Array.from({ length: times }, () => memory.waits.add(ms))
    add(40, 9)
    assert.equal(turnaround.ms, 5)
    add(40, 1)
    assert.equal(turnaround.ms, 40)
    // around the middle of a step nothing changes
    add(42.4, 200)
    assert.equal(turnaround.ms, 40)
    add(37.6, 200)
    assert.equal(turnaround.ms, 40)
    add(1, 200)
    assert.equal(turnaround.ms, 0)
  })

  it('mean of the last 200', () => {
    const waits = new Waits()
    assert.equal(waits.mean, null)
    for (let n = 1; n <= 1000; n++) waits.add(n)
    assert.ok(Math.abs(Number(waits.mean) - 900.5) < 1e-9)
  })
})

describe('NX PLC: holes', () => {
  /** @type {any} */
  let b
  afterEach(() => b.close())

  it('a block over addresses that the PLC does not have is found by halving, and read around from then on', async () => {
    // W10 to W13 are not there
    const areas = [
      { area: 'W', words: 10 },
      { area: 'V', base: 0x200 + 14, words: 90, as: 'words' }
    ]
    b = bench({ sim: { stations: [{ station: 1, areas }] } })
    b.station.set('W9', 9)
    const cycles = []
    const counts = []
    b.device.subscribe({ items: ['W0..W9', 'W14..W60'], interval: 1000 }, results => {
      cycles.push(results.map(({ quality }) => quality).join())
      counts.push(b.lease.line.stats().queries)
    })
    await b.clock.advance(10500)
    assert.deepEqual(cycles, Array(11).fill('good,good'))
    const each = counts.map((count, at) => count - (counts[at - 1] ?? 0))
    // the first one: the block, then its halves until the hole stands alone
    assert.ok(each[0] > 2 && each[0] <= 16, String(each))
    assert.deepEqual(each.slice(3), Array(8).fill(2))
  })

  it('an address that it does not have is asked for alone, every 30 s, and a good plan is kept meanwhile', async () => {
    b = bench({ sim: { stations: [{ station: 1, areas: [{ area: 'W', words: 10 }] }] } })
    const counts = []
    b.device.subscribe({ items: ['W0', 'W5', 'W20', 'W9'], interval: 1000 }, results => {
      assert.deepEqual(
        results.map(({ quality }) => quality),
        ['good', 'good', 'bad', 'good']
      )
      counts.push(b.lease.line.stats().queries)
    })
    await b.clock.advance(35500)
    const each = counts.map((count, at) => count - (counts[at - 1] ?? 0))
    assert.deepEqual([each.slice(1, 29), each.slice(29, 32).sort()], [Array(28).fill(1), [1, 1, 2]])
  })
})
