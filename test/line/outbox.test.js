'use strict'

const assert = require('node:assert/strict')
const { CHARACTER: FAST, createBench, failure } = require('./support/bench')
const { collect, toyFraming } = require('./support/framing')
const toy = require('./support/toy')

const CHARACTER = 10000 / 9600
const bytes = text => Buffer.from(text, 'latin1')
const says = ({ wire }, text) => wire.handlers.data(bytes(text))
const sentTexts = ({ wire }) => wire.sent.map(one => one.bytes.toString('latin1'))
const near = (got, expected) => assert.ok(Math.abs(got - expected) < 0.01, `${got} instead of ${expected}`)
const notes = ({ lease }) => lease.line.trace().map(({ dir, note }) => `${dir} ${note}`)

const opened = async ({ settings = {}, ...options } = {}) => {
  const bench = createBench({ settings: { baudRate: 9600, ...settings }, ...options })
  await bench.clock.advance(5000)
  return bench
}

/** A port of the test: what was written, what it says, and how often it was asked whether it is still there. */
const portOf = (takes = () => true) => {
  const port = { written: [], checks: [], handlers: /** @type {any} */ (null) }
  const transport = () => ({
    open: handlers => {
      port.handlers = handlers
      handlers.opened()
    },
    write: (sent, done) => {
      port.written.push(sent.toString('latin1'))
      if (takes(sent)) done()
    },
    hint: () => {},
    close: done => done(),
    id: () => 'port',
    check: what => port.checks.push(what)
  })
  return { port, transports: { simulated: transport, serial: transport } }
}

