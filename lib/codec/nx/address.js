'use strict'
const { PlcError } = require('../../error')
const { areaMap, LAST_BIT, LAST_WORD } = require('./areas')
const { functionOf, queryCode } = require('./functions')

/**
 * @typedef {import('./areas').AreaMap} AreaMap
 * @typedef {import('./areas').Area} Area
 * @typedef {import('./areas').Certainty} Certainty
 * @typedef {object} Address
 * @property {'bit'|'word'} kind
 * @property {number} address absolute word address, or absolute bit address (word × 16 + bit)
 * @property {number} count 1, or the length of a range
 * @property {string | null} area name of the area it lies in; null: in none, or in several (raw addresses)
 * @property {boolean} raw written as an absolute address: goes out exactly as written
 * @property {string} text canonical notation
 * @property {boolean} writable whether the area may be written (a bit that goes through its word: false)
 * @property {Certainty} certainty of the area table's row
 * @property {{ address: number, bit: number, writable: boolean }} [throughWord] the bit cannot be asked for as a bit: read this word
 *   (of a range: where it begins); `writable`: a read-modify-write of the word would be allowed
 */

const MOST_CHARACTERS = 64
const MOST_RANGE = 4096
const STANDARD = areaMap()
const NOTATION = /^([A-Z]{1,4})(\d{1,8})(?:\.(\d{1,8}))?$/
const RAW = /^@(BIT:)?(0X[0-9A-F]{1,8}|\d{1,8})(?:\.(\d{1,8}))?$/

const hex = value => value.toString(16).toUpperCase().padStart(4, '0')

/**
 * Reads the notation of an address: `M0`, `K127.12` (bit in decimal), `TC5`, the ranges `M0..M127`, `M0.0..M0.15`, `TC0..TC9`, and the
 * raw absolute addresses `@0x00C0` (word), `@0x01BF.12` and `@bit:0x1BFC` (bit). Case and leading zeros do not matter.
 * Manual: "Absolute bit address", "Word absolute address".
 * @param {string} text
 * @param {AreaMap} [areas]
 * @returns {Address}
 * @throws {PlcError} BAD_ADDRESS, UNKNOWN_AREA, OUT_OF_AREA, BAD_BIT, BAD_COUNT
 */
function parseAddress(text, areas = STANDARD) {
  if (typeof text !== 'string') throw new PlcError('BAD_ADDRESS', { address: text, reason: 'it is not text' })
  const clean = text.trim()
  if (clean === '') throw bad(text, 'it is empty')
  if (clean.length > MOST_CHARACTERS)
    throw bad(clean.slice(0, 20) + '…', `it has more than ${MOST_CHARACTERS} characters`)
  const [first, last, more] = clean.split(/\s*\.\.\s*/)
  if (more !== undefined) throw bad(clean, 'a range has two ends')
  const from = parseOne(first, clean, areas)
  if (last === undefined) return finish(from, 1, areas)
  return range(from, parseOne(last, clean, areas), { clean, areas })
}

function range(from, to, { clean, areas }) {
  if (from.kind !== to.kind) throw bad(clean, 'one end is a bit, the other a word')
  if (from.raw !== to.raw || (!from.raw && from.row !== to.row)) throw bad(clean, 'both ends must lie in one area')
  const count = to.address - from.address + 1
  if (count < 1) throw bad(clean, 'the range runs backwards')
  if (count > MOST_RANGE) {
    const reason = 'the range is too long'
    throw new PlcError('BAD_COUNT', { count, unit: `${from.kind}s`, reason, least: 1, most: MOST_RANGE })
  }
  return finish(from, count, areas)
}

function parseOne(part, whole, areas) {
  const upper = part.trim().toUpperCase()
  const raw = RAW.exec(upper)
  if (raw) return parseRaw(raw, whole)
  const found = NOTATION.exec(upper)
  if (!found)
    throw bad(
      whole,
      part === '' ? 'one end of the range is missing' : 'it is neither like M0 or K127.12 nor like @0x00C0'
    )
  const [, area, digits, bit] = found
  const row = areas.get(area)
  if (!row) {
    throw new PlcError('UNKNOWN_AREA', { address: whole, area, known: areas.list.map(each => each.area).join(', ') })
  }
  const number = Number(digits)
  if (row.as === 'bits' && bit !== undefined) throw bad(whole, `${area} has contacts: a number without a bit`)
  const size = row.as === 'bits' ? row.words * 16 : row.words
  if (number >= size) throw new PlcError('OUT_OF_AREA', { address: whole, area, range: `${area}0..${area}${size - 1}` })
  if (row.as === 'bits') return { kind: 'bit', address: row.base * 16 + number, row, raw: false }
  if (bit === undefined) return { kind: 'word', address: row.base + number, row, raw: false }
  return { kind: 'bit', address: (row.base + number) * 16 + bitOf(bit, whole), row, raw: false }
}

