'use strict'
const assert = require('node:assert/strict')
const F = require('../../../lib/codec/nx/functions')

// manual "Communication function codes", the whole table: name, Q 2-step, Q 4-step, R 2-step, R 4-step
const MANUAL = [
  ['readBits', 0x21, 0x01, 0xa1, 0x81],
  ['writeBits', 0x22, 0x02, 0xa2, 0x82],
  ['readWords', 0x23, 0x03, 0xa3, 0x83],
  ['writeWords', 0x24, 0x04, 0xa4, 0x84],
  ['readMixed', 0x25, 0x05, 0xa5, 0x85],
  ['writeMixed', 0x26, 0x06, 0xa6, 0x86],
  ['readProgram', 0x27, 0x07, 0xa7, 0x87],
  ['writeProgram', 0x28, 0x08, 0xa8, 0x88],
  ['readInstruction', 0x29, 0x09, 0xa9, 0x89],
  ['changeInstruction', 0x2a, 0x0a, 0xaa, 0x8a],
  ['changeOperand', 0x2b, 0x0b, 0xab, 0x8b],
  ['insertInstruction', 0x2c, 0x0c, 0xac, 0x8c],
  ['deleteInstruction', 0x2d, 0x0d, 0xad, 0x8d],
  ['searchInstruction', 0x2e, 0x0e, 0xae, 0x8e],
  ['searchOperand', 0x2f, 0x0f, 0xaf, 0x8f],
  ['deleteProgram', 0x20, 0x10, 0xa0, 0x90]
]

describe('NX function codes', () => {
  it('are those of the manual, all of them', () => {
    const table = F.FUNCTIONS.filter(row => row.name !== 'noService')
    const rows = table.map(row => [row.name, row.two, row.four, F.answerCode(row, 2), F.answerCode(row, 4)])
    assert.deepEqual(rows, MANUAL)
    const { two, four } = F.FUNCTIONS.find(row => row.name === 'noService')
    assert.deepEqual([two, four, F.NO_SERVICE], [0, 0, 0])
  })

  it('are found by their code, $00 being the RR', () => {
    for (const [name, two, four] of MANUAL) {
      assert.deepEqual([F.functionByCode(two).row.name, F.functionByCode(two).steps], [name, 2])
      assert.deepEqual([F.functionByCode(four).row.name, F.functionByCode(four).steps], [name, 4])
    }
    for (const code of [0x00, 0x11, 0x30, 0x80, 0xa3, 0xff]) assert.equal(F.functionByCode(code), undefined)
  })

  it('only the six described ones may be sent', () => {
    const six = ['readBits', 'writeBits', 'readWords', 'writeWords', 'readMixed', 'writeMixed']
    for (const [name] of MANUAL) {
      if (six.includes(name)) assert.equal(F.functionOf(name).name, name)
      else assert.throws(() => F.functionOf(name), { code: 'FUNCTION_REFUSED' })
    }
    for (const name of ['noService', '', 'toString', '__proto__', undefined, null, {}, 3, ['readBits']]) {
      assert.throws(() => F.functionOf(name), { code: 'FUNCTION_REFUSED' })
    }
  })

  it('reads may be repeated, writes not', () => {
    const repeatable = F.FUNCTIONS.filter(row => row.repeatable).map(row => row.name)
    assert.deepEqual(repeatable, ['readBits', 'readWords', 'readMixed'])
  })
})
