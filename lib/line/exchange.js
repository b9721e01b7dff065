'use strict'

const { PlcError } = require('../error')
const { Hints } = require('./hints')
const { jobOf } = require('./job')
const { EMPTY, Receiver } = require('./receiver')
const { Repeats } = require('./repeats')
const { Silence } = require('./silence')

/** A timer that fires this late (ms) tells of a busy process, not of a silent station: then the bytes get time to come in. */
const LAG = 10
const MOST_GRACE = 250

const TOLERANCE = 0.001

const nothing = () => {}

/**
 * One step on the wire at a time: gap, sending, answer. Synchronous: `done(error, answer)` is called from a timer or from
 * the arrival of bytes. Knows no stations and no queue.
 */
class Exchange {
  #clock
  #times
  #link
  #echo
  #settings
  #rx = new Receiver()
  #repeats
  #hints
  #silence
  /** @type {any} */
  #job = null
  /** @type {any} */
  #timer = null
  #firesAt = Infinity
  #lastByteAt = -Infinity
  #sendEnd = -Infinity

  /**
   * @param {{ clock: any, settings: any, times: any, echo: any, link: any }} options
   *   link: `{ name, write(bytes, done), hint(count, at, once?), waiting(), stray(bytes), skipped(bytes), echoed(bytes) }`
   */
  constructor({ clock, settings, times, echo, link }) {
    this.#clock = clock
    this.#settings = settings
    this.#times = times
    this.#echo = echo
    this.#link = link
    this.#hints = new Hints({ times, echo, link })
    this.#repeats = new Repeats({ character: times.character, transport: settings.transport })
    this.#silence = new Silence({ clock, quietSince: () => this.quietSince })
  }

  /** The port was opened. @param {unknown} id what its transport claims */
  opened(id) {
    this.#hints.opened()
    this.#repeats.opened(id)
  }

  /** The computed end of the frame that is being sent, or was sent last; ms of the clock. */
  get sendEnd() {
    return this.#sendEnd
  }

  /** When the last byte came or went, ms; those that have come and wait to be looked at come now. */
  get quietSince() {
    return this.#link.waiting() ? this.#clock.now() : Math.max(this.#lastByteAt, this.#sendEnd)
  }

  /**
   * @param {any} step of a conversation
   * @param {{ gap: number, station: any, calm?: boolean, sent: () => void, noted?: () => void, done: (error: any, answer: Buffer, facts: any) => void }} options
   *   calm: nobody is in a hurry for the answer; sent: it goes out now; noted: it has been handed to the wire
   *   facts: `{ due, sent, ms, wait, rest }` — when the answer should have begun; whether a byte went out; ms since the end of sending, and
   *   from there to the first byte; what came behind the answer
   */
  start(step, { gap, station, calm = false, sent, noted = nothing, done }) {
    const turnaround = calm ? this.#hints.turnaroundOf(station) : null
    this.#job = jobOf(step, { station, turnaround, sent, noted, done }, this.#clock.now())
    this.#silence.wait(gap, this.#send, this.#isJammed)
  }

  /** Nothing is sent into a flood: the step ends, if bytes came all the time. */
  #isJammed = now => {
    const { bytes, from } = this.#job
    if (bytes === 0 || now - from < this.#settings.jamTime) return false
    this.#settle(new PlcError('LINE_JAMMED', { line: this.#link.name, bytes, sent: false }))
    return true
  }

  #send = () => {
    const job = this.#job
    const { send } = job.step
    this.#echo.sent(send)
    this.#repeats.sent()
    job.phase = 'awaiting'
    job.sentAt = this.#clock.now()
    this.#sendEnd = job.sentAt + send.length * this.#times.character
    job.writing = true
    job.sent()
    this.#link.write(send, error => this.#written(job, error))
    job.writing = false
    // told behind the write: what the wire waits for comes first
    job.noted()
    if (this.#job !== job) return
    if (job.fault) return this.#fail(job.fault)
    this.#look()
  }

  #written(job, error) {
    if (this.#job !== job || job.written) return
    job.written = true
    job.fault = error
    this.#sendEnd = Math.max(this.#sendEnd, this.#clock.now())
    if (job.writing) return
    if (error) this.#fail(error)
    else this.#look()
  }

