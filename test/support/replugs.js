'use strict'

/**
 * An adapter that is unplugged at any moment of the traffic and plugged in again, on a real (virtual) serial port that two stations share. Run by
 * test/system and by `npm run endurance -- replugs`.
 */

const assert = require('node:assert/strict')
const fs = require('node:fs')
const os = require('node:os')
const path = require('node:path')
const { createPool, openChinoRegulator, openNxPlc } = require('../../lib')
const { createLine, createRandom, serveOnPty } = require('../../lib/sim')
const { until } = require('./node-red.js')
const { startVersions } = require('./versions.js')

const BAUD = 38400
const TIMEOUT = 500
const BACK = 2000 // ms, and the bound of lateness: docs/architecture.md
const STATIONS = [
  { device: 'nx', station: 1, first: 'M', block: 'M0..M9', open: openNxPlc },
  { device: 'chino', station: 11, first: 'hr', block: 'hr0..hr9', open: openChinoRegulator }
]

const wait = ms => new Promise(resolve => setTimeout(resolve, ms))
const openFiles = () => (fs.existsSync('/proc/self/fd') ? fs.readdirSync('/proc/self/fd').length : 0)

/** Polls a station; `good` are the times of its good values. */
function watch(device, { block }, isHeld) {
  const seen = { values: 0, last: -Infinity, wrong: 0, codes: new Set() }
  device.subscribe({ items: [block], interval: 50 }, ([{ value, quality, code }], { ms }) => {
    const now = performance.now()
    if (quality !== 'good') return seen.codes.add(code)
    if (!isHeld(value, now - ms - 1, now)) seen.wrong++
    seen.values++
    seen.last = now
  })
  return seen
}

/**
 * @param {{ rounds: number, outage?: [number, number], outages?: number[], seed?: number, tell?: (text: string) => void }} options outage: ms that the
 *   adapter is away, [least, most]; outages: the same, fixed, of the first rounds
 * @returns {Promise<{ rounds: number, values: number, wrong: number, slowest: number, limit: number, late: number, busiest: number, codes: string[] }>}
 *   slowest: ms from plugging in to the first good value of the later station; late: rounds over the limit; busiest: share of a core while unplugged
 */
async function replugs({ rounds, outage = [10, 500], outages = [], seed = 1, tell = _text => {} }) {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'replugs-'))
  const link = path.join(folder, 'line')
  const random = createRandom(seed)
  const { wire, stations } = createLine({ stations: STATIONS, baudRate: BAUD, quiet: true, turnaround: 2 })
  const held = startVersions(
    STATIONS.map(({ station, first }, n) => ({ memory: stations[n], number: station, first })),
    { every: 50, most: 1000 }
  )
  const port = serveOnPty({ wire, link })
  const pool = createPool()
  const devices = STATIONS.map(({ station, open }) =>
    open({ pool, path: link, baudRate: BAUD, station, timeout: TIMEOUT })
  )
  const seen = devices.map((device, n) => watch(device, STATIONS[n], (...value) => held.isHeld(n, ...value)))
  const since = time =>
    until(() => seen.every(({ last }) => last > time), { what: 'values', every: 2, patience: 60000 })
  const bound = () => Math.max(...STATIONS.map(({ station }) => devices[0].line.memory(station).bound))
  const done = { rounds: 0, values: 0, wrong: 0, slowest: 0, limit: 0, late: 0, busiest: 0 }
  try {
    await since(performance.now())
    const files = openFiles()
    for (let round = 0; round < rounds; round++) {
      await wait(random.integer(20, 200))
      const ms = outages[round] ?? random.integer(...outage)
      const used = process.cpuUsage()
      const away = performance.now()
      port.unplug()
      await wait(ms)
      const { user, system } = process.cpuUsage(used)
      if (ms > 200) done.busiest = Math.max(done.busiest, (user + system) / 1000 / (performance.now() - away))
      port.replug()
      const back = performance.now()
      await since(back)
      const took = performance.now() - back
      done.limit = Math.max(done.limit, BACK + bound())
      if (took > BACK + bound()) done.late++
      done.slowest = Math.max(done.slowest, Math.round(took))
      done.rounds++
      assert.equal(openFiles(), files, `after ${round + 1} replugs`)
      if ((round + 1) % 10 === 0) tell(`${round + 1} replugs, slowest ${done.slowest} ms, ${done.late} late`)
    }
    const sum = name => seen.reduce((total, each) => total + each[name], 0)
    const codes = [...new Set(seen.flatMap(each => [...each.codes]))].sort()
    return { ...done, values: sum('values'), wrong: sum('wrong'), codes }
  } finally {
    await Promise.all(devices.map(device => device.close()))
    held.stop()
    port.close()
    fs.rmSync(folder, { recursive: true, force: true })
  }
}

module.exports = { replugs }
