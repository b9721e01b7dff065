'use strict'

/**
 * A cost below which no plan of many single addresses can be: where each address of a mixed request pays its part of the room, requests no longer
 * depend on each other, and the cheapest choice is a shortest path; no plan is cheaper than that, whatever the part (Lagrange). Written from the
 * rules of the protocol, not from the planner.
 */

/** Addresses of one memory in order: what each needs there. */
const cellsOf = (points, joint) => {
  const words = new Map()
  const bits = []
  for (const { kind, address } of points) {
    if (kind === 'bit' && !joint) {
      bits.push({ start: address, end: address + 1, bits: 1 })
      continue
    }
    const word = kind === 'word' ? address : address >> 4
    const cell = words.get(word) ?? { start: word, end: word + 1, word: false, own: new Set() }
    if (kind === 'word') cell.word = true
    else cell.own.add(address)
    words.set(word, cell)
  }
  const list = [...words.values()].map(cell => ({ ...cell, bits: cell.own.size }))
  return { words: list.sort((a, b) => a.start - b.start), bits: bits.sort((a, b) => a.start - b.start) }
}

const shareOf = ({ word, bits, own }) => {
  if (!own) return { count: 1, bytes: 3 }
  if (word || bits > 1) return { count: 1, bytes: 4 }
  return { count: 1, bytes: 3 }
}

/** The cheapest way through the cells, when an address in a mixed request costs `price` beside its bytes. */
const path = (cells, { most, size, frameCost, price, readBits }) => {
  const best = [0]
  cells.forEach((cell, at) => {
    const { bytes, count } = shareOf(cell)
    let least = best[at] + bytes + price * count
    let onlyBits = true
    let first = Infinity
    let last = -Infinity
    for (let from = at; from >= 0 && cell.end - cells[from].start <= most; from--) {
      const { start, word, own } = cells[from]
      onlyBits = onlyBits && !word
      if (own) for (const bit of own) [first, last] = [Math.min(first, bit), Math.max(last, bit + 1)]
      let bytesOfBlock = size * (cell.end - start)
      if (onlyBits && own && last - first <= readBits) bytesOfBlock = Math.min(bytesOfBlock, last - first)
      least = Math.min(least, best[from] + frameCost + 3 + bytesOfBlock)
    }
    best.push(least)
  })
  return best[cells.length]
}

const PRICES = [0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8, 1, 1.3, 1.7, 2.2, 3, 4, 6, 9, 14, 30, 70]

/**
 * @param {{ kind: 'bit'|'word', address: number }[]} points distinct, single
 * @param {any} limits
 * @returns {number} byte times of a cycle
 */
const lowerBound = (points, limits) => {
  const { readBits, readWords, readMixed, frameCost, again, joint = [] } = limits
  const { words, bits } = cellsOf(points, joint.length > 0)
  const relaxed = price =>
    path(words, { most: readWords, size: 2, frameCost, price, readBits }) +
    path(bits, { most: readBits, size: 1, frameCost, price, readBits })
  const paths = shift => PRICES.map(price => relaxed(price + shift))
  const plain = paths(0)
  const short = again === undefined ? [] : paths(-1)
  /** With so many mixed requests: each pays for itself, and gives its room for nothing. */
  const withRequests = (relaxedPaths, count) =>
    count * frameCost + Math.max(...relaxedPaths.map((cost, at) => cost - PRICES[at] * count * readMixed))
  const boundFor = count => {
    const whole = withRequests(plain, count)
    if (again === undefined) return whole
    // two requests are repeated every other time. Those of them that are mixed save a byte for each of their addresses
    const bounds = [0, 1, 2].slice(0, count + 1).map(mixed => {
      const saved = frameCost - again + 1.5 * (2 - mixed)
      return (mixed === 0 ? whole : Math.max(withRequests(short, count), whole - mixed * readMixed)) - saved
    })
    return Math.min(...bounds)
  }
  const counts = Array.from({ length: Math.ceil(points.length / readMixed) + 1 }, (_, count) => boundFor(count))
  return Math.min(...counts)
}

module.exports = { lowerBound }
