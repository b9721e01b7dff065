'use strict'
const { PlcError, isRefusal } = require('../error')
const { PRIORITY } = require('../line')
const { asPlcError } = require('./failure')
const { outcomeOf, unsent, wordFor } = require('./outcome')
const { checkSteps } = require('./step')
const { verifyWritten } = require('./verify')

/**
 * Brings prepared writes to the station: never repeated, the latest value only where that is asked for, not sooner than the write interval allows, and
 * no step that is too large. The first frame that is not confirmed ends a write.
 *
 * @typedef {object} Job
 * @property {import('./writer').Prepared} prepared may be replaced by a later one until the first frame goes out
 * @property {() => void} [begin] its turn has come: from now on it is not replaced
 * @property {(outcome: any) => void} [settle]
 *
 * @typedef {object} Course how far a write has come
 * @property {Job} job
 * @property {boolean} patient waits for the write interval
 * @property {symbol} by so that it does not wait for itself
 * @property {{ outcome: string, error?: PlcError, unsent?: boolean }[]} done one for each request that had its turn
 * @property {number} reached requests whose frame was made
 * @property {PlcError | null} stopped why the one whose turn it is was not sent
 * @property {any[]} marks of the write interval, one for each request
 */

/** A broadcast is never confirmed: what comes after it goes out all the same. */
const goesOn = error => !error || error.code === 'BROADCAST_UNCONFIRMED'

class Delivery {
  #talk
  #reader
  #clock
  #settings
  #intervals
  #closed = false
  /** Writes of the latest value that still wait for their turn: key -> job. @type {Map<string, Job>} */
  #waiting = new Map()
  /** @type {Set<() => void>} ends of waits for the write interval */
  #sleeping = new Set()

  /** @param {{ talk: any, reader: any, clock: any, settings: any, intervals: any }} parts */
  constructor({ talk, reader, clock, settings, intervals }) {
    this.#talk = talk
    this.#reader = reader
    this.#clock = clock
    this.#settings = settings
    this.#intervals = intervals
  }

  /**
   * @param {import('./writer').Prepared} prepared
   * @param {{ verify?: boolean, coalesce?: boolean }} options
   * @returns {Promise<any>} the outcome; never rejects
   */
  write(prepared, options) {
    if (!options.coalesce) return this.#carryOut({ prepared }, options)
    const key = JSON.stringify([prepared.entries.map(({ item }) => item.text), Boolean(options.verify)])
    const job = this.#waiting.get(key)
    return job ? this.#replace(job, prepared) : this.#firstOf(key, prepared, options)
  }

