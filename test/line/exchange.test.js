'use strict'

const assert = require('node:assert/strict')
const { PRIORITY } = require('../../lib/line')
const { Echo } = require('../../lib/line/echo')
const { Exchange } = require('../../lib/line/exchange')
const { CHARACTER, createBench, failure } = require('./support/bench')
const { createLateClock } = require('./support/late-clock')
const toy = require('./support/toy')

const answering =
  (data = [7]) =>
  (bytes, wire) =>
    wire.reply(toy.answer(bytes[1], data, bytes[2]))

const near = (got, wanted, name) => assert.ok(Math.abs(got - wanted) < 0.01, `${name}: ${got}, wanted ${wanted}`)

/** Asks station 5 once; the wire answers with these pieces, `[ms after the query, hex]`. */
async function exchange(pieces, { settings, options } = {}) {
  const bench = createBench({
    settings,
    onQuery: (_, wire) => pieces.forEach(([after, hex]) => wire.reply(Buffer.from(hex, 'hex'), { after }))
  })
  const { lease, run, clock, wire } = bench
  const promise = lease.run(() => toy.ask(5, options), { station: 5 })
  const [result] = await run(Promise.allSettled([promise]))
  const ms = clock.now() - wire.queryEnd
  return { ...bench, ms, value: result.value, error: result.reason, stats: lease.line.stats() }
}

// 41 = answer, station 05, nonce 00, two bytes 01 02, sum 4b
const ANSWER = '4105000201024b'

describe('line: the answer', () => {
  it('is taken, and timed from the end of the query', async () => {
    const { value, stats } = await exchange([[5, ANSWER]])
    assert.deepEqual(value, [1, 2])
    near(stats.stations[5].latency.mean, 5, 'latency')
    assert.deepEqual([stats.queries, stats.answers, stats.bytesOut, stats.bytesIn], [1, 1, 4, 7])
    near(stats.busy, 4 * CHARACTER + 5, 'busy')
  })

  for (let at = 1; at < 7; at++) {
    it(`is taken when it comes in two pieces, cut after ${at} bytes`, async () => {
      const { value } = await exchange([
        [5, ANSWER.slice(0, 2 * at)],
        [9, ANSWER.slice(2 * at)]
      ])
      assert.deepEqual(value, [1, 2])
    })
  }

  it('is taken after noise, another station and a wrong nonce', async () => {
    const { value, stats } = await exchange([[5, `00ff${'41060001074f'}${'41050301074f'}${ANSWER}`]])
    assert.deepEqual(value, [1, 2])
    assert.equal(stats.skippedBytes, 14)
  })

  it('takes the exact length; the rest is counted as stray', async () => {
    const { value, stats } = await exchange([[5, `${ANSWER}${ANSWER}99`]])
    assert.deepEqual(value, [1, 2])
    assert.equal(stats.strayBytes, 8)
  })

  it('may begin just before the timeout', async () => {
    const { value } = await exchange([
      [199, ANSWER.slice(0, 4)],
      [202, ANSWER.slice(4)]
    ])
    assert.deepEqual(value, [1, 2])
  })

  it('does not come: TIMEOUT, from the computed end of sending', async () => {
    const { error, ms, stats } = await exchange([])
    assert.equal(error.code, 'TIMEOUT')
    assert.deepEqual(error.details, { station: 5, timeout: 200, sent: true })
    near(ms, 200, 'waited')
    assert.equal(stats.timeouts, 1)
  })

  it('stops early: INCOMPLETE with the numbers, at once after the wire time and slack', async () => {
    const { error, ms, stats } = await exchange([[10, ANSWER.slice(0, 10)]])
    assert.equal(error.code, 'INCOMPLETE')
    assert.deepEqual(error.details, { station: 5, got: 5, expected: 7, sent: true })
    near(ms, 10 + 7 * CHARACTER + 50, 'waited')
    assert.equal(stats.incomplete, 1)
  })

  it('has the slack of the setting', async () => {
    const { ms } = await exchange([[10, ANSWER.slice(0, 10)]], { settings: { slack: 20 } })
    near(ms, 10 + 7 * CHARACTER + 20, 'waited')
  })

  it('is damaged: CRC_ERROR at once', async () => {
    const { error, ms, stats } = await exchange([[10, `${ANSWER.slice(0, -2)}00`]])
    assert.equal(error.code, 'CRC_ERROR')
    assert.deepEqual([error.details.sent, error.details.got], [true, `${ANSWER.slice(0, -2)}00`])
    near(ms, 10, 'waited')
    assert.equal(stats.crcErrors, 1)
  })

  it('of somebody else neither shortens nor prolongs the wait', async () => {
    const pieces = [10, 60, 110, 160, 199].map(ms => [ms, '410600010700'])
    const { error, ms } = await exchange(pieces)
    assert.equal(error.code, 'TIMEOUT')
    near(ms, 200, 'waited')
  })

  it('of unknown origin prolongs the wait by its wire time only', async () => {
    const { error, ms } = await exchange([
      [150, '41'],
      [230, '41'],
      [270, '41']
    ])
    assert.equal(error.code, 'TIMEOUT')
    assert.ok(ms >= 200 && ms < 320, `waited ${ms}`)
  })

  it('that would begin after the timeout is none, whatever prolonged the wait', async () => {
    const { error, ms } = await exchange([
      [199, '41'],
      [230, '9941']
    ])
    assert.equal(error.code, 'TIMEOUT')
    near(ms, 230, 'waited')
  })

  it('is looked for in a bounded buffer', async () => {
    const flood = Array.from({ length: 40 }, (_, i) => [5 + i, 'ff'.repeat(1000)])
    const { value } = await exchange([...flood, [50, ANSWER]])
    assert.deepEqual(value, [1, 2])
  })

  it('ends the run, not the process, if its recogniser throws', async () => {
    const { lease, run } = createBench({ onQuery: answering() })
    const broken = () => {
      throw new Error('broken')
    }
    const step = { send: Buffer.from([1]), match: broken, timeout: 50 }
    const error = await run(
      failure(
        lease.run(
          function* () {
            yield step
          },
          { station: 1 }
        )
      )
    )
    assert.equal(error.message, 'broken')
    assert.deepEqual(await run(lease.run(() => toy.ask(2), { station: 2 })), [7])
  })
})

