'use strict'
const { asPlcError } = require('./failure')
const { Holes } = require('./holes')

/**
 * The requests for lists of points that come again and again: planned once, and anew only when something was learnt of the station.
 *
 * @typedef {import('./reader').Point} Point
 * @typedef {object} Prepared what becomes of a list of points
 * @property {number} version
 * @property {import('../plan/reads').ReadRequest[]} requests
 * @property {number[]} absent indexes of points that the station does not have
 * @property {{ index: number, error: import('../error').PlcError }[]} misfits longer than a request
 */

class Plans {
  #talk
  #station
  /** @type {import('./options').Plan} */
  #plan
  #turnaround
  /** By their list of points. @type {WeakMap<Point[], Prepared>} */
  #known = new WeakMap()
  /** What plans are made of: another number, other plans. */
  #version = 0
  #facts = { turnaround: 0, repeats: true }
  holes = new Holes()
  /** Addresses that the station refused: key -> { error, until, hole }. Who changes it says so by `learnt`. @type {Map<string, any>} */
  absent = new Map()

  /** @param {{ talk: any, settings: any, turnaround: { readonly ms: number } }} options turnaround: of the station */
  constructor({ talk, settings, turnaround }) {
    this.#talk = talk
    this.#station = settings.station
    this.#plan = settings.plan
    this.#turnaround = turnaround
  }

  /** Of what is known: plans of another one differ. */
  get version() {
    this.#look()
    return this.#version
  }

  /** Plans are made anew. */
  learnt() {
    this.#version++
  }

  /** @param {Point[]} points @returns {Prepared} @throws {PlcError} FRAME_TOO_LONG none of them fits into a request */
  prepared(points) {
    const { version } = this
    const known = this.#known.get(points)
    if (known?.version === version) return known
    const prepared = { version, ...this.#prepare(points) }
    this.#known.set(points, prepared)
    return prepared
  }

  /** What has changed since. */
  #look() {
    const { ms: turnaround } = this.#turnaround
    const repeats = this.#talk.repeating ?? false
    if (turnaround === this.#facts.turnaround && repeats === this.#facts.repeats) return
    this.#facts = { turnaround, repeats }
    this.#version++
  }

  /** Requests for all that can be asked for at all: a value that is longer than a request is bad alone. */
  #prepare(points) {
    const { joint, absent } = this.#groups(points)
    const misfits = []
    try {
      return { requests: this.requests([joint], { points }), absent, misfits }
    } catch (/** @type {any} */ error) {
      if (error.code !== 'FRAME_TOO_LONG') throw error
      const fitting = joint.filter(index => this.#fits(index, { points, misfits }))
      if (fitting.length + absent.length === 0) throw error
      return { requests: this.requests([fitting], { points }), absent, misfits }
    }
  }

  #fits(index, { points, misfits }) {
    // a plan for each of thousands of points would take its time
    if (points[index].count === 1) return true
    try {
      return this.requests([[index]], { points }).length > 0
    } catch (caught) {
      misfits.push({ index, error: asPlcError(caught, this.#station) })
      return false
    }
  }

  #groups(points) {
    const joint = []
    const absent = []
    const isKnown = this.absent.size === 0 ? () => false : point => this.absent.has(keyOf(point))
    points.forEach((point, index) => (isKnown(point) ? absent : joint).push(index))
    return { joint, absent }
  }

  /** Plans of parts of these points, by their indexes. @param {number[][]} parts @param {{ points: Point[] }} whole */
  requests(parts, { points }) {
    const facts = { ...this.#facts, holes: this.#missing() }
    return parts.flatMap(part => planned(part, points, { plan: this.#plan, facts }))
  }

  /** What no block may read over. */
  #missing() {
    return [...this.holes.list, ...[...this.absent.values()].map(({ hole }) => hole)]
  }
}

/** A plan for some of the points, with their places in the whole. */
const planned = (indexes, points, { plan, facts }) =>
  plan
    .reads(
      indexes.map(index => points[index]),
      facts
    )
    .map(request => ({ ...request, points: request.points.map(each => ({ ...each, point: indexes[each.point] })) }))

/** @param {{ kind: string, address: number, count: number }} point */
const keyOf = point => `${point.kind} ${point.address} ${point.count}`

module.exports = { Plans, keyOf }
