'use strict'
const { PlcError } = require('../../error')
const { readFunction, writeFunction } = require('./functions')

/**
 * Addresses of MODBUS as the panel writes them (`001001`, `101001`, `301101.05`, `401001`), in five digits (`40108`) and explicit (`hr107`).
 * Panel manual 6 "Supported addresses". No Buffer: the editor bundles it.
 * @typedef {'co'|'di'|'ir'|'hr'} TableName
 * @typedef {'1-base'|'0-base'} AddressMode 1-base: the number on the wire is the panel's − 1
 * @typedef {'panel'|'explicit'} Style
 * @typedef {object} Address
 * @property {'bit'|'word'} kind
 * @property {number} address absolute: words: holding registers 0, input registers 10000h; bits: 16 × word + bit, coils 200000h, discrete inputs 210000h
 * @property {number} count 1, or the length of a range
 * @property {TableName} table
 * @property {number} wire number on the wire, 0..65535, of the coil, input or register
 * @property {string} text canonical: six digits, or as `hr107`
 * @property {Style} style
 * @property {boolean} writable
 * @property {'certain'} certainty
 * @property {{ address: number, bit: number, writable: boolean }} [throughWord] a bit of a register: it is read, and written, with its word
 */

const SIZE = 0x10000
const MOST_CHARACTERS = 64
const MOST_RANGE = 4096

/** The four tables: `digit` begins the panel's notation, `base` is the absolute address of the first one. */
const TABLES = Object.freeze(
  /** @type {[TableName, string, 'bit'|'word', string, number, boolean][]} */
  ([
    ['co', 'coil', 'bit', '0', 0x200000, true],
    ['di', 'discrete input', 'bit', '1', 0x210000, false],
    ['ir', 'input register', 'word', '3', 0x10000, false],
    ['hr', 'holding register', 'word', '4', 0, true]
  ]).map(([table, name, kind, digit, base, writable]) =>
    Object.freeze({ table, name, kind, digit, base, writable, size: SIZE })
  )
)

const byDigit = new Map(TABLES.map(row => [row.digit, row]))
const byName = new Map(TABLES.map(row => [row.table, row]))
const PANEL = /^(\d+)(?:\.(\d*))?$/
const EXPLICIT = /^(co|di|ir|hr)(\d+)(?:\.(\d*))?$/

/** @param {string} table @returns {typeof TABLES[number]} */
const rowOf = table => /** @type {any} */ (byName.get(/** @type {TableName} */ (table)))

/**
 * Reads the notation of an address; ranges with `..`. Bits of registers have two digits, `.00` to `.15`.
 * @param {unknown} text
 * @param {{ addressMode?: AddressMode }} [options] default 1-base; explicit addresses are the wire's number in both
 * @returns {Address}
 * @throws {PlcError} BAD_ADDRESS, BAD_BIT, OUT_OF_AREA, BAD_COUNT
 */
function parseAddress(text, { addressMode = '1-base' } = {}) {
  if (typeof text === 'number') throw bad(text, 'a number loses its zeros; write the address in quotes, as in "010197"')
  if (typeof text !== 'string') throw bad('', 'it is not text')
  const clean = text.trim()
  if (clean === '') throw bad(text, 'it is empty', { why: 'empty' })
  if (clean.length > MOST_CHARACTERS)
    throw bad(`${clean.slice(0, 20)}…`, `it has more than ${MOST_CHARACTERS} characters`)
  const [first, last, more] = clean.split(/\s*\.\.\s*/)
  if (more !== undefined) throw bad(clean, 'a range has two ends')
  const from = parseOne(first, clean, addressMode)
  if (last === undefined) return finish(from, 1, addressMode)
  return range(from, parseOne(last, clean, addressMode), { clean, addressMode })
}

