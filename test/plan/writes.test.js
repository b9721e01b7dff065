'use strict'

const assert = require('node:assert/strict')
const fc = require('fast-check')
const { check } = require('../../lib/codec/nx/limits')
const { planWrites } = require('../../lib/plan')
const { LIMITS } = require('./support')

const plan = (points, limits = {}) => planWrites(points, { ...LIMITS, ...limits })
const word = (address, ...values) => ({ kind: 'word', address, values })
const bit = (address, value = true) => ({ kind: 'bit', address, values: [value] })
const words = (from, count) => Array.from({ length: count }, (_, at) => word(from + at, at))

const placesOf = ({ ask, base, values, writes }) =>
  writes ?? values.map((value, at) => ({ kind: ask === 'writeBits' ? 'bit' : 'word', address: base + at, value }))

/** The memory after the writes, as bits: a word is its sixteen bits. */
const memoryAfter = writes => {
  const memory = new Map()
  for (const { kind, address, value } of writes) {
    if (kind === 'bit') memory.set(address, value)
    else for (let at = 0; at < 16; at++) memory.set(address * 16 + at, Boolean((value >> at) & 1))
  }
  return [...memory].sort(([a], [b]) => a - b)
}

const inOrder = points =>
  points.flatMap(({ kind, address, values }) => values.map((value, at) => ({ kind, address: address + at, value })))

describe('plan of writes', () => {
  it('writes neighbours in blocks of 64 words', () => {
    const requests = plan(words(0x140, 128))
    assert.deepEqual(
      requests.map(({ ask, base, values }) => [ask, base, values.length]),
      [
        ['writeWords', 0x140, 64],
        ['writeWords', 0x180, 64]
      ]
    )
    assert.equal(plan(words(0x140, 128), { writeWords: 127 }).length, 2)
    assert.equal(plan(words(0x140, 127), { writeWords: 127 }).length, 1)
  })

  it('writes one bit, and one word, as the manual does', () => {
    assert.deepEqual(plan([bit(0x1bfc)]), [{ ask: 'writeBits', base: 0x1bfc, values: [true], points: [0] }])
    assert.deepEqual(plan([word(0x140, 0x1234)]), [{ ask: 'writeWords', base: 0x140, values: [0x1234], points: [0] }])
  })

  it('writes a mix in one frame', () => {
    const [request, ...more] = plan([word(0x1bf, 0x5678), bit(0x1bfc - 32), word(0x150, 1, 2)])
    assert.equal(more.length, 0)
    assert.equal(request.ask, 'writeMixed')
    assert.deepEqual(request.points, [0, 1, 2])
    assert.deepEqual(
      memoryAfter(placesOf(request)),
      memoryAfter(inOrder([word(0x1bf, 0x5678), bit(0x1bdc), word(0x150, 1, 2)]))
    )
  })

  it('64 scattered words fit one frame, 65 do not; 85 bits, 86 do not', () => {
    const scattered = (count, make) => Array.from({ length: count }, (_, at) => make(at * 3))
    assert.equal(plan(scattered(64, at => word(at, 1))).length, 1)
    assert.equal(plan(scattered(65, at => word(at, 1))).length, 2)
    assert.equal(plan(scattered(85, at => bit(at))).length, 1)
    assert.equal(plan(scattered(86, at => bit(at))).length, 2)
  })

  it('never turns two writes of one target round', () => {
    const requests = plan([word(5, 1), word(5, 2), bit(5 * 16), word(5, 4)])
    assert.deepEqual(
      requests.map(({ points }) => points),
      [[0], [1], [2], [3]]
    )
  })

  it('refuses a value that does not fit into one frame', () => {
    assert.throws(
      () => plan([word(0, ...new Array(65).fill(0))]),
      error => error.code === 'FRAME_TOO_LONG'
    )
  })

  it('has the effect of the writes one by one, each value in one frame, inside all limits', () => {
    const point = fc.oneof(
      fc.record({
        kind: fc.constant('word'),
        address: fc.integer({ min: 0, max: 60 }),
        values: fc.array(fc.nat(0xffff), { minLength: 1, maxLength: 4 })
      }),
      fc.record({
        kind: fc.constant('word'),
        address: fc.integer({ min: 0x3ffc, max: 0x4004 }),
        values: fc.array(fc.nat(0xffff), { minLength: 1, maxLength: 2 })
      }),
      fc.record({
        kind: fc.constant('bit'),
        address: fc.integer({ min: 0, max: 980 }),
        values: fc.tuple(fc.boolean())
      }),
      fc.record({
        kind: fc.constant('bit'),
        address: fc.integer({ min: 0x3ff0, max: 0x4010 }),
        values: fc.tuple(fc.boolean())
      })
    )
    const limits = fc.record({
      writeBits: fc.integer({ min: 1, max: 254 }),
      writeWords: fc.integer({ min: 4, max: 127 }),
      writeMixed: fc.integer({ min: 1, max: 85 }),
      info: fc.integer({ min: 16, max: 256 })
    })
    fc.assert(
      fc.property(fc.array(point, { maxLength: 60 }), limits, (points, own) => {
        const requests = plan(points, own)
        for (const request of requests) check(request, { ...LIMITS, ...own })
        assert.deepEqual(memoryAfter(requests.flatMap(placesOf)), memoryAfter(inOrder(points)))
        const served = requests.flatMap(request => request.points).sort((a, b) => a - b)
        assert.deepEqual(served, [...points.keys()])
        for (const request of requests) {
          const places = new Set(placesOf(request).map(({ kind, address }) => `${kind}${address}`))
          for (const index of request.points) {
            const { kind, address, values } = points[index]
            values.forEach((_, at) => assert.ok(places.has(`${kind}${address + at}`)))
          }
        }
      }),
      { numRuns: 300 }
    )
  })

  it('needs no more frames than the best way to share', () => {
    const fewest = (blocks, room) => {
      let best = Infinity
      for (let choice = 0; choice < 2 ** blocks.length; choice++) {
        const mixed = blocks.filter((_, at) => choice & (1 << at))
        const bytes = mixed.reduce((sum, count) => sum + 4 * count, 0)
        best = Math.min(best, blocks.length - mixed.length + Math.ceil(bytes / room))
      }
      return best
    }
    fc.assert(
      fc.property(
        fc.array(fc.integer({ min: 1, max: 6 }), { minLength: 1, maxLength: 9 }),
        fc.integer({ min: 4, max: 12 }),
        (blocks, room) => {
          const points = blocks.flatMap((count, at) => words(at * 20, count))
          assert.equal(plan(points, { info: 4 * room, writeWords: 6 }).length <= fewest(blocks, 4 * room) + 0, true)
        }
      )
    )
  })
})
