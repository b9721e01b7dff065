'use strict'
const { PlcError } = require('../error')
const { blocksOf, groupsOf } = require('./blocks')
const { MOST_EXACT, exactPlan } = require('./exact')
const { merged } = require('./merge')
const { LAST_MIXED } = require('./mixed')
const { Model, cycleCost } = require('./model')
const { pricedPlan } = require('./priced')

/**
 * Points -> read requests with the least line time. Pure.
 *
 * @typedef {object} Limits facts about the station and its line, as data. Costs are in byte times of the line
 * @property {number} readBits bits in one request
 * @property {number} readWords words in one request
 * @property {number} readMixed addresses in one mixed request; below 2: there are none
 * @property {number} writeBits
 * @property {number} writeWords
 * @property {number} writeMixed
 * @property {number} info bytes of INFO in one frame, either way
 * @property {number[]} [bounds] absolute word addresses at which an area begins or ends
 * @property {[number, number][]} [joint] from, to: words whose bits are the same memory, so that a bit may be read with its word
 * @property {{ kind: 'bit'|'word', start: number, end: number }[]} [holes] addresses that the station does not have: no request reads over them
 * @property {boolean} [bridge] whether addresses that nobody asked for may be read where that is shorter; default true
 * @property {number} [frameCost] what a request costs beside its INFO: heads, gaps, turnaround
 * @property {number} [again] the same of a request that the station repeats (RR); missing: it does not
 * @property {number} [bitBytes] bytes of one bit in an answer, default 1
 * @property {number} [scale] byte times of one byte of INFO, default 1
 * @property {number} [unit] bits are asked for in multiples of this, default 1
 *
 * @typedef {{ kind: 'bit'|'word', address: number, count?: number }} ReadPoint absolute; `count` addresses that are one
 *   value and so must come in one answer (default 1)
 * @typedef {{ point: number, at: number, count: number, bit?: number }} Served where in the answer the raw values of a point stand; `bit`: the
 *   point's bits begin at this one of the word that stands there
 * @typedef {({ ask: 'readBits'|'readWords', base: number, count: number }
 *   | { ask: 'readMixed', addresses: { kind: 'bit'|'word', address: number }[] })
 *   & { points: Served[], cost: number, again: number }} ReadRequest `cost`, `again`: byte times, at first and repeated
 */

const MOST_GROUPS_MERGED = 300 // pairs of requests are compared only while that is quick

/** Where the values of a group stand in an answer whose addresses have these places. @returns {Served[]} */
const servedBy = ({ groups, through }, placeOf) => {
  const served = []
  for (const group of groups) {
    const { kind, start, end, points } = group
    const count = end - start
    const isThrough = through(group)
    const at = isThrough ? placeOf('word', start >> 4) : placeOf(kind, start)
    for (const point of points) served.push(isThrough ? { point, at, bit: start & 15, count } : { point, at, count })
  }
  return served
}

const shapeOf = ({ form, span, addresses }) => {
  if (form === 'mixed') return { ask: 'readMixed', addresses }
  const { kind, start, end } = span
  return { ask: kind === 'bit' ? 'readBits' : 'readWords', base: start, count: end - start }
}

const placesOf = ({ form, span, addresses }) => {
  if (form === 'block') return (_kind, address) => address - span.start
  const places = { bit: new Map(), word: new Map() }
  addresses.forEach(({ kind, address }, at) => places[kind].set(address, at))
  return (kind, address) => places[kind].get(address)
}

/** @returns {ReadRequest} */
const requestOf = frame => {
  const { cost, again } = frame
  return /** @type {any} */ ({ ...shapeOf(frame), points: servedBy(frame, placesOf(frame)), cost, again })
}

const checkGroups = (groups, model) => {
  for (const group of groups) {
    const { kind, start, end } = group
    // almost all are single addresses, which always fit
    if (end - start === 1 || model.frames([group]).length > 0) continue
    throw new PlcError('FRAME_TOO_LONG', { what: `one value of ${kind}s`, got: end - start, most: model.most[kind] })
  }
}

