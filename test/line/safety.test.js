'use strict'

const assert = require('node:assert/strict')
const { PRIORITY } = require('../../lib/line')
const { createBench } = require('./support/bench')
const toy = require('./support/toy')

const SEED = Number(process.env.SEED ?? 20240501)

/** mulberry32 */
const randomFrom = seed => () => {
  seed = (seed + 0x6d2b79f5) | 0
  let t = Math.imul(seed ^ (seed >>> 15), 1 | seed)
  t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t
  return ((t ^ (t >>> 14)) >>> 0) / 4294967296
}

/**
 * A station whose answers do not tell which query they answer: `51 station address sum` → `41 station 00 04 counter sum`.
 * The counter of each query is known to the test: a value is right only if it is that of one's own query.
 */
const answers = (random, faults) => (bytes, wire, n) => {
  if (!faults.on) return wire.reply(toy.answer(bytes[1], counter(n)))
  const dice = random()
  const frame = Buffer.from(toy.answer(bytes[1], counter(n)))
  if (dice < 0.04) return
  if (dice < 0.1) return wire.reply(frame, { after: 200 + random() * 990 })
  if (dice < 0.13) return wire.reply(frame.subarray(0, 1 + Math.floor(random() * (frame.length - 1))))
  if (dice < 0.16) return wire.reply(Buffer.concat([frame, frame]))
  if (dice < 0.19) {
    frame[4 + Math.floor(random() * 4)] ^= 1 << Math.floor(random() * 8)
    return wire.reply(frame)
  }
  if (dice < 0.22) return wire.reply(Buffer.concat([Buffer.from([0xff, 0x00, 0x13]), frame]))
  if (dice < 0.25) return wire.reply(Buffer.concat([toy.answer(bytes[1] + 1, counter(0xffffffff)), frame]))
  if (dice < 0.255) return wire.unplug()
  const at = Math.floor(random() * frame.length)
  wire.reply(frame.subarray(0, at), { after: 5 })
  wire.reply(frame.subarray(at), { after: 5 + random() * 10 })
}

const counter = n => {
  const bytes = Buffer.alloc(4)
  bytes.writeUInt32BE(n >>> 0)
  return [...bytes]
}

describe(`line: seeded safety, SEED=${SEED}`, () => {
  const RUNS = 20000

  it(`${RUNS} exchanges with faults: no foreign value, each settled once; then all recovers`, async function () {
    this.timeout(30000)
    const random = randomFrom(SEED)
    const faults = { on: true }
    const bench = createBench({ random, onQuery: answers(random, faults), settings: { latenessBound: 1000 } })
    const { clock, wire, lease } = bench
    const tally = { good: 0, wrong: 0, failed: 0, settled: 0 }
    const ask = async station => {
      let mine = []
      const make = function* () {
        const step = toy.ask(station, { timeout: 200 })
        // the number of the query is the value that its answer must have
        const answer = yield { ...step.next().value }
        mine = [wire.asked[station]]
        return answer.readUInt32BE(4)
      }
      try {
        const value = await lease.run(make, { station, priority: station % 3 })
        tally[mine.includes(value) ? 'good' : 'wrong']++
      } catch (error) {
        assert.ok(error.code, error.stack)
        tally.failed++
      }
      tally.settled++
    }
    wire.asked = {}
    const { onQuery } = wire
    wire.onQuery = (bytes, w, n) => {
      wire.asked[bytes[1]] = n
      onQuery(bytes, w, n)
    }
    const reader = async station => {
      for (let i = 0; i < RUNS / 4; i++) {
        await ask(station)
        // while the line is down requests fail at once
        if (lease.line.state !== 'open') await new Promise(resolve => clock.setTimer(resolve, 100))
      }
    }
    await clock.run(Promise.all([10, 20, 30, 40].map(reader)))
    assert.deepEqual({ wrong: tally.wrong, settled: tally.settled }, { wrong: 0, settled: RUNS })
    assert.ok(tally.good > RUNS / 2, JSON.stringify(tally))
    faults.on = false
    const before = tally.good
    await clock.advance(6000)
    await clock.run(Promise.all([10, 20, 30, 40].map(ask)))
    assert.equal(tally.good, before + 4)
    await clock.run(lease.release())
    assert.equal(clock.pending(), 0)
    assert.ok(PRIORITY)
  })
})
