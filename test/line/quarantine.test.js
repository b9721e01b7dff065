'use strict'

const assert = require('node:assert/strict')
const { createPool } = require('../../lib/line')
const { Quarantine } = require('../../lib/line/quarantine')
const { simulated } = require('../../lib/line/transports/memory')
const { createVirtualClock } = require('../../lib/sim')
const { createBench, failure } = require('./support/bench')
const toy = require('./support/toy')

const near = (got, wanted, name) => assert.ok(Math.abs(got - wanted) < 0.01, `${name}: ${got}, wanted ${wanted}`)

/** `answers[station]` = [[ms after the query, data], …] of its first, second, … query; then at once. */
const stations = answers => {
  const asked = {}
  return (bytes, wire) => {
    const station = bytes[1]
    asked[station] = (asked[station] ?? 0) + 1
    const row = answers[station]?.[asked[station] - 1]
    if (row === null) return
    const [after, data] = row ?? [5, [100 + asked[station]]]
    wire.reply(toy.answer(station, data, bytes[2]), { after })
  }
}

const ask = ({ lease }, station, options) => lease.run(() => toy.ask(station, options), { station })

describe('line: quarantine', () => {
  it('a late answer never becomes the value of the next query', async () => {
    const bench = createBench({ onQuery: stations({ 1: [[350, [66]]] }) })
    assert.equal((await bench.run(failure(ask(bench, 1)))).code, 'TIMEOUT')
    assert.deepEqual(await bench.run(ask(bench, 1)), [102])
  })

  it('lasts max(timeout, 1 s) from the timeout', async () => {
    for (const [timeout, bound] of [
      [200, 1000],
      [3000, 3000]
    ]) {
      const bench = createBench({ onQuery: stations({ 1: [null] }) })
      await bench.run(failure(ask(bench, 1, { timeout })))
      const failed = bench.clock.now()
      await bench.run(ask(bench, 1, { timeout }))
      near(bench.wire.sent[1].at - failed, bound, 'from timeout to the next query')
    }
  })

  it('can be set for the line and for a run', async () => {
    for (const [settings, options] of [
      [{ latenessBound: 400 }, {}],
      [{}, { latenessBound: 400 }]
    ]) {
      const { lease, run, clock, wire } = createBench({ settings, onQuery: stations({ 1: [null] }) })
      await run(failure(lease.run(() => toy.ask(1), { station: 1, ...options })))
      const failed = clock.now()
      await run(lease.run(() => toy.ask(1), { station: 1, ...options }))
      near(wire.sent[1].at - failed, 400, 'from timeout to the next query')
    }
  })

  it('is the station’s: the others go on', async () => {
    const bench = createBench({ onQuery: stations({ 1: [null] }) })
    await bench.run(failure(ask(bench, 1)))
    const start = bench.clock.now()
    const waits = ask(bench, 1)
    for (let i = 0; i < 20; i++) await bench.run(ask(bench, 2))
    assert.ok(bench.clock.now() - start < 300)
    assert.equal(bench.lease.line.stats().stations[2].answers, 20)
    assert.deepEqual(await bench.run(waits), [102])
    assert.ok(bench.clock.now() - start >= 1000)
  })

  it('holds back the repeat of a conversation, which then goes on', async () => {
    const bench = createBench({ onQuery: stations({ 1: [null, null] }) })
    const promise = bench.lease.run(() => toy.askAgain(1), { station: 1 })
    const between = ask(bench, 2)
    await bench.run(between)
    assert.ok(bench.clock.now() < 300)
    assert.deepEqual(await bench.run(promise), [103])
    const [first, , second, third] = bench.wire.sent.map(({ at }) => at)
    assert.ok(second - first > 1200 && third - second > 1200)
  })

  it('gives the last failure at once', async () => {
    const bench = createBench({ onQuery: stations({ 1: [null, null, null] }) })
    const error = await bench.run(failure(bench.lease.run(() => toy.askAgain(1), { station: 1 })))
    assert.equal(error.code, 'TIMEOUT')
    assert.ok(bench.clock.now() < 3 * 205 + 2 * 1000)
  })

  it('keeps the station for the conversation that waits', async () => {
    const bench = createBench({ onQuery: stations({ 1: [null] }) })
    const first = bench.lease.run(() => toy.askAgain(1, { nonce: 1 }), { station: 1, priority: 2 })
    await bench.clock.advance(300)
    const write = bench.lease.run(() => toy.ask(1, { nonce: 2 }), { station: 1, priority: 0 })
    await bench.run(Promise.all([first, write]))
    assert.deepEqual(
      bench.wire.sent.map(({ bytes }) => bytes[2]),
      [1, 1, 2]
    )
  })

  it('keeps it also before others of the same class, which go on afterwards', async () => {
    const bench = createBench({ onQuery: stations({ 1: [null] }) })
    const first = bench.lease.run(() => toy.askAgain(1, { nonce: 1 }), { station: 1 })
    const others = [2, 3].map(nonce => bench.lease.run(() => toy.ask(1, { nonce }), { station: 1 }))
    await bench.run(Promise.all([first, ...others]))
    assert.deepEqual(
      bench.wire.sent.map(({ bytes }) => bytes[2]),
      [1, 1, 2, 3]
    )
  })

  it('ends with the conversation that keeps the station, also when it is given up', async () => {
    const bench = createBench({ onQuery: stations({ 1: [null] }) })
    const other = bench.open({}, 'other')
    const first = failure(bench.lease.run(() => toy.askAgain(1, { nonce: 1 }), { station: 1 }))
    const second = other.run(() => toy.ask(1, { nonce: 2 }), { station: 1 })
    await bench.clock.advance(500)
    await bench.lease.release()
    assert.deepEqual(await bench.run(second), [102])
    const error = await first
    assert.deepEqual([error.code, error.details.sent], ['LINE_CLOSED', true])
  })

  it('learns the lateness × 1.5, tells the user, and starts the silence anew', async () => {
    const bench = createBench({ onQuery: stations({ 1: [[1100, [66]]] }) })
    const events = []
    bench.lease.on('event', event => events.push(event))
    await bench.run(failure(ask(bench, 1)))
    await bench.run(ask(bench, 1))
    const [{ since, cause, remedy, bound, ...event }] = events
    assert.deepEqual(event, { event: 'late', station: 1, lateness: 900, timeout: 200, advice: 1700 })
    near(bound, 1350, 'bound')
    assert.equal(cause, 'Station 1 answers 900 ms after its timeout of 200 ms')
    assert.equal(remedy, 'Raise the timeout to 1700 ms.')
    assert.equal(bench.lease.line.stats().stations[1].advice, 1700)
    assert.ok(since > 0)
    near(
      bench.wire.sent[1].at - (bench.wire.sent[0].at + 4 / 1.92 + 1100),
      1350,
      'from the late answer to the next query'
    )
    assert.equal(bench.lease.line.stats().stations[1].late, 1)
    near(bench.lease.line.memory(1).bound, 1350, 'bound')
    assert.equal(bench.lease.line.trace().find(row => row.note === 'late').station, 1)
  })

  it('never learns to wait less', async () => {
    const bench = createBench({ onQuery: stations({ 1: [[1100, [66]], null, [250, [67]]] }) })
    for (let i = 0; i < 3; i++) await bench.run(failure(ask(bench, 1)))
    await bench.run(ask(bench, 1))
    near(bench.lease.line.memory(1).bound, 1350, 'bound')
  })

  it('sees a late answer between the frames of another station', async () => {
    const bench = createBench({ onQuery: stations({ 1: [[400, [66]]], 2: [[205, [67]]] }) })
    await bench.run(failure(ask(bench, 1)))
    assert.deepEqual(await bench.run(ask(bench, 2, { timeout: 1000 })), [67])
    assert.equal(bench.lease.line.stats().stations[1].late, 1)
  })

  it('sees the rest of an answer that was given up as incomplete', async () => {
    const bench = createBench({
      onQuery: (bytes, wire, n) => {
        const frame = toy.answer(1, [n, n, n])
        wire.reply(frame.subarray(0, 6), { after: 5 })
        wire.reply(frame.subarray(6), { after: n === 1 ? 300 : 6 })
      }
    })
    assert.equal((await bench.run(failure(ask(bench, 1)))).code, 'INCOMPLETE')
    assert.deepEqual(await bench.run(ask(bench, 1)), [2, 2, 2])
    assert.equal(bench.lease.line.stats().late, 1)
  })

  it('is not fooled by a duplicate in the same chunk', async () => {
    const twice = n => Buffer.concat([toy.answer(1, [n]), toy.answer(1, [n])])
    const bench = createBench({ onQuery: (bytes, wire, n) => n > 1 && wire.reply(twice(n)) })
    await bench.run(failure(ask(bench, 1)))
    assert.deepEqual(await bench.run(ask(bench, 1)), [2])
    assert.equal(bench.lease.line.stats().late, 0)
    assert.equal(bench.lease.line.stats().strayBytes, 6)
  })

  it('is not fooled by a duplicate: it teaches no lateness', async () => {
    const bench = createBench({
      onQuery: (bytes, wire, n) => {
        if (n === 1) return
        wire.reply(toy.answer(1, [n]), { after: 5 })
        wire.reply(toy.answer(1, [n]), { after: 40 })
      }
    })
    await bench.run(failure(ask(bench, 1)))
    assert.deepEqual(await bench.run(ask(bench, 1)), [2])
    await bench.clock.advance(100)
    assert.equal(bench.lease.line.stats().late, 0)
    assert.equal(bench.lease.line.memory(1).bound, 1000)
  })

  it('does not follow a damaged frame of full length: only the gap', async () => {
    const bench = createBench({
      onQuery: (bytes, wire, n) => {
        const frame = Buffer.from(toy.answer(1, [n]))
        if (n === 1) frame[4] ^= 1
        wire.reply(frame)
      }
    })
    assert.deepEqual(await bench.run(bench.lease.run(() => toy.askAgain(1), { station: 1 })), [2])
    assert.ok(bench.clock.now() < 30)
  })

  it('follows an opening of the port, for stations that were asked before only', async () => {
    const bench = createBench({ onQuery: stations({}) })
    await bench.run(ask(bench, 1))
    bench.wire.unplug()
    await bench.clock.advance(300)
    assert.equal(bench.lease.line.state, 'open')
    const start = bench.clock.now()
    await bench.run(ask(bench, 2))
    assert.ok(bench.clock.now() - start < 20)
    await bench.run(ask(bench, 1))
    assert.ok(bench.clock.now() - start > 900)
  })

  describe('before the first query to a station, where others may have asked before us', () => {
    const opened = (settings, wire) => {
      const clock = createVirtualClock()
      const serial = (_settings, itsClock) => simulated({ wire, path: 'a' }, itsClock)
      const pool = createPool({ clock, random: () => 0.5, transports: { serial } })
      const raw = { transport: 'serial', path: '/dev/a', baudRate: 19200, ...settings }
      return { clock, lease: pool.open(raw, { id: 'a', name: 'a' }) }
    }
    const silentUntil = async (settings, timeout) => {
      const sentAt = []
      const wire = {
        connect: ({ data }) => ({
          write(bytes) {
            sentAt.push(clock.now())
            clock.setTimer(() => data(toy.answer(bytes[1], [7])), 10)
          },
          close() {}
        })
      }
      const { clock, lease } = opened(settings, wire)
      const once = () => clock.run(lease.run(() => toy.ask(1, { timeout }), { station: 1 }))
      await once()
      await once()
      await clock.run(lease.release())
      return sentAt
    }

    it('the timeout of the query, for an older one may still be answered; then no more', async () => {
      const [first, second] = await silentUntil({}, 3000)
      near(first, 3000, 'from opening to the first query')
      assert.ok(second - first < 50)
    })

    it('a second at the least, or what the line is told', async () => {
      near((await silentUntil({}, 200))[0], 1000, 'short timeout')
      near((await silentUntil({ latenessBound: 40 }, 3000))[0], 40, 'setting')
    })
  })

  it('follows a run that was given up, until its answer has come', async () => {
    const bench = createBench({ onQuery: stations({ 1: [[400, [66]]] }) })
    const other = bench.open({}, 'other')
    const gone = failure(ask(bench, 1, { timeout: 1000 }))
    await bench.clock.advance(50)
    await bench.lease.release()
    assert.equal((await gone).details.sent, true)
    assert.deepEqual(await bench.run(other.run(() => toy.ask(1), { station: 1 })), [102])
    // its answer came in time: nothing else can come
    near(bench.wire.sent[1].at - bench.wire.sent[0].at, 4 / 1.92 + 400 + 3.5 / 1.92, 'from query to query')
    assert.equal(other.line.stats().late, 0)
  })

  it('lives with the wire: the bound survives a redeploy', async () => {
    const bench = createBench({ onQuery: stations({ 1: [[1100, [66]]] }) })
    await bench.run(failure(ask(bench, 1)))
    await bench.clock.advance(1000)
    await bench.run(bench.lease.release())
    const again = bench.open()
    near(again.line.memory(1).bound, 1350, 'bound')
    const start = bench.clock.now()
    await bench.run(again.run(() => toy.ask(1), { station: 1 }))
    near(bench.wire.sent[1].at - start, 1350, 'from opening to the first query')
  })

  it('bounds what it keeps', async () => {
    const bench = createBench({ onQuery: () => {} })
    for (let n = 0; n < 60; n++) await bench.run(failure(ask(bench, n, { timeout: 10 })))
    for (let i = 0; i < 200; i++) bench.wire.handlers.data(Buffer.alloc(500, 0x41))
    bench.wire.onQuery = stations({})
    assert.deepEqual(await bench.run(ask(bench, 100)), [101])
  })
})

