'use strict'

const { causeOf } = require('../error')

/**
 * When a line cannot be used: told once as it begins and once as it ends, however often its state changes meanwhile. The pool keeps `memory`
 * by wire, so that a redeploy begins no new outage.
 */
class Outage {
  #clock
  #memory
  #report

  /**
   * @param {{ clock: any, memory: { downAt: number | null }, report: (event: any) => void }} options
   *   memory: since when it is down, ms of the clock; null: it is not
   */
  constructor({ clock, memory, report }) {
    this.#clock = clock
    this.#memory = memory
    this.#report = report
  }

  /** @param {string} state of the line @param {any} reason a PlcError or null */
  became(state, reason) {
    const { downAt } = this.#memory
    if (state === 'waiting' && downAt === null) this.#begin(reason)
    else if (state === 'open' && downAt !== null) this.#end(downAt)
  }

  #begin(reason) {
    this.#memory.downAt = this.#clock.now()
    const { code, remedy } = reason
    this.#report({ event: 'lineDown', station: null, code, cause: causeOf(reason), remedy })
  }

  #end(downAt) {
    this.#memory.downAt = null
    const downFor = Math.round(this.#clock.now() - downAt)
    this.#report({ event: 'lineUp', station: null, downFor, cause: `it was down for ${downFor} ms`, remedy: '' })
  }
}

module.exports = { Outage }
