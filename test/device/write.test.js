'use strict'

const assert = require('node:assert/strict')
const { bench } = require('./support')

const tags = [
  { name: 'setpoint', address: 'K10', type: 'int16', scale: 0.1, min: 0, max: 80, writable: true },
  { name: 'level', address: 'K20:float32', min: -5, max: 5, writable: true },
  { name: 'pump', address: 'K127.12', writable: true },
  { name: 'fixedOnly', address: 'K30' },
  { name: 'highFirst', address: 'K50:float32', wordOrder: 'high', max: 5 }
]
const entry = (item, value) => ({ item, value })

describe('NX PLC: writing', () => {
  let b
  const start = (options = {}) => {
    const plc = { access: 'write', writableRanges: 'K0..K9, M5.3', tags, ...options.plc }
    b = bench({ ...options, plc })
  }
  afterEach(async () => {
    await b.close()
    assert.equal(b.clock.pending(), 0, 'a timer is left')
  })
  const write = (entries, options) => b.run(b.device.write(entries, options))
  const executed = () => b.queries.filter(({ ask }) => ask.startsWith('write')).length

  for (const steps of [2, 4]) {
    it(`bits, words and a float in one frame (${steps}-step)`, async () => {
      start({ plc: { steps } })
      const outcome = await write([
        entry('setpoint', '25.3'),
        entry('pump', 'on'),
        entry('level', 2.5),
        entry('K0..K2', [1, 2, 3])
      ])
      assert.equal(outcome.outcome, 'confirmed')
      assert.deepEqual(
        outcome.items.map(({ name, outcome: word }) => [name, word]),
        [
          ['setpoint', 'confirmed'],
          ['pump', 'confirmed'],
          ['level', 'confirmed'],
          ['K0_K2', 'confirmed']
        ]
      )
      assert.equal(outcome.attempts, 1)
      assert.ok(outcome.ms > 0)
      assert.equal(executed(), 1)
      assert.deepEqual(
        [b.station.get('K10'), b.station.get('K127.12'), b.station.get('K20', 'float32'), b.station.get('K2')],
        [253, true, 2.5, 3]
      )
    })
  }

  const refused = [
    // entries, code, with a fixed target too?
    [[entry('K40', 1)], 'NOT_WRITABLE', false],
    [[entry('fixedOnly', 1)], 'NOT_WRITABLE', false],
    [[entry('K8..K10', [1, 2, 3])], 'NOT_WRITABLE', false],
    [[entry('K9:float32', 1)], 'NOT_WRITABLE', false],
    [[entry('M5.4', 1)], 'NOT_WRITABLE', false],
    [[entry('M5', 1)], 'NOT_WRITABLE', false],
    [[entry('setpoint', 80.1)], 'VALUE_OUT_OF_RANGE', true],
    [[entry('K10:int16', 801)], 'VALUE_OUT_OF_RANGE', true],
    [[entry('K10', 5)], 'NOT_WRITABLE', true],
    [[entry('K10.3', true)], 'NOT_WRITABLE', true],
    [[entry('K9:float32', 1)], 'NOT_WRITABLE', true],
    [[entry('K8..K11', [1, 2, 3, 4])], 'NOT_WRITABLE', true],
    [[entry('K21', 5)], 'NOT_WRITABLE', true],
    [[entry('@0x0154', 5)], 'NOT_WRITABLE', true],
    [[entry('K21:float32', 1)], 'NOT_WRITABLE', true],
    [[entry('K19:float32', 1)], 'NOT_WRITABLE', true],
    [[entry('K50:float32', 1)], 'NOT_WRITABLE', true],
    [[entry('@0x0154:float32', -6)], 'VALUE_OUT_OF_RANGE', true],
    [[entry('@0x0154:float32', 6)], 'VALUE_OUT_OF_RANGE', true],
    [[entry('W0', 1)], 'NOT_WRITABLE', true],
    [[entry('W0.3', true)], 'NOT_WRITABLE', true],
    [[entry('F0', 1)], 'NOT_WRITABLE', true],
    [[entry('TC3', true)], 'NOT_WRITABLE', true],
    [[entry('@0x0200', 1)], 'NOT_WRITABLE', true],
    [[entry('K0', 1), entry('W0', 1)], 'NOT_WRITABLE', true],
    [[entry('K0', 65536)], 'VALUE_OUT_OF_RANGE', true],
    [[entry('K0', 1.5)], 'BAD_VALUE', true],
    [[entry('K0', null)], 'BAD_VALUE', true],
    [[entry('K0', '')], 'BAD_VALUE', true],
    [[entry('K0', NaN)], 'BAD_VALUE', true],
    [[entry('K0', [1])], 'BAD_VALUE', true],
    [[entry('pump', 7)], 'BAD_VALUE', true],
    [[entry('K200', 1)], 'OUT_OF_AREA', true],
    [[entry('nonsense', 1)], 'BAD_ADDRESS', true],
    [[entry('__proto__', 1)], 'BAD_ADDRESS', true],
    [[entry(undefined, 1)], 'BAD_ITEMS', true],
    [[null], 'NOTHING_TO_WRITE', true],
    [[], 'NOTHING_TO_WRITE', true],
    [undefined, 'NOTHING_TO_WRITE', true],
    [new Array(1001).fill(entry('K0', 1)), 'TOO_MANY', true]
  ]
  it('guards: each of a table is refused before anything is sent', async () => {
    start()
    for (const [entries, code, fixed] of refused) {
      for (const how of fixed ? [false, true] : [false]) {
        const outcome = await write(entries, { fixed: how })
        const about = `${JSON.stringify(entries?.slice(0, 3))} fixed ${how}: ${outcome.text}`
        assert.equal(outcome.outcome, 'refused', about)
        if (how === fixed) assert.equal(outcome.code, code, about)
      }
    }
    assert.equal(b.station.counts.queries, 0)
  })

  it('a fixed target needs no writable tag, but access and limits bind it', async () => {
    start()
    assert.equal((await write([entry('K40', 1)], { fixed: true })).outcome, 'confirmed')
    assert.equal((await write([{ item: 'fixedOnly', value: 2, fixed: true }])).outcome, 'confirmed')
    assert.equal((await write([entry('K10:int16', 800)], { fixed: true })).outcome, 'confirmed')
    assert.equal((await write([entry('@0x0154:float32', 5)], { fixed: true })).outcome, 'confirmed')
    assert.doesNotThrow(() => b.device.checkTarget('K40'))
    assert.throws(
      () => b.device.checkTarget('W0'),
      error => error.code === 'NOT_WRITABLE'
    )
    const reader = b.make({ access: 'read' })
    const outcome = await b.run(reader.write([entry('K0', 1)], { fixed: true }))
    assert.deepEqual([outcome.outcome, outcome.code], ['refused', 'READ_ONLY'])
    assert.throws(
      () => reader.checkTarget('K40'),
      error => error.code === 'READ_ONLY'
    )
    reader.close()
  })

  it('a confirmed area becomes writable', async () => {
    start({ plc: { areas: [{ area: 'W', confirmed: true }] } })
    assert.equal((await write([entry('W3:int32', -2)], { fixed: true })).outcome, 'confirmed')
    assert.equal(b.station.get('W3', 'int32'), -2)
    const bit = await write([entry('W3.4', true)], { fixed: true })
    assert.equal(bit.code, 'NOT_WRITABLE')
    assert.match(bit.text, /only words/)
  })

  it('an unanswered write is unknown, and the station sees it exactly once', async () => {
    for (const fault of ['silent', 'crc', 'truncated', 'lost']) {
      start()
      b.faults.once(fault)
      const outcome = await write([entry('K0', 5)])
      assert.deepEqual([outcome.outcome, outcome.code, outcome.attempts], ['unknown', 'WRITE_UNKNOWN', 1], fault)
      assert.deepEqual([...b.station.writes], fault === 'lost' ? [] : [['word:320', 1]], fault)
      if (fault !== 'lost') await b.close()
    }
  })

  it('reading back confirms an unanswered write; one that reads otherwise stays unknown', async () => {
    start()
    b.faults.once('silent')
    assert.equal((await write([entry('K0', 5)], { verify: true })).outcome, 'confirmed')
    b.faults.once('lost')
    const lost = await write([entry('K0', 6)], { verify: true })
    assert.deepEqual([lost.outcome, lost.code], ['unknown', 'VERIFY_FAILED'])
    assert.match(lost.text, /K0 reads 5h after 6h was written/)
    assert.equal(b.station.writes.get('word:320'), 1)
  })

  it('a target counts as a message’s unless it is said to be fixed', async () => {
    start()
    const given = await write([entry('fixedOnly', 1)])
    assert.deepEqual([given.outcome, given.code, given.attempts], ['refused', 'NOT_WRITABLE', 0])
    assert.equal((await write([entry('fixedOnly', 1)], { fixed: true })).outcome, 'confirmed')
  })

  it('a tag without limits does not forbid its words under another type', async () => {
    start()
    assert.equal((await write([entry('K30:int16', -1)], { fixed: true })).outcome, 'confirmed')
    assert.equal((await write([entry('K29:float32', 1)], { fixed: true })).outcome, 'confirmed')
  })

  it('what cannot be read back stays unknown', async () => {
    start()
    b.faults.once('silent', { times: 10 })
    const outcome = await write([entry('K0', 5)], { verify: true })
    assert.deepEqual([outcome.outcome, outcome.code], ['unknown', 'WRITE_UNKNOWN'])
    assert.match(outcome.text, /station 1 .*K0: it could not be read back/)
    assert.equal(b.station.writes.get('word:320'), 1)
  })

  it('what the program of the PLC overwrites is found by reading back', async () => {
    const onExecute = ({ query }) => query.ask.startsWith('write') && b.station.set('K0', 99)
    start({ sim: { stations: [{ station: 1, onExecute }] } })
    const outcome = await write([entry('K0', 5), entry('K2', 7)], { verify: true })
    assert.deepEqual([outcome.outcome, outcome.code], ['failed', 'VERIFY_FAILED'])
    assert.deepEqual(
      outcome.items.map(({ outcome: word }) => word),
      ['failed', 'confirmed']
    )
    assert.equal((await write([entry('K2', 7)])).outcome, 'confirmed')
  })

  it('of two writes to one target the later one holds, and is the one that is verified', async () => {
    start()
    const outcome = await write([entry('K0', 1), entry('K0', 2), entry('K0.3', true)], { verify: true })
    assert.equal(outcome.outcome, 'confirmed')
    assert.equal(b.station.get('K0'), 10)
  })

  it('the first frame that fails ends the write, and the outcome says how far it came', async () => {
    start()
    b.faults.once('silent', { skip: 1 })
    const values = Array.from({ length: 70 }, (_, at) => at)
    const outcome = await write([entry('M0..M69', values), entry('K60', 1), entry('K126', 2), entry('K60', 3)], {
      fixed: true
    })
    assert.equal(outcome.outcome, 'unknown')
    assert.equal(outcome.attempts, 2)
    const words = outcome.items.map(({ outcome: word }) => word)
    assert.equal(words.at(-1), 'notSent')
    assert.ok(words.includes('unknown'))
    assert.equal(executed(), 2)
  })

  it('the station’s own refusal is refused', async () => {
    start()
    b.station.setMode('program')
    const outcome = await write([entry('K0', 5)])
    assert.deepEqual([outcome.outcome, outcome.code], ['refused', 'PLC_NOT_PERFORMED'])
    assert.equal(b.station.writes.size, 0)
  })

  it('the acknowledgement that the manual prints counts, but not while a bit write is unanswered', async () => {
    start({ sim: { stations: [{ station: 1, printedAck: true }] } })
    assert.equal((await write([entry('K0', 1)])).outcome, 'confirmed')
    assert.equal(b.device.stats.nonStandardAcks, 1)
    b.faults.once('silent')
    assert.equal((await write([entry('K1.0', true)])).outcome, 'unknown')
    assert.equal((await write([entry('K0', 2)])).outcome, 'unknown')
    await b.run(b.device.read(['K0']))
    assert.equal((await write([entry('K0', 3)])).outcome, 'confirmed')
  })

  it('what never went out has failed', async () => {
    start()
    b.wire.unplug()
    await b.clock.advance(10)
    const outcome = await write([entry('K0', 5)])
    assert.equal(outcome.outcome, 'failed')
    assert.equal(b.station.counts.queries, 0)
  })

  it('a line that breaks while the answer is awaited leaves the write unknown', async () => {
    for (const break_ of [() => b.wire.unplug(), () => b.lease.release()]) {
      start()
      await write([entry('K0', 1)])
      b.faults.once('silent')
      const promise = b.device.write([entry('K0', 5)])
      await b.clock.advance(60)
      break_()
      const outcome = await b.run(promise)
      assert.deepEqual([outcome.outcome, outcome.code], ['unknown', 'WRITE_UNKNOWN'])
      assert.equal(b.station.writes.get('word:320'), 2)
      await b.close()
    }
  })

  it('coalesce: of several that wait only the latest goes out, in the first one’s place', async () => {
    start()
    const busy = b.device.read(['M0..M127'])
    const promises = [1, 2, 3].map(value => b.device.write([entry('K0', value)], { coalesce: true }))
    const other = b.device.write([entry('K1', 9)], { coalesce: true })
    const outcomes = await b.run(Promise.all([...promises, other]))
    assert.deepEqual(
      outcomes.map(({ outcome, code }) => code ?? outcome),
      ['SUPERSEDED', 'SUPERSEDED', 'confirmed', 'confirmed']
    )
    assert.equal(b.station.get('K0'), 3)
    assert.equal(b.station.writes.get('word:320'), 1)
    await b.run(busy)
    assert.equal((await write([entry('K0', 4)], { coalesce: true })).outcome, 'confirmed')
  })

  it('coalesce: one that is refused does not displace one that waits', async () => {
    start()
    const busy = b.device.read(['M0'])
    const first = b.device.write([entry('K0', 1)], { coalesce: true })
    const second = b.device.write([entry('K0', 'x')], { coalesce: true })
    const outcomes = await b.run(Promise.all([first, second]))
    assert.deepEqual(
      outcomes.map(({ outcome }) => outcome),
      ['confirmed', 'refused']
    )
    await b.run(busy)
  })

  it('without coalesce every value goes out, in order', async () => {
    start()
    const seen = []
    const outcomes = await b.run(Promise.all([1, 2, 3].map(value => b.device.write([entry('K0', value)]))))
    assert.deepEqual(
      outcomes.map(({ outcome }) => outcome),
      ['confirmed', 'confirmed', 'confirmed']
    )
    for (const { values } of b.queries) seen.push(...values)
    assert.deepEqual(seen, [1, 2, 3])
  })
})
