'use strict'
const { PlcError } = require('../error')
const { servedValues } = require('../plan')
const { asPlcError, isStationFailure } = require('./failure')
const { Plans, keyOf } = require('./plans')

/**
 * Reads points, whatever some of them do: a request that fails spoils only its own points, an address that the station does
 * not have names itself, and a silent station is not waited for again and again.
 */

const REST = 30000 // ms that an address stays out of the joint polls after the station said that it does not have it
const MOST_SPLITS = 64 // requests that one read may spend on finding bad addresses
const BROKEN = new Set(['CRC_ERROR', 'INCOMPLETE', 'BAD_ANSWER'])

/**
 * @typedef {{ kind: 'bit'|'word', address: number, count: number, text: string }} Point
 * @typedef {object} Job one read
 * @property {Point[]} points
 * @property {number} priority
 * @property {any[]} readings one per point, filled in as they come
 * @property {number} splits requests spent on finding bad addresses
 */

class Reader {
  #talk
  #clock
  #station
  /** @type {import('./options').Plan} */
  #plan
  #plans

  /** @param {{ talk: any, settings: any, clock: any, turnaround: { readonly ms: number } }} options turnaround: of the station */
  constructor({ talk, settings, clock, turnaround }) {
    this.#talk = talk
    this.#clock = clock
    this.#station = settings.station
    this.#plan = settings.plan
    this.#plans = new Plans({ talk, settings, turnaround })
  }

  /**
   * @param {Point[]} points
   * @param {{ priority: number, fresh: boolean }} options fresh: ask also for addresses that the station refused lately
   * @returns {Promise<import('./points').Reading[]>} one per point; bad with FRAME_TOO_LONG where a value does not fit into one request
   * @throws {PlcError} FRAME_TOO_LONG none of them does
   */
  async read(points, { priority, fresh }) {
    /** @type {Job} */
    const job = { points, priority, readings: new Array(points.length), splits: 0 }
    const { requests: joint, absent, misfits } = this.#plans.prepared(points)
    for (const { index, error } of misfits) this.#fail([index], error, job)
    const requests = absent.length > 0 ? [...joint, ...this.#apart(absent, { job, fresh })] : joint
    // the last one of a cycle first in the next: the station repeats it by a short frame
    const turned = requests.length > 1 && this.#talk.repeats?.(requests.at(-1))
    await this.#run(turned ? [...requests].reverse() : requests, job)
    return job.readings
  }

  /**
   * The requests that read these points, if nothing is wrong with them; none if none of them can be read.
   * @param {Point[]} points
   * @returns {import('../plan/reads').ReadRequest[]}
   */
  requestsOf(points) {
    try {
      return this.#plans.prepared(points).requests
    } catch {
      return []
    }
  }

  /** Of what plans are made of. */
  get version() {
    return this.#plans.version
  }

  /** Known absent addresses are asked for apart, so that they do not spoil the others' request again; or not at all for a while. */
  #apart(absent, { job, fresh }) {
    const { points } = job
    const due = []
    for (const index of absent) {
      const known = this.#plans.absent.get(keyOf(points[index]))
      if (!known || fresh || known.until <= this.#clock.now()) due.push(index)
      else this.#fail([index], this.#named(points[index], known), job)
    }
    return this.#plans.requests(equals(due, points), job)
  }

  /**
   * Requests one after the other; ends early if the station is silent or the line is down.
   * @returns {Promise<PlcError|null>} why it ended early
   */
  async #run(requests, job) {
    let answered = false
    for (let next = 0; next < requests.length; next++) {
      const request = requests[next]
      let error = null
      try {
        this.#served(request, await this.#talk.read(request, job), job)
      } catch (caught) {
        error = await this.#settle(asPlcError(caught, this.#station), request, job)
      }
      if (error) this.#fail(indexesOf(request), error, job)
      if (!error || !isStationFailure(error) || BROKEN.has(error.code)) answered = true
      // after an answer one silence may be that request's own fault; a second one is the station's
      else if (answered && error.code === 'TIMEOUT') answered = false
      else return this.#failRest(requests.slice(next + 1), error, job)
    }
    return null
  }

