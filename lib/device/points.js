'use strict'
const { PlcError } = require('../error')
const { decodeValue } = require('../tag/value')

/** Items -> absolute points to read, and back: raw words and bits -> results. Pure. */

const MOST_POINTS = 20000

/** Addresses of one value of an item. A bit that the station offers only in its word is read through it. */
const pointOf = (item, index) => {
  if (item.throughWord) return { kind: 'word', address: (item.address + index) >> 4, count: 1 }
  const { kind, address, type } = item
  return { kind, address: address + index * type.words, count: type.words }
}

/** @param {import('../tag/item').Item[]} items @throws {PlcError} TOO_MANY */
const checkTotal = items => {
  const total = items.reduce((sum, item) => sum + item.count * item.type.words, 0)
  if (total > MOST_POINTS) throw new PlcError('TOO_MANY', { count: total, unit: 'addresses', most: MOST_POINTS })
}

/**
 * The points of items, in order: `item.count` of each.
 * @param {import('../tag/item').Item[]} items
 * @returns {{ kind: 'bit'|'word', address: number, count: number, text: string }[]}
 * @throws {PlcError} TOO_MANY
 */
const pointsOf = items => {
  checkTotal(items)
  return items.flatMap(item => item.elements.map(({ text }, index) => ({ ...pointOf(item, index), text })))
}

/**
 * What came for a point.
 * @typedef {{ raw: (boolean|number)[], at: number } | { error: PlcError, at: number }} Reading `at`: epoch ms
 */

/** @returns {any} */
const elementOf = (item, index, reading) => {
  const { name } = item.elements[index]
  const base = { name, timestamp: reading.at }
  if ('error' in reading) {
    return { ...base, value: null, quality: 'bad', code: reading.error.code, text: reading.error.message }
  }
  const raw = item.throughWord ? [Boolean((reading.raw[0] >> ((item.address + index) & 15)) & 1)] : reading.raw
  const answer = decodeValue(item, raw)
  if ('code' in answer) return { ...base, value: null, quality: 'bad', code: answer.code, text: answer.text }
  return { ...base, value: answer.value, quality: 'good' }
}

/** @returns {any} */
const arrayOf = (item, elements) => {
  const bad = elements.find(element => element.quality === 'bad')
  const value = elements.every(element => element.quality === 'bad') ? null : elements.map(element => element.value)
  const timestamp = Math.min(...elements.map(element => element.timestamp))
  const result = { name: item.name, value, quality: bad ? 'bad' : 'good', timestamp, elements }
  return bad ? { ...result, code: bad.code, text: bad.text } : result
}

/**
 * One result per item. That of a range has an array as value (null where an address is bad) and `elements`, one result per
 * address.
 * @param {import('../tag/item').Item[]} items
 * @param {Reading[]} readings in the order of {@link pointsOf}
 * @returns {Result[]}
 */
const resultsOf = (items, readings) => {
  let next = 0
  return items.map(item => {
    const elements = item.elements.map((_, index) => elementOf(item, index, readings[next++]))
    const result = item.range ? arrayOf(item, elements) : { ...elements[0], name: item.name }
    const { text, label, unit, tag } = item
    return { ...result, item: text, label, unit, deadband: tag ? tag.deadband : 0 }
  })
}

/**
 * @typedef {object} Result
 * @property {string} name key in messages
 * @property {string} item as the user wrote it
 * @property {any} value null if bad
 * @property {'good'|'uncertain'|'bad'} quality
 * @property {number} timestamp epoch ms at which the answer came
 * @property {string} label
 * @property {string} unit
 * @property {number} deadband engineering units, for reports by exception
 * @property {string} [code] what is wrong
 * @property {string} [text]
 * @property {any[]} [elements] of a range: a result per value
 */

module.exports = { MOST_POINTS, checkTotal, pointsOf, resultsOf }
