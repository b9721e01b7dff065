'use strict'

/**
 * Repeatable randomness (mulberry32): everything random in the simulator comes from here, so that a seed replays a run.
 * Not for secrets.
 *
 * @param {number} seed 0..2^32-1
 * @returns {Random}
 */
function createRandom(seed) {
  let state = seed >>> 0
  const next = () => {
    state = (state + 0x6d2b79f5) >>> 0
    let z = Math.imul(state ^ (state >>> 15), state | 1)
    z = (z + Math.imul(z ^ (z >>> 7), z | 61)) ^ z
    return ((z ^ (z >>> 14)) >>> 0) / 0x100000000
  }
  const integer = (least, most) => least + Math.floor(next() * (most - least + 1))
  return {
    next,
    integer,
    chance: rate => rate > 0 && next() < rate,
    pick: list => list[integer(0, list.length - 1)],
    bytes: count => Buffer.from(Array.from({ length: count }, () => integer(0, 255))),
    fork: () => createRandom(integer(0, 0xffffffff))
  }
}

/** A seed for a run that is meant to be new each time; print it. */
const freshSeed = () => Math.floor(Math.random() * 0x100000000)

/**
 * @typedef {object} Random
 * @property {() => number} next 0 <= x < 1
 * @property {(least: number, most: number) => number} integer both ends included
 * @property {(rate: number) => boolean} chance
 * @property {<T>(list: T[]) => T} pick
 * @property {(count: number) => Buffer} bytes
 * @property {() => Random} fork an independent stream, decided by this one
 */

module.exports = { createRandom, freshSeed }
