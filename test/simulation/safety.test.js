'use strict'

const assert = require('node:assert')
const { freshSeed } = require('../../lib/sim')
const { safetyRun } = require('./run')

/** The five claims of a run; its report with the seed is the evidence. */
function assertSafe(report) {
  const evidence = () => `seed ${report.seed}: ${JSON.stringify(report, null, 1).slice(0, 4000)}`
  assert.deepStrictEqual(report.wrong, [], evidence())
  assert.deepStrictEqual(report.doubled, [], evidence())
  assert.deepStrictEqual(report.misreported, [], evidence())
  assert.strictEqual(report.settled, report.asked, evidence())
  assert.deepStrictEqual([report.open, report.timers], [0, 0], evidence())
  assert.deepStrictEqual(report.rejected, {}, evidence())
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
      const report = await safetyRun({ exchanges: 4000, ...Object(options) })
      assertSafe(report)
      assertBusy(report, 4000)
    })
  }

  const seed = freshSeed()
  it(`a fresh seed: ${seed}`, async () => {
    const report = await safetyRun({ seed, exchanges: 3000, collisions: false })
    assertSafe(report)
  })

  it('is replayed exactly by its seed', async () => {
    const [one, two] = [await safetyRun({ seed: 5, exchanges: 800 }), await safetyRun({ seed: 5, exchanges: 800 })]
    assert.deepStrictEqual(one, two)
    assert.notDeepStrictEqual((await safetyRun({ seed: 6, exchanges: 800 })).faults, one.faults)
  })

  it('no faults: every value good, every write confirmed', async () => {
    const report = await safetyRun({ seed: 8, exchanges: 2000, faults: [], unplugs: 0 })
    assertSafe(report)
    const { bad, outcomes } = report
    assert.deepStrictEqual([bad, outcomes.unknown, outcomes.refused, outcomes.failed], [0, 0, 0, 0])
    assert.ok(outcomes.confirmed > 100)
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
})
