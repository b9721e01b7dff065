'use strict'

const assert = require('node:assert/strict')
const { CHARACTER, createBench, failure } = require('./support/bench')
const { collect, toyFraming } = require('./support/framing')
const toy = require('./support/toy')

const near = (got, expected) => assert.ok(Math.abs(got - expected) < 0.01, `${got} instead of ${expected}`)
const bytes = text => Buffer.from(text, 'latin1')
const says = (bench, text) => bench.wire.handlers.data(bytes(text))
const starts = ({ wire }) => wire.sent.map(({ at }) => at)
const sentTexts = ({ wire }) => wire.sent.map(one => one.bytes.toString('latin1'))

/** A bench whose port is open. */
const opened = async options => {
  const bench = createBench(options)
  await bench.clock.advance(1)
  return bench
}

describe('listening line: messages', () => {
  it('come whole, in order, however the bytes are split', async () => {
    const text = 'one;;two;+;?bad;end;'
    for (let at = 0; at <= text.length; at++) {
      const bench = await opened()
      const { texts } = collect(bench.lease)
      says(bench, text.slice(0, at))
      says(bench, text.slice(at))
      assert.deepEqual(texts, ['one', '', 'two', '+', '?bad', 'end'], `split at ${at}`)
    }
  })

  it('bear the time of the wall clock', async () => {
    const bench = await opened()
    const times = []
    collect(bench.lease, { reply: (_, { at }) => void times.push(at) })
    await bench.clock.advance(1234)
    says(bench, 'a;')
    assert.deepEqual(times, [bench.clock.wall()])
  })

  it('that stop are given away after the silence of the framing, not before, and once', async () => {
    const bench = await opened()
    const { texts } = collect(bench.lease, { framing: toyFraming({ silence: 200 }) })
    says(bench, 'to')
    await bench.clock.advance(150)
    says(bench, 'rn')
    await bench.clock.advance(199)
    assert.deepEqual(texts, [])
    await bench.clock.advance(2)
    assert.deepEqual(texts, ['torn…'])
    await bench.clock.advance(1000)
    says(bench, 'next;')
    assert.deepEqual(texts, ['torn…', 'next'])
  })

  it('without such a silence wait for ever', async () => {
    const bench = await opened()
    const { texts } = collect(bench.lease)
    says(bench, 'a')
    await bench.clock.advance(100000)
    says(bench, 'b;')
    assert.deepEqual(texts, ['ab'])
    assert.equal(bench.clock.pending(), 0)
  })

  it('go to every listener of the line; one framing serves them all', async () => {
    const bench = await opened()
    const other = bench.open({}, 'other')
    const [one, two, three] = [collect(bench.lease), collect(bench.lease), collect(other)]
    says(bench, 'a;b')
    two.close()
    two.close()
    says(bench, ';c;')
    assert.deepEqual([one.texts, two.texts, three.texts], [['a', 'b', 'c'], ['a'], ['a', 'b', 'c']])
  })

  it('a listener or a splitter that throws harms nobody else', async () => {
    const bench = await opened()
    const throwing = () => {
      throw new Error('mine')
    }
    bench.lease.listen(toyFraming(), throwing)
    const { texts } = collect(bench.lease)
    says(bench, 'a;')
    assert.deepEqual(texts, ['a'])
    assert.ok(bench.lease.line.trace().some(({ note }) => note.includes('mine')))

    const second = await opened()
    const framing = toyFraming()
    const broken = { key: 'broken', create: () => ({ ...framing.create(), held: 0, push: throwing }) }
    second.lease.listen(broken, () => {})
    says(second, 'a;')
  })

  it('are given away as incomplete when the wire is lost, the line closed, or the last listener gone', async () => {
    const ends = [
      async bench => bench.wire.unplug(),
      bench => bench.run(bench.lease.release()),
      async (_, listener) => listener.close()
    ]
    for (const end of ends) {
      const bench = await opened()
      const listener = collect(bench.lease)
      says(bench, 'a;half')
      await end(bench, listener)
      assert.deepEqual(listener.texts, ['a', 'half…'])
      await bench.run(bench.lease.release())
      assert.deepEqual(listener.texts, ['a', 'half…'])
      assert.equal(bench.clock.pending(), 0)
    }
  })

  it('of a line that was reopened are not glued to what came before', async () => {
    const bench = await opened()
    const { texts } = collect(bench.lease)
    says(bench, 'head')
    bench.wire.unplug()
    await bench.clock.advance(1000)
    assert.equal(bench.lease.line.state, 'open')
    says(bench, 'tail;')
    assert.deepEqual(texts, ['head…', 'tail'])
  })

  it('are counted, and kept in the trace', async () => {
    const bench = await opened()
    collect(bench.lease, { framing: toyFraming({ silence: 10 }) })
    says(bench, 'a;?x;to')
    await bench.clock.advance(20)
    await bench.run(bench.lease.send(bytes('out;'), { label: 'recipe' }))
    const { messagesIn, damagedMessages, messagesOut, bytesIn, bytesOut, queries } = bench.lease.line.stats()
    assert.deepEqual(
      { messagesIn, damagedMessages, messagesOut, bytesIn, bytesOut, queries },
      {
        messagesIn: 3,
        damagedMessages: 2,
        messagesOut: 1,
        bytesIn: 7,
        bytesOut: 4,
        queries: 0
      }
    )
    const rows = bench.lease.line.trace().map(row => [row.dir, Buffer.from(row.bytes, 'hex').toString(), row.note])
    assert.deepEqual(rows, [
      ['in', 'a', ''],
      ['in', '?x', 'incomplete'],
      ['in', 'to', 'silent'],
      ['out', 'out;', 'recipe']
    ])
  })

  it('nobody listens: the bytes are strays', async () => {
    const bench = await opened()
    collect(bench.lease).close()
    says(bench, 'abc')
    assert.equal(bench.lease.line.stats().strayBytes, 3)
  })

  it('where the adapter hears itself, our own bytes are no message', async () => {
    const bench = await opened({ settings: { echo: 'on' } })
    const { texts } = collect(bench.lease)
    const sent = bench.lease.send(bytes('hello;'))
    says(bench, 'hel')
    says(bench, 'lo;hello;')
    await bench.run(sent)
    says(bench, 'hello;')
    assert.deepEqual(texts, ['hello', 'hello'])
    assert.equal(bench.lease.line.stats().echoes, 2)

    // one that is not heard costs nothing later on
    bench.lease.send(bytes('x;'))
    await bench.clock.advance(500)
    says(bench, 'x;')
    assert.deepEqual(texts, ['hello', 'hello', 'x'])

    // nor does one that is damaged
    bench.lease.send(bytes('abc;'))
    says(bench, 'aXc;')
    says(bench, 'bc;')
    assert.deepEqual(texts.slice(3), ['Xc', 'bc'])
  })
})

