'use strict'

/**
 * Simulated stations in a process of their own, behind virtual serial ports that keep the pace of their speed.
 * That process is this file: `node bench/far-end.js FOLDER COUNT SETTINGS`, settings of `createLine` as JSON.
 */
const { spawn } = require('node:child_process')
const { once } = require('node:events')
const { mkdtempSync, rmSync } = require('node:fs')
const os = require('node:os')
const path = require('node:path')
const { createLine, createRealClock, serveOnPty } = require('../lib/sim')

const SPIN = 1.5 // ms
const AWAKE = 15 // ms: longer than a master pauses, or its query takes
const GAP = 25 // ms: pauses of programs inside of a frame, which a wire does not have

/** Keeps the process from sleeping for a while after each call: who sleeps hears late. */
const wakefulness = now => {
  let until = -Infinity
  let awake = false
  const look = () => {
    awake = now() < until
    if (awake) setImmediate(look)
  }
  return () => {
    until = now() + AWAKE
    if (!awake) look()
  }
}

/**
 * A clock whose timers are not late: the last moments before each are waited for actively, and those behind it, when the next query may come. The
 * bytes of a wire come when they are due, and it hears them at once; a simulator is late by a part of a millisecond in both, the more the longer it
 * has slept. Where a bench measures such short times, the simulator must not be what it measures. Takes most of a core.
 */
const preciseClock = () => {
  const { now, wall } = createRealClock()
  const stayAwake = wakefulness(now)
  const arm = timer => {
    const left = timer.at - now()
    if (timer.fn === null) return
    if (left > SPIN) timer.waits = setTimeout(arm, left - SPIN, timer)
    else if (left > 0) setImmediate(arm, timer)
    else {
      timer.fn()
      stayAwake()
    }
  }
  const setTimer = (fn, ms) => {
    const timer = { fn, at: now() + ms, waits: /** @type {any} */ (null) }
    // never at once, as with any timer
    if (ms > SPIN) arm(timer)
    else setImmediate(arm, timer)
    return timer
  }
  const clearTimer = timer => {
    if (!timer) return
    clearTimeout(timer.waits)
    timer.fn = null
  }
  return { now, wall, setTimer, clearTimer }
}

/** @param {any} station number of an NX PLC, or what `createLine` takes */
const withGap = station => ({ gap: GAP, ...(typeof station === 'number' ? { station } : station) })

/** What `createLine` is given. */
const lineSettings = ({ precise = false, stations, ...settings }) => {
  if (!precise) return { stations, ...settings }
  return { ...settings, clock: preciseClock(), stations: stations.map(withGap) }
}

const linkIn = (folder, n) => path.join(folder, `line${n}`)

/**
 * @param {Record<string, any> & { lines?: number, precise?: boolean }} settings of `createLine`; lines: so many of them, default one; precise: bytes are
 *   never late and heard at once, for which the process takes most of a core
 * @returns {Promise<{ link: string, links: string[], close: () => Promise<void> }>} links: the ports to open; link: the first
 */
async function startFarEnd({ lines = 1, ...settings }) {
  const folder = mkdtempSync(path.join(os.tmpdir(), 'bench-'))
  const child = spawn(process.execPath, [__filename, folder, String(lines), JSON.stringify(settings)], {
    stdio: ['ignore', 'pipe', 'inherit']
  })
  const close = async () => {
    if (child.exitCode === null) {
      child.kill('SIGTERM')
      await once(child, 'exit')
    }
    rmSync(folder, { recursive: true, force: true })
  }
  const ended = once(child, 'exit').then(() => Promise.reject(new Error('the simulator ended')))
  ended.catch(() => {})
  try {
    await Promise.race([once(child.stdout, 'data'), ended])
  } catch (error) {
    await close()
    throw error
  }
  const links = Array.from({ length: lines }, (_, n) => linkIn(folder, n))
  return { link: links[0], links, close }
}

if (require.main === module) {
  const [, , folder, lines, settings] = process.argv
  const servers = Array.from({ length: Number(lines) }, (_, n) =>
    serveOnPty({ wire: createLine(lineSettings(JSON.parse(settings))).wire, link: linkIn(folder, n) })
  )
  process.once('SIGTERM', () => {
    for (const server of servers) server.close()
    process.exit(0)
  })
  process.stdout.write('ready\n')
}

module.exports = { startFarEnd }
