'use strict'
const { wordsOf } = require('./model')

/**
 * Values that overlap, as one: what a plan of many values moves about. Pure.
 *
 * @typedef {import('./blocks').Group} Group
 * @typedef {object} Chunk
 * @property {'bit'|'word'} space
 * @property {number} start
 * @property {number} end
 * @property {Group[]} groups
 * @property {{ first: number, last: number } | null} bits their bits, where none of them is a word
 * @property {{ count: number, answer: number } | null} share what it takes in a mixed request
 */

/** Where a value stands: bits of words that are the same memory stand among the words. */
const placed = (group, model) => {
  const span = group.kind === 'word' ? group : wordsOf(group)
  const among = group.kind === 'word' || model.isJoint(span)
  const { start, end } = among ? span : group
  return { space: among ? 'word' : 'bit', start, end, group }
}

const bitsOf = groups =>
  groups.every(({ kind }) => kind === 'bit')
    ? { first: Math.min(...groups.map(({ start }) => start)), last: Math.max(...groups.map(({ end }) => end)) }
    : null

const WORK = 5e5 // blocks that a search may have to look at

/**
 * Neighbours that touch are one chunk up to this length, where there are too many to look at every way to cut them.
 * @param {{ start: number, end: number }[]} places in order
 * @param {number} most addresses in one block
 */
const grainOf = (places, most) => {
  const span = places[places.length - 1].end - places[0].start
  const reach = Math.min(places.length, (most * places.length) / span)
  return Math.min(most, Math.ceil(Math.sqrt((places.length * reach) / WORK)))
}

/**
 * @param {Group[]} groups
 * @param {import('./model').Model} model
 * @param {'bit'|'word'} space
 * @returns {Chunk[]} in order of address
 */
const chunksOf = (groups, model, space) => {
  const places = groups.map(group => placed(group, model)).filter(place => place.space === space)
  if (places.length === 0) return []
  places.sort((a, b) => a.start - b.start || a.end - b.end)
  const grain = grainOf(places, model.most[space])
  const merged = []
  for (const { start, end, group } of places) {
    const last = merged.at(-1)
    // a run of values that overlap may be longer than a request: then some of it is read twice
    const most = last && start < last.end ? model.most[space] : grain
    if (last && start <= last.end && Math.max(end, last.end) - last.start <= most) {
      last.end = Math.max(last.end, end)
      last.groups.push(group)
    } else merged.push({ space, start, end, groups: [group] })
  }
  return merged.map(chunk => ({ ...chunk, bits: bitsOf(chunk.groups), share: model.mixedShare(chunk.groups) }))
}

module.exports = { chunksOf }
