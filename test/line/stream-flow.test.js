'use strict'

const assert = require('node:assert/strict')
const { createBench, failure } = require('./support/bench')
const { collect, toyFraming } = require('./support/framing')

const DC1 = '\x11'
const DC3 = '\x13'
/** one character at 9600 bit/s, ms */
const CHARACTER = 10000 / 9600
/** what may be on its way at 9600 bit/s: 64 - 2 - 0.96 x 16 */
const PIECE = 46

const bytes = text => Buffer.from(text, 'latin1')
const says = (bench, text) => bench.wire.handlers.data(bytes(text))
const sentTexts = ({ wire }) => wire.sent.map(one => one.bytes.toString('latin1'))
const allSent = bench => sentTexts(bench).join('')
const near = (got, expected) => assert.ok(Math.abs(got - expected) < 0.01, `${got} instead of ${expected}`)

const opened = async ({ settings = {}, ...options } = {}) => {
  const bench = createBench({ settings: { baudRate: 9600, ...settings }, ...options })
  await bench.clock.advance(1)
  return bench
}
const control = async ({ settings, ...options } = {}) => {
  const bench = await opened({ settings })
  return { ...bench, ...collect(bench.lease, { flow: 'dc', ...options }) }
}

describe('listening line: DC1 and DC3', () => {
  it('a stop keeps everything back, also answers; a go releases it, answers first', async () => {
    const bench = await control({ reply: () => bytes('ACK') })
    says(bench, DC3)
    const sent = bench.lease.send(bytes('a;'))
    says(bench, 'q;')
    await bench.clock.advance(1000)
    assert.deepEqual(sentTexts(bench), [])
    says(bench, DC1)
    assert.deepEqual(sentTexts(bench).slice(0, 1), ['ACK'])
    await bench.run(sent)
    assert.deepEqual(sentTexts(bench), ['ACK', 'a;'])
    assert.deepEqual(bench.texts, ['q'])
    assert.equal(bench.lease.line.stats().stops, 1)
  })

  it('answers that must wait do not pile up: of 100 the latest 16', async () => {
    let n = 0
    const bench = await control({ reply: () => bytes(`A${n++}`) })
    says(bench, DC3)
    says(bench, 'q;'.repeat(100))
    says(bench, DC1)
    assert.deepEqual(
      sentTexts(bench),
      Array.from({ length: 16 }, (_, k) => `A${84 + k}`)
    )
  })

  it('a message goes out in pieces, each after the one before has left', async () => {
    const bench = await control()
    const text = 'x'.repeat(120)
    const t = bench.clock.now()
    const { ms } = await bench.run(bench.lease.send(bytes(text)))
    assert.deepEqual(
      sentTexts(bench).map(piece => piece.length),
      [PIECE, PIECE, 120 - 2 * PIECE]
    )
    bench.wire.sent.forEach(({ at }, n) => near(at, t + n * PIECE * CHARACTER))
    near(ms, 120 * CHARACTER)
    assert.equal(allSent(bench), text)
    assert.equal(bench.lease.line.trace().length, 1)
  })

  it('after a stop comes no more than there is room for, at whatever moment it is said', async () => {
    for (let at = 0; at < 110; at++) {
      const bench = await control()
      const sent = bench.lease.send(bytes('x'.repeat(300)))
      const start = bench.clock.now()
      // the other side wants it now, behind the byte that it is sending; the adapter brings it 16 ms later
      const said = at * CHARACTER
      await bench.clock.advance(said + 2 * CHARACTER + 16)
      says(bench, DC3)
      await bench.clock.advance(500)
      const got = allSent(bench).length
      // what had not left the wire at that moment came after it
      assert.ok(got - said / CHARACTER <= 64, `${got} bytes where the stop was said at ${at}`)
      assert.equal(bench.clock.now() - start > 500, true)
      says(bench, DC1)
      await bench.run(sent)
      assert.equal(allSent(bench).length, 300)
    }
  })

  it('the pieces follow speed, room and latency; where none is left it is refused, naming both', async () => {
    const pieceAt = async (baudRate, options) => {
      const bench = await control({ settings: { baudRate }, ...options })
      bench.lease.send(bytes('x'.repeat(3000)))
      return sentTexts(bench)[0].length
    }
    assert.equal(await pieceAt(19200), 31)
    assert.equal(await pieceAt(38400, { latency: 15 }), 4)
    assert.equal(await pieceAt(38400, { latency: 1 }), 58)
    assert.equal(await pieceAt(115200, { room: 2048 }), 1861)
    for (const [baudRate, options] of /** @type {any[]} */ ([
      [57600, {}],
      [115200, {}],
      [38400, {}],
      [38400, { room: 65, transparent: 0x10 }]
    ])) {
      const bench = await opened({ settings: { baudRate } })
      assert.throws(
        () => collect(bench.lease, { flow: 'dc', ...options }),
        error => error.code === 'BAD_SETTING' && error.message.includes('room') && error.message.includes(`${baudRate}`)
      )
      // it keeps nothing
      collect(bench.lease)
    }
  })

  it('with the help of the driver, and without flow control, a message goes out at once', async () => {
    const driver = await control({ settings: { baudRate: 115200, flowControl: 'xonxoff' } })
    await driver.run(driver.lease.send(bytes('x'.repeat(500))))
    const none = await opened()
    collect(none.lease)
    await none.run(none.lease.send(bytes('x'.repeat(500))))
    assert.deepEqual([driver.wire.sent.length, none.wire.sent.length], [1, 1])
  })

  it('control codes are no data, unless the transparent code stands before them', async () => {
    const cases = [
      [null, `a${DC3}b${DC1};`, 'ab'],
      [null, `\x10${DC1};`, '\x10'],
      [0x10, `a\x10${DC3}b;`, `a\x10${DC3}b`],
      [0x10, `a\x10\x10${DC3}b${DC1};`, 'a\x10\x10b'],
      [0x10, `a\x10\x10\x10${DC3}b;`, `a\x10\x10\x10${DC3}b`]
    ]
    for (const [transparent, text, expected] of cases) {
      for (let at = 0; at <= text.length; at++) {
        const bench = await control({ transparent })
        says(bench, text.slice(0, at))
        says(bench, text.slice(at))
        assert.deepEqual(bench.texts, [expected], `${JSON.stringify(text)} split at ${at}`)
        await bench.run(bench.lease.send(bytes('a;')))
      }
    }
    const none = await opened()
    const { texts } = collect(none.lease)
    says(none, `a${DC3};`)
    await none.run(none.lease.send(bytes('a;')))
    assert.deepEqual(texts, [`a${DC3}`])
  })

  it('a piece never ends between the transparent code and its byte', async () => {
    for (let shift = 0; shift < 3; shift++) {
      const bench = await control({ transparent: 0x10, room: 20 })
      const text = 'x'.repeat(shift) + `\x10${DC3}\x10\x10y`.repeat(8)
      await bench.run(bench.lease.send(bytes(text)))
      assert.equal(allSent(bench), text)
      assert.ok(bench.wire.sent.length >= 10)
      for (const piece of sentTexts(bench)) {
        assert.ok(piece.length <= 4)
        assert.doesNotMatch(piece.replace(/\x10[^]/g, ''), /\x10/) // eslint-disable-line no-control-regex
      }
    }
  })

  it('stopped for too long: WRITE_STALLED, with what went out; the next one waits its own time', async () => {
    const bench = await control({ stallLimit: 1000 })
    const t = bench.clock.now()
    const long = failure(bench.lease.send(bytes('x'.repeat(100))))
    const next = failure(bench.lease.send(bytes('next;')))
    await bench.clock.advance(10)
    says(bench, DC3)
    const error = await bench.run(long)
    near(bench.clock.now(), t + 1010)
    assert.deepEqual([error.code, error.details.sent, error.details.of], ['WRITE_STALLED', PIECE, 100])
    const second = await bench.run(next)
    assert.deepEqual([second.code, second.details.sent, second.details.of], ['WRITE_STALLED', 0, 5])
    const third = failure(bench.lease.send(bytes('third;')))
    await bench.clock.advance(999)
    assert.equal(allSent(bench).length, PIECE)
    await bench.clock.advance(2)
    assert.equal((await third).code, 'WRITE_STALLED')
    // the line is as it was, and goes on
    assert.equal(bench.lease.line.state, 'open')
    const fourth = bench.lease.send(bytes('fourth;'))
    says(bench, DC1)
    await bench.run(fourth)
    assert.equal(sentTexts(bench).at(-1), 'fourth;')
    assert.deepEqual([bench.lease.line.stats().tornWrites, bench.wire.connects], [1, 1])
  })

  it('said again, a stop does not begin anew; each message waits its own time', async () => {
    const bench = await control({ stallLimit: 1000 })
    says(bench, DC3)
    const first = failure(bench.lease.send(bytes('a;')))
    for (let n = 0; n < 9; n++) {
      await bench.clock.advance(100)
      says(bench, DC3)
    }
    await bench.run(first)
    near(bench.clock.now(), 1001)
    const second = failure(bench.lease.send(bytes('b;')))
    await bench.run(second)
    near(bench.clock.now(), 2001)
  })

  it('an answer that comes before all of the message has gone out is none', async () => {
    const bench = await control()
    const options = { match: ({ kind }) => kind === 'ack', timeout: 100 }
    const sent = bench.lease.send(bytes('x'.repeat(100)), options)
    await bench.clock.advance(10)
    says(bench, '+;')
    assert.deepEqual(bench.texts, ['+'])
    await bench.clock.advance(120)
    says(bench, '+;')
    near((await bench.run(sent)).ms, 130)
    assert.deepEqual(bench.texts, ['+'])
  })

  it('an answer that could not go out is not sent over the next connection', async () => {
    const bench = await control({ reply: () => bytes('ACK') })
    says(bench, `${DC3}q;`)
    bench.wire.unplug()
    await bench.clock.advance(1000)
    await bench.run(bench.lease.send(bytes('a;')))
    says(bench, `${DC3}${DC1}`)
    assert.deepEqual(sentTexts(bench), ['a;'])
  })

  it('many stops and goes lose and double nothing', async () => {
    const bench = await control()
    const texts = Array.from({ length: 20 }, (_, n) => `${n}:`.padEnd(30 + 7 * n, 'abcdefg') + ';')
    const sent = Promise.all(texts.map(text => bench.lease.send(bytes(text))))
    for (let n = 0; n < 200; n++) {
      says(bench, n % 2 ? DC1 : DC3)
      await bench.clock.advance((n * 7) % 31)
    }
    says(bench, DC1)
    await bench.run(sent)
    assert.equal(allSent(bench), texts.join(''))
    assert.equal(bench.lease.line.stats().messagesOut, 20)
  })

  it('after a reopening it may be sent', async () => {
    const bench = await control()
    says(bench, `${DC3}`)
    bench.wire.unplug()
    await bench.clock.advance(1000)
    await bench.run(bench.lease.send(bytes('a;')))
  })
})

