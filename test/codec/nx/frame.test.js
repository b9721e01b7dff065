'use strict'
const assert = require('node:assert/strict')
const fc = require('fast-check')
const { LONGEST, SHORTEST, encodeFrame, decodeFrame, frameLength } = require('../../../lib/codec/nx/frame')
const { frame, hex, show } = require('../support/oracle')
const { EXCHANGES, QA, RR, ERROR_2 } = require('../../vectors/nx')

const byte = fc.nat(255)
const parts = fc.record({ to: byte, from: byte, fn: byte, info: fc.uint8Array({ minLength: 1, maxLength: 256 }) })

describe('NX frame', () => {
  it('is laid out as by hand, for any content', () => {
    fc.assert(
      fc.property(parts, ({ to, from, fn, info }) => {
        const bytes = encodeFrame({ to, from, fn, info })
        assert.equal(show(bytes), show(frame([to, from, fn], [...info])))
        const back = decodeFrame(bytes)
        assert.deepEqual(
          [back.to, back.from, back.fn, [...back.info], back.length],
          [to, from, fn, [...info], bytes.length]
        )
      })
    )
  })

  it('has LEN 00 for 256 bytes, and is 7 to 262 bytes long', () => {
    const longest = encodeFrame({ to: 1, from: 0xe2, fn: 3, info: new Uint8Array(256) })
    assert.deepEqual([longest.length, longest[3], frameLength(longest)], [262, 0, 262])
    const shortest = encodeFrame({ to: 1, from: 0xe2, fn: 0, info: [0] })
    assert.deepEqual([shortest.length, shortest[3], frameLength(shortest)], [7, 1, 7])
    assert.equal(encodeFrame({ to: 1, from: 2, fn: 3, info: new Uint8Array(255) })[3], 255)
  })

  it('cannot hold no byte or 257, nor what is no byte', () => {
    const good = { to: 1, from: 0xe2, fn: 3, info: [0] }
    assert.throws(() => encodeFrame({ ...good, info: [] }), { code: 'BAD_SETTING' })
    assert.throws(() => encodeFrame({ ...good, info: new Uint8Array(257) }), { code: 'FRAME_TOO_LONG' })
    for (const bad of [-1, 256, 1.5, NaN, undefined, '1']) {
      for (const key of ['to', 'from', 'fn'])
        assert.throws(() => encodeFrame({ ...good, [key]: bad }), { code: 'BAD_SETTING' })
    }
  })

  it('says what is wrong', () => {
    const good = { to: 1, from: 0xe2, fn: 3, info: [0] }
    const says = (frameParts, details) => assert.throws(() => encodeFrame({ ...good, ...frameParts }), { details })
    says({ info: [] }, { setting: 'info', value: 'empty', reason: 'LEN 0 means 256 bytes' })
    says({ info: new Uint8Array(257) }, { what: 'INFO', got: 257, most: 256 })
    for (const key of ['to', 'from', 'fn'])
      says({ [key]: 256 }, { setting: key, value: 256, reason: 'it must be a byte, 0 to 255' })
    assert.deepEqual([SHORTEST, LONGEST], [7, 262])
  })

  it('its length is known from the fourth byte on', () => {
    const bytes = hex(RR)
    for (const n of [0, 1, 2, 3]) assert.equal(frameLength(bytes.subarray(0, n)), 0)
    for (const n of [4, 5, 6, 7]) assert.equal(frameLength(bytes.subarray(0, n)), 7)
    assert.equal(frameLength(hex(`00 ${RR}`), 1), 7)
    assert.equal(frameLength(hex(`00 ${RR}`).subarray(0, 4), 1), 0)
  })

  it('is decoded where it begins, and leaves what follows', () => {
    const { to, from, fn, info, length } = decodeFrame(hex(`FF FF ${QA} ${RR}`), 2)
    assert.deepEqual([to, from, fn, [...info], length], [0xe2, 1, 0x80, [0], 7])
  })

  const all = [QA, RR, ...ERROR_2, ...EXCHANGES.flatMap(each => (each.r ? [each.q, each.r] : [each.q]))]
  it('is refused cut at each byte and with any bit turned', () => {
    for (const text of all) {
      const bytes = hex(text)
      assert.ok(decodeFrame(bytes), text)
      for (let n = 0; n < bytes.length; n++) assert.equal(decodeFrame(bytes.subarray(0, n)), null)
      for (let bit = 0; bit < bytes.length * 8; bit++) {
        const turned = Buffer.from(bytes)
        turned[bit >> 3] ^= 1 << (bit & 7)
        assert.equal(decodeFrame(turned), null, `bit ${bit} of ${text}`)
      }
    }
  })
})