/** Neighbours in blocks, no holes: what any other plan has to beat. No block of a kind of which a value is too long. */
const plainBlocks = (groups, model, bounds = []) =>
  /** @type {const} */ (['word', 'bit']).flatMap(kind => {
    const own = groups.filter(group => group.kind === kind)
    const most = model.most[kind]
    if (own.some(({ start, end }) => end - start > most)) return []
    return blocksOf(own, { most, bounds: kind === 'bit' ? bounds.map(bound => bound * 16) : bounds })
  })

const servesAll = (parts, groups) => parts.reduce((sum, part) => sum + part.groups.length, 0) === groups.length

const RANK = { word: 0, bit: 1, mixed: 2 }
const rankOf = ({ form, span }) => RANK[form === 'mixed' ? form : span.kind]
const startOf = ({ form, span, addresses }) => (form === 'mixed' ? addresses[0].address : span.start)

const byAddress = frames => [...frames].sort((a, b) => rankOf(a) - rankOf(b) || startOf(a) - startOf(b))

/** The two requests that gain most by repetition stand at the ends: the last one of a cycle is the first of the next, read backwards. */
const ordered = frames => {
  const [first, last, ...others] = [...frames].sort((a, b) => b.cost - b.again - (a.cost - a.again))
  return last ? [first, ...others, last] : frames
}

/** So many blocks are needed at least, if they have no holes. @param {import('./blocks').Group[]} groups in order, one kind after the other */
const runsOf = groups => {
  let runs = 0
  let last = groups[0].kind
  let until = -Infinity
  for (const { kind, start, end } of groups) {
    if (kind !== last || start > until) {
      runs++
      last = kind
      until = end
    } else if (end > until) until = end
  }
  return runs
}

const bestPlan = (groups, model, limits) => {
  if (groups.length <= MOST_EXACT) return exactPlan(groups, model)
  const priced = pricedPlan(groups, model)
  const found = groups.length <= MOST_GROUPS_MERGED ? merged(priced, model) : priced
  // repetition saves less than one of them
  if ((runsOf(groups) - 1) * model.frameCost >= cycleCost(found)) return found
  const plain = plainBlocks(groups, model, limits.bounds)
  // of equal plans the plain one
  const isPlain =
    servesAll(plain, groups) && cycleCost(plain.map(block => model.pricesOfBlock(block))) <= cycleCost(found)
  return isPlain ? plain.map(block => model.frames(block.groups)[0]) : found
}

/**
 * Requests that read every point once, with the least line time: blocks, also over holes and of bits through their words, and mixed requests;
 * where the station repeats its last request (`again`), to be sent forwards in one cycle and backwards in the next. No value is torn over two
 * requests, none crosses an area's end. Of up to nine values no cheaper plan exists; of many it is within about 2 % of what is possible at all.
 * Manual: "Read bits", "Read words", "Read bits and words".
 * @param {ReadPoint[]} points any order, doubles allowed
 * @param {Limits} limits
 * @returns {ReadRequest[]}
 * @throws {PlcError} FRAME_TOO_LONG one value does not fit into one request
 */
const planReads = (points, limits) => {
  const groups = [...groupsOf(points, 'word'), ...groupsOf(points, 'bit')]
  if (groups.length === 0) return []
  const model = new Model(limits)
  checkGroups(groups, model)
  const frames = bestPlan(groups, model, limits)
  return (model.repeats ? ordered(frames) : byAddress(frames)).map(requestOf)
}

/**
 * Raw values of a point in the answer to its request.
 * @param {(boolean|number)[]} answer
 * @param {Served} served
 * @returns {(boolean|number)[]}
 */
const servedValues = (answer, { at, count, bit }) => {
  if (bit === undefined) return count === 1 ? [answer[at]] : answer.slice(at, at + count)
  return Array.from({ length: count }, (_, step) => {
    const place = bit + step
    return Boolean((Number(answer[at + (place >> 4)]) >> (place & 15)) & 1)
  })
}

module.exports = { LAST_MIXED, planReads, servedValues }
