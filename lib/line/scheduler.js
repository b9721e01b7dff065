'use strict'

const { Queue } = require('./queue')
const { Run } = require('./run')

/**
 * Who waits, and who of them may go now: a station in quarantine may not, nor one that another conversation keeps
 * between two of its steps (an RR of another one in between would repeat the wrong query).
 */
class Scheduler {
  #clock
  #queue
  #readyAt
  #awake
  #held = new Map()
  /** @type {any} */
  #timer = null
  #wakeAt = Infinity

  /**
   * @param {{ clock: any, settings: any, readyAt: (station: any) => number, awake: () => void }} options
   *   awake: called when a station that was waited for may be asked
   */
  constructor({ clock, settings, readyAt, awake }) {
    this.#clock = clock
    this.#readyAt = readyAt
    this.#awake = awake
    this.#queue = new Queue({ limit: settings.queueLimit, most: settings.writesBeforePoll })
  }

  get size() {
    return this.#queue.size
  }

  get full() {
    return this.#queue.full
  }

  /** A run that still waits and can be shared. */
  shared(share) {
    return share === null ? undefined : this.#queue.waiting(share)
  }

  /** @param {() => Generator} make @param {any} options of `lease.run` @param {(limit: number) => any} late */
  add(make, options, late) {
    const run = new Run(make, options)
    this.#queue.add(run)
    if (options.deadline > 0) {
      run.deadlineTimer = this.#clock.setTimer(() => this.discard(run, late(options.deadline)), options.deadline)
    }
    return run
  }

  /** A conversation waits for its station before its next step, and keeps the station for itself. */
  hold(run) {
    this.#held.set(run.station, run)
    this.#queue.add(run, { first: true })
  }

  /** Takes out the next run; undefined: nobody may go now, `awake` is called when one may. */
  next() {
    const run = this.#queue.next(this.#ready)
    if (run) this.#free(run)
    else this.#wakeLater()
    return run
  }

  #mayAsk(run) {
    const holder = this.#held.get(run.station)
    return !holder || holder === run
  }

  #ready = run => this.#mayAsk(run) && this.isReady(run.station)

  /** @param {any} station @returns {boolean} whether it may be asked now */
  isReady(station) {
    return this.#readyAt(station) <= this.#clock.now()
  }

  #wakeLater() {
    let at = Infinity
    for (const run of this.#queue.heads()) {
      if (this.#mayAsk(run)) at = Math.min(at, this.#readyAt(run.station))
    }
    if (at === Infinity || (this.#timer !== null && this.#wakeAt <= at)) return
    this.sleep()
    this.#wakeAt = at
    this.#timer = this.#clock.setTimer(() => {
      this.#timer = null
      this.#awake()
    }, at - this.#clock.now())
  }

  /** Nobody needs to be woken. */
  sleep() {
    this.#clock.clearTimer(this.#timer)
    this.#timer = null
  }

  #free(run) {
    this.#clock.clearTimer(run.deadlineTimer)
    if (this.#held.get(run.station) === run) this.#held.delete(run.station)
  }

  /** A run that is not on the wire ends. @param {Run} run @param {any} reason */
  discard(run, reason) {
    this.#queue.remove(run)
    this.#free(run)
    run.stop(reason)
  }

  /** All that waits ends. */
  rejectAll(reason) {
    for (const run of this.#queue.all()) this.discard(run, reason)
  }

  /** What only this lease waits for ends. */
  drop(lease, reason) {
    for (const run of this.#queue.all()) {
      run.leave(lease, reason)
      if (!run.wanted) this.discard(run, reason)
    }
  }
}

module.exports = { Scheduler }
