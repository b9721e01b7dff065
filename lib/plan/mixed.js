'use strict'

/**
 * What a mixed request asks for: bits and words by their addresses, each once. Pure.
 *
 * @typedef {import('./blocks').Group} Group
 * @typedef {{ kind: 'bit'|'word', address: number }} Address
 * @typedef {{ bits: Set<number>, words: Set<number> }} Asked
 */

const LAST_MIXED = 0x3fff // two of sixteen bits of a mixed address say what it is

/** The words of a bit, where the station has them as one memory. */
const wordsOf = ({ start, end }) => ({ start: start >> 4, end: ((end - 1) >> 4) + 1 })

const addAll = (addresses, { start, end }) => {
  for (let address = start; address < end; address++) addresses.add(address)
}

/**
 * A value stands whole in bits or whole in words: from two bits of a word on the word itself is shorter.
 * @param {Group[]} groups
 * @param {(span: { start: number, end: number }) => boolean} isJoint
 * @returns {Asked}
 */
const askedOf = (groups, isJoint) => {
  const words = new Set()
  const bits = new Set()
  const single = []
  const seen = new Set()
  for (const group of groups) {
    const span = group.kind === 'word' ? group : wordsOf(group)
    if (group.kind === 'word') addAll(words, span)
    else if (!isJoint(span)) addAll(bits, group)
    else if (group.end - group.start > 1) addAll(words, span)
    else {
      single.push(group.start)
      if (seen.has(span.start) || group.start > LAST_MIXED) words.add(span.start)
      seen.add(span.start)
    }
  }
  for (const bit of single) if (!words.has(bit >> 4)) bits.add(bit)
  return { bits, words }
}

const canName = addresses => {
  for (const address of addresses) if (address > LAST_MIXED) return false
  return true
}

/** How many addresses, and bytes of INFO of the answer. @param {Asked} asked */
const sizeOf = ({ bits, words }) => ({ count: bits.size + words.size, answer: bits.size + 2 * words.size })

/** Whether one request holds so many. @param {Asked} asked @param {number} most */
const fits = ({ bits, words }, most) => bits.size + words.size <= most && canName(bits) && canName(words)

/** Addresses of one kind, in order, behind those that are there. */
const append = (list, kind, addresses) => {
  for (const address of Float64Array.from(addresses).sort()) list.push({ kind, address })
}

/** @param {Asked} asked @returns {Address[]} */
const addressesOf = ({ bits, words }) => {
  /** @type {Address[]} */
  const list = []
  append(list, 'bit', bits)
  append(list, 'word', words)
  return list
}

const BIT = { count: 1, answer: 1 }
const WORD = { count: 1, answer: 2 }

/**
 * What one address takes, without the sets above: almost all chunks of a large plan are one. A single bit goes as such if it can be named;
 * several of a word, and those with their word, go as the word.
 */
const shareOfOne = ({ space, start, groups }) => {
  const group = groups[0]
  const isSingle = groups.length === 1 && group.kind === 'bit' && group.end - group.start === 1
  if (isSingle && group.start <= LAST_MIXED) return BIT
  return space === 'word' && start <= LAST_MIXED ? WORD : null
}

const areWords = groups => {
  for (const { kind } of groups) if (kind !== 'word') return false
  return true
}

/** Words that touch: all from the first to the last. */
const shareOfWords = ({ start, end }, most) => {
  const count = end - start
  return count <= most && end - 1 <= LAST_MIXED ? { count, answer: 2 * count } : null
}

/**
 * What a chunk takes in a mixed request; null: it cannot hold it.
 * @param {{ space: 'bit'|'word', start: number, end: number, groups: Group[] }} chunk
 * @param {{ most: number, isJoint: (span: { start: number, end: number }) => boolean }} limits
 * @returns {{ count: number, answer: number } | null}
 */
const shareOf = (chunk, { most, isJoint }) => {
  if (chunk.end - chunk.start === 1) return most > 0 ? shareOfOne(chunk) : null
  if (areWords(chunk.groups)) return shareOfWords(chunk, most)
  const asked = askedOf(chunk.groups, isJoint)
  return fits(asked, most) ? sizeOf(asked) : null
}

module.exports = { LAST_MIXED, addressesOf, askedOf, fits, shareOf, sizeOf, wordsOf }
