'use strict'

/** 32 lines in one process, each polled without a pause; what the process takes of a core, and how late its event loop is. */
const { manyLines } = require('../many-lines')

const SECONDS = 20
const MOST_LAG = 10 // ms
const MOST_GROWTH = 1 // MB after a collection

async function* rows() {
  const { lines, share, rate, possible, lag, growth } = await manyLines({ seconds: SECONDS })
  const name = `${lines} saturated lines of 38400 bit/s, M0..M127`
  yield {
    name: `${name}: exchanges`,
    value: rate,
    unit: '1/s',
    against: 'what the wires allow',
    ratio: rate / possible,
    goal: ['>=', 0.95]
  }
  yield {
    name: `${name}: processor`,
    value: share,
    unit: 'cores',
    against: 'one core',
    ratio: share,
    goal: ['<=', 0.6]
  }
  yield {
    name: `${name}: event-loop lag p99`,
    value: lag,
    unit: 'ms',
    against: `${MOST_LAG} ms`,
    ratio: lag / MOST_LAG,
    goal: ['<=', 1]
  }
  yield {
    name: `${name}: memory in ${SECONDS} s`,
    value: growth,
    unit: 'MB',
    against: `${MOST_GROWTH} MB`,
    ratio: growth / MOST_GROWTH,
    goal: ['<=', 1]
  }
}

module.exports = { rows }