describe('listening line: sending', () => {
  it('one after the other in order; each resolves when its last byte has left', async () => {
    const bench = await opened()
    collect(bench.lease)
    const t = bench.clock.now()
    const results = await bench.run(Promise.all(['aa;', 'bbbb;', 'c;'].map(text => bench.lease.send(bytes(text)))))
    assert.deepEqual(sentTexts(bench), ['aa;', 'bbbb;', 'c;'])
    near(starts(bench)[1], t + 3 * CHARACTER)
    near(starts(bench)[2], t + 8 * CHARACTER)
    near(results[2].ms, 10 * CHARACTER)
    assert.deepEqual([results[0].answer, results[0].attempts], [null, 1])
  })

  it('keeps what it was given, whatever becomes of the buffer', async () => {
    const bench = await opened()
    const buffer = bytes('abc;')
    const both = [bench.lease.send(bytes('x;')), bench.lease.send(buffer)]
    buffer.fill(0)
    await bench.run(Promise.all(both))
    assert.deepEqual(sentTexts(bench), ['x;', 'abc;'])
  })

  it('nothing of ours goes out for a while after a message that asks for it', async () => {
    const bench = await opened()
    const t = bench.clock.now()
    bench.lease.send(bytes('a;'), { after: 50 })
    await bench.run(bench.lease.send(bytes('b;')))
    near(starts(bench)[1], t + 2 * CHARACTER + 50)
    // also after a pause
    await bench.clock.advance(10)
    bench.lease.send(bytes('c;'), { after: 50 })
    await bench.clock.advance(30)
    await bench.run(bench.lease.send(bytes('d;')))
    near(starts(bench)[3], starts(bench)[2] + 2 * CHARACTER + 50)
  })

  it('half duplex: waits for silence, never starts while bytes come', async () => {
    const bench = await opened()
    collect(bench.lease)
    says(bench, 'x')
    const sent = bench.lease.send(bytes('a;'), { quiet: 5 })
    let last = 0
    for (let n = 0; n < 10; n++) {
      await bench.clock.advance(3)
      says(bench, 'y')
      last = bench.clock.now()
      assert.equal(bench.wire.sent.length, 0)
    }
    await bench.run(sent)
    near(starts(bench)[0], last + 5)
    // and our own bytes are no silence
    await bench.run(bench.lease.send(bytes('b;'), { quiet: 5 }))
    near(starts(bench)[1], starts(bench)[0] + 2 * CHARACTER + 5)
  })

  it('half duplex: waits for the rest of a message, however it is delivered, or until it is torn', async () => {
    const bench = await opened()
    collect(bench.lease, { framing: toyFraming({ silence: 200 }) })
    says(bench, 'half')
    const sent = bench.lease.send(bytes('a;'), { quiet: 5 })
    // an adapter that delivers late
    await bench.clock.advance(20)
    assert.equal(bench.wire.sent.length, 0)
    says(bench, ' and rest;')
    await bench.run(sent)
    near(starts(bench)[0], 21 + 5)
    await bench.clock.advance(50)
    says(bench, 'torn')
    const t = bench.clock.now()
    // who does not wait for silence does not wait for this either
    await bench.run(bench.lease.send(bytes('b;')))
    near(starts(bench)[1], t)
    await bench.run(bench.lease.send(bytes('c;'), { quiet: 5 }))
    near(starts(bench)[2], t + 200 + 5)
  })

  it('into a flood nothing is sent: LINE_JAMMED, then it goes on', async () => {
    const bench = await opened()
    collect(bench.lease, { stallLimit: 500 })
    says(bench, 'y')
    const sent = failure(bench.lease.send(bytes('a;'), { quiet: 5 }))
    const t = bench.clock.now()
    while (bench.lease.line.state === 'open' && bench.clock.now() < t + 5000) {
      says(bench, 'y')
      await bench.clock.advance(3)
    }
    assert.equal(bench.lease.line.state, 'jammed')
    assert.ok(bench.clock.now() - t >= 1000)
    assert.equal(bench.wire.sent.length, 0)
    const error = await sent
    assert.deepEqual([error.code, error.details.sent, error.details.of], ['LINE_JAMMED', 0, 2])
    await bench.clock.advance(100)
    await bench.run(bench.lease.send(bytes('c;'), { quiet: 5 }))
    assert.deepEqual(sentTexts(bench), ['c;'])
  })

  it('the answer to a message goes out before all that waits, without waiting for silence', async () => {
    const bench = await opened()
    collect(bench.lease, { reply: ({ bytes: body }) => (body[0] === 0x71 ? bytes('ACK') : undefined) })
    collect(bench.lease, { reply: () => bytes('NAK') })
    const sent = ['a;', 'b;'].map(text => bench.lease.send(bytes(text), { quiet: 100 }))
    says(bench, 'q;')
    assert.deepEqual(sentTexts(bench), ['a;', 'ACK'])
    await bench.run(Promise.all(sent))
    says(bench, 'z;')
    assert.deepEqual(sentTexts(bench), ['a;', 'ACK', 'b;', 'NAK'])
    near(starts(bench)[2], 1 + 5 * CHARACTER + 100)
  })

  it('a message that answers one of ours is its result, and nobody else gets it', async () => {
    const bench = await opened()
    const { texts } = collect(bench.lease)
    const isAnswer = ({ kind }) => kind === 'ack' || kind === 'nak'
    const first = bench.lease.send(bytes('abc;'), { match: isAnswer, timeout: 100 })
    const second = bench.lease.send(bytes('d;'))
    await bench.clock.advance(50)
    assert.equal(bench.wire.sent.length, 1)
    says(bench, 'other;+;+;')
    const { answer, ms } = await bench.run(first)
    near(ms, 50)
    assert.equal(answer.kind, 'ack')
    await bench.run(second)
    assert.deepEqual(texts, ['other', '+'])
  })

  it('an answer that comes before the computed end of sending is kept until then', async () => {
    const bench = await opened()
    const { texts } = collect(bench.lease)
    const sent = bench.lease.send(bytes('abcdefgh;'), { match: ({ kind }) => kind === 'ack', timeout: 100 })
    says(bench, '+;+;')
    const { ms } = await bench.run(sent)
    near(ms, 9 * CHARACTER)
    assert.deepEqual(texts, ['+'])
  })

  it('no answer: TIMEOUT, from the end of sending on', async () => {
    const bench = await opened()
    collect(bench.lease)
    const t = bench.clock.now()
    const sent = failure(bench.lease.send(bytes('abc;'), { match: () => false, timeout: 100, label: 'recipe' }))
    const error = await bench.run(sent)
    near(bench.clock.now(), t + 4 * CHARACTER + 100)
    assert.deepEqual([error.code, error.details.sent, error.details.of], ['TIMEOUT', 4, 4])
    assert.match(error.message, /recipe/)
    assert.equal(bench.lease.line.stats().timeouts, 1)
  })

  it('a late answer is not taken for that of the next message', async () => {
    const bench = await opened()
    const { texts } = collect(bench.lease)
    const options = { match: ({ kind }) => kind === 'ack', timeout: 100 }
    const first = failure(bench.lease.send(bytes('a;'), options))
    const second = bench.lease.send(bytes('b;'), options)
    assert.equal((await bench.run(first)).code, 'TIMEOUT')
    await bench.clock.advance(500)
    assert.equal(bench.wire.sent.length, 1)
    says(bench, '+;')
    assert.deepEqual(sentTexts(bench), ['a;', 'b;'])
    await bench.clock.advance(50)
    says(bench, '+;')
    near((await bench.run(second)).ms, 651.04)
    assert.deepEqual(texts, [])
    assert.equal(bench.lease.line.stats().late, 1)
    // without a late one it goes on after a second
    const third = failure(bench.lease.send(bytes('c;'), options))
    await bench.run(third)
    const t = bench.clock.now()
    bench.lease.send(bytes('d;'))
    await bench.clock.advance(1010)
    near(starts(bench)[3], t + 1000)
  })

  it('a recogniser that throws ends its own message only', async () => {
    const bench = await opened()
    const { texts } = collect(bench.lease)
    const match = () => {
      throw new Error('mine')
    }
    const sent = failure(bench.lease.send(bytes('a;'), { match, timeout: 100 }))
    await bench.clock.advance(50)
    says(bench, 'x;')
    assert.equal((await sent).message, 'mine')
    await bench.run(bench.lease.send(bytes('b;')))
    assert.deepEqual(texts, ['x'])
  })

  it('the queue is bounded; a deadline ends the wait, also for silence', async () => {
    const bench = await opened({ settings: { queueLimit: 2 } })
    collect(bench.lease)
    says(bench, 'x')
    const first = failure(bench.lease.send(bytes('a;'), { quiet: 1000, deadline: 20 }))
    const rest = ['b;', 'c;'].map(text => bench.lease.send(bytes(text)))
    const error = await failure(bench.lease.send(bytes('dd;')))
    assert.deepEqual([error.code, error.details.sent, error.details.of], ['QUEUE_FULL', 0, 3])
    assert.equal(bench.lease.line.stats().waiting, 2)
    const late = await bench.run(first)
    near(bench.clock.now(), 21)
    assert.deepEqual([late.code, late.details.sent, late.details.of], ['DEADLINE', 0, 2])
    await bench.run(Promise.all(rest))
    assert.deepEqual(sentTexts(bench), ['b;', 'c;'])
    assert.equal(bench.lease.line.stats().queueFull, 1)
  })

  it('a deadline is for waiting, not for a message that goes out already', async () => {
    const bench = await opened()
    await bench.run(bench.lease.send(bytes('x'.repeat(100)), { deadline: 5 }))
  })

  it('refuses what cannot be sent', async () => {
    const { lease } = await opened()
    for (const wrong of [Buffer.alloc(0), 'text', null]) {
      assert.ok((await failure(lease.send(/** @type {any} */ (wrong)))) instanceof TypeError)
    }
    assert.ok((await failure(lease.send(bytes('a'), { match: () => true }))) instanceof TypeError)
    assert.throws(() => lease.listen(/** @type {any} */ ({}), () => {}), TypeError)
    assert.throws(() => lease.listen(toyFraming(), /** @type {any} */ (null)), TypeError)
  })

  it('waits for the first opening, and is refused at once while the line is down', async () => {
    const bench = createBench()
    const first = bench.lease.send(bytes('a;'))
    assert.equal(bench.wire.sent.length, 0)
    await bench.run(first)
    bench.wire.unplug()
    const error = await failure(bench.lease.send(bytes('b;')))
    assert.deepEqual([error.code, error.details.sent, error.details.of], ['PORT_GONE', 0, 2])
    await bench.clock.advance(1000)
    await bench.run(bench.lease.send(bytes('c;')))
    assert.deepEqual(sentTexts(bench), ['a;', 'c;'])
    assert.equal(bench.lease.line.stats().reconnects, 1)
  })
})

