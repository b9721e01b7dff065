'use strict'

const assert = require('node:assert')
const { byteMs, bytes, channel, CRLF, hex, onWire, text } = require('./c24-support')

describe('simulated C24: sending', () => {
  it('count and words stand at 400H; text, bytes and words go out with the end code', async () => {
    const { clock, c24, said } = channel()
    c24.send('ABC')
    await clock.drain()
    assert.strictEqual(hex(c24.memory.words(0x400, 3)), '0002 4241 0043')
    c24.send([0x1234, 0x00ff])
    c24.send(bytes('80 81'), { end: false })
    await clock.drain()
    assert.strictEqual(said(), '41 42 43 0D 0A 34 12 FF 00 0D 0A 80 81')
    assert.deepStrictEqual(
      c24.sent.map(({ outcome }) => outcome),
      ['sent', 'sent', 'sent']
    )
    assert.throws(() => c24.send('A'.repeat(1023)), { code: 'BAD_SETTING' })
  })
  it('stops inside a message at our DC3, behind the byte that it sends, and goes on at DC1', async () => {
    const { clock, c24, end, all } = onWire({ flow: 'dc' })
    c24.send('A'.repeat(500))
    await clock.advance(100 * byteMs)
    end.write(bytes('13'))
    await clock.advance(byteMs)
    const before = all().length
    await clock.advance(5000)
    assert.ok(all().length - before <= 1, `${before} ${all().length}`)
    end.write(bytes('11'))
    await clock.drain()
    assert.strictEqual(String(all()), 'A'.repeat(500) + CRLF)
    assert.deepStrictEqual([c24.counts.halted, c24.counts.resumed, c24.messages.length], [1, 1, 0])
  })
  it('its own DC3 comes between the bytes of a message', async () => {
    const { clock, c24, end, all } = onWire({ flow: 'dc', rate: 0 })
    end.write(text(`X${CRLF}`))
    end.write(Buffer.alloc(8448 - 100, 0x42))
    await clock.drain()
    c24.send('A'.repeat(200))
    end.write(Buffer.alloc(36, 0x42))
    await clock.drain()
    const place = all().indexOf(0x13)
    assert.ok(place === 36 || place === 37, String(place))
    assert.strictEqual(all().length, 203)
  })
  it('transparent code before DC1, DC3 and itself; ASCII-binary', async () => {
    const { clock, c24, said } = channel({ transparent: '10', flow: 'dc' })
    c24.send(bytes('11 12 13 10'))
    await clock.drain()
    assert.strictEqual(said(), '10 11 12 10 13 10 10 0D 0A')
    const other = channel({ asciiBinary: true, first: '02', last: '03' })
    other.c24.send(bytes('0A FF'))
    await other.clock.drain()
    assert.strictEqual(other.said(), '30 32 30 41 46 46 30 33')
  })
  it('a program that echoes, one that answers, one that speaks by itself', async () => {
    const run = async settings => {
      const { clock, end, all } = onWire(settings)
      end.write(text(`ASK${CRLF}`))
      await clock.advance(1050)
      return String(all())
    }
    assert.strictEqual(await run({ program: 'echo' }), `ASK${CRLF}`)
    assert.strictEqual(await run({ program: ({ bytes: asked }) => `${asked}=1` }), `ASK=1${CRLF}`)
    assert.strictEqual(await run({ speaks: { every: 500, value: n => `N${n}` } }), `N0${CRLF}N1${CRLF}`)
  })
  it('closed: nothing more, no timer left', async () => {
    const { clock, c24, hear, said } = channel({ speaks: { every: 500, value: () => 'A' }, timer0: 100, rate: 0.001 })
    hear(`ONE${CRLF}TWO${CRLF}`)
    await clock.advance(600)
    c24.close()
    await clock.drain()
    assert.deepStrictEqual([said(), clock.pending(), clock.now()], ['41 0D 0A', 0, 600])
  })
})

