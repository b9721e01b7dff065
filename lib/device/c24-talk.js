'use strict'
const { PlcError } = require('../error')
const { ACK_FRAME, OUR_NAK, encodeNak, nakText } = require('../codec/melsec/bidirectional')
const { Repeats } = require('../codec/melsec/repeats')
const { asPlcError } = require('./failure')

/**
 * The bidirectional protocol over a line: frames one after the other, each acknowledged, and the answers to what the other side sends.
 *
 * The protocol has no numbers. A NAK says that a frame was not taken: it may be sent again. Silence says nothing, since the ACK may have been lost: the
 * outcome is `unknown`, and the frame is sent again only where the user says that the other side's program knows a repetition, or where both sides have
 * sent at once and the module is set to ignore ours then.
 */

const MOST_WAITING = 1000
/** As the line holds back what an acknowledgement that comes late could be taken for, ms. */
const LEAST_LULL = 1000
/** A full buffer needs the sequence program: ms before the next attempt. */
const FULL_PAUSE = 100
const FULL = new Set([0x7f01, 0x7f6a])

const isAnswer = ({ kind }) => kind === 'ack' || kind === 'nak'

const shownCode = code => `${code.toString(16).toUpperCase().padStart(4, '0')}H`

/** Survives redeploys, and is one for all ports of a line: every port hears every frame. */
const sharedOf = (line, { repeatAfter, repeatWithin }) => {
  const memory = line.memory('C24')
  const key = `${repeatAfter} ${repeatWithin}`
  if (memory.c24?.key !== key) {
    const repeats = new Repeats({ after: repeatAfter, within: repeatWithin })
    memory.c24 = { key, repeats, message: null, again: false }
  }
  return memory.c24
}

/** @typedef {{ outcome: 'confirmed'|'unknown'|'refused'|'failed', code?: string, text?: string, attempts: number, bytes: number, error?: any }} Result */

class C24Talk {
  #lease
  #clock
  #settings
  #counts
  #shared
  /** @type {Promise<any>} */
  #turn = Promise.resolve()
  #waiting = 0
  #closed = false
  /** @type {any} the frame that is under way */
  #flight = null

  /** @param {{ lease: any, clock: any, settings: any, counts: Record<string, number> }} parts */
  constructor({ lease, clock, settings, counts }) {
    this.#lease = lease
    this.#clock = clock
    this.#settings = settings
    this.#counts = counts
    this.#shared = sharedOf(lease.line, settings)
  }

  // --- receiving

  /**
   * @param {any} message of the splitter
   * @param {(message: any, more: { repeated?: true }) => boolean} deliver false: nobody listens, so nothing is acknowledged
   * @returns {Buffer|null} the answer
   */
  hear(message, deliver) {
    if (isAnswer(message)) {
      this.#counts.strayAnswers++
      return null
    }
    if (message.kind === 'damaged') return this.#refuse(message)
    if (this.#isGivenUp(message)) {
      this.#counts.crossed++
      return null
    }
    const repeated = this.#isRepeated(message)
    if (repeated) this.#counts.repeats++
    const dropped = repeated && this.#settings.repeats === 'drop'
    if (!dropped && !deliver(message, repeated ? { repeated: true } : {})) return null
    this.#counts.acksOut++
    return ACK_FRAME
  }

