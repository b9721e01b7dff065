'use strict'
const { PlcError } = require('../error')
const { encodeFrame } = require('../codec/melsec/bidirectional')
const { bytesToValue, valueToBytes } = require('../codec/melsec/convert')
const { encodeMessage } = require('../codec/melsec/message')
const { realClock } = require('../line')
const { createAudit } = require('./audit')
const { asGivenError } = require('./failure')
const { readSettings } = require('./c24-settings')
const { C24Talk, outcomeOf } = require('./c24-talk')

const COUNTERS = [
  ...['received', 'incomplete', 'damaged', 'unheard', 'sent', 'confirmed', 'unknown', 'refused', 'failed'],
  ...['repeats', 'acksOut', 'naksOut', 'naksIn', 'strayAnswers', 'crossed']
]

/** Messages that are kept until somebody listens for the first time: a program makes the port before it listens. */
const MOST_EARLY = 100

/** The other end of a C24's port. Made by {@link createC24Port}. */
class C24Port {
  #lease
  #clock
  #settings
  #heard
  #talk
  #audit
  #listeners = new Set()
  /** @type {any[] | null} */
  #early = []
  #closed = false
  /** @type {Record<string, number>} */
  #counts = Object.fromEntries(COUNTERS.map(name => [name, 0]))

  /** @param {Record<string, any>} options of {@link createC24Port} */
  constructor({ lease, clock = realClock, ...given }) {
    const settings = readSettings(given, lease.line)
    this.#lease = lease
    this.#clock = clock
    this.#settings = settings
    this.#audit = createAudit({ line: lease.line, device: settings.name })
    this.#talk = settings.bidirectional ? new C24Talk({ lease, clock, settings, counts: this.#counts }) : null
    this.#heard = lease.listen(settings.framing, (message, { at }) => this.#take(message, at), settings.use)
  }

  get name() {
    return this.#settings.name
  }

