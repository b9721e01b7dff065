'use strict'

/** Processor time of planning 10,000 items, and what their plan costs beside a bound that no plan can go below. */
const { createRandom } = require('../../lib/sim')
const { limitsOf } = require('../../lib/codec/nx/limits')
const { planReads } = require('../../lib/plan')
const { lowerBound } = require('../../test/plan/bound')

const MOST = 50 // ms
const ROUNDS = 9
const ITEMS = 10000
const FRAME_COST = 69.6 // byte times at 38400 bit/s, 2-step
const AGAIN = 70.6

/** Distinct bits and words by chance. @param {{ count: number, words: number, bits: number, share: number, seed?: number }} given share: of bits */
const points = ({ count, words, bits, share, seed = 1 }) => {
  const random = createRandom(seed)
  const chosen = new Map()
  while (chosen.size < count) {
    const kind = random.chance(share) ? 'bit' : 'word'
    const address = random.integer(0, (kind === 'bit' ? bits : words) - 1)
    chosen.set(kind + address, { kind, address, count: 1 })
  }
  return [...chosen.values()]
}

const limits = more => ({ ...limitsOf(), frameCost: FRAME_COST, ...more })

const both = { words: 4096, bits: 16384, share: 0.7 }
const joint = [[0, 4096]]
const CASES = [
  { name: 'words, one in six of 60,000', given: { words: 60000, bits: 0, share: 0 }, own: limits() },
  { name: 'words, most of 12,000', given: { words: 12000, bits: 0, share: 0 }, own: limits() },
  { name: 'bits and words', given: both, own: limits({ joint }) },
  { name: 'bits and words, with RR', given: both, own: limits({ joint, again: AGAIN }) }
]

const processorTime = work => {
  const before = process.cpuUsage()
  work()
  const { user, system } = process.cpuUsage(before)
  return (user + system) / 1000
}

async function* rows() {
  for (const { name, given, own } of CASES) {
    const list = points({ count: ITEMS, ...given })
    const value = Math.min(...Array.from({ length: ROUNDS }, () => processorTime(() => planReads(list, own))))
    const ratio = value / MOST
    yield { name: `planning ${ITEMS} items: ${name}`, value, unit: 'ms', against: `${MOST} ms`, ratio, goal: ['<=', 1] }
  }
  const list = points({ count: 3000, ...both, share: 0.3, seed: 5 })
  const own = limits({ joint })
  const value = planReads(list, own).reduce((sum, { cost }) => sum + cost, 0)
  const ratio = value / lowerBound(list, own)
  const against = 'a cost that no plan can go below'
  yield { name: 'plan of 3000 bits and words', value, unit: 'byte times', against, ratio, goal: ['<=', 1.02] }
}

module.exports = { rows }