describe('listening line: who uses it', () => {
  const ask = lease => lease.run(() => toy.ask(1), { station: 1 })

  it('requests first: listening and sending are refused, both are named', async () => {
    const bench = await opened({ onQuery: (sent, wire) => wire.reply(toy.answer(sent[1], [1])) })
    await bench.run(ask(bench.lease))
    const other = bench.open({}, 'the C24')
    const check = error => {
      assert.equal(error.code, 'LINE_USE')
      for (const name of ['the C24', 'reader', 'the line']) assert.ok(error.message.includes(name), error.message)
      return true
    }
    assert.throws(() => other.listen(toyFraming(), () => {}), check)
    const error = await failure(other.send(bytes('abc')))
    check(error)
    assert.deepEqual([error.details.sent, error.details.of], [0, 3])
    await bench.run(ask(bench.lease))
    // who asked has gone: the line is free for messages
    await bench.run(bench.lease.release())
    other.listen(toyFraming(), () => {})
  })

  it('messages first: requests are refused until the last listener has gone', async () => {
    const bench = await opened({ onQuery: (sent, wire) => wire.reply(toy.answer(sent[1], [1])) })
    const listener = collect(bench.lease)
    const other = bench.open({}, 'the PLC')
    const error = await failure(ask(other))
    assert.deepEqual([error.code, error.details.sent], ['LINE_USE', false])
    for (const name of ['the PLC', 'reader']) assert.ok(error.message.includes(name), error.message)
    assert.equal(bench.wire.sent.length, 0)
    listener.close()
    assert.deepEqual(await bench.run(ask(other)), [1])
  })

  it('another framing, or another way of using the line, is refused', async () => {
    const bench = await opened({ settings: { baudRate: 9600 } })
    collect(bench.lease, { flow: 'dc' })
    const other = bench.open({ baudRate: 9600 }, 'other')
    const refused = (framing, options, reason) =>
      assert.throws(
        () => other.listen(framing, () => {}, options),
        error => error.code === 'LINE_USE' && error.message.includes(reason)
      )
    refused(toyFraming({ key: 'lines' }), { flow: 'dc' }, 'toy and lines')
    refused(toyFraming(), {}, 'flow dc and none')
    refused(toyFraming(), { flow: 'dc', transparent: 0x10 }, 'transparent')
    refused(toyFraming(), { flow: 'dc', torn: { wait: 5 } }, 'torn.wait 0 and 5')
    refused(toyFraming(), { flow: 'dc', torn: { first: bytes(';') } }, 'torn.first')
    other.listen(toyFraming(), () => {}, { flow: 'dc', torn: { wait: 0, first: null }, room: 64 })
    // who was refused does not keep the line from others
    await bench.run(Promise.all([bench.lease.release(), other.release()]))
    assert.equal(bench.clock.pending(), 0)
  })

  it('a released lease neither listens nor sends', async () => {
    const { lease, run } = await opened()
    await run(lease.release())
    assert.throws(
      () => lease.listen(toyFraming(), () => {}),
      error => error.code === 'LINE_CLOSED'
    )
    const error = await failure(lease.send(bytes('a')))
    assert.deepEqual([error.code, error.details.sent, error.details.of], ['LINE_CLOSED', 0, 1])
  })
})
