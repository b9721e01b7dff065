'use strict'
const { PlcError } = require('../error')
const { parseExpression } = require('../tag/item')
const { decodeValue } = require('../tag/value')
const { widthOf } = require('./points')

/**
 * What may be written at all; asked before anything is sent. Limits of a tag bind its words and bits, by whatever name,
 * type or width they are written.
 */

const BLOCK = 16 // bits: where two spans can meet at all is looked up by these, then they are compared bit by bit

/** The absolute bits of the values of an item, one span each. */
const spansOf = item => {
  const size = item.kind === 'word' ? 16 : 1
  const width = widthOf(item) * size
  return Array.from({ length: item.count }, (_, index) => {
    const start = item.address * size + index * width
    return { start, end: start + width }
  })
}

const blocksOf = ({ start, end }) => {
  const first = Math.floor(start / BLOCK)
  return Array.from({ length: Math.floor((end - 1) / BLOCK) - first + 1 }, (_, at) => first + at)
}

/** Block of bits -> the limited values that stand on it: `{ item, start, end }`. */
const limitedBlocks = notation => {
  const blocks = new Map()
  for (const tag of notation.tags.values()) {
    if (tag.min === null && tag.max === null && tag.maxStep === null) continue
    const item = parseExpression(tag.address, notation, { tag })
    for (const span of spansOf(item)) {
      const limited = { item, ...span }
      for (const block of blocksOf(span)) blocks.set(block, [...(blocks.get(block) ?? []), limited])
    }
  }
  return blocks
}

const refuse = (item, reason) => new PlcError('NOT_WRITABLE', { item: item.text, reason })

const inRanges = (item, ranges) => {
  const spans = spansOf(item)
  const { end } = spans[spans.length - 1]
  let at = spans[0].start
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

const sameValue = (item, span, { item: limited, start }) =>
  span.start === start &&
  item.type.name === limited.type.name &&
  (item.type.words === 1 || item.wordOrder === limited.wordOrder)

const checkInside = (item, raw, limited) => {
  const { tag } = limited
  const { value } = /** @type {{ value: number }} */ (decodeValue(limited, raw))
  if ((tag.min === null || value >= tag.min) && (tag.max === null || value <= tag.max)) return
  const limits = { least: tag.min ?? 'any', most: tag.max ?? 'any' }
  throw new PlcError('VALUE_OUT_OF_RANGE', { item: `${item.text} (tag ${tag.name})`, value, ...limits })
}

/** What must be read before: where the limited value stands. @returns {import('./step').Step & { at: number }} */
const stepOf = (item, { raw, at }, { item: limited, start, end }) => {
  const { kind, tag } = limited
  const size = kind === 'word' ? BLOCK : 1
  const point = { kind, address: start / size, count: (end - start) / size, text: tag.name }
  return { item: limited, point, raw, text: item.text, at }
}

/** A value that stands on limited bits must be that same value, inside the limits. @returns {Set<any>} the limited values */
const checkLimits = (item, { span, raw, blocks }) => {
  const met = new Set()
  for (const block of blocksOf(span)) {
    for (const limited of blocks.get(block) ?? []) {
      if (met.has(limited) || span.end <= limited.start || limited.end <= span.start) continue
      if (!sameValue(item, span, limited)) {
        const { name } = limited.item.tag
        throw refuse(item, `it overlaps the tag ${name}, which has limits, in another type or width`)
      }
      checkInside(item, raw, limited.item)
      met.add(limited)
    }
  }
  return met
}

const stepsOf = (item, value, met) =>
  [...met].filter(({ item: { tag } }) => tag.maxStep !== null).map(limited => stepOf(item, value, limited))

/**
 * @param {any} settings of the station; `reasons`: why its areas, or bits of its words, cannot be written
 */
const createGuard = ({ access, station, ranges, notation, reasons }) => {
  const blocks = limitedBlocks(notation)
  return {
    /**
     * Whether an item may be written at all.
     * @param {import('../tag/item').Item} item
     * @param {{ fixed?: boolean }} options fixed: the target stands in the node, by the flow's author
     * @throws {PlcError} READ_ONLY, NOT_WRITABLE
     */
    checkItem: (item, { fixed = false }) => {
      if (access !== 'write') throw new PlcError('READ_ONLY', { item: item.text, station })
      if (item.throughWord && reasons.throughWord) throw refuse(item, reasons.throughWord)
      if (!item.areaWritable) throw refuse(item, reasons.area)
      if (!fixed) checkTarget(item, ranges)
    },
    /**
     * Whether raw values may be written to an item.
     * @param {import('../tag/item').Item} item
     * @param {any[][]} values raw words (or one bit) of each of its values
     * @returns {(import('./step').Step & { at: number })[]} whose size is to be checked before they are sent; `at`: which of the values
     * @throws {PlcError} NOT_WRITABLE, VALUE_OUT_OF_RANGE
     */
    checkValues: (item, values) =>
      spansOf(item).flatMap((span, at) => {
        const raw = values[at]
        return stepsOf(item, { raw, at }, checkLimits(item, { span, raw, blocks }))
      })
  }
}

module.exports = { createGuard }
