'use strict'
const { pointsOf } = require('./points')

const MOST_WEIGHT = 20000
const KEY_WEIGHT = 0.1 // of a character, where a point weighs 1

/**
 * Lists of items that are read again and again: taken apart once, so that their plan is kept, too. Bounded.
 *
 * @typedef {{ items: import('../tag/item').Item[], points: import('./reader').Point[] }} List
 */
class Lists {
  #parse
  /** @type {Map<string, List>} */
  #known = new Map()
  #weight = 0

  /** @param {(items: unknown) => import('../tag/item').Item[]} parse throws what is wrong with them */
  constructor(parse) {
    this.#parse = parse
  }

  /** @param {unknown} items @returns {List} @throws {import('../error').PlcError} as `parse` */
  of(items) {
    const key = keyOf(items)
    const known = this.#known.get(key)
    if (known) return known
    const parsed = this.#parse(items)
    const list = { items: parsed, points: pointsOf(parsed) }
    if (key !== '') this.#keep(key, list)
    return list
  }

  #keep(key, list) {
    const weight = list.points.length + KEY_WEIGHT * key.length
    this.#weight += weight
    if (this.#weight > MOST_WEIGHT) {
      this.#known.clear()
      this.#weight = weight
    }
    this.#known.set(key, list)
  }
}

/** Equal for equal lists; '': it cannot be told. @param {any} items */
const keyOf = items =>
  Array.isArray(items) && items.every(item => typeof item === 'string') ? JSON.stringify(items) : ''

module.exports = { Lists }
