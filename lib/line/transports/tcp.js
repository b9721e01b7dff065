'use strict'

const net = require('node:net')
const { PlcError } = require('../../error')
const { Intake } = require('./intake')

const CLOSE_LIMIT = 300
/** So many requests in a row that stations left unanswered which had answered before: the connection is half-open. */
const LOST = 3
/** Of stations that have not answered yet; then after twice as many, … */
const SILENT = 5
const MOST_SILENT = 160
/** A connection on which nothing was heard for so long (ms) is not kept because requests are rare. */
const LONG = 600000
/** Nor one on which nothing was ever heard: the serial server may have taken it while it was about to stop. */
const UNHEARD = 60000

const REASONS = {
  ECONNREFUSED: 'nothing listens there',
  EHOSTUNREACH: 'the host cannot be reached',
  ENETUNREACH: 'the network cannot be reached',
  ENOTFOUND: 'the name of the host is not known',
  EAI_AGAIN: 'the name of the host cannot be resolved now',
  ECONNRESET: 'the other side broke it off',
  ETIMEDOUT: 'no answer'
}

/** 5, 10, 20, … : a line whose stations are all off is not reconnected for ever. */
const isSuspicious = silent => {
  for (let count = SILENT; count <= MOST_SILENT; count *= 2) if (silent === count) return true
  return silent > MOST_SILENT && silent % MOST_SILENT === 0
}

/** One connection to a serial server, or to anything else that carries the bytes of the line over TCP. */
class TcpTransport {
  #settings
  #clock
  #path
  /** @type {any} */
  #socket = null
  /** @type {any} */
  #handlers = null
  /** @type {any} */
  #intake = null
  #timer = null
  #open = false
  #ended = false
  #heardAt = 0
  #heard = false

  constructor(settings, clock) {
    this.#settings = settings
    this.#clock = clock
    this.#path = `${settings.host}:${settings.port}`
  }

  id() {
    return this.#path.toLowerCase()
  }

  open(handlers) {
    const { host, port, keepAlive, connectTimeout } = this.#settings
    const socket = net.connect({ host, port, noDelay: true })
    this.#socket = socket
    this.#handlers = handlers
    if (keepAlive > 0) socket.setKeepAlive(true, keepAlive)
    this.#timer = this.#clock.setTimer(() => this.#lose(`no connection within ${connectTimeout} ms`), connectTimeout)
    socket.once('connect', () => this.#opened())
    this.#intake = new Intake({
      clock: this.#clock,
      data: handlers.data,
      hold: held => (held ? socket.pause() : socket.resume())
    })
    socket.on('data', bytes => {
      if (this.#ended) return
      this.#heardAt = this.#clock.now()
      this.#heard = true
      this.#intake.take(bytes)
    })
    socket.on('error', error => this.#lose(REASONS[error['code']] ?? error.message))
    socket.on('end', () => this.#lose('the serial server closed the connection'))
    socket.on('close', () => this.#lose('the connection was closed'))
  }

  #opened() {
    if (this.#ended) return
    this.#clock.clearTimer(this.#timer)
    this.#open = true
    this.#heardAt = this.#clock.now()
    this.#handlers.opened()
  }

  #lose(reason) {
    if (this.#ended) return
    this.#end()
    this.#socket.destroy()
    if (this.#open) this.#handlers.closed(this.#broken(reason))
    else this.#handlers.failed(new PlcError('CONNECT_FAILED', { path: this.#path, reason }))
  }

  /** Nothing more is heard. */
  #end() {
    this.#ended = true
    this.#clock.clearTimer(this.#timer)
    this.#intake?.stop()
  }

  #broken(reason) {
    return new PlcError('LINE_DOWN', { line: this.#path, reason })
  }

  write(bytes, done) {
    if (!this.#open || this.#ended) return done(this.#broken('the connection is not open'))
    this.#socket.write(bytes, error => done(error ? this.#broken(error.message) : undefined))
  }

  /** Nothing is known before the bytes come: the network has its own time. */
  hint() {}

  /** Whether bytes have come that nobody has seen yet: the wire is not silent then. */
  get waiting() {
    return this.#intake?.waiting ?? false
  }

  /** @param {{ all: number, known: number }} missing see missing.js */
  check({ all, known }) {
    const long = all > 0 && this.#clock.now() - this.#heardAt >= (this.#heard ? LONG : UNHEARD)
    if (known < LOST && !isSuspicious(all) && !long) return
    this.#lose(`${all} requests in a row without an answer: the connection is dead`)
  }

  close(done) {
    const socket = this.#socket
    const wasOpen = this.#open && !this.#ended
    this.#end()
    if (!socket || socket.closed) return done()
    socket.once('close', () => {
      this.#clock.clearTimer(this.#timer)
      done()
    })
    if (!wasOpen) return socket.destroy()
    // what was written goes out before the connection ends
    this.#timer = this.#clock.setTimer(() => socket.destroy(), CLOSE_LIMIT)
    socket.end(() => socket.destroy())
  }
}

/**
 * @param {any} settings normalised: host, port, connectTimeout, keepAlive
 * @param {import('../clock').Clock} clock
 */
const tcp = (settings, clock) => new TcpTransport(settings, clock)

module.exports = { tcp }
