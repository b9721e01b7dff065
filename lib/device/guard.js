'use strict'
const { PlcError } = require('../error')
const { parseExpression } = require('../tag/item')
const { decodeValue } = require('../tag/value')

/**
 * What may be written at all; asked before anything is sent. Limits of a tag bind its words and bits, by whatever name,
 * type or width they are written.
 */

/** word address -> the limited values that stand on it: `{ item, start }`. */
const limitedWords = notation => {
  const words = new Map()
  for (const tag of notation.tags.values()) {
    if (tag.min === null && tag.max === null) continue
    const item = parseExpression(tag.address, notation, { tag })
    for (let index = 0; index < item.count; index++) {
      const start = item.address + index * item.type.words
      for (let word = start; word < start + item.type.words; word++) {
        words.set(word, [...(words.get(word) ?? []), { item, start }])
      }
    }
  }
  return words
}

const refuse = (item, reason) => new PlcError('NOT_WRITABLE', { item: item.text, reason })

const inRanges = (item, ranges) => {
  const size = item.kind === 'word' ? 16 : 1
  const end = (item.address + item.count * item.type.words) * size
  let at = item.address * size
  while (at < end) {
    const range = ranges.find(each => each.start <= at && at < each.end)
    if (!range) return false
    at = range.end
  }
  return true
}

const checkTarget = (item, ranges) => {
  if (item.tag?.writable || inRanges(item, ranges)) return
  throw refuse(item, 'a target that comes in a message must be a writable tag or lie in the writable ranges')
}

const sameValue = (item, start, { item: limited, start: from }) =>
  item.kind === 'word' &&
  start === from &&
  item.type.name === limited.type.name &&
  (item.type.words === 1 || item.wordOrder === limited.wordOrder)

/** A value that stands on limited words must be that same value, inside the limits. */
const checkLimits = (item, { start, raw, words }) => {
  const first = item.kind === 'bit' ? start >> 4 : start
  const last = item.kind === 'bit' ? first : start + item.type.words - 1
  for (let word = first; word <= last; word++) {
    for (const limited of words.get(word) ?? []) {
      const { tag } = limited.item
      if (!sameValue(item, start, limited)) {
        throw refuse(item, `it overlaps the tag ${tag.name}, which has limits, in another type or width`)
      }
      const { value } = /** @type {{ value: number }} */ (decodeValue(limited.item, raw))
      if ((tag.min !== null && value < tag.min) || (tag.max !== null && value > tag.max)) {
        const least = tag.min ?? 'any'
        throw new PlcError('VALUE_OUT_OF_RANGE', {
          item: `${item.text} (tag ${tag.name})`,
          value,
          least,
          most: tag.max ?? 'any'
        })
      }
    }
  }
}

/**
 * @param {any} settings of the PLC
 */
const createGuard = ({ access, station, ranges, notation }) => {
  const words = limitedWords(notation)
  return {
    /**
     * Whether an item may be written at all.
     * @param {import('../tag/item').Item} item
     * @param {{ fixed?: boolean }} options fixed: the target stands in the node, by the flow's author
     * @throws {PlcError} READ_ONLY, NOT_WRITABLE
     */
    checkItem: (item, { fixed = false }) => {
      if (access !== 'write') throw new PlcError('READ_ONLY', { item: item.text, station })
      if (item.throughWord) throw refuse(item, 'its area has only words: a single bit of it cannot be written')
      if (!item.areaWritable) {
        throw refuse(item, 'its area is unconfirmed or not for writing; confirm its row in the area table first')
      }
      if (!fixed) checkTarget(item, ranges)
    },
    /**
     * Whether raw values may be written to an item.
     * @param {import('../tag/item').Item} item
     * @param {any[][]} values raw words (or one bit) of each of its values
     * @throws {PlcError} NOT_WRITABLE, VALUE_OUT_OF_RANGE
     */
    checkValues: (item, values) =>
      values.forEach((raw, index) => checkLimits(item, { start: item.address + index * item.type.words, raw, words }))
  }
}

module.exports = { createGuard }