describe('line: what waits to go out', () => {
  it('a deadline ends the wait in the queue; the message on the wire and those behind go on', async () => {
    const bench = await opened()
    const t = bench.clock.now()
    const long = bench.lease.send(bytes('x'.repeat(100)))
    const late = failure(bench.lease.send(bytes('late;'), { deadline: 20 }))
    const last = bench.lease.send(bytes('last;'))
    const error = await bench.run(late)
    near(bench.clock.now(), t + 20)
    assert.deepEqual(error.details, { line: 'the line', limit: 20, sent: 0, of: 5 })
    await bench.run(Promise.all([long, last]))
    assert.deepEqual(sentTexts(bench), ['x'.repeat(100), 'last;'])
    near(bench.wire.sent[1].at, t + 100 * CHARACTER)
    near(bench.lease.line.stats().busy, 105 * CHARACTER)
  })

  it('says which line is full, jammed or stalled', async () => {
    const full = await opened({ settings: { queueLimit: 1 } })
    const rest = ['a;', 'b;'].map(text => full.lease.send(bytes(text)))
    assert.deepEqual((await failure(full.lease.send(bytes('c;')))).details, {
      line: 'the line',
      most: 1,
      sent: 0,
      of: 2
    })
    await full.run(Promise.all(rest))

    const stalled = await opened()
    collect(stalled.lease, { flow: 'dc', stallLimit: 100 })
    says(stalled, '\x13')
    const { details } = await stalled.run(failure(stalled.lease.send(bytes('a;'))))
    assert.deepEqual(details, { line: 'the line', limit: 100, sent: 0, of: 2 })

    const { port, transports } = portOf(() => false)
    const kept = createBench({ transports })
    const stuck = await kept.run(failure(kept.lease.send(bytes('ab'))))
    assert.deepEqual([stuck.code, stuck.details.line, port.written], ['WRITE_STALLED', 'the line', ['ab']])
    near(kept.clock.now(), 2 * FAST + 1000)
  })

  it('a flood is what comes while it waits, for a second, also where messages end in it', async () => {
    const bench = await opened()
    collect(bench.lease, { framing: toyFraming({ silence: 50 }), stallLimit: 10 })
    says(bench, 'before;')
    const sent = failure(bench.lease.send(bytes('a;'), { quiet: 5 }))
    const t = bench.clock.now()
    let said = 0
    while (bench.lease.line.state === 'open' && bench.clock.now() < t + 3000) {
      says(bench, said % 2 === 0 ? 'half ' : 'rest;')
      said++
      await bench.clock.advance(3)
    }
    const { code, details } = await sent
    assert.deepEqual([code, details.line, details.bytes], ['LINE_JAMMED', 'the line', 5 * said])
    assert.ok(bench.clock.now() - t >= 1000 && bench.clock.now() - t < 1010, `${bench.clock.now() - t}`)
    assert.deepEqual(sentTexts(bench), [])
  })

  it('where the other side needs a pause behind a torn message, what ends it goes out alone', async () => {
    const bench = await opened()
    collect(bench.lease, { torn: { first: bytes('\r\n'), apart: true } })
    const cut = failure(bench.lease.send(bytes('x'.repeat(50))))
    await bench.clock.advance(10)
    bench.wire.unplug()
    await cut
    await bench.clock.advance(1000)
    const t = bench.clock.now()
    await bench.run(bench.lease.send(bytes('next;'), { after: 40 }))
    assert.deepEqual(sentTexts(bench).slice(1), ['\r\n', 'next;'])
    near(bench.wire.sent[1].at, t)
    near(bench.wire.sent[2].at, t + 2 * CHARACTER + 40)
    assert.deepEqual(notes(bench).slice(-2), ['out torn', 'out '])
    await bench.run(bench.lease.send(bytes('later;')))
    assert.deepEqual(sentTexts(bench).slice(3), ['later;'])
  })

  it('a reply that came up inside a message goes out behind it, also after a stop and a go', async () => {
    const bench = await opened()
    collect(bench.lease, { flow: 'dc', reply: () => bytes('ACK') })
    const sent = bench.lease.send(bytes('x'.repeat(100)))
    await bench.clock.advance(1)
    says(bench, 'q;\x13')
    says(bench, '\x11')
    await bench.clock.advance(200)
    await bench.run(sent)
    assert.deepEqual(sentTexts(bench), ['x'.repeat(46), 'x'.repeat(46), 'x'.repeat(8), 'ACK'])
    assert.deepEqual(notes(bench).at(-1), 'out reply')
  })

  it('a port that takes no replies gets 16 of them, and no more', async () => {
    const { port, transports } = portOf(() => false)
    const bench = createBench({ transports })
    await bench.clock.advance(1)
    collect(bench.lease, { reply: () => bytes('ACK') })
    for (let n = 0; n < 40; n++) port.handlers.data(bytes('q;'))
    assert.equal(port.written.length, 16)
    await bench.run(bench.lease.release())
  })

  it('an answer is matched with its times; without one the port is asked whether it is still there', async () => {
    const { port, transports } = portOf()
    const bench = createBench({ transports })
    await bench.clock.advance(100)
    collect(bench.lease)
    const seen = []
    const match = (message, facts) => {
      seen.push(facts)
      return message.bytes.toString() === 'yes'
    }
    const sent = failure(bench.lease.send(bytes('ask;'), { match, timeout: 50 }))
    await bench.clock.advance(10)
    port.handlers.data(bytes('no;'))
    assert.deepEqual(seen, [{ since: 100, now: 110 }])
    assert.equal((await bench.run(sent)).code, 'TIMEOUT')
    assert.equal(port.checks.length, 1)
    assert.deepEqual([bench.lease.line.stats().timeouts, notes(bench).at(-1)], [1, 'in TIMEOUT'])
  })

  it('a message that never went out leaves no failure in the trace', async () => {
    const bench = await opened()
    collect(bench.lease)
    says(bench, 'x')
    await bench.run(failure(bench.lease.send(bytes('a;'), { quiet: 1000, deadline: 20 })))
    assert.deepEqual(notes(bench), [])
  })
})

