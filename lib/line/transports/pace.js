'use strict'

/** Timers count whole ms: what is nearer than one (ms) is waited for by the descriptor itself. */
const LEAST = 1
/** They fire so much (ms) later than asked for. */
const LATE = 0.3
/** The byte from which the time of the others is counted was seen so much (ms) after it came. */
const SEEN = 0.3
/** Clocks of two sides differ by such a part of the time at least. */
const DRIFT = 0.002
/** To give up a wait that is under way is worth it for so much (ms). */
const LONG = 2

/** When the next bytes can be there at the earliest; who sleeps until then can be woken. One sleeps at a time. */
class Pace {
  #clock
  #at = -Infinity
  #once = false
  /** @type {any} */
  #timer = null
  /** ms of the clock; null: about so */
  #until = /** @type {number | null} */ (null)
  /** @type {() => void} */
  #wake = () => {}
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

  /** @param {() => void} wake when it is time, or at the end @returns {boolean} false: it is time now, and nobody sleeps */
  sleep(wake) {
    const left = this.#at - this.#clock.now()
    const exact = !this.#once && this.#clock.linger !== undefined
    // of what is missing behind a whole ms that is rather short the descriptor tells
    const early = SEEN + DRIFT * left
    const ms = exact ? Math.floor(left - early) : Math.round(left - LATE)
    if (!(ms >= LEAST)) return false
    this.#until = exact ? this.#at - early : null
    this.#wake = wake
    this.#timer = this.#clock.setTimer(this.#fired, ms)
    return true
  }

  /** Whole ms have gone by; the rest goes without a timer. */
  #fired = () => {
    this.#timer = null
    const until = this.#until
    if (until !== null && until - this.#clock.now() < LEAST) this.#clock.linger?.(until)
    this.#wake()
  }

  stop() {
    this.#at = -Infinity
    if (this.#timer === null) return
    this.#clock.clearTimer(this.#timer)
    this.#timer = null
    this.#wake()
  }
}

module.exports = { Pace }
