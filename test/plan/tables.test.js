'use strict'

const assert = require('node:assert/strict')
const fc = require('fast-check')
const { planTableWrites, planTables } = require('../../lib/plan')

const HR = 0
const IR = 0x10000
const CO = 0x200000
const DI = 0x210000

const tables = (limits = {}) => [
  { kind: 'bit', from: CO, to: DI, read: 2000, write: 1968, ...limits.co },
  { kind: 'bit', from: DI, to: DI + 0x10000, read: 2000, write: 0, ...limits.di },
  { kind: 'word', from: IR, to: IR + 0x10000, read: 125, write: 0, ...limits.ir },
  { kind: 'word', from: HR, to: IR, read: 125, write: 123, ...limits.hr }
]
const word = (address, count = 1) => ({ kind: 'word', address, count })
const bit = (address, count = 1) => ({ kind: 'bit', address, count })
const through = (address, value) => ({ kind: 'bit', address, values: [value], through: true })
const values = (kind, address, ...given) => ({ kind, address, values: given })
const plain = ({ ask, base, count }) => [ask, base, count]

describe('plan of tables: reads', () => {
  it('each table by its own limit, and never over two of them', () => {
    const points = [word(0xffff), word(IR), word(IR + 1), bit(CO + 0xffff), bit(DI), word(3, 2)]
    assert.deepEqual(planTables(points, tables()).map(plain), [
      ['readBits', CO + 0xffff, 1],
      ['readBits', DI, 1],
      ['readWords', IR, 2],
      ['readWords', 3, 2],
      ['readWords', 0xffff, 1]
    ])
  })

  it('tells where in the answers each point stands, by its place in the whole', () => {
    const requests = planTables([word(IR + 5), bit(CO + 16, 16), word(IR + 4), bit(CO + 20)], tables())
    const served = requests.flatMap(({ base, points }) =>
      points.map(({ point, at, count }) => [point, base + at, count])
    )
    assert.deepEqual(
      served.sort(([a], [b]) => a - b),
      [
        [0, IR + 5, 1],
        [1, CO + 16, 16],
        [2, IR + 4, 1],
        [3, CO + 20, 1]
      ]
    )
  })

  it('126 registers are two requests, 2001 coils too; a value is not torn', () => {
    assert.deepEqual(
      planTables(
        Array.from({ length: 126 }, (_, at) => word(at)),
        tables()
      ).map(plain),
      [
        ['readWords', 0, 125],
        ['readWords', 125, 1]
      ]
    )
    assert.deepEqual(
      planTables(
        Array.from({ length: 2001 }, (_, at) => bit(CO + at)),
        tables()
      ).map(plain),
      [
        ['readBits', CO, 2000],
        ['readBits', CO + 2000, 1]
      ]
    )
    const wide = planTables(
      Array.from({ length: 63 }, (_, at) => word(2 * at, 2)),
      tables()
    )
    assert.deepEqual(wide.map(plain), [
      ['readWords', 0, 124],
      ['readWords', 124, 2]
    ])
  })

  it('refuses a value that is longer than one request', () => {
    assert.throws(
      () => planTables([word(0, 2)], tables({ hr: { read: 1 } })),
      error => error.code === 'FRAME_TOO_LONG'
    )
  })
})

describe('plan of tables: writes', () => {
  it('neighbours in one request, by the limits of their table', () => {
    const requests = planTableWrites(
      [values('word', 1, 7), values('bit', CO + 3, true), values('word', 0, 5), values('bit', CO + 4, false)],
      tables()
    )
    assert.deepEqual(requests, [
      { ask: 'writeBits', base: CO + 3, values: [true, false], points: [1, 3] },
      { ask: 'writeWords', base: 0, values: [5, 7], points: [0, 2] }
    ])
    const many = Array.from({ length: 124 }, (_, at) => values('word', at, at))
    assert.deepEqual(
      planTableWrites(many, tables()).map(request => request.values.length),
      [123, 1]
    )
  })

  it('several bits of one register in one request, the other bits stay', () => {
    const requests = planTableWrites(
      [through(16 * 5 + 15, true), through(16 * 5, false), through(16 * 6 + 1, true)],
      tables()
    )
    assert.deepEqual(requests, [
      { ask: 'writeBitsOfWord', base: 5, mask: 0x8001, value: 0x8000, points: [0, 1] },
      { ask: 'writeBitsOfWord', base: 6, mask: 2, value: 2, points: [2] }
    ])
  })

  it('a later write of the same target comes later: bit and word, word and bit, bit and bit', () => {
    const bitFirst = planTableWrites([through(80, true), values('word', 5, 0)], tables())
    assert.deepEqual(
      bitFirst.map(({ ask }) => ask),
      ['writeBitsOfWord', 'writeWords']
    )
    const wordFirst = planTableWrites([values('word', 5, 0), through(80, true)], tables())
    assert.deepEqual(
      wordFirst.map(({ ask }) => ask),
      ['writeWords', 'writeBitsOfWord']
    )
    const twice = planTableWrites([through(80, true), through(81, true), through(80, false)], tables())
    assert.deepEqual(
      twice.map(({ mask, value }) => [mask, value]),
      [
        [3, 3],
        [1, 0]
      ]
    )
  })

  it('nothing is written to a table that is only read', () => {
    for (const point of [values('word', IR, 1), values('bit', DI, true)]) {
      assert.throws(
        () => planTableWrites([point], tables()),
        error => error.code === 'FRAME_TOO_LONG'
      )
    }
  })

  it('has the effect of the writes one by one', () => {
    const bits = fc
      .record({ address: fc.nat(80), value: fc.boolean() })
      .map(({ address, value }) => through(address, value))
    const words = fc
      .record({ address: fc.nat(4), given: fc.array(fc.nat(0xffff), { minLength: 1, maxLength: 2 }) })
      .map(({ address, given }) => values('word', address, ...given))
    const property = fc.property(fc.array(fc.oneof(bits, words), { maxLength: 12 }), points => {
      const expected = new Map()
      for (const { kind, address, values: given } of points) {
        given.forEach((value, at) => {
          if (kind === 'bit') expected.set(address + at, value)
          else for (let n = 0; n < 16; n++) expected.set((address + at) * 16 + n, Boolean((value >> n) & 1))
        })
      }
      const memory = new Map()
      for (const request of planTableWrites(points, tables({ hr: { write: 3 } }))) {
        const { ask, base } = request
        const mask = ask === 'writeBitsOfWord' ? [request.mask] : request.values.map(() => 0xffff)
        const given = ask === 'writeBitsOfWord' ? [request.value] : request.values
        mask.forEach((each, at) => {
          for (let n = 0; n < 16; n++)
            if ((each >> n) & 1) memory.set((base + at) * 16 + n, Boolean((given[at] >> n) & 1))
        })
      }
      const sorted = map => [...map].sort(([a], [b]) => a - b)
      assert.deepEqual(sorted(memory), sorted(expected))
    })
    fc.assert(property, { numRuns: 300, seed: 7 })
  })
})
