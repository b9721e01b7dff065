'use strict'

const { EventEmitter } = require('node:events')
const { causeOf } = require('../error')
const { Condition } = require('./condition')
const { Connection } = require('./connection')
const { Missing } = require('./missing')
const { Outage } = require('./outage')
const { Recorder } = require('./recorder')
const { Requests } = require('./requests')
const { isLineFailure } = require('./run')
const { Silence } = require('./silence')
const { Stream } = require('./stream')
const { lineTimes } = require('./timing')
const { Use } = require('./use')
const { timeoutFor } = require('./waits')

/** A frame that is being sent is never cut; nor is closing held up longer than this, ms. */
const MOST_SENDING = 1000
/** A jammed line is looked at so often at most, ms. */
const LEAST_CALM = 20

/**
 * One wire: joins who uses it (requests, or a stream of messages) and how it opens, and is what others see of it.
 * Synchronous: everything happens inside a timer, the arrival of bytes, or a call; promises only at the edge.
 * Events: `state` (state, reason), `event` ({ event, station, … }) and `frame` (row of the trace, whether it may grow).
 */
class Line extends EventEmitter {
  #clock
  #settings
  #times
  #use
  #requests
  #stream
  #connection
  #recorder
  #condition
  #outage
  #evidence
  #calm
  #grace = null
  #missing = new Missing()
  /** What those who poll expect to take of it; see load.js. @type {Set<() => import('./load').Load>} */
  loads = new Set()

