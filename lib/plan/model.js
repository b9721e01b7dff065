'use strict'
const { addressesOf, askedOf, fits, shareOf, sizeOf, wordsOf } = require('./mixed')

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

/** Where a value stands in a block of bits or words. */
const spanIn = (kind, group) => (group.kind === kind ? group : wordsOf(group))

/** From the first to the last address of values in a block. */
const extentOf = (kind, groups) => {
  let start = Infinity
  let end = -Infinity
  for (const group of groups) {
    const span = spanIn(kind, group)
    start = Math.min(start, span.start)
    end = Math.max(end, span.end)
  }
  return { kind, start, end }
}

/** INFO of a block's query: address and count. */
const QUERY = 3

class Model {
  #limits
  #rules
  #joint
  #sharing

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
    this.#sharing = { most: this.mostMixed, isJoint: this.isJoint }
    /** whether the station repeats its last request */
    this.repeats = again !== undefined
    this.frameCost = frameCost
    this.repeatCost = again ?? Infinity
    this.queryOfBlock = QUERY
  }

  /** Whether these words and their bits are one memory. @param {{ start: number, end: number }} span */
  isJoint = ({ start, end }) => {
    for (const span of this.#joint) if (span[0] <= start && end <= span[1]) return true
    return false
  }

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
    for (const { start, end } of this.#rules[kind].holes) if (start < to && from < end) return false
    return true
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

  /** What a frame costs at first and repeated. @param {number} query bytes of INFO @param {number} answer the same */
  #prices(query, answer) {
    const cost = this.frameCost + query + answer
    return { cost, again: Math.min(cost, this.repeatCost + answer) }
  }

  /** What a block costs at first and repeated. @param {{ kind: 'bit'|'word', start: number, end: number }} block */
  pricesOfBlock({ kind, start, end }) {
    return this.#prices(QUERY, this.#sizeOf(kind, end - start))
  }

  /** Whether all that lies between these values may be read with them. @param {{ start: number, end: number }[]} spans in order */
  #bridges(kind, spans) {
    let { end } = spans[0]
    for (const span of spans) {
      if (!this.mayBridge(kind, end, span.start)) return false
      end = Math.max(end, span.end)
    }
    return true
  }

  #block(kind, groups) {
    const span = extentOf(kind, groups)
    if (span.end - span.start > this.most[kind]) return null
    const spans = sortedSpans(groups.map(group => spanIn(kind, group)))
    if (!this.#bridges(kind, spans) || this.#crosses(kind, span, spans)) return null
    const through = group => group.kind !== kind
    return { form: 'block', span, groups, through, ...this.pricesOfBlock(span) }
  }

  #asWords(groups) {
    const possible = groups.every(group => group.kind === 'word' || this.isJoint(wordsOf(group)))
    return possible ? this.#block('word', groups) : null
  }

  #asBits(groups) {
    return groups.every(({ kind }) => kind === 'bit') ? this.#block('bit', groups) : null
  }

  #asMixed(groups) {
    if (this.mostMixed < 2) return null
    const asked = askedOf(groups, this.isJoint)
    const { count, answer } = sizeOf(asked)
    // the plain functions are the better proven ones: one address never goes alone
    if (count < 2 || !fits(asked, this.mostMixed)) return null
    // a number of several bits stands in words wherever these are the same memory
    const through = group =>
      group.kind === 'bit' &&
      (group.end - group.start > 1 || asked.words.has(group.start >> 4)) &&
      this.isJoint(wordsOf(group))
    return { form: 'mixed', addresses: addressesOf(asked), groups, through, ...this.#prices(2 * count, answer) }
  }

  /** What values take in a mixed request: addresses and bytes of the answer; null: it cannot hold them. @param {any} chunk */
  mixedShare(chunk) {
    return shareOf(chunk, this.#sharing)
  }

  /** All the ways to read these values with one request. @param {Group[]} groups @returns {Frame[]} */
  frames(groups) {
    return /** @type {any[]} */ ([this.#asBits(groups), this.#asWords(groups), this.#asMixed(groups)].filter(Boolean))
  }
}

/**
 * What such frames cost each cycle: the last one of a cycle is the first of the next, where the station repeats it.
 * @param {{ cost: number, again: number }[]} frames
 */
const cycleCost = frames => {
  if (frames.length === 1) return frames[0].again
  let total = 0
  // the two that gain most by repetition stand at the ends
  let most = 0
  let second = 0
  for (const { cost, again } of frames) {
    const saved = cost - again
    total += cost
    if (saved > most) [most, second] = [saved, most]
    else if (saved > second) second = saved
  }
  return total - (most + second) / 2
}

module.exports = { Model, cycleCost }