  /** Tells the transport how long nobody needs to read: after sending, and after a part of the answer. */
  #hint(job, fresh) {
    const { length } = this.#rx.bytes
    if (fresh) this.#hints.more(job, length, this.#lastByteAt)
    else this.#hints.sent(job, length, this.#sendEnd)
  }

  /** @param {Buffer} bytes that arrived @param {number} [at] when, ms of the clock; default: now */
  data(bytes, at = this.#clock.now()) {
    this.#lastByteAt = at
    const job = this.#job
    if (!job) return this.#link.stray(bytes)
    job.bytes += bytes.length
    job.reads++
    if (job.phase !== 'awaiting' || !job.step.match) return this.#link.stray(bytes)
    const dropped = this.#rx.push(bytes, at)
    if (dropped.length > 0) this.#link.skipped(dropped)
    if (!job.writing) this.#look(true)
  }

  /** Looks at what has come; settles, or sets the time until which more may come. */
  #look(fresh = false) {
    const job = this.#job
    if (job.step.match) {
      let verdict
      try {
        verdict = this.#judge(job.step)
      } catch (error) {
        // a recogniser that throws ends its run, not the process
        return this.#job === job ? this.#fail(error) : undefined
      }
      if (this.#job !== job) return
      job.need = verdict.need ?? 1
      job.ours = verdict.ours ?? false
      this.#hint(job, fresh)
    }
    this.#arm(this.#dueTime(job))
  }

  #judge(step) {
    for (;;) {
      const { bytes } = this.#rx
      if (bytes.length === 0) return { need: this.#echo.expected + step.match(EMPTY).need }
      const echo = this.#echo.look(bytes)
      if (echo > 0) {
        this.#link.echoed(this.#rx.take(echo))
        this.#job.first = null
        continue
      }
      if (echo < 0) return { need: Math.max(step.send.length, this.#echo.expected + step.match(EMPTY).need) }
      const verdict = step.match(bytes)
      if (verdict.take > 0 && verdict.take <= bytes.length) {
        const frame = this.#rx.take(verdict.take)
        if (this.#repeats.isOld(frame, this.#query)) {
          this.#drop(frame)
          continue
        }
        this.#repeats.answered(frame, this.#query)
        this.#echo.answered(frame)
        this.#settle(null, frame)
        return verdict
      }
      if (verdict.bad) {
        this.#damaged(verdict)
        return verdict
      }
      if (!(verdict.skip > 0)) return verdict.need > bytes.length ? verdict : { ...verdict, need: bytes.length + 1 }
      this.#skip(step)
    }
  }

  /** Drops all that is not ours in one go: noise comes in many bytes. */
  #skip(step) {
    const { bytes } = this.#rx
    let at = 0
    while (at < bytes.length) {
      const { skip } = step.match(bytes.subarray(at))
      if (!(skip > 0) || this.#echo.begins(bytes.subarray(at))) break
      at += skip
    }
    this.#drop(this.#rx.take(at))
  }

  #drop(bytes) {
    this.#echo.disturbed(bytes)
    this.#link.skipped(bytes)
  }

  get #query() {
    const { step, sentAt } = this.#job
    return { length: step.send.length, sentAt, now: this.#clock.now() }
  }

  #damaged({ bad, length }) {
    const frame = this.#rx.take(length ?? this.#rx.bytes.length)
    const { station } = this.#job
    this.#settle(new PlcError('CRC_ERROR', { station, got: frame.toString('hex'), reason: bad, sent: true }), frame)
  }

  #dueTime(job) {
    const { step } = job
    if (!job.written) return this.#sendEnd + this.#settings.writeTimeout
    if (!step.match) return this.#sendEnd + (step.turnaround ?? 100)
    const due = this.#sendEnd + step.timeout
    if (this.#rx.bytes.length === 0) return due
    const rest = this.#rx.firstAt + job.need * this.#times.character + this.#times.slack
    if (job.ours) return rest
    // begun in time, but not yet known as ours: it may be the answer
    return this.#rx.firstAt <= due ? Math.max(due, rest) : due
  }

  #arm(due) {
    const job = this.#job
    job.due = due
    if (this.#timer !== null && this.#firesAt <= due) return
    this.#clock.clearTimer(this.#timer)
    const now = this.#clock.now()
    this.#firesAt = Math.max(due, now)
    this.#timer = this.#clock.setTimer(this.#expired, due - now)
  }

  #expired = () => {
    this.#timer = null
    const job = this.#job
    // of a step that is over
    if (job?.phase !== 'awaiting') return
    const now = this.#clock.now()
    if (job.due - now > TOLERANCE) return this.#arm(job.due)
    const lag = now - this.#firesAt
    if (lag > LAG && !job.graced) {
      job.graced = true
      return this.#arm(now + Math.min(lag, MOST_GRACE))
    }
    if (!job.written) return this.#fail(new PlcError('WRITE_STALLED', { line: this.#link.name, sent: true }))
    if (!job.step.match) return this.#settle(null, EMPTY)
    this.#timedOut(job)
  }

  #timedOut({ station, step, ours, need }) {
    const got = this.#rx.bytes.length
    const error = ours
      ? new PlcError('INCOMPLETE', { station, got, expected: need, sent: true })
      : new PlcError('TIMEOUT', { station, timeout: step.timeout, sent: true })
    this.#settle(error, this.#rx.takeAll())
  }

  /** Ends the step with this error, from outside or by the transport. */
  #fail(error) {
    this.#settle(error, this.#rx.takeAll())
  }

  /**
   * Ends the step without telling anybody.
   * @returns {{ sent: boolean, due: number, seen: Buffer } | null} due: when its answer should have begun
   */
  abort() {
    const job = this.#job
    this.#clock.clearTimer(this.#timer)
    this.#timer = null
    if (!job) return null
    this.#idle()
    const sent = job.phase === 'awaiting'
    return { sent, due: this.#dueEnd(job), seen: this.#rx.takeAll() }
  }

  /** Until when the answer to a step is in time: who probes waits shorter. */
  #dueEnd({ step }) {
    return this.#sendEnd + (step.lateAfter ?? step.timeout ?? 0)
  }

  /** The timer stays: the next step, which mostly comes before it, needs none of its own. */
  #idle() {
    this.#silence.stop()
    this.#job = null
  }

  #settle(error, bytes = EMPTY) {
    const job = this.#job
    this.#idle()
    if (error) this.#repeats.failed()
    const rest = this.#rx.takeAll()
    const ms = this.#clock.now() - this.#sendEnd
    const wait = Math.max(0, ms - bytes.length * this.#times.character)
    this.#hints.ended(job, error ? null : bytes, wait)
    job.done(error, bytes, { due: this.#dueEnd(job), rest, sent: job.phase === 'awaiting', ms, wait })
  }
}

module.exports = { Exchange }
