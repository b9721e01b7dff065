'use strict'
const { chunksOf } = require('./chunks')
const { cycleCost } = require('./model')
const { pack, roomOf } = require('./pack')
const { NO_BIT, chunkTable, costOf } = require('./table')

/**
 * A plan of many values. Where an address of a mixed request has a price, blocks and mixed requests no longer depend on each other, and the
 * best choice is a shortest path over the addresses. Mixed requests hold only so many: so prices are tried until the plan is cheapest. Pure.
 *
 * @typedef {import('./model').Frame} Frame
 * @typedef {import('./blocks').Group} Group
 * @typedef {import('./pack').Bin} Bin
 * @typedef {import('./table').Table} Table
 * @typedef {{ from: number, to: number, cost: number }} Block chunks by their places in the table
 * @typedef {{ mixed: number[], blocks: Block[] }} Choice
 */

// below zero: where a request is repeated by its short form, addresses in it cost nothing on the way out
const PRICES = [-2, -1.5, -1, -0.5, 0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.7, 1, 1.5, 2, 3, 5, 8, 12, Infinity]
const STEPS = 8 // of the search for the price that fills whole requests
const WORK = 2e6 // steps of all searches together: a bound of the time

const MIXED = -1

/**
 * Where the last request of the cheapest choice up to each chunk begins; MIXED: the chunk goes into a mixed one.
 * @param {Table} table
 * @param {number} price
 * @param {{ best: Float64Array, from: Int32Array }} notes for each chunk, and one more
 */
const choose = (table, price, { best, from }) => {
  const { count, words, shares, answers, start, end, reach, firstBit } = table
  best.fill(Infinity)
  best[0] = 0
  for (let at = 0; at < count; at++) {
    const here = best[at]
    const mixed = shares[at] > 0 ? here + answers[at] + shares[at] * (2 + price) : Infinity
    if (mixed < best[at + 1]) {
      best[at + 1] = mixed
      from[at + 1] = MIXED
    }
    const own = at < words ? table.word : table.bit
    const first = start[at]
    const last = reach[at]
    for (let to = at + 1; to <= last; to++) {
      const cost = here + own[end[to - 1] - first]
      // of equal ones the block that begins last: those before it are full
      if (cost <= best[to]) {
        best[to] = cost
        from[to] = at
      }
    }
    if (at < words && firstBit[at] !== NO_BIT) chooseBits(table, at, { best, from })
  }
  return from
}

/** Blocks of bits that stand among words: shorter where there are few. */
const chooseBits = ({ reach, firstBit, lastBit, bit }, at, { best, from }) => {
  const here = best[at]
  const first = firstBit[at]
  const last = reach[at]
  for (let to = at + 1; to <= last && firstBit[to - 1] !== NO_BIT; to++) {
    const span = lastBit[to - 1] - first
    if (span >= bit.length) return
    const cost = here + bit[span]
    if (cost <= best[to]) {
      best[to] = cost
      from[to] = at
    }
  }
}

/** @returns {Choice} */
const trace = (table, from) => {
  const mixed = []
  const blocks = []
  for (let to = table.count; to > 0;) {
    const start = from[to] === MIXED ? to - 1 : from[to]
    if (from[to] === MIXED) mixed.push(start)
    else blocks.push({ from: start, to, cost: costOf(table, start, to) })
    to = start
  }
  return { mixed, blocks }
}

/** What a block would gain in mixed requests, and how many addresses it has there. */
const gainOf = (block, { shares, answers }) => {
  let count = 0
  let gain = block.cost
  for (let at = block.from; at < block.to && gain > 0; at++) {
    count += shares[at]
    gain = shares[at] === 0 ? 0 : gain - answers[at] - 2 * shares[at]
  }
  return { block, count, gain }
}

const range = (from, to) => Array.from({ length: to - from }, (_, at) => from + at)

/** What room is left in the mixed requests takes the blocks that gain most. @returns {Choice & { bins: Bin[] }} */
const fill = ({ mixed, blocks }, table, most) => {
  const bins = pack(mixed, table, most)
  let room = bins.length * most - roomOf(mixed, table)
  if (room === 0) return { mixed, blocks, bins }
  const gaining = blocks.map(block => gainOf(block, table)).filter(({ gain, count }) => gain > 0 && count <= room)
  const moved = new Set()
  for (const { block, count } of gaining.sort((a, b) => b.gain / b.count - a.gain / a.count)) {
    if (count > room) continue
    room -= count
    moved.add(block)
  }
  if (moved.size === 0) return { mixed, blocks, bins }
  const all = [...mixed, ...[...moved].flatMap(({ from, to }) => range(from, to))]
  return { mixed: all, blocks: blocks.filter(block => !moved.has(block)), bins: pack(all, table, most) }
}

