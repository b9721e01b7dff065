'use strict'
const { cycleCost } = require('./model')

/**
 * Joins requests as long as that makes a plan cheaper. Pure.
 *
 * @typedef {import('./model').Frame} Frame
 */

const MOST_FRAMES = 40

const joined = (one, other, model) =>
  model.frames([...one.groups, ...other.groups]).filter(({ cost }) => cost < one.cost + other.cost)

/** The cheapest plan with two requests joined, or null. */
const better = (frames, model) => {
  let least = cycleCost(frames)
  let best = null
  for (let one = 0; one < frames.length; one++) {
    for (let other = one + 1; other < frames.length; other++) {
      for (const frame of joined(frames[one], frames[other], model)) {
        const plan = [...frames.filter((_, at) => at !== one && at !== other), frame]
        const cost = cycleCost(plan)
        if (cost >= least) continue
        least = cost
        best = plan
      }
    }
  }
  return best
}

/**
 * @param {Frame[]} frames
 * @param {any} model
 * @returns {Frame[]}
 */
const merged = (frames, model) => {
  if (frames.length > MOST_FRAMES) return frames
  const next = better(frames, model)
  return next ? merged(next, model) : frames
}

module.exports = { merged }
