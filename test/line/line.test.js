'use strict'

const assert = require('node:assert/strict')
const { PRIORITY } = require('../../lib/line')
const { PlcError } = require('../../lib/error')
const { CHARACTER, createBench, failure } = require('./support/bench')
const toy = require('./support/toy')

const { WRITE, ASK, POLL } = PRIORITY
const answering = (bytes, wire) => wire.reply(toy.answer(bytes[1], [bytes[1]], bytes[2]))

describe('line: requests', () => {
  it('go one at a time, writes before asks before polls', async () => {
    const { lease, run, wire, clock } = createBench({ onQuery: answering })
    await clock.advance(1)
    const asked = [
      [1, POLL],
      [2, POLL],
      [3, ASK],
      [4, WRITE]
    ].map(([station, priority]) => lease.run(() => toy.ask(station), { station, priority }))
    await run(Promise.all(asked))
    assert.deepEqual(
      wire.sent.map(({ bytes }) => bytes[1]),
      [1, 4, 3, 2]
    )
  })

  it('with the same key that still wait are shared, and counted', async () => {
    const { lease, run, wire, open } = createBench({ onQuery: answering })
    const other = open({}, 'other')
    const poll = l => l.run(() => toy.ask(1), { station: 1, priority: POLL, key: 'M0' })
    const values = await run(Promise.all([poll(lease), poll(lease), poll(other)]))
    assert.deepEqual(values, [[1], [1], [1]])
    assert.equal(wire.sent.length, 1)
    assert.equal(lease.line.stats().overruns, 2)
    // one on the wire and one that waits
    const first = poll(lease)
    const rest = [poll(lease), poll(lease)]
    await run(Promise.all([first, ...rest]))
    assert.equal(wire.sent.length, 3)
  })

  it('with the same key of another station or class are not; writes never', async () => {
    const { lease, run, wire } = createBench({ onQuery: answering })
    const go = (station, priority) => lease.run(() => toy.ask(station), { station, priority, key: 'k' })
    await run(Promise.all([go(1, POLL), go(2, POLL), go(1, ASK), go(1, WRITE), go(1, WRITE)]))
    assert.equal(wire.sent.length, 5)
  })

  it('that are shared go on for the others when one leaves', async () => {
    const { lease, run, open } = createBench({ onQuery: answering })
    const other = open({}, 'other')
    const poll = l => l.run(() => toy.ask(1), { station: 1, priority: POLL, key: 'M0' })
    const mine = failure(poll(lease))
    const others = poll(other)
    await lease.release()
    assert.equal((await mine).code, 'LINE_CLOSED')
    assert.deepEqual(await run(others), [1])
  })

  it('on the wire go on for the others when one leaves; the wire is free as soon as nobody waits', async () => {
    const { clock, lease, open, run, wire } = createBench()
    const other = open({}, 'other')
    await clock.advance(1)
    const blocked = failure(lease.run(() => toy.ask(9, { timeout: 50 }), { station: 9 }))
    const asked = [lease, other].map(one =>
      one.run(() => toy.ask(1, { timeout: 5000 }), { station: 1, priority: POLL, key: 'a' })
    )
    asked[0].catch(() => {})
    await run(blocked)
    await clock.advance(10)
    assert.equal(wire.sent.length, 2)
    await lease.release()
    wire.handlers.data(toy.answer(1, [4]))
    assert.deepEqual(await run(asked[1]), [4])

    const third = open({}, 'third')
    const gone = failure(other.run(() => toy.ask(2, { timeout: 5000 }), { station: 2 }))
    const next = failure(third.run(() => toy.ask(3), { station: 3 }))
    await clock.advance(20)
    assert.equal(wire.sent.length, 3)
    await other.release()
    assert.equal((await gone).code, 'LINE_CLOSED')
    await clock.advance(20)
    assert.equal(wire.sent.length, 4)
    await run(next)
    await run(third.release())
  })

  it('that clear go out at once, and their station is free again if they were right', async () => {
    for (const right of [true, false, undefined]) {
      const { clock, lease, run, wire } = createBench()
      await clock.advance(1)
      const clearing = function* () {
        try {
          yield* toy.ask(1)
        } catch {
          wire.onQuery = (query, w) => right !== undefined && w.reply(toy.answer(1, [0], query[2]))
          const step = { send: toy.query(1, 7), match: toy.answerTo(1, 7), timeout: 50 }
          return yield { ...step, clears: () => right }
        }
      }
      await run(lease.run(clearing, { station: 1 }).catch(({ code }) => code))
      const from = wire.sent[0].at + 4 * CHARACTER + 200
      assert.ok(wire.sent[1].at < from + 5)
      wire.onQuery = (query, w) => w.reply(toy.answer(1, [3], query[2]))
      assert.deepEqual(await run(lease.run(() => toy.ask(1), { station: 1 })), [3])
      // one that was not answered makes it no longer
      const at = wire.sent[2].at
      assert.ok(right ? at < from + 100 : Math.abs(at - from - 1000) < 3, `${right}: ${at - from}`)
      await run(lease.release())
    }
  })

  it('that are too many end with QUEUE_FULL; none that waits is dropped', async () => {
    const { lease, run, clock } = createBench({ onQuery: answering, settings: { queueLimit: 3 } })
    await clock.advance(1)
    const write = n => lease.run(() => toy.ask(n), { station: n, priority: WRITE })
    const accepted = [1, 2, 3, 4].map(write)
    const error = await failure(write(5))
    assert.equal(error.code, 'QUEUE_FULL')
    assert.deepEqual(error.details, { line: 'the line', most: 3, sent: false })
    assert.deepEqual(await run(Promise.all(accepted)), [[1], [2], [3], [4]])
    assert.equal(lease.line.stats().queueFull, 1)
  })

  it('that wait longer than their deadline end with DEADLINE and are not sent', async () => {
    const { lease, run, clock, wire } = createBench()
    const slow = failure(lease.run(() => toy.ask(1, { timeout: 500 }), { station: 1 }))
    const start = clock.now()
    const error = await run(failure(lease.run(() => toy.ask(2), { station: 2, deadline: 100 })))
    assert.deepEqual([error.code, error.details.sent, clock.now() - start], ['DEADLINE', false, 100])
    assert.deepEqual([error.details.line, error.details.limit], ['the line', 100])
    await run(slow)
    assert.equal(wire.sent.length, 1)
    wire.onQuery = answering
    assert.deepEqual(await run(lease.run(() => toy.ask(3), { station: 3, deadline: 100 })), [3])
    await clock.advance(200)
    assert.equal(clock.pending(), 0)
  })

  it('several steps of one conversation are not torn apart', async () => {
    const { lease, run, wire } = createBench({ onQuery: answering })
    const two = function* () {
      yield* toy.ask(1, { nonce: 1 })
      return yield* toy.ask(1, { nonce: 2 })
    }
    const poll = lease.run(two, { station: 1, priority: POLL })
    const write = lease.run(() => toy.ask(1, { nonce: 3 }), { station: 1, priority: WRITE })
    await run(Promise.all([poll, write]))
    assert.deepEqual(
      wire.sent.map(({ bytes }) => bytes[2]),
      [3, 1, 2]
    )
  })
})

