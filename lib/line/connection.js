'use strict'

const { PlcError } = require('../error')

const FIRST_DELAY = 250
const MOST_DELAY = 5000
/** To look for a name costs nothing, and it is there a moment before its rights: an adapter that was plugged in is found within this, ms. */
const MOST_LOOKING = 1000
const LOOKING = new Set(['PORT_NOT_FOUND', 'PORT_DENIED'])
/** A connection that lived this long (ms) was a good one: the next attempt comes soon. */
const STABLE = 5000
/** A transport that does not say that it has closed is given up after this, ms. */
const CLOSE_LIMIT = 800

/**
 * Keeps one wire open: a fresh transport for each attempt, back-off with jitter between them.
 * `told` = `{ opened(), data(bytes, at?), down(error, wasOpen) }`.
 */
class Connection {
  #clock
  #make
  #random
  #claims
  #told
  /** @type {any} */
  #transport = null
  #open = false
  #wanted = false
  #timer = null
  #delay = FIRST_DELAY
  #openedAt = 0
  #claimed = undefined
  #name
  /** @type {any} who waits for the end of a close that is under way; null: none is */
  #shutting = null

  /** @param {{ name: string, clock: any, make: () => any, random: () => number, claims: Claims, told: any }} options */
  constructor({ name, clock, make, random, claims, told }) {
    this.#name = name
    this.#clock = clock
    this.#make = make
    this.#random = random
    this.#claims = claims
    this.#told = told
  }

  get isOpen() {
    return this.#open
  }

  /** What the transport that is open claims; undefined: none is. */
  get id() {
    return this.#claimed
  }

  /** Opens now, and again whenever it is lost. */
  start() {
    this.#wanted = true
    this.#attempt()
  }

  #attempt() {
    this.#timer = null
    try {
      const transport = this.#make()
      const id = transport.id()
      this.#claims.take(id)
      this.#claimed = id
      this.#transport = transport
      transport.open(this.#handlers(transport))
    } catch (error) {
      this.#lost(error)
    }
  }

  /** A transport that was given up is not heard any more. */
  #handlers(transport) {
    const mine = fn => (value, at) => {
      if (this.#transport === transport) return fn(value, at)
    }
    return {
      opened: mine(() => this.#opened()),
      data: mine((bytes, at) => this.#told.data(bytes, at)),
      closed: mine(error => this.#lost(error)),
      failed: mine(error => this.#lost(error))
    }
  }

  #opened() {
    this.#open = true
    this.#openedAt = this.#clock.now()
    this.#told.opened()
  }

  #lost(error) {
    const wasOpen = this.#open
    if (wasOpen && this.#clock.now() - this.#openedAt >= STABLE) this.#delay = FIRST_DELAY
    this.#forget()
    this.#failed(error, wasOpen)
  }

  #forget() {
    this.#transport = null
    this.#open = false
    if (this.#claimed !== undefined) this.#claims.release(this.#claimed)
    this.#claimed = undefined
  }

  #failed(error, wasOpen = false) {
    if (this.#wanted) {
      const most = LOOKING.has(error?.code) ? MOST_LOOKING : MOST_DELAY
      const delay = this.#delay * (0.75 + 0.5 * this.#random())
      this.#delay = Math.min(most, this.#delay * 2)
      this.#timer = this.#clock.setTimer(() => this.#attempt(), Math.min(delay, most))
    }
    this.#told.down(error, wasOpen)
  }

  /** The other side answered: what comes next is a new fault. */
  proven() {
    this.#delay = FIRST_DELAY
  }

  /** @param {Buffer} bytes @param {(error?: any) => void} done */
  write(bytes, done) {
    if (!this.#open) return done(new PlcError('LINE_DOWN', { line: this.#name, reason: 'the port is not open' }))
    try {
      this.#transport.write(bytes, done)
    } catch (/** @type {any} */ cause) {
      // a port that fails in the call must not end the process, which may hold other lines
      done(new PlcError('PORT_ERROR', { path: this.#name, reason: cause?.message ?? String(cause), cause }))
    }
  }

  hint(count, at, once) {
    this.#transport?.hint(count, at, once)
  }

  /** Whether bytes have come that nobody has seen yet. */
  get waiting() {
    return this.#transport?.waiting ?? false
  }

  /** Asks the transport whether it is still there. @param {{ all: number, known: number }} missing see missing.js */
  check(missing) {
    this.#transport?.check?.(missing)
  }

  /** Closes what does not work any more, and starts again. */
  restart(error) {
    if (!this.#transport) return
    const wasOpen = this.#open
    this.#open = false
    this.#shut(() => this.#failed(error, wasOpen))
  }

  /** @param {() => void} done called once; the port is free then */
  stop(done) {
    this.#wanted = false
    this.#clock.clearTimer(this.#timer)
    this.#timer = null
    this.#open = false
    if (this.#transport || this.#shutting) this.#shut(done)
    else done()
  }

  #shut(done) {
    if (this.#shutting) return void this.#shutting.push(done)
    this.#shutting = [done]
    const transport = this.#transport
    // its late words concern nobody
    this.#transport = null
    const finish = () => {
      const waiting = this.#shutting
      if (!waiting) return
      this.#shutting = null
      this.#clock.clearTimer(limit)
      this.#forget()
      for (const told of waiting) told()
    }
    const limit = this.#clock.setTimer(finish, CLOSE_LIMIT)
    transport.close(once(finish))
  }
}

const once = fn => {
  let called = false
  return () => {
    if (called) return
    called = true
    fn()
  }
}

/**
 * @typedef {object} Claims
 * @property {(id: any) => void} take throws WIRE_IN_USE
 * @property {(id: any) => void} release
 */

module.exports = { Connection }
