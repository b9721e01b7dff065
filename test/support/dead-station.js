'use strict'

/**
 * Ten stations on one paced line, of which one dies and comes back, on a real (virtual) serial port: what it costs the others. Run by test/system and
 * by `npm run endurance -- dead`.
 */

const fs = require('node:fs')
const os = require('node:os')
const path = require('node:path')
const { createPool, openChinoRegulator, openNxPlc } = require('../../lib')
const { createLine, serveOnPty } = require('../../lib/sim')
const { until } = require('./node-red.js')
const { startVersions } = require('./versions.js')

const BAUD = 38400
const COUNT = 10
const KINDS = {
  nx: { first: 'M', block: 'M0..M9', open: openNxPlc },
  chino: { first: 'hr', block: 'hr0..hr9', open: openChinoRegulator }
}
const wait = ms => new Promise(resolve => setTimeout(resolve, ms))

/** How long the line was busy with each station: on a line that is never idle, from one query to the next. */
function watchTime(pool, link) {
  const queries = []
  const frame = ({ dir, station }) => void (dir === 'out' && queries.push({ station, at: performance.now() }))
  const stop = pool.watch({ path: link, baudRate: BAUD }, { frame })
  const spent = (station, from, to) => {
    const all = queries.map((query, n) => ({ ...query, ms: (queries[n + 1]?.at ?? to) - query.at }))
    const own = all.filter(query => query.station === station && query.at >= from && query.at < to)
    const longest = Math.round(Math.max(0, ...own.map(({ ms }) => ms)))
    return { requests: own.length, longest, share: own.reduce((sum, { ms }) => sum + ms, 0) / (to - from) }
  }
  return Object.assign(spent, { stop })
}

/**
 * @param {{ seconds: number, device?: 'nx'|'chino', timeout?: number, answersFirst?: boolean, more?: any, tell?: (text: string) => void }} options seconds: that the
 *   station is dead; answersFirst: it has answered before it dies (default), so that its p99 is known; more: further settings of the stations
 * @returns {Promise<{ before: number, dead: number, after: number, cost: number, later: number, probes: number, longest: number, demoted: number, events: string[],
 *   back: number, wrong: number }>} values per second of the nine others before, while it is dead, after; cost: share of the line's time that was spent
 *   on the dead station, later: the same once it was demoted; probes: so many of them, longest: the longest, ms; demoted: ms from its death until it was demoted; back: ms from its
 *   return to its first good value
 */
async function deadStation({
  seconds,
  device = 'nx',
  timeout = 500,
  answersFirst = true,
  more = {},
  tell = _text => {}
}) {
  const { first, block, open } = KINDS[device]
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'dead-'))
  const link = path.join(folder, 'line')
  const numbers = Array.from({ length: COUNT }, (_, n) => n + 1)
  const { wire, stations } = createLine({ device, stations: numbers, baudRate: BAUD, quiet: true, turnaround: 2 })
  const held = startVersions(
    numbers.map((number, n) => ({ memory: stations[n], number, first })),
    { every: 100, most: 600 }
  )
  const port = serveOnPty({ wire, link })
  const pool = createPool()
  const devices = numbers.map(station => open({ pool, path: link, baudRate: BAUD, station, timeout, ...more }))
  const { line } = devices[0]
  const events = []
  line.on('event', ({ event, station }) => events.push({ event, station, at: performance.now() }))
  const seen = { values: 0, wrong: 0, lastOfDead: -Infinity }
  const dead = COUNT
  const spent = watchTime(pool, link)
  if (!answersFirst) wire.setOff(dead, true)
  let running = true
  // the nine ask as fast as the line allows: what the tenth takes, they do not get
  const asking = devices.slice(0, -1).map(async (each, n) => {
    while (running) {
      const from = performance.now()
      const [{ value, quality }] = await each.read([block])
      if (quality !== 'good') continue
      if (!held.isHeld(n, value, from, performance.now())) seen.wrong++
      seen.values++
    }
  })
  const rate = async ms => {
    const [from, count] = [performance.now(), seen.values]
    await wait(ms)
    return ((seen.values - count) * 1000) / (performance.now() - from)
  }
  const poll = () =>
    devices[COUNT - 1].subscribe({ items: [block], interval: 500 }, ([{ quality }]) => {
      if (quality === 'good') seen.lastOfDead = performance.now()
    })
  try {
    await wait(1200 + timeout)
    const subscription = poll()
    if (answersFirst) await until(() => seen.lastOfDead > 0, { what: 'the tenth station' })
    // the same load as later: the tenth is polled
    const before = await rate(Math.min(5000, seconds * 500))
    tell(`before: ${before.toFixed(1)} values a second`)
    const died = performance.now()
    wire.setOff(dead, true)
    const during = await rate(seconds * 1000)
    const ended = performance.now()
    const demoted = events.find(({ event, station }) => event === 'stationDemoted' && station === dead)
    tell(`dead: ${during.toFixed(1)} values a second`)
    wire.setOff(dead, false)
    const returned = performance.now()
    await until(() => seen.lastOfDead > returned, { what: 'the tenth station again', patience: 90000 })
    const back = performance.now() - returned
    const after = await rate(1000)
    subscription.stop()
    return {
      ...{ before, dead: during, after, wrong: seen.wrong },
      ...{ cost: spent(dead, died, ended).share, later: spent(dead, demoted?.at, ended).share },
      probes: spent(dead, demoted?.at, ended).requests,
      longest: spent(dead, demoted?.at, ended).longest,
      demoted: demoted ? Math.round(demoted.at - died) : NaN,
      back: Math.round(back),
      events: events.map(({ event, station }) => `${event} ${station}`)
    }
  } finally {
    running = false
    spent.stop()
    await Promise.all(devices.map(each => each.close()))
    await Promise.all(asking)
    held.stop()
    port.close()
    fs.rmSync(folder, { recursive: true, force: true })
  }
}

module.exports = { deadStation }
