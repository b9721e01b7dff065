'use strict'
const { TURNAROUND } = require('./options')

const STEP = 5 // ms
const STICKY = 4 // ms that the mean may lie off before plans are made anew
const LEARNT = 10 // answers

/** How long a station takes until it begins to answer, in steps, so that the plans which follow it stay the same. */
class Turnaround {
  #memory
  #ms = TURNAROUND

  /** @param {{ waits?: { size: number, mean: number | null } }} memory of the station on the line */
  constructor(memory) {
    this.#memory = memory
  }

  /** A multiple of 5 ms. */
  get ms() {
    const { waits } = this.#memory
    if (!waits || waits.size < LEARNT) return this.#ms
    const mean = Number(waits.mean)
    if (Math.abs(mean - this.#ms) > STICKY) this.#ms = STEP * Math.max(0, Math.round(mean / STEP))
    return this.#ms
  }
}

module.exports = { Turnaround }
