'use strict'

const TOLERANCE = 0.001

/** A silence whose end is seen this late (ms) may hide bytes that nobody has read yet: they get a moment to come in. */
const LATE = 5
const BREATH = 5
/** Timers take whole ms: less than one is lingered for. */
const PART = 1

const never = () => false

/** Waits until the wire has been silent for a while. One wait at a time. */
class Silence {
  #clock
  #quietSince
  #timer = null
  #ms = 0
  /** @type {() => void} */
  #done = never
  /** @type {(now: number) => boolean} */
  #givenUp = never
  #wokenAt = 0
  #rested = false

  /** @param {{ clock: any, quietSince: () => number }} options quietSince: when the last byte came or went, ms of the clock */
  constructor({ clock, quietSince }) {
    this.#clock = clock
    this.#quietSince = quietSince
  }

  /**
   * @param {number} ms of silence
   * @param {() => void} done at once, if it is silent already
   * @param {(now: number) => boolean} [givenUp] asked whenever it is not silent yet; true ends the wait
   */
  wait(ms, done, givenUp = never) {
    if (this.#timer !== null) this.stop()
    this.#ms = ms
    this.#done = done
    this.#givenUp = givenUp
    this.#wokenAt = this.#clock.now()
    this.#rested = false
    this.#look()
  }

  #look = () => {
    this.#timer = null
    const free = this.#quietSince() + this.#ms
    const now = this.#nowOr(free)
    // once: a process that is always late must go on all the same
    const overslept = !this.#rested && now - Math.max(free, this.#wokenAt) >= LATE
    if (now >= free - TOLERANCE && !overslept) return this.#done()
    if (this.#givenUp(now)) return
    const rest = overslept ? BREATH : this.#inTimers(free - now)
    this.#rested ||= overslept
    this.#wokenAt = now + rest
    this.#timer = this.#clock.setTimer(this.#look, rest)
  }

  /** Where the time is all but over, that time. */
  #nowOr(free) {
    const now = this.#clock.now()
    if (!this.#clock.linger || now >= free || free - now >= PART) return now
    this.#clock.linger(free)
    return this.#clock.now()
  }

  #inTimers(rest) {
    const whole = Math.floor(rest)
    return this.#clock.linger && whole > 0 ? whole : rest
  }

  stop() {
    this.#clock.clearTimer(this.#timer)
    this.#timer = null
  }
}

module.exports = { Silence }