function range(from, to, { clean, addressMode }) {
  if (from.row !== to.row) throw bad(clean, `one end is of the ${from.row.name}s, the other of the ${to.row.name}s`)
  if (from.kind !== to.kind) throw bad(clean, 'one end is a bit, the other a register')
  if (from.style !== to.style) throw bad(clean, 'both ends must be written in the same way')
  const count = to.address - from.address + 1
  if (count < 1) throw bad(clean, 'the range runs backwards', { why: 'backwards' })
  if (count > MOST_RANGE) {
    const reason = 'the range is too long'
    throw new PlcError('BAD_COUNT', { count, unit: `${from.kind}s`, reason, least: 1, most: MOST_RANGE })
  }
  return finish(from, count, addressMode)
}

const FORMS = 'like 400108, 40108 or hr107'

function parseOne(part, whole, addressMode) {
  const clean = part.trim().toLowerCase()
  const explicit = EXPLICIT.exec(clean)
  if (explicit) {
    const [, name, digits, bit] = explicit
    return place(rowOf(name), Number(digits), { bit, whole, style: 'explicit', first: 0 })
  }
  const found = PANEL.exec(clean)
  if (!found)
    throw part === ''
      ? bad(whole, 'one end of the range is missing')
      : bad(whole, `it is not ${FORMS}`, { why: 'form' })
  const [, digits, bit] = found
  if (digits.length !== 5 && digits.length !== 6) throw wrongDigits(whole, digits)
  const row = byDigit.get(digits[0])
  if (!row)
    throw bad(
      whole,
      `the first digit is ${digits[0]}, not 0 (coil), 1 (discrete input), 3 (input register) or 4 (holding register)`,
      { why: 'firstDigit', digit: digits[0] }
    )
  return place(row, Number(digits.slice(1)), { bit, whole, style: 'panel', first: addressMode === '0-base' ? 0 : 1 })
}

const wrongDigits = (whole, digits) => {
  const { length } = digits
  const reason = `it has ${length === 1 ? '1 digit' : `${length} digits`} instead of 6 or 5`
  if (length > 5) return bad(whole, reason, { why: 'digits', digits: length })
  const padded = digits.padStart(6, '0')
  const hint = `; a zero in front may have been lost, as in ${padded}`
  return bad(whole, reason + hint, { why: 'zeroLost', digits: length, padded })
}

function place(row, number, { bit, whole, style, first }) {
  const wire = number - first
  if (!(wire >= 0 && wire < SIZE)) {
    const numbers = `${first}..${SIZE - 1 + first}`
    throw new PlcError('OUT_OF_AREA', {
      address: whole,
      area: `the table of ${row.name}s`,
      range: `the numbers ${numbers}`,
      notation: 'modbus',
      numbers
    })
  }
  if (bit === undefined) return { kind: row.kind, address: row.base + wire, row, style }
  if (row.kind === 'bit') throw bad(whole, `a ${row.name} is a bit: nothing follows its number`, { why: 'bitOfBit' })
  return { kind: 'bit', address: (row.base + wire) * 16 + bitOf(bit, whole), row, style }
}

function bitOf(digits, whole) {
  if (digits.length !== 2) {
    const hint = digits.length === 1 ? `: .${digits} could be .0${digits} or .${digits}0` : ''
    throw bad(whole, `a bit of a register has two digits, .00 to .15${hint}`, { why: 'bitDigits' })
  }
  if (Number(digits) > 15) throw new PlcError('BAD_BIT', { address: whole, bit: Number(digits) })
  return Number(digits)
}

/** @returns {Address} */
function finish({ kind, address, row, style }, count, addressMode) {
  const through = kind === 'bit' && row.kind === 'word'
  /** @type {Address} */
  const result = {
    kind,
    address,
    count,
    table: row.table,
    wire: placeOf(kind, address).wire,
    text: formatAddress({ kind, address, count, style }, { addressMode }),
    style,
    writable: row.writable,
    certainty: 'certain'
  }
  if (through) result.throughWord = { address: address >> 4, bit: address & 15, writable: row.writable }
  return result
}

