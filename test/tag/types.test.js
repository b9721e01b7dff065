'use strict'

const assert = require('node:assert/strict')
const fc = require('fast-check')
const { parseType } = require('../../lib/tag/types')

// independent of the code: a Buffer with the bytes as the wire has them, low word first
const words = (...bytes) =>
  Array.from({ length: bytes.length / 2 }, (_, at) => bytes[2 * at] | (bytes[2 * at + 1] << 8))
const wordsOf = buffer => words(...buffer)
const made = (size, method, value) => {
  const buffer = Buffer.alloc(size)
  buffer[method](value)
  return wordsOf(buffer)
}
const value = (name, raw, order) => parseType(name).decode(raw, order)
const code = expected => error => error.code === expected

describe('data types', () => {
  const known = [
    ['int16', [0xfffe], -2],
    ['int16', [0x7fff], 32767],
    ['uint16', [0xfffe], 65534],
    ['int32', [0xfffe, 0xffff], -2],
    ['uint32', [0x0001, 0x8000], 0x80000001],
    ['float32', [0x0000, 0x3fc0], 1.5], // IEEE 754: 3FC00000h
    ['float32', [0x0000, 0xc2f6], -123],
    ['bcd16', [0x1234], 1234],
    ['bcd16', [0x9999], 9999],
    ['bcd32', [0x5678, 0x1234], 12345678],
    ['string[5]', [0x4548, 0x4c4c, 0x004f], 'HELLO'],
    ['string[4]', [0x4241, 0x0000], 'AB']
  ]
  for (const [name, raw, expected] of known) {
    it(`${name} ${raw.map(word => word.toString(16)).join(' ')} is ${expected}`, () => {
      assert.deepEqual(value(name, raw), { value: expected })
      assert.deepEqual(parseType(name).encode(expected), raw)
    })
  }

  it('has the high word first where it is told so', () => {
    assert.deepEqual(value('float32', [0x3fc0, 0], { wordOrder: 'high' }), { value: 1.5 })
    assert.deepEqual(parseType('int32').encode(0x12345678, { wordOrder: 'high' }), [0x1234, 0x5678])
    assert.deepEqual(value('bcd32', [0x1234, 0x5678], { wordOrder: 'high' }), { value: 12345678 })
  })

  it('has the high byte of a string first where it is told so', () => {
    assert.deepEqual(value('string[3]', [0x4142, 0x4300], { byteOrder: 'high' }), { value: 'ABC' })
    assert.deepEqual(parseType('string[3]').encode('ABC', { byteOrder: 'high' }), [0x4142, 0x4300])
    assert.deepEqual(parseType('string[3]').encode('ABC'), [0x4241, 0x0043])
  })

  const oracle = [
    ['int16', fc.integer({ min: -0x8000, max: 0x7fff }), x => made(2, 'writeInt16LE', x)],
    ['uint16', fc.integer({ min: 0, max: 0xffff }), x => made(2, 'writeUInt16LE', x)],
    ['int32', fc.integer({ min: -0x80000000, max: 0x7fffffff }), x => made(4, 'writeInt32LE', x)],
    ['uint32', fc.integer({ min: 0, max: 0xffffffff }), x => made(4, 'writeUInt32LE', x)],
    ['float32', fc.float({ noNaN: true, noDefaultInfinity: true }), x => made(4, 'writeFloatLE', x)],
    [
      'bcd16',
      fc.integer({ min: 0, max: 9999 }),
      x => wordsOf(Buffer.from(String(x).padStart(4, '0'), 'hex').reverse())
    ],
    [
      'bcd32',
      fc.integer({ min: 0, max: 99999999 }),
      x => wordsOf(Buffer.from(String(x).padStart(8, '0'), 'hex').reverse())
    ]
  ]
  for (const [name, numbers, expected] of oracle) {
    it(`${name} agrees with Buffer, both ways and in both orders`, () => {
      fc.assert(
        fc.property(numbers, number => {
          const raw = expected(number)
          const type = parseType(name)
          assert.deepEqual(type.encode(number), raw)
          assert.deepEqual(type.decode(raw), { value: number })
          assert.deepEqual(type.encode(number, { wordOrder: 'high' }), [...raw].reverse())
          assert.deepEqual(type.decode([...raw].reverse(), { wordOrder: 'high' }), { value: number })
        })
      )
    })
  }

  it('never gives out as a number what is none', () => {
    assert.match(value('float32', [0, 0x7fc0]).bad, /NaN/)
    assert.match(value('float32', [0, 0x7f80]).bad, /infinity/)
    assert.match(value('float32', [0, 0xff80]).bad, /infinity/)
    assert.match(value('bcd16', [0x12a4]).bad, /12A4h is not BCD/)
    assert.match(value('bcd32', [0x1234, 0xf000]).bad, /not BCD/)
  })

  const refused = [
    ['int16', 32768, 'VALUE_OUT_OF_RANGE'],
    ['int16', -32769, 'VALUE_OUT_OF_RANGE'],
    ['uint16', -1, 'VALUE_OUT_OF_RANGE'],
    ['uint16', 65536, 'VALUE_OUT_OF_RANGE'],
    ['uint32', 4294967296, 'VALUE_OUT_OF_RANGE'],
    ['bcd16', 10000, 'VALUE_OUT_OF_RANGE'],
    ['bcd32', -1, 'VALUE_OUT_OF_RANGE'],
    ['float32', 3.5e38, 'VALUE_OUT_OF_RANGE'],
    ['float32', Infinity, 'BAD_VALUE'],
    ['uint16', NaN, 'BAD_VALUE'],
    ['uint16', 1.5, 'BAD_VALUE'],
    ['uint16', '', 'BAD_VALUE'],
    ['uint16', '  ', 'BAD_VALUE'],
    ['uint16', null, 'BAD_VALUE'],
    ['uint16', undefined, 'BAD_VALUE'],
    ['uint16', true, 'BAD_VALUE'],
    ['uint16', '12 apples', 'BAD_VALUE'],
    ['uint16', '1,5', 'BAD_VALUE'],
    ['float32', 'Infinity', 'BAD_VALUE'],
    ['float32', '1e999', 'BAD_VALUE'],
    ['uint16', {}, 'BAD_VALUE'],
    ['uint16', [1], 'BAD_VALUE'],
    ['bool', 2, 'BAD_VALUE'],
    ['bool', 'yes please', 'BAD_VALUE'],
    ['bool', null, 'BAD_VALUE'],
    ['bool', NaN, 'BAD_VALUE'],
    ['string[3]', 'ABCD', 'BAD_VALUE'],
    ['string[8]', '온도', 'BAD_VALUE'],
    ['string[8]', {}, 'BAD_VALUE']
  ]
  for (const [name, given, expected] of refused) {
    it(`${name} refuses ${typeof given} ${JSON.stringify(given)}`, () => {
      assert.throws(() => parseType(name).encode(given), code(expected))
    })
  }

  it('takes numbers and switches as text', () => {
    assert.deepEqual(parseType('int16').encode(' -12 '), [0xfff4])
    assert.deepEqual(parseType('uint16').encode('0x1F'), [31])
    assert.deepEqual(parseType('float32').encode('1.5'), [0, 0x3fc0])
    for (const on of [true, 1, '1', 'on', 'TRUE', ' On ']) assert.deepEqual(parseType('bool').encode(on), [true])
    for (const off of [false, 0, '0', 'off', 'False']) assert.deepEqual(parseType('bool').encode(off), [false])
  })

  it('names what is no type', () => {
    for (const text of ['int8', '', 'string', 'string[0]', 'string[257]', 'string[x]', 'constructor', '__proto__']) {
      assert.throws(() => parseType(text), code('BAD_TYPE'), text)
    }
    assert.equal(parseType(' STRING[ 8 ] ').words, 4)
    assert.equal(parseType('string[7]').words, 4)
    assert.equal(parseType('Float32').name, 'float32')
  })
})
