'use strict'

/** Reads of registers at 9600 bit/s by our device and by other libraries; the bytes arrive one by one, as from a UART that reports each. */
const { comparison } = require('../compare')

const CASES = [
  {
    chunk: 1,
    count: 10,
    before: 2500,
    requests: 20,
    rounds: 15,
    most: { 'modbus-serial': 0.35, jsmodbus: 0.35, pymodbus: 1 }
  },
  {
    chunk: 1,
    count: 125,
    before: 200,
    requests: 6,
    rounds: 9,
    most: { 'modbus-serial': 0.1, jsmodbus: 0.1, pymodbus: 1 }
  }
]

async function* rows() {
  for (const each of CASES) yield* comparison(each)
}

module.exports = { rows }
