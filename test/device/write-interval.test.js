'use strict'

const assert = require('node:assert/strict')
const { Intervals } = require('../../lib/device/interval')
const chino = require('./chino-bench')
const nx = require('./support')

const entry = (item, value) => ({ item, value })
const short = ({ outcome, code }) => code ?? outcome
const INTERVAL = 1000

/** The least time between two writes of the same words or bits of a device. */
describe('write interval, NX PLC', () => {
  let b
  let seen
  const start = (options = {}) => {
    seen = []
    const onExecute = ({ query }) => {
      if (query.ask.startsWith('write')) seen.push({ at: b.clock.now(), base: query.base, values: query.values })
    }
    const plc = { access: 'write', writeInterval: INTERVAL, tags: [{ name: 'pump', address: 'K0.3' }], ...options.plc }
    b = nx.bench({ sim: { stations: [{ station: 1, onExecute }], ...options.sim }, ...options, plc })
  }
  afterEach(async () => {
    await b.close()
    assert.equal(b.clock.pending(), 0, 'a timer is left')
  })
  const ask = (entries, options) => b.device.write(entries, { fixed: true, ...options })
  const write = (entries, options) => b.run(ask(entries, options))
  const gaps = () => seen.slice(1).map(({ at }, index) => at - seen[index].at)

  it('sooner: refused, nothing is sent, and the text says how long to wait', async () => {
    start()
    assert.equal(short(await write([entry('K0', 1)])), 'confirmed')
    const soon = await write([entry('K5', 1), entry('K0', 2)])
    assert.deepEqual([soon.outcome, soon.code, soon.attempts], ['refused', 'WRITE_TOO_SOON', 0])
    assert.match(soon.text, /K0 was not written: it may be written again in \d+ ms/)
    assert.equal(seen.length, 1)
    await b.clock.advance(INTERVAL)
    assert.equal(short(await write([entry('K0', 2)])), 'confirmed')
    assert.ok(gaps()[0] > INTERVAL - 1e-6, `${gaps()}`)
  })

  it('0, the default, lets each one out', async () => {
    start({ plc: { writeInterval: undefined } })
    for (const value of [1, 2, 3]) assert.equal(short(await write([entry('K0', value)])), 'confirmed')
  })

  it('by absolute words and bits, whatever the name; others are not bound', async () => {
    start({ plc: { areas: [{ area: 'W', confirmed: true }] } })
    for (const [first, same, other] of [
      [entry('K0', 1), ['K0', '@0x0140', 'K0.3', 'pump', 'K0:int32'], ['K1', 'K2.0']],
      [entry('K10.4', true), ['K10.4', 'K10', 'K9:float32'], ['K10.5', 'K11']],
      [entry('K20:float32', 1), ['K21', 'K20.0', 'K19:int32'], ['K22', 'K18:int32']],
      [entry('K30..K39', new Array(10).fill(7)), ['K39.15', 'K30', 'K35'], ['K40']]
    ]) {
      assert.equal(short(await write([first])), 'confirmed')
      const value = name => (/\.|pump/.test(name) ? true : 1)
      for (const name of same) {
        assert.equal(short(await write([entry(name, value(name))])), 'WRITE_TOO_SOON', `${name} after ${first.item}`)
      }
      for (const name of other) {
        assert.equal(short(await write([entry(name, value(name))])), 'confirmed', `${name} after ${first.item}`)
      }
    }
  })

  it('of several at once the first goes out, the others are too soon when their turn has come', async () => {
    start()
    const outcomes = await b.run(Promise.all([1, 2, 3].map(value => ask([entry('K0', value)]))))
    assert.deepEqual(outcomes.map(short), ['confirmed', 'WRITE_TOO_SOON', 'WRITE_TOO_SOON'])
    assert.equal(b.station.get('K0'), 1)
    assert.equal(seen.length, 1)
  })

  it('with the latest value alone: it waits, and the latest goes out when the time has come', async () => {
    start()
    const last = []
    for (let value = 1; value <= 50; value++) {
      last.push(ask([entry('K0', value)], { coalesce: true }))
      await b.clock.advance(50)
    }
    const outcomes = await b.run(Promise.all(last))
    assert.deepEqual(new Set(outcomes.map(short)), new Set(['confirmed', 'SUPERSEDED']))
    assert.equal(short(outcomes.at(-1)), 'confirmed')
    assert.equal(seen.length, outcomes.filter(({ outcome }) => outcome === 'confirmed').length)
    assert.deepEqual(
      seen.map(({ values }) => values[0]),
      [1, 20, 40, 50]
    )
    for (const gap of gaps()) assert.ok(gap > INTERVAL - 1e-6 && gap < INTERVAL + 100, `${gaps()}`)
    assert.ok(outcomes.at(-1).ms > 400, 'the wait is part of its time')
  })

  it('two that coalesce under other names do not come closer either', async () => {
    start()
    const promises = ['K0', '@0x0140', 'K0..K1'].map((name, at) =>
      ask([entry(name, at < 2 ? at : [5, 6])], { coalesce: true })
    )
    const outcomes = await b.run(Promise.all(promises))
    assert.deepEqual(outcomes.map(short), ['confirmed', 'confirmed', 'confirmed'])
    assert.equal(seen.length, 3)
    for (const gap of gaps()) assert.ok(gap > INTERVAL - 1e-6, `${gaps()}`)
  })

  it('what never went out does not count; what is unknown, or refused by the station, does', async () => {
    start()
    b.wire.unplug()
    await b.clock.advance(10)
    assert.equal((await write([entry('K0', 1)])).outcome, 'failed')
    b.wire.plug()
    await b.clock.advance(6000)
    assert.equal(short(await write([entry('K0', 1)])), 'confirmed')
    await b.clock.advance(INTERVAL)
    b.faults.once('silent')
    assert.equal((await write([entry('K0', 1)])).outcome, 'unknown')
    assert.equal(short(await write([entry('K0', 1)])), 'WRITE_TOO_SOON')
    await b.clock.advance(INTERVAL)
    b.station.setMode('program')
    assert.equal((await write([entry('K0', 1)])).outcome, 'refused')
    assert.equal(short(await write([entry('K0', 1)])), 'WRITE_TOO_SOON')
  })

  it('a step that was too large was not sent', async () => {
    start({ plc: { tags: [{ name: 'valve', address: 'K12', maxStep: 5 }] } })
    assert.equal(short(await write([entry('valve', 9)])), 'STEP_TOO_LARGE')
    assert.equal(short(await write([entry('valve', 5)])), 'confirmed')
    assert.equal(short(await write([entry('valve', 9)])), 'WRITE_TOO_SOON')
  })

  it('is kept over a redeploy, also where the line was closed in between', async () => {
    start()
    assert.equal(short(await write([entry('K0', 1)])), 'confirmed')
    b.device.close()
    await b.run(b.lease.release())
    const settings = { transport: 'simulated', path: 'sim', wire: b.wire, baudRate: 38400, echo: 'off' }
    const lease = b.pool.open(settings, { id: 'b', name: 'again' })
    const again = b.make({ lease })
    assert.equal(short(await b.run(again.write([entry('K0', 2)], { fixed: true }))), 'WRITE_TOO_SOON')
    await b.clock.advance(INTERVAL)
    assert.equal(short(await b.run(again.write([entry('K0', 2)], { fixed: true }))), 'confirmed')
    again.close()
    await b.run(lease.release())
  })

  it('one of several frames does not wait for itself, and binds all its words from the first', async () => {
    start()
    const values = Array.from({ length: 70 }, (_, at) => at)
    const own = ask([entry('K0..K69', values), entry('K0', 5)])
    await b.clock.advance(10)
    const other = await write([entry('K69', 7)])
    assert.equal(short(await b.run(own)), 'confirmed')
    assert.equal(short(other), 'WRITE_TOO_SOON')
    assert.equal(seen.length, 3)
    assert.deepEqual([b.station.get('K69'), b.station.get('K0')], [69, 5])
  })

  it('of one of several frames nothing goes out if the words of a later one were written while it waited', async () => {
    start()
    const promises = [ask([entry('K69', 7)]), ask([entry('K0..K69', new Array(70).fill(1))])]
    const outcomes = await b.run(Promise.all(promises))
    assert.deepEqual(
      outcomes.map(({ outcome, code, attempts }) => [code ?? outcome, attempts]),
      [
        ['confirmed', 1],
        ['WRITE_TOO_SOON', 0]
      ]
    )
    assert.equal(seen.length, 1)
  })

  it('counts from the frame that wrote the word, not from the first one of its write', async () => {
    start()
    await write([entry('K0..K69', new Array(70).fill(1)), entry('K0', 5)])
    await write([entry('K0', 6)], { coalesce: true })
    assert.equal(seen.length, 4)
    assert.ok(gaps()[2] > INTERVAL - 1e-6, `${gaps()}`)
  })

  it('what was broken off before a byte of it went out does not count', async () => {
    start({ plc: { writeInterval: 60000 } })
    const promises = [ask([entry('K1', 1)]), ask([entry('K0', 1)])]
    let first = null
    promises[0].then(outcome => (first = outcome))
    while (!first) await b.clock.advance(1)
    // the silence before the next query
    await b.clock.advance(3)
    b.wire.unplug()
    assert.equal((await b.run(promises[1])).outcome, 'failed')
    b.wire.plug()
    await b.clock.advance(6000)
    assert.equal(short(await write([entry('K0', 1)])), 'confirmed')
    assert.equal(short(await write([entry('K1', 1)])), 'WRITE_TOO_SOON')
  })

  it('closed while one waits: failed, nothing is sent, no timer is left', async () => {
    start()
    await write([entry('K0', 1)])
    const waits = ask([entry('K0', 2)], { coalesce: true })
    await b.clock.advance(100)
    b.device.close()
    const outcome = await b.run(waits)
    assert.deepEqual([outcome.outcome, outcome.code, outcome.attempts], ['failed', 'LINE_CLOSED', 0])
    assert.ok(outcome.ms < 150, `after ${outcome.ms} ms`)
    await b.clock.advance(2 * INTERVAL)
    assert.equal(seen.length, 1)
  })

  it('is bounded: what binds no more is forgotten', () => {
    start()
    let now = 0
    const written = { words: new Map(), bits: new Map() }
    const intervals = new Intervals({ written, interval: 10, clock: { now: () => now } })
    const by = Symbol('write')
    const point = address => ({ kind: /** @type {'word'} */ ('word'), address, count: 1000, text: '' })
    for (let address = 0; address < 100000; address += 1000, now++) intervals.mark([point(address)], by)
    assert.ok(written.words.size <= 22000, `${written.words.size}`)
    assert.ok(intervals.wait([point(99500)]).ms > 0)
  })
})

