'use strict'

const assert = require('node:assert/strict')
const { createRandom } = require('../../lib/sim')
const chino = require('./chino-bench')
const nx = require('./support')

const entry = (item, value) => ({ item, value })
const short = ({ outcome, code, attempts }) => [outcome, code, attempts]
const words = ({ items }) => items.map(({ outcome }) => outcome)

/** The largest step of a tag: what the station holds now is read right before the frame that writes. */
describe('largest step of a tag, NX PLC', () => {
  const tags = [
    { name: 'speed', address: 'K10', type: 'int16', scale: 0.1, maxStep: 0.3, writable: true },
    { name: 'raw', address: 'K10', type: 'int16', writable: true },
    { name: 'valve', address: 'K12', maxStep: 5, min: 0, max: 100, writable: true },
    { name: 'level', address: 'K20:float32', maxStep: 0.1, writable: true },
    { name: 'far', address: 'K120', maxStep: 5, writable: true },
    { name: 'row', address: 'K30..K33', type: 'int16', maxStep: 2, writable: true }
  ]
  let b
  const start = (options = {}) => {
    b = nx.bench({ ...options, plc: { access: 'write', writableRanges: 'K0..K9', tags, ...options.plc } })
  }
  afterEach(async () => {
    await b.close()
    assert.equal(b.clock.pending(), 0, 'a timer is left')
  })
  const write = (entries, options) => b.run(b.device.write(entries, { fixed: true, ...options }))
  const asked = () => b.queries.map(({ ask }) => ask)
  const times = () => [...b.station.writes.values()].reduce((sum, count) => sum + count, 0)

  for (const steps of [2, 4]) {
    it(`one inside the step: read, then written, once (${steps}-step)`, async () => {
      start({ plc: { steps } })
      b.station.set('K10', 5)
      assert.deepEqual(short(await write([entry('speed', 0.8)])), ['confirmed', undefined, 1])
      assert.deepEqual(asked(), ['readWords', 'writeWords'])
      assert.equal(b.station.get('K10'), 8)
      assert.equal(times(), 1)
    })
  }

  it('one that is too large: refused, nothing that writes goes out, and the text says from where to where', async () => {
    start()
    b.station.set('K10', 5)
    const outcome = await write([entry('K0', 7), entry('speed', 0.9)])
    assert.deepEqual(short(outcome), ['refused', 'STEP_TOO_LARGE', 0])
    assert.match(outcome.text, /speed was not written: it is 0\.5 now, and 0\.9 is a step of more than 0\.3/)
    assert.deepEqual(words(outcome), ['notSent', 'notSent'])
    assert.deepEqual(asked(), ['readWords'])
    assert.equal(times(), 0)
  })

  it('downwards too, and up to the step itself, whatever a double makes of tenths', async () => {
    start()
    for (const [from, to, code] of [
      [5, 0.8],
      [8, 0.5],
      [5, 0.2],
      [5, 0.1, 'STEP_TOO_LARGE'],
      [11, 1.4],
      [-2, 0.1],
      [-2, 0.2, 'STEP_TOO_LARGE'],
      [32767, 3276.4],
      [32767, 3276.3, 'STEP_TOO_LARGE']
    ]) {
      b.station.set('K10', from, 'int16')
      const outcome = await write([entry('speed', to)])
      assert.equal(outcome.code, code, `${from} to ${to}: ${outcome.text}`)
    }
  })

  it('a float32: its rounding is no step, a hundredth is', async () => {
    start()
    for (const [from, to, code] of [
      [0.1, 0.2],
      [1e6, 1e6 + 0.125],
      [0.1, 0.201, 'STEP_TOO_LARGE'],
      [0, -0.11, 'STEP_TOO_LARGE']
    ]) {
      b.station.set('K20', from, 'float32')
      assert.equal((await write([entry('level', to)])).code, code, `${from} to ${to}`)
    }
  })

  it('the same words under another name are bound; in another type or width they are refused', async () => {
    start()
    assert.equal((await write([entry('raw', 3)])).outcome, 'confirmed')
    assert.deepEqual(short(await write([entry('raw', 7)])), ['refused', 'STEP_TOO_LARGE', 0])
    assert.deepEqual(short(await write([entry('K10:int16', 7)])), ['refused', 'STEP_TOO_LARGE', 0])
    assert.deepEqual(short(await write([entry('@0x014A:int16', 7)])), ['refused', 'STEP_TOO_LARGE', 0])
    const before = b.queries.length
    for (const other of [
      entry('K10', 3),
      entry('K10.3', true),
      entry('K9:float32', 0),
      entry('K10:int32', 0),
      entry('K8..K11', [0, 0, 0, 0])
    ]) {
      assert.deepEqual(short(await write([other])), ['refused', 'NOT_WRITABLE', 0], other.item)
    }
    assert.equal(b.queries.length, before)
    assert.equal(times(), 1)
  })

  it('a range: each of its values is compared with its own', async () => {
    start()
    for (const at of [0, 1, 2, 3]) b.station.set(`K3${at}`, at * 10)
    assert.equal((await write([entry('row', [2, 8, 21, 30])])).outcome, 'confirmed')
    assert.equal((await write([entry('row', [2, 8, 18, 30])])).code, 'STEP_TOO_LARGE')
    assert.equal((await write([entry('K31:int16', 11)])).code, 'STEP_TOO_LARGE')
    assert.equal((await write([entry('K31:int16', 10)])).outcome, 'confirmed')
  })

  it('of a write of several frames nothing goes out if the last one must not', async () => {
    start({ plc: { limits: { writeWords: 4 } } })
    b.station.set('K120', 50)
    const values = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]
    const outcome = await write([entry('K0..K9', values), entry('K0', 3), entry('far', 60)])
    assert.deepEqual(short(outcome), ['refused', 'STEP_TOO_LARGE', 0])
    assert.equal(times(), 0)
    assert.equal((await write([entry('K0..K9', values), entry('K0', 3), entry('far', 55)])).outcome, 'confirmed')
    assert.equal(b.station.get('K120'), 55)
  })

  it('of two writes at once the second one is compared with what the first one wrote', async () => {
    start()
    const promises = [5, 10, -1, 12].map(value => b.device.write([entry('valve', Math.abs(value))], { fixed: true }))
    const outcomes = await b.run(Promise.all(promises))
    assert.deepEqual(outcomes.map(short), [
      ['confirmed', undefined, 1],
      ['confirmed', undefined, 1],
      ['refused', 'STEP_TOO_LARGE', 0],
      ['confirmed', undefined, 1]
    ])
    assert.equal(b.station.get('K12'), 12)
  })

  it('reads anew each time: what a panel has moved meanwhile counts', async () => {
    start()
    assert.equal((await write([entry('valve', 5)])).outcome, 'confirmed')
    b.station.set('K12', 50)
    assert.equal((await write([entry('valve', 6)])).code, 'STEP_TOO_LARGE')
    assert.equal((await write([entry('valve', 48)])).outcome, 'confirmed')
  })

  it('what stands there cannot be read: failed or refused with that code, nothing is sent', async () => {
    start()
    b.faults.once('silent', { times: 10 })
    assert.deepEqual(short(await write([entry('valve', 1)])), ['failed', 'TIMEOUT', 0])
    assert.equal(times(), 0)
    await b.close()
    start()
    b.station.setMode('program')
    b.station.set('K20', NaN, 'float32')
    const none = await write([entry('level', 1)])
    assert.deepEqual(short(none), ['refused', 'NOT_A_VALUE', 0])
    assert.match(none.text, /level cannot be read as float32: .*size of the step is not known/)
    assert.equal(times(), 0)
  })

  it('a lost or damaged answer to the reading is asked for again; the write goes out once', async () => {
    for (const fault of ['silent', 'crc', 'truncated', 'lost']) {
      start()
      b.faults.once(fault)
      assert.deepEqual(short(await write([entry('valve', 5)])), ['confirmed', undefined, 1], fault)
      assert.deepEqual([...b.station.writes.values()], [1], fault)
      await b.close()
    }
    start()
  })

  it('the write after it is unknown where it is not answered, and is never repeated', async () => {
    for (const fault of ['silent', 'crc', 'truncated', 'lost']) {
      start()
      b.faults.once(fault, { skip: 1 })
      assert.deepEqual(short(await write([entry('valve', 5)])), ['unknown', 'WRITE_UNKNOWN', 1], fault)
      assert.deepEqual([...b.station.writes.values()], fault === 'lost' ? [] : [1], fault)
      await b.close()
    }
    start()
  })

  it('a line that breaks while it is read: failed, not unknown', async () => {
    for (const break_ of [() => b.wire.unplug(), () => b.lease.release()]) {
      start()
      await write([entry('valve', 1)])
      b.faults.once('silent', { times: 10 })
      const promise = b.device.write([entry('valve', 2)], { fixed: true })
      await b.clock.advance(60)
      break_()
      const outcome = await b.run(promise)
      assert.equal(outcome.outcome, 'failed', outcome.text)
      assert.equal(outcome.attempts, 0)
      assert.equal(times(), 1)
      await b.close()
    }
    start()
  })

  it('reading back and the latest value alone go with it', async () => {
    start()
    const busy = b.device.read(['M0..M127'])
    const latest = [1, 2, 9, 4].map(value =>
      b.device.write([entry('valve', value)], { fixed: true, verify: true, coalesce: true })
    )
    const outcomes = await b.run(Promise.all(latest))
    assert.deepEqual(
      outcomes.map(({ outcome, code }) => code ?? outcome),
      ['SUPERSEDED', 'SUPERSEDED', 'SUPERSEDED', 'confirmed']
    )
    assert.equal(times(), 1)
    await b.run(busy)
  })

  it('never a larger step in the station, whatever is asked for by whatever name, with lost, late and damaged answers', async () => {
    const random = createRandom(7)
    const rates = ['silent', 'late', 'crc', 'lost'].map(kind => ({ kind, rate: 0.05 }))
    let held = 0
    let moves = 0
    const onExecute = ({ query }) => {
      if (query.ask !== 'writeWords') return
      assert.deepEqual([query.base, query.values.length], [0x014c, 1])
      const [value] = query.values
      assert.ok(Math.abs(value - held) <= 5, `${held} became ${value}`)
      moves += value === held ? 0 : 1
      held = value
    }
    start({ sim: { rates, seed: 3, stations: [{ station: 1, onExecute }] } })
    const outcomes = []
    for (let round = 0; round < 70; round++) {
      const three = ['valve', 'K12', '@0x014C'].map(name => {
        const value = Math.min(100, Math.max(0, held + random.integer(-9, 9)))
        return b.device.write([entry(name, value)], { fixed: true })
      })
      outcomes.push(...(await b.run(Promise.all(three))))
      assert.equal(b.station.get('K12'), held)
    }
    const codes = new Set(outcomes.map(({ outcome, code }) => code ?? outcome))
    for (const code of ['confirmed', 'STEP_TOO_LARGE', 'WRITE_UNKNOWN']) assert.ok(codes.has(code), code)
    assert.ok(moves > 25, `it moved ${moves} times`)
  })
})

