'use strict'

const assert = require('node:assert/strict')
const { loopback } = require('../../../lib/codec/modbus/loopback')
const { toAscii } = require('../../../lib/codec/modbus/ascii')
const { answerTo } = require('../../../lib/codec/modbus/match')
const { crc, rtu, ascii } = require('../../device/slave')
const { STATION } = require('../../vectors/modbus')

// "MODBUS application protocol" 6.8: request 08 00 00 A5 37, response the same; the check codes are those of other code
const BODY = [STATION, 0x08, 0x00, 0x00, 0xa5, 0x37]
const EMPTY = Buffer.alloc(0)

describe('MODBUS 08, sub-function 0000', () => {
  for (const [protocol, framed] of [
    ['rtu', rtu],
    ['ascii', ascii]
  ]) {
    const frame = framed(BODY)
    const query = () => loopback(0xa537, { station: STATION, protocol })

    it(`${protocol}: the example of the specification, both ways`, () => {
      const { send, match, proves, exception } = query()
      assert.deepEqual(send, frame)
      assert.deepEqual(match(frame), { take: frame.length })
      assert.equal(proves(frame), true)
      assert.equal(exception(frame), 0)
      for (let length = 0; length < frame.length; length++) {
        const verdict = match(frame.subarray(0, length))
        assert.ok(verdict.need > length && verdict.need <= frame.length, `${length}: ${JSON.stringify(verdict)}`)
      }
    })

    it(`${protocol}: no other number, station, function or sub-function is its answer, nor a damaged one`, () => {
      const { match, proves } = query()
      for (const [at, value] of [
        [0, STATION + 1],
        [1, 0x06],
        [2, 0x01],
        [3, 0x0a],
        [4, 0xa4],
        [5, 0x36]
      ]) {
        const other = framed(BODY.map((byte, n) => (n === at ? value : byte)))
        assert.equal(match(other).take, undefined, `byte ${at}`)
        assert.equal(proves(other), false)
      }
      for (let bit = 0; bit < frame.length * 8; bit++) {
        const damaged = Buffer.from(frame)
        damaged[bit >> 3] ^= 1 << (bit & 7)
        assert.equal(match(damaged).take, undefined, `bit ${bit}`)
      }
    })

    it(`${protocol}: an exception is taken and proves nothing`, () => {
      const { match, proves, exception } = query()
      const refusal = framed([STATION, 0x88, 0x01])
      assert.deepEqual(match(refusal), { take: refusal.length })
      assert.equal(proves(refusal), false)
      assert.equal(exception(refusal), 1)
      assert.equal(exception(framed([STATION, 0x83, 0x01])), 0)
      assert.equal(exception(framed([STATION + 1, 0x88, 0x01])), 0)
      assert.equal(exception(EMPTY), 0)
    })
  }

  it('a late answer to it is stepped over as a whole by who waits for another one', () => {
    // its number looks like the beginning of the awaited answer
    const body = [STATION, 0x08, 0x00, 0x00, STATION, 0x03]
    const late = Buffer.from([...body, ...crc(body)])
    const awaited = answerTo({ fn: 3, base: 0, count: 1 }, { station: STATION })
    assert.deepEqual(awaited(late), { skip: late.length })
    assert.deepEqual(awaited(late.subarray(0, 6)), { need: 8, ours: false })
    const answer = rtu([STATION, 3, 2, 0, 7])
    assert.deepEqual(awaited(Buffer.concat([late, answer])), { skip: 8 })
    const text = answerTo({ fn: 3, base: 0, count: 1 }, { station: STATION, protocol: 'ascii' })
    assert.deepEqual(text(toAscii(late)), { skip: toAscii(late).length })
  })
})
