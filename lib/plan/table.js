'use strict'

/**
 * Chunks as plain numbers, with what a block costs from each of them to each that it can reach: what a search asks thousands of times. Pure.
 *
 * @typedef {import('./chunks').Chunk} Chunk
 */

/** Of a chunk with a word: it does not stand in bits. */
const NO_BIT = -1e9

/** What a search needs of the chunks, as plain numbers. @param {Chunk[]} chunks @param {import('./model').Model} model */
const columnsOf = (chunks, model) => {
  const column = () => new Int32Array(chunks.length)
  const columns = {
    start: column(),
    end: column(),
    /** first bit and the one after the last, where none of the values is a word */
    firstBit: column().fill(NO_BIT),
    lastBit: column(),
    /** addresses and bytes of the answer in a mixed request; 0: it cannot hold them */
    shares: column(),
    answers: column(),
    /** 1: a block may go on from the chunk before it */
    follows: column()
  }
  let last = chunks[0]
  for (let at = 0; at < chunks.length; at++) {
    const chunk = chunks[at]
    columns.start[at] = chunk.start
    columns.end[at] = chunk.end
    if (chunk.bits) {
      columns.firstBit[at] = chunk.bits.first
      columns.lastBit[at] = chunk.bits.last
    }
    if (chunk.share) {
      columns.shares[at] = chunk.share.count
      columns.answers[at] = chunk.share.answer
    }
    if (last.space === chunk.space && model.mayBridge(chunk.space, last.end, chunk.start)) columns.follows[at] = 1
    last = chunk
  }
  return columns
}

/**
 * For each chunk the one after the last that a block can hold which begins there. They end in the order in which they begin; so what a block holds, a
 * block that begins later can hold as well.
 */
const reaches = (chunks, { start, end, follows }, model) => {
  const reach = new Int32Array(chunks.length)
  let at = 0
  for (let first = 0; first < chunks.length; first++) {
    const { space } = chunks[first]
    const most = model.most[space]
    const border = model.borderAfter(space, start[first])
    if (at <= first) at = end[first] - start[first] > most ? first : first + 1
    while (at > first && at < chunks.length && follows[at] === 1) {
      if (end[at] > Math.max(border, end[at - 1]) || end[at] - start[first] > most) break
      at++
    }
    reach[first] = at
  }
  return reach
}

/** What blocks cost, by how many bits or words they have. */
const costsByLength = model => {
  const costsOf = kind =>
    Float64Array.from({ length: model.most[kind] + 1 }, (_, count) => model.blockCost(kind, count))
  return { bit: costsOf('bit'), word: costsOf('word') }
}

/** Costs of the blocks that begin at a chunk: of this one alone, with the next one, and so on. */
const fillCosts = (costs, { from, to, place }, { own, bit, columns }) => {
  const { start, end, firstBit, lastBit } = columns
  const first = start[from]
  for (let at = from; at < to; at++) costs[place + at - from] = own[end[at] - first]
  // the same as bits is shorter where there are few
  for (let at = from; at < to && firstBit[at] !== NO_BIT; at++) {
    const span = lastBit[at] - firstBit[from]
    if (span >= bit.length) break
    if (bit[span] < costs[place + at - from]) costs[place + at - from] = bit[span]
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
  const columns = columnsOf(chunks, model)
  const reach = reaches(chunks, columns, model)
  const first = new Int32Array(count + 1)
  for (let at = 0; at < count; at++) first[at + 1] = first[at] + reach[at] - at
  const costs = new Float64Array(first[count])
  const byLength = costsByLength(model)
  for (let from = 0; from < count; from++) {
    const block = { from, to: reach[from], place: first[from] }
    fillCosts(costs, block, { own: byLength[chunks[from].space], bit: byLength.bit, columns })
  }
  return { count, shares: columns.shares, answers: columns.answers, costs, first }
}

module.exports = { chunkTable }
