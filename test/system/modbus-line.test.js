'use strict'

/** An NX PLC and three regulators on one paced RS-485 line, a minute long: no wrong value, each polled at its rate. */

const assert = require('node:assert/strict')
const { mixedLine } = require('../support/mixed-line.js')

const SECONDS = Number(process.env.SERIAL_PLC_LINE_SECONDS || 60)
/** What may be missing of the cycles that were due: this machine may stop us for a moment. */
const TOLERANCE = 0.02

describe('NX and MODBUS on one line, 19200 bit/s', function () {
  this.timeout((SECONDS + 60) * 1000)

  it(`${SECONDS} s under load: no wrong value, each polled at its rate`, async () => {
    const run = await mixedLine({ seconds: SECONDS, baudRate: 19200 })
    assert.deepEqual(run.wrong, [])
    assert.deepEqual(run.failures, [])
    assert.ok(run.busy > 0.5, `the line was busy for ${run.busy} of the time`)
    for (const { device, station, interval, cycles, due, overruns } of run.polls) {
      const what = `${device} ${station} every ${interval} ms: ${cycles} of ${due}, ${overruns} overruns`
      assert.ok(cycles >= due * (1 - TOLERANCE) - 1 && cycles <= due * (1 + TOLERANCE) + 1, what)
      assert.ok(overruns <= due * TOLERANCE, what)
    }
    const { timeouts, crcErrors, incomplete, late } = run.stats
    assert.deepEqual({ timeouts, crcErrors, incomplete, late }, { timeouts: 0, crcErrors: 0, incomplete: 0, late: 0 })
    // of what was compared: two values a poll, one an ask
    const polled = run.polls.reduce((sum, { cycles }) => sum + 2 * cycles, 0)
    assert.equal(run.values, polled + run.asks)
    assert.ok(run.writes >= SECONDS * 5 && run.asks >= SECONDS * 3, `${run.writes} writes, ${run.asks} asks`)
  })
})