describe('line: who is told of an event may ask at once', () => {
  /** Two steps, one after the other. */
  function* twice(station) {
    const first = yield { send: toy.query(station, 1), match: toy.answerTo(station, 1), timeout: 200 }
    const second = yield { send: toy.query(station, 2), match: toy.answerTo(station, 2), timeout: 200 }
    return [first[4], second[4]]
  }

  it('a late answer behind the first of two steps: neither conversation takes the other one’s turn', async () => {
    const late = toy.answer(1, [66])
    const bench = createBench({
      onQuery: (bytes, wire, n) => {
        const answer = toy.answer(bytes[1], [n], bytes[2])
        // the first query is answered behind the answer to the second one
        if (n > 1) wire.reply(n === 2 ? Buffer.concat([answer, late]) : answer)
      }
    })
    const { lease, run } = bench
    const asked = []
    lease.on('event', () => asked.push(lease.run(() => toy.ask(3), { station: 3 })))
    assert.equal((await run(failure(lease.run(() => toy.ask(1), { station: 1 })))).code, 'TIMEOUT')
    assert.deepEqual(await run(lease.run(() => twice(2), { station: 2 })), [2, 3])
    assert.deepEqual(await run(Promise.all(asked)), [[4]])
  })

  it('nor where the conversation itself causes the event', async () => {
    const bench = createBench({ onQuery: (bytes, wire, n) => wire.reply(toy.answer(bytes[1], [n], bytes[2])) })
    const { lease, run } = bench
    function* telling() {
      lease.line.report({ event: 'test', station: 2 })
      const values = yield* twice(2)
      lease.line.report({ event: 'test', station: 2 })
      return values
    }
    const asked = []
    lease.on('event', () => asked.push(lease.run(() => toy.ask(3), { station: 3 })))
    assert.deepEqual(await run(lease.run(telling, { station: 2 })), [1, 2])
    assert.deepEqual(await run(Promise.all(asked)), [[3], [4]])
  })
})

