'use strict'

const { causeOf } = require('../error')
const { totalLoad } = require('./load')
const { Stats } = require('./stats')

/** What stands in the statistics of a wire that nobody uses. */
const nothing = () => ({ ...new Stats().snapshot(), waiting: 0 })

/** @param {any} error a PlcError or null */
const reasonOf = error => error && { code: error.code, cause: causeOf(error), remedy: error.remedy }

const demotedOf = stations => Object.keys(stations).filter(name => stations[name].health === 'demoted')

/** Watches a wire and says from time to time how it is. */
class Monitor {
  #clock
  #name
  #told
  /** @type {any} */
  #line = null
  #state = 'closed'
  #reason = null
  #since
  #timer = null
  #stop
  #evidence

  /**
   * @param {{ clock: any, name: string, watch: (told: any) => () => void, evidence: { facts: () => any, read: (most: number) => Promise<any> } }} wire
   * @param {MonitorOptions} [options]
   */
  constructor({ clock, name, watch, evidence }, options = {}) {
    this.#clock = clock
    this.#name = name
    this.#evidence = evidence
    this.#told = options
    this.#since = { at: clock.now(), busy: 0 }
    const { frame, interval = 0 } = options
    this.#stop = watch({
      state: (state, reason, line) => this.#became(state, reason, line),
      event: event => this.#noticed(event),
      frame
    })
    if (interval > 0) this.#tick(interval)
  }

  #tick(interval) {
    this.#timer = this.#clock.setTimer(() => {
      this.#tick(interval)
      this.#told.statistics?.(this.statistics())
    }, interval)
  }

  #became(state, reason, line) {
    const before = this.#line
    this.#line = state === 'closed' ? null : line
    this.#state = state
    this.#reason = reason
    // its counters begin anew
    if (this.#line !== before) this.#since.busy = this.#counts().busy
    this.#tell()
  }

  #noticed(event) {
    this.#told.event?.(event)
    if (event.station !== null) this.#tell()
  }

  #tell() {
    const demoted = demotedOf(this.#counts().stations).length
    this.#told.condition?.({ state: this.#state, reason: this.#reason, demoted })
  }

  #counts() {
    return this.#line?.stats() ?? nothing()
  }

  #busyPercent(busy) {
    const since = this.#since
    const now = this.#clock.now()
    const period = now - since.at
    const percent = period > 0 ? (100 * (busy - since.busy)) / period : 0
    this.#since = { at: now, busy }
    // a step counts when it ends, also what of it lay before
    return { period: Math.round(period), busyPercent: Math.round(10 * Math.min(100, Math.max(0, percent))) / 10 }
  }

  /** What the polls should take: `busyPercent` as it is measured, `percent` with the silences before frames; asksMost: a name, or ''. */
  #predicted() {
    const { busyPercent, percent, most } = totalLoad(this.#line?.loads ?? new Set())
    return { busyPercent, percent, asksMost: most?.name ?? '' }
  }

  /**
   * How the line is now: all of `line.stats()`, and `line` (its name), `timestamp`, `state`, `reason` ({ code, cause, remedy } or null), `echo`,
   * `predicted` ({ busyPercent, percent, asksMost }), `demoted` (names of stations), `period` (ms since the last statistics), `busyPercent` (of that time), `evidence` (of evidence-file.js).
   */
  statistics() {
    const counts = this.#counts()
    return {
      line: this.#name,
      timestamp: this.#clock.wall(),
      state: this.#state,
      reason: reasonOf(this.#reason),
      echo: this.#line?.echo ?? 'unknown',
      ...counts,
      ...this.#busyPercent(counts.busy),
      predicted: this.#predicted(),
      demoted: demotedOf(counts.stations),
      evidence: this.#evidence.facts()
    }
  }

  /**
   * The last frames around faults, as they stand on disk.
   * @param {number} [most] rows
   * @returns {Promise<{ file: string | null, previous: string | null, rows: any[], written: number, skipped: number, lost: number,
   *   error: { code: string, text: string } | null }>} never rejects; file null: the pool keeps none
   */
  evidence(most = 500) {
    return this.#evidence.read(most)
  }

  /** Ends it; any number of times. */
  stop() {
    this.#clock.clearTimer(this.#timer)
    this.#stop()
  }
}

/**
 * @typedef {object} MonitorOptions
 * @property {number} [interval] ms between two statistics; 0: none by itself
 * @property {(statistics: any) => void} [statistics] told each time
 * @property {(event: any) => void} [event] what the line and its devices noticed
 * @property {(how: { state: string, reason: any, demoted: number }) => void} [condition] now and at each change; demoted: so many stations are
 * @property {(row: any) => void} [frame] each frame: `{ t, dir, station, bytes (hex), note }`
 */

module.exports = { Monitor }
