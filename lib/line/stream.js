'use strict'

const { Flow, flowDifference, flowOptions } = require('./flow')
const { Outbox } = require('./outbox')
const { OwnEcho } = require('./own-echo')
const { copyOf } = require('./run')
const { Silence } = require('./silence')

/** A serial port is asked so often whether it is still there, ms: nobody who waits for an answer would notice. */
const WATCH = 5000

/**
 * A line that listens: bytes become messages by one framing, which all its listeners share; what is sent goes through the outbox.
 */
class Stream {
  #clock
  #settings
  #host
  #recorder
  #flow
  #outbox
  #echo
  #silence
  #watch = null
  #listeners = []
  /** @type {any} */
  #framing = null
  /** @type {any} */
  #splitter = null
  #lastByteAt = -Infinity
  #heard = 0
  /** whether the other side was last told to stop */
  #told = false

  /**
   * @param {{ name: string, clock: any, settings: any, times: any, recorder: any, memories: Map<any, any>,
   *   write: (bytes: Buffer, done: (error?: any) => void) => void, waiting: () => boolean }} parts
   * @param {{ refusal: () => any, rejection: () => any, isOpen: () => boolean, answered: () => void, troubled: (error: any) => void,
   *   check: () => void, use: import('./use').Use }} host the line
   */
  constructor(parts, host) {
    const { clock, settings, recorder } = parts
    this.#clock = clock
    this.#settings = settings
    this.#host = host
    this.#recorder = recorder
    this.#flow = new Flow(flowOptions(), { clock, settings })
    this.#echo = new OwnEcho(parts)
    const { refusal, troubled } = host
    // bytes that have come and wait to be looked at come now
    const lastByteAt = () => (parts.waiting() ? clock.now() : this.#lastByteAt)
    const sent = (bytes, end) => this.#echo.sent(bytes, end)
    this.#outbox = new Outbox(
      { ...parts, flow: this.#flow },
      { refusal, troubled, lastByteAt, heldUntil: () => this.#heldUntil, sent, heard: () => this.#heard }
    )
    this.#silence = new Silence({ clock, quietSince: lastByteAt })
  }

  /** Letters that wait. */
  get size() {
    return this.#outbox.size
  }

  /** When the last byte came or went, ms. */
  get quietSince() {
    return Math.max(this.#lastByteAt, this.#outbox.sendEnd)
  }

  // --- listeners

  /**
   * @param {any} lease @param {any} framing `{ key, create() }`
   * @param {{ onMessage: (message: any, facts: { at: number }) => any, options: any }} listener
   * @returns {{ close: () => void, pause: () => void, resume: () => void }}
   * @throws {PlcError} LINE_USE, BAD_SETTING
   */
  listen(lease, framing, { onMessage, options }) {
    const flow = new Flow(flowOptions(options), { clock: this.#clock, settings: this.#settings })
    const reason = this.#difference(framing, flow)
    const refusal = reason ? this.#host.use.conflict(lease, reason) : this.#host.use.claim('messages', lease)
    if (refusal) throw refusal
    if (!this.#framing) this.#begin(framing, flow)
    const listener = { lease, onMessage, paused: false }
    this.#listeners.push(listener)
    const pause = paused => {
      listener.paused = paused
      this.#tell()
    }
    return { close: () => this.#leave(listener), pause: () => pause(true), resume: () => pause(false) }
  }

  #difference(framing, flow) {
    if (!this.#framing) return ''
    if (this.#framing.key !== framing.key) return `different framings, ${this.#framing.key} and ${framing.key}`
    return flowDifference(this.#flow.options, flow.options)
  }

  #begin(framing, flow) {
    this.#splitter = framing.create()
    this.#framing = framing
    // what the other side said before holds
    flow.stoppedAt = flow.on ? this.#flow.stoppedAt : Infinity
    this.#flow = flow
    this.#outbox.use(flow)
    if (this.#settings.transport === 'serial') this.#look()
  }

  #look() {
    this.#watch = this.#clock.setTimer(() => {
      this.#host.check()
      this.#look()
    }, WATCH)
  }

  #leave(listener) {
    if (!this.#listeners.includes(listener)) return
    const { lease } = listener
    if (this.#listeners.length === 1 && this.#splitter) this.#finish()
    this.#listeners = this.#listeners.filter(one => one !== listener)
    this.#tell()
    const busy = this.#listeners.some(one => one.lease === lease) || this.#outbox.has(lease)
    if (!busy) this.#host.use.leave(lease)
  }

  /** Nobody will listen: what has come of a message is told, once. */
  #finish() {
    this.#silence.stop()
    this.#clock.clearTimer(this.#watch)
    const splitter = this.#splitter
    this.#splitter = null
    this.#framing = null
    this.#deliverAll(attempt(() => splitter.reset()))
  }

  /** Tells the other side to stop while one of the listeners is behind. */
  #tell() {
    const stop = this.#listeners.some(({ paused }) => paused)
    if (stop === this.#told || !this.#flow.on || !this.#host.isOpen()) return
    this.#told = stop
    this.#outbox.control(stop)
  }

  // --- bytes

  /** @param {Buffer} received @returns {number} messages that it completed */
  data(received) {
    this.#lastByteAt = this.#clock.now()
    this.#heard += received.length
    const own = this.#echo.look(received)
    if (own > 0) this.#recorder.echoed(received.subarray(0, own))
    const { stopped } = this.#flow
    const { bytes, stops } = this.#flow.take(received.subarray(own))
    if (stops > 0) this.#recorder.stats.add('stops', stops)
    if (this.#flow.stopped !== stopped) this.#outbox.changed()
    if (bytes.length === 0) return 0
    if (this.#splitter) return this.#split(() => this.#splitter.push(bytes))
    this.#recorder.unclaimed('stray', bytes)
    return 0
  }

  get #heldUntil() {
    const { held = 0, silence = 0 } = this.#splitter ?? {}
    return held > 0 && silence > 0 ? this.#lastByteAt + silence : -Infinity
  }

  #split(work) {
    const wasHeld = this.#heldUntil > -Infinity
    // a splitter that throws costs what it held, not the process
    const messages = attempt(work, () => attempt(() => this.#splitter.reset()))
    this.#deliverAll(messages)
    const splitter = this.#splitter
    if (splitter?.held > 0 && splitter.silence > 0) this.#silence.wait(splitter.silence, this.#flush)
    else this.#silence.stop()
    if (wasHeld && this.#heldUntil === -Infinity) this.#outbox.quieter()
    return messages.length
  }

  #flush = () => this.#deliverAll(attempt(() => this.#splitter?.flush() ?? []))

  #deliverAll(messages) {
    for (const message of messages) this.#deliver(message)
  }

  #deliver(message) {
    if (message.complete) this.#host.answered()
    if (this.#outbox.claims(message)) return
    this.#recorder.message(message)
    const at = this.#clock.wall()
    let reply = null
    for (const listener of [...this.#listeners]) {
      if (!this.#listeners.includes(listener)) continue
      const said = attempt(
        () => listener.onMessage(message, { at }),
        error => this.#recorder.failed(`a listener failed: ${error?.message ?? error}`)
      )
      if (!reply && Buffer.isBuffer(said)) reply = said
    }
    if (reply) this.#outbox.reply(reply)
  }

  // --- sending

  /** @param {any} lease @param {Buffer} bytes @param {any} options of `lease.send`, complete @returns {Promise<any>} */
  send(lease, bytes, options) {
    const refusal = this.#host.rejection() ?? this.#host.use.claim('messages', lease)
    if (refusal) return Promise.reject(copyOf(refusal, { sent: 0, of: bytes.length }))
    return this.#outbox.add(lease, bytes, options)
  }

  // --- the line's life

  opened() {
    const stop = this.#listeners.some(({ paused }) => paused)
    if (this.#flow.on && (stop || this.#told)) this.#outbox.control(stop)
    this.#told = stop
  }

  pump() {
    this.#outbox.pump()
  }

  /** The wire is gone: nothing more of what has begun will come. */
  lost() {
    this.#flow.reset()
    this.#echo.reset()
    this.#silence.stop()
    if (this.#splitter) this.#deliverAll(attempt(() => this.#splitter.reset()))
  }

  /** Nothing can be sent for this reason: all that waits ends. */
  fall(reason) {
    this.#outbox.rejectAll(reason)
  }

  /** A lease was released. */
  drop(lease, reason) {
    for (const listener of [...this.#listeners]) if (listener.lease === lease) this.#leave(listener)
    this.#outbox.drop(lease, reason)
  }

  /** The line is given up: what is on the wire may end. @returns {number} when it will have left, ms */
  stop(reason) {
    for (const listener of [...this.#listeners]) this.#leave(listener)
    return this.#outbox.stop(reason)
  }

  /** The port is closed now. */
  end(reason) {
    this.#outbox.rejectAll(reason)
  }
}

/** A fault of somebody else's code ends here. @param {() => any} work @param {(error: any) => any} [instead] */
const attempt = (work, instead = () => []) => {
  try {
    return work()
  } catch (error) {
    return instead(error)
  }
}

module.exports = { Stream }