describe('listening line: pause and resume', () => {
  it('tell the other side, at once and once, while any listener is behind', async () => {
    const bench = await control()
    const other = collect(bench.lease, { flow: 'dc' })
    bench.pause()
    bench.pause()
    other.pause()
    bench.resume()
    assert.deepEqual(sentTexts(bench), [DC3])
    other.resume()
    other.resume()
    assert.deepEqual(sentTexts(bench), [DC3, DC1])
    assert.deepEqual(
      bench.lease.line.trace().map(({ dir, note }) => [dir, note]),
      [
        ['out', 'DC3'],
        ['out', 'DC1']
      ]
    )
  })

  it('also inside a message, and while the other side has stopped us', async () => {
    const bench = await control()
    const sent = bench.lease.send(bytes('x'.repeat(100)))
    says(bench, DC3)
    bench.pause()
    assert.deepEqual(
      sentTexts(bench).map(text => text.length),
      [PIECE, 1]
    )
    says(bench, DC1)
    bench.resume()
    await bench.run(sent)
    assert.equal(allSent(bench).replace(/[^x]/g, ''), 'x'.repeat(100))
  })

  it('an answer never goes out inside a message', async () => {
    const bench = await control({ reply: () => bytes('ACK') })
    const sent = bench.lease.send(bytes('x'.repeat(100)))
    says(bench, 'q;')
    bench.lease.send(bytes('next;'))
    await bench.run(sent)
    await bench.clock.advance(100)
    assert.equal(allSent(bench), `${'x'.repeat(100)}ACKnext;`)
  })

  it('after a reopening the other side is told again what holds', async () => {
    for (const resumed of [false, true]) {
      const bench = await control()
      bench.pause()
      bench.wire.unplug()
      if (resumed) bench.resume()
      await bench.clock.advance(1000)
      assert.deepEqual(sentTexts(bench), [DC3, resumed ? DC1 : DC3])
    }
  })

  it('who goes leaves nobody stopped', async () => {
    const closed = await control()
    closed.pause()
    closed.close()
    assert.deepEqual(sentTexts(closed), [DC3, DC1])
    const released = await control()
    released.pause()
    await released.run(released.lease.release())
    assert.deepEqual(sentTexts(released), [DC3, DC1])
    assert.equal(released.wire.open, 0)
  })

  it('without flow control they say nothing', async () => {
    const bench = await opened()
    const listener = collect(bench.lease)
    listener.pause()
    says(bench, 'a;')
    listener.resume()
    assert.deepEqual([sentTexts(bench), listener.texts], [[], ['a']])
  })
})

