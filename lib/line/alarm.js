'use strict'

/** A timer that fires this late (ms) tells of a busy process, not of a silent partner: what came meanwhile gets time to be read. */
const LAG = 10
const MOST_GRACE = 250

/** One timer at a time, set to a moment of the clock. */
class Alarm {
  #clock
  #timer = null

  /** @param {any} clock */
  constructor(clock) {
    this.#clock = clock
  }

  /** @param {number} at ms of the clock @param {() => void} fn */
  set(at, fn) {
    this.stop()
    const due = Math.max(at, this.#clock.now())
    const fire = graced => () => {
      const lag = this.#clock.now() - due
      if (lag > LAG && !graced) {
        this.#timer = this.#clock.setTimer(fire(true), Math.min(lag, MOST_GRACE))
        return
      }
      this.#timer = null
      fn()
    }
    this.#timer = this.#clock.setTimer(fire(false), due - this.#clock.now())
  }

  stop() {
    this.#clock.clearTimer(this.#timer)
    this.#timer = null
  }
}

module.exports = { Alarm }