describe('line: late answers of several stations', () => {
  const TIMES = { timeout: 200, latenessBound: 0 }
  const create = () => {
    const clock = createVirtualClock()
    const told = []
    const quarantine = new Quarantine({
      clock,
      memories: new Map(),
      late: ({ station, lateness }, frame) => told.push([station, lateness, frame.toString('hex')]),
      freed: () => told.push('freed'),
      hasPast: false
    })
    /** Asked now, and not answered until 200 ms later. */
    const unanswered = async (station, match) => {
      quarantine.asks(station, TIMES)
      const due = clock.now() + 200
      await clock.advance(200)
      quarantine.failed({ station, match, due, timeout: 200, seen: Buffer.alloc(0) })
    }
    return { clock, told, quarantine, unanswered }
  }
  const answer = (...bytes) => Buffer.from(bytes)
  /** Frames of two bytes that begin so. */
  const begins = first => bytes => (bytes[0] !== first ? { skip: 1 } : bytes.length < 2 ? { need: 2 } : { take: 2 })

  it('in one chunk are all seen, whatever their order', async () => {
    for (const [one, two] of [
      [1, 2],
      [2, 1]
    ]) {
      const { clock, told, quarantine, unanswered } = create()
      await unanswered(1, begins(1))
      await unanswered(2, begins(2))
      await clock.advance(100)
      quarantine.offer(answer(one, 0xaa, two, 0xbb))
      assert.deepEqual(told.map(([station]) => station).sort(), [1, 2])
    }
  })

  it('are seen in pieces, not before they are whole', async () => {
    const { clock, told, quarantine, unanswered } = create()
    await unanswered(1, () => ({ take: 4 }))
    await clock.advance(100)
    quarantine.offer(answer(1, 2))
    assert.deepEqual(told, [])
    quarantine.offer(answer(3, 4))
    assert.deepEqual(told, [[1, 100, '01020304']])
  })

  it('an answer of another station takes nothing from them, nor does one that is none of theirs', async () => {
    const any = bytes => (bytes.length < 2 ? { need: 2 } : { take: 2 })
    for (const [match, station, frame] of /** @type {[any, number, Buffer][]} */ ([
      [any, 2, answer(2, 0)],
      [begins(1), 1, answer(7, 0)]
    ])) {
      const { clock, told, quarantine, unanswered } = create()
      await unanswered(1, match)
      quarantine.answered(station, frame)
      await clock.advance(50)
      quarantine.offer(answer(1, 0xaa))
      assert.deepEqual(told, [[1, 50, '01aa']])
    }
  })

  it('an answer that is like theirs makes them unknown', async () => {
    const { clock, told, quarantine, unanswered } = create()
    await unanswered(1, begins(1))
    quarantine.answered(1, answer(1, 0xaa))
    await clock.advance(50)
    quarantine.offer(answer(1, 0xaa))
    assert.deepEqual(told, [])
  })

  it('one that comes when it was due is in time: the station is free', async () => {
    const { clock, told, quarantine, unanswered } = create()
    await unanswered(1, begins(1))
    const end = clock.now()
    quarantine.offer(answer(1, 0xaa))
    assert.deepEqual([told, quarantine.readyAt(1)], [['freed'], end])
  })

  it('older than what was answered since: here answers overtake each other', async () => {
    const overtaken = async (before, later) => {
      const { clock, quarantine, unanswered } = create()
      if (before) quarantine.cleared(1)
      await unanswered(1, begins(1))
      await clock.advance(later ?? 0)
      if (later !== null) quarantine.cleared(1)
      await clock.advance(50)
      quarantine.offer(answer(1, 0xaa))
      return quarantine.memory(1).overtaken
    }
    assert.deepEqual(
      [await overtaken(true, null), await overtaken(false, null), await overtaken(false, 0), await overtaken(true, 10)],
      [undefined, undefined, true, true]
    )
  })

  it('the end of a silence that is seen late gets a moment, also if it was asked for before; one that is seen in time does not', async () => {
    const { clock, quarantine, unanswered } = create()
    await unanswered(1, begins(1))
    const until = quarantine.readyAt(1)
    assert.equal(until, 1200)
    await clock.advance(1000 + 3)
    assert.equal(quarantine.readyAt(1), 1203 + 10)
    const other = create()
    await other.unanswered(1, begins(1))
    await other.clock.advance(1000)
    assert.equal(other.quarantine.readyAt(1), 1200)
    await other.clock.advance(50)
    assert.equal(other.quarantine.readyAt(1), 1200)
  })
})