describe('listening line: CTS of a simulated wire', () => {
  const rtscts = { flowControl: 'rtscts' }

  it('nothing leaves while it is off; the message has left when all is taken', async () => {
    const bench = await opened({ settings: rtscts })
    collect(bench.lease)
    const t = bench.clock.now()
    const sent = bench.lease.send(bytes('x'.repeat(100)))
    await bench.clock.advance(20 * CHARACTER)
    bench.wire.handlers.cts(false)
    await bench.clock.advance(3000)
    assert.equal(allSent(bench).length, 32)
    bench.wire.handlers.cts(true)
    const { ms } = await bench.run(sent)
    assert.equal(allSent(bench).length, 100)
    // 68 bytes after CTS came back
    near(t + ms, bench.clock.now())
    near(ms, (20 + 68) * CHARACTER + 3000)
    await bench.run(bench.lease.send(bytes('next;')))
    assert.equal(sentTexts(bench).at(-1), 'next;')
  })

  it('off from the beginning, and for too long: WRITE_STALLED, and the port is opened anew', async () => {
    const bench = await opened({ settings: rtscts })
    collect(bench.lease, { stallLimit: 2000 })
    bench.wire.handlers.cts(false)
    const sent = failure(bench.lease.send(bytes('abc;')))
    await bench.clock.advance(1900)
    assert.equal(bench.lease.line.state, 'open')
    const error = await bench.run(sent)
    assert.deepEqual([error.code, error.details.of], ['WRITE_STALLED', 4])
    await bench.clock.advance(1000)
    assert.deepEqual([bench.wire.connects, bench.lease.line.state], [2, 'open'])
    // what the port had kept does not come afterwards
    bench.wire.handlers.cts(true)
    await bench.run(bench.lease.send(bytes('next;')))
    assert.equal(allSent(bench), 'next;')
  })

  it('means nothing without the setting', async () => {
    const bench = await opened()
    bench.wire.handlers.cts(false)
    await bench.run(bench.lease.send(bytes('a;')))
    assert.equal(allSent(bench), 'a;')
  })

  it('an unplugged wire loses what was kept', async () => {
    const bench = await opened({ settings: rtscts })
    bench.wire.handlers.cts(false)
    const sent = failure(bench.lease.send(bytes('abc;')))
    bench.wire.unplug()
    assert.equal((await sent).code, 'PORT_GONE')
    await bench.clock.advance(1000)
    assert.equal(allSent(bench), '')
    await bench.run(bench.lease.release())
    assert.equal(bench.clock.pending(), 0)
  })
})

describe('listening line: options', () => {
  const wrong = [
    ['flow', { flow: 'xon' }],
    ['transparent', { transparent: 256 }],
    ['transparent', { transparent: 0x13 }],
    ['transparent', { transparent: '10' }],
    ['room', { room: 0 }],
    ['latency', { latency: -1 }],
    ['stallLimit', { stallLimit: NaN }],
    ['torn.wait', { torn: { wait: -5 } }]
  ]
  for (const [name, options] of wrong) {
    it(`refuses ${JSON.stringify(options)}`, async () => {
      const bench = await opened()
      assert.throws(
        () => bench.lease.listen(toyFraming(), () => {}, /** @type {any} */ (options)),
        error => error.code === 'BAD_SETTING' && error.details.setting === name
      )
      await bench.run(bench.lease.release())
    })
  }
})
