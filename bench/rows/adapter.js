'use strict'

/** The same as modbus.js behind an adapter that hands over 16 bytes at once: then the peers wake less often. */
const { comparison } = require('../compare')

const CASES = [
  {
    chunk: 16,
    count: 10,
    before: 2500,
    requests: 20,
    rounds: 15,
    most: { 'modbus-serial': 1, jsmodbus: 1, pymodbus: 1 }
  },
  {
    chunk: 16,
    count: 125,
    before: 200,
    requests: 6,
    rounds: 9,
    most: { 'modbus-serial': 0.5, jsmodbus: 0.5, pymodbus: 1 }
  }
]

async function* rows() {
  for (const each of CASES) yield* comparison(each)
}

module.exports = { rows }
