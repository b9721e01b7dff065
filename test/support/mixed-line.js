'use strict'

/**
 * An NX PLC and three regulators on one RS-485 line that keeps the pace of its speed, in real time, over a virtual serial port: polled, written to
 * and asked at once. Every value is compared with what the station held between request and answer.
 */

const assert = require('node:assert/strict')
const fs = require('node:fs')
const os = require('node:os')
const path = require('node:path')
const { createPool, openChinoRegulator, openNxPlc } = require('../../lib')
const { createLine, createRandom, serveOnPty } = require('../../lib/sim')
const { startVersions } = require('./versions.js')

const CHANGE = 50 // ms between two changes of what a station holds
const ASK = 170
const WRITE = 110
const TURNAROUND = 5
const SET_POINT_STEPS = 1000

const nx = { device: 'nx', station: 1, block: 'M0..M9', first: 'M', setPoint: 'M10', interval: 250 }
const chino = (station, interval) => ({
  device: 'chino',
  station,
  block: 'hr100..hr109',
  first: 'hr10',
  setPoint: 'hr110',
  interval
})
const STATIONS = [nx, chino(11, 200), chino(12, 250), chino(13, 400)]

/** The simulated end: it changes what it holds and remembers when. */
function createFarEnd({ baudRate, link, rates, seed }) {
  const rows = STATIONS.map(({ device, station }) => ({ device, station }))
  const line = { baudRate, turnaround: TURNAROUND, quiet: true, rates, seed }
  const { wire, stations, faults } = createLine({ stations: rows, ...line })
  const server = serveOnPty({ wire, link })
  const held = startVersions(
    STATIONS.map(({ station, first }, n) => ({ memory: stations[n], number: station, first })),
    { every: CHANGE }
  )
  return {
    held,
    faults,
    stations,
    wire,
    close: () => {
      held.stop()
      server.close()
    }
  }
}

/** One station as our library sees it, with the judge of its values. */
function createNearEnd(shape, device, { held, wrong }) {
  const { station, block, setPoint } = shape
  const seen = { cycles: 0, values: 0, writes: 0, asks: 0, failures: [] }
  // what was sent as set point: from when it may have been there, and until when
  const sent = [{ value: 0, from: -Infinity, until: Infinity }]
  const judge = (results, from) => {
    const to = performance.now()
    for (const { item, value, quality, code } of results) {
      if (quality !== 'good') seen.failures.push(`${station} ${item}: ${code}`)
      else if (!isHeld(item, value, from, to)) wrong.push({ station, item, value, from, to })
      else seen.values++
    }
  }
  const isHeld = (item, value, from, to) => {
    if (item === setPoint) return sent.some(each => each.value === value && each.from <= to && each.until >= from)
    return held(value, from, to)
  }
  const subscription = device.subscribe({ items: [block, setPoint], interval: shape.interval }, (results, { ms }) => {
    seen.cycles++
    judge(results, performance.now() - ms - 1)
  })
  return {
    shape,
    seen,
    subscription,
    async ask() {
      seen.asks++
      const from = performance.now()
      judge(await device.read([block]), from)
    },
    async write(value) {
      const before = sent.filter(({ until }) => until === Infinity)
      const entry = { value, from: performance.now(), until: Infinity }
      sent.push(entry)
      const { outcome, code } = await device.write({ [setPoint]: value })
      // else both may be held
      if (outcome !== 'confirmed') return seen.failures.push(`${station} write: ${outcome} ${code}`)
      seen.writes++
      for (const each of before) each.until = performance.now()
    },
    /** What the station can hold at the end. */
    last: () => sent.filter(({ until }) => until === Infinity).map(({ value }) => value)
  }
}

const openDevice = ({ device, station }, line) => {
  if (device === 'nx') return openNxPlc({ ...line, station, access: 'write', timeout: 1000 })
  return openChinoRegulator({ ...line, station, access: 'write', timeout: 1000 })
}

/** Calls `run` every `ms`, one after the other, until it is stopped. */
function every(ms, run) {
  let stopped = false
  const rest = () => new Promise(resolve => setTimeout(resolve, ms))
  const done = (async () => {
    for (await rest(); !stopped; await rest()) await run()
  })()
  return () => {
    stopped = true
    return done
  }
}

/**
 * @param {{ seconds?: number, baudRate?: number, seed?: number, rates?: import('../../lib/sim/faults').Fault[] }} [options] rates: of faults of the answers
 * @returns {Promise<{ seconds: number, busy: number, wrong: any[], failures: string[], polls: any[], values: number, writes: number, asks: number,
 *   faults: Record<string, number>, stats: any }>} busy: share of the time that the line had something to do; polls: cycles of each station, and how many were due
 */
async function mixedLine({ seconds = 60, baudRate = 19200, seed = 1, rates = [] } = {}) {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'mixed-'))
  const link = path.join(folder, 'line')
  const far = createFarEnd({ baudRate, link, rates, seed })
  const pool = createPool()
  const random = createRandom(seed)
  const devices = STATIONS.map(shape => openDevice(shape, { pool, path: link, baudRate }))
  const wrong = []
  try {
    // the first answer of each: from here on the rate counts
    await Promise.all(devices.map((device, n) => device.read([STATIONS[n].setPoint])))
    const near = devices.map((device, n) =>
      createNearEnd(STATIONS[n], device, { held: (...value) => far.held.isHeld(n, ...value), wrong })
    )
    const { busy } = devices[0].line.stats()
    const from = performance.now()
    let turn = 0
    const stops = [
      every(ASK, () => random.pick(near).ask()),
      every(WRITE, () => near[turn++ % near.length].write(random.integer(1, SET_POINT_STEPS)))
    ]
    await new Promise(resolve => setTimeout(resolve, seconds * 1000))
    const took = performance.now() - from
    const polls = near.map(({ shape, seen, subscription }) => {
      subscription.stop()
      const { device, station, interval } = shape
      return { device, station, interval, cycles: seen.cycles, due: took / interval, overruns: subscription.overruns }
    })
    await Promise.all(stops.map(stop => stop()))
    const stats = devices[0].line.stats()
    near.forEach(({ shape, last }, n) => assert.ok(last().includes(far.stations[n].get(shape.setPoint))))
    const sum = name => near.reduce((total, { seen }) => total + seen[name], 0)
    return {
      seconds: took / 1000,
      busy: (stats.busy - busy) / took,
      wrong,
      failures: near.flatMap(({ seen }) => seen.failures),
      polls,
      values: sum('values'),
      writes: sum('writes'),
      asks: sum('asks'),
      faults: far.faults.counts,
      stats
    }
  } finally {
    await Promise.all(devices.map(device => device.close()))
    far.close()
    fs.rmSync(folder, { recursive: true, force: true })
  }
}

module.exports = { mixedLine }
