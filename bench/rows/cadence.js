'use strict'

/**
 * When the queries of a subscription leave. Jitter: how late against their grid, on an idle line, beside a bare timer of the same process. Drift: what
 * an hour in virtual time adds up to, on a machine whose timers are late by chance.
 */
const { createNxPlc, createPool } = require('../../lib')
const { serial } = require('../../lib/line/transports/serial')
const { simulated } = require('../../lib/line/transports/memory')
const { createNxLine, createRandom, createVirtualClock } = require('../../lib/sim')
const { startFarEnd } = require('../far-end')
const { percentile } = require('../measure')

const BAUD = 38400
const INTERVAL = 100
const CYCLES = 250
const ALLOWED = 2 // ms above a bare timer's
const HOUR = 3600000
const LATE = 3 // ms that a timer of the simulated machine may be late
const SECOND = 1000

/** A transport that tells when each frame is handed over. */
const watched = (factory, now, sent) => (settings, clock) => {
  const transport = factory(settings, clock)
  const write = transport.write.bind(transport)
  transport.write = (bytes, done) => {
    sent.push(now())
    return write(bytes, done)
  }
  return transport
}

/** How late each was, against the grid on which the earliest lies. */
const lateness = (times, interval) => {
  const [first] = times
  const late = times.map(time => time - first - Math.round((time - first) / interval) * interval)
  const earliest = Math.min(...late)
  return late.map(each => each - earliest)
}

/** A timer that aims at its grid, and nothing else. */
const bareTimer = interval => {
  const fired = []
  let due = performance.now() + interval / 2
  let timer = /** @type {any} */ (null)
  const arm = () => {
    timer = setTimeout(
      () => {
        fired.push(performance.now())
        due += interval
        arm()
      },
      Math.max(0, due - performance.now())
    )
  }
  arm()
  return { fired, stop: () => clearTimeout(timer) }
}

const jitter = async () => {
  const far = await startFarEnd({ stations: [1], baudRate: BAUD, turnaround: 5, quiet: true })
  const sent = []
  const now = () => performance.now()
  const pool = createPool({ transports: { serial: watched(serial, now, sent) } })
  const line = { transport: 'serial', path: far.link, baudRate: BAUD, latenessBound: 1 }
  const lease = pool.open(line, { id: 'bench', name: 'bench' })
  const plc = createNxPlc({ lease, station: 1 })
  const timer = bareTimer(INTERVAL)
  try {
    await new Promise(resolve => {
      plc.subscribe({ items: ['M0'], interval: INTERVAL }, () => sent.length > CYCLES && resolve(undefined))
    })
    const p99 = times => percentile(lateness(times.slice(10), INTERVAL), 0.99)
    return { ours: p99(sent), bare: p99(timer.fired) }
  } finally {
    timer.stop()
    plc.close()
    await lease.release()
    await far.close()
  }
}

/** @returns {Promise<number>} ms between the grid of the first cycles and that of the last */
const drift = async () => {
  const virtual = createVirtualClock()
  const random = createRandom(3)
  const setTimer = (fn, ms, options) => virtual.setTimer(fn, ms + random.next() * LATE, options)
  const clock = { ...virtual, setTimer }
  const sent = []
  const { wire } = createNxLine({ clock: virtual, baudRate: BAUD, turnaround: 5, quiet: true, stations: [1] })
  const pool = createPool({ clock, transports: { simulated: watched(simulated, virtual.now, sent) } })
  const line = { transport: 'simulated', path: 'bench', wire, baudRate: BAUD, echo: 'off' }
  const lease = pool.open(line, { id: 'bench', name: 'bench' })
  const plc = createNxPlc({ lease, clock, station: 1, timeout: 500 })
  plc.subscribe({ items: ['M0'], interval: SECOND }, () => {})
  await virtual.advance(HOUR)
  plc.close()
  await virtual.run(lease.release())
  const late = lateness(sent.slice(1), SECOND)
  const earliest = list => Math.min(...list)
  return Math.abs(earliest(late.slice(-200)) - earliest(late.slice(0, 200)))
}

async function* rows() {
  const { ours, bare } = await jitter()
  const limit = bare + ALLOWED
  const against = `a bare timer's ${bare.toFixed(2)} ms + ${ALLOWED} ms`
  const name = `jitter of a subscription on an idle line, p99, every ${INTERVAL} ms`
  yield { name, value: ours, unit: 'ms', against, ratio: ours / limit, goal: ['<=', 1] }
  const value = await drift()
  // both ends of the hour are known to a fraction of what timers are late
  const share = value / LATE
  const late = `timers that are up to ${LATE} ms late`
  yield { name: 'drift in an hour', value, unit: 'ms', against: late, ratio: share, goal: ['<=', 0.05] }
}

module.exports = { rows }
