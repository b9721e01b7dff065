'use strict'

const assert = require('node:assert')
const { byteMs, channel, CRLF, onWire, shown, text } = require('./c24-support')

describe('simulated C24: OS area', () => {
  /** The receive area is occupied, the OS area empty. */
  function occupied(settings) {
    const run = channel({ rate: 0, ...settings })
    run.hear(`X${CRLF}`)
    assert.strictEqual(run.c24.os().free, 8448)
    return run
  }

  it('DC3 at exactly 64 free bytes, once; DC1 at exactly 263', () => {
    const { c24, hear, said } = occupied({ flow: 'dc', end: '0D 0A', unit: 'byte' })
    hear('A'.repeat(500) + CRLF)
    hear(Buffer.alloc(8448 - 65 - 502, 0x42))
    assert.deepStrictEqual([c24.os().free, said()], [65, ''])
    hear('B')
    assert.deepStrictEqual([c24.os().free, said()], [64, '13'])
    hear('BB')
    assert.deepStrictEqual([c24.os().free, said(), c24.counts.stops], [62, '13', 1])
  })
  it('the go at 263 and not at 262', () => {
    const { c24, hear, said } = occupied({ flow: 'dc' })
    hear('A'.repeat(196) + CRLF)
    hear(`c${CRLF}`)
    hear(Buffer.alloc(8448 - 64 - 198 - 3, 0x42))
    assert.deepStrictEqual([c24.os().free, said()], [64, '13'])
    // X makes room for the A's (198): 262, and then for c (3): 265
    c24.take()
    assert.deepStrictEqual([c24.os().free, said()], [262, '13'])
    c24.take()
    assert.deepStrictEqual([c24.os().free, said()], [265, '13 11'])
    const exact = occupied({ flow: 'dc' })
    exact.hear('A'.repeat(197) + CRLF)
    exact.hear(Buffer.alloc(8448 - 64 - 199, 0x42))
    exact.c24.take()
    assert.deepStrictEqual([exact.c24.os().free, exact.said()], [263, '13 11'])
  })
  it('the limits are settings, 64..4095 and 263..4096', () => {
    const { c24, hear, said } = occupied({ flow: 'dc', stopFree: 4095, goFree: 4096 })
    hear(Buffer.alloc(8448 - 4096, 0x42))
    assert.strictEqual(said(), '')
    hear('B')
    assert.deepStrictEqual([c24.os().free, said()], [4095, '13'])
    for (const wrong of [{ stopFree: 63 }, { stopFree: 4096 }, { goFree: 262 }, { stopFree: 300, goFree: 300 }]) {
      assert.throws(() => channel(wrong), { code: 'BAD_SETTING' })
    }
  })
  it('DTR off and on at the same limits; nothing is sent', () => {
    const { c24, hear, said, cts } = occupied({ flow: 'dtr' })
    hear('A'.repeat(197) + CRLF)
    hear(Buffer.alloc(8448 - 65 - 199, 0x42))
    assert.deepStrictEqual(cts, [true])
    hear('B')
    assert.deepStrictEqual(cts, [true, false])
    c24.take()
    assert.deepStrictEqual([cts, said()], [[true, false, true], ''])
  })
  it('without room: SIO error, discarded until there is room, the rest is as it was', () => {
    const { c24, hear } = occupied({ unit: 'byte' })
    hear('A'.repeat(98) + CRLF)
    hear(Buffer.alloc(8348, 0x42))
    assert.deepStrictEqual([c24.os().free, c24.sioError(), c24.memory.get(0x201)], [0, false, 0])
    hear('LOST')
    assert.deepStrictEqual([c24.counts.discarded, c24.sioError(), c24.memory.get(0x201)], [4, true, 2])
    c24.take()
    assert.strictEqual(c24.os().free, 100)
    hear(`!${CRLF}`)
    assert.strictEqual(String(c24.take().bytes), 'A'.repeat(98))
    const { bytes: rest } = c24.take()
    assert.strictEqual(String(rest), 'B'.repeat(511))
    // the error stays until the program clears it
    assert.strictEqual(c24.sioError(), true)
    c24.clearError()
    assert.deepStrictEqual([c24.sioError(), c24.counts.sioErrors], [false, 1])
    assert.strictEqual(channel({ channel: 2 }).c24.memory.get(0x202), 0)
  })
  it('after switching on nothing is sent, also after a stop: the other side must assume that it may send', () => {
    const { c24, hear, said } = occupied({ flow: 'dc' })
    hear(Buffer.alloc(8448 - 64, 0x42))
    assert.strictEqual(said(), '13')
    c24.powerOn()
    assert.deepStrictEqual(
      [said(), c24.os(), c24.memory.get(0x600)],
      ['13', { held: 0, free: 8448, stopped: false }, 0]
    )
  })
  it('on a wire: DC3 leaves when the byte has come that makes it 64, a byte later it is heard', async () => {
    const { clock, end, heard } = onWire({ flow: 'dc', rate: 0 })
    end.write(text(`X${CRLF}`))
    end.write(Buffer.alloc(8448 - 64, 0x42))
    await clock.drain()
    const [[at, data]] = heard
    assert.deepStrictEqual([shown(data), Math.round(at / byteMs)], ['13', 3 + 8448 - 64 + 1])
  })
})
