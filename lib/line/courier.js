'use strict'

const { PlcError } = require('../error')
const { Alarm } = require('./alarm')

const TOLERANCE = 0.001

/**
 * Carries one letter at a time over the wire: its pieces, each after the one before has left by the wire's time, then its answer.
 * The only one who writes to the port of a listening line.
 */
class Courier {
  #name
  #clock
  #settings
  #character
  #recorder
  #write
  #host
  #flow
  #alarm
  #sendEnd = -Infinity
  /** @type {import('./letter').Letter|null} the one on the wire */
  #letter = null
  /** what is no letter and was not taken by the port yet */
  #kept = new Set()

  /**
   * @param {any} parts of the line, see stream.js
   * @param {{ sent: (bytes: Buffer, end: number) => void, handedOver: () => void, ended: (error: any, answer: any) => void,
   *   failed: (error: any) => void, stopped: () => void }} host
   *   handedOver: the port has all of the letter; failed: the wire is at fault; stopped: the other side takes nothing, it is asked to go on by
   *   `advance`
   */
  constructor({ name, clock, settings, times, recorder, write, flow }, host) {
    this.#name = name
    this.#clock = clock
    this.#settings = settings
    this.#character = times.character
    this.#recorder = recorder
    this.#write = write
    this.#flow = flow
    this.#host = host
    this.#alarm = new Alarm(clock)
  }

  /** How the line is used has been decided. @param {import('./flow').Flow} flow */
  use(flow) {
    this.#flow = flow
  }

  /** When all that was given to the port has left, ms. */
  get sendEnd() {
    return this.#sendEnd
  }

  /** In the middle of a letter: nothing else may come in between. */
  get inside() {
    return this.#letter !== null && !this.#letter.handedOver
  }

  /**
   * @param {any} letter @param {Buffer|null} before what ends a torn one, if that is wanted
   */
  start(letter, before) {
    this.#letter = letter
    letter.begin(this.#clock.now(), before)
    this.#recorder.letter(letter.wire, letter.label)
    this.#piece(letter)
  }

  /** The letter ends without the wire. */
  stop() {
    this.#alarm.stop()
    this.#letter = null
  }

  /** Bytes that are no letter. @param {Buffer} bytes @param {string} note */
  put(bytes, note) {
    this.#recorder.letter(bytes, note)
    const kept = this.#kept
    const own = {}
    kept.add(own)
    this.#give(bytes, error => {
      // what an earlier connection says of its bytes concerns nobody
      if (kept.delete(own) && error && kept === this.#kept) this.#host.failed(error)
    })
  }

  /** How often the port has not taken what is no letter. */
  get kept() {
    return this.#kept.size
  }

  /** The port is given up, with all that it keeps. */
  forget() {
    this.#kept = new Set()
  }

  #give(bytes, done) {
    this.#sendEnd = Math.max(this.#sendEnd, this.#clock.now()) + bytes.length * this.#character
    this.#recorder.stats.add('bytesOut', bytes.length)
    this.#host.sent(bytes, this.#sendEnd)
    this.#write(bytes, done)
  }

  #piece(letter) {
    const now = this.#clock.now()
    const from = letter.out
    letter.out = this.#flow.pieceEnd(letter.wire, from)
    const bytes = letter.wire.subarray(from, letter.out)
    const at = Math.max(now, this.#sendEnd)
    letter.piece = { at, from, end: at + bytes.length * this.#character, taken: false }
    letter.writing = true
    this.#give(bytes, error => this.#taken(letter, error))
    letter.writing = false
    if (this.#letter !== letter) return
    if (letter.handedOver) this.#host.handedOver()
    if (this.#letter === letter) this.advance()
  }

  #taken(letter, error) {
    if (this.#letter !== letter || letter.piece.taken) return
    if (error) return this.#host.failed(error)
    const { piece } = letter
    const now = this.#clock.now()
    piece.taken = true
    // where the port had to wait
    piece.end = Math.max(piece.end, now)
    this.#sendEnd = Math.max(this.#sendEnd, now)
    if (!letter.writing) this.advance()
  }

  /** What comes next: the rest of the piece, the next piece, or the end. */
  advance() {
    const letter = this.#letter
    if (!letter || letter.left) return
    const { piece } = letter
    if (this.#clock.now() < piece.end - TOLERANCE) return this.#alarm.set(piece.end, () => this.advance())
    if (!piece.taken) return this.#alarm.set(piece.end + this.#patience(), () => this.#stuck())
    if (letter.handedOver) return this.#left(letter)
    if (this.#flow.stopped) {
      this.#alarm.stop()
      return this.#host.stopped()
    }
    this.#piece(letter)
  }

  /** How long the port may keep bytes: with flow control by the driver it is the other side that decides. */
  #patience() {
    const { flowControl, writeTimeout } = this.#settings
    return flowControl === 'none' ? writeTimeout : this.#flow.options.stallLimit
  }

  #stuck() {
    this.#host.failed(new PlcError('WRITE_STALLED', { line: this.#name }))
  }

  /** The last byte has left. */
  #left(letter) {
    letter.left = true
    this.#recorder.letterSent(this.#clock.now() - letter.at)
    if (!letter.match || letter.answer) return this.#host.ended(null, letter.answer)
    const { timeout } = letter
    const error = new PlcError('TIMEOUT', { station: letter.label || this.#name, timeout })
    this.#alarm.set(letter.piece.end + timeout, () => this.#host.ended(error, null))
  }

  /** Whether this message answers the letter on the wire. @param {any} message */
  claims(message) {
    const letter = this.#letter
    if (!letter?.match || !letter.handedOver || letter.answer) return false
    if (!letter.match(message, { since: letter.piece.at, now: this.#clock.now() })) return false
    this.#recorder.message(message)
    letter.answer = message
    // one that comes before the computed end is kept until then
    if (letter.left) this.#host.ended(null, message)
    return true
  }
}

module.exports = { Courier }
