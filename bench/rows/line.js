'use strict'

/**
 * Cycles of an NX PLC over a virtual serial port whose other end keeps the pace of 38400 bit/s, in a process of its own.
 * Its bytes are never late, and it hears at once: what is above the limit is ours. Limit: the bytes' own time on the wire, the station's turnaround and the gaps that the manual asks for.
 */
const { openNxPlc } = require('../../lib')
const { startFarEnd } = require('../far-end')

const BAUD = 38400
const TURNAROUND = 5
const GAP = 10 // before each query, and before each RR
const ROUNDS = 10

const QUERY = 9
const SHORT = 7 // query accepted; RR
const ANSWER = 6
const ms = bytes => (bytes * 10 * 1000) / BAUD

/** @param {number} words @param {number} steps */
const limitOf = (words, steps) => {
  const answer = ANSWER + 2 * words
  if (steps === 2) return ms(QUERY + answer) + TURNAROUND + GAP
  return ms(QUERY + SHORT + SHORT + answer) + 2 * (TURNAROUND + GAP)
}

const CASES = [
  { item: 'M0..M127', words: 128, cycles: 6, most: 1.02 },
  { item: 'M0..M9', words: 10, cycles: 20, most: 1.08 }
]

const readerOf = (plc, item) => async () => {
  const [result] = await plc.read([item])
  if (result.quality !== 'good') throw new Error(`bad read: ${result.code} ${result.text}`)
}

/** The best of some rounds: what other programs take only adds. */
async function measure(link, steps, { item, cycles }) {
  const plc = openNxPlc({ path: link, baudRate: BAUD, station: 1, steps, latenessBound: 1 })
  const read = readerOf(plc, item)
  try {
    await read()
    const rounds = []
    for (let round = 0; round < ROUNDS; round++) {
      const from = performance.now()
      for (let n = 0; n < cycles; n++) await read()
      rounds.push((performance.now() - from) / cycles)
    }
    return Math.min(...rounds)
  } finally {
    await plc.close()
  }
}

async function* rows() {
  const far = await startFarEnd({ stations: [1], baudRate: BAUD, turnaround: TURNAROUND, quiet: true, precise: true })
  try {
    for (const steps of [2, 4]) {
      for (const each of CASES) {
        const value = await measure(far.link, steps, each)
        const limit = limitOf(each.words, steps)
        const against = `the wire's own ${limit.toFixed(1)} ms`
        const name = `${each.item} at ${BAUD} bit/s, ${steps}-step`
        yield { name, value, unit: 'ms', against, ratio: value / limit, goal: ['<=', each.most] }
      }
    }
  } finally {
    await far.close()
  }
}

module.exports = { rows }
