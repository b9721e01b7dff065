'use strict'

/**
 * Addresses that a station does not have, as far as it has said so: those that somebody asked for, and those that a block read over.
 *
 * @typedef {{ kind: 'bit'|'word', start: number, end: number }} Hole
 */

const MOST = 1000

const UNIT = { readWords: 'word', readBits: 'bit' }

/** Where a point of a block begins and ends, in the block's own unit. */
const spanOf = ({ kind, address, count }, unit) => {
  if (kind === unit) return { start: address, end: address + count }
  return { start: address >> 4, end: ((address + count - 1) >> 4) + 1 }
}

class Holes {
  /** @type {Map<string, Hole>} */
  #known = new Map()

  /** Those that nobody asked for. @returns {Hole[]} */
  get list() {
    return [...this.#known.values()]
  }

  /**
   * Both halves of a block were read, the whole was not: what lies between them is missing.
   * @param {any} request the block
   * @param {any[]} before points of the first half @param {any[]} after those of the second
   */
  learn({ ask }, before, after) {
    const kind = UNIT[ask]
    if (!kind) return
    const start = Math.max(...before.map(point => spanOf(point, kind).end))
    const end = Math.min(...after.map(point => spanOf(point, kind).start))
    if (start >= end) return
    if (this.#known.size >= MOST) this.#known.clear()
    this.#known.set(`${kind} ${start} ${end}`, { kind, start, end })
  }
}

module.exports = { Holes }
