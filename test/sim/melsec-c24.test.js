'use strict'

const assert = require('node:assert')
const { byteMs, bytes, channel, CRLF, hex, onWire, shown, text } = require('./c24-support')

describe('simulated C24: receive area', () => {
  // seeds: "receive data list", ABCDEFG123
  const IMAGE = '4241 4443 4645 3147 3332'

  for (const [unit, count] of [
    ['word', 5],
    ['byte', 10]
  ]) {
    it(`ABCDEFG123 in ${unit} units: ${count} and the words of the manual`, () => {
      const { c24, hear } = channel({ unit, rate: 0 })
      hear(`ABCDEFG123${CRLF}`)
      assert.strictEqual(c24.memory.get(0x600), count)
      assert.strictEqual(hex(c24.memory.words(0x601, 5)), IMAGE)
      assert.strictEqual(c24.memory.get(0x606), 0)
    })
  }
  it('channel 2 has it at A00H', () => {
    const { c24, hear } = channel({ channel: 2, rate: 0 })
    hear(`ABCDEFG123${CRLF}`)
    assert.strictEqual(hex(c24.memory.words(0xa00, 6)), `0005 ${IMAGE}`)
    assert.strictEqual(c24.memory.get(0x600), 0)
  })
  it('an odd byte gets 00H above it; the end code is stored where the setting says so', () => {
    const { c24, hear } = channel({ rate: 0 })
    hear(`ABC${CRLF}`)
    assert.strictEqual(hex(c24.memory.words(0x600, 3)), '0002 4241 0043')
    const other = channel({ rate: 0, unit: 'byte', storeEnd: true })
    other.hear(`ABC${CRLF}`)
    assert.strictEqual(hex(other.c24.memory.words(0x600, 4)), '0005 4241 0D43 000A')
  })
  it('the end code counts as a pair', () => {
    const { c24, hear } = channel()
    hear(`A\rB\nC\r\r\n`)
    assert.deepStrictEqual(
      c24.messages.map(message => shown(message.bytes)),
      ['41 0D 42 0A 43 0D']
    )
  })
  it('the receive data count ends it, too: 511 words, 511 bytes, or what is set', () => {
    const lengths = settings => {
      const { c24, hear } = channel(settings)
      hear(Buffer.alloc(3000, 0x41))
      return c24.messages.map(message => [message.bytes.length, message.by, message.count])
    }
    assert.deepStrictEqual(lengths({}), Array(2).fill([1022, 'count', 511]))
    assert.deepStrictEqual(lengths({ unit: 'byte' }), Array(5).fill([511, 'count', 511]))
    assert.deepStrictEqual(lengths({ count: 500, end: '' }), Array(3).fill([1000, 'count', 500]))
  })
  const channelWithOdd = () => {
    const { c24, hear } = channel({ first: '02', last: '03', rate: 0 })
    hear('\x02ABC\x03')
    return hex(c24.memory.words(0x600, 3))
  }
  it('user frames: what comes before is skipped, an odd byte is lost in word units', () => {
    const { c24, hear } = channel({ first: '02', last: '03 0D' })
    hear('noise\x02ABC\x03\r\x02DE\x03F\x03\r')
    assert.deepStrictEqual(
      c24.messages.map(message => [message.bytes.toString('latin1'), message.by]),
      [
        ['AB', 'frame'],
        ['DE\x03F', 'frame']
      ]
    )
    // all words stand there, but not all are counted
    assert.strictEqual(channelWithOdd(), '0001 4241 0043')
    assert.strictEqual(c24.counts.skipped, 5)
  })
  it('transparent code', () => {
    const { c24, hear } = channel({ transparent: '10', flow: 'dc', unit: 'byte' })
    hear(bytes('41 10 13 10 10 10 11 42 0D 0A'))
    assert.strictEqual(shown(c24.messages[0].bytes), '41 13 10 11 42')
    assert.deepStrictEqual([c24.counts.halted, c24.counts.resumed], [0, 0])
    // what stands behind it is data, also where it looks like the end
    hear(bytes('41 10 0D 0A 42 0D 0A'))
    assert.strictEqual(shown(c24.messages[1].bytes), '41 0D 0A 42')
  })
  it('ASCII-binary: the complete code is converted, too, user frames are not; half a byte hides it', () => {
    const taken = (settings, sent) => {
      const { c24, hear } = channel({ asciiBinary: true, ...settings })
      hear(sent)
      return [c24.messages.map(message => shown(message.bytes)), c24.counts.conversionErrors]
    }
    assert.deepStrictEqual(taken({}, '41FF0D0D0A420D0A'), [['41 FF 0D', '42'], 0])
    assert.deepStrictEqual(taken({ storeEnd: true }, '410D0A'), [['41 0D 0A'], 0])
    assert.deepStrictEqual(taken({}, '4g0D0A410D0A'), [['41'], 1])
    assert.deepStrictEqual(taken({}, '410D00A0D0A'), [[], 0])
    assert.deepStrictEqual(taken({ first: '02', last: '03', unit: 'byte' }, '\x0241FF0D\x03'), [['41 FF 0D'], 0])
    assert.deepStrictEqual(taken({ end: '', count: 2 }, '4142434445464748'), [['41 42 43 44', '45 46 47 48'], 0])
  })

  // protocols page: a peer that pauses up to 50 ms at 9600 bit/s needs 41
  for (const [timer0, expected] of [
    [41, ['SET 125']],
    [40, ['SET 12', '5']]
  ]) {
    it(`timer 0 of ${timer0} bytes: after a pause of 50 ms ${JSON.stringify(expected)}`, async () => {
      const { clock, c24, end } = onWire({ timer0 })
      end.write(text('SET 12'))
      await clock.advance(6 * byteMs + 50)
      end.write(text('5'))
      await clock.drain()
      assert.deepStrictEqual(
        c24.messages.map(message => String(message.bytes)),
        expected
      )
      assert.deepStrictEqual([c24.messages[0].by, c24.counts.timeouts], ['timer', expected.length])
    })
  }
  it('timer 0 of one byte does not cut a message without pauses; without it a torn head waits for ever', async () => {
    const { clock, c24, end } = onWire({ timer0: 1 })
    end.write(text(`${'A'.repeat(400)}${CRLF}`))
    await clock.drain()
    assert.deepStrictEqual(
      c24.messages.map(({ by }) => by),
      ['code']
    )
    const other = onWire()
    other.end.write(text('SET 12'))
    await other.clock.advance(1e6)
    other.end.write(text(`SET 125${CRLF}`))
    await other.clock.drain()
    assert.strictEqual(String(other.c24.messages[0].bytes), 'SET 12SET 125')
  })
  it('timer 0 also parts what waits in the OS area', async () => {
    const { clock, c24, end } = onWire({ timer0: 41, rate: 0 })
    end.write(text(`FIRST${CRLF}SET 12`))
    await clock.drain()
    end.write(text(`SET 125${CRLF}`))
    await clock.drain()
    const taken = [c24.take(), c24.take(), c24.take(), c24.take()]
    assert.deepStrictEqual(
      taken.map(message => message && String(message.bytes)),
      ['FIRST', 'SET 12', 'SET 125', null]
    )
  })
})
