'use strict'

/** Line time by number of items and by planner, in virtual time; draws docs/speed.svg. */
const { writeFileSync } = require('node:fs')
const path = require('node:path')
const { greedy, onePerItem } = require('../planners')
const { drawn } = require('../plot')
const { scattered } = require('../samples')
const { cycleOf } = require('../virtual')

const FILE = path.join(__dirname, '..', '..', 'docs', 'speed.svg')
const COUNTS = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000]

const WAYS = [
  { name: 'one request per item', color: '#b3432b', options: { planner: onePerItem } },
  { name: 'greedy blocks', color: '#b07d12', options: { planner: greedy } },
  { name: 'our plan', color: '#1f6fb2', options: {} },
  { name: 'our plan, with RR', color: '#2b7a4b', options: { soleMaster: true } }
]

/** @param {number[]} counts @returns {Promise<import('../plot').Curve[]>} */
const curvesOf = counts =>
  Promise.all(
    WAYS.map(async ({ name, color, options }) => {
      const points = /** @type {[number, number][]} */ ([])
      for (const count of counts) points.push([count, (await cycleOf(scattered(count), options)).measured])
      return { name, color, points }
    })
  )

async function* rows() {
  const curves = await curvesOf(COUNTS)
  const title = 'Line time of a cycle by planner: words of W, 38400 bit/s, 2-step'
  writeFileSync(FILE, drawn({ title, x: 'items in a cycle', y: 'ms of line time', curves }))
  const [one, blocks, ours] = curves.map(({ points }) => points)
  for (const [at, [count, value]] of ours.entries()) {
    const name = `${count} words of W by chance`
    const row = { name, value, unit: 'ms', goal: /** @type {['<=', number]} */ (['<=', 1]) }
    yield { ...row, against: 'greedy blocks', ratio: value / blocks[at][1] }
    yield { ...row, against: 'one request per item', ratio: value / one[at][1] }
  }
}

module.exports = { curvesOf, rows }
