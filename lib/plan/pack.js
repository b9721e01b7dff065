'use strict'

/**
 * Chunks -> mixed requests that are as full as possible. Pure.
 *
 * @typedef {{ shares: Int32Array, answers: Int32Array }} Shares addresses and bytes of the answer of each chunk
 * @typedef {{ used: number, answer: number, chunks: number[] }} Bin a request: its addresses, the bytes of its answer
 */

/** @param {number[]} chunks @param {Shares} table */
const roomOf = (chunks, { shares }) => {
  let room = 0
  for (const at of chunks) room += shares[at]
  return room
}

/**
 * First fit, largest first: values of one and two words fill requests without a gap.
 * @param {number[]} mixed
 * @param {Shares} table
 * @param {number} most addresses in one request
 * @returns {Bin[]}
 */
const pack = (mixed, { shares, answers }, most) => {
  const plain = mixed.every(at => shares[at] === 1)
  /** @type {Bin[]} */
  const bins = []
  let open = 0
  for (const at of plain ? mixed : [...mixed].sort((a, b) => shares[b] - shares[a])) {
    let index = open
    while (index < bins.length && bins[index].used + shares[at] > most) index++
    if (index === bins.length) bins.push({ used: 0, answer: 0, chunks: [] })
    const bin = bins[index]
    bin.used += shares[at]
    bin.answer += answers[at]
    bin.chunks.push(at)
    while (open < bins.length && bins[open].used === most) open++
  }
  return bins
}

module.exports = { pack, roomOf }
