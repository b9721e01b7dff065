'use strict'

const { PRIORITY } = require('./queue')
const { copyOf } = require('./run')

/**
 * Drives conversations: takes the next run when the wire is free, puts its steps on the wire, gives it the answers and
 * failures, and tells the quarantine what was not answered.
 */
class Driver {
  #exchange
  #scheduler
  #quarantine
  #recorder
  #host
  #least
  /** @type {any} the run whose step is on the wire */
  #active = null
  /** between two steps: whoever is told of something now may ask, but has to wait for its turn */
  #turning = false

  /**
   * @param {any} parts `{ exchange, scheduler, quarantine, recorder }` of the line
   * @param {{ gap: number, latenessBound: number }} least of the line, in ms; runs and steps may ask for more
   * @param {{ refusal: () => any, answered: (station: any) => void, troubled: (error: any) => void,
   *   stray: (bytes: Buffer) => void }} host
   *   refusal: why nothing can be sent now, or null
   */
  constructor({ exchange, scheduler, quarantine, recorder }, least, host) {
    this.#exchange = exchange
    this.#scheduler = scheduler
    this.#quarantine = quarantine
    this.#recorder = recorder
    this.#least = least
    this.#host = host
  }

  /** Lets the next one go, if the wire is free. */
  pump() {
    while (!this.#active && !this.#turning && this.#scheduler.size > 0 && !this.#host.refusal()) {
      const run = this.#scheduler.next()
      if (!run) return
      if (run.started) this.#go(run)
      else this.#resume(run, null)
    }
  }

  /** @template T @param {() => T} fn @returns {T} */
  #turn(fn) {
    const was = this.#turning
    this.#turning = true
    try {
      return fn()
    } finally {
      this.#turning = was
    }
  }

  /** The conversation goes on by one step: at once, or when its station may be asked again. */
  #resume(run, error, answer) {
    if (!this.#turn(() => run.advance(error, answer))) return
    this.#announce(run)
    const refusal = this.#host.refusal()
    if (refusal) run.stop(refusal)
    else if (run.step.clears || this.#scheduler.isReady(run.station)) this.#go(run)
    else this.#scheduler.hold(run)
  }

  #announce({ station, step, latenessBound }) {
    if (!step.match) return
    const bound = latenessBound || this.#least.latenessBound
    this.#quarantine.asks(station, { timeout: timeOf(step), latenessBound: bound })
  }

  #go(run) {
    this.#active = run
    const { step, station } = run
    this.#exchange.start(step, {
      gap: Math.max(this.#least.gap, step.gap ?? 0, run.gap),
      station,
      calm: run.priority === PRIORITY.POLL && this.#scheduler.size === 0,
      sent: () => this.#sent(run),
      noted: () => this.#recorder.sent(run.station, step.send, run.label),
      done: (error, answer, facts) => this.#ended(run, error, answer, facts)
    })
  }

  #sent(run) {
    run.sent = true
    run.step.sent?.()
  }

  #ended(run, error, answer, facts) {
    this.#active = null
    this.#turn(() => this.#note(run, { error, answer, facts }))
    this.#resume(run, error, answer)
    this.pump()
  }

  /** What became of a step. */
  #note(run, { error, answer, facts }) {
    const { station, step } = run
    this.#recorder.ended({ station, step, error, answer, facts })
    if (error) {
      // of a frame of full length nothing more can come; of all else something may
      if (error.code !== 'CRC_ERROR') this.#unanswered(run, { ...facts, seen: answer })
      this.#host.troubled(error)
    } else if (step.match) {
      this.#recorder.stats.waited(station, facts.wait)
      this.#quarantine.answered(station, answer)
      if (step.clears?.(answer)) this.#quarantine.cleared(station)
      this.#host.answered(station)
    }
    if (facts.rest.length > 0) this.#host.stray(facts.rest)
  }

  #unanswered({ station, step }, facts) {
    // what clears proves something or nothing: heard later on, it may be our own echo
    if (!facts?.sent || !step.match || step.clears) return
    const { due, seen } = facts
    this.#quarantine.failed({ station, match: step.match, timeout: timeOf(step), due, seen })
  }

  /** The wire broke: the step on it ends with this error, and its conversation may still say what that means. */
  breakOff(reason) {
    const run = this.#active
    const facts = this.#exchange.abort()
    if (!run) return
    this.#unanswered(run, facts)
    this.#active = null
    this.#resume(run, copyOf(reason, { sent: facts?.sent ?? false }))
  }

  /** The run on the wire ends. */
  stop(reason) {
    const run = this.#active
    const facts = this.#exchange.abort()
    if (!run) return
    this.#unanswered(run, facts)
    this.#active = null
    run.stop(reason)
  }

  /** What only this lease waits for ends. */
  drop(lease, reason) {
    this.#scheduler.drop(lease, reason)
    const run = this.#active
    if (!run) return
    run.leave(lease, reason)
    if (run.wanted) return
    this.stop(reason)
    this.pump()
  }
}

/** What the answer may take and still be in time, ms. */
const timeOf = ({ timeout, lateAfter }) => lateAfter ?? timeout

module.exports = { Driver }
