'use strict'

const { EventEmitter } = require('node:events')
const { PlcError } = require('../error')
const { Connection } = require('./connection')
const { Echo } = require('./echo')
const { Exchange } = require('./exchange')
const { Quarantine } = require('./quarantine')
const { Queue } = require('./queue')
const { Run, copyOf, isLineFailure } = require('./run')
const { Recorder } = require('./recorder')
const { lineTimes } = require('./timing')

/** A frame that is being sent is never cut; nor is closing held up longer than this, ms. */
const MOST_SENDING = 1000

/** After a failure with one of these an answer may still come. */
const UNANSWERED = new Set(['TIMEOUT', 'INCOMPLETE', 'WRITE_STALLED'])

/**
 * One wire: who goes next, what happens when nobody answers, and how it opens and closes.
 * Synchronous: everything happens inside a timer, the arrival of bytes, or a call; promises only at the edge.
 * Events: `state` (state, reason) and `event` ({ event, station, … }).
 */
class Line extends EventEmitter {
  #clock
  #settings
  #times
  #queue
  #quarantine
  #echo
  #exchange
  #connection
  #recorder
  /** @type {any} */
  #state = 'closed'
  /** @type {any} */
  #reason = null
  /** @type {any} */
  #active = null
  #held = new Map()
  #wake = null
  #wakeAt = Infinity
  #grace = null
  #quiet = null
  #silent = 0
  #closing = false

  /**
   * @param {{ name: string, settings: any, clock: any, make: () => any, random: () => number, claims: any,
   *   memories: Map<any, any> }} options
   */
  constructor({ name, settings, clock, make, random, claims, memories }) {
    super()
    this.setMaxListeners(0)
    this.name = name
    this.#clock = clock
    this.#settings = settings
    this.#times = lineTimes(settings)
    this.#recorder = new Recorder(clock)
    this.#queue = new Queue({ limit: settings.queueLimit, most: settings.writesBeforePoll })
    this.#quarantine = new Quarantine({ clock, memories, late: (fact, frame) => this.#late(fact, frame) })
    this.#echo = new Echo(settings.echo)
    const link = this.#link()
    this.#exchange = new Exchange({ clock, settings, times: this.#times, echo: this.#echo, link })
    const told = {
      opened: () => this.#opened(),
      data: bytes => this.#data(bytes),
      down: (error, wasOpen) => this.#down(error, wasOpen)
    }
    this.#connection = new Connection({ name, clock, make, random, claims, told })
  }