describe('simulated C24: bidirectional protocol', () => {
  // protocols page: length 5 words, sum 0277H
  const VECTOR = '05 05 00 41 42 43 44 45 46 47 31 32 33 77 02'

  it('the vector in both directions', async () => {
    const { clock, c24, hear, said } = channel({ protocol: 'bidirectional' })
    hear(bytes(VECTOR))
    await clock.drain()
    assert.strictEqual(said(), '06')
    assert.strictEqual(hex(c24.memory.words(0x600, 6)), '0005 4241 4443 4645 3147 3332')
    c24.send('ABCDEFG123')
    await clock.advance(100)
    assert.strictEqual(said(), `06 ${VECTOR}`)
    assert.strictEqual(c24.sent.length, 0)
    hear(bytes('06'))
    assert.deepStrictEqual(
      c24.sent.map(({ outcome, attempts }) => [outcome, attempts]),
      [['confirmed', 1]]
    )
  })
  it('the length in bytes; without sum', async () => {
    const { clock, c24, hear, said } = channel({ protocol: 'bidirectional', unit: 'byte', sumCheck: false })
    hear(bytes('05 03 00 41 42 43'))
    await clock.drain()
    assert.deepStrictEqual([String(c24.messages[0].bytes), said()], ['ABC', '06'])
  })
  it('ASCII-binary and transparent code: the sum counts the characters and is neither', async () => {
    const characters = Buffer.from('0300111041', 'latin1')
    const total = [...characters].reduce((sum, byte) => sum + byte, 0)
    const settings = { protocol: 'bidirectional', unit: 'byte', asciiBinary: true }
    const { clock, c24, hear, said } = channel(settings)
    hear(Buffer.concat([Buffer.of(5), characters, Buffer.of(total & 255, total >> 8)]))
    await clock.drain()
    assert.deepStrictEqual([c24.messages[0].bytes.toString('hex'), said()], ['111041', '06'])
    const other = channel({ protocol: 'bidirectional', unit: 'byte', transparent: '10' })
    // 3 + 17 + 16 + 237 = 0111H: a sum of DC1s, not made transparent
    const message = bytes('05 03 00 10 11 10 10 ED 11 01')
    other.hear(message)
    await other.clock.drain()
    assert.deepStrictEqual([other.c24.messages[0].bytes.toString('hex'), other.said()], ['1110ed', '06'])
    other.c24.send(bytes('11 10 ED'))
    await other.clock.advance(50)
    assert.strictEqual(other.said(), '06 05 03 00 10 11 10 10 ED 11 01')
  })
  it('ACK when the program has read, not before', async () => {
    const { clock, c24, hear, said } = channel({ protocol: 'bidirectional', rate: 0 })
    hear(bytes(VECTOR))
    await clock.advance(1000)
    assert.strictEqual(said(), '')
    c24.take()
    await clock.drain()
    assert.strictEqual(said(), '06')
  })
  it('NAK with a code, low byte first: wrong sum, too long, torn', async () => {
    const { clock, c24, hear, said } = channel({ protocol: 'bidirectional', timer0: 10 })
    hear(bytes(VECTOR.replace('77 02', '78 02')))
    await clock.drain()
    assert.strictEqual(said(), '15 24 7F')
    hear(bytes('05 00 02'))
    await clock.drain()
    assert.strictEqual(said(), '15 24 7F 15 25 7F')
    hear(bytes('05 05 00 41'))
    await clock.drain()
    assert.strictEqual(said(), '15 24 7F 15 25 7F 15 40 7F')
    assert.deepStrictEqual([c24.messages.length, c24.counts.refused], [0, 3])
    hear(bytes(VECTOR))
    assert.strictEqual(c24.messages.length, 1)
  })
  it('our NAK ends its message, or has it repeated; no answer: 7F40H at 257H', async () => {
    const { clock, c24, hear } = channel({ protocol: 'bidirectional', retries: 1, ackTimeout: 500 })
    c24.send('AB')
    await clock.advance(50)
    hear(bytes('15 22 00'))
    await clock.advance(50)
    hear(bytes('15 23 00'))
    assert.deepStrictEqual([c24.sent[0].outcome, c24.sent[0].code, c24.sent[0].attempts], ['refused', 0x23, 2])
    assert.strictEqual(c24.memory.get(0x257), 0x23)
    c24.send('CD')
    await clock.drain()
    assert.deepStrictEqual(
      [c24.sent[1].outcome, c24.sent[1].reason, c24.memory.get(0x257)],
      ['failed', 'timeout', 0x7f40]
    )
  })
  it('both at once: which counts is a setting', async () => {
    const run = async simultaneous => {
      const { clock, c24, hear, said } = channel({ protocol: 'bidirectional', simultaneous, ackTimeout: 500 })
      c24.send('AB')
      await clock.advance(1)
      hear(bytes(VECTOR))
      await clock.advance(100)
      const answers = said().replace('05 01 00 41 42 84 00', '').trim()
      hear(bytes('06'))
      await clock.drain()
      return [c24.messages.length, answers, c24.sent[0].outcome]
    }
    assert.deepStrictEqual(
      (await run('both')).filter((_, n) => n !== 1),
      [1, 'confirmed']
    )
    assert.deepStrictEqual(
      (await run('receive')).filter((_, n) => n !== 1),
      [1, 'failed']
    )
    assert.deepStrictEqual(await run('send'), [0, '', 'confirmed'])
    assert.deepStrictEqual(await run('none'), [0, '', 'failed'])
  })
})