describe('line: opening, losing, coming back', () => {
  const notFound = new PlcError('PORT_NOT_FOUND', { path: 'x' })

  it('a request waits for the first opening', async () => {
    const { lease, run } = createBench({ onQuery: answering })
    assert.equal(lease.line.state, 'opening')
    assert.deepEqual(await run(lease.run(() => toy.ask(1), { station: 1 })), [1])
  })

  it('but no longer than the grace', async () => {
    const never = () => ({ open: () => {}, write: () => {}, hint: () => {}, close: done => done(), id: () => 'x' })
    const { lease, run, clock } = createBench({ transports: { simulated: never } })
    const error = await run(failure(lease.run(() => toy.ask(1), { station: 1 })))
    assert.equal(error.code, 'LINE_DOWN')
    assert.equal(clock.now(), 2000)
    assert.equal((await failure(lease.run(() => toy.ask(1), { station: 1 }))).code, 'LINE_DOWN')
    await run(lease.release())
    assert.equal(clock.pending(), 0)
  })

  it('what waits and what comes ends at once with the reason', async () => {
    const { lease, run, clock, wire } = createBench()
    wire.refuse = notFound
    const states = []
    lease.on('state', (state, reason) => states.push([state, reason?.code]))
    const error = await run(failure(lease.run(() => toy.ask(1), { station: 1 })))
    assert.equal(error.code, 'PORT_NOT_FOUND')
    assert.equal(error.cause, notFound)
    assert.equal(error.details.sent, false)
    assert.equal(clock.now(), 0)
    assert.equal((await failure(lease.run(() => toy.ask(1), { station: 1 }))).code, 'PORT_NOT_FOUND')
    assert.deepEqual(states, [['waiting', 'PORT_NOT_FOUND']])
  })

  for (const [what, error, wanted] of [
    ['a busy port', new PlcError('PORT_BUSY', { path: 'x' }), [0, 250, 750, 1750, 3750, 7750, 12750, 17750]],
    // to look whether a name is there costs nothing, and an adapter that was plugged in must not wait: each second
    ['an absent port', notFound, [0, 250, 750, 1750, 2750, 3750, 4750, 5750]],
    // the name is there a moment before its rights are
    ['a forbidden port', new PlcError('PORT_DENIED', { path: 'x' }), [0, 250, 750, 1750, 2750, 3750, 4750, 5750]]
  ]) {
    it(`tries ${what} again after a longer and longer time, with a fresh transport each time`, async () => {
      const times = []
      const made = []
      const absent = (_, clock) => {
        const transport = {
          open: handlers => {
            times.push(clock.now())
            made.push(transport)
            handlers.failed(error)
          },
          hint: () => {},
          close: done => done(),
          id: () => 'x'
        }
        return transport
      }
      const { clock, lease, run } = createBench({ transports: { simulated: absent } })
      await clock.advance(wanted.at(-1) + 100)
      assert.deepEqual(times, wanted)
      assert.equal(new Set(made).size, 8)
      await run(lease.release())
      assert.equal(clock.pending(), 0)
    })
  }

  it('an adapter that is plugged in after an hour is open within a second, also if its rights come late and another program looks at it first', async () => {
    const faults = [notFound]
    const port = (_, clock) => ({
      open: handlers => clock.setTimer(() => (faults[0] ? handlers.failed(faults[0]) : handlers.opened()), 1),
      hint: () => {},
      close: done => done(),
      id: () => 'x'
    })
    const { clock, lease, run } = createBench({ transports: { simulated: port }, random: () => 1 })
    await clock.advance(3600000)
    faults[0] = new PlcError('PORT_DENIED', { path: 'x' })
    await clock.advance(1010)
    faults[0] = new PlcError('PORT_BUSY', { path: 'x' })
    await clock.advance(1010)
    faults.length = 0
    // doubled once for the other program
    await clock.advance(1510)
    assert.equal(lease.line.state, 'open')
    await run(lease.release())
  })

  it('begins with the short delay again after an answer', async () => {
    const { clock, wire, run, lease } = createBench({ onQuery: answering })
    wire.refuse = notFound
    await clock.advance(1000)
    wire.refuse = null
    await clock.advance(1000)
    assert.equal(lease.line.state, 'open')
    await run(lease.run(() => toy.ask(1), { station: 1 }))
    wire.unplug()
    await clock.advance(255)
    assert.equal(lease.line.state, 'open')
  })

  it('varies the delays', async () => {
    for (const [random, expected] of [
      [0, 187.5],
      [0.999999, 312.5]
    ]) {
      const { wire, clock } = createBench({ random: () => random })
      wire.refuse = notFound
      await clock.advance(expected - 1)
      wire.refuse = null
      assert.equal(wire.connects, 0)
      await clock.advance(1.01)
      assert.equal(wire.connects, 1)
    }
  })

  it('a lost wire ends what is under way, and comes back by itself', async () => {
    const { lease, run, clock, wire } = createBench()
    const states = []
    lease.on('state', (state, reason) => states.push([state, reason?.code]))
    const asked = [1, 2].map(n => failure(lease.run(() => toy.askAgain(n), { station: n })))
    await clock.advance(50)
    wire.unplug()
    const errors = await run(Promise.all(asked))
    assert.deepEqual(
      errors.map(e => [e.code, e.details.sent]),
      [
        ['PORT_GONE', true],
        ['PORT_GONE', false]
      ]
    )
    assert.equal(clock.now(), 50)
    wire.onQuery = answering
    await clock.advance(260)
    assert.deepEqual(await run(lease.run(() => toy.ask(3), { station: 3 })), [3])
    assert.equal(lease.line.stats().reconnects, 1)
    assert.deepEqual(states, [
      ['open', undefined],
      ['waiting', 'PORT_GONE'],
      ['open', undefined]
    ])
  })

  it('a step in the pause before it has not been sent, and its station may be asked at once', async () => {
    const { lease, run, clock, wire } = createBench({ settings: { gap: 500 }, onQuery: answering })
    await clock.advance(1)
    await run(lease.run(() => toy.ask(1), { station: 1 }))
    const failed = failure(lease.run(() => toy.ask(2), { station: 2 }))
    await clock.advance(100)
    wire.unplug()
    const error = await run(failed)
    assert.deepEqual([error.code, error.details.sent], ['PORT_GONE', false])
    assert.equal(wire.sent.length, 1)
    assert.equal(lease.line.memory(2).until < clock.now(), true)
    await run(lease.release())
  })

  it('the conversation is told, and may give its own error', async () => {
    const { lease, run, clock, wire } = createBench()
    const make = function* () {
      try {
        yield* toy.ask(1)
      } catch (cause) {
        throw new PlcError('WRITE_UNKNOWN', { station: 1, item: 'M0', reason: cause.code, cause })
      }
    }
    const promise = failure(lease.run(make, { station: 1, priority: WRITE }))
    await clock.advance(20)
    wire.unplug()
    const error = await run(promise)
    assert.deepEqual([error.code, error.details.reason], ['WRITE_UNKNOWN', 'PORT_GONE'])
  })

  it('asks the transport after each timeout whether it is still there', async () => {
    const checks = []
    const { simulated } = require('../../lib/line/transports/memory')
    const checking = (settings, clock) => ({
      ...simulated(settings, clock),
      check: ({ all, known }) => checks.push([all, known])
    })
    const { lease, run, wire, clock } = createBench({ transports: { simulated: checking } })
    for (const n of [1, 2, 3]) await run(failure(lease.run(() => toy.ask(n), { station: n })))
    wire.onQuery = answering
    await run(lease.run(() => toy.ask(4), { station: 4 }))
    wire.onQuery = () => {}
    for (const n of [5, 4]) await run(failure(lease.run(() => toy.ask(n), { station: n })))
    wire.unplug()
    await clock.advance(300)
    await run(failure(lease.run(() => toy.ask(4), { station: 4 })))
    // in a row, and how many of them of stations that have answered since the line was opened
    assert.deepEqual(checks, [
      [1, 0],
      [2, 0],
      [3, 0],
      [1, 0],
      [2, 1],
      [3, 0]
    ])
  })

  it('an answer that comes too late ends the row: what brought it is there', async () => {
    const checks = []
    const { simulated } = require('../../lib/line/transports/memory')
    const checking = (settings, clock) => ({
      ...simulated(settings, clock),
      check: ({ all, known }) => checks.push([all, known])
    })
    const { lease, run, wire } = createBench({ transports: { simulated: checking } })
    wire.onQuery = bytes => wire.reply(toy.answer(bytes[1], [bytes[1]], bytes[2]), { after: 250 })
    for (const nonce of [1, 2, 3, 4]) {
      const asked = lease.run(() => toy.ask(4, { nonce, timeout: 200 }), { station: 4 })
      assert.equal((await run(failure(asked))).code, 'TIMEOUT')
    }
    assert.deepEqual(checks, [
      [1, 0],
      [1, 1],
      [1, 1],
      [1, 1]
    ])
  })

  it('a transport that goes when it is asked ends the run, which cannot be repeated', async () => {
    const { simulated } = require('../../lib/line/transports/memory')
    const going = (settings, clock) => {
      const transport = simulated(settings, clock)
      const state = {}
      return {
        ...transport,
        open: handlers => transport.open((state.handlers = handlers)),
        check: () => state.handlers.closed(new PlcError('PORT_GONE', { path: 'x' }))
      }
    }
    const { lease, run, wire } = createBench({ transports: { simulated: going } })
    const error = await run(failure(lease.run(() => toy.askAgain(1), { station: 1 })))
    assert.equal(error.code, 'PORT_GONE')
    assert.equal(wire.sent.length, 1)
  })
})

