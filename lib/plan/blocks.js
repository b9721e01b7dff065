'use strict'
const { PlcError } = require('../error')

/**
 * Points -> blocks of neighbouring addresses. Pure.
 *
 * @typedef {object} Group addresses that must stand in one request, because they are one value
 * @property {'bit'|'word'} kind
 * @property {number} start absolute address
 * @property {number} end absolute address after the last one
 * @property {number[]} points which points it serves
 *
 * @typedef {{ kind: 'bit'|'word', start: number, end: number, groups: Group[] }} Block
 */

const order = (a, b) => a.start - b.start || a.end - b.end

/**
 * Groups in order of address, each once.
 * @param {{ kind: 'bit'|'word', address: number, count: number, point: number }[]} points
 * @returns {Group[]}
 */
const groupsOf = points => {
  const groups = new Map()
  for (const { kind, address, count, point } of points) {
    const key = `${address} ${count}`
    const known = groups.get(key)
    if (known) known.points.push(point)
    else groups.set(key, { kind, start: address, end: address + count, points: [point] })
  }
  return [...groups.values()].sort(order)
}

/** The first border after an address: no block crosses it, since the CPU's areas need not be one memory. */
const borders = bounds => {
  const sorted = [...new Set(bounds)].sort((a, b) => a - b)
  return start => {
    let low = 0
    let high = sorted.length
    while (low < high) {
      const middle = (low + high) >> 1
      if (sorted[middle] > start) high = middle
      else low = middle + 1
    }
    return low < sorted.length ? sorted[low] : Infinity
  }
}

/**
 * As few blocks as possible that hold every group whole: each begins at the first group that is not served yet and takes
 * what touches it, up to `most` addresses, and never crosses a border.
 * @param {Group[]} groups of one kind, in order
 * @param {{ most: number, bounds: number[] }} limits
 * @returns {Block[]}
 * @throws {PlcError} FRAME_TOO_LONG one value alone is longer than `most`
 */
const blocksOf = (groups, { most, bounds }) => {
  const borderAfter = borders(bounds)
  /** @type {Block[]} */
  const blocks = []
  let block = null
  let border = Infinity
  for (const group of groups) {
    const { kind, start, end } = group
    if (end - start > most)
      throw new PlcError('FRAME_TOO_LONG', { what: `one value of ${kind}s`, got: end - start, most })
    if (block && start <= block.end && end <= Math.max(border, block.end) && end - block.start <= most) {
      block.end = Math.max(block.end, end)
      block.groups.push(group)
    } else {
      block = { kind, start, end, groups: [group] }
      border = borderAfter(start)
      blocks.push(block)
    }
  }
  return blocks
}

/**
 * Parts of a block that may go separate ways: values that do not overlap.
 * @param {Block} block
 * @returns {Block[]}
 */
const partsOf = ({ kind, groups }) => {
  /** @type {Block[]} */
  const parts = []
  for (const group of groups) {
    const last = parts.at(-1)
    if (last && group.start < last.end) {
      last.end = Math.max(last.end, group.end)
      last.groups.push(group)
    } else parts.push({ kind, start: group.start, end: group.end, groups: [group] })
  }
  return parts
}

module.exports = { blocksOf, groupsOf, partsOf }
