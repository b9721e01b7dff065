'use strict'
const assert = require('node:assert/strict')
const { createC24Port, openC24Port, toBufferMemory } = require('../../lib')
const { c24Bench } = require('./c24-bench')

const hex = text => Buffer.from(text.replace(/ /g, ''), 'hex')
const code = wanted => error => error.code === wanted

describe('C24 port, free messages', () => {
  let bench
  const open = options => (bench = c24Bench(options))
  afterEach(() => bench?.close())
  const opened = async options => {
    open(options)
    await bench.clock.advance(10)
    return bench
  }

  it('sends text with its end code, and hears messages', async () => {
    await opened()
    const outcome = await bench.send('SET 125')
    assert.deepEqual({ ...outcome, ms: 0 }, { outcome: 'sent', attempts: 1, bytes: 9, ms: 0 })
    // nine bytes of 10/9600 s
    assert.ok(Math.abs(outcome.ms - 9.375) < 0.1, `${outcome.ms}`)
    assert.equal(bench.peer.text(), 'SET 125\r\n')
    bench.peer.say('ABC\r\nDE')
    bench.peer.say('F\r\n')
    await bench.clock.advance(10)
    const [first, second] = bench.got
    const { timestamp, ...rest } = first
    const bytes = Buffer.from('ABC')
    assert.deepEqual(rest, { value: 'ABC', text: 'ABC', bytes, count: 2, complete: true, afterOpen: true })
    assert.ok(Math.abs(timestamp - bench.clock.wall()) < 100)
    assert.deepEqual([second.value, 'afterOpen' in second], ['DEF', false])
    assert.deepEqual({ ...bench.device.stats }, { ...bench.device.stats, received: 2, incomplete: 0, sent: 1 })
  })

  it('words: low byte first; count as in the buffer memory', async () => {
    await opened({ port: { format: 'words' } })
    await bench.send([0x4241, 3])
    assert.equal(bench.peer.hex(), '41420300' + '0D0A')
    bench.peer.say('ABCDEFG123\r\n')
    await bench.clock.advance(10)
    assert.deepEqual(bench.got[0].value, [0x4241, 0x4443, 0x4645, 0x3147, 0x3332])
    assert.equal(bench.got[0].count, toBufferMemory(Buffer.from('ABCDEFG123'))[0])
    await bench.close()
    await opened({ port: { format: 'words', unit: 'byte' } })
    bench.peer.say('ABCDEFG123\r\n')
    await bench.clock.advance(10)
    assert.equal(bench.got[0].count, 10)
  })

  it('what cannot be sent is refused, with a code, and nothing goes out', async () => {
    await opened({ port: { flow: 'dc', most: 20 } })
    for (const [value, wanted] of [
      ['A\r\nB', 'END_CODE_INSIDE'],
      ['A\x13', 'FLOW_CODE_INSIDE'],
      ['가', 'BAD_VALUE'],
      [undefined, 'BAD_VALUE'],
      ['x'.repeat(21), 'FRAME_TOO_LONG']
    ]) {
      const outcome = await bench.send(value)
      assert.deepEqual([outcome.outcome, outcome.code, outcome.attempts, outcome.bytes], ['refused', wanted, 0, 0])
      assert.ok(outcome.text)
    }
    assert.deepEqual(bench.peer.heard, [])
    assert.equal(bench.device.stats.refused, 5)
  })

  it('DC3 stops it, DC1 lets it go on; made transparent they are data', async () => {
    await opened({ port: { flow: 'dc', transparent: '10' } })
    bench.peer.say([0x13])
    const sending = bench.device.send('A\x11B')
    await bench.clock.advance(500)
    assert.deepEqual(bench.peer.heard, [])
    bench.peer.say([0x11])
    const { outcome } = await bench.run(sending)
    assert.equal(outcome, 'sent')
    assert.equal(bench.peer.hex(), '41101142' + '0D0A')
    bench.peer.say(hex('41 10 13 42 0D 0A'))
    await bench.clock.advance(10)
    assert.deepEqual(bench.values(), ['A\x13B'])
    bench.device.pause()
    bench.device.resume()
    assert.ok(bench.peer.hex().endsWith('1311'))
  })

  it('stopped too long: failed, with a code', async () => {
    await opened({ port: { flow: 'dc', stallLimit: 1000 } })
    bench.peer.say([0x13])
    const { outcome, code: why, bytes } = await bench.send('A')
    assert.deepEqual([outcome, why, bytes], ['failed', 'WRITE_STALLED', 0])
  })

  it('interrupted: unknown; the next message waits for timer 0, and the end code goes first if wanted', async () => {
    await opened({ port: { timer0: 5000, tornEnd: true } })
    const sending = bench.device.send('SET 125')
    await bench.clock.advance(4)
    bench.peer.cut()
    const { outcome, code: why, bytes } = await bench.run(sending)
    assert.deepEqual([outcome, why], ['unknown', 'PORT_GONE'])
    assert.ok(bytes > 0 && bytes < 9, `${bytes}`)
    const at = bench.clock.now()
    bench.peer.heard.length = 0
    await bench.clock.advance(3000)
    assert.equal((await bench.send('NEXT')).outcome, 'sent')
    assert.ok(bench.peer.times.at(-1) - at >= 5000)
    assert.equal(bench.peer.text(), '\r\nNEXT\r\n')
  })

  it('the end code behind an interrupted message is converted as those of messages are, and not between user frames', async () => {
    const rows = [
      [{ asciiBinary: true }, '0D0A'],
      [{ asciiBinary: true, first: '02', last: '03', unit: 'byte' }, '\x03']
    ]
    for (const [own, end] of rows) {
      await opened({ port: { ...own, tornEnd: true } })
      const sending = bench.device.send('SET 125')
      await bench.clock.advance(4)
      bench.peer.cut()
      await bench.run(sending)
      bench.peer.heard.length = 0
      await bench.clock.advance(3000)
      await bench.send('A')
      assert.equal(bench.peer.text(), own.first ? `${end}\x0241\x03` : `${end}410D0A`)
      await bench.close()
    }
    // an acknowledged frame needs no end code
    await opened({ port: { bidirectional: true, tornEnd: true, ackTimeout: 100 } })
    const sending = bench.device.send('AB')
    await bench.clock.advance(2)
    bench.peer.cut()
    await bench.run(sending)
    bench.peer.heard.length = 0
    await bench.clock.advance(3000)
    await bench.send('AB')
    assert.equal(bench.peer.hex().slice(0, 6), '050100')
  })

  it('a message that stops is told as incomplete', async () => {
    await opened({ port: { gap: 100 } })
    bench.peer.say('SET 1')
    await bench.clock.advance(99)
    assert.deepEqual(bench.got, [])
    await bench.clock.advance(5)
    bench.peer.say('NEXT\r\n')
    await bench.clock.advance(5)
    assert.deepEqual(
      bench.got.map(({ value, complete, reason }) => [value, complete, reason]),
      [
        ['SET 1', false, 'silence'],
        ['NEXT', true, undefined]
      ]
    )
    assert.equal(bench.device.stats.incomplete, 1)
  })

  it('messages by silence: ours are kept apart, too', async () => {
    await opened({ port: { framing: 'gap', gap: 50 } })
    await bench.run(Promise.all([bench.device.send('A'), bench.device.send('B')]))
    const [one, two] = bench.peer.times
    assert.ok(two - one >= 50)
    bench.peer.say('X')
    await bench.clock.advance(60)
    assert.deepEqual(bench.values(), ['X'])
  })

  it('messages by silence: behind a torn one the next waits as long', async () => {
    await opened({ port: { framing: 'gap', gap: 5000 } })
    const sending = bench.device.send('SET 125')
    await bench.clock.advance(4)
    bench.peer.cut()
    await bench.run(sending)
    const at = bench.clock.now()
    await bench.clock.advance(2000)
    await bench.send('NEXT')
    assert.ok(bench.peer.times.at(-1) - at >= 5000)
  })

  it('a character that the encoding does not have is damage', async () => {
    await opened({ port: { encoding: 'ascii' } })
    bench.peer.say(hex('41 C2 0D 0A'))
    await bench.clock.advance(10)
    assert.deepEqual([bench.got[0].complete, bench.got[0].reason], [false, 'encoding'])
  })

  it('keeps what comes before the first listener', async () => {
    open()
    const late = bench.make({})
    await bench.clock.advance(10)
    bench.peer.say('EARLY\r\n')
    const got = []
    const stop = late.listen(({ value }) => got.push(value))
    const later = []
    const stopLater = late.listen(({ value }) => later.push(value))
    bench.peer.say('MORE\r\n')
    stop()
    stopLater()
    bench.peer.say('LOST\r\n')
    assert.deepEqual([got, later], [['EARLY', 'MORE'], ['MORE']])
    assert.equal(late.stats.unheard, 1)
    late.close()
  })

  it('after close nothing goes out, and closing settles what waits', async () => {
    await opened({ port: { flow: 'dc' } })
    bench.peer.say([0x13])
    const waiting = [bench.device.send('A'), bench.device.send('B')]
    await bench.clock.advance(10)
    bench.device.close()
    const released = bench.lease.release()
    const outcomes = await bench.run(Promise.all(waiting))
    assert.deepEqual(
      outcomes.map(({ outcome, code: why }) => [outcome, why]),
      [
        ['failed', 'LINE_CLOSED'],
        ['failed', 'LINE_CLOSED']
      ]
    )
    await bench.run(released)
    assert.deepEqual([(await bench.send('C')).outcome, bench.peer.heard.length], ['failed', 0])
  })

  const wrong = {
    'an unknown framing': { framing: 'line' },
    'an end code that is no hex': { end: 'CR' },
    'the driver without flow control': { flow: 'driver' },
    'bidirectional with DC codes': { bidirectional: true, flow: 'dc' },
    'an unknown encoding': { encoding: 'ebcdic' },
    'no time of silence': { framing: 'gap' },
    'an unknown priority': { priority: 'me' },
    'a time that is none': { ackTimeout: 0 }
  }
  for (const [name, options] of Object.entries(wrong)) {
    it(`settings: ${name}`, () => {
      open()
      assert.throws(() => createC24Port({ lease: bench.lease, ...options }), code('BAD_SETTING'))
    })
  }

  it('a port with another framing on the same line is refused', () => {
    open()
    assert.throws(() => bench.make({ end: '0A' }), code('LINE_USE'))
    bench.make({ format: 'bytes' }).close()
  })

  it('takes the settings as a node saves them', async () => {
    const port = {
      framing: 'end',
      end: '0d0a',
      count: 0,
      gap: '0',
      most: '100',
      padEven: 'true',
      first: '',
      last: '',
      flow: 'driver'
    }
    await opened({ port: { ...port, transparent: '', sumCheck: 'true' }, line: { flowControl: 'rtscts' } })
    await bench.send('ABC')
    assert.equal(bench.peer.hex(), '41424300' + '0D0A')
  })

  it('openC24Port: a line of its own', async () => {
    open()
    const { settings, pool, clock } = bench
    const wire = { connect: handlers => settings.wire.connect(handlers) }
    const own = openC24Port({ ...settings, wire, path: 'own', pool, clock, gap: 200 })
    const got = []
    own.listen(({ value }) => got.push(value))
    const { outcome } = await bench.run(own.send('HELLO'))
    bench.peer.say('BACK\r\n')
    await clock.advance(5)
    assert.deepEqual([outcome, got, own.line.state], ['sent', ['BACK'], 'open'])
    await bench.run(own.close())
    assert.throws(() => openC24Port({ ...settings, wire, path: 'own', pool, clock, end: 'X' }), code('BAD_SETTING'))
    // the gap of messages may be longer than that of a line
    await clock.run(openC24Port({ ...settings, wire, path: 'own', pool, clock, gap: 20000 }).close())
    assert.equal(pool.lines().length, 1)
  })
})
