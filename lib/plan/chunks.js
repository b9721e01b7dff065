'use strict'
const { wordsOf } = require('./mixed')

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

/** @typedef {Group | { start: number, end: number, group: Group }} Place where a value stands: the value itself, or a bit among the words */

/**
 * Where values stand, in order of address: bits of words that are the same memory stand among the words.
 * @param {Group[]} groups in order, one kind after the other
 * @param {import('./model').Model} model
 */
const placesOf = (groups, model) => {
  /** @type {Record<'word'|'bit', Place[]>} */
  const places = { word: [], bit: [] }
  let among = 0
  for (const group of groups) {
    const span = group.kind === 'word' ? null : wordsOf(group)
    if (!span || !model.isJoint(span)) places[group.kind].push(group)
    else among = places.word.push({ start: span.start, end: span.end, group })
  }
  if (among > 0) places.word.sort((a, b) => a.start - b.start || a.end - b.end)
  return places
}

/** First and last bit of values, where none is a word. */
const bitsOf = groups => {
  let first = Infinity
  let last = -Infinity
  for (const { kind, start, end } of groups) {
    if (kind === 'word') return null
    first = Math.min(first, start)
    last = Math.max(last, end)
  }
  return { first, last }
}

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

const chunksIn = (space, places, model) => {
  if (places.length === 0) return []
  const longest = model.most[space]
  const grain = grainOf(places, longest)
  /** @type {Chunk[]} */
  const chunks = []
  /** @type {any} */
  let last = null
  /** So long may a chunk become by a value that begins there: 0 at the end of an area, which no block crosses. */
  const mostAt = start => {
    // a run of values that overlap may be longer than a request: then some of it is read twice
    if (start < last.end) return longest
    return model.borderAfter(space, start - 1) === start ? 0 : grain
  }
  for (const place of places) {
    const { start, end } = place
    const group = 'group' in place ? place.group : place
    if (last && start <= last.end && Math.max(end, last.end) - last.start <= mostAt(start)) {
      last.end = Math.max(last.end, end)
      last.groups.push(group)
    } else chunks.push((last = { space, start, end, groups: [group], bits: null, share: null }))
  }
  for (const chunk of chunks) {
    chunk.bits = bitsOf(chunk.groups)
    chunk.share = model.mixedShare(chunk)
  }
  return chunks
}

/**
 * @param {Group[]} groups
 * @param {import('./model').Model} model
 * @returns {Chunk[]} in order of address, those of words first
 */
const chunksOf = (groups, model) => {
  const { word, bit } = placesOf(groups, model)
  return [...chunksIn('word', word, model), ...chunksIn('bit', bit, model)]
}

module.exports = { chunksOf }