  /** The points of a request get their readings. */
  #served(request, answer, { points, readings }) {
    const at = Math.round(this.#clock.wall())
    const { absent } = this.#plans
    for (const served of request.points) {
      readings[served.point] = { raw: servedValues(answer, served), at }
      if (absent.size > 0 && absent.delete(keyOf(points[served.point]))) this.#plans.learnt()
    }
  }

  /** What another plan can mend. @returns {Promise<PlcError|null>} what is left of the error */
  async #settle(error, request, job) {
    if (this.#plan.splits.has(error.code)) return this.#split(request, error, job)
    if (this.#plan.simpler(request, error)) {
      this.#plans.learnt()
      return this.#run(this.#plans.requests([indexesOf(request)], job), job)
    }
    return error
  }

  /**
   * Such a refusal names no address: halve until the bad ones stand alone, or between two good ones that a block read over.
   * @returns {Promise<PlcError|null>}
   */
  async #split(request, error, job) {
    const indexes = inOrder(request)
    const [first, second] = distinct(indexes, job.points)
    if (second === undefined) return this.#refused(first, indexes, { error, job })
    if (job.splits >= MOST_SPLITS) return error
    job.splits += 2
    const middle = cutAt(indexes, indexes.length >> 1, job.points)
    const halves = [indexes.slice(0, middle), indexes.slice(middle)]
    const ended = await this.#run(this.#plans.requests(halves, job), job)
    if (!this.#plan.absent.has(error.code) || indexes.some(index => !job.readings[index]?.raw)) return ended
    const [before, after] = halves.map(half => half.map(index => job.points[index]))
    this.#plans.holes.learn(request, before, after)
    this.#plans.learnt()
    return ended
  }

  /** The address that stands alone is refused: each item that asked for it is told so by its own name. */
  #refused(key, indexes, { error, job }) {
    if (!this.#plan.absent.has(error.code)) return error
    const { kind, address, count } = job.points[indexes[0]]
    const hole = { kind, start: address, end: address + count }
    const known = { error, until: this.#clock.now() + REST, hole }
    this.#plans.absent.set(key, known)
    this.#plans.learnt()
    for (const index of indexes) this.#fail([index], this.#named(job.points[index], known), job)
    return error
  }

  #named({ text }, known) {
    const { error } = known
    if (error.details.address === text) return error
    const details = { ...error.details, station: this.#station, address: text, cause: error }
    return (known.error = new PlcError(error.code, details))
  }

  #fail(indexes, error, job) {
    const at = Math.round(this.#clock.wall())
    for (const index of indexes) job.readings[index] ??= { error, at }
  }

  #failRest(requests, error, job) {
    for (const request of requests) this.#fail(indexesOf(request), error, job)
    return error
  }
}

const indexesOf = ({ points }) => points.map(({ point }) => point)

/** The points of a request as they stand in its answer. */
const inOrder = ({ points }) =>
  [...points].sort((a, b) => a.at - b.at || (a.bit ?? 0) - (b.bit ?? 0) || a.count - b.count).map(({ point }) => point)

/** Indexes of equal points together. @returns {number[][]} */
const equals = (indexes, points) => {
  const groups = new Map()
  for (const index of indexes) {
    const key = keyOf(points[index])
    if (groups.has(key)) groups.get(key).push(index)
    else groups.set(key, [index])
  }
  return [...groups.values()]
}

const distinct = (indexes, points) => [...new Set(indexes.map(index => keyOf(points[index])))]

/** A place to cut that leaves equal points together and neither half empty. */
const cutAt = (sorted, middle, points) => {
  const key = keyOf(points[sorted[middle]])
  const first = sorted.findIndex(index => keyOf(points[index]) === key)
  if (first > 0) return first
  return sorted.findIndex(index => keyOf(points[index]) !== key)
}

module.exports = { Reader }
