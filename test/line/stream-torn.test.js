'use strict'

const assert = require('node:assert/strict')
const { createBench, failure } = require('./support/bench')
const { collect } = require('./support/framing')

const CHARACTER = 10000 / 9600
const bytes = text => Buffer.from(text, 'latin1')
const sentTexts = ({ wire }) => wire.sent.map(one => one.bytes.toString('latin1'))
const near = (got, expected) => assert.ok(Math.abs(got - expected) < 0.01, `${got} instead of ${expected}`)

const opened = async options => {
  const bench = createBench({ settings: { baudRate: 9600 } })
  await bench.clock.advance(1)
  return { ...bench, options, ...collect(bench.lease, options) }
}

/** A message that is cut off after 10 bytes; the wire comes back. */
const torn = async options => {
  const bench = await opened(options)
  const sent = failure(bench.lease.send(bytes('SET 125'.padEnd(40) + ';')))
  await bench.clock.advance(10 * CHARACTER + 0.1)
  bench.wire.unplug()
  const error = await sent
  return { ...bench, error, at: bench.clock.now() }
}

describe('listening line: torn messages', () => {
  it('are told with the bytes that went out by the time of the wire, and counted', async () => {
    const { error, lease } = await torn()
    assert.deepEqual([error.code, error.details.sent, error.details.of], ['PORT_GONE', 10, 41])
    assert.equal(lease.line.stats().tornWrites, 1)
  })

  it('the next message waits for a silence of ours, if that is wanted', async () => {
    for (const wait of [0, 5000]) {
      const bench = await torn({ torn: { wait } })
      await bench.clock.advance(1000)
      const result = bench.lease.send(bytes('next;'))
      const later = bench.lease.send(bytes('later;'))
      await bench.run(result)
      near(bench.wire.sent[1].at, wait === 0 ? bench.at + 1000 : bench.at + wait)
      // only the next one
      await bench.run(later)
      near(bench.wire.sent[2].at, bench.wire.sent[1].at + 5 * CHARACTER)
    }
  })

  it('what ends the torn one goes before the next, if that is wanted; it counts for none', async () => {
    const bench = await torn({ torn: { first: bytes('\r\n') } })
    await bench.clock.advance(1000)
    const result = failure(bench.lease.send(bytes('next;')))
    assert.deepEqual(sentTexts(bench).slice(1), ['\r\nnext;'])
    await bench.clock.advance(1.5 * CHARACTER)
    bench.wire.unplug()
    const error = await result
    // a byte that the port has got may be on its way
    assert.deepEqual([error.details.sent, error.details.of], [1, 5])
    // so it is torn still
    await bench.clock.advance(1000)
    await bench.run(bench.lease.send(bytes('third;')))
    await bench.run(bench.lease.send(bytes('fourth;')))
    assert.deepEqual(sentTexts(bench).slice(2), ['\r\nthird;', 'fourth;'])
    assert.equal(bench.lease.line.stats().tornWrites, 2)
  })

  it('are remembered over a redeploy', async () => {
    const bench = await torn({ torn: { wait: 5000, first: bytes('\r\n') } })
    await bench.run(bench.lease.release())
    const again = bench.open({}, 'again')
    collect(again, bench.options)
    await bench.run(again.send(bytes('next;')))
    near(bench.wire.sent[1].at, bench.at + 5000)
    assert.deepEqual(sentTexts(bench).slice(1), ['\r\nnext;'])
  })

  it('a message that had left, or had not begun, is not torn', async () => {
    const bench = await opened({ torn: { first: bytes('\r\n') } })
    const match = () => false
    const whole = failure(bench.lease.send(bytes('abc;'), { match, timeout: 1000 }))
    const waiting = failure(bench.lease.send(bytes('def;')))
    await bench.clock.advance(50)
    bench.wire.unplug()
    assert.deepEqual([(await whole).details.sent, (await waiting).details.sent], [4, 0])
    await bench.clock.advance(1000)
    await bench.run(bench.lease.send(bytes('next;')))
    assert.deepEqual(sentTexts(bench), ['abc;', 'next;'])
    assert.equal(bench.lease.line.stats().tornWrites, 0)
  })
})

