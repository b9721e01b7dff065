'use strict'
const { PlcError } = require('../error')
const { absurdity, elementsOf, toNumber } = require('./convert')

/** Raw words and bits of an item <-> the value that a message carries: types, scale, offset, limits. Pure. */

const decimals = number => {
  const [mantissa, exponent = '0'] = String(Math.abs(number)).split('e')
  return Math.max(0, (mantissa.split('.')[1] || '').length - Number(exponent))
}

const scaled = tag => Boolean(tag) && (tag.scale !== 1 || tag.offset !== 0)

/**
 * Engineering value of a raw number: raw × scale + offset, rounded to the decimals that scale and offset have (253 × 0.1
 * is 25.3, not 25.300000000000001); for float32 to 15 digits.
 */
const toEngineering = (raw, tag, integer) => {
  const value = raw * tag.scale + tag.offset
  const places = Math.max(decimals(tag.scale), decimals(tag.offset))
  return integer && places <= 15 ? Number(value.toFixed(places)) : Number(value.toPrecision(15))
}

/** Raw number of an engineering value; the type then rounds it to the nearest whole number, halves away from zero. */
const toRaw = (value, tag) => Number(((value - tag.offset) / tag.scale).toPrecision(15))

/**
 * One value of an item out of its raw words (or bit).
 * @param {import('./item').Item} item
 * @param {any[]} raw `item.type.words` words, or one boolean
 * @returns {{ value: any } | { code: 'NOT_A_VALUE', text: string }}
 */
const decodeValue = (item, raw) => {
  const answer = item.type.decode(raw, item)
  if ('bad' in answer) {
    const error = new PlcError('NOT_A_VALUE', { item: item.text, type: item.type.name, reason: answer.bad })
    return { code: 'NOT_A_VALUE', text: error.message }
  }
  if (!scaled(item.tag)) return answer
  return { value: toEngineering(answer.value, item.tag, item.type.integer) }
}

const checkLimits = (item, number, value) => {
  const { min = null, max = null } = item.tag ?? {}
  if ((min !== null && number < min) || (max !== null && number > max)) {
    throw new PlcError('VALUE_OUT_OF_RANGE', {
      item: item.text,
      value,
      least: min ?? 'any',
      most: max ?? 'any'
    })
  }
}

const engineeringRange = ({ tag, type }) => {
  const ends = [type.least, type.most].map(raw => toEngineering(raw, tag, type.integer)).sort((a, b) => a - b)
  return { least: ends[0], most: ends[1] }
}

/**
 * One value of an item -> its raw words (or bit). A scaled value is converted back; `min` and `max` of the tag bind the
 * engineering value as it was given and as it goes out, after rounding.
 * @param {import('./item').Item} item
 * @param {unknown} value
 * @returns {any[]}
 * @throws {PlcError} BAD_VALUE, VALUE_OUT_OF_RANGE
 */
const encodeOne = (item, value) => {
  const { type, tag, text, wordOrder, byteOrder } = item
  if (!type.numeric) return type.encode(value, { item: text, wordOrder, byteOrder })
  const number = toNumber(value, text)
  checkLimits(item, number, value)
  if (!scaled(tag)) return type.encode(number, { item: text, wordOrder })
  try {
    const raw = type.encode(toRaw(number, tag), { item: text, wordOrder, rounds: true })
    const out = /** @type {{ value: number }} */ (type.decode(raw, item)).value
    checkLimits(item, toEngineering(out, tag, type.integer), value)
    return raw
  } catch (caught) {
    const error = /** @type {PlcError} */ (caught)
    if (error.code !== 'VALUE_OUT_OF_RANGE' || error.details.value === value) throw error
    throw new PlcError('VALUE_OUT_OF_RANGE', { item: text, value, ...engineeringRange(item) })
  }
}

/**
 * What is written for a value: raw words (or bits) for each of the item's values. A range takes an array of its length.
 * @param {import('./item').Item} item
 * @param {unknown} value
 * @returns {any[][]} one array of raw words (or one bit) per value
 * @throws {PlcError} BAD_VALUE, VALUE_OUT_OF_RANGE
 */
const encodeValue = (item, value) => {
  const absurd = absurdity(value)
  if (absurd && value !== '') throw new PlcError('BAD_VALUE', { item: item.text, value, reason: absurd })
  if (!item.range) {
    if (Array.isArray(value)) throw new PlcError('BAD_VALUE', { item: item.text, value, reason: 'it takes one value' })
    return [encodeOne(item, value)]
  }
  if (!Array.isArray(value) || value.length !== item.count) {
    throw new PlcError('BAD_VALUE', { item: item.text, value, reason: `it takes an array of ${item.count} values` })
  }
  return elementsOf(value).map(one => encodeOne(item, one))
}

module.exports = { decodeValue, encodeValue }
