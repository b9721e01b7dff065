'use strict'
const { PlcError } = require('../../error')
const { functionOf } = require('./functions')
const { MOST_INFO } = require('./frame')

/**
 * Items in one frame, and bytes of INFO in either direction. Defaults: what the frame holds, but for word writes, which the manual's own
 * program proves only up to 64. A CPU may be stricter: it answers error 5.
 * @type {Readonly<Record<string, number>>}
 */
const LIMITS = Object.freeze({
  readBits: 255,
  writeBits: 254,
  readWords: 128,
  writeWords: 64,
  readMixed: 128,
  writeMixed: 85,
  info: MOST_INFO
})

// in mixed frames two bits of the address are taken by the mark
const LAST_MIXED = 0x3fff
const LAST = 0xffff

/**
 * The limits of one PLC.
 * @param {Record<string, number>} [settings] rows to replace; at most what a frame holds (`writeWords` 127)
 * @returns {Readonly<Record<string, number>>}
 * @throws {PlcError} BAD_SETTING
 */
function limitsOf(settings = {}) {
  const limits = { ...LIMITS }
  for (const [name, given] of Object.entries(settings ?? {})) {
    if (given === undefined) continue
    if (!Object.hasOwn(LIMITS, name)) {
      throw new PlcError('BAD_SETTING', { setting: `limits.${name}`, value: given, reason: 'there is no such limit' })
    }
    const least = name === 'info' ? 3 : 1
    const most = name === 'info' ? MOST_INFO : functionOf(name).most
    const value = typeof given === 'string' && /^\s*\d{1,3}\s*$/.test(given) ? Number(given) : given
    if (!Number.isInteger(value) || value < least || value > most) {
      throw new PlcError('BAD_SETTING', {
        setting: `limits.${name}`,
        value: given,
        reason: `it must be ${least} to ${most}`
      })
    }
    limits[name] = value
  }
  return Object.freeze(limits)
}

/**
 * Refuses, before anything is sent, what a frame or a PLC cannot take.
 * @param {any} query
 * @param {Readonly<Record<string, number>>} [limits]
 * @returns {import('./functions').FunctionRow} the function of the query
 * @throws {PlcError} FUNCTION_REFUSED, BAD_COUNT, BAD_ADDRESS, BAD_VALUE, FRAME_TOO_LONG
 */
function check(query, limits = LIMITS) {
  const row = functionOf(query?.ask)
  CHECKS[row.name](query, row, limits)
  return row
}

const CHECKS = {
  readBits: checkBlock,
  readWords: checkBlock,
  writeBits: (query, row, limits) => checkBlockWrite('bit', query, { row, limits }),
  writeWords: (query, row, limits) => checkBlockWrite('word', query, { row, limits }),
  readMixed({ addresses }, row, limits) {
    const list = listOf(addresses, row, limits)
    list.forEach(checkPlace)
    // two bytes for each address; its value in the answer has no more
    checkBytes(list.length * 2, limits)
  },
  writeMixed({ writes }, row, limits) {
    const list = listOf(writes, row, limits)
    list.forEach(checkPlace)
    list.forEach(({ kind, address, value }) => checkValue(kind, address, value))
    const bytes = list.reduce((sum, { kind }) => sum + (kind === 'bit' ? 3 : 4), 0)
    checkBytes(bytes, limits)
  }
}

function checkBlockWrite(kind, { base, values }, { row, limits }) {
  const list = listOf(values, row, limits)
  checkBlock({ base, count: list.length }, row, limits)
  list.forEach((value, i) => checkValue(kind, base + i, value))
}

function checkBlock({ base, count }, row, limits) {
  checkCount(count, row, limits)
  const kind = row.unit === 'bits' ? 'bit' : 'word'
  if (!whole(base, LAST)) throw badAddress(base, `the last ${kind} address is ${LAST}`)
  if (base + count - 1 > LAST)
    throw badAddress(base, `${count} ${row.unit} from there end after the last address ${LAST}`)
  const size = kind === 'bit' ? count : count * 2
  checkBytes(row.repeatable ? Math.max(size, 3) : size + 2, limits)
}

function checkCount(count, row, limits) {
  const most = limits[row.name]
  if (whole(count, most) && count >= 1) return
  const reason =
    count === 0 ? 'there is nothing to ask for' : whole(count, Infinity) ? 'too many for one frame' : 'no count'
  throw new PlcError('BAD_COUNT', { count, unit: row.unit, reason, least: 1, most })
}

function checkBytes(got, limits) {
  if (got > limits.info)
    throw new PlcError('FRAME_TOO_LONG', { what: 'the query or its answer', got, most: limits.info })
}

function checkPlace(place) {
  const kind = place?.kind
  if (kind !== 'bit' && kind !== 'word') throw badAddress(place?.address, 'it must be a bit or a word')
  if (!whole(place.address, LAST_MIXED))
    throw badAddress(place.address, `in mixed frames the last ${kind} address is ${LAST_MIXED}`)
}

function checkValue(kind, address, value) {
  if (kind === 'bit' ? typeof value === 'boolean' : whole(value, 0xffff)) return
  const reason = kind === 'bit' ? 'a bit is true or false' : 'a word is a whole number from 0 to 65535'
  throw new PlcError('BAD_VALUE', { item: `${kind} ${hex(address)}`, value: String(value), reason })
}

// a copy: forEach would step over the holes of a sparse array
function listOf(list, row, limits) {
  if (Array.isArray(list)) {
    checkCount(list.length, row, limits)
    return Array.from(list)
  }
  const reason = 'they are not given as a list'
  throw new PlcError('BAD_COUNT', { count: 'no', unit: row.unit, reason, least: 1, most: limits[row.name] })
}

const whole = (value, most) => Number.isInteger(value) && value >= 0 && value <= most
const hex = value => `${value.toString(16).toUpperCase().padStart(4, '0')}h`
const badAddress = (address, reason) => new PlcError('BAD_ADDRESS', { address: String(address), reason })

module.exports = { LIMITS, limitsOf, check }
