'use strict'

/**
 * What one read request can hold and what it costs: the one place that all planners ask. Pure.
 *
 * @typedef {import('./blocks').Group} Group
 * @typedef {{ kind: 'bit'|'word', start: number, end: number }} Span
 * @typedef {object} Frame a request and the values that it brings
 * @property {'block'|'mixed'} form
 * @property {Span} [span] of a block
 * @property {{ kind: 'bit'|'word', address: number }[]} [addresses] of a mixed request
 * @property {Group[]} groups
 * @property {(group: Group) => boolean} through whether bits are read with their words
 * @property {number} cost byte times
 * @property {number} again byte times where the station repeats it without being asked anew; as `cost`, where it cannot
 */

const FRAME_COST = 60 // two frames' heads and CRC, 10 ms of gap and some of turnaround at 38400 bit/s
const LAST_MIXED = 0x3fff // two of sixteen bits of a mixed address say what it is

const sortedSpans = spans => [...spans].sort((a, b) => a.start - b.start)

/** Index of the first one that is greater. */
const firstAbove = (sorted, value) => {
  let low = 0
  let high = sorted.length
  while (low < high) {
    const middle = (low + high) >> 1
    if (sorted[middle] > value) high = middle
    else low = middle + 1
  }
  return low
}

const SIZE = { bit: 16, word: 1 }

/** @param {'bit'|'word'} kind @param {import('./reads').Limits} limits */
const rulesOf = (kind, { bounds = [], holes = [] }) => ({
  bounds: [...new Set(bounds)].map(bound => bound * SIZE[kind]).sort((a, b) => a - b),
  holes: sortedSpans(holes.filter(hole => hole.kind === kind))
})

/** The words of a bit, where the station has them as one memory. */
const wordsOf = ({ start, end }) => ({ start: start >> 4, end: ((end - 1) >> 4) + 1 })

/** Touching intervals as one. */
const joined = intervals => {
  const all = []
  for (const [from, to] of [...intervals].sort((a, b) => a[0] - b[0])) {
    const last = all.at(-1)
    if (last && from <= last[1]) last[1] = Math.max(last[1], to)
    else all.push([from, to])
  }
  return all
}

const addressesIn = ({ start, end }) => Array.from({ length: end - start }, (_, at) => start + at)

/** The words that a mixed request asks for, also for their bits: from two bits of a word on the word itself is shorter. */
const mixedWords = (groups, isJoint) => {
  const words = new Set()
  const single = new Map()
  for (const group of groups) {
    const span = group.kind === 'word' ? group : wordsOf(group)
    const whole = group.kind === 'word' || (group.end - group.start > 1 && isJoint(span))
    if (whole) for (const word of addressesIn(span)) words.add(word)
    else if (isJoint(span)) single.set(span.start, [...(single.get(span.start) ?? []), group])
  }
  for (const [word, own] of single) if (own.length > 1 || own[0].start > LAST_MIXED) words.add(word)
  return words
}

const none = () => false

/**
 * Addresses of a mixed request, each once. A value stands whole in bits or whole in words.
 * @returns {{ addresses: { kind: 'bit'|'word', address: number }[], through: (group: Group) => boolean }}
 */
const mixedAddresses = (groups, isJoint) => {
  const [{ kind: only, start: first, end: last }] = groups
  if (groups.length === 1 && last - first === 1 && first <= LAST_MIXED)
    return { addresses: [{ kind: only, address: first }], through: none }
  const words = mixedWords(groups, isJoint)
  const through = group => {
    const span = wordsOf(group)
    return group.kind === 'bit' && isJoint(span) && addressesIn(span).every(word => words.has(word))
  }
  const bits = new Set(groups.filter(group => group.kind === 'bit' && !through(group)).flatMap(addressesIn))
  const list = (kind, addresses) => [...addresses].sort((a, b) => a - b).map(address => ({ kind, address }))
  return { addresses: [...list('bit', bits), ...list('word', words)], through }
}

/** INFO of a block's query: address and count. */
const QUERY = 3

class Model {
  #limits
  #rules
  #joint

  /** @param {import('./reads').Limits} limits */
  constructor(limits) {
    const { readBits, readWords, readMixed, info, again, frameCost = FRAME_COST } = limits
    this.#limits = limits
    this.#joint = joined(limits.joint ?? [])
    this.#rules = { bit: rulesOf('bit', limits), word: rulesOf('word', limits) }
    /** addresses in one block */
    this.most = { bit: Math.min(readBits, info), word: Math.min(readWords, info >> 1) }
    /** addresses in one mixed request */
    this.mostMixed = Math.min(readMixed, info >> 1)
    /** whether the station repeats its last request */
    this.repeats = again !== undefined
    this.frameCost = frameCost
    this.repeatCost = again ?? Infinity
    this.queryOfBlock = QUERY
  }

