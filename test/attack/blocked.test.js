'use strict'

const assert = require('node:assert')
const { createPool } = require('../../lib/line')
const { createVirtualClock } = require('../../lib/sim')
const { createWire } = require('../line/support/bench')
const toy = require('../line/support/toy')

/** What a process sees that is blocked from one time to another: its timers fire at the end, before what came is read. */
const blockedClock = (clock, { from, to }) => ({
  ...clock,
  setTimer(fn, ms) {
    const at = clock.now() + Math.max(0, ms)
    return clock.setTimer(fn, (at >= from && at < to ? to : at) - clock.now())
  }
})

describe('attack: a process that is blocked when a quarantine ends', () => {
  // seen over TCP with one fixed master ID and a flow that computed for 400 ms: M1 got the value of M0
  it('reads the late answer before it asks again', async () => {
    const clock = createVirtualClock()
    const wire = createWire(clock, (_bytes, { reply, sent }) => {
      // the answer to the first query comes within the bound, while nobody reads
      if (sent.length > 1) return reply.call(wire, toy.answer(1, [222]))
      clock.setTimer(() => wire.handlers.data(toy.answer(1, [111])), 1501)
    })
    const pool = createPool({ clock: blockedClock(clock, { from: 1100, to: 1500 }), random: () => 0.5 })
    const lease = pool.open({ transport: 'simulated', wire }, { id: 'a', name: 'a' })
    const first = lease.run(() => toy.ask(1), { station: 1 })
    await clock.run(assert.rejects(first, { code: 'TIMEOUT' }))
    assert.deepEqual(await clock.run(lease.run(() => toy.ask(1), { station: 1 })), [222])
    assert.equal(lease.line.stats().late, 1)
    await clock.run(lease.release())
  })
})

describe('attack: a process that is blocked while the gap before a query runs', () => {
  it('reads the duplicate of the last answer before it asks again', async () => {
    const clock = createVirtualClock()
    const wire = createWire(clock, (_bytes, { reply, sent }) => {
      if (sent.length > 1) return reply.call(wire, toy.answer(1, [222]))
      reply.call(wire, toy.answer(1, [111]))
      clock.setTimer(() => wire.handlers.data(toy.answer(1, [111])), 201)
    })
    const blocked = blockedClock(clock, { from: 10, to: 200 })
    const pool = createPool({ clock: blocked, random: () => 0.5 })
    const lease = pool.open({ transport: 'simulated', wire, gap: 20 }, { id: 'a', name: 'a' })
    assert.deepEqual(await clock.run(lease.run(() => toy.ask(1), { station: 1 })), [111])
    assert.deepEqual(await clock.run(lease.run(() => toy.ask(1), { station: 1 })), [222])
    await clock.run(lease.release())
  })
})
