'use strict'
const { PlcError } = require('../error')
const { decodeValue } = require('../tag/value')
const { packed } = require('./points')

/**
 * The largest step of a tag: what the station holds now is read in the conversation that writes, right before the frame that writes, so that nothing
 * of ours comes between. Pure; the conversation is a generator.
 *
 * @typedef {object} Step
 * @property {any} item of the limited tag
 * @property {{ kind: 'bit'|'word', address: number, count: number, text: string }} point where it stands
 * @property {any[]} raw what is to be written there
 * @property {string} text what the user calls it
 */

/** Requests that may be spent on finding out which address spoils a joint read. */
const MOST_SPLITS = 64

/** Rounding of a float32, relative. */
const FLOAT = 2 ** -23
const DOUBLE = 2 ** -40

const differs = (type, { value, now, most }) => {
  const scale = Math.max(Math.abs(value), Math.abs(now), most)
  // 0.8 - 0.5 is 0.30000000000000004
  return Math.abs(value - now) - most > scale * (type.integer ? DOUBLE : FLOAT)
}

/** @param {Step} step @param {any[]} raw what the station holds @throws {PlcError} STEP_TOO_LARGE, NOT_A_VALUE */
const checkStep = ({ item, raw: next, text }, raw) => {
  const { type, tag } = item
  const named = text === tag.name ? text : `${text} (tag ${tag.name})`
  const now = decodeValue(item, item.packed ? packed(raw) : raw)
  if (!('value' in now)) {
    const reason = 'what stands there is no value, so the size of the step is not known'
    throw new PlcError('NOT_A_VALUE', { item: named, type: type.name, reason })
  }
  const { value } = /** @type {{ value: number }} */ (decodeValue(item, next))
  const sizes = { value, now: now.value, most: tag.maxStep }
  if (differs(type, sizes)) throw new PlcError('STEP_TOO_LARGE', { item: named, ...sizes })
}

/**
 * Raw values of points, read inside a conversation.
 * @param {any[]} points
 * @param {{ plan: import('./options').Plan, ask: (request: any) => Generator<any, any[], Buffer>, budget?: { left: number } }} how
 * @returns {Generator<any, any[][], Buffer>} in the order of the points
 */
function* readPoints(points, { plan, ask, budget = { left: MOST_SPLITS } }) {
  const raws = new Array(points.length)
  for (const request of plan.reads(points)) {
    const own = request.points.map(({ point }) => point)
    try {
      const answer = yield* ask(request)
      for (const { point, at, count } of request.points) raws[point] = answer.slice(at, at + count)
    } catch (/** @type {any} */ error) {
      for (const part of partsOf(own, { plan, request, error, budget })) {
        const found = yield* readPoints(
          part.map(index => points[index]),
          { plan, ask, budget }
        )
        part.forEach((index, at) => (raws[index] = found[at]))
      }
    }
  }
  return raws
}

/** What is asked for instead of a joint read that the station refuses: it may be spoilt by what lies between. @returns {number[][]} */
const partsOf = (indexes, { plan, request, error, budget }) => {
  if (plan.simpler(request, error)) return [indexes]
  if (!plan.splits.has(error.code) || indexes.length < 2 || budget.left <= 0) throw error
  budget.left -= 2
  const middle = indexes.length >> 1
  return [indexes.slice(0, middle), indexes.slice(middle)]
}

const keyOf = ({ kind, address, count }) => `${kind} ${address} ${count}`

/**
 * Reads what the station holds and compares.
 * @param {Step[]} steps
 * @param {{ plan: any, ask: (request: any) => Generator<any, any[], Buffer> }} how
 * @returns {Generator<any, void, Buffer>}
 * @throws {PlcError} STEP_TOO_LARGE, NOT_A_VALUE, and whatever reading throws
 */
function* checkSteps(steps, how) {
  // each place once, however many values are to stand on it
  const points = new Map(steps.map(({ point }) => [keyOf(point), point]))
  const raws = yield* readPoints([...points.values()], how)
  const held = new Map([...points.keys()].map((key, index) => [key, raws[index]]))
  for (const step of steps) checkStep(step, /** @type {any[]} */ (held.get(keyOf(step.point))))
}

module.exports = { checkSteps }
