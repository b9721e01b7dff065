'use strict'

/** Programs that are stopped, killed and started again in the middle of an exchange, on a real (virtual) serial port. Run by test/system. */

const { fork, spawn } = require('node:child_process')
const fs = require('node:fs')
const os = require('node:os')
const path = require('node:path')
const { createPool, openChinoRegulator, openNxPlc } = require('../../lib')
const { createLine, createRandom, serveOnPty } = require('../../lib/sim')
const { until } = require('./node-red.js')
const { startVersions } = require('./versions.js')

const BAUD = 19200
const STATIONS = [
  { device: 'nx', station: 1, first: 'M', block: 'M0..M9', target: 'M20' },
  { device: 'chino', station: 11, first: 'hr', block: 'hr0..hr9', target: 'hr20' }
]
const wait = ms => new Promise(resolve => setTimeout(resolve, ms))
const clock = () => Number(process.hrtime.bigint()) / 1e6

/** Two stations on a port of this process; the master is a process of its own. @param {{ echo?: boolean }} [options] */
function createStage(options = {}) {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'processes-'))
  const link = path.join(folder, 'line')
  const { wire, stations } = createLine({ stations: STATIONS, baudRate: BAUD, quiet: true, turnaround: 3, ...options })
  const held = startVersions(
    STATIONS.map(({ station, first }, n) => ({ memory: stations[n], number: station, first })),
    { every: 50, most: 2000 }
  )
  const port = serveOnPty({ wire, link })
  const seen = { values: [0, 0], wrong: [], writes: [], states: [], last: [-Infinity, -Infinity] }
  const children = new Set()
  const hear = ({ what, ...message }) => {
    // the clocks of two processes have other zeros
    const shift = performance.now() - clock()
    if (what === 'state') seen.states.push(message)
    if (what === 'write') seen.writes.push(message)
    if (what !== 'value') return
    const { n, value, from, to } = message
    if (!held.isHeld(n, value, from + shift, to + shift)) seen.wrong.push(message)
    seen.values[n]++
    seen.last[n] = to + shift
  }
  /** @param {any} [more] */
  const start = more => {
    const line = { path: link, baudRate: BAUD }
    const child = fork(path.join(__dirname, 'master.js'), [JSON.stringify({ line, stations: STATIONS, ...more })])
    children.add(child)
    child.on('message', hear)
    child.once('exit', () => children.delete(child))
    return child
  }
  return {
    ...{ folder, link, port, wire, stations, seen, start },
    good: from => until(() => seen.last.every(at => at > from), { what: 'values', every: 5, patience: 30000 }),
    async close() {
      const ended = [...children].map(child => new Promise(resolve => child.once('exit', resolve)))
      for (const child of children) child.kill('SIGKILL')
      await Promise.all(ended)
      held.stop()
      port.close()
      fs.rmSync(folder, { recursive: true, force: true })
    }
  }
}

/**
 * The master is stopped (SIGSTOP) at any moment and goes on later.
 * @param {{ rounds: number, seed?: number }} options
 * @returns {Promise<{ values: number, wrong: number, slowest: number, writes: number, unconfirmed: any[], states: any[] }>} slowest: ms from going on to the first values
 */
async function stoppedMaster({ rounds, seed = 1 }) {
  const random = createRandom(seed)
  const stage = createStage()
  try {
    const child = stage.start()
    await stage.good(performance.now())
    let slowest = 0
    for (let round = 0; round < rounds; round++) {
      await wait(random.integer(20, 250))
      child.kill('SIGSTOP')
      // shorter and longer than the timeout
      await wait(random.integer(0, 1) ? random.integer(10, 300) : random.integer(600, 1500))
      child.kill('SIGCONT')
      const from = performance.now()
      await stage.good(from)
      slowest = Math.max(slowest, Math.round(performance.now() - from))
    }
    return summary(stage, { slowest })
  } finally {
    await stage.close()
  }
}

/**
 * The master is killed (SIGKILL) at any moment, and a new one is started at once.
 * @param {{ rounds: number, seed?: number }} options
 * @returns {Promise<any>} as {@link stoppedMaster}; slowest: ms from the start of the new process to its first values
 */