describe('write interval, CHINO regulator', () => {
  let b
  afterEach(async () => {
    await b.close()
    assert.equal(b.clock.pending(), 0, 'a timer is left')
  })

  it('registers and coils of one number are two; a bit of a register is its own', async () => {
    b = chino.bench({ device: { writeInterval: INTERVAL } })
    const each = async (item, value) => short(await b.write([entry(item, value)]))
    assert.equal(await each('400001', 5), 'confirmed')
    assert.equal(await each('000001', true), 'confirmed')
    assert.equal(await each('hr0', 6), 'WRITE_TOO_SOON')
    assert.equal(await each('400001.03', true), 'WRITE_TOO_SOON')
    assert.equal(await each('000001', false), 'WRITE_TOO_SOON')
    assert.equal(await each('400002.03', true), 'confirmed')
    assert.equal(await each('400002.04', true), 'confirmed')
    assert.equal(await each('400002.03', false), 'WRITE_TOO_SOON')
    await b.clock.advance(INTERVAL)
    assert.equal(await each('400001', 6), 'confirmed')
  })

  it('a broadcast counts too', async () => {
    b = chino.bench({ device: { writeInterval: INTERVAL, station: 0, broadcast: true } })
    assert.equal(short(await b.write([entry('400001', 5)])), 'BROADCAST_UNCONFIRMED')
    assert.equal(short(await b.write([entry('400001', 6)])), 'WRITE_TOO_SOON')
    assert.equal(b.slave.requests.length, 1)
  })
})