describe('line: what is not a conversation', () => {
  const refused = [
    ['no bytes', { send: Buffer.alloc(0), match: () => ({ need: 1 }), timeout: 10 }, /bytes to send/],
    ['no timeout', { send: Buffer.from([1]), match: () => ({ need: 1 }) }, /timeout/],
    ['nothing', undefined, /bytes to send/]
  ]
  for (const [name, step, text] of refused) {
    it(`a step with ${name}`, async () => {
      const { lease, run, wire } = createBench()
      const make = function* () {
        yield step
      }
      assert.match((await run(failure(lease.run(make, { station: 1 })))).message, text)
      assert.equal(wire.sent.length, 0)
    })
  }

  it('a conversation that asks nothing just returns', async () => {
    const { lease, run } = createBench()
    // eslint-disable-next-line require-yield
    const make = function* () {
      return 'nothing to do'
    }
    assert.equal(await run(lease.run(make, { station: 1 })), 'nothing to do')
  })

  it('a maker that throws rejects', async () => {
    const { lease, run } = createBench()
    const make = () => {
      throw new RangeError('no')
    }
    assert.equal((await run(failure(lease.run(make, { station: 1 })))).message, 'no')
  })

  it('an unknown priority', async () => {
    const { lease, run } = createBench()
    assert.match((await run(failure(lease.run(() => toy.ask(1), { station: 1, priority: 9 })))).message, /priority/)
  })
})

