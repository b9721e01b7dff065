'use strict'
const { loopback } = require('../codec/modbus/loopback')

/**
 * After a timeout a station is left alone until nothing late can come any more. A regulator that knows function 08 can be asked instead: it sends a
 * number back, and what it was asked before it has answered by then, or never will. Only where answers come in order, and only where what is heard
 * cannot be ourselves: the answer to 08 is a copy of the query.
 */

const UNANSWERED = new Set(['TIMEOUT', 'INCOMPLETE'])
/** So often in a row it may be silent to 08 before it is not asked any more. */
const MOST_SILENT = 3
/** Numbers that are not used again so soon: an answer to an older one must not be taken for this one's. */
const MOST_NUMBERS = 64
const ILLEGAL_FUNCTION = 1

class Clearing {
  #lease
  #settings
  #health
  #random
  #memory
  #station

  /**
   * @param {{ lease: any, settings: any, health: { patience: number }, memory: any, random: () => number }} options memory: of the station, kept over redeploys;
   *   random: 0 to 1
   */
  constructor({ lease, settings, health, memory, random }) {
    this.#lease = lease
    this.#settings = settings
    this.#health = health
    this.#random = random
    this.#memory = memory.clearing ??= { heardSelf: true, refused: false, silent: 0, numbers: [] }
    this.#station = lease.line.memory(settings.station)
    lease.on('state', this.#forget)
  }

  // another adapter may be behind the port
  #forget = () => void Object.assign(this.#memory, { heardSelf: true, silent: 0 })

  get #isPossible() {
    const { refused, silent, heardSelf } = this.#memory
    if (refused || silent >= MOST_SILENT || this.#station.overtaken) return false
    const { echo } = this.#lease.line
    return echo === 'present' || (echo === 'absent' && !heardSelf)
  }

  /** A conversation, after each of whose unanswered steps the station is asked by 08. @param {Generator<any, any, Buffer>} dialog @param {number} gap ms */
  watch(dialog, gap) {
    return this.#settings.probe08 && this.#settings.station !== 0 ? this.#watched(dialog, gap) : dialog
  }

  *#watched(dialog, gap) {
    let next = dialog.next()
    try {
      while (!next.done) {
        let answer
        try {
          answer = yield* this.#step(next.value)
        } catch (/** @type {any} */ error) {
          if (UNANSWERED.has(error.code)) yield* this.#clear(gap)
          next = dialog.throw(error)
          continue
        }
        next = dialog.next(answer)
      }
      return next.value
    } finally {
      dialog.return(undefined)
    }
  }

  /** One step; whether we hear ourselves is seen by answers that do not equal their queries. */
  *#step(step) {
    if (!step.match) return yield step
    let heardSelf = false
    let alone = true
    const { match } = step
    // the step itself is changed: a conversation makes a new one each time
    step.match = bytes => {
      heardSelf ||= Buffer.from(bytes).includes(step.send)
      const verdict = match(bytes)
      // what is stepped over may be ourselves, damaged
      if (verdict.skip > 0) alone = false
      return verdict
    }
    const answer = yield step
    if (heardSelf) this.#memory.heardSelf = true
    else if (alone && !answer.equals(step.send)) this.#memory.heardSelf = false
    return answer
  }

  /** Whatever comes of it, what had happened before counts. */
  *#clear(gap) {
    if (!this.#isPossible) return
    const { station, framing, timeout } = this.#settings
    const { send, match, proves, exception } = loopback(this.#number(), { station, protocol: framing })
    const patience = Math.min(this.#health.patience, timeout)
    try {
      const answer = yield { send, match, timeout: patience, lateAfter: timeout, gap, clears: proves }
      if (proves(answer)) this.#memory.silent = 0
      if (exception(answer) === ILLEGAL_FUNCTION) this.#memory.refused = true
    } catch (/** @type {any} */ error) {
      if (error.code === 'TIMEOUT') this.#memory.silent++
    }
  }

  #number() {
    const { numbers } = this.#memory
    let number = Math.floor(this.#random() * 0x10000) & 0xffff
    while (numbers.includes(number)) number = (number + 1) & 0xffff
    numbers.push(number)
    if (numbers.length > MOST_NUMBERS) numbers.shift()
    return number
  }

  close() {
    this.#lease.off('state', this.#forget)
  }
}

module.exports = { Clearing }
