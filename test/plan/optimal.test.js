'use strict'

const assert = require('node:assert/strict')
const { createRandom, freshSeed } = require('../../lib/sim')
const { planReads, servedValues } = require('../../lib/plan')
const { lowerBound } = require('./bound')
const { leastCost } = require('./brute')
const { LIMITS } = require('./support')

/** What a plan costs each cycle, from its bytes. */
const costOf = (requests, limits) => {
  const { frameCost, again, scale = 1, unit = 1, bitBytes = 1 } = limits
  const priced = requests.map(({ ask, count, addresses }) => {
    const bits = ask === 'readMixed' ? addresses.filter(({ kind }) => kind === 'bit').length : 0
    const info = {
      readMixed: () => 2 * addresses.length - bits,
      readWords: () => scale * 2 * count,
      readBits: () => scale * Math.ceil(Math.ceil(count / unit) * unit * bitBytes)
    }[ask]()
    const cost = frameCost + (ask === 'readMixed' ? 2 * addresses.length : 3) + info
    return { cost, saved: again === undefined ? 0 : Math.max(0, cost - again - info) }
  })
  const total = priced.reduce((sum, { cost }) => sum + cost, 0)
  if (priced.length === 1) return total - priced[0].saved
  const [first, last] = [priced[0], priced[priced.length - 1]]
  return total - (first.saved + last.saved) / 2
}

/** A station's memory, in which bits and words are the same where the limits say so. */
const word = address => (address * 40503 + 12345) & 0xffff
const held = ({ kind, address }, { joint }) => {
  if (kind === 'word') return word(address)
  const same = joint.some(([from, to]) => from <= address >> 4 && address >> 4 < to)
  return Boolean(same ? (word(address >> 4) >> (address & 15)) & 1 : (address * 2654435761) & 8192)
}

const answerOf = ({ ask, base, count, addresses }, limits) => {
  const kind = ask === 'readBits' ? 'bit' : 'word'
  const all = addresses ?? Array.from({ length: count }, (_, at) => ({ kind, address: base + at }))
  return all.map(place => held(place, limits))
}

const checkValues = (points, requests, limits) => {
  const got = new Map()
  for (const request of requests) {
    const answer = answerOf(request, limits)
    for (const served of request.points) got.set(served.point, servedValues(answer, served))
  }
  points.forEach(({ kind, address, count }, at) => {
    const expected = Array.from({ length: count }, (_, step) => held({ kind, address: address + step }, limits))
    assert.deepEqual(got.get(at), expected)
  })
}

const randomLimits = random => {
  const limits = {
    ...LIMITS,
    readBits: random.pick([4, 20, 255]),
    readWords: random.pick([3, 8, 128]),
    readMixed: random.pick([0, 2, 3, 5, 128]),
    info: random.pick([8, 40, 256]),
    frameCost: random.pick([12, 20, 60, 200]),
    joint: random.pick([
      [],
      [[0, 4096]],
      [
        [0, 6],
        [6, 40]
      ]
    ]),
    bounds: random.pick([[], [2, 7], [16]]),
    bridge: random.chance(0.9)
  }
  if (random.chance(0.3)) {
    const start = random.integer(0, 30)
    limits.holes = [{ kind: random.pick(['bit', 'word']), start, end: start + random.integer(1, 4) }]
  }
  if (random.chance(0.4)) limits.again = Math.round(limits.frameCost * random.pick([0.4, 0.8, 1.05]))
  // registers and coils: no mixed requests, eight bits in a byte, ASCII doubles what it sends
  if (random.chance(0.2)) {
    Object.assign(limits, { readMixed: 0, bitBytes: 1 / 8, unit: random.pick([1, 8]), scale: random.pick([1, 2]) })
    delete limits.again
  }
  return limits
}

const randomPoints = random => {
  const points = new Map()
  const near = random.pick([8, 40, 300])
  for (let n = random.integer(1, 5); n > 0; n--) {
    const kind = random.pick(['bit', 'word'])
    const point = {
      kind,
      address: random.integer(0, kind === 'bit' ? near * 4 : near) + (random.chance(0.03) ? 0x3ff0 : 0),
      // numbers on bits are 16 and more of them; two would be shorter as bits
      count: random.chance(0.2) ? random.integer(kind === 'bit' ? 3 : 2, 6) : 1
    }
    points.set(JSON.stringify(point), point)
  }
  return [...points.values()]
}

const planned = (points, limits) => {
  try {
    return planReads(points, limits)
  } catch (error) {
    assert.equal(/** @type {any} */ (error).code, 'FRAME_TOO_LONG')
    return null
  }
}

const compare = (seed, cases) => {
  const random = createRandom(seed)
  let repeated = 0
  for (let n = 0; n < cases; n++) {
    const points = randomPoints(random)
    const limits = randomLimits(random)
    const least = leastCost(points, limits)
    const requests = planned(points, limits)
    const evidence = `seed ${seed}, case ${n}: ${JSON.stringify({ points, limits, requests })}`
    if (!requests) {
      assert.ok(
        points.some(point => leastCost([point], limits) === Infinity),
        evidence
      )
      continue
    }
    assert.ok(Math.abs(costOf(requests, limits) - least) < 1e-6, `${least} is possible; ${evidence}`)
    checkValues(points, requests, limits)
    if (limits.again !== undefined) repeated++
  }
  assert.ok(repeated > cases / 10)
}

describe('plan of reads: no cheaper one exists', function () {
  this.timeout(30000)

  it('10,000 random cases: as cheap as the best of all ways to share requests', () => compare(41, 10000))

  const seed = freshSeed()
  it(`a fresh seed: ${seed}`, () => compare(seed, 500))
})

/** Distinct single addresses, bits among words in some of them. */
const scattered = (random, count, { near, share }) => {
  const points = new Map()
  while (points.size < count) {
    const kind = random.chance(share) ? 'bit' : 'word'
    const address = random.integer(0, kind === 'bit' ? near * 4 - 1 : near - 1)
    points.set(kind + address, { kind, address, count: 1 })
  }
  return [...points.values()]
}

const farFrom = (random, { least, most }) => {
  const near = least < 1500 ? random.pick([600, 2000, 4096]) : 4096
  const share = random.pick([0, 0.3, 0.8])
  const points = scattered(random, random.integer(least, Math.min(most, near * 0.8)), { near, share })
  const limits = { ...LIMITS, frameCost: random.pick([32, 69, 140]), joint: random.pick([[], [[0, 4096]]]) }
  if (random.chance(0.4)) Object.assign(limits, { again: Math.round(limits.frameCost * random.pick([0.5, 0.9])) })
  return { ratio: costOf(planReads(points, limits), limits) / lowerBound(points, limits), limits, size: points.length }
}

describe('plan of many reads', function () {
  this.timeout(30000)

  it('costs at most 2 % more than what no plan can go below, from 1500 items on; a few requests leave a gap to that bound', () => {
    const random = createRandom(42)
    for (let n = 0; n < 6; n++) {
      const { ratio, ...which } = farFrom(random, { least: n % 2 ? 250 : 1500, most: 3000 })
      const most = which.size >= 1500 ? 1.02 : 1.1
      assert.ok(ratio > 0.999 && ratio <= most, `case ${n}: ${ratio} ${JSON.stringify(which)}`)
    }
  })
})
