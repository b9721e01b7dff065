'use strict'

const assert = require('node:assert')
const { freshSeed } = require('../../lib/sim')
const { FAULTS, safetyRun } = require('./run')
const { SOLE, mixed, regulators } = require('./workload')

/** The claims of a run; its report with the seed is the evidence. */
function assertSafe(report) {
  const evidence = () => `seed ${report.seed}: ${JSON.stringify(report, null, 1).slice(0, 4000)}`
  assert.deepStrictEqual(report.wrong, [], evidence())
  assert.deepStrictEqual(report.doubled, [], evidence())
  assert.deepStrictEqual(report.misreported, [], evidence())
  assert.strictEqual(report.settled, report.asked, evidence())
  assert.deepStrictEqual([report.open, report.timers], [0, 0], evidence())
  assert.deepStrictEqual(report.rejected, {}, evidence())
}

/** Liveness: within the bound of the settings all is well again, and stays so. */
function assertRecovered(report) {
  const evidence = `seed ${report.seed}: ${JSON.stringify(report, null, 1).slice(0, 4000)}`
  assert.deepStrictEqual(report.overdue, [], evidence)
  assert.strictEqual(report.relapses, 0, evidence)
}

/** A run that meets no fault and delivers nothing would be safe, too. */
function assertBusy({ good, outcomes, faults, exchanges, redeploys, unplugged }, least) {
  assert.ok(exchanges >= least)
  assert.ok(good > least, `${good} good values`)
  assert.ok(outcomes.confirmed > least / 20 && outcomes.unknown > 10, JSON.stringify(outcomes))
  assert.strictEqual(Object.keys(faults).length, 13, JSON.stringify(faults))
  assert.ok(redeploys + unplugged > 0)
}

describe('safety: any faults, up to 30 % of all answers', function () {
  this.timeout(60000)
  const cases = [
    ['seed 1: stations that answer at once spoil each other', { seed: 1 }],
    ['seed 2', { seed: 2, collisions: false }],
    ['seed 3: the adapter hears itself', { seed: 3, echo: true }],
    ['seed 4: unplugged and redeployed ten times as often', { seed: 4, unplugs: 0.01 }]
  ]
  for (const [name, options] of cases) {
    it(String(name), async () => {
      const report = await safetyRun({ exchanges: 1600, unplugs: 0.003, ...Object(options) })
      assertSafe(report)
      assertBusy(report, 1600)
      assertRecovered(report)
    })
  }

  it('seed 10: polls of several requests, repeated by an RR alone, forwards and backwards', async () => {
    const sole = { stations: SOLE, polls: true, pause: 2000 }
    const report = await safetyRun({ seed: 10, exchanges: 1500, ...sole })
    assertSafe(report)
    assertRecovered(report)
    assert.ok(report.repeats > 25, `${report.repeats} repeats`)
  })

  const seed = freshSeed()
  it(`a fresh seed: ${seed}`, async () => {
    const report = await safetyRun({ seed, exchanges: 1000, collisions: false })
    assertSafe(report)
    assertRecovered(report)
  })

  it('is replayed exactly by its seed', async () => {
    const [one, two] = [await safetyRun({ seed: 5, exchanges: 400 }), await safetyRun({ seed: 5, exchanges: 400 })]
    assert.deepStrictEqual(one, two)
    assert.notDeepStrictEqual((await safetyRun({ seed: 6, exchanges: 400 })).faults, one.faults)
  })

  it('no faults: every value good, every write confirmed', async () => {
    const report = await safetyRun({ seed: 8, exchanges: 1000, faults: [], unplugs: 0 })
    assertSafe(report)
    const { bad, outcomes } = report
    assert.deepStrictEqual([bad, outcomes.unknown, outcomes.refused, outcomes.failed], [0, 0, 0, 0])
    assert.ok(outcomes.confirmed > 50)
  })
})

// LRC: one flipped bit is what it surely sees
const ONE_BIT = FAULTS.map(fault => (fault.kind === 'crc' ? { ...fault, argument: 1 } : fault))
const without = (faults, ...kinds) => faults.filter(({ kind }) => !kinds.includes(kind))