/**
 * Table and number on the wire of an absolute address.
 * @param {'bit'|'word'} kind
 * @param {number} address
 * @returns {{ table: TableName, wire: number, bit?: number }} `bit`: of a register
 * @throws {PlcError} BAD_ADDRESS
 */
function placeOf(kind, address) {
  const at = (name, number) => TABLES.find(row => row.kind === name && number >= row.base && number < row.base + SIZE)
  const own = Number.isInteger(address) ? at(kind, address) : undefined
  if (own) return { table: own.table, wire: address - own.base }
  const word = kind === 'bit' && Number.isInteger(address) && address >= 0 ? at('word', address >> 4) : undefined
  if (word) return { table: word.table, wire: (address >> 4) - word.base, bit: address & 15 }
  throw bad(String(address), `no ${kind} has this absolute address`)
}

/**
 * The notation of an absolute address.
 * @param {{ kind: 'bit'|'word', address: number, count?: number, style?: Style }} place
 * @param {{ addressMode?: AddressMode }} [options]
 * @returns {string} `400108`, `401001.05`, `hr107`, `001001..001016`
 * @throws {PlcError} BAD_ADDRESS
 */
function formatAddress({ kind, address, count = 1, style = 'panel' }, { addressMode = '1-base' } = {}) {
  const one = at => {
    const { table, wire, bit } = placeOf(kind, at)
    const tail = bit === undefined ? '' : `.${String(bit).padStart(2, '0')}`
    if (style === 'explicit') return `${table}${wire}${tail}`
    const number = addressMode === '0-base' ? wire : wire + 1
    return `${rowOf(table).digit}${String(number).padStart(5, '0')}${tail}`
  }
  return count === 1 ? one(address) : `${one(address)}..${one(address + count - 1)}`
}

/**
 * One short line that says what goes out for an address, for the dialogs.
 * @param {{ kind: 'bit'|'word', address: number, count?: number }} place from {@link parseAddress}; `count` in addresses
 * @param {{ write?: boolean, coilFunction?: '0F'|'05'|'auto', holdingFunction?: '10'|'06'|'auto' }} [options]
 * @returns {string} such as `function 03, wire address 107 (006Bh)`
 */
function describeAddress({ kind, address, count = 1 }, options = {}) {
  const first = placeOf(kind, address)
  const last = placeOf(kind, address + count - 1)
  const row = rowOf(first.table)
  const span = spanOf(first.wire, last.wire)
  const read = hex(readFunction(first.table), 2)
  if (options.write && !row.writable) return `${row.name}s cannot be written`
  const code = options.write ? writeCode(first.table, last.wire - first.wire + 1, options) : read
  if (first.bit === undefined) return `function ${code}, ${span}`
  if (options.write) return `functions ${read} and ${code}, read-modify-write of ${span}`
  return `function ${code}, ${span}, ${count === 1 ? `bit ${first.bit}` : `${count} bits`}`
}

function writeCode(table, count, { coilFunction = '0F', holdingFunction = '10' }) {
  const chosen = table === 'co' ? coilFunction : holdingFunction
  const single = chosen === '05' || chosen === '06' || (chosen === 'auto' && count === 1)
  return hex(/** @type {number} */ (writeFunction(table, { single })), 2)
}

/**
 * Numbers on the wire, in words.
 * @param {number} first
 * @param {number} last
 * @returns {string} `wire address 107 (006Bh)`, `wire addresses 107–110 (006Bh–006Eh)`
 */
const spanOf = (first, last) =>
  first === last
    ? `wire address ${first} (${hex(first)}h)`
    : `wire addresses ${first}–${last} (${hex(first)}h–${hex(last)}h)`

const hex = (value, digits = 4) => value.toString(16).toUpperCase().padStart(digits, '0')
/** `why` and its values: by these the dialogs say the reason in another language. */
const bad = (address, reason, more = {}) =>
  new PlcError('BAD_ADDRESS', { address: String(address), reason, notation: 'modbus', ...more })

module.exports = { TABLES, describeAddress, formatAddress, parseAddress, placeOf, spanOf }