describe('largest step of a tag, CHINO regulator', () => {
  const tags = [
    { name: 'output', address: '400001', maxStep: 10, writable: true },
    { name: 'limit', address: '400003', maxStep: 10, writable: true },
    { name: 'coils', address: '000001:uint16', maxStep: 1, writable: true }
  ]
  let b
  const start = (options = {}) => (b = chino.bench({ ...options, device: { tags, ...options.device } }))
  afterEach(async () => {
    await b.close()
    assert.equal(b.clock.pending(), 0, 'a timer is left')
  })
  const writes = () => b.slave.requests.filter(hex => parseInt(hex.slice(2, 4), 16) > 4)

  for (const protocol of ['rtu', 'ascii']) {
    it(`reads, compares, writes once; a step that is too large only reads (${protocol})`, async () => {
      start({ device: { protocol } })
      b.slave.set('hr', 0, 100)
      assert.deepEqual(short(await b.write([entry('output', 110)])), ['confirmed', undefined, 1])
      assert.deepEqual(b.slave.requests, ['0b0300000001', '0b10000000010200' + '6e'])
      assert.deepEqual(short(await b.write([entry('output', 99)])), ['refused', 'STEP_TOO_LARGE', 0])
      assert.deepEqual(writes().length, 1)
      assert.deepEqual(b.slave.values('hr', 0, 1), [110])
    })
  }

  it('a number on coils', async () => {
    start()
    b.slave.set('co', 0, 1, 1)
    assert.deepEqual(short(await b.write([entry('coils', 4)])), ['confirmed', undefined, 1])
    assert.deepEqual(short(await b.write([entry('coils', 6)])), ['refused', 'STEP_TOO_LARGE', 0])
    assert.deepEqual(short(await b.write([entry('000003', true)])), ['refused', 'NOT_WRITABLE', 0])
    assert.deepEqual(b.slave.values('co', 0, 4), [0, 0, 1, 0])
  })

  it('an address that is missing between two of them does not spoil the reading', async () => {
    start({ slaves: [{ has: (_table, address) => address === 0 || address === 2 }] })
    const outcome = await b.write([entry('output', 3), entry('limit', 4)])
    assert.equal(outcome.outcome, 'confirmed', outcome.text)
    assert.equal(writes().length, 2)
    assert.deepEqual([...b.slave.values('hr', 0, 1), ...b.slave.values('hr', 2, 1)], [3, 4])
  })

  it('an address that the station does not have: refused with its word, nothing that writes goes out', async () => {
    start({ slaves: [{ has: (_table, address) => address === 0 }] })
    const outcome = await b.write([entry('output', 3), entry('limit', 4)])
    assert.deepEqual(short(outcome), ['refused', 'MODBUS_ILLEGAL_ADDRESS', 0])
    assert.deepEqual(writes(), [])
  })

  it('by function 06, and while it is not known whether the adapter hears itself', async () => {
    start({ device: { holdingFunction: '06' }, line: { echo: 'auto' } })
    assert.deepEqual(short(await b.write([entry('output', 10)])), ['confirmed', undefined, 1])
    assert.deepEqual(writes(), ['0b060000000a'])
    assert.deepEqual(short(await b.write([entry('output', 21)])), ['refused', 'STEP_TOO_LARGE', 0])
    assert.equal(writes().length, 1)
  })

  it('a broadcast cannot be compared with anything: refused', async () => {
    start({ device: { station: 0, broadcast: true } })
    assert.deepEqual(short(await b.write([entry('output', 3)])), ['refused', 'BROADCAST_REFUSED', 0])
    assert.deepEqual(b.slave.requests, [])
    assert.deepEqual(short(await b.write([entry('400002', 3)])), ['unknown', 'BROADCAST_UNCONFIRMED', 1])
  })
})
