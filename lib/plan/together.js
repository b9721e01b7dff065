'use strict'

/**
 * What of a station is polled together. Pure.
 *
 * @typedef {{ interval: number }} Group ms
 */

const SHARE = 0.5 // of its interval that a cycle may take with slower ones in it

/**
 * Groups that are due at the same moment -> those whose items are read by one plan. A fast one takes the slower ones along as long as they do not hold
 * it up: the whole takes at most half of its interval.
 * @template {Group} G
 * @param {G[]} groups one for each interval
 * @param {(groups: G[]) => number} msOf what reading them by one plan takes
 * @returns {G[][]} the fastest first
 */
const together = (groups, msOf) => {
  let rest = [...groups].sort((a, b) => a.interval - b.interval)
  const parts = []
  while (rest.length > 0) {
    const part = [rest[0]]
    const left = []
    for (const group of rest.slice(1)) {
      if (msOf([...part, group]) <= SHARE * part[0].interval) part.push(group)
      else left.push(group)
    }
    parts.push(part)
    rest = left
  }
  return parts
}

module.exports = { SHARE, together }
