'use strict'

const assert = require('node:assert/strict')
const fc = require('fast-check')
const { check } = require('../../lib/codec/nx/limits')
const { planReads } = require('../../lib/plan')
const { growth } = require('../support/growth')
const { LIMITS } = require('./support')

const word = (address, count = 1) => ({ kind: 'word', address, count })
const bit = address => ({ kind: 'bit', address, count: 1 })
const words = (from, count) => Array.from({ length: count }, (_, at) => word(from + at))
const shape = requests =>
  requests.map(({ ask, base, count, addresses }) =>
    addresses ? `${ask} ${addresses.map(each => each.kind[0] + each.address).join(' ')}` : `${ask} ${base} ${count}`
  )
const plan = (points, limits = {}) => planReads(points, { ...LIMITS, ...limits })

/** What a station would answer: the address itself stands for the value. */
const answer = ({ base, count, addresses, ask }) =>
  addresses
    ? addresses.map(({ kind, address }) => kind[0] + address)
    : Array.from({ length: count }, (_, at) => (ask === 'readBits' ? 'b' : 'w') + (base + at))

/** Every point once, all of its addresses in one answer, at the place that is said. */
const checkServed = (points, requests) => {
  const served = new Map()
  for (const request of requests) {
    const values = answer(request)
    for (const { point, at, count } of request.points) {
      assert.ok(!served.has(point), `point ${point} twice`)
      served.set(point, values.slice(at, at + count))
    }
  }
  points.forEach(({ kind, address, count }, index) => {
    const expected = Array.from({ length: count }, (_, at) => kind[0] + (address + at))
    assert.deepEqual(served.get(index), expected)
  })
}

const checkLimits = (requests, limits, bounds) => {
  for (const request of requests) {
    check(request, { ...LIMITS, ...limits })
    if (!request.addresses) {
      const size = request.ask === 'readBits' ? 16 : 1
      const end = request.base + request.count
      const groups = request.points.map(({ at, count }) => [request.base + at, request.base + at + count])
      for (const bound of bounds.map(each => each * size)) {
        const inside = bound > request.base && bound < end
        assert.ok(!inside || groups.some(([from, to]) => from < bound && bound < to), `crosses ${bound}`)
      }
    }
  }
}

describe('plan of reads', () => {
  it('reads neighbours in one block', () => {
    assert.deepEqual(shape(plan(words(0xc0, 128))), ['readWords 192 128'])
    assert.deepEqual(shape(plan(words(0xc0, 129))), ['readWords 192 128', 'readWords 320 1'])
    assert.deepEqual(shape(plan([bit(5), bit(3), bit(4)])), ['readBits 3 3'])
    assert.deepEqual(shape(plan([])), [])
  })

  it('reads scattered ones in one mixed request, bits first', () => {
    assert.deepEqual(shape(plan([word(447), bit(7164), word(0x210), word(447)])), ['readMixed b7164 w447 w528'])
  })

  it('keeps what a mixed request cannot hold in blocks', () => {
    // bits of words after $3FF, words after $3FFF: the mark takes two bits of the address
    assert.deepEqual(shape(plan([bit(0x4000), bit(0x3fff), word(0x3fff), word(0x4000)])), [
      'readWords 16383 2',
      'readBits 16383 2'
    ])
    assert.deepEqual(shape(plan([bit(0x4000), bit(0x3ffe), word(5)])), ['readBits 16384 1', 'readMixed b16382 w5'])
  })

  it('does not cross the end of an area', () => {
    const points = [word(0x13f), word(0x140), bit(0x1400), bit(0x13ff)]
    const requests = plan(points, { bounds: [0xc0, 0x140], readMixed: 0 })
    assert.deepEqual(shape(requests).sort(), [
      'readBits 5119 1',
      'readBits 5120 1',
      'readWords 319 1',
      'readWords 320 1'
    ])
  })

  it('does not cross it either where there are so many values that neighbours are planned in pairs', () => {
    const points = words(0, 4200)
    const own = { bounds: [2001], readMixed: 0 }
    const requests = plan(points, own)
    checkServed(points, requests)
    checkLimits(requests, own, own.bounds)
    assert.equal(requests.length, Math.ceil(2001 / 128) + Math.ceil(2199 / 128))
  })

  it('does not tear a value of several words', () => {
    const points = [...words(0, 127), word(127, 2)]
    assert.deepEqual(shape(plan(points)), ['readWords 0 127', 'readWords 127 2'])
    assert.throws(
      () => plan([word(0, 129)]),
      error => error.code === 'FRAME_TOO_LONG'
    )
    const apart = Array.from({ length: 100 }, (_, at) => word(at * 3, 2))
    checkServed(apart, plan(apart))
  })

  it('large blocks stay blocks beside a mixed request', () => {
    const requests = plan([...words(0, 100), word(300), word(400), bit(9000)])
    assert.deepEqual(shape(requests), ['readWords 0 100', 'readMixed b9000 w300 w400'])
  })

  it('20,000 scattered words are planned at once', () => {
    const points = Array.from({ length: 20000 }, (_, at) => word(at * 3))
    checkServed(points, plan(points))
    const ratio = growth(size => plan(points.slice(0, size)), 2000)
    assert.ok(ratio < 10, `four times the points take ${ratio.toFixed(1)} times as long`)
  })

  const anyPoint = fc.oneof(
    fc.record({
      kind: fc.constant('word'),
      address: fc.integer({ min: 0, max: 400 }),
      count: fc.integer({ min: 1, max: 4 })
    }),
    fc.record({
      kind: fc.constant('word'),
      address: fc.integer({ min: 0x3ff0, max: 0x400f }),
      count: fc.constantFrom(1, 2)
    }),
    fc.record({ kind: fc.constant('bit'), address: fc.integer({ min: 0x3fe0, max: 0x4020 }), count: fc.constant(1) }),
    fc.record({ kind: fc.constant('bit'), address: fc.integer({ min: 0, max: 300 }), count: fc.constant(1) })
  )

  it('serves every point exactly once, inside all limits', () => {
    const limits = fc.record({
      readBits: fc.integer({ min: 1, max: 255 }),
      readWords: fc.integer({ min: 4, max: 128 }),
      readMixed: fc.integer({ min: 0, max: 128 }),
      info: fc.integer({ min: 8, max: 256 }),
      frameCost: fc.constantFrom(0, 60, 1e6)
    })
    const bounds = fc.uniqueArray(fc.integer({ min: 0, max: 500 }), { maxLength: 5 })
    fc.assert(
      fc.property(fc.array(anyPoint, { maxLength: 150 }), limits, bounds, (points, own, borders) => {
        const requests = plan(points, { ...own, bounds: borders })
        checkServed(points, requests)
        checkLimits(requests, own, borders)
      }),
      { numRuns: 300 }
    )
  })
})
