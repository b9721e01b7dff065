'use strict'
const assert = require('node:assert/strict')
const fc = require('fast-check')
const { lrc } = require('../../lib/codec/lrc')
const { hex } = require('./support/oracle')
const { EXCHANGES } = require('../vectors/modbus')

describe('LRC', () => {
  for (const each of EXCHANGES) {
    it(`of ${each.name}`, () => {
      assert.equal(lrc(hex(each.q)), parseInt(each.lrc[0], 16))
      assert.equal(lrc(hex(each.r)), parseInt(each.lrc[1], 16))
    })
  }

  it('of a part; of nothing it is 0', () => {
    assert.equal(lrc([9, 0x11, 0x03, 0x00, 0x6b, 0x00, 0x03, 9], 1, 7), 0x7e)
    assert.equal(lrc([]), 0)
    assert.equal(lrc([0x80, 0x80]), 0)
  })

  it('makes the sum of all bytes 0', () => {
    fc.assert(
      fc.property(fc.uint8Array(), bytes => {
        const sum = [...bytes, lrc(bytes)].reduce((all, byte) => all + byte, 0)
        assert.equal(sum % 256, 0)
      })
    )
  })
})
