'use strict'

const SAMPLES = 4
/** Of so many answers one is looked at again from its first byte on: the station may have become faster. */
const AGAIN = 16
/** Timers count whole ms, and to wake a little too early costs another time. */
const MARGIN = 0.5

/** How long each station has taken lately, at least, until it began to answer: so an answer for which nobody is in a hurry is read once, when it is there. */
class Turnarounds {
  /** @type {Map<any, { lately: number[], count: number }>} */
  #stations = new Map()

  /** @param {any} station @returns {number | null} ms; null: not known, or to be looked at again */
  of(station) {
    const known = this.#stations.get(station)
    if (!known || known.lately.length < SAMPLES || ++known.count % AGAIN === 0) return null
    return Math.min(...known.lately) + MARGIN
  }

  /** @param {any} station @param {number} ms from the end of the query to the first byte, by an answer whose bytes were read as they came */
  seen(station, ms) {
    const known = this.#stations.get(station) ?? { lately: [], count: 0 }
    this.#stations.set(station, known)
    known.lately.push(ms)
    if (known.lately.length > SAMPLES) known.lately.shift()
  }

  /** The port was opened: there may be others behind it. */
  forget() {
    this.#stations.clear()
  }
}

module.exports = { Turnarounds }
