'use strict'

/**
 * Chunks as plain numbers, how far a block can reach from each of them, and what it costs: what a search asks thousands of times. Pure.
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
const costsByLength = (model, kind) => {
  const costs = new Float64Array(model.most[kind] + 1)
  for (let count = 0; count < costs.length; count++) costs[count] = model.blockCost(kind, count)
  return costs
}

const isWord = ({ space }) => space === 'word'

/** @typedef {ReturnType<typeof chunkTable>} Table */

/**
 * @param {Chunk[]} chunks in order of address, those of words first
 * @param {import('./model').Model} model
 */
const chunkTable = (chunks, model) => {
  const columns = columnsOf(chunks, model)
  const reach = reaches(chunks, columns, model)
  return {
    ...columns,
    count: chunks.length,
    /** so many of them stand among words */
    words: chunks.filter(isWord).length,
    /** the chunk after the last that a block can hold which begins there */
    reach,
    /** all blocks that there can be */
    blocks: reach.reduce((sum, end, at) => sum + end - at, 0),
    word: costsByLength(model, 'word'),
    bit: costsByLength(model, 'bit')
  }
}

/** What a block costs. @param {Table} table @param {number} from its first chunk @param {number} to the one after its last */
const costOf = ({ words, start, end, firstBit, lastBit, word, bit }, from, to) => {
  const own = from < words ? word : bit
  const cost = own[end[to - 1] - start[from]]
  for (let at = from; at < to; at++) if (firstBit[at] === NO_BIT) return cost
  // the same as bits is shorter where there are few
  return Math.min(cost, bit[lastBit[to - 1] - firstBit[from]] ?? Infinity)
}

module.exports = { NO_BIT, chunkTable, costOf }