describe('safety: regulators, alone and beside NX PLCs', function () {
  this.timeout(60000)
  // ASCII: what collides is spoilt so that the LRC sees it
  const lines = [
    ['RTU', { stations: regulators('rtu') }],
    ['ASCII', { stations: regulators('ascii'), faults: ONE_BIT, collisions: 'seen' }],
    ['NX and RTU', { stations: mixed('rtu') }],
    ['NX and ASCII', { stations: mixed('ascii'), faults: ONE_BIT, collisions: 'seen' }]
  ]
  const cases = [
    ['seed 23', { seed: 23 }],
    ['seed 23: the adapter hears itself', { seed: 23, echo: true }]
  ]
  for (const [name, line] of lines) {
    for (const [what, options] of cases) {
      it(`${name}, ${what}`, async () => {
        const report = await safetyRun({ exchanges: 1000, ...Object(line), ...Object(options), unplugs: 0.003 })
        assertSafe(report)
        assertBusy(report, 600)
        assertRecovered(report)
        assert.ok(report.executed > 80)
      })
    }

    // two faults at once are not claimed: the answer that `merged` repeats is taken if another one spoils the right one before it
    const claimed = without(Object(line).faults ?? FAULTS, 'merged', 'echo')
    const seed = freshSeed()
    it(`${name}, a fresh seed: ${seed}`, async () => {
      const report = await safetyRun({ seed, exchanges: 600, ...Object(line), faults: claimed, collisions: 'seen' })
      assertSafe(report)
      assertRecovered(report)
    })

    // and nothing collides here
    const apart = without(Object(line).faults ?? FAULTS, 'late', 'duplicated', 'off')
    it(`${name}, a fresh seed without late answers: ${seed + 1}`, async () => {
      assertSafe(await safetyRun({ seed: seed + 1, exchanges: 500, ...Object(line), faults: apart, unplugs: 0 }))
    })

    it(`${name}, no faults: every value good, every write confirmed`, async () => {
      const report = await safetyRun({ ...Object(line), seed: 23, exchanges: 600, faults: [], unplugs: 0 })
      assertSafe(report)
      const { bad, outcomes, relapses } = report
      assert.deepStrictEqual([bad, outcomes.unknown, outcomes.refused, outcomes.failed, relapses], [0, 0, 0, 0, 0])
      assert.ok(outcomes.confirmed > 30)
    })
  }

  it('is replayed exactly by its seed', async () => {
    const run = () => safetyRun({ seed: 5, exchanges: 300, stations: mixed('rtu') })
    assert.deepStrictEqual(await run(), await run())
  })

  it('a busy or slow device (06, 05): reads are asked again, writes are not', async () => {
    for (const argument of [5, 6]) {
      const faults = [{ kind: 'error', rate: 0.3, argument }]
      const report = await safetyRun({ seed: 24, exchanges: 500, stations: regulators('rtu'), faults, unplugs: 0 })
      assertSafe(report)
      const code = argument === 5 ? 'MODBUS_ACKNOWLEDGE' : 'MODBUS_BUSY'
      assert.deepStrictEqual(Object.keys(report.codes), [code])
      assert.ok(report.bad < report.good / 4, `${report.bad} of ${report.good}`)
    }
  })
})

describe('safety: the run has teeth', function () {
  this.timeout(60000)
  const late = { seed: 9, exchanges: 1000, unplugs: 0, collisions: false, uniform: true }
  // 25 ms after the timeout of 150: an ID is used again only after eight queries
  const faults = [{ kind: 'late', rate: 0.2, argument: 175 }]
  const fixedId = { masterIds: 226, attempts: 1 }

  it('without quarantine and with one fixed ID late answers are taken, and the run sees it', async () => {
    const report = await safetyRun({ ...late, faults, device: fixedId, wire: { latenessBound: 1 } })
    assert.ok(report.wrong.length > 50, String(report.wrong.length))
  })

  it('the quarantine alone keeps them out', async () => {
    const report = await safetyRun({ ...late, faults, device: fixedId })
    assertSafe(report)
    assert.ok(report.faults.late > 150)
  })

  it('the changing ID alone keeps them out', async () => {
    const report = await safetyRun({ ...late, faults, device: { attempts: 1 }, wire: { latenessBound: 1 } })
    assertSafe(report)
    assert.ok(report.faults.late > 150)
  })

  // MODBUS has no nonce: silence alone tells a late answer from the awaited one
  for (const protocol of ['rtu', 'ascii']) {
    const chino = { ...late, stations: regulators(protocol), faults }

    it(`regulators, ${protocol}: without quarantine late answers are taken, and the run sees it`, async () => {
      const report = await safetyRun({ ...chino, recovery: false, device: { attempts: 1 }, wire: { latenessBound: 1 } })
      assert.ok(report.wrong.length > 50, String(report.wrong.length))
    })

    it(`regulators, ${protocol}: with it they are not`, async () => {
      const report = await safetyRun({ ...chino, device: { attempts: 1 } })
      assertSafe(report)
      assertRecovered(report)
      assert.ok(report.faults.late > 150)
    })
  }
})