  /** Of several writes of the same items that wait, only the latest goes out, in the place of the first. */
  #replace(job, prepared) {
    const { entries } = job.prepared
    job.settle(unsent(new PlcError('SUPERSEDED', { item: entries[0].item.text }), entries))
    job.prepared = prepared
    return new Promise(resolve => (job.settle = resolve))
  }

  #firstOf(key, prepared, options) {
    /** @type {any} */
    const job = { prepared }
    job.begin = () => void (this.#waiting.get(key) === job && this.#waiting.delete(key))
    this.#waiting.set(key, job)
    const promise = new Promise(resolve => (job.settle = resolve))
    this.#carryOut(job, options).then(outcome => {
      job.begin()
      job.settle(outcome)
    })
    return promise
  }

  /** @param {Job} job @param {{ verify?: boolean, coalesce?: boolean }} options */
  async #carryOut(job, { verify, coalesce = false }) {
    /** @type {Course} */
    const course = { job, patient: coalesce, by: Symbol('write'), done: [], reached: 0, stopped: null, marks: [] }
    let error = null
    for (let next = 0; next < job.prepared.requests.length && goesOn(error); next++) {
      error = await this.#request(course, next)
      // nothing of the whole was sent: the error may be another item's
      if (error && course.stopped && next === 0)
        return unsent(error, job.prepared.entries, /** @type {any} */ (wordFor(error)))
      const fate = error ? { outcome: wordFor(error), error } : { outcome: 'confirmed' }
      course.done.push({ ...fate, unsent: fate.outcome === 'failed' || course.stopped !== null })
    }
    course.marks.forEach((mark, index) => (course.done[index]?.unsent ?? true) && this.#intervals.drop(mark))
    return this.#outcome(course, verify)
  }

  async #outcome({ job, done, reached }, verify) {
    const { entries, points, requests } = job.prepared
    const { station } = this.#settings
    const fates = points.map(() => ({ outcome: 'notSent' }))
    requests.forEach((request, index) => {
      if (done[index]) for (const point of request.points) fates[point] = done[index]
    })
    if (verify) await verifyWritten({ reader: this.#reader, station, points, fates })
    return { ...outcomeOf(entries, fates, station), attempts: reached }
  }

  /** @param {Course} course @param {number} next @returns {Promise<PlcError|null>} */
  async #request(course, next) {
    for (;;) {
      const first = next === 0
      if (first && course.patient && !(await this.#due(course.job))) {
        return (course.stopped = new PlcError('LINE_CLOSED', { line: this.#settings.name }))
      }
      course.stopped = null
      const error = await this.#send(course, next)
      // another write of the same words was faster
      if (!(first && course.patient && course.stopped && error?.code === 'WRITE_TOO_SOON')) return error
    }
  }

  /** Waits until the write interval is over. @param {Job} job @returns {Promise<boolean>} false: closed meanwhile */
  async #due(job) {
    while (!this.#closed) {
      const { ms } = this.#intervals.wait(job.prepared.points)
      if (ms <= 0) return true
      await new Promise(resolve => {
        const end = () => {
          this.#clock.clearTimer(timer)
          this.#sleeping.delete(end)
          resolve(undefined)
        }
        const timer = this.#clock.setTimer(end, ms)
        this.#sleeping.add(end)
      })
    }
    return false
  }

  /** @param {Course} course @param {number} next @returns {Promise<PlcError|null>} */
  async #send(course, next) {
    let item = ''
    const take = () => {
      const { points, requests } = course.job.prepared
      item = points[requests[next].points[0]].text
      return { query: requests[next], item, before: ask => this.#before(course, next, ask) }
    }
    try {
      await this.#talk.write(take, { priority: PRIORITY.WRITE })
      return null
    } catch (caught) {
      const error = asPlcError(caught, this.#settings.station)
      // a byte that went out before was one of reading
      return course.reached > next ? this.#meaning(error, item) : error
    }
  }

  /** Goes before the frame, in one conversation with it: none of our writes comes between. */
  *#before(course, next, ask) {
    const { job } = course
    try {
      this.checkInterval(this.#pointsOf(job, next), course.by)
      job.begin?.()
      const { requests, steps } = job.prepared
      const own = next === 0 ? steps : steps.filter(({ index }) => requests[next].points.includes(index))
      yield* checkSteps(own, { plan: this.#settings.plan, ask })
    } catch (caught) {
      course.stopped = asPlcError(caught, this.#settings.station)
      throw caught
    }
    course.reached = next + 1
    // all at once: another write of its words must not come in between
    if (next === 0)
      course.marks = job.prepared.requests.map((_, at) =>
        this.#intervals.mark(this.#pointsOf(job, at, true), course.by)
      )
    return () => this.#intervals.again(course.marks[next])
  }

  /** The first request stands for the whole write: nothing of it goes out if a later one must not. */
  #pointsOf({ prepared: { points, requests } }, next, alone = false) {
    return next === 0 && !alone ? points : requests[next].points.map(index => points[index])
  }

  /**
   * @param {any[]} points
   * @param {symbol} [by] the write that asks
   * @throws {PlcError} WRITE_TOO_SOON
   */
  checkInterval(points, by) {
    const { ms, text } = this.#intervals.wait(points, by)
    if (ms > 0) throw new PlcError('WRITE_TOO_SOON', { item: text, wait: Math.ceil(ms) })
  }

  /** What the line broke off after a byte of it went out may have been carried out. */
  #meaning(error, item) {
    const { code, details } = error
    if (code === 'WRITE_UNKNOWN' || isRefusal(error) || details.sent !== true) return error
    return new PlcError('WRITE_UNKNOWN', { station: this.#settings.station, item, reason: code, cause: error })
  }

  /** What waits for the write interval fails; what waits for the line is settled by the line. */
  close() {
    this.#closed = true
    for (const end of [...this.#sleeping]) end()
  }
}

module.exports = { Delivery }
