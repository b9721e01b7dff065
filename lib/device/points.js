'use strict'
const { PlcError } = require('../error')
const { splitType } = require('../tag/item')
const { decodeValue } = require('../tag/value')

/** Items -> absolute points to read and to write, and back: raw words and bits -> results. Pure. */

const MOST_POINTS = 20000

const WORD = 16

/**
 * How many addresses (bits or words) one value of an item takes: a word that is packed into bits takes sixteen of them.
 * @param {any} item
 */
const widthOf = item => (item.packed ? item.type.words * WORD : item.type.words)

/** Addresses of one value of an item. A bit that the station offers only in its word is read through it. */
const pointOf = (item, index) => {
  const { kind, address } = item
  if (item.throughWord) return { kind: 'word', address: (address + index) >> 4, count: 1 }
  const count = widthOf(item)
  return { kind, address: address + index * count, count }
}

/** The address as the user wrote it, or the name of the tag. */
const writtenAs = item => (item.tag ? item.text : splitType(item.text.trim())[0])

/** Bits -> words, the lowest bit first; and back. */
const packed = bits =>
  Array.from({ length: bits.length / WORD }, (_, word) =>
    bits.slice(word * WORD, (word + 1) * WORD).reduce((sum, bit, at) => sum | (bit ? 1 << at : 0), 0)
  )
const unpacked = words => words.flatMap(word => Array.from({ length: WORD }, (_, at) => Boolean((word >> at) & 1)))

/**
 * The points that are written for the values of an item; `through`: the station writes only the word of this bit.
 * @param {{ item: any, values: any[][] }} entry values: raw words, or one bit, of each value
 * @returns {{ kind: 'bit'|'word', address: number, count: number, values: (boolean|number)[], text: string, through: boolean }[]}
 */
const writePointsOf = ({ item, values }) => {
  const width = widthOf(item)
  return values.map((raw, index) => ({
    kind: item.kind,
    address: item.address + index * width,
    values: item.packed ? unpacked(raw) : raw,
    count: width,
    text: item.range ? item.elements[index].text : writtenAs(item),
    through: item.throughWord
  }))
}

/** What is read to compare a point that was written. */
const readBackOf = ({ kind, address, count, text, through }) =>
  through
    ? { kind: /** @type {'word'} */ ('word'), address: address >> 4, count: 1, text }
    : { kind, address, count, text }

/** The raw values of a written point, out of what {@link readBackOf} gave. */
const readBackValues = ({ address, through }, raw) => (through ? [Boolean((raw[0] >> (address & 15)) & 1)] : raw)

/** @param {import('../tag/item').Item[]} items @throws {PlcError} TOO_MANY */
const checkTotal = items => {
  const total = items.reduce((sum, item) => sum + item.count * widthOf(item), 0)
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
  return items.flatMap(item =>
    item.elements.map(({ text }, index) => ({ ...pointOf(item, index), text: item.range ? text : writtenAs(item) }))
  )
}

/**
 * What came for a point.
 * @typedef {{ raw: (boolean|number)[], at: number } | { error: PlcError, at: number }} Reading `at`: epoch ms
 */

const rawOf = (item, index, raw) => {
  if (item.packed) return packed(raw)
  if (!item.throughWord) return raw
  return readBackValues({ address: item.address + index, through: item.throughWord }, raw)
}

/** @returns {any} */
const elementOf = (item, index, reading) => {
  // that of a single value goes by the item's own name
  const name = item.range ? item.elements[index].name : item.name
  const timestamp = reading.at
  if ('error' in reading) {
    const { code, message } = reading.error
    return { name, timestamp, value: null, quality: 'bad', code, text: message }
  }
  const answer = decodeValue(item, rawOf(item, index, reading.raw))
  if ('code' in answer) return { name, timestamp, value: null, quality: 'bad', code: answer.code, text: answer.text }
  return { name, timestamp, value: answer.value, quality: 'good' }
}

/** @returns {any} */
const arrayOf = (item, elements) => {
  const bad = elements.find(element => element.quality === 'bad')
  const value = bad && elements.every(element => element.quality === 'bad') ? null : elements.map(each => each.value)
  const timestamp = elements.reduce((least, element) => Math.min(least, element.timestamp), Infinity)
  const result = { name: item.name, value, quality: bad ? 'bad' : 'good', timestamp, elements }
  return bad ? { ...result, code: bad.code, text: bad.text } : result
}

const deadbandOf = ({ tag }) => (tag ? tag.deadband : 0)

const described = (item, result) => {
  const { text, label, unit } = item
  return Object.assign(result, { item: text, label, unit, deadband: deadbandOf(item) })
}

/** Of an item that is no range. A good one is made as one object: there may be thousands of them each second. */
const singleOf = (item, reading) => {
  if ('error' in reading) return described(item, elementOf(item, 0, reading))
  const answer = decodeValue(item, rawOf(item, 0, reading.raw))
  if ('code' in answer) return described(item, elementOf(item, 0, reading))
  const { name, text, label, unit } = item
  const { value } = answer
  const deadband = deadbandOf(item)
  return { name, timestamp: reading.at, value, quality: 'good', item: text, label, unit, deadband }
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
    if (!item.range) return singleOf(item, readings[next++])
    const elements = item.elements.map((_, index) => elementOf(item, index, readings[next++]))
    return described(item, arrayOf(item, elements))
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
 * @property {number|string} deadband engineering units, or `2%`, for reports by exception
 * @property {string} [code] what is wrong
 * @property {string} [text]
 * @property {any[]} [elements] of a range: a result per value
 */

module.exports = {
  MOST_POINTS,
  checkTotal,
  packed,
  pointsOf,
  readBackOf,
  readBackValues,
  resultsOf,
  widthOf,
  writePointsOf
}
