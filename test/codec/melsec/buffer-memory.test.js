'use strict'
const assert = require('node:assert/strict')
const fc = require('fast-check')
const { fromBufferMemory, toBufferMemory } = require('../../../lib/codec/melsec/buffer-memory')
const { IMAGE, TEXT, bytes } = require('../../vectors/melsec')

const code = wanted => error => error.code === wanted
const end = bytes('0D 0A')

describe('MELSEC buffer memory', () => {
  it('the data list of the manual: ABCDEFG123', () => {
    assert.deepEqual(toBufferMemory(Buffer.from(TEXT)), [IMAGE.word, ...IMAGE.words])
    assert.deepEqual(toBufferMemory(Buffer.from(TEXT), { unit: 'byte' }), [IMAGE.byte, ...IMAGE.words])
    assert.deepEqual(fromBufferMemory([5, ...IMAGE.words]), Buffer.from(TEXT))
    assert.deepEqual(fromBufferMemory([10, ...IMAGE.words], { unit: 'byte' }), Buffer.from(TEXT))
  })

  it('an odd byte gets 00H above it', () => {
    assert.deepEqual(toBufferMemory(Buffer.from('ABC')), [2, 0x4241, 0x0043])
    assert.deepEqual(toBufferMemory(Buffer.from('ABC'), { unit: 'byte' }), [3, 0x4241, 0x0043])
    assert.deepEqual(fromBufferMemory([3, 0x4241, 0x0043], { unit: 'byte' }), Buffer.from('ABC'))
    assert.deepEqual(fromBufferMemory([2, 0x4241, 0x0043]), Buffer.from('ABC\0'))
  })

  it('user frames in word units: the last byte of an odd count is not counted', () => {
    assert.deepEqual(toBufferMemory(Buffer.from('ABC'), { userFrames: true }), [1, 0x4241, 0x0043])
    assert.deepEqual(fromBufferMemory([1, 0x4241, 0x0043]), Buffer.from('AB'))
  })

  it('the end code is stored and counted, or not: a setting', () => {
    assert.deepEqual(toBufferMemory(Buffer.from('AB'), { end }), [1, 0x4241])
    assert.deepEqual(toBufferMemory(Buffer.from('AB'), { end, storeEnd: true }), [2, 0x4241, 0x0a0d])
    assert.deepEqual(toBufferMemory(Buffer.from('A'), { end, storeEnd: true }), [2, 0x0d41, 0x000a])
    assert.deepEqual(fromBufferMemory([2, 0x0d41, 0x000a], { end, storeEnd: true }), Buffer.from('A'))
    assert.deepEqual(fromBufferMemory([4, 0x4241, 0x0a0d], { end, storeEnd: true, unit: 'byte' }), Buffer.from('AB'))
  })

  it('an end code that is not stored there is not taken away', () => {
    assert.deepEqual(fromBufferMemory([1, 0x4241], { end, storeEnd: true }), Buffer.from('AB'))
    assert.deepEqual(fromBufferMemory([1, 0x0041], { end, storeEnd: true, unit: 'byte' }), Buffer.from('A'))
    assert.deepEqual(fromBufferMemory([1, 0x4241], { storeEnd: true }), Buffer.from('AB'))
    assert.deepEqual(fromBufferMemory([1, 0x0041], { storeEnd: true }), Buffer.from('A\0'))
    assert.deepEqual(fromBufferMemory([2, 0x4241, 0x0a0d], { end }), Buffer.from('AB\r\n'))
    // 0AH 00H is no end code where bytes are counted
    assert.deepEqual(
      fromBufferMemory([4, 0x0d41, 0x000a], { end, storeEnd: true, unit: 'byte' }),
      Buffer.from('A\r\n\0')
    )
    assert.deepEqual(fromBufferMemory([1, 0xffff]), Buffer.from([255, 255]))
  })

  it('says what is wrong', () => {
    const item = 'the buffer memory'
    assert.throws(() => fromBufferMemory([]), { details: { item, value: [], reason: 'a count and words are needed' } })
    const few = { item, value: [2, 1], reason: '2 words are counted, 1 words are there' }
    assert.throws(() => fromBufferMemory([2, 1]), { details: few })
    assert.throws(() => toBufferMemory(Buffer.alloc(9), { most: 4 }), {
      details: { what: 'the message', got: 9, most: 8 }
    })
  })

  it('takes the rest of the area, and nothing that is no image', () => {
    assert.deepEqual(fromBufferMemory([1, 0x4241, 7, 7]), Buffer.from('AB'))
    for (const image of [[], [2, 1], [1, 70000], [1, -1], [1, 1.5], 'AB', null]) {
      assert.throws(() => fromBufferMemory(/** @type {any} */ (image)), code('BAD_VALUE'))
    }
    assert.throws(() => toBufferMemory(Buffer.alloc(1023)), code('FRAME_TOO_LONG'))
    assert.equal(toBufferMemory(Buffer.alloc(1022)).length, 512)
  })

  it('there and back', () => {
    const options = fc.record({ unit: fc.constantFrom('word', 'byte'), storeEnd: fc.boolean(), end: fc.constant(end) })
    fc.assert(
      fc.property(fc.uint8Array({ maxLength: 60 }), options, (body, given) => {
        const exact = given.unit === 'byte' || given.storeEnd || body.length % 2 === 0
        const expected = exact ? body : [...body, 0]
        // a body that ends as if an end code were stored has none that could be told apart
        fc.pre(!given.storeEnd || body.at(-1) !== 0x0a)
        assert.deepEqual([...fromBufferMemory(toBufferMemory(body, given), given)], [...expected])
      })
    )
  })
})
