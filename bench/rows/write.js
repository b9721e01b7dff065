'use strict'

/**
 * How long a write takes while the line is polled without a pause: at most the exchange in flight and its own. On a virtual serial port that keeps
 * the pace of 38400 bit/s, and, with more of them, in virtual time.
 */
const { createNxPlc, createPool } = require('../../lib')
const { encodeAnswer } = require('../../lib/codec/nx/answer')
const { encodeQuery } = require('../../lib/codec/nx/query')
const { PRIORITY } = require('../../lib')
const { createNxLine, createRandom, createVirtualClock } = require('../../lib/sim')
const { startFarEnd } = require('../far-end')
const { percentile } = require('../measure')

const BAUD = 38400
const TURNAROUND = 5
const GAP = 10
const STATIONS = [1, 2]
const SLACK = 10 // ms that the goal leaves to timers and program
const MOST_PAUSE = 200

const wireTime = query => {
  const ends = { station: 1, master: 0xe2, steps: 2 }
  const answer = query.ask === 'writeWords' ? true : new Array(query.count).fill(0)
  const bytes = encodeQuery(query, ends).length + encodeAnswer(query, answer, ends).length
  return (bytes * 10000) / BAUD + TURNAROUND + GAP
}
const LONGEST = wireTime({ ask: 'readWords', base: 0x0c0, count: 128 })
const OWN = wireTime({ ask: 'writeWords', base: 0x140, values: [1] })
const LIMIT = LONGEST + OWN + SLACK

/**
 * @param {any} pool @param {any} line
 * @param {{ clock: { now: () => number }, pause: (ms: number) => Promise<any>, writes: number }} options
 * @returns {Promise<number[]>} ms that each write took
 */
const latencies = async (pool, line, { clock, pause, writes }) => {
  const random = createRandom(7)
  const own = { ...(clock.setTimer ? { clock } : {}), access: 'write', timeout: 1000 }
  const lease = pool.open({ echo: 'off', baudRate: BAUD, latenessBound: 1, ...line }, { id: 'bench', name: 'bench' })
  const [first, ...others] = STATIONS.map(station => createNxPlc({ lease, station, ...own }))
  let open = true
  // as many readers as keep the queue from ever being empty
  const poll = async plc => {
    while (open) await plc.read(['M0..M127'], { priority: PRIORITY.POLL })
  }
  const polls = [first, ...others].map(poll)
  const taken = []
  try {
    await pause(500)
    for (let n = 0; n < writes; n++) {
      await pause(random.next() * MOST_PAUSE)
      const from = clock.now()
      const { outcome, code } = await first.write([{ item: 'K0', value: n & 0xff }], { fixed: true })
      if (outcome !== 'confirmed') throw new Error(`the write was ${outcome}: ${code}`)
      taken.push(clock.now() - from)
    }
  } finally {
    open = false
    await Promise.all(polls)
    for (const plc of [first, ...others]) plc.close()
    await lease.release()
  }
  return taken
}

const real = async writes => {
  const far = await startFarEnd({ stations: STATIONS, baudRate: BAUD, turnaround: TURNAROUND, quiet: true })
  const pause = ms => new Promise(resolve => setTimeout(resolve, ms))
  try {
    const line = { transport: 'serial', path: far.link }
    return await latencies(createPool(), line, { clock: performance, pause, writes })
  } finally {
    await far.close()
  }
}

const virtual = writes => {
  const clock = createVirtualClock()
  const { wire } = createNxLine({ clock, baudRate: BAUD, turnaround: TURNAROUND, quiet: true, stations: STATIONS })
  const pause = ms => new Promise(resolve => clock.setTimer(() => resolve(undefined), ms))
  const line = { transport: 'simulated', path: 'bench', wire }
  return clock.run(latencies(createPool({ clock }), line, { clock, pause, writes }))
}

async function* rows() {
  const against = `longest exchange + own + ${SLACK} ms: ${LIMIT.toFixed(1)} ms`
  for (const [where, taken] of [
    ['in virtual time', await virtual(2000)],
    ['on a real port', await real(150)]
  ]) {
    const value = percentile(taken, 0.99)
    const name = `a write under saturated polling, p99, ${where}`
    yield { name, value, unit: 'ms', against, ratio: value / LIMIT, goal: ['<=', 1] }
  }
}

module.exports = { rows }