  /** Whether these words and their bits are one memory. @param {{ start: number, end: number }} span */
  isJoint = ({ start, end }) => this.#joint.some(([from, to]) => from <= start && end <= to)

  #sizeOf(kind, count) {
    const { unit = 1, bitBytes = 1, scale = 1 } = this.#limits
    return scale * (kind === 'word' ? count * 2 : Math.ceil(Math.ceil(count / unit) * unit * bitBytes))
  }

  /** What a block costs, both ways. @param {'bit'|'word'} kind @param {number} count */
  blockCost(kind, count) {
    return this.frameCost + QUERY + this.#sizeOf(kind, count)
  }

  /** Whether what lies between two values may be read with them: nobody asked for it. @param {'bit'|'word'} kind */
  mayBridge(kind, from, to) {
    if (from >= to) return true
    if (this.#limits.bridge === false) return false
    return !this.#rules[kind].holes.some(({ start, end }) => start < to && from < end)
  }

  /** The first border after an address: areas need not be one memory. @param {'bit'|'word'} kind @param {number} start */
  borderAfter(kind, start) {
    const { bounds } = this.#rules[kind]
    return bounds[firstAbove(bounds, start)] ?? Infinity
  }

  /** Whether a block goes over a border on which none of its values stands. */
  #crosses(kind, { start, end }, spans) {
    for (let border = this.borderAfter(kind, start); border < end; border = this.borderAfter(kind, border)) {
      if (!spans.some(span => span.start < border && border < span.end)) return true
    }
    return false
  }

  #priced(frame, query, answer) {
    const cost = this.frameCost + query + answer
    return { ...frame, cost, again: Math.min(cost, this.repeatCost + answer) }
  }

  #block(kind, spans, groups) {
    const sorted = sortedSpans(spans)
    const { start } = sorted[0]
    let { end } = sorted[0]
    for (const span of sorted) {
      if (!this.mayBridge(kind, end, span.start)) return null
      end = Math.max(end, span.end)
    }
    if (end - start > this.most[kind] || this.#crosses(kind, { start, end }, spans)) return null
    const through = group => group.kind !== kind
    const frame = { form: 'block', span: { kind, start, end }, groups, through }
    return this.#priced(frame, QUERY, this.#sizeOf(kind, end - start))
  }

  #asWords(groups) {
    const spans = groups.map(group => (group.kind === 'word' ? group : wordsOf(group)))
    const possible = groups.every(({ kind }, at) => kind === 'word' || this.isJoint(spans[at]))
    return possible ? this.#block('word', spans, groups) : null
  }

  #asBits(groups) {
    return groups.every(({ kind }) => kind === 'bit') ? this.#block('bit', groups, groups) : null
  }

  #asMixed(groups) {
    if (this.mostMixed < 2) return null
    const { addresses, through } = mixedAddresses(groups, this.isJoint)
    // the plain functions are the better proven ones: one address never goes alone
    if (addresses.length < 2 || !this.#fits(addresses)) return null
    return this.#priced({ form: 'mixed', addresses, groups, through }, 2 * addresses.length, answerOf(addresses))
  }

  #fits(addresses) {
    return addresses.length <= this.mostMixed && addresses.every(({ address }) => address <= LAST_MIXED)
  }

  /** What values take in a mixed request: addresses and bytes of the answer; null: it cannot hold them. @param {Group[]} groups */
  mixedShare(groups) {
    const { addresses } = mixedAddresses(groups, this.isJoint)
    return this.#fits(addresses) ? { count: addresses.length, answer: answerOf(addresses) } : null
  }

  /** All the ways to read these values with one request. @param {Group[]} groups @returns {Frame[]} */
  frames(groups) {
    return /** @type {any[]} */ ([this.#asBits(groups), this.#asWords(groups), this.#asMixed(groups)].filter(Boolean))
  }
}

/** Bytes of INFO of a mixed answer. */
const answerOf = addresses => addresses.reduce((sum, { kind }) => sum + (kind === 'word' ? 2 : 1), 0)

/** What such frames cost each cycle: the last one of a cycle is the first of the next, where the station repeats it. @param {Frame[]} frames */
const cycleCost = frames => {
  const total = frames.reduce((sum, { cost }) => sum + cost, 0)
  if (frames.length === 1) return frames[0].again
  const saved = frames.map(({ cost, again }) => cost - again).sort((a, b) => b - a)
  return total - ((saved[0] ?? 0) + (saved[1] ?? 0)) / 2
}

module.exports = { LAST_MIXED, Model, cycleCost, wordsOf }
