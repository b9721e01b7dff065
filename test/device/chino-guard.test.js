'use strict'

const assert = require('node:assert/strict')
const fc = require('fast-check')
const { modbusNotation, parseItem } = require('../../lib')
const { createGuard } = require('../../lib/device/guard')
const { bench } = require('./chino-bench')

const tags = [
  { name: 'output', address: '400001', scale: 0.1, min: 0, max: 80, writable: true },
  { name: 'energy', address: '400021:uint32', max: 1000, writable: true },
  { name: 'word', address: '001005:uint16', max: 100, writable: true },
  { name: 'high', address: '002001:uint32', wordOrder: 'high', max: 100 },
  { name: 'fan', address: '000050', writable: true },
  { name: 'mode', address: '400031.05', writable: true },
  { name: 'plain', address: '400041' }
]
const entry = (item, value) => ({ item, value })
const short = ({ outcome, code, attempts }) => [outcome, code, attempts]

describe('CHINO regulator: what may be written', () => {
  let b
  const start = options => (b = bench(options))
  afterEach(async () => {
    await b.close()
    assert.equal(b.clock.pending(), 0, 'a timer is left')
  })

  const guarded = [
    // item, value, code; refused whether or not the target is fixed
    ['300001', 1, 'NOT_WRITABLE'],
    ['300001.02', true, 'NOT_WRITABLE'],
    ['100001', true, 'NOT_WRITABLE'],
    ['100001:uint16', 1, 'NOT_WRITABLE'],
    ['output', 80.1, 'VALUE_OUT_OF_RANGE'],
    ['hr0', 801, 'NOT_WRITABLE'],
    ['400001:int16', 1, 'NOT_WRITABLE'],
    ['400001.00', true, 'NOT_WRITABLE'],
    ['400001:uint32', 1, 'NOT_WRITABLE'],
    ['energy', 1001, 'VALUE_OUT_OF_RANGE'],
    ['400021', 1, 'NOT_WRITABLE'],
    ['400022', 1, 'NOT_WRITABLE'],
    ['400022.15', true, 'NOT_WRITABLE'],
    ['400020..400023', [1, 1, 1, 1], 'NOT_WRITABLE'],
    ['400020:uint32', 1, 'NOT_WRITABLE'],
    ['word', 101, 'VALUE_OUT_OF_RANGE'],
    ['001005', true, 'NOT_WRITABLE'],
    ['001020', true, 'NOT_WRITABLE'],
    ['000990:uint16', 1, 'NOT_WRITABLE'],
    ['001006:uint16', 1, 'NOT_WRITABLE'],
    ['000990..001005', new Array(16).fill(true), 'NOT_WRITABLE'],
    ['co1004:uint32', 1, 'NOT_WRITABLE'],
    ['002001:uint32', 1, 'NOT_WRITABLE'],
    ['002032', true, 'NOT_WRITABLE']
  ]
  it('guards: tables that are only read, and what overlaps a tag with limits, by bits', async () => {
    start({ device: { tags } })
    for (const [item, value, code] of guarded) {
      const outcome = await b.write([entry(item, value)])
      const wanted = item === 'hr0' ? 'VALUE_OUT_OF_RANGE' : code
      assert.deepEqual(
        [outcome.outcome, outcome.code, outcome.attempts],
        ['refused', wanted, 0],
        `${item}: ${outcome.text}`
      )
    }
    assert.equal(b.slave.requests.length, 0)
    for (const [item, value] of [
      ['001004', true],
      ['001021', true],
      ['000989:uint16', 1],
      ['001021:uint16', 1],
      ['001005:uint16', 100],
      ['002000', true],
      ['002033', true],
      ['high', 100],
      ['400020', 1],
      ['400023.00', true],
      ['hr0', 800]
    ]) {
      const outcome = await b.write([entry(item, value)])
      assert.equal(outcome.outcome, 'confirmed', `${item}: ${outcome.text}`)
    }
  })

  it('guards: a target of a message must be a writable tag or lie in a writable range, bits and numbers too', async () => {
    start({ device: { tags, writableRanges: '400051..400052, 000101..000132, 400060.03' } })
    const cases = [
      ['400051', 1, true],
      ['400051:uint32', 1, true],
      ['400052.15', true, true],
      ['400052:uint32', 1, false],
      ['400060.03', true, true],
      ['400060.04', true, false],
      ['400060', 1, false],
      ['000101:uint32', 1, true],
      ['000117:uint16', 1, true],
      ['000118:uint16', 1, false],
      ['000132', true, true],
      ['000133', true, false],
      ['mode', true, true],
      ['400031.06', true, false],
      ['fan', true, true],
      ['plain', 1, false]
    ]
    for (const [item, value, allowed] of cases) {
      const outcome = await b.write([entry(item, value)], { fixed: false })
      assert.equal(outcome.code, allowed ? undefined : 'NOT_WRITABLE', `${item}: ${outcome.text}`)
    }
    const reader = b.make({ access: 'read' })
    assert.equal((await b.run(reader.write([entry('400001', 1)], { fixed: true }))).code, 'READ_ONLY')
    assert.throws(
      () => reader.checkTarget('400001'),
      error => error.code === 'READ_ONLY'
    )
    assert.throws(
      () => b.device.checkTarget('300001.00'),
      error => error.code === 'NOT_WRITABLE'
    )
    assert.doesNotThrow(() => b.device.checkTarget('400031.00'))
    reader.close()
  })

  it('a limited tag binds exactly its bits: any item against any tag, counted bit by bit', () => {
    const WIDTH = { uint16: 16, int16: 16, uint32: 32 }
    const pad = (digit, number) => `${digit}${String(number).padStart(5, '0')}`
    const register = fc.record({
      number: fc.integer({ min: 1, max: 6 }),
      type: fc.constantFrom('uint16', 'int16', 'uint32')
    })
    const coil = fc.record({
      number: fc.integer({ min: 1, max: 70 }),
      type: fc.constantFrom('uint16', 'int16', 'uint32')
    })
    // [text, first bit, after the last, type], bits of registers from 0, coils far behind
    const registerOf = ({ number, type }) => [
      `${pad(4, number)}:${type}`,
      (number - 1) * 16,
      (number - 1) * 16 + WIDTH[type],
      type
    ]
    const coilsOf = ({ number, type }) => [
      `${pad(0, number)}:${type}`,
      5000 + number,
      5000 + number + WIDTH[type],
      type
    ]
    const numbers = fc.oneof(register.map(registerOf), coil.map(coilsOf))
    const registerBit = fc.nat(110).map(bit => {
      const text = `${pad(4, (bit >> 4) + 1)}.${String(bit & 15).padStart(2, '0')}`
      return [text, bit, bit + 1, 'bool']
    })
    const oneCoil = fc
      .integer({ min: 1, max: 110 })
      .map(number => [pad(0, number), 5000 + number, 5001 + number, 'bool'])
    const property = fc.property(
      numbers,
      fc.oneof(numbers, registerBit, oneCoil),
      ([tag, from, to], [text, first, end, type]) => {
        const notation = modbusNotation({ tags: [{ name: 'limited', address: tag, min: 0, max: 5 }] })
        const guard = createGuard({ access: 'write', station: 1, ranges: [], notation, reasons: {} })
        const item = parseItem(text, notation)
        const raw = type === 'bool' ? [true] : item.type.encode(3)
        const same = first === from && end === to && tag.endsWith(`:${type}`)
        const refused = first < to && from < end && !same
        const check = () => guard.checkValues(item, [raw])
        if (refused) assert.throws(check, error => error.code === 'NOT_WRITABLE')
        else assert.doesNotThrow(check)
      }
    )
    fc.assert(property, { numRuns: 3000, seed: 11 })
  })

  describe('broadcast', () => {
    it('goes to all, waits, and is never confirmed', async () => {
      start({
        slaves: [{ station: 11 }, { station: 12 }],
        device: { station: 0, broadcast: true, turnaround: 150, coilFunction: '05' }
      })
      const began = b.clock.now()
      const outcome = await b.write([entry('400001', 7), entry('000001..000002', [true, true])])
      assert.deepEqual(short(outcome), ['unknown', 'BROADCAST_UNCONFIRMED', 2])
      assert.ok(
        outcome.items.every(({ outcome: each, code }) => each === 'unknown' && code === 'BROADCAST_UNCONFIRMED')
      )
      assert.ok(b.clock.now() - began >= 450)
      for (const slave of b.slaves) {
        assert.deepEqual([slave.values('hr', 0, 1), slave.values('co', 0, 2)], [[7], [1, 1]])
      }
      assert.equal(b.lease.line.stats().timeouts, 0)
      const { broadcasts, answers } = b.device.stats
      assert.deepEqual({ broadcasts, answers }, { broadcasts: 2, answers: 0 })
      assert.equal(b.device.name, 'all stations')
    })

    it('refuses reading, bits of registers and reading back, and sends nothing', async () => {
      start({ device: { station: 0, broadcast: true } })
      await assert.rejects(b.read(['400001']), error => error.code === 'BROADCAST_REFUSED')
      assert.throws(
        () => b.device.subscribe({ items: ['400001'], interval: 100 }, () => {}),
        error => error.code === 'BROADCAST_REFUSED'
      )
      for (const [entries, options] of [
        [[entry('400001.03', true)]],
        [[entry('400001', 1), entry('400002.03', true)]],
        [[entry('400001', 1)], { verify: true }]
      ]) {
        const outcome = await b.write(entries, options)
        assert.deepEqual(short(outcome), ['refused', 'BROADCAST_REFUSED', 0])
      }
      assert.equal(b.slave.requests.length, 0)
    })

    it('guards bind it', async () => {
      start({ device: { station: 0, broadcast: true, tags } })
      assert.equal((await b.write([entry('output', 81)])).code, 'VALUE_OUT_OF_RANGE')
      assert.equal((await b.write([entry('400001', 1)], { fixed: false })).code, 'NOT_WRITABLE')
      assert.equal(b.slave.requests.length, 0)
    })
  })
})
