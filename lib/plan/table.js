'use strict'

/**
 * Chunks as plain numbers, with what a block costs from each of them to each that it can reach: what a search asks thousands of times. Pure.
 *
 * @typedef {import('./chunks').Chunk} Chunk
 */

/** Costs of the blocks that begin at a chunk: of this one alone, with the next one, and so on. */
const costsFrom = (chunks, first, { model, costs }) => {
  const { most } = model
  const { space, start, bits } = chunks[first]
  const border = model.borderAfter(space, start)
  let end = start
  let onlyBits = bits !== null
  for (let at = first; at < chunks.length && chunks[at].space === space; at++) {
    const chunk = chunks[at]
    const apart = at > first && (!model.mayBridge(space, end, chunk.start) || chunk.end > Math.max(border, end))
    end = Math.max(end, chunk.end)
    if (apart || end - start > most[space]) return
    onlyBits &&= chunk.bits !== null
    const span = onlyBits ? chunk.bits.last - bits.first : Infinity
    const asBits = span <= most.bit ? model.blockCost('bit', span) : Infinity
    costs.push(Math.min(model.blockCost(space, end - start), asBits))
  }
}

/**
 * @param {Chunk[]} chunks in order of address, one space after the other
 * @param {import('./model').Model} model
 * @returns {{ count: number, shares: Int32Array, answers: Int32Array, costs: Float64Array, first: Int32Array }} `shares`, `answers`: addresses and
 *   bytes in a mixed request (0: it cannot hold them); `costs` from `first[chunk]` on: of the blocks that begin there
 */
const chunkTable = (chunks, model) => {
  const costs = []
  const first = new Int32Array(chunks.length + 1)
  for (let at = 0; at < chunks.length; at++) {
    costsFrom(chunks, at, { model, costs })
    first[at + 1] = costs.length
  }
  const numbers = of => Int32Array.from(chunks, ({ share }) => (share ? of(share) : 0))
  return {
    count: chunks.length,
    shares: numbers(({ count }) => count),
    answers: numbers(({ answer }) => answer),
    costs: Float64Array.from(costs),
    first
  }
}

module.exports = { chunkTable }
