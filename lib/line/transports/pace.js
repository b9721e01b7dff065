'use strict'

/** Timers count whole ms: what is nearer than one (ms) is waited for by the descriptor itself. */
const LEAST = 1
/** They fire so much (ms) later than asked for. */
const LATE = 0.3
/** The byte from which the time of the others is counted was seen so much (ms) after it came. */
const SEEN = 0.2
/** To give up a wait that is under way is worth it for so much (ms). */
const LONG = 2

/** When the next bytes can be there at the earliest; who sleeps until then can be woken. */
class Pace {
  #clock
  #at = -Infinity
  #once = false
  /** @type {(() => void) | null} */
  #wake = null
  /** @type {(() => void) | null} */
  #giveUp = null

  /** @param {import('../clock').Clock} clock */
  constructor(clock) {
    this.#clock = clock
  }

  /** @param {number} at ms of the clock @param {boolean} [once] nobody asks when the first byte comes, nor for a part of a ms */
  hint(at, once = false) {
    this.#at = at
    this.#once = once
    if (once && at - this.#clock.now() >= LONG) this.#giveUp?.()
  }

  /** @param {(() => void) | null} giveUp ends the wait for the first byte, which is under way; null: it is over */
  watch(giveUp) {
    this.#giveUp = giveUp
  }

  /** @returns {Promise<void> | null} null: it is time */
  sleep() {
    const { linger } = this.#clock
    return this.#once || !linger ? this.#about() : this.#until(this.#at - SEEN, linger)
  }

  /** The nearest whole ms; timers are a little late, so rather the one before. Of what is still missing then the descriptor tells. */
  #about() {
    return this.#timer(Math.round(this.#at - this.#clock.now() - LATE), () => {})
  }

  /** Whole ms by a timer, the rest without one. */
  #until(at, linger) {
    return this.#timer(Math.floor(at - this.#clock.now()), () => {
      if (at - this.#clock.now() < LEAST) linger(at)
    })
  }

  #timer(ms, last) {
    if (!(ms >= LEAST)) return null
    return new Promise((/** @type {(value: void) => void} */ resolve) => {
      const wake = () => {
        this.#wake = null
        this.#clock.clearTimer(timer)
        resolve()
      }
      const timer = this.#clock.setTimer(() => {
        last()
        wake()
      }, ms)
      this.#wake = wake
    })
  }

  stop() {
    this.#at = -Infinity
    this.#wake?.()
  }
}

module.exports = { Pace }
