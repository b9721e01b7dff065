'use strict'

/**
 * M0..M127 over a virtual serial port whose other end keeps the pace of 38400 bit/s, in a process of its own.
 * Limit: the bytes' own time on the wire, the station's turnaround and the gaps that the manual asks for.
 */
const { openNxPlc } = require('../../lib')
const { startFarEnd } = require('../far-end')

const BAUD = 38400
const TURNAROUND = 5
const CYCLES = 40
const GAP_BEFORE_QUERY = 10
const GAP_BEFORE_RR = 10
const MOST = 1.05

const QUERY = 9
const SHORT = 7
const ANSWER = 262
const ms = bytes => (bytes * 10 * 1000) / BAUD

const LIMITS = {
  2: ms(QUERY + ANSWER) + TURNAROUND + GAP_BEFORE_QUERY,
  4: ms(QUERY + SHORT + SHORT + ANSWER) + 2 * TURNAROUND + GAP_BEFORE_QUERY + GAP_BEFORE_RR
}

async function cycle(plc) {
  const [result] = await plc.read(['M0..M127'])
  if (result.quality !== 'good') throw new Error(`bad read: ${result.code} ${result.text}`)
}

async function measure(link, steps) {
  const plc = openNxPlc({ path: link, baudRate: BAUD, station: 1, steps })
  try {
    await cycle(plc)
    const from = performance.now()
    for (let i = 0; i < CYCLES; i++) await cycle(plc)
    return (performance.now() - from) / CYCLES
  } finally {
    await plc.close()
  }
}

async function* rows() {
  const far = await startFarEnd({ stations: [1], baudRate: BAUD, turnaround: TURNAROUND })
  try {
    for (const steps of [2, 4]) {
      const value = await measure(far.link, steps)
      const limit = LIMITS[steps]
      const against = `the wire's own ${limit.toFixed(1)} ms`
      const name = `M0..M127 at ${BAUD} bit/s, ${steps}-step`
      yield { name, value, unit: 'ms', against, ratio: value / limit, goal: ['<=', MOST] }
    }
  } finally {
    await far.close()
  }
}

module.exports = { rows }
