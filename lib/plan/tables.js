'use strict'
const { PlcError } = require('../error')
const { planReads } = require('./reads')
const { planRounds, roundsOf } = require('./writes')

/**
 * Stations whose addresses stand in tables, each with limits of its own and no request that mixes them (MODBUS). Pure.
 *
 * @typedef {object} Table a row of facts
 * @property {'bit'|'word'} kind
 * @property {number} from absolute address of its first bit or word
 * @property {number} to absolute address after its last one
 * @property {number} read addresses in one request
 * @property {number} write addresses in one request; 0: it is only read
 * @property {number} [unit] bits are asked for in multiples of this
 * @property {number} [frameCost] byte times that a request costs beside its INFO
 * @property {number} [scale] byte times of one byte of INFO
 *
 * @typedef {import('./reads').ReadPoint} ReadPoint
 * @typedef {import('./writes').WritePoint} WritePoint
 * @typedef {{ ask: 'writeBitsOfWord', base: number, mask: number, value: number, points: number[] }} BitsOfWord the bits of `mask`
 *   get those of `value`, the word's other bits stay
 */

const WIDE = 0x100000 // bytes: what one request takes is said by the table

/** @param {Table} table */
const limitsOf = ({ read, write, unit, frameCost, scale }) => ({
  ...{ unit, frameCost, scale, bitBytes: 1 / 8 },
  readBits: read,
  readWords: read,
  readMixed: 0,
  writeBits: write,
  writeWords: write,
  writeMixed: 0,
  info: WIDE
})

/** Holes of a table alone. */
const holesIn = ({ kind, from, to }, holes = []) =>
  holes.filter(hole => hole.kind === kind && from <= hole.start && hole.start < to)

/** Which of the points stand in a table, with their places in the whole. */
const within = ({ kind, from, to }, points) =>
  points
    .map((point, index) => ({ point, index }))
    .filter(({ point }) => point.kind === kind && from <= point.address && point.address < to)

/**
 * Requests that read every point once, neighbours in blocks, no request over two tables.
 * @param {ReadPoint[]} points
 * @param {Table[]} tables
 * @param {{ holes?: import('./reads').Limits['holes'] }} [facts] what the station does not have
 * @returns {import('./reads').ReadRequest[]} `readBits` and `readWords` only
 * @throws {PlcError} FRAME_TOO_LONG one value does not fit into one request
 */
const planTables = (points, tables, { holes } = {}) =>
  tables.flatMap(table => {
    const own = within(table, points)
    const requests = planReads(
      own.map(({ point }) => point),
      { ...limitsOf(table), holes: holesIn(table, holes) }
    )
    return requests.map(request => ({
      ...request,
      points: request.points.map(each => ({ ...each, point: own[each.point].index }))
    }))
  })

/** Bits that the station only writes with their word: those of one word in one request. @returns {BitsOfWord[]} */
const bitsOfWords = points => {
  const words = new Map()
  for (const { address, values, point } of points) {
    values.forEach((value, at) => {
      const base = (address + at) >> 4
      const bit = 1 << ((address + at) & 15)
      const request = words.get(base) ?? { ask: 'writeBitsOfWord', base, mask: 0, value: 0, points: [] }
      request.mask |= bit
      if (value) request.value |= bit
      if (!request.points.includes(point)) request.points.push(point)
      words.set(base, request)
    })
  }
  return [...words.values()].sort((a, b) => a.base - b.base)
}

const planRound = (points, tables) => {
  const plain = points.filter(point => !point.through)
  const requests = tables.flatMap(table => {
    const own = within(table, plain).map(({ point }) => point)
    if (own.length > 0 && table.write === 0) {
      throw new PlcError('FRAME_TOO_LONG', { what: `a write of ${table.kind}s`, got: own.length, most: 0 })
    }
    return planRounds([own], limitsOf(table))
  })
  return [...requests, ...bitsOfWords(points.filter(point => point.through))]
}

/**
 * As few requests as possible that write every point, in an order in which later writes of one target come later. Points with
 * `through` are bits of words: the station writes only the word, so they become `writeBitsOfWord`.
 * @param {(WritePoint & { through?: boolean })[]} points
 * @param {Table[]} tables
 * @returns {(import('./writes').WriteRequest | BitsOfWord)[]} to be sent in this order
 * @throws {PlcError} FRAME_TOO_LONG one value does not fit into one frame, or the table is only read
 */
const planTableWrites = (points, tables) => roundsOf(points).flatMap(round => planRound(round, tables))

module.exports = { planTableWrites, planTables }
