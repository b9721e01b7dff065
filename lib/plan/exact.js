'use strict'

/**
 * The cheapest plan of a few values, by trying every way to share requests: the best one for each subset of the values, built from those of
 * its parts. Pure.
 *
 * @typedef {import('./model').Frame} Frame
 * @typedef {import('./blocks').Group} Group
 */

/** So many values at most: the work grows threefold with each. */
const MOST_EXACT = 9

/** How much of its saving by repetition a request enjoys: none, every other cycle, always. */
const SHARES = [0, 0.5, 1]

const cheapest = (frames, share) => {
  /** @type {{ cost: number, frame: Frame | null }} */
  let best = { cost: Infinity, frame: null }
  for (const frame of frames) {
    const cost = frame.cost - share * (frame.cost - frame.again)
    if (cost < best.cost) best = { cost, frame }
  }
  return best
}

/** Best request for each subset of the values, by share. */
const framesOfSubsets = (groups, model) => {
  /** @type {any[]} */
  const all = [null]
  for (let mask = 1; mask < 1 << groups.length; mask++) {
    const frames = model.frames(groups.filter((_, at) => mask & (1 << at)))
    all.push(SHARES.map(share => cheapest(frames, share)))
  }
  return all
}

/** `table[ends][mask]`: the best plan of a subset, `ends` of whose requests enjoy half of their saving. */
const tabulate = (subsets, ends) => {
  const table = Array.from({ length: ends + 1 }, () => subsets.map(() => ({ cost: Infinity, part: 0, ends: 0 })))
  table[0][0].cost = 0
  for (let mask = 1; mask < subsets.length; mask++) {
    const low = mask & -mask
    for (let part = mask; part > 0; part = (part - 1) & mask) {
      if (!(part & low)) continue
      for (let used = 0; used <= ends; used++) {
        for (let own = 0; own <= Math.min(1, used); own++) {
          const cost = table[used - own][mask ^ part].cost + subsets[part][own].cost
          if (cost < table[used][mask].cost) table[used][mask] = { cost, part, ends: own }
        }
      }
    }
  }
  return table
}

const collect = (table, subsets, { mask, used }) => {
  const frames = []
  while (mask > 0) {
    const { part, ends } = table[used][mask]
    frames.push(subsets[part][ends].frame)
    mask ^= part
    used -= ends
  }
  return frames
}

/**
 * @param {Group[]} groups at most {@link MOST_EXACT}
 * @param {import('./model').Model} model
 * @returns {Frame[]}
 */
const exactPlan = (groups, model) => {
  if (groups.length === 0) return []
  const subsets = framesOfSubsets(groups, model)
  const mask = subsets.length - 1
  const used = model.repeats ? 2 : 0
  const table = tabulate(subsets, used)
  const alone = subsets[mask][2]
  if (model.repeats && alone.frame && alone.cost <= table[used][mask].cost) return [alone.frame]
  return collect(table, subsets, { mask, used })
}

module.exports = { MOST_EXACT, exactPlan }
