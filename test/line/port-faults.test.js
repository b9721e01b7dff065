'use strict'

const assert = require('node:assert/strict')
const { PlcError } = require('../../lib/error')
const { createPool } = require('../../lib/line')
const { createVirtualClock } = require('../../lib/sim/clock')
const { CHARACTER, createBench, failure } = require('./support/bench')
const { collect } = require('./support/framing')
const toy = require('./support/toy')

const bytes = text => Buffer.from(text, 'latin1')
const eio = () => new PlcError('PORT_ERROR', { path: 'p', reason: 'EIO' })

/** A line over a port whose writes are `write(bytes, done, port)`; `ports` has each port that was opened. */
const scripted = (write, options = {}) => {
  const ports = []
  const make = () => {
    const port = {
      sent: [],
      open: handlers => {
        ports.push(port)
        port.handlers = handlers
        handlers.opened()
      },
      write: (data, done) => {
        port.sent.push(data.toString('latin1'))
        write(data, done, port)
      },
      hint: () => {},
      close: done => done(),
      id: () => 'scripted'
    }
    return port
  }
  return { ...createBench({ transports: { simulated: make }, ...options }), ports }
}

const isFirst = (port, ports) => port === ports[0]
const ask = (bench, station = 1) => bench.lease.run(() => toy.ask(station), { station })
const answerLater = (data, done, port) => {
  done()
  setImmediate(() => port.handlers.data(toy.answer(data[1], [3])))
}

describe('line: faults of a port, requests', () => {
  const faults = {
    'says that it failed, at once': (data, done) => done(eio()),
    'says that it failed, later': (data, done) => setImmediate(done, eio()),
    throws: () => {
      throw new Error('EIO')
    },
    'throws no error at all': () => {
      throw 'EIO' // eslint-disable-line no-throw-literal
    }
  }
  for (const [name, fault] of Object.entries(faults)) {
    it(`one that ${name}: PORT_ERROR, and the port is opened anew`, async () => {
      const bench = scripted((data, done, port) =>
        isFirst(port, bench.ports) ? fault(data, done) : answerLater(data, done, port)
      )
      const error = await bench.run(failure(ask(bench)))
      assert.deepEqual([error.code, error.details.reason], ['PORT_ERROR', 'EIO'])
      await bench.clock.advance(1000)
      assert.equal(bench.ports.length, 2)
      assert.deepEqual(await bench.run(ask(bench, 2)), [3])
    })
  }

  it('one that says twice that it has taken the bytes, or says so and then fails, does no harm', async () => {
    const bench = scripted((data, done, port) => {
      done()
      done()
      setImmediate(() => {
        done(eio())
        port.handlers.data(toy.answer(data[1], [3]))
      })
    })
    assert.deepEqual(await bench.run(ask(bench)), [3])
    assert.deepEqual(await bench.run(ask(bench, 2)), [3])
    assert.equal(bench.ports.length, 1)
  })

  it('one that answers inside the call of write', async () => {
    const bench = scripted((data, done, port) => {
      port.handlers.data(toy.answer(data[1], [3]))
      done()
    })
    assert.deepEqual(await bench.run(ask(bench)), [3])
  })

  it('one that goes without a reason, or with any', async () => {
    for (const [said, reason] of [
      [null, 'the connection was closed'],
      [new Error('unplugged'), 'unplugged']
    ]) {
      const bench = scripted((data, done, port) => {
        done()
        setImmediate(() => port.handlers.closed(said))
      })
      const error = await bench.run(failure(ask(bench)))
      assert.deepEqual([error.code, error.details.reason], ['LINE_DOWN', reason])
    }
  })

  it('a conversation that throws on its way out harms nobody', async () => {
    const bench = createBench({ onQuery: () => {} })
    const stubborn = function* () {
      try {
        yield { send: toy.query(1), match: toy.answerTo(1), timeout: 500 }
      } finally {
        throw new Error('never') // eslint-disable-line no-unsafe-finally
      }
    }
    const running = failure(bench.lease.run(() => stubborn(), { station: 1 }))
    await bench.clock.advance(10)
    const closed = bench.lease.release()
    const error = await bench.run(running)
    assert.equal(error.code, 'LINE_CLOSED')
    await bench.run(closed)
  })
})

