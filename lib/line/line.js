'use strict'

const { EventEmitter } = require('node:events')
const { PlcError } = require('../error')
const { Condition } = require('./condition')
const { Connection } = require('./connection')
const { Driver } = require('./driver')
const { Echo } = require('./echo')
const { Exchange } = require('./exchange')
const { Quarantine } = require('./quarantine')
const { Recorder } = require('./recorder')
const { isLineFailure } = require('./run')
const { Scheduler } = require('./scheduler')
const { Silence } = require('./silence')
const { lineTimes } = require('./timing')

/** A frame that is being sent is never cut; nor is closing held up longer than this, ms. */
const MOST_SENDING = 1000
/** A jammed line is looked at so often at most, ms. */
const LEAST_CALM = 20

/**
 * One wire: joins who waits, who talks and how it opens, and is what others see of it.
 * Synchronous: everything happens inside a timer, the arrival of bytes, or a call; promises only at the edge.
 * Events: `state` (state, reason) and `event` ({ event, station, … }).
 */
class Line extends EventEmitter {
  #clock
  #settings
  #times
  #scheduler
  #quarantine
  #echo
  #exchange
  #driver
  #connection
  #recorder
  #condition
  #calm
  #grace = null
  #silent = 0

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
    const late = (fact, frame) => this.#late(fact, frame)
    const hasPast = settings.transport !== 'simulated'
    this.#quarantine = new Quarantine({ clock, memories, late, hasPast, freed: () => this.#driver.pump() })
    const readyAt = station => this.#quarantine.readyAt(station)
    this.#scheduler = new Scheduler({ clock, settings, readyAt, awake: () => this.#driver.pump() })
    this.#echo = new Echo(settings.echo)
    this.#exchange = new Exchange({ clock, settings, times: this.#times, echo: this.#echo, link: this.#link() })
    this.#calm = new Silence({ clock, quietSince: () => this.#exchange.quietSince })
    this.#condition = new Condition({ line: name, changed: (state, reason) => this.emit('state', state, reason) })
    this.#driver = this.#makeDriver()
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

  #makeDriver() {
    const parts = {
      exchange: this.#exchange,
      scheduler: this.#scheduler,
      quarantine: this.#quarantine,
      recorder: this.#recorder
    }
    const least = { gap: this.#times.gap, latenessBound: this.#settings.latenessBound }
    return new Driver(parts, least, {
      refusal: () => this.#condition.refusal(),
      answered: () => this.#answered(),
      troubled: error => this.#troubled(error),
      stray: bytes => this.#unclaimed('stray', bytes)
    })
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
    return this.#echo.state
  }

  /** Times of this wire in ms: `{ character, gap, slack }`. */
  get times() {
    return this.#times
  }

  /** Counters since the line was made; see docs/nodes.md. */
  stats() {
    return { ...this.#recorder.stats.snapshot(), waiting: this.#scheduler.size }
  }

  /** The last 200 frames, oldest first: `{ t, dir, station, bytes (hex), note }`. */
  trace() {
    return this.#recorder.trace.rows()
  }

  /** A plain object per station that survives redeploys; `bound` and `lateness` (ms) are the line's. */
  memory(station) {
    return this.#quarantine.memory(station)
  }

  /** Tells all who listen of something that was noticed: `{ event, station, cause, remedy, … }`. */
  report(event) {
    this.emit('event', { since: this.#clock.wall(), ...event })
  }

  // --- requests

  /**
   * @param {object} lease who asks
   * @param {() => Generator} make
   * @param {any} options of `lease.run`, complete
   * @returns {Promise<any>}
   */
  run(lease, make, options) {
    const rejection = this.#condition.rejection()
    if (rejection) return Promise.reject(rejection)
    const shared = this.#scheduler.shared(options.share)
    if (shared) {
      this.#recorder.stats.count('overruns', options.station)
      return shared.join(lease)
    }
    if (this.#scheduler.full) {
      this.#recorder.stats.count('queueFull')
      const most = this.#settings.queueLimit
      return Promise.reject(new PlcError('QUEUE_FULL', { line: this.name, most, sent: false }))
    }
    const late = limit => new PlcError('DEADLINE', { line: this.name, limit })
    const promise = this.#scheduler.add(make, options, late).join(lease)
    this.#driver.pump()
    return promise
  }

  /** A lease was released: what only it waits for ends. */
  drop(lease) {
    this.#driver.drop(lease, this.#condition.closed())
  }

  #answered() {
    this.#silent = 0
    this.#connection.proven()
  }

  #troubled(error) {
    if (error.code === 'TIMEOUT') this.#connection.check(++this.#silent)
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
    this.#echo.reset()
    this.#quarantine.opened()
    this.#condition.become('open')
    this.#driver.pump()
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
    this.#driver.breakOff(reason)
    this.#scheduler.rejectAll(reason)
  }

  #down(error, wasOpen) {
    if (this.#condition.closing) return
    if (wasOpen) this.#recorder.stats.count('reconnects')
    this.#fall(this.#condition.asReason(error))
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
    const sending = Math.min(MOST_SENDING, this.#exchange.sendEnd - this.#clock.now())
    this.#stopTimers()
    this.#scheduler.sleep()
    this.#scheduler.rejectAll(reason)
    this.#driver.stop(reason)
    const shut = () =>
      this.#connection.stop(() => {
        this.#condition.become('closed')
        done()
      })
    if (sending > 0 && this.#connection.isOpen) this.#clock.setTimer(shut, sending)
    else shut()
  }

  // --- bytes that nobody asked for

  #data(bytes) {
    this.#recorder.stats.add('bytesIn', bytes.length)
    if (bytes.length > 0) this.#exchange.data(bytes)
  }

  #unclaimed(note, bytes) {
    this.#recorder.unclaimed(note, bytes)
    if (this.#condition.state === 'open') this.#quarantine.offer(bytes)
  }

  #late({ station, lateness, timeout, bound }, frame) {
    this.#recorder.late(station, frame)
    const ms = Math.round(lateness)
    const remedy = `Station ${station} answers ${ms} ms after its ${timeout} ms timeout: raise the timeout.`
    this.report({ event: 'late', station, lateness: ms, timeout, bound, remedy })
  }

  /** Nothing is sent into a flood; the first silence ends it. */
  #jam(error) {
    this.#fall(error, 'jammed')
    const { message, remedy } = error
    this.report({ event: 'jammed', station: null, cause: message, remedy })
    this.#calm.wait(Math.max(LEAST_CALM, this.#times.gap), () => {
      this.#condition.become('open')
      this.#driver.pump()
    })
  }
}

module.exports = { Line }
