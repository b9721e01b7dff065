'use strict'

/**
 * Chunks as plain numbers, with what a block costs from each of them to each that it can reach: what a search asks thousands of times. Pure.
 *
 * @typedef {import('./chunks').Chunk} Chunk
 */

/** The chunk after the last one that a block can hold which begins at this one. */
const reachOf = (chunks, first, model) => {
  const { space, start } = chunks[first]
  const border = model.borderAfter(space, start)
  const most = model.most[space]
  let end = start
  let at = first
  for (; at < chunks.length && chunks[at].space === space; at++) {
    const chunk = chunks[at]
    if (at > first && (!model.mayBridge(space, end, chunk.start) || chunk.end > Math.max(border, end))) break
    end = Math.max(end, chunk.end)
    if (end - start > most) break
  }
  return at
}

/** What blocks cost, by how many bits or words they have. */
const costsByLength = model => {
  const costsOf = kind =>
    Float64Array.from({ length: model.most[kind] + 1 }, (_, count) => model.blockCost(kind, count))
  return { bit: costsOf('bit'), word: costsOf('word') }
}

/** Costs of the blocks that begin at a chunk: of this one alone, with the next one, and so on. */
const fillCosts = (chunks, { from, to }, { costs, place, byLength }) => {
  const { space, start, bits } = chunks[from]
  const own = byLength[space]
  let end = start
  let onlyBits = bits !== null
  for (let at = from; at < to; at++) {
    const chunk = chunks[at]
    end = Math.max(end, chunk.end)
    costs[place + at - from] = own[end - start]
    onlyBits &&= chunk.bits !== null
    // the same as bits is shorter where there are few
    const span = onlyBits ? chunk.bits.last - bits.first : Infinity
    if (span < byLength.bit.length) costs[place + at - from] = Math.min(own[end - start], byLength.bit[span])
  }
}

/**
 * @param {Chunk[]} chunks in order of address, one space after the other
 * @param {import('./model').Model} model
 * @returns {{ count: number, shares: Int32Array, answers: Int32Array, costs: Float64Array, first: Int32Array }} `shares`, `answers`: addresses and
 *   bytes in a mixed request (0: it cannot hold them); `costs` from `first[chunk]` on: of the blocks that begin there
 */
const chunkTable = (chunks, model) => {
  const count = chunks.length
  const first = new Int32Array(count + 1)
  for (let at = 0; at < count; at++) first[at + 1] = first[at] + reachOf(chunks, at, model) - at
  const costs = new Float64Array(first[count])
  const byLength = costsByLength(model)
  const shares = new Int32Array(count)
  const answers = new Int32Array(count)
  for (let at = 0; at < count; at++) {
    const place = first[at]
    fillCosts(chunks, { from: at, to: at + first[at + 1] - place }, { costs, place, byLength })
    const { share } = chunks[at]
    shares[at] = share ? share.count : 0
    answers[at] = share ? share.answer : 0
  }
  return { count, shares, answers, costs, first }
}

module.exports = { chunkTable }
