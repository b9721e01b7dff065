'use strict'
const { PlcError } = require('../../error')

/**
 * @typedef {'readBits'|'writeBits'|'readWords'|'writeWords'|'readMixed'|'writeMixed'} Ask
 * @typedef {{ name: string, two: number, four: number, most: number, unit: string, repeatable: boolean, sendable: boolean }} FunctionRow
 */

// manual "Function codes included in the query". 2-step = 4-step + $20 but for "delete program"; the answer is the query's + $80.
// most: items in one frame (LEN 0 = 256 bytes of INFO). Functions named without description are never sent.
/** @type {readonly FunctionRow[]} */
const FUNCTIONS = table([
  // name            2-step 4-step most unit        repeatable sendable
  ['readBits', 0x21, 0x01, 255, 'bits', true, true],
  ['writeBits', 0x22, 0x02, 254, 'bits', false, true],
  ['readWords', 0x23, 0x03, 128, 'words', true, true],
  ['writeWords', 0x24, 0x04, 127, 'words', false, true],
  ['readMixed', 0x25, 0x05, 128, 'addresses', true, true],
  ['writeMixed', 0x26, 0x06, 85, 'addresses', false, true],
  ['readProgram', 0x27, 0x07, 0, '', false, false],
  ['writeProgram', 0x28, 0x08, 0, '', false, false],
  ['readInstruction', 0x29, 0x09, 0, '', false, false],
  ['changeInstruction', 0x2a, 0x0a, 0, '', false, false],
  ['changeOperand', 0x2b, 0x0b, 0, '', false, false],
  ['insertInstruction', 0x2c, 0x0c, 0, '', false, false],
  ['deleteInstruction', 0x2d, 0x0d, 0, '', false, false],
  ['searchInstruction', 0x2e, 0x0e, 0, '', false, false],
  ['searchOperand', 0x2f, 0x0f, 0, '', false, false],
  ['deleteProgram', 0x20, 0x10, 0, '', false, false],
  ['noService', 0x00, 0x00, 0, '', false, false]
])

function table(rows) {
  return Object.freeze(
    rows.map(([name, two, four, most, unit, repeatable, sendable]) =>
      Object.freeze({ name, two, four, most, unit, repeatable, sendable })
    )
  )
}

const ANSWER = 0x80
// the two frames of the 4-step method that are no function: manual "Structure of Communication Frames"
const ACKNOWLEDGE = 0x80
const RESPONSE_REQUEST = 0x00
const NO_SERVICE = 0x00

const ERRORS = Object.freeze({
  1: 'PLC_WRONG_FUNCTION',
  2: 'PLC_OUT_OF_RANGE',
  3: 'PLC_WRONG_FRAME',
  4: 'PLC_NOT_PERFORMED',
  5: 'PLC_FRAME_TOO_LONG'
})

const byName = new Map(FUNCTIONS.map(row => [row.name, row]))
/** @type {Map<number, { row: FunctionRow, steps: 2 | 4 }>} */
const byCode = new Map()
for (const row of FUNCTIONS) {
  if (row.name === 'noService') continue
  byCode.set(row.two, { row, steps: 2 })
  byCode.set(row.four, { row, steps: 4 })
}

/**
 * The row of a function that may be sent.
 * @param {unknown} name as in `query.ask`
 * @returns {FunctionRow}
 * @throws {PlcError} FUNCTION_REFUSED for names unknown or without description in the manual
 */
function functionOf(name) {
  const row = typeof name === 'string' ? byName.get(name) : undefined
  if (!row || !row.sendable) throw new PlcError('FUNCTION_REFUSED', { function: String(name) })
  return row
}

/**
 * @param {FunctionRow} row
 * @param {2|4} steps
 * @returns {number} the code of the query
 */
const queryCode = (row, steps) => (steps === 4 ? row.four : row.two)

/**
 * @param {FunctionRow} row
 * @param {2|4} steps
 * @returns {number} the code of the response: the query's + $80
 */
const answerCode = (row, steps) => queryCode(row, steps) + ANSWER

/**
 * The function behind a query's code.
 * @param {number} code 0..255
 * @returns {{ row: FunctionRow, steps: 2 | 4 } | undefined} undefined: no function of a query ($00 is the RR)
 */
const functionByCode = code => byCode.get(code)

module.exports = {
  FUNCTIONS,
  ERRORS,
  ANSWER,
  ACKNOWLEDGE,
  RESPONSE_REQUEST,
  NO_SERVICE,
  functionOf,
  functionByCode,
  queryCode,
  answerCode
}
