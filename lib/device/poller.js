'use strict'
const { together } = require('../plan')

const EARLY = 2 // ms: timers of Node.js may fire a little before their time, which must not count as a cycle of its own
const MOST_JITTER = 100 // ms: many stations that start together do not stay together
const MOST_EARLY = 50 // ms that a cycle may come before its time, so that others of the station share its requests
const MOST_SETS = 50

/**
 * @typedef {object} Member a subscription, as the poller sees it
 * @property {number} interval ms
 * @property {boolean} running whether its last cycle has not ended yet
 * @property {boolean} stopped
 * @property {{ kind: 'bit'|'word', address: number, count: number, text: string }[]} points
 * @property {(cycles: number) => void} missed cycles were left out
 * @property {() => void} begin
 * @property {(readings: any[]) => void} end
 * @property {(error: any) => void} fail
 *
 * @typedef {{ due: number, base: number | null }} Times when it is due, and one of its moments on the grid (null: it was not there yet); ms of the clock
 */

/**
 * Polls a station: all its subscriptions together. Their times lie on one grid, from the monotonic clock, without drift; what is due at the
 * same moment is planned and read at once, the same value once however many ask for it. A cycle that still runs when its next one is due is
 * counted as missed, never piled up.
 */
class Poller {
  #clock
  #random
  #grid
  #read
  #estimate
  #overrun
  /** @type {Map<Member, Times>} */
  #times = new Map()
  #timer = null
  /** Lists of points by the members that were read together: plans are kept by such a list. @type {Map<string, any[]>} */
  #sets = new Map()
  /** @type {WeakMap<Member, number>} */
  #numbers = new WeakMap()
  #count = 0

  /**
   * @param {object} options
   * @param {any} options.clock
   * @param {() => number} options.random 0 to 1
   * @param {{ after: (due: number, interval: number) => number }} options.grid
   * @param {(points: any[]) => Promise<any[]>} options.read one reading per point
   * @param {(points: any[]) => number} options.estimate ms that reading them takes
   * @param {(member: any) => void} [options.overrun] a cycle was left out because the one before still runs
   */
  constructor({ clock, random, grid, read, estimate, overrun = () => {} }) {
    this.#clock = clock
    this.#random = random
    this.#grid = grid
    this.#read = read
    this.#estimate = estimate
    this.#overrun = overrun
  }

  /** @param {Member} member @param {{ immediately: boolean }} options the first cycle at once, or after one interval */
  add(member, { immediately }) {
    const { interval } = member
    const wait = immediately ? this.#random() * Math.min(MOST_JITTER, interval / 10) : interval
    this.#numbers.set(member, this.#count++)
    this.#times.set(member, { due: this.#clock.now() + wait, base: null })
    this.#wake()
  }

  /** @param {Member} member */
  remove(member) {
    this.#times.delete(member)
    this.#sets.clear()
    this.#wake()
  }

  /** Other points of a member. */
  changed() {
    this.#sets.clear()
  }

  /** These members at once, beside their times. @param {Member[]} members */
  now(members) {
    this.#cycle(members.filter(({ running, stopped }) => !running && !stopped))
  }

  /** All members, those of one interval together: what a prediction is made of. @returns {{ interval: number, points: any[] }[]} */
  get groups() {
    return byInterval([...this.#times.keys()]).map(({ interval, members }) => ({
      interval,
      points: this.#pointsOf(members)
    }))
  }

  #wake() {
    this.#clock.clearTimer(this.#timer)
    this.#timer = null
    if (this.#times.size === 0) return
    let next = Infinity
    for (const { due } of this.#times.values()) next = Math.min(next, due)
    this.#timer = this.#clock.setTimer(this.#tick, Math.max(0, next - this.#clock.now()))
  }

  #tick = () => {
    this.#timer = null
    const now = this.#clock.now()
    const ready = []
    for (const [member, times] of this.#times) {
      const early = Math.max(EARLY, Math.min(MOST_EARLY, member.interval / 10))
      if (times.due > now + early) continue
      // of a process that stood still
      const passed = this.#advance(times, member.interval, now)
      if (passed > 0) member.missed(passed)
      if (!member.running) ready.push(member)
      else {
        member.missed(1)
        this.#overrun(member)
      }
    }
    this.#wake()
    this.#cycle(ready)
  }

  /** The next time of a member, counted from one moment on so that no delay adds up. @returns {number} cycles that have passed meanwhile */
  #advance(times, interval, now) {
    const { due, base } = times
    times.base ??= this.#grid.after(due, interval)
    // the first time on the grid may lie more than one interval ahead
    const past = Math.max(-1, Math.floor((Math.max(now, due) - times.base + EARLY) / interval))
    times.due = times.base + (past + 1) * interval
    return base === null ? past + 1 : Math.max(0, Math.round((times.due - due) / interval) - 1)
  }

  /** Short intervals first; a long cycle does not hold up those that come more often. @param {Member[]} ready */
  #cycle(ready) {
    if (ready.length === 0) return
    if (ready.length === 1) return this.#start(ready)
    const parts = together(byInterval(ready), groups => this.#estimate(this.#pointsOf(membersOf(groups))))
    for (const part of parts) this.#start(membersOf(part))
  }

  /** The points of members as one list; the same list for the same members, by which its plan is found again. @param {Member[]} members */
  #pointsOf(members) {
    if (members.length === 1) return members[0].points
    const key = members.map(member => this.#numbers.get(member)).join()
    const known = this.#sets.get(key)
    if (known) return known
    if (this.#sets.size >= MOST_SETS) this.#sets.clear()
    const points = members.flatMap(member => member.points)
    this.#sets.set(key, points)
    return points
  }

  /** @param {Member[]} members */
  #start(members) {
    const points = this.#pointsOf(members)
    // whoever gets other items meanwhile is answered for those that it asked for
    const shares = members.map(member => ({ member, count: member.points.length }))
    for (const member of members) member.begin()
    this.#read(points).then(
      readings => {
        let from = 0
        for (const { member, count } of shares) {
          tell(member, { readings: shares.length === 1 ? readings : readings.slice(from, from + count) })
          from += count
        }
      },
      error => members.forEach(member => tell(member, { error }))
    )
  }
}

const membersOf = groups => groups.flatMap(({ members }) => members)

/** @param {Member[]} members @returns {{ interval: number, members: Member[] }[]} */
const byInterval = members => {
  const groups = new Map()
  for (const member of members) {
    const { interval } = member
    if (groups.has(interval)) groups.get(interval).members.push(member)
    else groups.set(interval, { interval, members: [member] })
  }
  return [...groups.values()]
}

/** Who is told and throws does not keep the others from being told. */
const tell = (member, /** @type {{ readings?: any[], error?: any }} */ { readings, error: failure }) => {
  try {
    if (readings) member.end(readings)
    else member.fail(failure)
  } catch (/** @type {any} */ error) {
    process.emitWarning(`a callback of a subscription failed: ${error?.message ?? error}`)
  }
}

module.exports = { EARLY, Poller }
