'use strict'
const { blocksOf, groupsOf, partsOf } = require('./blocks')
const { share } = require('./share')

/**
 * Points -> read requests. Pure.
 *
 * @typedef {object} Limits facts about the station and its line, as data
 * @property {number} readBits bits in one request
 * @property {number} readWords words in one request
 * @property {number} readMixed addresses in one mixed request
 * @property {number} writeBits
 * @property {number} writeWords
 * @property {number} writeMixed
 * @property {number} info bytes of INFO in one frame, either way
 * @property {number[]} [bounds] absolute word addresses at which an area begins or ends
 * @property {number} [frameCost] what a request costs beside its INFO (heads, gaps, turnaround), in byte times
 *
 * @typedef {{ kind: 'bit'|'word', address: number, count?: number }} ReadPoint absolute; `count` addresses that are one
 *   value and so must come in one answer (default 1)
 * @typedef {{ point: number, at: number, count: number }} Served where in the answer the raw values of a point stand
 * @typedef {({ ask: 'readBits'|'readWords', base: number, count: number }
 *   | { ask: 'readMixed', addresses: { kind: 'bit'|'word', address: number }[] }) & { points: Served[] }} ReadRequest
 */

const LAST_MIXED = 0x3fff // two of sixteen bits of a mixed address say what it is
const FRAME_COST = 60 // two frames' heads and CRC, 10 ms of gap and some of turnaround at 38400 bit/s

const servedBy = (groups, placeOf) =>
  groups.flatMap(group => group.points.map(point => ({ point, at: placeOf(group), count: group.end - group.start })))

/** @returns {ReadRequest} */
const ownRequest = ({ kind, start, end, groups }) => ({
  ask: kind === 'bit' ? 'readBits' : 'readWords',
  base: start,
  count: end - start,
  points: servedBy(groups, group => group.start - start)
})

/** @returns {ReadRequest} */
const sharedRequest = parts => {
  const places = new Map()
  for (const { kind, start, end } of parts) {
    for (let address = start; address < end; address++) {
      const key = `${kind}${address}`
      if (!places.has(key)) places.set(key, { at: places.size, kind, address })
    }
  }
  const addresses = [...places.values()].map(({ kind, address }) => ({ kind, address }))
  const placeOf = group => places.get(`${group.kind}${group.start}`).at
  return {
    ask: 'readMixed',
    addresses,
    points: servedBy(
      parts.flatMap(part => part.groups),
      placeOf
    )
  }
}

const blocksFor = (points, kind, limits) => {
  const { readBits, readWords, info, bounds = [] } = limits
  const most = kind === 'bit' ? Math.min(readBits, info) : Math.min(readWords, info >> 1)
  const chosen = points
    .map(({ kind: each, address, count = 1 }, point) => ({ kind: each, address, count, point }))
    .filter(point => point.kind === kind)
  return blocksOf(groupsOf(chosen), { most, bounds: kind === 'bit' ? bounds.map(bound => bound * 16) : bounds })
}

const items = ({ start, end }) => end - start

/**
 * Requests that read every point once: neighbours in blocks, scattered ones in mixed requests where that costs less line
 * time. No value is torn over two requests, none crosses an area's end. Manual: "Read bits", "Read words", "Read bits and
 * words".
 * @param {ReadPoint[]} points any order, doubles allowed
 * @param {Limits} limits
 * @returns {ReadRequest[]}
 * @throws {import('../error').PlcError} FRAME_TOO_LONG one value does not fit into one request
 */
const planReads = (points, limits) => {
  const blocks = [...blocksFor(points, 'word', limits), ...blocksFor(points, 'bit', limits)]
  const most = Math.min(limits.readMixed, limits.info >> 1)
  const { own, shared } = share(blocks, {
    mixed: {
      items: most,
      bytes: 2 * most,
      last: { bit: LAST_MIXED, word: LAST_MIXED },
      size: block => 2 * items(block)
    },
    frameCost: limits.frameCost ?? FRAME_COST,
    // the third byte is left out, so that a mixed request for one address is never the cheaper one
    ownCost: block => 2 + items(block) * (block.kind === 'bit' ? 1 : 2),
    sharedCost: block => items(block) * (block.kind === 'bit' ? 3 : 4),
    partsOf
  })
  return [...own.map(ownRequest), ...shared.map(sharedRequest)]
}

module.exports = { LAST_MIXED, planReads }
