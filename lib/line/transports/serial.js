'use strict'

const fs = require('node:fs')
const { PlcError } = require('../../error')
const { notAPort } = require('./device-file')
const { Intake } = require('./intake')
const { OpenPort } = require('./open-port')
const { Pace } = require('./pace')
const { pacedBinding } = require('./paced-binding')
const { goneError, openError } = require('./port-errors')

const flow = {
  none: {},
  rtscts: { rtscts: true },
  xonxoff: { xon: true, xoff: true }
}

const portOptions = ({ path, baudRate, dataBits, parity, stopBits, flowControl }) => ({
  path,
  baudRate,
  dataBits,
  parity,
  stopBits,
  ...flow[flowControl]
})

/** What DTR and RTS are to be after opening; null: as the system leaves them (both on). */
const signals = ({ dtr, rts }) => {
  if (dtr === 'unchanged' && rts === 'unchanged') return null
  return { dtr: dtr !== 'off', rts: rts !== 'off' }
}

/** The device behind a stable name; null: it leads nowhere. */
const deviceOf = path => {
  try {
    return fs.realpathSync(path)
  } catch {
    return null
  }
}

/** One port, opened once: the binding of serialport 13, read by wire time. */
class SerialTransport {
  #settings
  #clock
  #binding
  #pace
  #intake
  /** @type {any} */
  #port = null
  /** @type {any} */
  #handlers = null
  #delay = null
  #state = 'new'
  /** @type {any} */
  #device = null
  #closed = []
  #writes = new Set()

  constructor({ settings, clock, binding }) {
    this.#settings = settings
    this.#clock = clock
    this.#binding = binding
    this.#pace = new Pace(clock)
    this.#intake = new Intake({
      clock,
      data: (bytes, at) => this.#handlers.data(bytes, at),
      hold: held => this.#port.hold(held)
    })
  }

  /** What is claimed. A name that leads nowhere yet stands for itself. */
  id() {
    return deviceOf(this.#settings.path) ?? this.#settings.path
  }

  /** @throws {PlcError} BAD_SETTING: something else than a serial port stands there; nothing is opened */
  open(handlers) {
    const { path } = this.#settings
    const reason = notAPort(path)
    if (reason) throw new PlcError('BAD_SETTING', { setting: 'path', value: path, reason })
    // serialport is loaded when the first port is opened: a line over TCP needs no native code
    const { SerialPort } = require('serialport')
    this.#handlers = handlers
    this.#state = 'opening'
    this.#device = deviceOf(this.#settings.path)
    const binding = pacedBinding(this.#binding ?? SerialPort.binding, this.#pace)
    binding.open(portOptions(this.#settings)).then(
      port => {
        this.#port = new OpenPort(port, error => this.#lose(error))
        this.#setSignals()
      },
      error => this.#notOpened(error)
    )
  }

  #notOpened(error) {
    const wanted = this.#state === 'opening'
    this.#state = 'closed'
    if (wanted) this.#handlers.failed(openError(error, this.#settings.path))
    this.#tellClosed()
  }

  #setSignals() {
    const wanted = signals(this.#settings)
    if (this.#state !== 'opening') return this.#shut()
    if (!wanted) return this.#wait()
    this.#port.set(wanted, error => {
      if (this.#state !== 'opening') return this.#shut()
      if (!error) return this.#wait()
      this.#state = 'failing'
      this.#handlers.failed(openError(error, this.#settings.path))
      this.#shut()
    })
  }

  /** Converters that live on DTR and RTS need a moment. */
  #wait() {
    const { openDelay } = this.#settings
    if (openDelay > 0) this.#delay = this.#clock.setTimer(() => this.#ready(), openDelay)
    else this.#ready()
  }

  #ready() {
    this.#state = 'open'
    this.#port.read(bytes => this.#intake.take(bytes))
    this.#handlers.opened()
  }

  /** The port failed by itself, and is closed by now; or its name leads elsewhere. */
  #lose(error) {
    const was = this.#state
    this.#state = 'closing'
    this.#pace.stop()
    this.#intake.stop()
    const gone = goneError(error, this.#settings.path)
    for (const done of [...this.#writes]) done(gone)
    if (was === 'open') this.#handlers.closed(gone)
    if (this.#port.isOpen) this.#shut()
    else if (!this.#port.closing) this.#free()
  }

  write(bytes, done) {
    const { path } = this.#settings
    // a write to a closed port never calls back, and its bytes would go out at a later open
    if (this.#state !== 'open' || !this.#port.isOpen) return done(new PlcError('PORT_GONE', { path }))
    const finish = error => {
      if (!this.#writes.delete(finish)) return
      done(error ? goneError(error, path) : undefined)
    }
    this.#writes.add(finish)
    this.#port.write(bytes, finish)
  }

  hint(_count, at, once) {
    this.#pace.hint(at, once)
  }

  /** Whether bytes have come that nobody has seen yet: the wire is not silent then. */
  get waiting() {
    return this.#intake.waiting
  }

  /** A request was not answered: is the port still there, or has the system not told that it went? */
  check() {
    if (!this.#device || this.#state !== 'open') return
    fs.realpath(this.#settings.path, (error, device) => {
      if (this.#state !== 'open' || (!error && device === this.#device)) return
      if (!error || error.code === 'ENOENT') this.#lose(error)
    })
  }

  close(done) {
    this.#closed.push(done)
    this.#clock.clearTimer(this.#delay)
    const was = this.#state
    if (was === 'closed' || was === 'new') return this.#tellClosed()
    this.#state = 'closing'
    this.#pace.stop()
    this.#intake.stop()
    this.#writes.clear()
    this.#shut()
  }

  #shut() {
    if (this.#port?.isOpen) this.#port.close(() => this.#free())
  }

  #free() {
    this.#state = 'closed'
    this.#tellClosed()
  }

  #tellClosed() {
    const waiting = this.#closed
    this.#closed = []
    for (const done of waiting) done()
  }
}

/**
 * A factory of serial transports over a given binding.
 * @param {{ binding?: any }} [options] default: the binding of this operating system
 */
const serialOver =
  ({ binding = null } = {}) =>
  (settings, clock) =>
    new SerialTransport({ settings, clock, binding })

module.exports = { serial: serialOver(), serialOver }
