'use strict'

/**
 * When the polls of the stations of a line fall due: each station's on one grid, so that what has the same interval, or a multiple of it, comes at the
 * same moment; the grids of different stations apart, so that not all are due at once. Shares of the golden ratio lie well apart however many there are.
 */

const GOLDEN = (Math.sqrt(5) - 1) / 2
/** A longer interval only keeps to steps of this: waiting hours for a common moment would help nobody. ms */
const MOST_STEP = 10000
const MOST_STEPS = 200
/** How much sooner than an interval after the first cycle the second one may come, of a step: the first one may have waited for other stations. */
const SOONER = 0.25

/** @type {WeakMap<object, { epoch: number | null, stations: Map<any, number> }>} */
const lines = new WeakMap()

const phasesOf = line => {
  let phases = lines.get(line)
  if (!phases) lines.set(line, (phases = { epoch: null, stations: new Map() }))
  return phases
}

const stepOf = interval => {
  if (interval <= MOST_STEP) return interval
  return [MOST_STEP, 1000].find(step => interval % step === 0) ?? interval
}

/** The moments of one station. */
class Grid {
  #line
  #share
  /** One of its moments by step. @type {Map<number, number>} */
  #bases = new Map()

  /** @param {object} line @param {any} station */
  constructor(line, station) {
    this.#line = phasesOf(line)
    const { stations } = this.#line
    if (!stations.has(station)) stations.set(station, stations.size)
    this.#share = (Number(stations.get(station)) * GOLDEN) % 1
  }

  /**
   * A moment of the grid about one interval after a cycle that was not on it: a quarter of a step sooner at most, three quarters later.
   * @param {number} due of that cycle, ms of the clock
   * @param {number} interval ms
   */
  after(due, interval) {
    this.#line.epoch ??= due
    const step = stepOf(interval)
    const base = this.#baseOf(step)
    return base + Math.ceil((due + interval - base) / step - SOONER) * step
  }

  #baseOf(step) {
    const known = this.#bases.get(step)
    if (known !== undefined) return known
    if (this.#bases.size >= MOST_STEPS) this.#bases.clear()
    const base = this.#newBase(step)
    this.#bases.set(step, base)
    return base
  }

  /** On the grid of a shorter interval, or of a longer one, that it fits to. */
  #newBase(step) {
    const steps = [...this.#bases.keys()].sort((a, b) => a - b)
    const part = steps.findLast(each => each < step && step % each === 0)
    if (part) return this.#base(part) + Math.round((this.#share * step) / part) * part
    const whole = steps.find(each => each > step && each % step === 0)
    return whole ? this.#base(whole) : Number(this.#line.epoch) + this.#share * step
  }

  #base(step) {
    return /** @type {number} */ (this.#bases.get(step))
  }
}

module.exports = { Grid }
