'use strict'

const assert = require('node:assert/strict')
const { distinctNames, parseItem } = require('../../lib/tag/item')
const { nxNotation } = require('../../lib/tag/nx-notation')
const { decodeValue, encodeValue } = require('../../lib/tag/value')

const notation = nxNotation()
const item = text => parseItem(text, notation)
const code = expected => error => error.code === expected
const withTag = tag => parseItem(tag.name, nxNotation({ tags: [tag] }))

describe('items', () => {
  // absolute addresses by hand: docs/nx.md, K127 = 140h + 127 = 1BFh, its bit 12 = 1BFCh; W0 = 200h
  const known = [
    // text, name, kind, address, values, type
    ['M0', 'M0', 'word', 0xc0, 1, 'uint16'],
    ['m000', 'M0', 'word', 0xc0, 1, 'uint16'],
    ['K127.12', 'K127_12', 'bit', 0x1bfc, 1, 'bool'],
    ['W10:float32', 'W10', 'word', 0x20a, 1, 'float32'],
    ['W20:string[8]', 'W20', 'word', 0x214, 1, 'string[8]'],
    ['M0..M127', 'M0_M127', 'word', 0xc0, 128, 'uint16'],
    ['W0..W9:float32', 'W0_W9', 'word', 0x200, 5, 'float32'],
    ['K1.14..K2.1', 'K1_14_K2_1', 'bit', 0x141e, 4, 'bool'],
    ['TC5', 'TC5', 'bit', 0x1d05, 1, 'bool'],
    ['@0x00C0', '_0x00C0', 'word', 0xc0, 1, 'uint16'],
    ['@bit:0x1BFC', '_0x01BF_12', 'bit', 0x1bfc, 1, 'bool'],
    ['@0x00C0:int32', '_0x00C0', 'word', 0xc0, 1, 'int32'],
    ['W10 : int16', 'W10', 'word', 0x20a, 1, 'int16']
  ]
  for (const [text, name, kind, address, count, type] of known) {
    it(text, () => {
      const { name: key, kind: as, address: at, count: values, type: of, range } = item(text)
      assert.deepEqual([key, as, at, values, of.name, range], [name, kind, address, count, type, count > 1])
      assert.match(key, /^[A-Za-z_]\w*$/)
    })
  }

  it('names each value of a range', () => {
    const names = text => item(text).elements.map(element => element.name)
    assert.deepEqual(names('W0..W3:float32'), ['W0', 'W2'])
    assert.deepEqual(names('K1.15..K2.0'), ['K1_15', 'K2_0'])
  })

  const wrong = [
    ['M128', 'OUT_OF_AREA'],
    ['Q1', 'UNKNOWN_AREA'],
    ['K1.16', 'BAD_BIT'],
    ['hello', 'BAD_ADDRESS'],
    ['', 'BAD_ITEMS'],
    ['   ', 'BAD_ITEMS'],
    [7, 'BAD_ITEMS'],
    [null, 'BAD_ITEMS'],
    [{}, 'BAD_ITEMS'],
    ['M0:int8', 'BAD_TYPE'],
    ['M0:bool', 'BAD_TYPE'],
    ['K1.3:int16', 'BAD_TYPE'],
    ['W0..W2:float32', 'BAD_TYPE'],
    ['M127:float32', 'OUT_OF_AREA'],
    ['W2040:string[100]', 'OUT_OF_AREA'],
    ['__proto__', 'BAD_ADDRESS'],
    ['constructor', 'BAD_ADDRESS']
  ]
  for (const [text, expected] of wrong) {
    it(`refuses ${JSON.stringify(text)}: ${expected}`, () => assert.throws(() => item(text), code(expected)))
  }

  it('keeps keys apart', () => {
    const names = (...texts) => distinctNames(texts.map(item)).map(each => each.name)
    assert.deepEqual(names('W10', 'W10:float32', 'M0'), ['W10', 'W10_float32', 'M0'])
    assert.deepEqual(names('W10:int16', 'W10:string[4]'), ['W10_int16', 'W10_string_4'])
    assert.deepEqual(names('M0', 'm0', 'M0'), ['M0', 'M0', 'M0'])
    const tagged = nxNotation({ tags: [{ name: 'K127_12', address: 'M5' }] })
    const both = ['K127.12', 'K127_12'].map(text => parseItem(text, tagged))
    assert.throws(() => distinctNames(both), code('BAD_ITEMS'))
  })
})

