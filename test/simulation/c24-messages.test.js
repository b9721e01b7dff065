'use strict'
const assert = require('node:assert/strict')
const { APART, CLOSE, CONFIRMED, WEAR, c24Messages, freeTheory } = require('./c24-messages')

// endurance run "c24messages": 10,000 each way
const COUNT = 1000

/** Within four standard deviations of what theory expects. */
const near = (got, expected) =>
  assert.ok(Math.abs(got - expected) < 4 * Math.sqrt(expected), `${got}, by theory ${expected.toFixed(1)}`)

describe('C24: messages each way while one byte of a hundred is damaged or lost', () => {
  it('bidirectional, with programs that repeat and know a repetition: 0 lost, 0 doubled', async () => {
    const { outcomes, toModule, toUs, stats } = await c24Messages({ count: COUNT, seed: 1, wear: WEAR, ...CONFIRMED })
    const all = { came: COUNT, lost: 0, doubled: 0, wrong: 0, glued: 0, disorder: 0 }
    assert.deepEqual({ outcomes, toModule }, { outcomes: { confirmed: COUNT }, toModule: all })
    assert.deepEqual(toUs, { ...all, damaged: 0 })
    // the line was as bad as it should be
    assert.ok(stats.naksOut > COUNT / 20 && stats.naksIn > COUNT / 20 && stats.repeats > 2, JSON.stringify(stats))
  })

  it('bidirectional, with the defaults: nothing is doubled, what may be lost is told', async () => {
    const peer = { protocol: 'bidirectional', ackTimeout: 1500, timer0: 160 }
    const { outcomes, toModule, toUs } = await c24Messages({
      count: COUNT / 4,
      seed: 2,
      wear: WEAR,
      port: { bidirectional: true, priority: 'both' },
      peer
    })
    assert.deepEqual([toModule.doubled, toModule.wrong, toUs.doubled, toUs.wrong], [0, 0, 0, 0])
    // each message that did not come had an outcome that says so
    assert.ok(toModule.lost <= COUNT / 4 - outcomes.confirmed)
    assert.ok(outcomes.unknown > 0 && outcomes.confirmed > COUNT / 5, JSON.stringify(outcomes))
  })

  it('free messages with silence between them: none glued, none doubled, what stops is told', async () => {
    const { outcomes, toModule, toUs } = await c24Messages({ count: COUNT / 2, seed: 3, wear: WEAR, ...APART })
    assert.deepEqual(outcomes, { sent: COUNT / 2 })
    assert.deepEqual([toModule.glued, toUs.glued, toModule.doubled, toUs.doubled], [0, 0, 0, 0])
    // nothing checks a message: a damaged character in a whole one is not seen, as theory says
    const theory = freeTheory(COUNT / 2)
    near(toModule.wrong, theory.hit)
    near(toModule.lost, theory.hit)
    near(toUs.wrong, theory.unseen)
    near(toUs.damaged, theory.seen)
    near(toUs.lost, theory.hit)
  })

  it('free messages without silence: a damaged end code glues two of them', async () => {
    const { toModule } = await c24Messages({ count: COUNT / 4, seed: 4, wear: WEAR, ...CLOSE })
    assert.ok(toModule.glued > 0)
  })
})
