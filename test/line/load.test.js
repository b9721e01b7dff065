'use strict'

const assert = require('node:assert/strict')
const { totalLoad } = require('../../lib/line/load')

const who = { id: 'reader' }
const load = (percent, busyPercent, ...asked) => {
  const rows = asked.map(([name, own]) => ({ name, percent: own, owner: who }))
  return () => ({ percent, busyPercent, asked: rows })
}
const of = (...loads) => totalLoad(new Set(loads))

describe('line: what those who poll expect to take of its time', () => {
  it('nothing where nobody does', () => {
    assert.deepEqual(of(), { percent: 0, busyPercent: 0, most: null })
    assert.deepEqual(of(load(0, 0)), { percent: 0, busyPercent: 0, most: null })
  })

  it('is the sum, in tenths of a percent', () => {
    const { percent, busyPercent } = of(load(10.04, 5.02), load(20.02, 3.04))
    assert.deepEqual([percent, busyPercent], [30.1, 8.1])
    assert.equal(of(load(250, 180)).percent, 250, 'more than there is')
  })

  it('who asks for most, by itself; of equals the first', () => {
    const pump = load(30, 20, ['pump', 10], ['valve', 20])
    assert.deepEqual(of(pump, load(15, 9, ['oven', 15])).most, { name: 'valve', percent: 20, owner: who })
    assert.equal(of(load(15, 9, ['oven', 15]), pump).most?.name, 'valve')
    assert.equal(of(pump, load(20, 9, ['oven', 20])).most?.name, 'valve')
  })
})
