'use strict'

const assert = require('node:assert/strict')
const { RepeatWatch } = require('../../lib/device/repeat-watch')
const { bench } = require('./support')

/** Repeats by an RR alone in polls of several requests; the frames are looked at as they are on the wire. */

const RR = '00'
/** `Q` with the function's code, or `RR`. */
const sentIn = ({ lease }) =>
  lease.line
    .trace()
    .filter(({ dir }) => dir === 'out')
    .map(({ bytes }) => bytes.replace(/\s/g, '').slice(4, 6))
    .map(fn => (fn === RR ? 'RR' : `Q${fn}`))

describe('NX PLC: polls repeated by an RR alone', () => {
  /** @type {any} */
  let b
  const start = options => (b = bench(options))
  afterEach(async () => {
    await b.close()
    assert.equal(b.clock.pending(), 0, 'a timer is left')
  })

  // words far apart, more than one request each way
  const ITEMS = ['M0..M127', 'K0..K127', 'W0..W127']

  it('of several requests the last one of a cycle is the first of the next', async () => {
    for (const steps of [2, 4]) {
      start({ plc: { soleMaster: true, steps } })
      const counts = []
      b.device.subscribe({ items: ITEMS, interval: 2000 }, results => {
        assert.ok(results.every(({ quality }) => quality === 'good'))
        counts.push(b.device.stats.repeats)
      })
      await b.clock.advance(9000)
      assert.deepEqual(counts, [0, 1, 2, 3, 4], `${steps} steps`)
      const queries = sentIn(b)
      const cycle = queries.length / 5
      if (steps === 2) {
        assert.equal(cycle, 3)
        assert.deepEqual(
          queries.map((each, at) => (at % 3 === 0 && at > 0 ? each === 'RR' : each !== 'RR')),
          Array(15).fill(true)
        )
      }
      await b.close()
    }
    start()
  })

  it('brings the values of now, forwards and backwards', async () => {
    start({ plc: { soleMaster: true } })
    let cycle = 0
    const wrong = []
    const next = () =>
      ['M0', 'M127', 'K0', 'K127', 'W0', 'W127'].forEach((item, at) => b.station.set(item, cycle * 10 + at))
    next()
    b.device.subscribe({ items: ['M0', 'M127', 'K0', 'K127', 'W0', 'W127', ...ITEMS], interval: 2000 }, results => {
      results.slice(0, 6).forEach(({ value }, at) => value === cycle * 10 + at || wrong.push([cycle, at, value]))
      cycle++
      next()
    })
    await b.clock.advance(20000)
    assert.equal(cycle, 10)
    assert.deepEqual(wrong, [])
    assert.equal(b.device.stats.repeats, 9)
  })

  for (const noRepeat of ['silent', 'error']) {
    it(`a PLC that does not repeat (${noRepeat}) is noticed and asked by queries`, async () => {
      start({ plc: { soleMaster: true }, sim: { stations: [{ station: 1, noRepeat }] } })
      const events = []
      b.lease.on('event', ({ event, cause, remedy }) => events.push([event, Boolean(cause && remedy)]))
      const qualities = []
      // a silence has the station left alone for a second
      b.device.subscribe({ items: ['M0'], interval: 3000 }, ([{ quality }]) => qualities.push(quality))
      await b.clock.advance(61000)
      assert.deepEqual(qualities, Array(21).fill('good'))
      const sent = sentIn(b)
      assert.equal(sent.filter(each => each === 'RR').length, 3)
      assert.equal(sent.length, 21 + 3)
      assert.deepEqual(
        events.filter(([event]) => event === 'noRepeat'),
        [['noRepeat', true]]
      )
      assert.equal(b.device.stats.repeats, 0)
    })
  }

  it('a PLC that repeats is not given up for some lost answers', async () => {
    start({ plc: { soleMaster: true, timeout: 50 } })
    const seen = []
    b.device.subscribe({ items: ['M0'], interval: 5000 }, ([{ quality }]) => seen.push(quality))
    await b.clock.advance(7000)
    for (let n = 0; n < 9; n++) {
      b.faults.once('silent')
      await b.clock.advance(5000)
    }
    const { repeats } = b.device.stats
    assert.equal(repeats, 1)
    await b.clock.advance(25000)
    assert.equal(b.device.stats.repeats, repeats + 5)
    assert.ok(seen.every(quality => quality === 'good'))
  })
})

describe('watch of the repeat by RR', () => {
  const make = () => {
    const state = { now: 0, found: 0 }
    const memory = /** @type {any} */ ({})
    const open = () => new RepeatWatch({ clock: { now: () => state.now }, memory, found: () => state.found++ })
    const note = (watch, ...verdicts) => verdicts.forEach(verdict => watch.note(verdict))
    return { state, open, note }
  }

  it('three failures of a PLC that never repeated: an hour of rest, over a redeploy, told once', () => {
    const { state, open, note } = make()
    note(open(), false, false)
    assert.equal(open().allowed, true)
    note(open(), false)
    assert.deepEqual([open().allowed, state.found], [false, 1])
    state.now = 3599999
    assert.equal(open().allowed, false)
    state.now = 3600000
    assert.equal(open().allowed, true)
    note(open(), false, false, false)
    assert.deepEqual([open().allowed, state.found], [false, 1])
  })

  it('ten of one that did', () => {
    const { open, note } = make()
    const watch = open()
    note(watch, false, false, true, ...Array(9).fill(false), true, ...Array(9).fill(false))
    assert.equal(watch.allowed, true)
    note(watch, false)
    assert.equal(watch.allowed, false)
  })
})