describe('line: the gap', () => {
  const twice = async (settings, options = {}) => {
    const { lease, run, wire } = createBench({ settings, onQuery: answering() })
    await run(
      Promise.all(
        [1, 2].map(n => lease.run(() => toy.ask(n, options), { station: n, priority: PRIORITY.POLL, ...options.run }))
      )
    )
    return wire.sent[1].at - wire.sent[0].at - 4 * CHARACTER - 5
  }

  it('is 3.5 characters', async () => near(await twice({}), 3.5 * CHARACTER, 'gap'))
  it('is the setting', async () => near(await twice({ gap: 10 }), 10, 'gap'))
  it('is the larger one of the step', async () => near(await twice({ gap: 10 }, { gap: 30 }), 30, 'gap'))
  it('is the larger one of the run', async () => near(await twice({}, { run: { gap: 15 } }), 15, 'gap'))

  it('starts anew with every byte, and what came before the query is dropped', async () => {
    const { lease, run, wire, clock } = createBench({
      settings: { gap: 10 },
      onQuery: (bytes, w, n) => w.reply(toy.answer(bytes[1], [n]), { after: 5 })
    })
    await run(lease.run(() => toy.ask(1), { station: 1 }))
    wire.reply(Buffer.from(ANSWER, 'hex'), { after: 9 })
    const start = clock.now()
    assert.deepEqual(await run(lease.run(() => toy.ask(5), { station: 5 })), [2])
    near(wire.sent[1].at - start, 4 + 10, 'from the first answer')
    assert.equal(lease.line.stats().strayBytes, 7)
  })

  it('is kept after a frame whose asker went away in the middle of it', async () => {
    const { lease, run, wire, clock, open } = createBench({ settings: { baudRate: 300 }, onQuery: answering() })
    const other = open({ baudRate: 300 }, 'other')
    const character = 10000 / 300
    const first = failure(lease.run(() => toy.ask(1), { station: 1 }))
    await clock.advance(1)
    const second = other.run(() => toy.ask(2), { station: 2 })
    await lease.release()
    assert.equal((await first).code, 'LINE_CLOSED')
    wire.onQuery = answering([9])
    await run(second)
    assert.ok(wire.sent[1].at - wire.sent[0].at >= 4 * character + 3.5 * character - 0.01)
  })
})

describe('line: a jammed line', () => {
  const jam = async () => {
    const bench = createBench()
    const { clock, wire, lease } = bench
    await clock.advance(1)
    let on = true
    const babble = () => {
      if (!on) return
      wire.handlers.data(Buffer.alloc(16, 0xaa))
      clock.setTimer(babble, 1)
    }
    babble()
    const events = []
    lease.on('event', event => events.push(event.event))
    return { ...bench, events, stop: () => (on = false) }
  }

  it('is never sent into; requests end with LINE_JAMMED', async () => {
    const { clock, wire, lease, run, events } = await jam()
    const start = clock.now()
    const asked = [1, 2].map(n => failure(lease.run(() => toy.ask(n), { station: n })))
    const errors = await run(Promise.all(asked))
    assert.deepEqual(
      errors.map(e => [e.code, e.details.sent]),
      [
        ['LINE_JAMMED', false],
        ['LINE_JAMMED', false]
      ]
    )
    assert.ok(clock.now() - start >= 1000 && clock.now() - start < 1003)
    // 16 each ms
    for (const { details } of errors) assert.ok(details.bytes === 0 || Math.abs(details.bytes - 16000) < 50)
    assert.ok(errors[0].details.bytes > 0)
    assert.equal(wire.sent.length, 0)
    assert.equal(lease.line.state, 'jammed')
    assert.deepEqual(events, ['jammed'])
    const at = clock.now()
    assert.equal((await run(failure(lease.run(() => toy.ask(3), { station: 3 })))).code, 'LINE_JAMMED')
    assert.equal(clock.now(), at)
    await run(lease.release())
  })

  it('goes on by itself when it is silent again', async () => {
    const { clock, wire, lease, run, stop } = await jam()
    await run(failure(lease.run(() => toy.ask(1), { station: 1 })))
    await clock.advance(5000)
    assert.equal(lease.line.state, 'jammed')
    stop()
    await clock.advance(30)
    assert.equal(lease.line.state, 'open')
    wire.onQuery = answering()
    assert.deepEqual(await run(lease.run(() => toy.ask(1), { station: 1 })), [7])
    assert.ok(lease.line.trace().length < 20, 'the flood is one row of the trace')
    await run(lease.release())
    assert.equal(clock.pending(), 0)
  })
})