describe('line: trace', () => {
  it('keeps the last 200 frames, oldest first', async () => {
    const { lease, run } = createBench({ onQuery: answering })
    for (let n = 0; n < 150; n++) await run(lease.run(() => toy.ask(1, { nonce: n }), { station: 1, label: `n${n}` }))
    const rows = lease.line.trace()
    assert.equal(rows.length, 200)
    assert.deepEqual({ ...rows[0], t: 0 }, { t: 0, dir: 'out', station: 1, bytes: '51013284', note: 'n50' })
    assert.deepEqual({ ...rows[199], t: 0 }, { t: 0, dir: 'in', station: 1, bytes: '4101950101d9', note: '' })
    assert.ok(rows[199].t > Date.UTC(2024, 0, 1))
  })

  it('shows what was skipped, stray, damaged, late', async () => {
    const { lease, run } = createBench({
      onQuery: (_, wire) => wire.reply(Buffer.from('ff4101000107ff0102', 'hex'))
    })
    await run(failure(lease.run(() => toy.ask(1), { station: 1 })))
    assert.deepEqual(
      lease.line.trace().map(({ note, bytes }) => `${note} ${bytes}`),
      [' 51010052', 'skipped ff', 'CRC_ERROR 4101000107ff', 'stray 0102']
    )
  })
})