  /**
   * @param {{ name: string, settings: any, clock: any, make: () => any, random: () => number, claims: any,
   *   memories: Map<any, any>, outage: { downAt: number | null }, evidence?: import('./evidence').Evidence | null }} options
   *   memories, outage, evidence: kept by the pool, by wire
   */
  constructor({ name, settings, clock, make, random, claims, memories, outage, evidence = null }) {
    super()
    this.setMaxListeners(0)
    this.name = name
    this.#clock = clock
    this.#settings = settings
    this.#times = lineTimes(settings)
    this.#evidence = evidence
    this.#recorder = new Recorder(clock, {
      frame: (row, grows) => this.#frame(row, grows),
      fault: (station, code) => evidence?.fault(station, code),
      good: station => evidence?.good(station)
    })
    this.#condition = new Condition({ line: name, changed: (state, reason) => this.#changed(state, reason) })
    this.#outage = new Outage({ clock, memory: outage, report: event => this.report(event) })
    this.#use = new Use(name)
    const parts = this.#parts(memories)
    this.#requests = new Requests(parts, { ...this.#host(), isOpen: () => this.#condition.state === 'open' })
    this.#stream = new Stream(parts, this.#host())
    const quietSince = () => Math.max(this.#requests.quietSince, this.#stream.quietSince)
    this.#calm = new Silence({ clock, quietSince })
    const told = {
      opened: () => this.#opened(),
      data: (bytes, at) => this.#data(bytes, at),
      down: (error, wasOpen) => this.#down(error, wasOpen)
    }
    this.#connection = new Connection({ name, clock, make, random, claims, told })
  }

  #frame(row, grows) {
    this.#evidence?.frame(row)
    this.emit('frame', row, grows)
  }

  #changed(state, reason) {
    this.emit('state', state, reason)
    this.#outage.became(state, reason)
  }

  #parts(memories) {
    return {
      name: this.name,
      clock: this.#clock,
      settings: this.#settings,
      times: this.#times,
      recorder: this.#recorder,
      memories,
      write: (bytes, done) => this.#connection.write(bytes, done),
      hint: (count, at, once) => this.#connection.hint(count, at, once),
      waiting: () => this.#connection.waiting
    }
  }

  #host() {
    return {
      refusal: () => this.#condition.refusal(),
      rejection: () => this.#condition.rejection(),
      isOpen: () => this.#connection.isOpen,
      use: this.#use,
      late: fact => this.#late(fact),
      answered: station => this.#answered(station),
      troubled: error => this.#troubled(error),
      check: () => this.#connection.check({ all: 0, known: 0 })
    }
  }

  /** @returns {'closed'|'opening'|'open'|'waiting'|'jammed'} */
  get state() {
    return this.#condition.state
  }

  /** Why it is waiting or jammed: a PlcError, or null. */
  get reason() {
    return this.#condition.reason
  }

  /** `unknown`, `present` or `absent`: whether the adapter hears what it sends. */
  get echo() {
    return this.#requests.echo
  }

  /** Times of this wire in ms: `{ character, gap, slack }`. */
  get times() {
    return this.#times
  }

  /** That of the serial driver: `none`, `rtscts`, `xonxoff`. */
  get flowControl() {
    return this.#settings.flowControl
  }

  /** Counters since the line was made; see docs/nodes.md. */
  stats() {
    return { ...this.#recorder.stats.snapshot(), waiting: this.#requests.size + this.#stream.size }
  }

  /** Grows with every byte that was not an answer. */
  get strays() {
    return this.#recorder.stats.strays
  }

  /** The last 200 frames, oldest first: `{ t, dir, station, bytes (hex), note }`. */
  trace() {
    return this.#recorder.trace.rows()
  }

  /** A plain object per station that survives redeploys; `bound` and `lateness` (ms) are the line's. */
  memory(station) {
    return this.#requests.memory(station)
  }

  /** Tells all who listen of something that was noticed: `{ event, station, cause, remedy, … }`. */
  report(event) {
    const whole = { ...event, since: event.since ?? this.#clock.wall() }
    this.#evidence?.event(whole)
    this.emit('event', whole)
  }

  // --- who uses it; see lease.js

  run(lease, make, options) {
    const refusal = this.#use.claim('requests', lease)
    return refusal ? Promise.reject(refusal) : this.#requests.run(lease, make, options)
  }

  listen(lease, framing, listener) {
    return this.#stream.listen(lease, framing, listener)
  }

  send(lease, bytes, options) {
    return this.#stream.send(lease, bytes, options)
  }

  /** A lease was released: what only it waits for ends. */
  drop(lease) {
    const reason = this.#condition.closed()
    this.#requests.drop(lease, reason)
    this.#stream.drop(lease, reason)
    this.#use.leave(lease)
  }

  #answered(station) {
    this.#missing.answered(station)
    this.#connection.proven()
  }

  #troubled(error) {
    if (error.code === 'TIMEOUT') this.#connection.check(this.#missing.missed(error.details.station))
    else if (error.code === 'LINE_JAMMED') this.#jam(error)
    else if (isLineFailure(error)) this.#restart(error)
  }

  // --- opening and closing

  open() {
    this.#condition.become('opening')
    this.#grace = this.#clock.setTimer(() => this.#fall(this.#condition.slow()), this.#settings.openGrace)
  }

  /** The port is free: the transport may open it. */
  connect() {
    if (!this.#condition.closing) this.#connection.start()
  }

  #opened() {
    this.#stopTimers()
    this.#missing.opened()
    this.#requests.opened(this.#connection.id)
    this.#stream.opened()
    this.#become('open')
  }

  #become(state) {
    this.#condition.become(state)
    this.#requests.pump()
    this.#stream.pump()
  }

  #stopTimers() {
    this.#clock.clearTimer(this.#grace)
    this.#calm.stop()
  }

  /**
   * Nothing can be sent for this reason: all that waits ends, so that nothing hangs.
   * @param {any} reason @param {'waiting'|'jammed'} [state]
   */
  #fall(reason, state = 'waiting') {
    this.#stopTimers()
    this.#condition.become(state, reason)
    this.#requests.fall(reason)
    this.#stream.fall(reason)
  }

  #down(error, wasOpen) {
    if (this.#condition.closing) return
    if (wasOpen) this.#recorder.stats.count('reconnects')
    this.#fall(this.#condition.asReason(error))
    if (wasOpen) this.#stream.lost()
  }

  /** A port that takes no bytes is closed: else they would go out at some later time. */
  #restart(error) {
    this.#fall(error)
    this.#connection.restart(error)
  }

  /** Ends all that waits, lets a frame on the wire end, closes the port. @param {() => void} done */
  close(done) {
    this.#condition.closing = true
    const reason = this.#condition.closed()
    this.#stopTimers()
    this.#requests.stop(reason)
    const end = Math.max(this.#requests.sendEnd, this.#stream.stop(reason))
    const sending = Math.min(MOST_SENDING, end - this.#clock.now())
    const shut = () => {
      this.#stream.end(reason)
      this.#connection.stop(() => {
        this.#condition.become('closed')
        done()
      })
    }
    if (sending > 0 && this.#connection.isOpen) this.#clock.setTimer(shut, sending)
    else shut()
  }

  // --- bytes and what was noticed

  /** @returns {number|undefined} how many messages it was, where the line listens */
  #data(bytes, at) {
    this.#recorder.stats.add('bytesIn', bytes.length)
    if (bytes.length === 0) return undefined
    if (this.#use.kind === 'messages') return this.#stream.data(bytes)
    this.#requests.data(bytes, at)
    return undefined
  }

  #late({ station, lateness, timeout, bound }) {
    // late, but it came: whatever brought it is not dead
    this.#answered(station)
    const ms = Math.round(lateness)
    const memory = this.memory(station)
    memory.advice = Math.max(memory.advice ?? 0, timeoutFor(timeout + ms))
    const cause = `Station ${station} answers ${ms} ms after its timeout of ${timeout} ms`
    const remedy = `Raise the timeout to ${memory.advice} ms.`
    this.report({ event: 'late', station, lateness: ms, timeout, bound, advice: memory.advice, cause, remedy })
  }

  /** Nothing is sent into a flood; the first silence ends it. */
  #jam(error) {
    this.#fall(error, 'jammed')
    this.report({ event: 'jammed', station: null, cause: causeOf(error), remedy: error.remedy })
    this.#calm.wait(Math.max(LEAST_CALM, this.#times.gap), () => {
      this.#become('open')
    })
  }
}

module.exports = { Line }
