'use strict'

const { PlcError } = require('../error')
const { Aftermath } = require('./aftermath')
const { Alarm } = require('./alarm')
const { Courier } = require('./courier')
const { DC1, DC3 } = require('./flow')
const { Letter } = require('./letter')
const { Silence } = require('./silence')

const TOLERANCE = 0.001
const MOST_REPLIES = 16

/**
 * What goes out on a listening line: one letter at a time, in order; replies to what came (ACK, NAK) before all that waits.
 * Synchronous: everything happens in a timer, the arrival of bytes, or a call.
 */
class Outbox {
  #name
  #clock
  #settings
  #character
  #host
  #recorder
  #aftermath
  #flow
  #courier
  #silence
  #alarm
  #queue = []
  /** @type {any} the letter whose turn it is */
  #letter = null
  #replies = []

  /**
   * @param {any} parts of the line, see stream.js; `flow`: how it is used at first
   * @param {{ refusal: () => any, troubled: (error: any) => void, lastByteAt: () => number, heldUntil: () => number,
   *   heard: () => number, sent: (bytes: Buffer, end: number) => void }} host heard: bytes that came in all; heldUntil: when a message that is
   *   coming will be torn
   */
  constructor(parts, host) {
    const { name, clock, settings, times, recorder, memories, flow } = parts
    this.#name = name
    this.#clock = clock
    this.#settings = settings
    this.#character = times.character
    this.#recorder = recorder
    this.#aftermath = new Aftermath(clock, memories)
    this.#flow = flow
    this.#host = host
    this.#courier = new Courier(parts, {
      sent: host.sent,
      handedOver: () => this.#sendReplies(),
      ended: (error, answer) => this.#ended(error, answer),
      failed: error => this.#fail(error),
      stopped: () => this.#stall()
    })
    this.#alarm = new Alarm(clock)
    this.#silence = new Silence({ clock, quietSince: () => Math.max(this.sendEnd, this.#heardUntil()) })
  }

  /** How the line is used has been decided. @param {import('./flow').Flow} flow */
  use(flow) {
    this.#flow = flow
    this.#courier.use(flow)
  }

  get sendEnd() {
    return this.#courier.sendEnd
  }

  /** Letters that wait for their turn. */
  get size() {
    return this.#queue.length
  }

  /** Whether this lease has something to send. */
  has(lease) {
    return this.#letter?.lease === lease || this.#queue.some(letter => letter.lease === lease)
  }

  /** @param {any} lease @param {Buffer} bytes @param {any} options of `lease.send` @returns {Promise<any>} */
  add(lease, bytes, options) {
    const most = this.#settings.queueLimit
    const letter = new Letter(lease, { bytes, options, now: this.#clock.now() })
    if (this.#queue.length >= most) {
      this.#recorder.stats.count('queueFull')
      letter.reject(new PlcError('QUEUE_FULL', { line: this.#name, most }), 0)
      return letter.promise
    }
    this.#queue.push(letter)
    const { deadline } = options
    if (deadline > 0) letter.deadlineTimer = this.#clock.setTimer(() => this.#tooLate(letter, deadline), deadline)
    this.pump()
    return letter.promise
  }

  #tooLate(letter, limit) {
    if (letter === this.#letter) this.#idle()
    else this.#queue = this.#queue.filter(one => one !== letter)
    this.#settle(letter, new PlcError('DEADLINE', { line: this.#name, limit }))
    this.pump()
  }

  // --- waiting for the turn

  /** Lets the next one go, if nothing is on its way. */
  pump() {
    if (this.#letter || this.#queue.length === 0 || this.#host.refusal()) return
    this.#letter = this.#queue.shift()
    this.#wait()
  }

  /** Until it may begin: time since what went out before, the other side's leave, and silence. */
  #wait() {
    const letter = this.#letter
    this.#silence.stop()
    this.#alarm.stop()
    const from = this.#aftermath.until(this.#flow.options.torn)
    if (this.#clock.now() < from - TOLERANCE) return this.#alarm.set(from, () => this.#wait())
    if (this.#flow.stopped) return this.#stall()
    if (letter.waitsFrom === null) {
      letter.waitsFrom = this.#clock.now()
      letter.heard = this.#host.heard()
    }
    this.#silence.wait(
      letter.quiet,
      () => this.#begin(),
      now => this.#isJammed(now)
    )
  }

  /**
   * Adapters deliver in pieces: the pauses between them are no silence of the wire. So who waits for silence waits for the rest of a message, too.
   */
  #heardUntil() {
    const { lastByteAt, heldUntil } = this.#host
    return this.#letter?.quiet > 0 ? Math.max(lastByteAt(), heldUntil()) : lastByteAt()
  }

  /** A message that was coming has ended. */
  quieter() {
    if (this.#letter?.waits) this.#wait()
  }

  /** The other side takes nothing: who waits too long for that ends with a code. */
  #stall() {
    const { stallLimit } = this.#flow.options
    this.#alarm.set(this.#letter.stallsAt(this.#flow.stoppedAt, stallLimit), () => {
      this.#ended(new PlcError('WRITE_STALLED', { line: this.#name, limit: stallLimit }), null)
    })
  }

  /** Half duplex: nothing is sent into a flood. */
  #isJammed(now) {
    const { waitsFrom, heard } = this.#letter
    const bytes = this.#host.heard() - heard
    if (now - waitsFrom < Math.max(this.#settings.jamTime, this.#flow.options.stallLimit) || bytes === 0) return false
    this.#fail(new PlcError('LINE_JAMMED', { line: this.#name, bytes }))
    return true
  }

  #begin() {
    const letter = this.#letter
    const before = this.#aftermath.first(this.#flow.options.torn)
    if (before && this.#flow.options.torn.apart) return this.#endTorn(before, letter)
    this.#clock.clearTimer(letter.deadlineTimer)
    this.#aftermath.over()
    this.#courier.start(letter, before)
  }

  /** Where the other side needs a pause to see that the torn one is over. */
  #endTorn(first, letter) {
    this.#aftermath.end()
    this.#courier.put(first, 'torn')
    if (this.#letter !== letter) return
    this.#aftermath.pause(this.sendEnd + letter.after)
    this.#wait()
  }

  /** The other side has said stop, or that it goes on. */
  changed() {
    if (!this.#flow.stopped) {
      this.#alarm.stop()
      if (!this.#courier.inside) this.#sendReplies()
    }
    if (this.#letter?.waits) this.#wait()
    else if (this.#courier.inside) this.#courier.advance()
  }

  // --- replies and the like

  /** Bytes that go out before all that waits, without waiting for silence; never inside a letter. @param {Buffer} bytes */
  reply(bytes) {
    // where the port keeps them they would all come at once, and late: each could be taken for that of another message
    if (bytes.length === 0 || this.#host.refusal() || this.#courier.kept >= MOST_REPLIES) return
    this.#replies.push(Buffer.from(bytes))
    if (this.#replies.length > MOST_REPLIES) this.#replies.shift()
    if (!this.#courier.inside && !this.#flow.stopped) this.#sendReplies()
  }

  #sendReplies() {
    const replies = this.#replies
    this.#replies = []
    for (const bytes of replies) this.#courier.put(bytes, 'reply')
  }

  /** Tells the other side to stop or to go on: at once, also between two pieces of a letter. @param {boolean} stop */
  control(stop) {
    this.#courier.put(Buffer.of(stop ? DC3 : DC1), stop ? 'DC3' : 'DC1')
  }

  /**
   * Whether this message is the one that a letter awaits, or awaited: nobody else gets it.
   * @param {any} message @returns {boolean}
   */
  claims(message) {
    try {
      if (this.#courier.claims(message)) return true
    } catch (error) {
      // a recogniser that throws ends its own letter, not the process
      this.#ended(error, null)
    }
    return this.#isLate(message)
  }

  #isLate(message) {
    if (!this.#aftermath.isLate(message)) return false
    this.#recorder.late(null, message.bytes)
    if (this.#letter?.waits) this.#wait()
    return true
  }

  // --- ends

  /** The wire is at fault. */
  #fail(error) {
    const letter = this.#letter
    this.#idle()
    if (letter) this.#settle(letter, error)
    this.#host.troubled(error)
    this.pump()
  }

  #ended(error, answer) {
    const letter = this.#letter
    this.#idle()
    this.#settle(letter, error, answer)
    if (error?.code === 'TIMEOUT') this.#host.troubled(error)
    this.pump()
  }

  #idle() {
    this.#silence.stop()
    this.#alarm.stop()
    this.#courier.stop()
    this.#letter = null
  }

  #settle(letter, error, answer) {
    const now = this.#clock.now()
    this.#clock.clearTimer(letter.deadlineTimer)
    if (letter.piece) this.#aftermath.pause(letter.piece.end + letter.after)
    if (!error) return letter.resolve(now, answer)
    this.#aftermath.expect(letter)
    if (letter.isTorn(now, this.#character)) {
      this.#aftermath.tear()
      this.#recorder.stats.count('tornWrites')
    }
    if (!letter.waits) this.#recorder.letterFailed(error)
    letter.reject(error, letter.sent(now, this.#character))
  }

  /** All that waits or is under way ends. @param {any} reason */
  rejectAll(reason) {
    const letters = this.#letter ? [this.#letter, ...this.#queue] : this.#queue
    this.#queue = []
    this.#replies = []
    this.#aftermath.lost()
    this.#idle()
    this.#courier.forget()
    for (const letter of letters) this.#settle(letter, reason)
  }

  /** What this lease waits for ends. @param {any} lease @param {any} reason */
  drop(lease, reason) {
    const mine = this.#queue.filter(letter => letter.lease === lease)
    this.#queue = this.#queue.filter(letter => letter.lease !== lease)
    for (const letter of mine) this.#settle(letter, reason)
    if (this.#letter?.lease === lease) this.#abandon(this.#letter, reason)
    this.pump()
  }

  /** Nobody waits for the letter any more; what is on the wire is not cut. */
  #abandon(letter, reason) {
    if (letter.waits || letter.left) {
      this.#idle()
      return this.#settle(letter, reason)
    }
    this.#aftermath.expect(letter)
    letter.reject(reason, letter.given)
    letter.abandoned()
  }

  /** The line is given up. @param {any} reason @returns {number} when what is on the wire will have left, ms */
  stop(reason) {
    const waiting = this.#queue
    this.#queue = []
    for (const letter of waiting) this.#settle(letter, reason)
    if (this.#letter) this.#abandon(this.#letter, reason)
    const letter = this.#letter
    const rest = letter ? letter.piece.end + (letter.wire.length - letter.out) * this.#character : -Infinity
    return Math.max(this.sendEnd, rest)
  }
}

module.exports = { Outbox }
