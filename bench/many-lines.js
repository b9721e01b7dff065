'use strict'

/** Many lines in one process, saturated: two stations on each are polled more often than the wire allows. The simulators have processes of their own. */
const { monitorEventLoopDelay } = require('node:perf_hooks')
const v8 = require('node:v8')
const vm = require('node:vm')
const { createNxPlc, createPool } = require('../lib')
const { startFarEnd } = require('./far-end')

const BAUD = 38400
const TURNAROUND = 5
const GAP = 10
const STATIONS = [1, 2]
const ITEM = 'M0..M127'
/** ms; two of them would need 171. */
const INTERVAL = 100
const EXCHANGE = ((9 + 262) * 10000) / BAUD + TURNAROUND + GAP
const SETTLE = 15000 // ms: the trace of each line is full then
const RESOLUTION = 5
const FAR_ENDS = 2
const MB = 1048576

const pause = ms => new Promise(resolve => setTimeout(resolve, ms))

const heap = () => {
  v8.setFlagsFromString('--expose-gc')
  vm.runInNewContext('gc')()
  const { heapUsed, external } = process.memoryUsage()
  return (heapUsed + external) / MB
}

/** Polls all stations of a port. */
const startLine = (pool, link, onCycle) => {
  const line = { transport: 'serial', path: link, baudRate: BAUD, latenessBound: 1 }
  const lease = pool.open(line, { id: link, name: link })
  const plcs = STATIONS.map(station => createNxPlc({ lease, station, timeout: 1000, gap: GAP }))
  for (const plc of plcs) plc.subscribe({ items: [ITEM], interval: INTERVAL }, onCycle)
  return async () => {
    for (const plc of plcs) plc.close()
    await lease.release()
  }
}

/** What the process takes and does in some seconds. */
const observe = async (seconds, counts) => {
  const before = { ...counts, heap: heap() }
  const delay = monitorEventLoopDelay({ resolution: RESOLUTION })
  delay.enable()
  const cpu = process.cpuUsage()
  const from = performance.now()
  await pause(seconds * 1000)
  const ms = performance.now() - from
  const { user, system } = process.cpuUsage(cpu)
  delay.disable()
  if (counts.bad > 0) throw new Error(`${counts.bad} cycles failed: ${counts.why}`)
  return {
    share: (user + system) / 1000 / ms,
    rate: ((counts.good - before.good) * 1000) / ms,
    lag: Math.max(0, delay.percentile(99) / 1e6 - RESOLUTION),
    growth: Math.max(0, heap() - before.heap)
  }
}

/**
 * @param {{ lines?: number, seconds: number }} options lines: default 32
 * @returns {Promise<{ lines: number, share: number, rate: number, possible: number, lag: number, growth: number }>} share: of a core; rate, possible:
 *   exchanges a second, as measured and as the wires allow; lag: of the event loop, p99, ms; growth: MB of memory after a collection
 */
const manyLines = async ({ lines = 32, seconds }) => {
  const settings = {
    stations: STATIONS,
    baudRate: BAUD,
    turnaround: TURNAROUND,
    quiet: true,
    lines: Math.ceil(lines / FAR_ENDS)
  }
  const far = await Promise.all(Array.from({ length: FAR_ENDS }, () => startFarEnd(settings)))
  const counts = { good: 0, bad: 0, why: '' }
  const onCycle = (_results, { failure }) => {
    if (failure) Object.assign(counts, { bad: counts.bad + 1, why: failure.text ?? failure.message })
    else counts.good++
  }
  const pool = createPool()
  const links = far.flatMap(each => each.links).slice(0, lines)
  const stops = links.map(link => startLine(pool, link, onCycle))
  try {
    await pause(SETTLE)
    return { lines: links.length, possible: (links.length * 1000) / EXCHANGE, ...(await observe(seconds, counts)) }
  } finally {
    await Promise.all(stops.map(stop => stop()))
    await Promise.all(far.map(each => each.close()))
  }
}

module.exports = { manyLines }
