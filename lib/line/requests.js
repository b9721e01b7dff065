'use strict'

const { PlcError } = require('../error')
const { Driver } = require('./driver')
const { Echo } = require('./echo')
const { Exchange } = require('./exchange')
const { Quarantine } = require('./quarantine')
const { Scheduler } = require('./scheduler')

/** A line that asks: conversations one after the other, their queue, and who must not be asked yet. */
class Requests {
  #name
  #settings
  #host
  #recorder
  #scheduler
  #quarantine
  #echo
  #exchange
  #driver

  /**
   * @param {{ name: string, clock: any, settings: any, times: any, recorder: any, memories: Map<any, any>,
   *   write: (bytes: Buffer, done: (error?: any) => void) => void, waiting: () => boolean,
   *   hint: (count: number, at: number, once?: boolean) => void }} parts
   * @param {{ refusal: () => any, rejection: () => any, isOpen: () => boolean, late: (fact: any) => void, answered: (station: any) => void,
   *   troubled: (error: any) => void }} host the line
   */
  constructor({ name, clock, settings, times, recorder, memories, write, hint, waiting }, host) {
    this.#name = name
    this.#settings = settings
    this.#host = host
    this.#recorder = recorder
    recorder.stats.remember(memories)
    const late = (fact, frame) => this.#late(fact, frame)
    const awake = () => this.#driver.pump()
    const hasPast = settings.transport !== 'simulated'
    this.#quarantine = new Quarantine({ clock, memories, late, hasPast, freed: awake })
    this.#scheduler = new Scheduler({ clock, settings, readyAt: station => this.#quarantine.readyAt(station), awake })
    this.#echo = new Echo(settings.echo, () => clock.now())
    const stray = bytes => this.#unclaimed('stray', bytes)
    const skipped = bytes => this.#unclaimed('skipped', bytes)
    const link = { name, write, hint, waiting, stray, skipped, echoed: bytes => recorder.echoed(bytes) }
    this.#exchange = new Exchange({ clock, settings, times, echo: this.#echo, link })
    const parts = { exchange: this.#exchange, scheduler: this.#scheduler, quarantine: this.#quarantine, recorder }
    const { refusal, answered, troubled } = host
    const least = { gap: times.gap, latenessBound: settings.latenessBound }
    this.#driver = new Driver(parts, least, { refusal, answered, troubled, stray })
  }

  get echo() {
    return this.#echo.state
  }

  /** The computed end of what is being sent, ms. */
  get sendEnd() {
    return this.#exchange.sendEnd
  }

  /** When the last byte came or went, ms. */
  get quietSince() {
    return this.#exchange.quietSince
  }

  get size() {
    return this.#scheduler.size
  }

  memory(station) {
    return this.#quarantine.memory(station)
  }

  /**
   * @param {object} lease who asks
   * @param {() => Generator} make
   * @param {any} options of `lease.run`, complete
   * @returns {Promise<any>}
   */
  run(lease, make, options) {
    const rejection = this.#host.rejection()
    if (rejection) return Promise.reject(rejection)
    const shared = this.#scheduler.shared(options.share)
    if (shared) {
      this.#recorder.stats.count('overruns', options.station)
      return shared.join(lease)
    }
    if (this.#scheduler.full) {
      this.#recorder.stats.count('queueFull')
      const most = this.#settings.queueLimit
      return Promise.reject(new PlcError('QUEUE_FULL', { line: this.#name, most, sent: false }))
    }
    const promise = this.#scheduler.add(make, options, this.#tooLate).join(lease)
    this.#driver.pump()
    return promise
  }

  #tooLate = limit => new PlcError('DEADLINE', { line: this.#name, limit })

  /** Lets the next one go, if the wire is free. */
  pump() {
    this.#driver.pump()
  }

  /** A lease was released: what only it waits for ends. */
  drop(lease, reason) {
    this.#driver.drop(lease, reason)
  }

  /** @param {unknown} id what the transport claims */
  opened(id) {
    this.#echo.reset()
    this.#exchange.opened(id)
    this.#quarantine.opened()
  }

  /** Nothing can be sent for this reason: all that waits ends. */
  fall(reason) {
    this.#driver.breakOff(reason)
    this.#scheduler.rejectAll(reason)
  }

  /** The line is given up. */
  stop(reason) {
    this.#scheduler.sleep()
    this.#scheduler.rejectAll(reason)
    this.#driver.stop(reason)
  }

  /** @param {Buffer} bytes @param {number} [at] when they came, ms of the clock */
  data(bytes, at) {
    this.#exchange.data(bytes, at)
  }

  #unclaimed(note, bytes) {
    this.#recorder.unclaimed(note, bytes)
    if (this.#host.isOpen()) this.#quarantine.offer(bytes)
  }

  #late(fact, frame) {
    this.#recorder.late(fact.station, frame)
    this.#host.late(fact)
  }
}

module.exports = { Requests }
