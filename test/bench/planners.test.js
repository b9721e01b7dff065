'use strict'

const assert = require('node:assert/strict')
const { greedy, onePerItem } = require('../../bench/planners')
const { drawn } = require('../../bench/plot')
const { dense, mixed, scattered } = require('../../bench/samples')
const { cycleOf } = require('../../bench/virtual')
const { createRandom } = require('../../lib/sim')

/** Areas as an NX PLC has them: M from word 0x0c0 on, K from 0x140. */
const LIMITS = { readBits: 255, readWords: 128, frameCost: 69.6, bounds: [0x0c0, 0x140, 0x1c0, 0x200, 0xa00] }
const words = (...addresses) => addresses.map(address => ({ kind: /** @type {'word'} */ ('word'), address, count: 1 }))
const blocks = requests => requests.map(({ base, count }) => [base, count])

const randomPoints = (random, count) =>
  Array.from({ length: count }, () => {
    const kind = random.pick(['bit', 'word'])
    return { kind, address: random.integer(0x0c0, 0x9f0) * (kind === 'bit' ? 4 : 1), count: random.integer(1, 5) }
  })

/** Where each point of a plan stands, as address: what a memory that holds its own addresses would answer. */
const served = requests => {
  const places = []
  for (const { base, points } of requests) for (const { point, at } of points) places[point] = base + at
  return places
}

describe('bench: planners to compare with', () => {
  it('both serve every point, inside of their requests and the limits', () => {
    const random = createRandom(11)
    for (let n = 0; n < 200; n++) {
      const points = randomPoints(random, random.integer(1, 40))
      for (const planner of [onePerItem, greedy]) {
        const requests = planner(points, LIMITS)
        assert.deepEqual(
          served(requests),
          points.map(({ address }) => address)
        )
        for (const { ask, count, points: own } of requests) {
          assert.ok(count <= (ask === 'readBits' ? 255 : 128))
          for (const each of own) {
            assert.equal(ask, points[each.point].kind === 'bit' ? 'readBits' : 'readWords')
            assert.ok(each.at >= 0 && each.at + each.count <= count && each.count === points[each.point].count)
          }
        }
      }
    }
  })

  it('one request per item: one each, whatever stands beside it', () => {
    assert.deepEqual(blocks(onePerItem(words(0x200, 0x201, 0x200), LIMITS)), [
      [0x200, 1],
      [0x201, 1],
      [0x200, 1]
    ])
  })

  it('greedy: over a gap that costs no more than a request, up to 128 words, not over an area', () => {
    assert.deepEqual(blocks(greedy(words(0x214, 0x200, 0x20a), LIMITS)), [[0x200, 21]])
    // 72.6 byte times are 36 words
    assert.deepEqual(blocks(greedy(words(0x200, 0x225), LIMITS)), [[0x200, 38]])
    assert.deepEqual(blocks(greedy(words(0x200, 0x226), LIMITS)), [
      [0x200, 1],
      [0x226, 1]
    ])
    const apart = Array.from({ length: 14 }, (_, n) => 0x200 + 10 * n)
    assert.deepEqual(blocks(greedy(words(...apart), LIMITS)), [
      [0x200, 121],
      [0x282, 1]
    ])
    assert.deepEqual(blocks(greedy(words(0x13f, 0x140), LIMITS)), [
      [0x13f, 1],
      [0x140, 1]
    ])
  })

  it('costs: 12 bytes of frame, the query`s three and the answer`s', () => {
    assert.equal(greedy(words(0x200, 0x202), LIMITS)[0].cost, 69.6 + 3 + 6)
    assert.equal(onePerItem([{ kind: 'bit', address: 5, count: 1 }], LIMITS)[0].cost, 69.6 + 3 + 1)
  })
})

describe('bench: cycles in virtual time', () => {
  const valueOf = item => ((0x200 + Number(item.slice(1))) * 40503) & 0xffff

  it('every planner brings the values of all items', async () => {
    const items = scattered(40)
    for (const options of [
      {},
      { soleMaster: true },
      { planner: greedy },
      { planner: onePerItem, steps: /** @type {4} */ (4) }
    ])
      assert.deepEqual((await cycleOf(items, options)).values, items.map(valueOf))
  })

  it('take what their bytes, gaps and turnarounds take', async () => {
    // 9 bytes, 5 ms, 8 bytes, and 10 ms before each query
    const { measured, requests } = await cycleOf(['W0', 'W100'], { planner: onePerItem })
    assert.equal(requests, 2)
    assert.ok(Math.abs(measured - 2 * (15 + (17 * 10000) / 38400)) < 0.01, String(measured))
  })
})

describe('bench: samples and plot', () => {
  it('samples are what they say, and the same in each run', () => {
    assert.equal(new Set(scattered(1000)).size, 1000)
    assert.deepEqual(mixed(200, 2), mixed(200, 2))
    const items = mixed(200, 3)
    assert.equal(new Set(items).size, 200)
    assert.ok(items.filter(item => item.includes('.')).length > 70)
    for (const list of Object.values(dense)) assert.equal(new Set(list).size, list.length)
  })

  it('draws points where they belong', () => {
    const curves = [
      {
        name: 'a & b',
        color: '#111',
        points: /** @type {[number, number][]} */ ([
          [1, 10],
          [10, 1000]
        ])
      },
      {
        name: 'c',
        color: '#222',
        points: /** @type {[number, number][]} */ ([
          [1, 10],
          [10, 100]
        ])
      }
    ]
    const svg = drawn({ title: 't', x: 'items', y: 'ms', curves })
    // one decade across from 80 to 570, two up from 380 to 56
    for (const place of ['cx="80" cy="380"', 'cx="570" cy="56"', 'cx="570" cy="218"'])
      assert.ok(svg.includes(place), place)
    assert.ok(svg.includes('a &amp; b') && svg.startsWith('<svg ') && svg.endsWith('</svg>\n'))
  })
})