describe('line: what a recogniser may say', () => {
  const step = (match, more) => () =>
    (function* () {
      return yield { send: toy.query(1), match, timeout: 100, ...more }
    })()
  const answering = (answer, pieces = 1) => ({
    onQuery: (_, wire) => {
      const size = Math.ceil(answer.length / pieces)
      for (let n = 0; n < pieces; n++) wire.reply(answer.subarray(n * size, (n + 1) * size), { after: 5 + n })
    }
  })

  it('an answer that is longer than what has come is waited for', async () => {
    const bench = createBench(answering(bytes('ABCD'), 4))
    const match = got => (got.length === 0 ? { need: 1 } : { take: 4 })
    assert.equal(`${await bench.run(bench.lease.run(step(match), { station: 1 }))}`, 'ABCD')
  })

  it('one that needs no more than it has, or says nothing, is asked again with the next byte', async () => {
    for (const nothing of [{}, { need: 1 }]) {
      const bench = createBench(answering(bytes('ABCD'), 4))
      const match = got => (got.length === 4 ? { take: 4 } : nothing)
      assert.equal(`${await bench.run(bench.lease.run(step(match), { station: 1 }))}`, 'ABCD')
    }
  })

  it('what is damaged without a length is all that has come', async () => {
    const bench = createBench(answering(bytes('ABCD')))
    const match = got => (got.length === 0 ? { need: 1 } : { bad: 'sum' })
    const error = await bench.run(failure(bench.lease.run(step(match), { station: 1 })))
    assert.deepEqual([error.code, error.details.got], ['CRC_ERROR', '41424344'])
  })

  it('who waits for more than a line holds gets the last 4096 bytes', async () => {
    const flood = Buffer.concat([Buffer.alloc(5000, 1), Buffer.from([2])])
    const bench = createBench(answering(flood))
    let seen = 0
    const match = got => {
      seen = Math.max(seen, got.length)
      return got.at(-1) === 2 ? { take: got.length } : { need: 6000 }
    }
    assert.equal((await bench.run(bench.lease.run(step(match), { station: 1 }))).length, 4096)
    assert.equal(seen, 4096)
    assert.equal(bench.lease.line.stats().skippedBytes, 905)
  })

  it('without a turnaround a broadcast waits 100 ms', async () => {
    const bench = createBench()
    const start = bench.clock.now()
    await bench.run(bench.lease.run(step(null), { station: 0 }))
    assert.ok(Math.abs(bench.clock.now() - start - 100 - 4 * CHARACTER) < 5, `${bench.clock.now() - start}`)
  })
})

describe('line: a process that was busy', () => {
  /** A clock that can be late: what its timers see is `late` ms more. */
  const create = () => {
    const clock = createVirtualClock()
    const lazy = { ...clock, late: 0, now: () => clock.now() + lazy.late }
    const wire = { connect: handlers => ({ write: () => (wire.handlers = handlers), close() {} }) }
    const lease = createPool({ clock: lazy }).open({ transport: 'simulated', wire }, { id: 'a', name: 'a' })
    return { clock, lazy, wire, lease }
  }

  it('takes an answer that came in time and is read behind the end of the wait', async () => {
    const { clock, lazy, wire, lease } = create()
    const asked = lease.run(() => toy.ask(1), { station: 1 })
    await clock.advance(200)
    lazy.late = 80
    // the timer fires 80 ms late; the bytes lie in the buffer of the port
    await clock.advance(20)
    wire.handlers.data(toy.answer(1, [3]))
    assert.deepEqual(await clock.run(asked), [3])
  })

  it('but waits only once, and no longer than it was late', async () => {
    const { clock, lazy, lease } = create()
    const start = clock.now()
    const asked = failure(lease.run(() => toy.ask(1), { station: 1 }))
    await clock.advance(200)
    lazy.late = 80
    assert.equal((await clock.run(asked)).code, 'TIMEOUT')
    const took = clock.now() - start
    assert.ok(took > 270 && took < 300, `${took}`)
  })
})