describe('line: sending', () => {
  it('that the port does not take ends with WRITE_STALLED, and the port is opened anew', async () => {
    const opened = []
    const stalling = () => {
      const transport = {
        open: handlers => {
          opened.push(transport)
          transport.handlers = handlers
          handlers.opened()
        },
        write: (bytes, done) => {
          if (opened.length === 1) return
          done()
          transport.handlers.data(toy.answer(bytes[1], [3]))
        },
        hint: () => {},
        close: done => done(),
        id: () => 'stalling'
      }
      return transport
    }
    const { lease, run, clock } = createBench({ transports: { simulated: stalling } })
    const start = clock.now()
    const error = await run(failure(lease.run(() => toy.ask(1), { station: 1 })))
    assert.equal(error.code, 'WRITE_STALLED')
    assert.equal(error.details.sent, true)
    near(clock.now() - start, 4 * CHARACTER + 1000, 'noticed after')
    assert.equal((await run(failure(lease.run(() => toy.ask(1), { station: 1 })))).code, 'WRITE_STALLED')
    await clock.advance(300)
    assert.equal(opened.length, 2)
    assert.deepEqual(await run(lease.run(() => toy.ask(1), { station: 1 })), [3])
    // what the port that was given up still says concerns nobody
    opened[0].handlers.data(Buffer.from([1, 2, 3]))
    opened[0].handlers.closed(null)
    assert.equal(lease.line.state, 'open')
    assert.equal(lease.line.stats().strayBytes, 0)
  })

  it('of a broadcast waits for the turnaround, and counts no timeout', async () => {
    const { lease, run, clock, wire } = createBench({ settings: { baudRate: 9600 } })
    const make = function* () {
      const nothing = yield { send: Buffer.from('0102', 'hex'), match: null, turnaround: 80 }
      return nothing.length
    }
    assert.equal(await run(lease.run(make, { station: 'all' })), 0)
    near(clock.now() - wire.sent[0].at, 2 * (10000 / 9600) + 80, 'waited')
    assert.equal(lease.line.stats().timeouts, 0)
    assert.equal(lease.line.stats().answers, 0)
  })

  it('tells the transport before when nobody needs to read', async () => {
    const hints = []
    const bench = createBench({
      transports: {
        simulated: (settings, clock) => ({
          ...require('../../lib/line/transports/memory').simulated(settings, clock),
          hint: (count, at) => hints.push([count, at])
        })
      },
      onQuery: (_, w) => {
        w.reply(Buffer.from(ANSWER.slice(0, 10), 'hex'), { after: 5 })
        w.reply(Buffer.from(ANSWER.slice(10), 'hex'), { after: 8 })
      }
    })
    await bench.run(bench.lease.run(() => toy.ask(5), { station: 5 }))
    const end = bench.wire.queryEnd
    assert.equal(hints.length, 2)
    // the shortest answer has 5 bytes
    assert.equal(hints[0][0], 5)
    near(hints[0][1], end + 5 * CHARACTER, 'first')
    // 5 of 7 are there
    assert.equal(hints[1][0], 2)
    near(hints[1][1], end + 5 + 2 * CHARACTER, 'second')
  })

  it('where we hear ourselves the answer is awaited behind our own bytes', async () => {
    const hints = []
    const bench = createBench({
      settings: { echo: 'on' },
      transports: {
        simulated: (settings, clock) => ({
          ...require('../../lib/line/transports/memory').simulated(settings, clock),
          hint: (count, at) => hints.push([count, at])
        })
      },
      onQuery: (query, w) => {
        w.reply(query.subarray(0, 3), { after: 1 })
        w.reply(query.subarray(3), { after: 2 })
        w.reply(Buffer.from(ANSWER, 'hex'), { after: 8 })
      }
    })
    await bench.run(bench.lease.run(() => toy.ask(5), { station: 5 }))
    const end = bench.wire.queryEnd
    assert.deepEqual(
      hints.map(([count]) => count),
      [9, 6, 5]
    )
    // our own bytes come while we send
    near(hints[0][1], end + 5 * CHARACTER, 'all')
    near(hints[1][1], end + 1 + 6 * CHARACTER, 'behind a part of them')
    near(hints[2][1], end + 2 + 5 * CHARACTER, 'behind them')
  })
})