/** What blocks and mixed requests cost, without making them. */
const pricesOf = ({ blocks, bins }, { frameCost, repeatCost, queryOfBlock }) => {
  const prices = blocks.map(({ cost }) => ({
    cost,
    again: Math.min(cost, cost - frameCost - queryOfBlock + repeatCost)
  }))
  for (const { used, answer } of bins) {
    const cost = frameCost + 2 * used + answer
    prices.push({ cost, again: Math.min(cost, repeatCost + answer) })
  }
  return prices
}

/** Tries prices; remembers the cheapest plan. */
const createSearch = (table, model) => {
  /** @type {{ blocks: Block[], bins: Bin[], cost: number, room: number }} */
  const best = { blocks: [], bins: [], cost: Infinity, room: 0 }
  const notes = { best: new Float64Array(table.count + 1), from: new Int32Array(table.count + 1) }
  return {
    best,
    /** @returns {number} addresses that go into mixed requests at this price */
    attempt: price => {
      const from = choose(table, price, notes)
      // a value that no block can hold has no way at an infinite price
      if (notes.best[table.count] === Infinity) return 0
      const chosen = trace(table, from)
      const room = roomOf(chosen.mixed, table)
      const { blocks, bins } = fill(chosen, table, model.mostMixed)
      const cost = cycleCost(pricesOf({ blocks, bins }, model))
      if (cost < best.cost) Object.assign(best, { blocks, bins, cost, room })
      return room
    }
  }
}

/** The price at which mixed requests are just full. */
const bisect = (search, target) => {
  let low = PRICES[0]
  let high = 16
  for (let step = 0; step < STEPS; step++) {
    const price = (low + high) / 2
    if (search.attempt(price) > target) low = price
    else high = price
  }
}

const explore = (search, { steps, mostMixed }) => {
  if (mostMixed < 2) return search.attempt(Infinity)
  const tries = Math.max(4, Math.min(PRICES.length, Math.floor(WORK / steps)))
  const stride = (PRICES.length - 1) / (tries - 1)
  for (let at = 0; at < tries; at++) search.attempt(PRICES[Math.round(at * stride)])
  const full = Math.round(search.best.room / mostMixed)
  const around = [full, full - 1, full + 1].slice(0, Math.max(0, Math.floor((WORK / steps - tries) / STEPS)))
  for (const requests of around) if (requests > 0) bisect(search, requests * mostMixed)
}

const cheapest = (frames, key) => frames.reduce((best, frame) => (frame[key] < best[key] ? frame : best))

const groupsIn = chunks => {
  const all = []
  for (const { groups } of chunks) for (const group of groups) all.push(group)
  return all
}

/** All requests that can hold a set of chunks, for each set; one that none can hold after all is read chunk by chunk. @returns {Frame[][]} */
const formsOf = (sets, model) =>
  sets.flatMap(chunks => {
    const forms = model.frames(groupsIn(chunks))
    return forms.length > 0 ? [forms] : chunks.map(({ groups }) => model.frames(groups))
  })

/**
 * @param {Group[]} groups
 * @param {import('./model').Model} model
 * @returns {Frame[]}
 */
const pricedPlan = (groups, model) => {
  const chunks = chunksOf(groups, model)
  const table = chunkTable(chunks, model)
  const search = createSearch(table, model)
  explore(search, { steps: table.blocks + table.count, mostMixed: model.mostMixed })
  const { blocks, bins } = search.best
  const sets = [
    ...blocks.map(({ from, to }) => chunks.slice(from, to)),
    ...bins.map(bin => bin.chunks.map(at => chunks[at]))
  ]
  const forms = formsOf(sets, model)
  const plans = (model.repeats ? ['cost', 'again'] : ['cost']).map(key => forms.map(each => cheapest(each, key)))
  return plans.reduce((best, plan) => (cycleCost(plan) < cycleCost(best) ? plan : best))
}

module.exports = { pricedPlan }