describe('listening line: faults of a port', () => {
  const opened = async write => {
    const bench = scripted(write)
    await bench.clock.advance(1)
    return { ...bench, ...collect(bench.lease, { reply: () => bytes('ACK') }) }
  }

  it('a message that the port refuses, at once or later: its error, and the port is opened anew', async () => {
    for (const later of [false, true]) {
      const bench = await opened((data, done, port) => {
        if (!isFirst(port, bench.ports)) return done()
        return later ? void setImmediate(done, eio()) : done(eio())
      })
      const error = await bench.run(failure(bench.lease.send(bytes('abc;'))))
      assert.deepEqual([error.code, error.details.of], ['PORT_ERROR', 4])
      await bench.clock.advance(1000)
      assert.equal(bench.ports.length, 2, `${later}`)
      await bench.run(bench.lease.send(bytes('d;')))
      assert.deepEqual(bench.ports[1].sent, ['d;'])
    }
  })

  it('a port that says twice that it has taken a message', async () => {
    const bench = await opened((data, done) => {
      done()
      setImmediate(done)
      setImmediate(done, eio())
    })
    await bench.run(bench.lease.send(bytes('abc;')))
    await bench.run(bench.lease.send(bytes('def;')))
    assert.equal(bench.ports.length, 1)
  })

  it('an answer that the port refuses opens it anew; what an earlier port says of its answers concerns nobody', async () => {
    const refused = []
    const bench = await opened((data, done, port) => {
      if (isFirst(port, bench.ports)) refused.push(done)
      else done()
    })
    bench.ports[0].handlers.data(bytes('q;r;'))
    assert.deepEqual(bench.ports[0].sent, ['ACK', 'ACK'])
    refused[0](eio())
    assert.equal(bench.lease.line.state, 'waiting')
    await bench.clock.advance(1000)
    assert.equal(bench.ports.length, 2)
    refused[1](eio())
    assert.equal(bench.lease.line.state, 'open')
    await bench.clock.advance(1000)
    assert.equal(bench.ports.length, 2)
  })

  it('one that does not say that it has taken a message: WRITE_STALLED after the time for writing', async () => {
    const bench = await opened((data, done, port) => void (isFirst(port, bench.ports) || done()))
    const start = bench.clock.now()
    const error = await bench.run(failure(bench.lease.send(bytes('abc;'))))
    assert.deepEqual([error.code, error.details.sent], ['WRITE_STALLED', 3])
    const took = bench.clock.now() - start
    assert.ok(Math.abs(took - 4 * CHARACTER - 1000) < 1, `${took}`)
  })

  it('one that refuses what ends a torn message: the next one is not sent behind it', async () => {
    const refused = []
    const bench = scripted((data, done) => {
      if (`${data}` !== '\x18') return done()
      refused.push(`${data}`)
      done(eio())
    })
    await bench.clock.advance(1)
    collect(bench.lease, { torn: { wait: 0, first: bytes('\x18'), apart: true } })
    const torn = failure(bench.lease.send(bytes('x'.repeat(50))))
    await bench.clock.advance(5)
    bench.ports[0].handlers.closed(null)
    await torn
    const next = failure(bench.lease.send(bytes('next;')))
    const failed = await Promise.race([bench.run(next), bench.clock.advance(3000).then(() => null)])
    assert.ok(failed === null || failed.code)
    assert.ok(bench.ports.every(port => !port.sent.includes('next;') || port.sent[0] === '\x18'))
  })
})

describe('listening line: nobody listens', () => {
  it('a line that only sends: what comes is stray', async () => {
    const bench = createBench()
    await bench.run(bench.lease.send(bytes('abc;')))
    bench.wire.handlers.data(bytes('what?'))
    await bench.run(bench.lease.send(bytes('def;'), { quiet: 5 }))
    assert.equal(bench.lease.line.stats().strayBytes, 5)
  })

  it('a listener that closes another, one that throws no error, an answer without bytes', async () => {
    const bench = createBench()
    await bench.clock.advance(1)
    const closes = collect(bench.lease, {
      reply: () => {
        second.close()
        throw 'no error' // eslint-disable-line no-throw-literal
      }
    })
    const second = collect(bench.lease)
    const third = collect(bench.lease, { reply: () => Buffer.alloc(0) })
    bench.wire.handlers.data(bytes('a;'))
    assert.deepEqual([closes.texts, second.texts, third.texts], [['a'], [], ['a']])
    assert.deepEqual(bench.wire.sent, [])
    second.close()
    bench.wire.handlers.data(bytes('b;'))
    assert.deepEqual(
      [closes.texts, third.texts],
      [
        ['a', 'b'],
        ['a', 'b']
      ]
    )
  })

  it('bytes that wait to be looked at keep the wire busy: nothing is sent into them', async () => {
    const bench = scripted((data, done) => done())
    await bench.clock.advance(1)
    collect(bench.lease)
    const [port] = bench.ports
    port.waiting = true
    const sent = bench.lease.send(bytes('abc;'), { quiet: 20 })
    await bench.clock.advance(100)
    assert.deepEqual(port.sent, [])
    port.waiting = false
    await bench.run(sent)
    assert.deepEqual(port.sent, ['abc;'])
  })
})

describe('line: one who is told may act at once', () => {
  it('who releases the line inside an event harms nobody', async () => {
    for (const event of ['frame', 'event']) {
      const bench = createBench({ onQuery: (data, wire) => wire.reply(toy.answer(data[1], [3], data[2])) })
      let released = null
      bench.lease.line.on(event, () => (released ??= bench.lease.release()))
      bench.lease.line.on('state', () => {})
      const [result] = await bench.run(Promise.allSettled([ask(bench)]))
      assert.ok(result.status === 'fulfilled' || result.reason.code === 'LINE_CLOSED', event)
      await bench.run(released ?? bench.lease.release())
    }
  })
})
