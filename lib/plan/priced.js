'use strict'
const { chunksOf } = require('./chunks')
const { cycleCost } = require('./model')
const { chunkTable } = require('./table')

/**
 * A plan of many values. Where an address of a mixed request has a price, blocks and mixed requests no longer depend on each other, and the
 * best choice is a shortest path over the addresses. Mixed requests hold only so many: so prices are tried until the plan is cheapest. Pure.
 *
 * @typedef {import('./model').Frame} Frame
 * @typedef {import('./blocks').Group} Group
 * @typedef {{ from: number, to: number, cost: number }} Block chunks by their places in the table
 */

// below zero: where a request is repeated by its short form, addresses in it cost nothing on the way out
const PRICES = [-2, -1.5, -1, -0.5, 0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.7, 1, 1.5, 2, 3, 5, 8, 12, Infinity]
const STEPS = 8 // of the search for the price that fills whole requests
const WORK = 2e6 // steps of all searches together: a bound of the time

const MIXED = -1

/** Where the last request of the cheapest choice up to each chunk begins; MIXED: the chunk goes into a mixed one. */
const choose = ({ count, shares, answers, costs, first }, price) => {
  const best = new Float64Array(count + 1).fill(Infinity)
  const from = new Int32Array(count + 1)
  best[0] = 0
  for (let at = 0; at < count; at++) {
    const here = best[at]
    const mixed = shares[at] > 0 ? here + answers[at] + shares[at] * (2 + price) : Infinity
    if (mixed < best[at + 1]) {
      best[at + 1] = mixed
      from[at + 1] = MIXED
    }
    const last = first[at + 1]
    for (let place = first[at], next = at + 1; place < last; place++, next++) {
      const cost = here + costs[place]
      // of equal ones the block that begins last: those before it are full
      if (cost <= best[next]) {
        best[next] = cost
        from[next] = at
      }
    }
  }
  return from
}

/** @returns {{ mixed: number[], blocks: Block[] }} */
const trace = ({ count, costs, first }, from) => {
  const mixed = []
  const blocks = []
  for (let to = count; to > 0;) {
    const start = from[to] === MIXED ? to - 1 : from[to]
    if (from[to] === MIXED) mixed.push(start)
    else blocks.push({ from: start, to, cost: costs[first[start] + to - start - 1] })
    to = start
  }
  return { mixed, blocks }
}

const roomOf = (mixed, { shares }) => mixed.reduce((total, at) => total + shares[at], 0)

/** First fit, largest first: values of one and two words fill requests without a gap. @returns {number[][]} */
const pack = (mixed, { shares }, most) => {
  const plain = mixed.every(at => shares[at] === 1)
  /** @type {{ used: number, chunks: number[] }[]} */
  const bins = []
  let open = 0
  for (const at of plain ? mixed : [...mixed].sort((a, b) => shares[b] - shares[a])) {
    let bin
    for (let index = open; index < bins.length && !bin; index++) {
      if (bins[index].used + shares[at] <= most) bin = bins[index]
    }
    if (!bin) bins.push((bin = { used: 0, chunks: [] }))
    bin.used += shares[at]
    bin.chunks.push(at)
    while (open < bins.length && bins[open].used === most) open++
  }
  return bins.map(({ chunks }) => chunks)
}

const range = (from, to) => Array.from({ length: to - from }, (_, at) => from + at)

/** What room is left in the mixed requests takes the blocks that gain most. */
const fill = ({ mixed, blocks }, table, most) => {
  let room = pack(mixed, table, most).length * most - roomOf(mixed, table)
  if (room === 0) return { mixed, blocks }
  const { shares, answers } = table
  const gaining = []
  for (const block of blocks) {
    let count = 0
    let gain = block.cost
    for (let at = block.from; at < block.to && gain > 0; at++) {
      count += shares[at]
      gain = shares[at] === 0 ? 0 : gain - answers[at] - 2 * shares[at]
    }
    if (gain > 0 && count <= room) gaining.push({ block, gain, count })
  }
  const moved = new Set()
  for (const { block, count } of gaining.sort((a, b) => b.gain / b.count - a.gain / a.count)) {
    if (count > room) continue
    room -= count
    moved.add(block)
  }
  const more = [...moved].flatMap(({ from, to }) => range(from, to))
  return { mixed: [...mixed, ...more], blocks: blocks.filter(block => !moved.has(block)) }
}

/** Sets of chunks with what they cost as requests, without making these. */
const priced = (chosen, table, model) => {
  const { mixed, blocks } = fill(chosen, table, model.mostMixed)
  const { frameCost, repeatCost, queryOfBlock } = model
  const sets = blocks.map(({ from, to, cost }) => {
    const again = Math.min(cost, cost - frameCost - queryOfBlock + repeatCost)
    return { chunks: range(from, to), cost, again }
  })
  for (const chunks of pack(mixed, table, model.mostMixed)) {
    const answer = chunks.reduce((total, at) => total + table.answers[at], 0)
    const cost = frameCost + 2 * roomOf(chunks, table) + answer
    sets.push({ chunks, cost, again: Math.min(cost, repeatCost + answer) })
  }
  return sets
}

/** Tries prices; remembers the cheapest plan. */
const createSearch = (table, model) => {
  /** @type {{ sets: { chunks: number[] }[], cost: number, room: number }} */
  const best = { sets: [], cost: Infinity, room: 0 }
  return {
    best,
    /** @returns {number} addresses that go into mixed requests at this price */
    attempt: price => {
      const chosen = trace(table, choose(table, price))
      const room = roomOf(chosen.mixed, table)
      const sets = priced(chosen, table, model)
      const cost = cycleCost(sets)
      if (cost < best.cost) Object.assign(best, { sets, cost, room })
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

/** Requests of sets of chunks; a set that no request can hold after all is read chunk by chunk. @returns {Frame[]} */
const framesOf = (sets, model, key) =>
  sets.flatMap(groups => {
    const frames = model.frames(groups.flat())
    if (frames.length > 0) return [cheapest(frames, key)]
    return groups.map(own => cheapest(model.frames(own), key))
  })

/**
 * @param {Group[]} groups
 * @param {import('./model').Model} model
 * @returns {Frame[]}
 */
const pricedPlan = (groups, model) => {
  const chunks = [...chunksOf(groups, model, 'word'), ...chunksOf(groups, model, 'bit')]
  const table = chunkTable(chunks, model)
  const search = createSearch(table, model)
  explore(search, { steps: table.costs.length + table.count, mostMixed: model.mostMixed })
  const sets = search.best.sets.map(set => set.chunks.map(at => chunks[at].groups))
  const plans = (model.repeats ? ['cost', 'again'] : ['cost']).map(key => framesOf(sets, model, key))
  return plans.reduce((best, plan) => (cycleCost(plan) < cycleCost(best) ? plan : best))
}

module.exports = { pricedPlan }
