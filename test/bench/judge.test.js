'use strict'

const assert = require('node:assert/strict')
const { spawnSync } = require('node:child_process')
const path = require('node:path')
const { judge, lineOf } = require('../../bench/judge')
const { median, percentile } = require('../../bench/measure')
const { chosen, known, run } = require('../../bench/run')
const { read } = require('../support/source.js')

const measured = more => ({ name: 'a', value: 3, unit: 'ms', against: 'b', ratio: 0.5, goal: ['<=', 1], ...more })

describe('bench: verdicts', () => {
  it('a row has what it was measured against, its goal, and whether that holds', () => {
    assert.deepEqual(judge(measured()), {
      name: 'a',
      value: 3,
      unit: 'ms',
      against: 'b',
      ratio: 0.5,
      goal: '<= 1',
      holds: true
    })
  })

  it('a goal that is missed does not hold; nor does what is no number', () => {
    const holds = (ratio, goal) => judge(measured({ ratio, goal })).holds
    assert.equal(holds(1.01, ['<=', 1]), false)
    assert.equal(holds(1, ['<=', 1]), true)
    assert.equal(holds(0.99, ['>=', 1]), false)
    assert.equal(holds(1, ['>=', 1]), true)
    assert.equal(holds(NaN, ['<=', 1]), false)
    assert.equal(holds(NaN, ['>=', 1]), false)
    assert.equal(holds(Infinity, ['<=', 1]), false)
  })

  it('is about the figure that is shown', () => {
    const row = judge(measured({ ratio: 1.00004, value: 12.34567 }))
    assert.deepEqual([row.ratio, row.value, row.holds], [1, 12.35, true])
    assert.equal(judge(measured({ ratio: 1.0006 })).holds, false)
  })

  it('is a line for people', () => {
    assert.equal(lineOf(judge(measured())), 'ok   a: 3 ms, 0.5 x b (goal <= 1)')
    assert.match(lineOf(judge(measured({ ratio: 2 }))), /^MISS a/)
  })
})

describe('bench: a run', () => {
  async function* rows() {
    yield measured()
    yield measured({ name: 'c', ratio: 7 })
  }

  const printed = async json => {
    const lines = /** @type {string[]} */ ([])
    const missed = await run(['any'], { json, print: line => lines.push(line), load: () => ({ rows }) })
    return { missed, lines }
  }

  it('--json: one object a line, with these members', async () => {
    const { missed, lines } = await printed(true)
    assert.equal(missed, 1)
    const objects = lines.map(line => JSON.parse(line))
    assert.deepEqual(
      objects.map(({ name, holds }) => [name, holds]),
      [
        ['a', true],
        ['c', false]
      ]
    )
    for (const each of objects)
      assert.deepEqual(Object.keys(each), ['name', 'value', 'unit', 'against', 'ratio', 'goal', 'holds'])
  })

  it('without it: a line for each', async () => {
    const { lines } = await printed(false)
    assert.deepEqual(
      lines.map(line => line.slice(0, 6)),
      ['ok   a', 'MISS c']
    )
  })

  it('names choose files of rows; one that is not there is an error with those that are', () => {
    assert.deepEqual(chosen(['plan']), ['plan'])
    assert.deepEqual(chosen([]), known())
    const script = path.join(__dirname, '..', '..', 'bench', 'run.js')
    const { status, stderr } = spawnSync(process.execPath, [script, 'nonsense'], { encoding: 'utf8' })
    assert.equal(status, 2)
    for (const name of known()) assert.ok(stderr.includes(name), name)
  })

  it('each is explained in docs/speed.md, which has the plot', () => {
    const page = read('docs/speed.md')
    for (const name of known()) assert.ok(page.includes(`\n## \`${name}\``), name)
    assert.ok(page.includes('](speed.svg)'))
  })
})

describe('bench: figures of lists', () => {
  it('median and percentile', () => {
    assert.equal(median([5, 1, 3]), 3)
    const hundred = Array.from({ length: 100 }, (_, n) => 100 - n)
    assert.equal(percentile(hundred, 0.99), 99)
    assert.equal(percentile(hundred, 1), 100)
    assert.equal(percentile([7], 0.5), 7)
  })
})
