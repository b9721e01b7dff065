'use strict'

const { performance } = require('node:perf_hooks')
const { createLinger } = require('./linger')

const cell = new Int32Array(new SharedArrayBuffer(4))

/**
 * The clock of the machine. Intervals come from the monotonic clock, so a time server that moves the wall clock by an
 * hour moves no poll. Timers are rounded up to whole ms; Node.js may fire them up to a millisecond early all the same, so
 * who must not be early looks at the time again.
 * @type {Clock}
 */
const realClock = Object.freeze({
  now: () => performance.now(),
  linger: createLinger({ now: () => performance.now(), nap: ms => void Atomics.wait(cell, 0, 0, ms) }),
  wall: () => Date.now(),
  setTimer: (fn, ms) => setTimeout(fn, Math.max(0, Math.ceil(ms))),
  clearTimer: timer => clearTimeout(timer)
})

/** The last moment that a date can say, epoch ms. */
const LAST = 8.64e15

/**
 * A moment as a text for people, UTC.
 * @param {number} wall epoch ms
 * @returns {string | null} null: it is none
 */
const timeText = wall => (Math.abs(wall) <= LAST ? new Date(wall).toISOString() : null)

/**
 * @typedef {object} Clock
 * @property {() => number} now monotonic ms, with fractions
 * @property {() => number} wall epoch ms
 * @property {(until: number) => void} [linger] keeps the process until then: for parts of a ms, which timers do not count. Not if it has done so for a
 *   tenth of the time lately: who calls looks at the time again. A clock without it is exact
 * @property {(fn: () => void, ms: number) => any} setTimer
 * @property {(timer: any) => void} clearTimer any number of times; undefined is allowed
 */

module.exports = { realClock, timeText }
