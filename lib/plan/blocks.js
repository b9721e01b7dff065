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

/**
 * Address and place in the list of the points of one kind, as one number each: in order of address, and those of one address as they came.
 * @returns {Float64Array} address × size of the list + place
 */
const inOrder = (points, kind) => {
  const size = points.length
  const keys = new Float64Array(size)
  let count = 0
  for (let at = 0; at < size; at++) if (points[at].kind === kind) keys[count++] = points[at].address * size + at
  // plain numbers are sorted many times as fast as objects
  return keys.subarray(0, count).sort()
}

/** Where the group of these addresses stands, or belongs, among the last ones, which are ordered by their ends where they begin at the same address. */
const placeAmong = (groups, start, end) => {
  let at = groups.length
  while (at > 0 && groups[at - 1].start === start && groups[at - 1].end > end) at--
  const known = groups[at - 1]
  return known && known.start === start && known.end === end ? at - 1 : at
}

/** @param {Group[]} groups of one kind @param {Group} group one point more */
const add = (groups, group) => {
  const { start, end, points } = group
  const at = placeAmong(groups, start, end)
  if (at === groups.length) groups.push(group)
  else if (groups[at].start === start && groups[at].end === end) groups[at].points.push(...points)
  else groups.splice(at, 0, group)
}

/**
 * Groups of one kind in order of address, each once.
 * @param {{ kind: 'bit'|'word', address: number, count?: number }[]} points
 * @param {'bit'|'word'} kind
 * @param {(at: number) => number} [pointAt] what a group shall call the point that stands there in the list; default: so
 * @returns {Group[]}
 */
const groupsOf = (points, kind, pointAt = at => at) => {
  /** @type {Group[]} */
  const groups = []
  const keys = inOrder(points, kind)
  for (let n = 0; n < keys.length; n++) {
    const at = keys[n] % points.length
    const { address, count = 1 } = points[at]
    add(groups, { kind, start: address, end: address + count, points: [pointAt(at)] })
  }
  return groups
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
