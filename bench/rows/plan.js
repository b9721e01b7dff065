'use strict'

/**
 * Line time of a cycle by planner: ours, one request for each item, and blocks that are joined greedily over gaps. Simulated line in virtual time, so
 * that the figures are exact; 38400 bit/s, 5 ms of turnaround, 10 ms of gap, both modes.
 */
const { greedy, onePerItem } = require('../planners')
const { apart, dense, mixed } = require('../samples')
const { cycleOf, predictedOf } = require('../virtual')

const PLANNERS = { 'greedy blocks': greedy, 'one request per item': onePerItem }
const SEEDS = [1, 2, 3]
const RR = ' with RR'

const row = ({ name, value, against, limit, most }) => ({
  name,
  value,
  unit: 'ms',
  against,
  ratio: value / limit,
  goal: ['<=', most]
})

/** Predicted and measured: whichever is larger, by the other. */
const prediction = (name, measured, predicted) =>
  row({
    name: `${name}: measured and predicted`,
    value: Math.max(measured, predicted),
    against: `the ${measured > predicted ? 'predicted' : 'measured'} line time`,
    limit: Math.min(measured, predicted),
    most: 1.03
  })

/** Words that lie apart: each planner once, ours also with the repeat by RR. */
async function* words(steps) {
  const items = apart(200, 10)
  const title = `200 words, one in ten of W, ${steps}-step`
  const goals = { 'greedy blocks': [0.22, 0.18], 'one request per item': [0.12, 0.1] }
  const plain = await cycleOf(items, { steps })
  const repeated = await cycleOf(items, { steps, soleMaster: true })
  for (const [against, planner] of Object.entries(PLANNERS)) {
    const { measured: limit } = await cycleOf(items, { steps, planner })
    const [most, mostRepeated] = goals[against]
    yield row({ name: title, value: plain.measured, against, limit, most })
    yield row({ name: title + RR, value: repeated.measured, against, limit, most: mostRepeated })
  }
  yield prediction(title, plain.measured, predictedOf(items, { steps }))
  yield prediction(title + RR, repeated.measured, predictedOf(items, { steps, soleMaster: true }))
}

/** The worst of some mixes. */
async function* mixes(steps) {
  let worst = { ratio: 0, items: /** @type {string[]} */ ([]), value: 0, limit: 1 }
  for (const seed of SEEDS) {
    const items = mixed(200, seed)
    const { measured: value } = await cycleOf(items, { steps })
    const { measured: limit } = await cycleOf(items, { steps, planner: onePerItem })
    if (value / limit > worst.ratio) worst = { ratio: value / limit, items, value, limit }
  }
  const name = `200 bits and words of M, K and W, ${steps}-step`
  yield row({ name, value: worst.value, against: 'one request per item', limit: worst.limit, most: 0.35 })
  yield prediction(name, worst.value, predictedOf(worst.items, { steps }))
}

async function* neighbours(steps) {
  for (const [what, items] of Object.entries(dense)) {
    const ours = await cycleOf(items, { steps })
    const { measured: limit } = await cycleOf(items, { steps, planner: greedy })
    yield row({ name: `${what}, ${steps}-step`, value: ours.measured, against: 'greedy blocks', limit, most: 1 })
  }
}

async function* rows() {
  for (const steps of [2, 4]) {
    yield* words(steps)
    yield* mixes(steps)
    yield* neighbours(steps)
  }
}

module.exports = { rows }
