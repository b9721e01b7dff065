'use strict'

const assert = require('node:assert/strict')
const { Stats } = require('../../lib/line/stats')
const { Waits } = require('../../lib/line/waits')

const filled = (...rows) => {
  const waits = new Waits()
  for (const ms of rows) waits.add(ms)
  return waits
}
const span = (from, last) => Array.from({ length: last - from + 1 }, (_, n) => from + n)

describe('line: how long a station took lately', () => {
  it('is what 99 of 100 answers did not exceed', () => {
    assert.deepEqual([filled().p99, filled().size], [null, 0])
    assert.equal(filled(7).p99, 7)
    assert.equal(filled(9, 100, 11).p99, 100, 'as numbers, not as texts')
    assert.equal(filled(...span(1, 99)).p99, 99)
    assert.equal(filled(...span(1, 100)).p99, 99)
    assert.equal(filled(...span(1, 101)).p99, 100)
    assert.equal(filled(...span(1, 200)).p99, 198)
  })

  it('knows the last 200', () => {
    const waits = filled(...span(1000, 1199), ...span(1, 199))
    assert.deepEqual([waits.size, waits.p99], [200, 198])
    waits.add(200)
    assert.deepEqual([waits.size, waits.p99], [200, 198])
    assert.equal(filled(...span(1, 200), ...new Array(200).fill(5)).p99, 5)
  })

  it('on the average, of the last 200', () => {
    assert.equal(filled().mean, null)
    assert.equal(filled(7).mean, 7)
    assert.equal(filled(10, 20, 60).mean, 30)
    assert.equal(filled(...span(1000, 1199), ...span(1, 200)).mean, 100.5)
  })

  it('is kept in the memory of the station; of one that has none nothing is known', () => {
    const stats = new Stats()
    stats.waited(1, 50)
    stats.answered(1, 60)
    assert.deepEqual(stats.snapshot().stations[1].latency, { min: 60, mean: 60, max: 60, p99: null })
    const memory = /** @type {any} */ ({})
    stats.remember(new Map([[1, memory]]))
    for (const ms of [10, 50]) stats.waited(1, ms)
    stats.answered(1, 20)
    assert.deepEqual(stats.snapshot().stations[1].latency, { min: 20, mean: 40, max: 60, p99: 50 })
    assert.equal(memory.waits.size, 2)
    assert.deepEqual([stats.snapshot().stations[1].health, stats.snapshot().stations[1].since], ['online', null])
    memory.health = { state: 'demoted', since: 7 }
    assert.deepEqual([stats.snapshot().stations[1].health, stats.snapshot().stations[1].since], ['demoted', 7])
  })
})