describe('line: who listens', () => {
  const ask = lease => lease.run(() => toy.ask(1), { station: 1 })
  const refused = async lease => (await failure(ask(lease))).details

  it('a serial port is asked every 5 s whether it is still there, as long as somebody listens', async () => {
    const { port, transports } = portOf()
    const { clock, open, run, lease } = createBench({ transports })
    collect(lease)
    await run(lease.release())
    const serial = open({ transport: 'serial', path: 'port' })
    const listener = collect(serial)
    await clock.advance(20001)
    assert.deepEqual(port.checks, new Array(4).fill({ all: 0, known: 0 }))
    listener.close()
    assert.equal(clock.pending(), 0)
    collect(serial)
    await run(serial.release())
    assert.equal(clock.pending(), 0)
  })

  it('closing twice, and a second listener in the middle of a message, harm nobody', async () => {
    const bench = await opened()
    const first = collect(bench.lease)
    says(bench, 'half')
    const second = collect(bench.lease)
    first.close()
    first.close()
    says(bench, ' rest;next;')
    assert.deepEqual([first.texts, second.texts], [[], ['half rest', 'next']])
  })

  it('who has something to send uses the line, waiting or not; who has neither leaves it', async () => {
    const bench = await opened()
    const [other, third] = ['other', 'third'].map(name => bench.open({ baudRate: 9600 }, name))
    const mine = collect(bench.lease)
    const others = collect(other)
    mine.close()
    assert.equal((await refused(third)).other, 'other')
    const long = bench.lease.send(bytes('x'.repeat(50)))
    const queued = other.send(bytes('y;'))
    others.close()
    const again = collect(bench.lease)
    again.close()
    assert.equal((await refused(third)).reason, 'the one asks stations, the other listens to messages')
    assert.equal((await refused(bench.lease)).other, 'other', 'its letter waits')
    assert.equal((await refused(other)).other, 'reader', 'its letter is on the wire')
    await bench.run(Promise.all([long, queued]))
  })

  it('a splitter that throws when it is told to begin anew harms nothing', async () => {
    const bench = await opened()
    const framing = toyFraming()
    const create = () =>
      Object.assign(framing.create(), {
        reset: () => {
          throw new Error('mistake')
        }
      })
    const { texts, close } = collect(bench.lease, { framing: { key: 'bad', create } })
    bench.wire.unplug()
    await bench.clock.advance(1000)
    says(bench, 'a;')
    assert.deepEqual(texts, ['a'])
    close()
    assert.equal(bench.lease.line.state, 'open')
  })

  it('what a listener throws is kept in the trace, whatever it is; bytes that nobody hears are strays', async () => {
    const bench = await opened()
    for (const thrown of [new Error('mistake'), 'text', undefined]) {
      const { close } = collect(bench.lease, {
        reply: () => {
          throw thrown
        }
      })
      says(bench, 'a;')
      close()
    }
    const keeper = bench.lease.send(bytes('x'))
    says(bench, 'who?')
    await bench.run(keeper)
    assert.deepEqual(notes(bench), [
      'in ',
      'in a listener failed: mistake',
      'in ',
      'in a listener failed: text',
      'in ',
      'in a listener failed: undefined',
      'out ',
      'in stray'
    ])
  })

  it('a whole message proves the connection, a part of one does not', async () => {
    for (const [text, tries] of [
      ['a;', 250],
      ['a', 500]
    ]) {
      const bench = await opened()
      collect(bench.lease, { framing: toyFraming({ silence: 10 }) })
      bench.wire.unplug()
      await bench.clock.advance(400)
      assert.equal(bench.lease.line.state, 'open')
      says(bench, `${text}`)
      await bench.clock.advance(20)
      bench.wire.unplug()
      await bench.clock.advance(Number(tries) - 5)
      assert.notEqual(bench.lease.line.state, 'open')
      await bench.clock.advance(10)
      assert.equal(bench.lease.line.state, 'open', `${text}`)
    }
  })
})
