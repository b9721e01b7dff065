'use strict'
const { PlcError } = require('../error')
const { asPlcError, isStationFailure } = require('./failure')

/**
 * Reads points, whatever some of them do: a request that fails spoils only its own points, an address that the station does
 * not have names itself, and a silent station is not waited for again and again.
 */

const REST = 30000 // ms that an address stays out of the joint polls after the station said that it does not have it
const MOST_SPLITS = 64 // requests that one read may spend on finding bad addresses
const BROKEN = new Set(['CRC_ERROR', 'INCOMPLETE', 'BAD_ANSWER'])

const keyOf = point => `${point.kind} ${point.address} ${point.count}`

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
  /** Addresses that the station refused: key -> { error, until }. */
  #absent = new Map()

  /** @param {{ talk: any, settings: any, clock: any }} options */
  constructor({ talk, settings, clock }) {
    this.#talk = talk
    this.#clock = clock
    this.#station = settings.station
    this.#plan = settings.plan
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
    const { joint, due, resting } = this.#groups(points, fresh)
    for (const index of resting)
      this.#fail([index], this.#named(points[index], this.#absent.get(keyOf(points[index]))), job)
    // known absent addresses are asked for apart, so that they do not spoil the others' request again
    const alone = equals(due, points)
    await this.#run(this.#possible([joint, ...alone], job), job)
    return job.readings
  }

  /** Requests for all that can be asked for at all: a value that is longer than a request is bad alone. */
  #possible(parts, job) {
    try {
      return this.#requests(parts, job)
    } catch (/** @type {any} */ error) {
      if (error.code !== 'FRAME_TOO_LONG') throw error
      const fitting = parts.map(part => part.filter(index => this.#fits(index, job)))
      if (fitting.every(part => part.length === 0)) throw error
      return this.#requests(fitting, job)
    }
  }

  #fits(index, job) {
    // a plan for each of thousands of points would take its time
    if (job.points[index].count === 1) return true
    try {
      return this.#requests([[index]], job).length > 0
    } catch (caught) {
      this.#fail([index], asPlcError(caught, this.#station), job)
      return false
    }
  }

  #groups(points, fresh) {
    const joint = []
    const due = []
    const resting = []
    points.forEach((point, index) => {
      const known = this.#absent.get(keyOf(point))
      if (!known) joint.push(index)
      else if (fresh || known.until <= this.#clock.now()) due.push(index)
      else resting.push(index)
    })
    return { joint, due, resting }
  }

  #requests(parts, job) {
    return parts.flatMap(part => planned(part, job.points, this.#plan))
  }

  /**
   * Requests one after the other; ends early if the station is silent or the line is down.
   * @returns {Promise<PlcError|null>} why it ended early
   */
  async #run(requests, job) {
    let answered = false
    for (let next = 0; next < requests.length; next++) {
      const indexes = requests[next].points.map(({ point }) => point)
      const refused = await this.#attempt(requests[next], job)
      const error = refused && (await this.#settle(refused, requests[next], job))
      if (error) this.#fail(indexes, error, job)
      if (!error || !isStationFailure(error) || BROKEN.has(error.code)) answered = true
      // after an answer one silence may be that request's own fault; a second one is the station's
      else if (answered && error.code === 'TIMEOUT') answered = false
      else return this.#failRest(requests.slice(next + 1), error, job)
    }
    return null
  }

  /** One request; its points get their readings. @returns {Promise<PlcError|null>} */
  async #attempt(request, job) {
    try {
      const answer = await this.#talk.read(request, job)
      const at = Math.round(this.#clock.wall())
      for (const { point, at: place, count } of request.points) {
        job.readings[point] = { raw: answer.slice(place, place + count), at }
        this.#absent.delete(keyOf(job.points[point]))
      }
      return null
    } catch (caught) {
      return asPlcError(caught, this.#station)
    }
  }

  /** What another plan can mend. @returns {Promise<PlcError|null>} what is left of the error */
  async #settle(error, request, job) {
    const indexes = request.points.map(({ point }) => point)
    if (this.#plan.splits.has(error.code)) return this.#split(indexes, error, job)
    if (this.#plan.simpler(request, error)) return this.#run(this.#requests([indexes], job), job)
    return error
  }

  /** Such a refusal names no address: halve until the bad ones stand alone. @returns {Promise<PlcError|null>} */
  async #split(indexes, error, job) {
    const [first, second] = distinct(indexes, job.points)
    if (second === undefined) return this.#refused(first, indexes, { error, job })
    if (job.splits >= MOST_SPLITS) return error
    job.splits += 2
    const sorted = [...indexes].sort((a, b) => order(job.points[a], job.points[b]))
    const middle = cutAt(sorted, sorted.length >> 1, job.points)
    return this.#run(this.#requests([sorted.slice(0, middle), sorted.slice(middle)], job), job)
  }

  /** The address that stands alone is refused: each item that asked for it is told so by its own name. */
  #refused(key, indexes, { error, job }) {
    if (!this.#plan.absent.has(error.code)) return error
    const known = { error, until: this.#clock.now() + REST }
    this.#absent.set(key, known)
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
    for (const { points } of requests) {
      this.#fail(
        points.map(({ point }) => point),
        error,
        job
      )
    }
    return error
  }
}

const order = (a, b) => a.kind.localeCompare(b.kind) || a.address - b.address || a.count - b.count

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

/** A plan for some of the points, with their places in the whole. */
const planned = (indexes, points, plan) =>
  plan
    .reads(indexes.map(index => points[index]))
    .map(request => ({ ...request, points: request.points.map(each => ({ ...each, point: indexes[each.point] })) }))

module.exports = { Reader }