  #link() {
    return {
      name: this.name,
      write: (bytes, done) => this.#connection.write(bytes, done),
      hint: (count, at) => this.#connection.hint(count, at),
      echoed: bytes => this.#recorder.echoed(bytes),
      skipped: bytes => this.#unclaimed('skipped', bytes),
      stray: bytes => this.#unclaimed('stray', bytes)
    }
  }

  /** @returns {'closed'|'opening'|'open'|'waiting'|'jammed'} */
  get state() {
    return this.#state
  }

  /** Why it is waiting or jammed: a PlcError, or null. */
  get reason() {
    return this.#reason
  }

  /** `unknown`, `present` or `absent`: whether the adapter hears what it sends. */
  get echo() {
    return this.#echo.state
  }

  /** Times of this wire in ms: `{ character, gap, slack }`. */
  get times() {
    return this.#times
  }

  /** Counters since the line was made; see docs/nodes.md. */
  stats() {
    return { ...this.#recorder.stats.snapshot(), waiting: this.#queue.size }
  }

  /** The last 200 frames, oldest first: `{ t, dir, station, bytes (hex), note }`. */
  trace() {
    return this.#recorder.trace.rows()
  }

  /** A plain object per station that survives redeploys; `bound` and `lateness` (ms) are the line's. */
  memory(station) {
    return this.#quarantine.memory(station)
  }

  // --- opening and closing

  open() {
    this.#become('opening', null)
    this.#grace = this.#clock.setTimer(() => this.#graceOver(), this.#settings.openGrace)
  }

  /** The port is free: the transport may open it. */
  connect() {
    if (!this.#closing) this.#connection.start()
  }

  #become(state, reason) {
    if (state === this.#state && reason?.code === this.#reason?.code) return
    this.#state = state
    this.#reason = reason
    this.emit('state', state, reason)
  }

  #graceOver() {
    this.#grace = null
    const reason = new PlcError('LINE_DOWN', { line: this.name, reason: 'it is still being opened' })
    this.#become('waiting', reason)
    this.#rejectWaiting(reason)
  }

  #opened() {
    this.#clearGrace()
    this.#echo.reset()
    this.#quarantine.opened()
    this.#become('open', null)
    this.#pump()
  }

  #clearGrace() {
    this.#clock.clearTimer(this.#grace)
    this.#grace = null
  }

  #down(error, wasOpen) {
    if (this.#closing) return
    const reason = this.#asReason(error)
    this.#clearGrace()
    this.#stopWatching()
    if (wasOpen) this.#recorder.stats.count('reconnects')
    this.#become('waiting', reason)
    this.#breakOff(reason)
    this.#rejectWaiting(reason)
  }

  #asReason(error) {
    if (error instanceof PlcError) return error
    const reason = error?.message ?? 'the connection was closed'
    return new PlcError('LINE_DOWN', { line: this.name, reason, cause: error })
  }

  /** The step on the wire ends with this error; its conversation may still say what that means. */
  #breakOff(reason) {
    const run = this.#active
    if (!run) return
    const facts = this.#exchange.abort()
    this.#abandoned(run, facts)
    this.#active = null
    this.#resume(run, copyOf(reason, { sent: facts?.sent ?? false }))
  }

  #abandoned(run, facts) {
    if (facts?.sent) this.#quarantine.failed({ ...run.step, ...facts, station: run.station })
  }

  #rejectWaiting(reason) {
    for (const run of this.#queue.all()) this.#discard(run, reason)
  }

  /** A run that is not on the wire ends. */
  #discard(run, reason) {
    this.#queue.remove(run)
    this.#free(run)
    run.stop(reason)
  }

  #free(run) {
    this.#clock.clearTimer(run.deadlineTimer)
    if (this.#held.get(run.station) === run) this.#held.delete(run.station)
  }

  /** Ends all that waits, lets a frame on the wire end, closes the port. @param {() => void} done */
  close(done) {
    if (this.#closing) return done()
    this.#closing = true
    const reason = new PlcError('LINE_CLOSED', { line: this.name })
    const sending = Math.min(MOST_SENDING, this.#exchange.sendEnd - this.#clock.now())
    this.#clearGrace()
    this.#stopWatching()
    this.#clock.clearTimer(this.#wake)
    this.#rejectWaiting(reason)
    this.#stopActive(reason)
    const shut = () =>
      this.#connection.stop(() => {
        this.#become('closed', null)
        done()
      })
    if (sending > 0 && this.#connection.isOpen) this.#clock.setTimer(shut, sending)
    else shut()
  }

  #stopActive(reason) {
    const run = this.#active
    if (!run) return
    this.#abandoned(run, this.#exchange.abort())
    this.#active = null
    run.stop(reason)
  }

  // --- requests

  /**
   * @param {object} lease who asks
   * @param {() => Generator} make
   * @param {any} options of `lease.run`, complete
   * @returns {Promise<any>}
   */
  run(lease, make, options) {
    const refusal = this.#refusal()
    if (refusal) return Promise.reject(refusal)
    const shared = options.share === null ? undefined : this.#queue.waiting(options.share)
    if (shared) {
      this.#recorder.stats.count('overruns', options.station)
      return shared.join(lease)
    }
    if (this.#queue.full) {
      this.#recorder.stats.count('queueFull')
      return Promise.reject(
        new PlcError('QUEUE_FULL', { line: this.name, most: this.#settings.queueLimit, sent: false })
      )
    }
    const run = new Run(make, options)
    const promise = run.join(lease)
    this.#queue.add(run)
    if (options.deadline > 0) {
      run.deadlineTimer = this.#clock.setTimer(() => this.#overdue(run, options.deadline), options.deadline)
    }
    this.#pump()
    return promise
  }

  #refusal() {
    if (this.#closing || this.#state === 'closed') return new PlcError('LINE_CLOSED', { line: this.name, sent: false })
    return this.#reason ? copyOf(this.#reason, { sent: false }) : null
  }

  #overdue(run, limit) {
    this.#discard(run, new PlcError('DEADLINE', { line: this.name, limit }))
  }

  /** A lease was released: what only it waits for ends. */
  drop(lease) {
    const reason = new PlcError('LINE_CLOSED', { line: this.name })
    const runs = this.#queue.all()
    for (const run of runs) {
      run.leave(lease, reason)
      if (!run.wanted) this.#discard(run, reason)
    }
    const active = this.#active
    if (!active) return
    active.leave(lease, reason)
    if (active.wanted) return
    this.#stopActive(reason)
    this.#pump()
  }

  #ready = run => {
    const holder = this.#held.get(run.station)
    return (!holder || holder === run) && this.#quarantine.readyAt(run.station) <= this.#clock.now()
  }

  /** Lets the next one go, if the line is free. */
  #pump() {
    while (!this.#active && this.#state === 'open' && !this.#closing && this.#queue.size > 0) {
      const run = this.#queue.next(this.#ready)
      if (!run) return this.#wakeLater()
      this.#free(run)
      if (run.started) this.#go(run)
      else this.#resume(run, null)
    }
  }

  #wakeLater() {
    let at = Infinity
    for (const run of this.#queue.heads()) {
      const holder = this.#held.get(run.station)
      if (!holder || holder === run) at = Math.min(at, this.#quarantine.readyAt(run.station))
    }
    if (at === Infinity || (this.#wake !== null && this.#wakeAt <= at)) return
    this.#clock.clearTimer(this.#wake)
    this.#wakeAt = at
    this.#wake = this.#clock.setTimer(() => {
      this.#wake = null
      this.#pump()
    }, at - this.#clock.now())
  }

  /** The conversation goes on by one step: at once, or when its station may be asked again. */
  #resume(run, error, answer) {
    if (!run.advance(error, answer)) return
    const refusal = this.#refusal()
    if (refusal) return void run.stop(refusal)
    if (this.#quarantine.readyAt(run.station) <= this.#clock.now()) return this.#go(run)
    // an RR of another conversation in between would repeat the wrong query: the station stays with this one
    this.#held.set(run.station, run)
    this.#queue.add(run, { first: true })
  }

  #go(run) {
    this.#active = run
    const { step, station } = run
    const gap = Math.max(this.#times.gap, step.gap ?? 0, run.gap)
    this.#exchange.start(step, {
      gap,
      station,
      sent: () => this.#sent(run),
      done: (error, answer, facts) => this.#ended(run, error, answer, facts)
    })
  }

  #sent(run) {
    run.sent = true
    const { station, step } = run
    if (step.match) this.#quarantine.asked(station, { timeout: step.timeout, latenessBound: run.latenessBound })
    this.#recorder.sent(station, step.send, run.label)
  }

  #ended(run, error, answer, facts) {
    const { station, step } = run
    this.#recorder.ended({ station, step, error, answer, facts })
    this.#active = null
    if (error) this.#troubled(run, error, answer, facts)
    else if (step.match) this.#answered(station, answer)
    this.#resume(run, error, answer)
    this.#pump()
  }

  #answered(station, answer) {
    this.#silent = 0
    this.#connection.proven()
    this.#quarantine.answered(station, answer)
  }

  #troubled({ station, step }, error, seen, facts) {
    if (facts.sent && (UNANSWERED.has(error.code) || isLineFailure(error))) {
      this.#quarantine.failed({ station, match: step.match, timeout: step.timeout, due: facts.due, seen })
    }
    if (error.code === 'TIMEOUT') this.#connection.check(++this.#silent)
    if (error.code === 'LINE_JAMMED') this.#jam(error)
    else if (isLineFailure(error)) this.#restart(error)
  }

  /** A port that takes no bytes is closed: else they would go out at some later time. */
  #restart(error) {
    this.#become('waiting', error)
    this.#rejectWaiting(error)
    this.#connection.restart(error)
  }

  // --- bytes that nobody asked for

  #data(bytes) {
    this.#recorder.stats.add('bytesIn', bytes.length)
    if (bytes.length > 0) this.#exchange.data(bytes)
  }

  #unclaimed(note, bytes) {
    this.#recorder.unclaimed(note, bytes)
    if (this.#state === 'open') this.#quarantine.offer(bytes)
  }

  #late({ station, lateness, timeout, bound }, frame) {
    this.#recorder.late(station, frame)
    const ms = Math.round(lateness)
    const remedy = `Station ${station} answers ${ms} ms after its ${timeout} ms timeout: raise the timeout.`
    this.emit('event', { event: 'late', station, lateness: ms, timeout, bound, since: this.#clock.wall(), remedy })
  }

  /** Nothing is sent into a flood; the first silence ends it. */
  #jam(error) {
    this.#become('jammed', error)
    const { remedy } = error
    this.emit('event', { event: 'jammed', station: null, since: this.#clock.wall(), cause: error.message, remedy })
    this.#rejectWaiting(error)
    this.#watchSilence()
  }

  #watchSilence() {
    const wait = Math.max(20, this.#times.gap)
    const rest = this.#exchange.quietSince + wait - this.#clock.now()
    if (rest > 0) this.#quiet = this.#clock.setTimer(() => this.#watchSilence(), rest)
    else this.#calm()
  }

  #calm() {
    this.#quiet = null
    this.#become('open', null)
    this.#pump()
  }

  #stopWatching() {
    this.#clock.clearTimer(this.#quiet)
    this.#quiet = null
  }
}

module.exports = { Line }