function parseRaw(found, whole) {
  const [, isBit, digits, bit] = found
  const number = Number(digits)
  const kind = isBit || bit !== undefined ? 'bit' : 'word'
  if (isBit && bit !== undefined) throw bad(whole, '@bit: is followed by a bit address alone')
  const limit = isBit ? LAST_BIT : LAST_WORD
  if (number > limit) throw bad(whole, `the last ${isBit ? 'bit' : 'word'} address is 0x${hex(limit)}`)
  const address = bit === undefined ? number : number * 16 + bitOf(bit, whole)
  return { kind, address, row: null, raw: true }
}

function bitOf(digits, whole) {
  if (Number(digits) > 15) throw new PlcError('BAD_BIT', { address: whole, bit: Number(digits) })
  return Number(digits)
}

/** @returns {Address} */
function finish({ kind, address, row, raw }, count, areas) {
  const place = raw ? covering({ kind, address, count }, areas) : row
  const last = address + count - 1
  const through = kind === 'bit' && (last > LAST_BIT || (!raw && row.as === 'words'))
  /** @type {Address} */
  const result = {
    kind,
    address,
    count,
    area: place.area,
    raw,
    text: raw ? rawText(kind, address, count) : areaText(kind, address, count, row),
    writable: place.writable && !through,
    certainty: place.certainty
  }
  if (through) result.throughWord = { address: address >> 4, bit: address & 15, writable: place.writable }
  return result
}

// a raw address is as sure and as writable as the row it lies in: it must not be a way around the table
function covering({ kind, address, count }, areas) {
  const first = kind === 'bit' ? address >> 4 : address
  const last = kind === 'bit' ? (address + count - 1) >> 4 : address + count - 1
  const rows = []
  for (let word = first; word <= last;) {
    const row = areas.at(word)
    if (!row) return { area: null, writable: false, certainty: 'unconfirmed' }
    rows.push(row)
    word = row.base + row.words
  }
  const certainty = ['unconfirmed', 'likely', 'certain'].find(each => rows.some(row => row.certainty === each))
  return { area: rows.length === 1 ? rows[0].area : null, writable: rows.every(row => row.writable), certainty }
}

function rawText(kind, address, count) {
  const one = at => (kind === 'word' ? `@0x${hex(at)}` : `@0x${hex(at >> 4)}.${at & 15}`)
  return count === 1 ? one(address) : `${one(address)}..${one(address + count - 1)}`
}

function areaText(kind, address, count, row) {
  const one = at => {
    if (kind === 'word') return `${row.area}${at - row.base}`
    return row.as === 'bits' ? `${row.area}${at - row.base * 16}` : `${row.area}${(at >> 4) - row.base}.${at & 15}`
  }
  return count === 1 ? one(address) : `${one(address)}..${one(address + count - 1)}`
}

/**
 * The notation of an absolute address: by its area where one holds all of it, else raw.
 * @param {{ kind: 'bit'|'word', address: number, count?: number }} place
 * @param {AreaMap} [areas]
 * @returns {string} `M0`, `K127.12`, `TC5`, `M0..M127`, `@0x01E0`
 * @throws {PlcError} BAD_ADDRESS
 */
function formatAddress({ kind, address, count = 1 }, areas = STANDARD) {
  checkPlace(kind, address, count)
  const last = address + count - 1
  const row = areas.at(kind === 'bit' ? address >> 4 : address)
  const inside = row && areas.at(kind === 'bit' ? last >> 4 : last) === row
  if (!inside || (kind === 'word' && row.as === 'bits')) return rawText(kind, address, count)
  return areaText(kind, address, count, row)
}

function checkPlace(kind, address, count) {
  const limit = kind === 'bit' ? LAST_WORD * 16 + 15 : LAST_WORD
  const known = kind === 'bit' || kind === 'word'
  if (known && Number.isInteger(address) && Number.isInteger(count) && address >= 0 && count >= 1) {
    if (address + count - 1 <= limit) return
  }
  throw bad(String(address), `no ${kind} has this absolute address`)
}

/**
 * One short line that says what goes out for an address, for the dialogs.
 * @param {Address} place from {@link parseAddress}
 * @param {{ steps?: 2|4, write?: boolean }} [options]
 * @returns {string} such as `function 23, word address 01BFh (447)` or `function 21, bit address 1BFCh`
 */
function describeAddress(place, { steps = 2, write = false } = {}) {
  const words = place.kind === 'word' || place.throughWord !== undefined
  const row = functionOf(`${write ? 'write' : 'read'}${words ? 'Words' : 'Bits'}`)
  const code = hex(queryCode(row, steps)).slice(2)
  const last = place.address + place.count - 1
  if (!words) return `function ${code}, ${span('bit', place.address, last)}`
  const first = place.throughWord ? place.throughWord.address : place.address
  const end = place.throughWord ? last >> 4 : last
  const decimal = first === end ? `(${first})` : `(${first}–${end})`
  const bit = !place.throughWord ? '' : place.count === 1 ? `, bit ${place.throughWord.bit}` : `, ${place.count} bits`
  return `function ${code}, ${span('word', first, end)} ${decimal}${bit}`
}

const span = (unit, first, last) =>
  first === last ? `${unit} address ${hex(first)}h` : `${unit} addresses ${hex(first)}h–${hex(last)}h`

const bad = (address, reason) => new PlcError('BAD_ADDRESS', { address, reason })

module.exports = { parseAddress, formatAddress, describeAddress }
