'use strict'
const { totalLoad } = require('../line/load')
const { loadOf } = require('../plan')
const { overloadText, overrunEvent } = require('./load-texts')

const MINUTE = 60000
const TOLD_FROM = 3 // cycles left out in a minute: one may be left out for any disturbance

/** What the polls of a device cost, and what becomes of those that do not fit. */
class Load {
  #clock
  #line
  #settings
  #reader
  #groups
  #members
  #state = { minute: -Infinity, missed: 0, told: false }
  /** @type {{ version: any, load: any } | null} */
  #known = null

  /**
   * @param {object} options
   * @param {any} options.clock
   * @param {any} options.line
   * @param {any} options.settings
   * @param {import('./reader').Reader} options.reader
   * @param {() => { interval: number, points: any[] }[]} options.groups that are polled, one for each interval
   * @param {() => Iterable<any>} options.members subscriptions
   */
  constructor({ clock, line, settings, reader, groups, members }) {
    this.#clock = clock
    this.#line = line
    this.#settings = settings
    this.#reader = reader
    this.#groups = groups
    this.#members = members
    line.loads?.add(this.all)
  }

  get #wire() {
    const { gap, silences } = this.#settings.plan
    const character = this.#line.times?.character ?? 1
    return { requestsOf: points => this.#reader.requestsOf(points), character, gap, silences }
  }

  /** Other subscriptions, or other items. */
  changed() {
    this.#known = null
  }

  /** All polls of the device. @returns {import('../line/load').Load & import('../plan/prediction').Load} */
  all = () => {
    const { version } = this.#reader
    if (this.#known?.version !== version) {
      const asked = [...this.#members()].map(owner => ({ name: owner.name, percent: this.alone(owner).percent, owner }))
      this.#known = { version, load: { ...loadOf(this.#groups(), this.#wire), asked } }
    }
    return this.#known?.load
  }

  /** One subscription by itself. @param {{ interval: number, points: any[] }} member @returns {{ ms: number, percent: number, requests: number }} */
  alone({ interval, points }) {
    const { percent, cycles } = loadOf([{ interval, points }], this.#wire)
    const [{ ms, requests }] = cycles
    return { ms, percent, requests }
  }

  /** What reading these points takes by one plan, ms. @param {any[]} points */
  msOf(points) {
    const { requestsOf, character } = this.#wire
    return requestsOf(points).reduce((sum, { cost }) => sum + cost, 0) * character
  }

  /** What all who poll take of the line. */
  get #total() {
    return totalLoad(this.#line.loads ?? new Set([this.all]))
  }

  /** Of `Polling`, see device.js. @param {any} member */
  costOf(member) {
    const own = this.alone(member)
    const { percent: linePercent, most } = this.#total
    const { interval } = member
    const advice = most?.owner === member ? overloadText({ ...own, interval, linePercent }) : null
    return { ...own, linePercent, advice }
  }

  /** A cycle was left out. @param {any} member */
  overrun(member) {
    const now = this.#clock.now()
    const state = this.#state
    if (now - state.minute >= MINUTE) Object.assign(state, { minute: now, missed: 0, told: false })
    state.missed++
    if (state.told || state.missed < TOLD_FROM) return
    const { station } = this.#settings
    const facts = { station, missed: state.missed, interval: member.interval, took: member.took }
    const event = overrunEvent({ ...facts, ...this.alone(member), linePercent: this.#total.percent })
    state.told = event !== null
    if (event) this.#line.report(event)
  }

  close() {
    this.#line.loads?.delete(this.all)
  }
}

module.exports = { Load }
