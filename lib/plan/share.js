'use strict'

/**
 * Which blocks have a request of their own, and which share mixed ones. Pure.
 *
 * @typedef {import('./blocks').Block} Block
 * @typedef {object} Mixed what a mixed frame takes
 * @property {number} items addresses in one frame
 * @property {number} bytes of INFO in one frame
 * @property {{ bit: number, word: number }} last highest absolute address
 * @property {(block: { kind: string, start: number, end: number }) => number} size bytes of INFO that a block takes there
 */

const itemsOf = block => block.end - block.start

const fits = (block, mixed) => block.end - 1 <= mixed.last[block.kind]

/**
 * How many of the smallest blocks share frames so that the whole costs least. A block of its own costs a frame; in a
 * mixed one it costs its addresses: so only small ones can gain, and the smallest gain most.
 */
const bestCount = (candidates, { mixed, frameCost, ownCost, sharedCost }) => {
  let own = candidates.reduce((sum, block) => sum + frameCost + ownCost(block), 0)
  let items = 0
  let bytes = 0
  let shared = 0
  let best = { count: 0, cost: own }
  candidates.forEach((block, index) => {
    own -= frameCost + ownCost(block)
    items += itemsOf(block)
    bytes += mixed.size(block)
    shared += sharedCost(block)
    const frames = Math.max(Math.ceil(items / mixed.items), Math.ceil(bytes / mixed.bytes))
    const cost = own + shared + frames * frameCost
    if (cost < best.cost) best = { count: index + 1, cost }
  })
  return best.count
}

/**
 * First fit, largest first: values of one and two words fill frames without a gap.
 * @param {Block[]} parts
 * @param {Mixed} mixed
 * @returns {Block[][]}
 */
const pack = (parts, mixed) => {
  /** @type {{ items: number, bytes: number, parts: Block[] }[]} */
  const frames = []
  let firstOpen = 0
  for (const part of [...parts].sort((a, b) => itemsOf(b) - itemsOf(a) || a.start - b.start)) {
    const items = itemsOf(part)
    const bytes = mixed.size(part)
    /** @type {typeof frames[number] | null} */
    let frame = null
    for (let at = firstOpen; at < frames.length && !frame; at++) {
      const { items: used, bytes: full } = frames[at]
      if (used + items <= mixed.items && full + bytes <= mixed.bytes) frame = frames[at]
    }
    if (!frame) frames.push((frame = { items: 0, bytes: 0, parts: [] }))
    frame.items += items
    frame.bytes += bytes
    frame.parts.push(part)
    while (firstOpen < frames.length && frames[firstOpen].items === mixed.items) firstOpen++
  }
  return frames.map(frame => frame.parts.sort((a, b) => a.kind.localeCompare(b.kind) || a.start - b.start))
}

/**
 * @param {Block[]} blocks
 * @param {object} costs
 * @param {Mixed} costs.mixed
 * @param {number} costs.frameCost what one more request costs beside its INFO, in byte times
 * @param {(block: Block) => number} costs.ownCost bytes of INFO, both ways, as a request of its own
 * @param {(block: Block) => number} costs.sharedCost bytes of INFO, both ways, in a mixed request
 * @param {(block: Block) => Block[]} costs.partsOf what may be packed apart
 * @returns {{ own: Block[], shared: Block[][] }}
 */
const share = (blocks, { mixed, frameCost, ownCost, sharedCost, partsOf }) => {
  const small = block => fits(block, mixed) && partsOf(block).every(part => partFits(part, mixed))
  const candidates = blocks.filter(small).sort((a, b) => mixed.size(a) - mixed.size(b) || a.start - b.start)
  const count = bestCount(candidates, { mixed, frameCost, ownCost, sharedCost })
  const chosen = new Set(candidates.slice(0, count))
  const frames = pack([...chosen].flatMap(partsOf), mixed)
  // the plain functions are the better proven ones
  const alone = frames.filter(parts => parts.length === 1).flat()
  return {
    own: [...blocks.filter(block => !chosen.has(block)), ...alone],
    shared: frames.filter(parts => parts.length > 1)
  }
}

const partFits = (part, mixed) => itemsOf(part) <= mixed.items && mixed.size(part) <= mixed.bytes

module.exports = { share }