describe('listening line: released and closed', () => {
  it('what ends a torn message does not count as bytes of the next one', async () => {
    const bench = await torn({ torn: { first: bytes('\r\n') } })
    await bench.clock.advance(1000)
    const sent = failure(bench.lease.send(bytes('next;')))
    assert.deepEqual(sentTexts(bench).slice(1), ['\r\nnext;'])
    await bench.run(bench.lease.release())
    const { code, details } = await sent
    assert.deepEqual([code, details.sent, details.of], ['LINE_CLOSED', 5, 5])
  })

  it('all settle once with LINE_CLOSED and what went out; the message on the wire is not cut', async () => {
    for (const flow of ['none', 'dc']) {
      const bench = await opened({ flow })
      const sent = [bytes('x'.repeat(90) + ';'), bytes('b;')].map(each => failure(bench.lease.send(each)))
      await bench.clock.advance(10)
      const released = bench.lease.release()
      const errors = await Promise.all(sent)
      assert.deepEqual(
        errors.map(({ code, details }) => [code, details.sent, details.of]),
        [
          ['LINE_CLOSED', flow === 'dc' ? 46 : 91, 91],
          ['LINE_CLOSED', 0, 2]
        ]
      )
      assert.equal(bench.wire.open, 1)
      await bench.run(released)
      near(bench.clock.now(), 1 + 91 * CHARACTER)
      assert.equal(sentTexts(bench).join(''), 'x'.repeat(90) + ';')
      assert.deepEqual([bench.wire.open, bench.clock.pending()], [0, 0])
      assert.equal(bench.lease.line.stats().tornWrites, 0)
    }
  })

  it('a message that is too long, or stopped, is cut after a second at most: it is torn', async () => {
    const long = await opened({ flow: 'dc', torn: { first: bytes('!') } })
    const sent = failure(long.lease.send(bytes('x'.repeat(5000))))
    await long.run(long.lease.release())
    near(long.clock.now(), 1001)
    assert.equal((await sent).code, 'LINE_CLOSED')
    assert.equal(long.lease.line.stats().tornWrites, 1)
    const again = long.open({}, 'again')
    collect(again, long.options)
    await long.run(again.send(bytes('next;')))
    assert.equal(sentTexts(long).at(-1), '!next;')
    await long.run(again.release())
    assert.equal(long.clock.pending(), 0)
  })

  it('what one lease waits for ends with it; the others go on', async () => {
    const bench = await opened({ flow: 'dc' })
    const other = bench.open({}, 'other')
    const { texts } = collect(other, { flow: 'dc' })
    const [first, second] = ['x'.repeat(100) + ';', 'b;'].map(text => failure(bench.lease.send(bytes(text))))
    const third = other.send(bytes('c;'))
    await bench.clock.advance(5)
    await bench.run(bench.lease.release())
    assert.deepEqual([(await first).details.sent, (await second).details.sent], [46, 0])
    await bench.run(third)
    assert.equal(sentTexts(bench).join(''), 'x'.repeat(100) + ';c;')
    bench.wire.handlers.data(bytes('q;'))
    assert.deepEqual([texts, bench.texts], [['q'], []])
  })

  it('the late answer to a message of a lease that has gone answers nobody else', async () => {
    const bench = await opened()
    const other = bench.open({}, 'other')
    const { texts } = collect(other)
    const options = { match: ({ kind }) => kind === 'ack', timeout: 100 }
    const first = failure(bench.lease.send(bytes('a;'), options))
    await bench.clock.advance(50)
    await bench.run(bench.lease.release())
    assert.deepEqual([(await first).code, (await first).details.sent], ['LINE_CLOSED', 2])
    const second = other.send(bytes('b;'), options)
    await bench.clock.advance(20)
    bench.wire.handlers.data(bytes('+;'))
    await bench.clock.advance(20)
    bench.wire.handlers.data(bytes('+;'))
    assert.equal((await bench.run(second)).answer.kind, 'ack')
    assert.deepEqual(texts, [])
  })

  it('a listener that releases, closes or sends from inside its callback harms nothing', async () => {
    const bench = await opened()
    const other = bench.open({}, 'other')
    const { texts } = collect(other)
    const errors = []
    const inside = bench.lease.listen(
      require('./support/framing').toyFraming(),
      () => {
        inside.close()
        void bench.lease.release()
        bench.lease.send(bytes('x;')).catch(error => errors.push(error.code))
      },
      {}
    )
    bench.wire.handlers.data(bytes('a;b;half'))
    await bench.run(other.release())
    assert.deepEqual([texts, errors], [['a', 'b', 'half…'], ['LINE_CLOSED']])
    assert.deepEqual([bench.wire.open, bench.clock.pending()], [0, 0])
  })
})