  /** Both sent at once, and ours counts: the module has given its own message up and awaits no answer. */
  #isGivenUp(message) {
    return this.#settings.priority === 'us' && this.#flight?.crossing === message
  }

  #isRepeated(message) {
    const shared = this.#shared
    if (shared.message !== message) {
      shared.message = message
      shared.again = shared.repeats.accept(message.bytes, this.#clock.now())
    }
    return shared.again
  }

  #refuse(message) {
    const { began, reason } = message
    this.#counts.damaged++
    // to bytes that are no frame nothing is said: a NAK could meet the frame behind them
    if (!began || reason === 'closed' || this.#isGivenUp(message)) return null
    this.#shared.repeats.refuse(this.#clock.now())
    this.#counts.naksOut++
    return encodeNak(OUR_NAK[reason] ?? OUR_NAK.other, this.#settings.format)
  }

  // --- sending

  /** @param {Buffer} frame @param {number} deadline ms that it may wait for its turn @returns {Promise<Result>} */
  send(frame, deadline) {
    if (this.#waiting >= MOST_WAITING) {
      const error = new PlcError('QUEUE_FULL', { line: this.#lease.line.name, most: MOST_WAITING })
      return Promise.resolve(outcomeOf('failed', error, { attempts: 0, bytes: 0 }))
    }
    this.#waiting++
    const due = deadline > 0 ? this.#clock.now() + deadline : Infinity
    return new Promise(resolve => {
      // whose time is over is told so at once, also while another one is repeated
      const tooLate = () => resolve(outcomeOf('failed', this.#deadlineError(deadline), { attempts: 0, bytes: 0 }))
      const timer = deadline > 0 ? this.#clock.setTimer(tooLate, deadline) : null
      // one frame with all its repetitions before the next: order is kept
      this.#turn = this.#turn.then(async () => {
        this.#clock.clearTimer(timer)
        resolve(await this.#exchange(frame, { due, deadline }))
        this.#waiting--
      })
    })
  }

  #deadlineError(limit) {
    return new PlcError('DEADLINE', { line: this.#lease.line.name, limit })
  }

  /** @returns {Promise<Result>} */
  async #exchange(frame, { due, deadline }) {
    let doubtful = false
    for (let attempts = 1; ; attempts++) {
      const end = await this.#attempt(frame, { due, deadline })
      const facts = { attempts: end.sent === 0 ? attempts - 1 : attempts, bytes: end.sent ?? frame.length }
      if (end.kind === 'ack') return { outcome: 'confirmed', ...facts }
      const { again, error } = this.#judge(end)
      if (!again || attempts >= this.#settings.attempts || this.#closed) {
        return outcomeOf(doubtful ? 'unknown' : wordOf(end), error, facts)
      }
      // it may have been taken: what comes of the next attempt says nothing of this one, unless it is an ACK
      doubtful ||= end.kind !== 'nak' && !end.crossed
      if (await this.#lull(end)) return { outcome: 'confirmed', ...facts }
    }
  }

  /** Whether the same frame may be sent again. */
  #judge(end) {
    const { name, priority, repeatUnanswered } = this.#settings
    if (end.kind === 'nak') {
      const error = new PlcError('C24_NAK', { station: name, nak: shownCode(end.code), reason: nakText(end.code) })
      return { again: true, error }
    }
    const unanswered = end.error.code === 'TIMEOUT'
    const ignored = end.crossed && priority === 'c24'
    return { again: unanswered && (ignored || repeatUnanswered), error: end.error }
  }

  /** @returns {Promise<any>} `{ kind, code? }` of the answer, or `{ error, sent, … }` */
  async #attempt(frame, { due, deadline }) {
    const { name, quiet, ackTimeout } = this.#settings
    const now = this.#clock.now()
    const { line } = this.#lease
    if (this.#closed) return { error: new PlcError('LINE_CLOSED', { line: line.name }), sent: 0 }
    if (now >= due) return { error: this.#deadlineError(deadline), sent: 0 }
    const flight = { crossed: false, crossing: null, over: false, late: null }
    this.#flight = flight
    const match = (message, times) => this.#matches(message, { flight, frame, times })
    const left = due === Infinity ? 0 : due - now
    try {
      const { answer } = await this.#lease.send(frame, {
        quiet,
        match,
        timeout: ackTimeout,
        deadline: left,
        label: name
      })
      if (answer.kind === 'nak') this.#counts.naksIn++
      return { kind: answer.kind, code: answer.code }
    } catch (/** @type {any} */ error) {
      return { error: asPlcError(error), sent: Number(error?.details?.sent) || 0, crossed: flight.crossed, flight }
    } finally {
      flight.over = true
      this.#flight = null
    }
  }

  /** Asked by the line for every message that comes while this frame is out, and once more for an answer that comes too late. */
  #matches(message, { flight, frame, times }) {
    if (!isAnswer(message)) {
      if (times && this.#isCrossing(message, { frame, ...times }))
        Object.assign(flight, { crossed: true, crossing: message })
      return false
    }
    if (flight.over) flight.late?.(message)
    return true
  }

  /** Whether this message began before our frame, which went out since then, had ended: both sides sent at once. */
  #isCrossing({ bytes }, { frame, since, now }) {
    const { character } = this.#settings
    return now - (bytes.length + 5) * character < since + frame.length * character
  }

  /**
   * Waits before the next attempt.
   * @returns {Promise<boolean>} true: the ACK came late, but it came
   */
  #lull({ kind, code, flight }) {
    const ms = kind === 'nak' ? (FULL.has(code) ? FULL_PAUSE : 0) : Math.max(this.#settings.ackTimeout, LEAST_LULL)
    if (ms === 0) return Promise.resolve(false)
    return new Promise(resolve => {
      const end = confirmed => {
        this.#clock.clearTimer(timer)
        this.#wake = null
        resolve(confirmed)
      }
      const timer = this.#clock.setTimer(() => end(false), ms)
      this.#wake = () => end(false)
      if (flight) flight.late = ({ kind: late }) => end(late === 'ack')
    })
  }

  /** @type {null | (() => void)} */
  #wake = null

  /** No further attempt; what is on the wire is settled by the line. */
  close() {
    this.#closed = true
    this.#wake?.()
  }
}

/** What a last attempt that was not acknowledged says. @param {any} end */
const wordOf = ({ kind, sent }) => {
  if (kind === 'nak') return 'refused'
  return sent === 0 ? 'failed' : 'unknown'
}

/** @returns {Result} */
const outcomeOf = (outcome, error, { attempts, bytes }) => {
  const { code, message: text } = asPlcError(error)
  return { outcome, code, text, attempts, bytes, error }
}

module.exports = { C24Talk, outcomeOf }
