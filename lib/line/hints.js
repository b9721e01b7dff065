'use strict'

const { Awaited } = require('./awaited')
const { Turnarounds } = require('./turnarounds')

/** A timer may be so late (ms), and another one that was set for so much later must not come before it. */
const SOON = 5

/**
 * Tells the transport when it is worth reading (`hint` of a transport): by the wire's time, what a station usually answers and how long it usually takes.
 *
 * @typedef {object} Job of the exchange
 * @property {{ usual?: number, timeout: number }} step
 * @property {any} station
 * @property {number} need bytes that are needed at least
 * @property {boolean} ours whether they are known to be the answer's
 * @property {number | null} turnaround of the station, ms, where nobody is in a hurry and it is known
 * @property {number} reads so many times bytes came
 * @property {{ at: number, length: number } | null} first when the first of them were read (ms of the clock), and how many these were
 */
class Hints {
  #character
  #echo
  #link
  #awaited
  #turnarounds = new Turnarounds()

  /**
   * @param {{ times: { character: number, slack: number }, echo: { readonly expected: number },
   *   link: { hint: (count: number, at: number, once?: boolean) => void } }} line
   */
  constructor({ times, echo, link }) {
    this.#character = times.character
    this.#echo = echo
    this.#link = link
    this.#awaited = new Awaited(times)
  }

  /** The port was opened: others may be behind it. */
  opened() {
    this.#awaited.forget()
    this.#turnarounds.forget()
  }

  /** @param {any} station @returns {number | null} ms; null: not known, or to be looked at again */
  turnaroundOf(station) {
    return this.#turnarounds.of(station)
  }

  /** One byte at least: a recogniser that needs no more has ended the step. */
  #missing({ step, need, ours }, length) {
    return (ours ? need : this.#awaited.bytes(step, need, this.#echo.expected)) - length
  }

  /** A query was sent. @param {Job} job @param {number} length of what has come by now, in bytes @param {number} sendEnd ms of the clock */
  sent(job, length, sendEnd) {
    const count = this.#missing(job, length)
    // our own echo comes while we send
    const echo = length === 0 ? this.#echo.expected : 0
    const at = sendEnd + (count - echo) * this.#character
    const latest = sendEnd + job.step.timeout
    const whole = at + (job.turnaround ?? Infinity)
    if (whole < latest - SOON) this.#link.hint(count, whole, true)
    else this.#link.hint(count, at)
  }

  /** A part of the answer came. @param {Job} job @param {number} length of what has come by now @param {number} now ms of the clock */
  more(job, length, now) {
    const count = this.#missing(job, length)
    const { at, length: begun } = (job.first ??= { at: now, length })
    // the last of them may have come up to a character ago: we have slept
    const lastAt = Math.max(at + (length - begun) * this.#character, now - this.#character)
    this.#link.hint(count, Math.min(lastAt, now) + count * this.#character)
  }

  /** @param {Job} job @param {Buffer | null} answer null: it failed; empty: none was awaited @param {number} wait ms until its first byte */
  ended(job, answer, wait) {
    if (!answer?.length) return this.#awaited.forget()
    this.#awaited.answered(answer, job.step)
    // of an answer that was there when we looked it is not known since when
    if (job.turnaround === null || job.reads > 1) this.#turnarounds.seen(job.station, wait)
  }
}

module.exports = { Hints }