describe('values of items', () => {
  const tag = { name: 't', address: 'K0', type: 'int16', scale: 0.1, offset: -20, min: -10, max: 100 }

  it('scales without the noise of binary fractions', () => {
    const scaled = withTag(tag)
    // by hand: 453 / 10 - 20
    assert.deepEqual(decodeValue(scaled, [453]), { value: 25.3 })
    assert.deepEqual(decodeValue(scaled, [203]), { value: 0.3 })
    assert.deepEqual(decodeValue(scaled, [200]), { value: 0 })
    assert.deepEqual(encodeValue(scaled, 25.3), [[453]])
    assert.deepEqual(encodeValue(scaled, '0.3'), [[203]])
  })

  it('rounds to the nearest raw number, halves away from zero', () => {
    const ten = withTag({ name: 't', address: 'K0', type: 'int16', scale: 10 })
    assert.deepEqual(encodeValue(ten, 14), [[1]])
    assert.deepEqual(encodeValue(ten, 15), [[2]])
    assert.deepEqual(encodeValue(ten, -15), [[0x10000 - 2]])
    assert.deepEqual(encodeValue(ten, -14), [[0x10000 - 1]])
    assert.deepEqual(encodeValue(ten, -4), [[0]])
  })

  it('every raw number survives the way there and back', () => {
    for (const scale of [0.1, 0.01, 0.5, 3, -2, 1 / 3]) {
      const each = withTag({ name: 't', address: 'K0', type: 'int16', scale, offset: 7.25 })
      for (let raw = 0; raw < 0x10000; raw += 97) {
        const { value } = decodeValue(each, [raw])
        assert.deepEqual(encodeValue(each, value), [[raw]], `${raw} × ${scale}`)
      }
    }
  })

  it('min and max bind the engineering value, also as it goes out', () => {
    const limited = withTag(tag)
    for (const value of [-10.1, 100.1, 1e9]) {
      assert.throws(() => encodeValue(limited, value), code('VALUE_OUT_OF_RANGE'), String(value))
    }
    assert.deepEqual(encodeValue(limited, 100), [[1200]])
    const coarse = withTag({ name: 't', address: 'K0', scale: 10, max: 16 })
    assert.throws(() => encodeValue(coarse, 16), code('VALUE_OUT_OF_RANGE'), 'would go out as 20')
    const open = withTag({ name: 't', address: 'K0', scale: 0.1 })
    assert.throws(
      () => encodeValue(open, 6553.6),
      error => code('VALUE_OUT_OF_RANGE')(error) && error.details.most === 6553.5
    )
  })

  it('ranges take arrays of their length', () => {
    assert.deepEqual(encodeValue(item('K0..K2'), [1, '2', 3]), [[1], [2], [3]])
    assert.deepEqual(encodeValue(item('K0..K3:float32'), [1.5, 0]), [
      [0, 0x3fc0],
      [0, 0]
    ])
    for (const value of [1, [1, 2], [1, 2, 3, 4], new Array(3), [1, null, 3]]) {
      assert.throws(() => encodeValue(item('K0..K2'), value), code('BAD_VALUE'))
    }
    assert.throws(() => encodeValue(item('K0'), [1]), code('BAD_VALUE'))
  })

  it('what cannot be a value has a code and a reason', () => {
    const bad = decodeValue(item('W0:float32'), [0, 0x7fc0])
    assert.equal(bad.code, 'NOT_A_VALUE')
    assert.match(bad.text, /W0:float32 cannot be read as float32/)
  })
})
