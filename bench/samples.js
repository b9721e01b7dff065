'use strict'

/** What the planners are given to read: items of an NX PLC, by number and kind. The same ones in each run. */

const { createRandom } = require('../lib/sim')

const range = (count, item) => Array.from({ length: count }, (_, n) => item(n))

/** Words that lie `step` words apart in W, which has 2048. */
const apart = (count, step) => range(count, n => `W${n * step}`)

/** W's words, so many of them by chance. @param {number} count 1 to 2048 @param {number} [seed] */
const scattered = (count, seed = 1) => {
  const random = createRandom(seed)
  const chosen = new Set()
  while (chosen.size < count) chosen.add(random.integer(0, 2047))
  return [...chosen].map(word => `W${word}`)
}

/** Bits and words, half and half, by chance over M and K, and words of W. @param {number} count @param {number} seed */
const mixed = (count, seed) => {
  const random = createRandom(seed)
  const bit = () => `${random.pick(['M', 'K'])}${random.integer(0, 127)}.${random.integer(0, 15)}`
  const word = () =>
    random.chance(0.5) ? `${random.pick(['M', 'K'])}${random.integer(0, 127)}` : `W${random.integer(0, 2047)}`
  const chosen = new Set()
  while (chosen.size < count) chosen.add(random.chance(0.5) ? bit() : word())
  return [...chosen]
}

/** Neighbours, with nothing between them. */
const dense = {
  '128 words of M': range(128, n => `M${n}`),
  '300 words of W': range(300, n => `W${n}`),
  '400 bits of M': range(400, n => `M${n >> 4}.${n & 15}`),
  '60 words of M, 60 of K, 200 of W': [
    ...range(60, n => `M${n}`),
    ...range(60, n => `K${n}`),
    ...range(200, n => `W${n}`)
  ],
  '20 runs of 10 words of W': range(200, n => `W${Math.floor(n / 10) * 100 + (n % 10)}`)
}

module.exports = { apart, dense, mixed, scattered }