  /**
   * Messages by what became of them: `received` (`incomplete` of these), `unheard` (nobody listened), `sent` `confirmed` `unknown` `refused` `failed`;
   * of the bidirectional protocol `damaged` frames, `repeats`, `crossed` (dropped: both sides sent at once), `acksOut` `naksOut` `naksIn` `strayAnswers`.
   */
  get stats() {
    return { ...this.#counts }
  }

  // --- receiving

  #take(message, at) {
    if (this.#talk) return this.#talk.hear(message, (whole, more) => this.#deliver(whole, { at, ...more }))
    return void this.#deliver(message, { at })
  }

  /** @returns {boolean} whether somebody listens */
  #deliver(message, { at, ...more }) {
    const told = { ...this.#told(message, at), ...more }
    if (this.#listeners.size === 0) {
      // what is not acknowledged comes again
      if (!this.#talk && this.#early && this.#early.length < MOST_EARLY) this.#early.push(told)
      else this.#counts.unheard++
      return false
    }
    this.#tell(told)
    return true
  }

  #tell(told) {
    this.#counts.received++
    if (!told.complete) this.#counts.incomplete++
    for (const callback of [...this.#listeners]) callback(told)
  }

  #told({ bytes, complete, reason, afterOpen }, timestamp) {
    const { value: form, format } = this.#settings
    const { value, text, valid } = bytesToValue(bytes, form)
    const count = format.unit === 'word' ? Math.ceil(bytes.length / 2) : bytes.length
    const damage = complete && !valid ? 'encoding' : reason
    return {
      value,
      text,
      bytes,
      count,
      complete: complete && valid,
      timestamp,
      ...(damage ? { reason: damage } : {}),
      ...(afterOpen ? { afterOpen } : {})
    }
  }

  /**
   * @param {(message: Received) => void} callback for each message that comes, whole or not; in the bidirectional protocol whole ones only
   * @returns {() => void} stop
   */
  listen(callback) {
    const own = message => callback(message)
    this.#listeners.add(own)
    const early = this.#early ?? []
    this.#early = null
    for (const told of early) this.#tell(told)
    return () => void this.#listeners.delete(own)
  }

  /** Tells the C24 to stop sending (flow `dc`): DC3. */
  pause() {
    this.#heard.pause()
  }

  /** Lets the C24 go on: DC1. */
  resume() {
    this.#heard.resume()
  }

  // --- sending

  /**
   * Sends one message, after those of earlier calls.
   * @param {unknown} value by the format: text or a number; an array of bytes; an array of words or one word. A Buffer as it is.
   * @param {{ deadline?: number, by?: import('./audit').By }} [options] deadline: ms that it may wait for its turn, 0: no limit; by: who asked, for the
   *   event `audit`
   * @returns {Promise<Outcome>} never rejects
   */
  async send(value, { deadline = this.#settings.deadline, by } = {}) {
    const start = this.#clock.now()
    const since = this.#clock.wall()
    const { error, ...outcome } = await this.#outcome(value, deadline)
    this.#counts[outcome.outcome]++
    const whole = { ...outcome, ms: this.#clock.now() - start }
    this.#audit.message(whole, { value, since, by, error })
    return whole
  }

  /**
   * Tells of a message that its owner does not let go out: the event `audit`, nothing else.
   * @param {unknown} value
   * @param {any} error why
   * @param {{ by?: import('./audit').By }} [options]
   */
  refused(value, error, { by } = {}) {
    const outcome = { outcome: 'refused', attempts: 0, bytes: 0, ms: 0 }
    this.#audit.message(outcome, { value, since: this.#clock.wall(), by, error })
  }

  /** @returns {Promise<Omit<Outcome, 'ms'> & { error?: any }>} */
  async #outcome(value, deadline) {
    const { line } = this.#lease
    const nothing = { attempts: 0, bytes: 0 }
    if (this.#closed) return outcomeOf('failed', new PlcError('LINE_CLOSED', { line: line.name }), nothing)
    let bytes
    try {
      bytes = this.#encode(value)
    } catch (error) {
      return outcomeOf('refused', asGivenError(error), nothing)
    }
    if (this.#talk) return this.#talk.send(bytes, deadline)
    try {
      const { quiet, after, name: label } = this.#settings
      await this.#lease.send(bytes, { quiet, after, deadline, label })
      return { outcome: 'sent', attempts: 1, bytes: bytes.length }
    } catch (/** @type {any} */ error) {
      const sent = Number(error?.details?.sent) || 0
      return outcomeOf(sent > 0 ? 'unknown' : 'failed', error, { attempts: sent > 0 ? 1 : 0, bytes: sent })
    }
  }

  #encode(value) {
    const { value: form, format, bidirectional } = this.#settings
    const body = valueToBytes(value, form)
    return bidirectional ? encodeFrame(body, format) : encodeMessage(body, format)
  }

  /** What waits is settled by the line, whose lease stays its owner's. */
  close() {
    this.#closed = true
    this.#talk?.close()
    this.#heard.close()
    this.#listeners.clear()
  }
}

/**
 * The port of a MELSEC-Q serial module (QJ71C24) on a line: free messages, or the bidirectional protocol. Times in ms, bytes in hexadecimal (`0D 0A`).
 *
 * @param {object} options
 * @param {any} options.lease of the line, from `pool.open`
 * @param {string} [options.name]
 * @param {'end'|'count'|'gap'} [options.framing] what ends a received message; `end` is also added to what is sent
 * @param {string} [options.end] 1 or 2 bytes, default `0D 0A`
 * @param {number} [options.count] bytes, for the framing count
 * @param {number} [options.gap] of silence: ends a message (framing gap), or gives up one that has begun; 0: none
 * @param {number} [options.most] bytes of a message, default 16384
 * @param {'text'|'bytes'|'words'} [options.format] of values
 * @param {'latin1'|'utf8'|'ascii'|'euc-kr'|'shift_jis'} [options.encoding] of text
 * @param {'word'|'byte'} [options.unit] of counts, as in the module
 * @param {boolean} [options.padEven] a zero byte behind an odd message
 * @param {'none'|'dc'|'driver'} [options.flow] DC1/DC3 by us, or the flow control of the line
 * @param {string} [options.transparent] the additional code, then codes that it makes transparent beside DC1 and DC3
 * @param {boolean} [options.asciiBinary] two hexadecimal characters a byte
 * @param {string} [options.first] user frame before each message
 * @param {string} [options.last] user frame behind it, in place of the end code
 * @param {number} [options.quiet] of silence on the line before a message goes out
 * @param {number} [options.timer0] that the module waits before it gives up a torn message: so long nothing follows one of ours
 * @param {boolean} [options.tornEnd] the end code goes out behind a torn message. The module then takes what was cut off for a message
 * @param {number} [options.room] bytes that the module takes after its stop, default 64
 * @param {number} [options.stallLimit] that a message may be stopped, default 30000
 * @param {number} [options.deadline] that a message may wait for its turn, default no limit
 * @param {boolean} [options.bidirectional] ENQ, length, data, sum; ACK or NAK
 * @param {boolean} [options.sumCheck] default true
 * @param {number} [options.ackTimeout] until the ACK, default 1000: at least two scans and 100 ms
 * @param {number} [options.attempts] of a message that is answered by NAK, default 3
 * @param {boolean} [options.repeatUnanswered] also one that is not answered: only for a program that knows a repetition. Default false
 * @param {'c24'|'us'|'both'} [options.priority] whose message counts if both send at once, as set in the module: `c24` transmission valid, reception
 *   invalid (ours is sent again); `us` the other way round (its message is dropped); `both` valid (the module's default)
 * @param {'mark'|'drop'} [options.repeats] what becomes of a frame that came twice: delivered with `repeated`, or dropped
 * @param {number} [options.repeatAfter] that the module at least waits for our ACK before its program repeats; default 0
 * @param {number} [options.repeatWithin] after which equal bytes are a new message, default 10000; 0: always
 * @param {any} [options.clock]
 * @returns {C24Port}
 * @throws {PlcError} BAD_SETTING, LINE_USE, LINE_CLOSED
 */
const createC24Port = options => new C24Port(options)

/**
 * @typedef {object} Received
 * @property {string | Buffer | number[]} value by the format
 * @property {string} text
 * @property {Buffer} bytes without end code, user frames and additional codes
 * @property {number} count words (rounded up) or bytes, by the unit
 * @property {boolean} complete one whole message, as far as can be known
 * @property {string} [reason] why it is not: `silence`, `closed`, `tooLong`, `notHex`, `odd`, `cut`, `stray`, `encoding`
 * @property {true} [afterOpen] the first one after the port was opened: its beginning may be missing
 * @property {true} [repeated] bidirectional: as far as can be known the same one as the one before
 * @property {number} timestamp epoch ms
 *
 * @typedef {object} Outcome
 * @property {'sent'|'confirmed'|'unknown'|'refused'|'failed'} outcome sent: every byte has left the port, nobody confirms it; confirmed: acknowledged;
 *   unknown: it was interrupted, or nothing answered; refused: before anything was sent, or by NAK; failed: nothing went out
 * @property {string} [code]
 * @property {string} [text]
 * @property {number} attempts frames that went out
 * @property {number} ms from the call to the outcome
 * @property {number} bytes that went out, of the last attempt
 */

module.exports = { C24Port, createC24Port }