describe('line: one step after the other, and the timer that is left', () => {
  it('of an answered step ends nothing, whenever the next one comes', async () => {
    for (let pause = 0; pause < 420; pause += 7) {
      const { lease, run, clock, wire } = createBench({
        onQuery: (bytes, w) => w.reply(toy.answer(bytes[1], [bytes[2]], bytes[2]), { after: 150 })
      })
      const ask = (nonce, gap = 0) => run(lease.run(() => toy.ask(5, { nonce, timeout: 200 }), { station: 5, gap }))
      await ask(1)
      await clock.advance(pause)
      assert.deepEqual(await ask(2, 100), [2], `${pause} ms later`)
      wire.onQuery = () => {}
      assert.equal((await failure(ask(3))).code, 'TIMEOUT')
      near(clock.now() - wire.queryEnd, 200, `${pause} ms later`)
    }
  })

  it('serves the next ones: steps that are answered in time need one timer a timeout, and a line that is closed has none', async () => {
    const { lease, run, clock } = createBench({
      onQuery: (bytes, w) => w.reply(toy.answer(bytes[1], [bytes[1]], bytes[2]), { after: 5 })
    })
    await run(lease.run(() => toy.ask(5, { timeout: 1000 }), { station: 5 }))
    const { setTimer } = clock
    let long = 0
    clock.setTimer = (fn, ms, ...more) => {
      if (ms > 500) long++
      return setTimer(fn, ms, ...more)
    }
    const from = clock.now()
    for (let n = 0; n < 100; n++) await run(lease.run(() => toy.ask(5, { timeout: 1000 }), { station: 5 }))
    assert.ok(clock.now() - from < 2000, `${clock.now() - from}`)
    assert.ok(long <= 2, `${long} timers`)
    await run(lease.release())
    assert.equal(clock.pending(), 0)
  })
})

