'use strict'
const { PlcError } = require('../error')
const { parseExpression, splitType } = require('./item')
const { parseType } = require('./types')

/**
 * The tag table. Pure; the editor bundles this file.
 *
 * @typedef {object} Tag
 * @property {string} name identifier, key in messages
 * @property {string} label free text in any language
 * @property {string} address address expression, may be a range
 * @property {string} type '' = by address (bit: bool, word: uint16)
 * @property {''|'low'|'high'} wordOrder '' = as the station
 * @property {''|'low'|'high'} byteOrder of strings; '' = as the station
 * @property {number} scale engineering value = raw × scale + offset
 * @property {number} offset
 * @property {string} unit
 * @property {number|string} deadband engineering units; 0: every change counts; `2%`: of the value that was reported last
 * @property {boolean} writable
 * @property {number|null} min engineering value
 * @property {number|null} max engineering value
 * @property {number|null} maxStep engineering units: what is written differs by so much at most from what the station holds
 */

const FIELDS = Object.freeze([
  ...['name', 'label', 'address', 'type', 'wordOrder', 'byteOrder', 'scale', 'offset', 'unit', 'deadband'],
  ...['writable', 'min', 'max', 'maxStep']
])
const NAME = /^[A-Za-z_]\w*$/
// keys that mean something else on every object: a payload { constructor: 1 } must not be read as a tag
const RESERVED = new Set(Object.getOwnPropertyNames(Object.prototype).concat('prototype'))
const MOST_TAGS = 10000

const bad = (name, reason) => new PlcError('BAD_TAG', { name, reason })

/** What has one text; an object may have none, or throw. */
const isPlain = value => value === null || !['object', 'function', 'symbol'].includes(typeof value)

/** An own property as trimmed text; '' if there is none. */
const textOf = (row, field) => {
  const value = Object.hasOwn(row, field) ? row[field] : undefined
  return value === undefined || value === null ? '' : String(value).trim()
}

const numberOf = (row, field, { name, fallback }) => {
  const text = textOf(row, field)
  if (text === '') return fallback
  const number = Number(text)
  if (!Number.isFinite(number)) throw bad(name, `${field} is "${text}", not a number`)
  return number
}

const PERCENT = /^(\d+(?:\.\d+)?)\s*%$/

/** Engineering units, or a text like `2%`. */
const deadbandOf = (row, name) => {
  const [, percent] = PERCENT.exec(textOf(row, 'deadband')) ?? []
  if (percent === undefined) return numberOf(row, 'deadband', { name, fallback: 0 })
  if (Number(percent) > 100) throw bad(name, `deadband is ${percent} %, 100 % at most`)
  return Number(percent) === 0 ? 0 : `${Number(percent)}%`
}

const YES = new Set(['true', '1', 'yes', 'x', 'on'])
const NO = new Set(['', 'false', '0', 'no', 'off'])

const booleanOf = (row, field, name) => {
  const text = textOf(row, field).toLowerCase()
  if (YES.has(text)) return true
  if (NO.has(text)) return false
  throw bad(name, `${field} is "${text}", write true or false`)
}

const orderOf = (row, field, name) => {
  const text = textOf(row, field).toLowerCase()
  if (text === '' || text === 'low' || text === 'high') return /** @type {''|'low'|'high'} */ (text)
  throw bad(name, `${field} is "${text}", write low or high`)
}

/** Fields of a row with their types and defaults; nothing is looked up yet. */
const readRow = (row, place) => {
  if (!row || typeof row !== 'object' || Array.isArray(row)) throw bad(place, 'it is not a row of fields')
  const strange = FIELDS.find(field => Object.hasOwn(row, field) && !isPlain(row[field]))
  if (strange) throw bad(place, `${strange} is neither text nor a number`)
  const name = textOf(row, 'name')
  if (!NAME.test(name)) throw bad(name || place, 'a name is made of letters, digits and _, and starts with no digit')
  if (RESERVED.has(name)) throw bad(name, 'this name is reserved')
  return {
    name,
    label: textOf(row, 'label'),
    address: textOf(row, 'address'),
    type: textOf(row, 'type').toLowerCase(),
    wordOrder: orderOf(row, 'wordOrder', name),
    byteOrder: orderOf(row, 'byteOrder', name),
    scale: numberOf(row, 'scale', { name, fallback: 1 }),
    offset: numberOf(row, 'offset', { name, fallback: 0 }),
    unit: textOf(row, 'unit'),
    deadband: deadbandOf(row, name),
    writable: booleanOf(row, 'writable', name),
    min: numberOf(row, 'min', { name, fallback: null }),
    max: numberOf(row, 'max', { name, fallback: null }),
    maxStep: numberOf(row, 'maxStep', { name, fallback: null })
  }
}

const checkNumbers = (tag, type) => {
  const { name, scale, offset, deadband, min, max, maxStep } = tag
  if (scale === 0) throw bad(name, 'scale is 0')
  if (deadband < 0) throw bad(name, 'deadband is negative')
  if (min !== null && max !== null && min > max) throw bad(name, `min ${min} is larger than max ${max}`)
  if (maxStep !== null && maxStep <= 0) throw bad(name, `maxStep is ${maxStep}; leave it empty to allow any step`)
  if (type.numeric) return
  if (scale !== 1 || offset !== 0) throw bad(name, `${type.name} cannot be scaled`)
  if (min !== null || max !== null) throw bad(name, `${type.name} has no min and max`)
  if (maxStep !== null) throw bad(name, `${type.name} has no maxStep`)
}

/** A name that is also an address would mean two things. */
const checkName = (tag, item, notation) => {
  const other = attempt(() => notation.parse(tag.name))
  if (other && (other.kind !== item.kind || other.address !== item.address)) {
    throw bad(tag.name, `its name is the address ${other.text}, but it stands for ${tag.address}`)
  }
}

const attempt = make => {
  try {
    return make()
  } catch {
    return null
  }
}

const checkTag = (tag, notation) => {
  const [, written] = splitType(tag.address)
  try {
    if (written && tag.type && parseType(written).name !== parseType(tag.type).name) {
      throw bad(tag.name, `its address says ${written}, its type ${tag.type}`)
    }
    const item = parseExpression(tag.address, notation, { tag })
    checkNumbers(tag, item.type)
    checkName(tag, item, notation)
  } catch (caught) {
    const error = /** @type {PlcError} */ (caught)
    throw error.code === 'BAD_TAG'
      ? error
      : new PlcError('BAD_TAG', { name: tag.name, reason: error.message, cause: error })
  }
}

/**
 * A tag table, checked.
 * @param {unknown} rows array of tags; missing fields have their defaults, numbers may be texts
 * @param {import('./item').Notation} notation of the station
 * @returns {Map<string, Tag>}
 * @throws {PlcError} BAD_TAG with the tag and the reason
 */
const readTags = (rows, notation) => {
  const tags = new Map()
  if (rows === undefined || rows === null || rows === '') return tags
  if (!Array.isArray(rows)) throw bad('table', 'it is not an array of tags')
  if (rows.length > MOST_TAGS) throw new PlcError('TOO_MANY', { count: rows.length, unit: 'tags', most: MOST_TAGS })
  rows.forEach((row, index) => {
    const tag = readRow(row, `in row ${index + 1}`)
    if (tags.has(tag.name)) throw bad(tag.name, `row ${index + 1} has the same name again`)
    checkTag(tag, notation)
    tags.set(tag.name, Object.freeze(tag))
  })
  return tags
}

module.exports = { FIELDS, readTags }