async function killedMaster({ rounds, seed = 2 }) {
  const random = createRandom(seed)
  const stage = createStage()
  try {
    let child = stage.start()
    await stage.good(performance.now())
    let slowest = 0
    for (let round = 0; round < rounds; round++) {
      await wait(random.integer(20, 250))
      const gone = new Promise(resolve => child.once('exit', resolve))
      child.kill('SIGKILL')
      const from = performance.now()
      child = stage.start()
      await gone
      await stage.good(from)
      slowest = Math.max(slowest, Math.round(performance.now() - from))
    }
    return summary(stage, { slowest })
  } finally {
    await stage.close()
  }
}

function summary({ seen }, more) {
  const unconfirmed = seen.writes.filter(({ outcome }) => outcome !== 'confirmed')
  return {
    ...more,
    values: seen.values.reduce((sum, count) => sum + count, 0),
    wrong: seen.wrong.length,
    writes: seen.writes.length,
    unconfirmed,
    states: seen.states
  }
}

const MEANING = n => (n * 257 + 11) & 0xffff
const WORDS = 100
/** How the words of a kind of station are called, and who opens it. */
const KINDS = {
  nx: { word: 'M', open: openNxPlc },
  chino: { word: 'hr', open: openChinoRegulator }
}

/**
 * The stations' end is stopped in the middle of an exchange, and goes on later: its answers are late by as much. Each word of it says its address.
 * @param {{ rounds: number, device?: 'nx'|'chino', seed?: number, longest?: number, more?: any }} options longest: ms that it is stopped; more: further
 *   settings of line and device
 * @returns {Promise<{ values: number, wrong: number, bad: string[], slowest: number, bound: number }>} bound: of lateness, as learnt, ms
 */
async function stoppedStation({ rounds, device = 'nx', seed = 3, longest = 1500, more = {} }) {
  const { word, open } = KINDS[device]
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'processes-'))
  const link = path.join(folder, 'line')
  const script = path.join(__dirname, '..', '..', 'scripts', 'simulate.js')
  const args = [script, device, '--pty', link, '--baud', String(BAUD), '--quiet']
  const child = spawn(process.execPath, args, { stdio: ['ignore', 'pipe', 'inherit'] })
  const exited = new Promise(resolve => child.once('exit', resolve))
  const random = createRandom(seed)
  let station
  try {
    await until(() => fs.existsSync(link), { what: 'the simulator' })
    const line = { pool: createPool(), path: link, baudRate: BAUD }
    station = open({ ...line, station: 1, timeout: 300, access: 'write', ...more })
    await station.write(Object.fromEntries(Array.from({ length: WORDS }, (_, n) => [`${word}${n}`, MEANING(n)])))
    const result = { values: 0, wrong: 0, bad: new Set(), slowest: 0 }
    const ask = async () => {
      const first = random.integer(0, WORDS - 10)
      const [{ value, quality, code }] = await station.read([`${word}${first}..${word}${first + 9}`])
      if (quality !== 'good') return void result.bad.add(code)
      if (String(value) !== String(value.map((_, n) => MEANING(first + n)))) result.wrong++
      else result.values++
    }
    const asking = async () => {
      for (let n = 0; n < 8; n++) await ask()
    }
    for (let round = 0; round < rounds; round++) {
      const done = asking()
      await wait(random.integer(0, 150))
      child.kill('SIGSTOP')
      await wait(random.integer(50, longest))
      child.kill('SIGCONT')
      const from = performance.now()
      await done
      const { values } = result
      await until(async () => (await ask(), result.values > values), { what: 'a value', every: 5 })
      result.slowest = Math.max(result.slowest, Math.round(performance.now() - from))
    }
    return { ...result, bad: [...result.bad].sort(), bound: station.line.memory(1).bound }
  } finally {
    await station?.close()
    child.kill('SIGCONT')
    child.kill('SIGTERM')
    await exited
    fs.rmSync(folder, { recursive: true, force: true })
  }
}

module.exports = { createStage, killedMaster, stoppedMaster, stoppedStation }