describe('line: one step, in a process that is late', () => {
  const STEP = { send: Buffer.from('query'), match: toy.answerTo(5, 0), timeout: 200 }
  const start = ({
    step = STEP,
    gap = 0,
    character = 1,
    waiting = false,
    before = '',
    fault = /** @type {any} */ (undefined),
    told = /** @type {any[] | null} */ (null)
  } = {}) => {
    const clock = createLateClock()
    const ended = []
    const log = []
    const link = {
      name: 'mill',
      write: (_, done) => {
        log.push('written')
        if (told) told.push(done)
        else done(fault)
      },
      hint: () => {},
      waiting: () => waiting,
      stray: () => {},
      skipped: () => {},
      echoed: () => {}
    }
    const times = { character, slack: 50, gap: 0 }
    const settings = { writeTimeout: 1000, jamTime: 1000 }
    const one = new Exchange({ clock, settings, times, echo: new Echo('off', clock.now), link })
    const done = (error, answer, facts) => {
      log.push('ended')
      ended.push([error?.code ?? answer.toString('hex'), facts])
    }
    const noted = () => log.push('noted')
    if (before) one.data(Buffer.from(before, 'hex'))
    one.start(step, { gap, station: 5, sent: () => log.push('sent'), noted, done })
    return { clock, one, ended, log, hear: hex => one.data(Buffer.from(hex, 'hex')) }
  }

  it('is told of before it goes out, and noted behind it; also one that cannot be written, before it ends', () => {
    assert.deepEqual(start().log, ['sent', 'written', 'noted'])
    const { log, ended } = start({ fault: Object.assign(new Error('EIO'), { code: 'PORT_GONE' }) })
    assert.deepEqual([log, ended[0][0]], [['sent', 'written', 'noted', 'ended'], 'PORT_GONE'])
  })

  it('a write that is told of late, or twice, does not touch the step behind it', () => {
    const told = []
    const { clock, one } = start({ told })
    one.abort()
    clock.wake(30)
    one.start(STEP, { gap: 0, station: 5, sent() {}, done() {} })
    const [first, second] = told
    second()
    const end = one.sendEnd
    clock.wake(60)
    first()
    second()
    assert.equal(one.sendEnd, end)
  })

  it('bytes count from when they came, not from when they are looked at', () => {
    const { clock, one } = start({ gap: 0 })
    clock.wake(30)
    one.data(Buffer.from('05', 'hex'), 28)
    assert.equal(one.quietSince, 28)
    clock.wake(31)
    one.data(Buffer.from('05', 'hex'))
    assert.equal(one.quietSince, 31)
  })

  it('a timeout seen up to 10 ms late is one; later, what came meanwhile gets as much time, 250 ms at most, once', () => {
    for (const [woken, due] of [
      [216, 227],
      [305, 405],
      [805, 1055]
    ]) {
      const { clock, ended } = start()
      clock.wake(204)
      assert.deepEqual([ended, clock.due()], [[], [205]])
      clock.wake(woken)
      assert.deepEqual([ended, clock.due()], [[], [due]])
      clock.wake(due + 400)
      assert.deepEqual([ended[0][0], clock.due()], ['TIMEOUT', []])
    }
    const { clock, ended } = start()
    clock.wake(215)
    assert.equal(ended[0][0], 'TIMEOUT')
  })

  it('an answer that is read then is taken; how long the station took, and the whole exchange', () => {
    const { clock, one, ended, hear } = start()
    clock.wake(305)
    clock.wake(310)
    hear(`${ANSWER}aabb`)
    const [[answer, { rest, sent, ms, wait, due }]] = ended
    assert.deepEqual([answer, rest.toString('hex'), sent, ms, wait, due], [ANSWER, 'aabb', true, 305, 298, 205])
    assert.deepEqual([one.abort(), clock.due()], [null, []])
  })

  it('what an answer takes on the wire is not the time of the station', () => {
    const { clock, ended, hear } = start({ character: 2 })
    clock.wake(100)
    hear(ANSWER)
    const { ms, wait } = ended[0][1]
    const bytes = ANSWER.length / 2
    assert.deepEqual([ms, wait], [90, 90 - 2 * bytes])
  })

  it('one that never went out says so: after a second of bytes, not a moment earlier', () => {
    const { clock, ended, hear } = start({ gap: 20, before: 'aa' })
    for (let at = 10; at < 1000; at += 10) {
      hear('aa')
      clock.wake(at)
    }
    assert.deepEqual(ended, [])
    hear('aa')
    clock.wake(1000)
    const [[code, { sent }]] = ended
    assert.deepEqual([code, sent], ['LINE_JAMMED', false])
  })

  it('a line on which nothing comes is not jammed, however long its silence is not seen', () => {
    const { clock, ended } = start({ gap: 20, waiting: true })
    for (let at = 20; at <= 3000; at += 20) clock.wake(at)
    assert.deepEqual(ended, [])
  })

  it('an answer that came faster than the wire: the station took no time', () => {
    const { clock, ended, hear } = start()
    clock.wake(6)
    hear(ANSWER)
    assert.deepEqual([ended[0][1].ms, ended[0][1].wait], [1, 0])
  })
})
