'use strict'

/** A line over TCP whose connection goes in every way there is. Run by test/system and by `npm run endurance -- halfopen`. */

const { createPool, openNxPlc } = require('../../lib')
const { createLine, serveOnTcp } = require('../../lib/sim')
const { until } = require('./node-red.js')
const { createTcpProxy } = require('./tcp-proxy.js')
const { startVersions } = require('./versions.js')

const BAUD = 38400
const BACK = 2000
const wait = ms => new Promise(resolve => setTimeout(resolve, ms))

/**
 * What is done to the connection; `cut` begins it, `mend` ends it after `ms`.
 * @type {Record<string, { ms: number, cut: (plant: any) => any, mend?: (plant: any) => any }>}
 */
const WAYS = {
  // a firewall that has forgotten the connection: nobody is told
  halfOpen: { ms: 0, cut: ({ proxy }) => proxy.halfOpen() },
  // a serial server whose program hangs, and that works again before anybody has given up
  deaf: {
    ms: 1000,
    cut: ({ proxy }) => proxy.deaf(true),
    mend: ({ proxy }) => proxy.deaf(false)
  },
  drop: { ms: 0, cut: ({ proxy }) => proxy.drop() },
  restart: { ms: 1500, cut: ({ proxy }) => proxy.stop(), mend: ({ proxy }) => proxy.start() }
}

/**
 * @param {{ rounds: number, timeout?: number, attempts?: number, ways?: string[], tell?: (text: string) => void }} options
 * @returns {Promise<Record<string, { rounds: number, noticed: number, back: number, limit: number, wrong: number }>>} by way: noticed: longest time
 *   (ms) from the cut to the next connection, where the cut itself does not tell; back: longest from where it can work again to the first good value;
 *   limit: what `noticed` may be, 2 × timeout × attempts
 */
async function halfOpen({ rounds, timeout = 1000, attempts = 3, ways = Object.keys(WAYS), tell = _text => {} }) {
  const { wire, stations } = createLine({ stations: [2], baudRate: BAUD, quiet: true, turnaround: 2 })
  const held = startVersions([{ memory: stations[0], number: 2, first: 'M' }], { every: 50, most: 1000 })
  const server = await serveOnTcp({ wire })
  const proxy = await createTcpProxy(server.port)
  const line = { host: '127.0.0.1', port: proxy.port, baudRate: BAUD, pool: createPool() }
  const plc = openNxPlc({ ...line, station: 2, timeout, attempts })
  const seen = { last: -Infinity, wrong: 0 }
  plc.subscribe({ items: ['M0..M9'], interval: 50 }, ([{ value, quality }], { ms }) => {
    const now = performance.now()
    if (quality !== 'good') return
    if (!held.isHeld(0, value, now - ms - 1, now)) seen.wrong++
    seen.last = now
  })
  const good = from => until(() => seen.last > from, { what: 'a value', every: 2, patience: 120000 })
  const once = async ({ ms, cut, mend }) => {
    await good(performance.now())
    const { accepted } = proxy.counts
    const start = performance.now()
    await cut({ proxy })
    const again = until(() => proxy.counts.accepted > accepted, { what: 'a connection', every: 2, patience: 60000 })
    await wait(ms)
    await mend?.({ proxy })
    const mended = performance.now()
    await again
    const connected = performance.now()
    await good(connected)
    return { noticed: connected - start, back: performance.now() - Math.max(mended, connected) }
  }
  const results = {}
  try {
    for (const way of ways) {
      const result = { rounds: 0, noticed: 0, back: 0, limit: 2 * timeout * attempts, wrong: 0 }
      for (let round = 0; round < rounds; round++) {
        const { noticed, back } = await once(WAYS[way])
        result.rounds++
        result.noticed = Math.max(result.noticed, Math.round(noticed))
        result.back = Math.max(result.back, Math.round(back))
      }
      result.wrong = seen.wrong
      results[way] = result
      tell(`${way}: ${JSON.stringify(result)}`)
    }
    return results
  } finally {
    await plc.close()
    held.stop()
    await proxy.stop()
    await server.close()
  }
}

/** What is too slow or wrong. @param {Awaited<ReturnType<typeof halfOpen>>} results @param {number} bound of lateness, ms */
const slowOf = (results, bound) =>
  Object.entries(results)
    .filter(([, { noticed, back, limit, wrong }]) => noticed > limit || back > BACK + bound || wrong > 0)
    .map(([way, result]) => `${way}: ${JSON.stringify(result)}`)

module.exports = { halfOpen, slowOf }
