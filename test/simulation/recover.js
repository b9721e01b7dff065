'use strict'

/** Liveness: the faults stop. Everything must come back by itself within the bound of its settings, and then nothing may be bad any more. */

const { read, write } = require('./workload')

const REOPEN = 5000 // ms: the longest back-off of a line, lib/line/connection.js
const LATEST = 1000 // ms: the latest answer of lib/sim/faults.js, with what it waits for on the wire
const JITTER = 1.1 // of a probe, lib/device/health.js
const PROBE_MOST = 60000
const TICK = 20

/**
 * How long it may take until all is well again: the longest of what a station may wait for, one after the other.
 * @param {any} system of run.js
 * @returns {number} ms
 */
function boundOf({ rows, lease, common, groups }) {
  const { timeout, attempts, demoteAfter = 3, probeMost = PROBE_MOST } = common
  // an answer that was on its way when the faults stopped begins the silence anew
  const silence = LATEST + Math.max(...rows.map(({ station }) => lease.line.memory(station).bound ?? 1000))
  const probe = demoteAfter > 0 ? probeMost * JITTER : 0
  // all that waits before it is asked, and may fail to the last attempt
  const turn = rows.length * attempts * (timeout + silence)
  const interval = Math.max(0, ...groups.map(each => each.interval))
  return REOPEN + probe + silence + turn + interval
}

function stopFaults({ line, rows }) {
  line.faults.clear()
  line.wire.plug()
  for (const { station } of rows) line.wire.setOff(station, false)
}

/** The faults begin again. */
function resume({ line, faults }) {
  for (const { kind, rate, argument } of faults) line.faults.set(kind, rate, argument)
}

async function recover(system) {
  const { clock, report, rows, groups } = system
  stopFaults(system)
  const start = clock.now()
  const bound = boundOf(system)
  const late = () => clock.now() - start > bound
  const pause = ms => new Promise(resolve => clock.setTimer(() => resolve(undefined), ms))
  // the last late answers are under way: what they spoil, and who is demoted for it, belongs to the faults
  await pause(LATEST)
  const calm = clock.now()
  const isBack = async index => {
    while (!(await read(system, index))) {
      if (late()) return false
      await pause(TICK)
    }
    return true
  }
  const delivers = async group => {
    while (group.goodAt <= calm) {
      if (late()) return false
      await pause(TICK)
    }
    return true
  }
  const back = await Promise.all([...rows.map((_, index) => isBack(index)), ...groups.map(delivers)])
  const took = clock.now() - start
  report.recovered = Math.max(report.recovered, took)
  report.bound = bound
  if (!back.every(Boolean) || took > bound) report.overdue.push({ at: start, took, bound, back })
  await checkCalm(system)
}

/** From now on all must be good. */
async function checkCalm(system) {
  const { report, rows } = system
  for (let n = 0; n < 5 * rows.length; n++) {
    const index = n % rows.length
    if (!(await read(system, index))) report.relapses++
    if ((await write(system, index)) !== 'confirmed') report.relapses++
  }
}

module.exports = { recover, resume }
