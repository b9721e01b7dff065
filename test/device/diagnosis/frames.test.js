'use strict'
const assert = require('node:assert/strict')
const { findFrames } = require('../../../lib/device/diagnosis/frames')
const { EXCHANGES } = require('../../vectors/modbus')
const { hex } = require('../../codec/support/oracle')
const { nx, rtu } = require('../diagnose-bench')

const brief = frames => frames.map(({ protocol, station, query, at, length }) => [protocol, station, query, at, length])

describe('frames among stray bytes', () => {
  for (const { name, query, q, r, crc, lrc } of EXCHANGES) {
    const isRead = query.fn <= 4
    for (const [what, body, n] of /** @type {[string, string, number]} */ ([
      ['request', q, 0],
      ['answer', r, 1]
    ])) {
      // the answer to 05 and 06 equals its request, that to 0F and 10 looks like nothing else
      const asked = what === 'request' && (isRead || query.fn >= 15)
      it(`${name}: ${what}, RTU and ASCII, also behind noise`, () => {
        const frame = hex(body + crc[n])
        assert.deepEqual(brief(findFrames(frame, 'rtu')), [['rtu', 17, asked, 0, frame.length]])
        const noisy = Buffer.concat([Buffer.of(0xff, 0x00), frame, Buffer.of(0x55)])
        assert.deepEqual(brief(findFrames(noisy, 'rtu')), [['rtu', 17, asked, 2, frame.length]])
        const text = Buffer.from(`:${(body + lrc[n]).replaceAll(' ', '')}\r\n`)
        assert.deepEqual(
          findFrames(text, 'rtu').map(({ protocol, station }) => [protocol, station]),
          [['ascii', 17]]
        )
      })
    }
  }

  it('NX: the query of the manual, an answer, a request for a response', () => {
    const query = hex('01 E2 23 03 BF 01 01 28 75')
    const answer = nx(0xe2, 1, 0xa3, 0x34, 0x12)
    const found = findFrames(Buffer.concat([query, answer]), 'nx')
    assert.deepEqual(brief(found), [
      ['nx', 1, true, 0, 9],
      ['nx', 1, false, 9, 8]
    ])
    assert.equal(found[1].to, 0xe2)
  })

  it('NX: who asks and who answers', () => {
    for (const [bytes, station, query] of /** @type {[Buffer, number, boolean][]} */ ([
      [nx(3, 0xe2, 0x23, 1, 0xbf, 1, 1), 3, true],
      [nx(3, 0xe2, 0x00, 0), 3, true],
      [nx(0xe2, 3, 0x00, 0), 3, false],
      [nx(100, 3, 0xa3, 5, 0, 6, 0), 3, false]
    ])) {
      const [found] = findFrames(bytes, 'nx')
      assert.deepEqual([found.station, found.query], [station, query], bytes.toString('hex'))
    }
  })

  it('no MODBUS station has a number above 247', () => {
    assert.equal(findFrames(rtu(247, 3, 2, 0, 7), 'rtu').length, 1)
    assert.deepEqual(findFrames(rtu(248, 3, 2, 0, 7), 'rtu'), [])
  })

  it('bytes that can be both are those of the protocol that is expected', () => {
    // receiver 226, sender 6, LEN 2: to MODBUS a write of station 226
    const both = nx(0xe2, 6, 0xa3, 1, 2)
    assert.deepEqual([findFrames(both, 'nx')[0].protocol, findFrames(both, 'rtu')[0].protocol], ['nx', 'rtu'])
  })

  it('exceptions, also of functions that the protocol does not have here', () => {
    assert.deepEqual(brief(findFrames(rtu(4, 0x83, 2), 'rtu')), [['rtu', 4, false, 0, 5]])
    assert.deepEqual(findFrames(rtu(4, 0xc1, 2), 'rtu'), [])
  })

  it('damage of any one bit: no frame', () => {
    const frame = rtu(3, 3, 4, 0, 7, 0, 8)
    for (let bit = 0; bit < frame.length * 8; bit++) {
      const copy = Buffer.from(frame)
      copy[bit >> 3] ^= 1 << (bit & 7)
      assert.deepEqual(findFrames(copy, 'rtu'), [], `bit ${bit}`)
    }
  })

  it('any bytes, cut anywhere: it ends, and finds what lies within', () => {
    const bytes = Buffer.from(Array.from({ length: 2000 }, (_, n) => (n * 7919 + (n >> 3)) & 0xff))
    for (let at = 0; at < 300; at++) {
      for (const { at: from, length } of findFrames(bytes.subarray(at, at + 40), 'nx')) assert.ok(from + length <= 40)
    }
    assert.ok(Array.isArray(findFrames(bytes, 'rtu')))
  })
})
