'use strict'
const { PlcError } = require('../../error')

/**
 * The functions of MODBUS that are used; panel manual appendix A, "MODBUS application protocol" 6.1 to 6.12. No Buffer: the editor bundles it.
 * @typedef {'co'|'di'|'ir'|'hr'} Table
 * @typedef {object} FunctionRow
 * @property {number} fn its number
 * @property {Table} table what it reads or writes
 * @property {'bits'|'words'} unit
 * @property {'block'|'single'|'multiple'} request `block`: base and count; `single`: base and one value; `multiple`: base, count and values
 * @property {number} most items in one frame
 * @property {'bits'|'words'|'echo'} answer values behind a byte count, or the first four bytes of the request
 * @property {boolean} reads a read may be asked again, a write never is
 */

/** @type {readonly FunctionRow[]} */
const FUNCTIONS = table([
  // fn  table  unit    request      most  answer  reads
  [0x01, 'co', 'bits', 'block', 2000, 'bits', true],
  [0x02, 'di', 'bits', 'block', 2000, 'bits', true],
  [0x03, 'hr', 'words', 'block', 125, 'words', true],
  [0x04, 'ir', 'words', 'block', 125, 'words', true],
  [0x05, 'co', 'bits', 'single', 1, 'echo', false],
  [0x06, 'hr', 'words', 'single', 1, 'echo', false],
  [0x0f, 'co', 'bits', 'multiple', 1968, 'echo', false],
  [0x10, 'hr', 'words', 'multiple', 123, 'echo', false]
])

function table(rows) {
  return Object.freeze(
    rows.map(([fn, name, unit, request, most, answer, reads]) =>
      Object.freeze({ fn, table: name, unit, request, most, answer, reads })
    )
  )
}

/** An answer with this bit in its function is an exception. */
const EXCEPTION = 0x80

/** Diagnostics, sub-function 0000: the request comes back. It carries no values, so it is no row of the table; loopback.js sends it. */
const LOOPBACK = 0x08

const byNumber = new Map(FUNCTIONS.map(row => [row.fn, row]))
const find = (name, request) =>
  /** @type {FunctionRow} */ (FUNCTIONS.find(row => row.table === name && row.request === request)) ?? null

/**
 * The row of a function that may be sent.
 * @param {unknown} fn 1, 2, 3, 4, 5, 6, 15 or 16
 * @returns {FunctionRow}
 * @throws {PlcError} FUNCTION_REFUSED
 */
function functionOf(fn) {
  const row = byNumber.get(/** @type {number} */ (fn))
  if (!row) throw new PlcError('FUNCTION_REFUSED', { function: String(fn) })
  return row
}

/**
 * Whether a number is that of a function in the table.
 * @param {number} fn
 * @returns {FunctionRow | undefined}
 */
const functionByNumber = fn => byNumber.get(fn)

/** @param {Table} name @returns {number} the function that reads a table: 1..4 */
const readFunction = name => find(name, 'block').fn

/**
 * The function that writes a table.
 * @param {Table} name
 * @param {{ single: boolean }} options 05 and 06 for one value, or 0F and 10
 * @returns {number | null} null: the table cannot be written
 */
const writeFunction = (name, { single }) => find(name, single ? 'single' : 'multiple')?.fn ?? null

module.exports = { EXCEPTION, FUNCTIONS, LOOPBACK, functionByNumber, functionOf, readFunction, writeFunction }
