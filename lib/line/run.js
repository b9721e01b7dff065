'use strict'

const { PlcError } = require('../error')

/** Failures of the line itself, not of a station. */
const LINE_CODES = new Set([
  'LINE_CLOSED',
  'LINE_DOWN',
  'LINE_JAMMED',
  'WRITE_STALLED',
  'WIRE_IN_USE',
  'CONNECT_FAILED',
  'PORT_NOT_FOUND',
  'PORT_BUSY',
  'PORT_DENIED',
  'PORT_GONE',
  'PORT_ERROR'
])

/** @param {any} error */
const isLineFailure = error => LINE_CODES.has(error?.code)

/** The same failure for one more request: each gets its own object, the first is the cause. */
const copyOf = (error, details) => new PlcError(error.code, { ...error.details, ...details, cause: error })

/**
 * One conversation, waiting or on the wire, and all who wait for its result. Settles exactly once for each of them.
 */
class Run {
  #make
  /** @type {any} */
  #generator = null
  #waiters = []
  /** the step that goes out next, or is out */
  step = null
  /** whether a byte of any step has gone out */
  sent = false
  deadlineTimer = null

  /** @param {() => Generator} make @param {any} options of `lease.run`, complete */
  constructor(make, { station, priority, share, gap, label, latenessBound }) {
    this.#make = make
    this.station = station
    this.priority = priority
    this.share = share
    this.gap = gap
    this.label = label
    this.latenessBound = latenessBound
  }

  get started() {
    return this.#generator !== null
  }

  get wanted() {
    return this.#waiters.length > 0
  }

  /** @param {object} lease @returns {Promise<any>} */
  join(lease) {
    return new Promise((resolve, reject) => this.#waiters.push({ lease, resolve, reject }))
  }

  /** Ends the wait of one lease. */
  leave(lease, error) {
    const gone = this.#waiters.filter(w => w.lease === lease)
    this.#waiters = this.#waiters.filter(w => w.lease !== lease)
    for (const { reject } of gone) reject(copyOf(error, { sent: this.sent }))
  }

  /**
   * Goes on by one step.
   * @param {any} error of the last step, or null @param {Buffer} [answer]
   * @returns {boolean} false: it is over, and settled
   */
  advance(error, answer) {
    try {
      const result = this.#resume(error, answer)
      if (result.done) return this.settle(null, result.value)
      this.step = checked(result.value)
      return true
    } catch (failure) {
      return this.settle(failure)
    }
  }

  #resume(error, answer) {
    if (!this.#generator) {
      this.#generator = this.#make()
      return this.#generator.next()
    }
    return error ? this.#generator.throw(error) : this.#generator.next(answer)
  }

  /** Ends it before its time: the generator returns, all who wait get the error. */
  stop(error) {
    try {
      this.#generator?.return(undefined)
    } catch {
      // a conversation that throws on its way out changes nothing
    }
    return this.settle(copyOf(error, { sent: this.sent }))
  }

  settle(error, value) {
    const waiters = this.#waiters
    this.#waiters = []
    for (const { resolve, reject } of waiters) {
      if (error) reject(error)
      else resolve(value)
    }
    return false
  }
}

const checked = step => {
  if (!Buffer.isBuffer(step?.send) || step.send.length === 0) throw new TypeError('a step needs bytes to send')
  if (step.match && !(step.timeout > 0)) throw new TypeError('a step needs a timeout')
  return step
}

module.exports = { Run, copyOf, isLineFailure }
