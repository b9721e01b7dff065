'use strict'
const assert = require('node:assert/strict')
const fc = require('fast-check')
const { crc16 } = require('../../lib/codec/crc16')
const { crc } = require('./support/oracle')

describe('CRC-16', () => {
  it('has the check value of the reflected polynomial $A001 with start $FFFF', () => {
    assert.equal(crc16(Buffer.from('123456789')), 0x4b37)
    assert.equal(crc16(Buffer.alloc(0)), 0xffff)
  })

  it('takes only the bytes from start to end', () => {
    assert.equal(crc16(Buffer.from('xx123456789yy'), 2, 11), 0x4b37)
    assert.equal(crc16([0x31, 0x32, 0x33, 0x34, 0x35, 0x36, 0x37, 0x38, 0x39]), 0x4b37)
  })

  it('is the same as the bitwise routine of the manual', () => {
    fc.assert(
      fc.property(fc.uint8Array({ maxLength: 270 }), bytes => {
        const sum = crc16(bytes)
        assert.deepEqual([sum & 0xff, sum >> 8], crc([...bytes]))
      })
    )
  })
})
