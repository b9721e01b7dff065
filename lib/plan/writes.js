'use strict'
const { blocksOf, groupsOf, partsOf } = require('./blocks')
const { LAST_MIXED } = require('./reads')
const { share } = require('./share')

/**
 * Points with values -> write requests. Pure.
 *
 * @typedef {import('./reads').Limits} Limits
 * @typedef {{ kind: 'bit'|'word', address: number, values: (boolean|number)[] }} WritePoint absolute; its values go out in
 *   one frame
 * @typedef {({ ask: 'writeBits', base: number, values: boolean[] } | { ask: 'writeWords', base: number, values: number[] }
 *   | { ask: 'writeMixed', writes: { kind: 'bit'|'word', address: number, value: boolean|number }[] })
 *   & { points: number[] }} WriteRequest
 */

const MANY = 1e6 // a frame costs more than any bytes: a write is to be done in as few as possible

/**
 * Rounds of points such that no two of a round overlap and later ones for the same target come later. A word overlaps
 * its sixteen bits.
 */
const roundsOf = points => {
  const rounds = []
  const lastOfBit = new Map()
  const lastOfWord = new Map()
  points.forEach((point, index) => {
    let round = 0
    const places = point.values.map((_, at) => point.address + at)
    for (const place of places) round = Math.max(round, lastTouch(point.kind, place, { lastOfBit, lastOfWord }) + 1)
    for (const place of places) touch(point.kind, place, { lastOfBit, lastOfWord, round })
    ;(rounds[round] ??= []).push({ ...point, point: index })
  })
  return rounds
}

const lastTouch = (kind, place, { lastOfBit, lastOfWord }) => {
  if (kind === 'bit') return Math.max(lastOfBit.get(place) ?? -1, lastOfWord.get(place >> 4) ?? -1)
  const bits = Array.from({ length: 16 }, (_, bit) => lastOfBit.get(place * 16 + bit) ?? -1)
  return Math.max(lastOfWord.get(place) ?? -1, ...bits)
}

const touch = (kind, place, { lastOfBit, lastOfWord, round }) => {
  ;(kind === 'bit' ? lastOfBit : lastOfWord).set(place, round)
}

const blocksFor = (points, kind, limits) => {
  const { writeBits, writeWords, info, bounds = [] } = limits
  const most = kind === 'bit' ? Math.min(writeBits, info - 2) : Math.min(writeWords, (info - 2) >> 1)
  const places = points.map(({ kind: own, address, values }) => ({ kind: own, address, count: values.length }))
  const groups = groupsOf(places, kind, at => points[at].point)
  return blocksOf(groups, { most, bounds: kind === 'bit' ? bounds.map(bound => bound * 16) : bounds })
}

const items = ({ start, end }) => end - start
const pointsOf = parts => parts.flatMap(part => part.groups.flatMap(group => group.points)).sort((a, b) => a - b)

const ownRequest = (block, valueAt) => {
  const values = Array.from({ length: items(block) }, (_, at) => valueAt(block.kind, block.start + at))
  const ask = block.kind === 'bit' ? 'writeBits' : 'writeWords'
  return /** @type {WriteRequest} */ ({ ask, base: block.start, values, points: pointsOf([block]) })
}

/** @returns {WriteRequest} */
const sharedRequest = (parts, valueAt) => ({
  ask: 'writeMixed',
  writes: parts.flatMap(({ kind, start, end }) =>
    Array.from({ length: end - start }, (_, at) => ({ kind, address: start + at, value: valueAt(kind, start + at) }))
  ),
  points: pointsOf(parts)
})

const planRound = (points, limits) => {
  const values = new Map()
  for (const { kind, address, values: given } of points) {
    given.forEach((value, at) => values.set(`${kind}${address + at}`, value))
  }
  const valueAt = (kind, address) => values.get(`${kind}${address}`)
  const { own, shared } = share([...blocksFor(points, 'word', limits), ...blocksFor(points, 'bit', limits)], {
    mixed: {
      items: limits.writeMixed,
      bytes: limits.info,
      last: { bit: LAST_MIXED, word: LAST_MIXED },
      size: block => items(block) * (block.kind === 'bit' ? 3 : 4)
    },
    frameCost: MANY,
    ownCost: block => 2 + items(block) * (block.kind === 'bit' ? 1 : 2),
    sharedCost: block => items(block) * (block.kind === 'bit' ? 3 : 4),
    partsOf
  })
  return [...own.map(block => ownRequest(block, valueAt)), ...shared.map(parts => sharedRequest(parts, valueAt))]
}

/** Requests of rounds, which are not to be mixed. @returns {WriteRequest[]} */
const planRounds = (rounds, limits) => rounds.flatMap(round => planRound(round, limits))

/**
 * As few requests as possible that write every point: what belongs together in one frame, what has the same target never
 * in another order than given. Manual: "Write bits", "Write words", "Write bits and words".
 * @param {WritePoint[]} points
 * @param {Limits} limits
 * @returns {WriteRequest[]} to be sent in this order
 * @throws {import('../error').PlcError} FRAME_TOO_LONG one value does not fit into one frame
 */
const planWrites = (points, limits) => planRounds(roundsOf(points), limits)

module.exports = { planRounds, planWrites, roundsOf }
