'use strict'

const { EMPTY } = require('./receiver')
const { Stats } = require('./stats')
const { Trace } = require('./trace')

const FAILURES = { TIMEOUT: 'timeouts', INCOMPLETE: 'incomplete', CRC_ERROR: 'crcErrors' }

/** What happened on a line, counted and kept: statistics and trace in one place, so that they agree. */
class Recorder {
  stats = new Stats()
  trace
  #clock
  #told
  #sentAt = 0

  /**
   * @param {any} clock
   * @param {{ frame?: (row: any, grows: boolean) => void, fault: (station: any, code: string) => void, good: (station: any) => void }} [told]
   *   frame: each row of the trace; fault: what went wrong; good: a station, or the other side, has spoken well
   */
  constructor(clock, told = { fault() {}, good() {} }) {
    this.#clock = clock
    this.#told = told
    this.trace = new Trace({ tell: told.frame })
  }

  #row(dir, { station, bytes, note }) {
    this.trace.add({ t: this.#clock.wall(), dir, station, bytes, note })
  }

  /** @param {any} station @param {Buffer} bytes of a step: nobody changes them any more @param {string} label */
  sent(station, bytes, label) {
    this.#sentAt = this.#clock.now()
    this.stats.asked(station, bytes.length)
    this.trace.keep({ t: this.#clock.wall(), dir: 'out', station, bytes, note: label })
  }

  /** @param {{ station: any, step: any, error: any, answer: Buffer, facts: { sent: boolean, ms: number } }} end of a step */
  ended({ station, step, error, answer, facts }) {
    if (facts.sent) this.stats.add('busy', this.#clock.now() - this.#sentAt)
    if (error) return this.#failed(station, error, answer)
    if (!step.match) return
    this.stats.answered(station, facts.ms)
    this.trace.keep({ t: this.#clock.wall(), dir: 'in', station, bytes: answer, note: '' })
    this.#told.good(station)
  }

  #failed(station, error, seen) {
    const counter = FAILURES[error.code]
    if (counter) this.stats.count(counter, station)
    this.#row('in', { station, bytes: seen, note: error.code ?? error.message })
    this.#told.fault(station, error.code ?? error.message)
  }

  late(station, frame) {
    this.stats.count('late', station)
    this.#row('in', { station, bytes: frame, note: 'late' })
  }

  // --- listening lines

  /** A message or a reply begins to go out. @param {Buffer} bytes @param {string} note */
  letter(bytes, note) {
    this.#row('out', { station: null, bytes, note })
  }

  /** Its last byte has left. @param {number} ms from its first byte on */
  letterSent(ms) {
    this.stats.count('messagesOut')
    this.stats.add('busy', ms)
  }

  letterFailed(error) {
    const counter = FAILURES[error.code]
    if (counter) this.stats.count(counter)
    this.failed(error.code ?? error.message)
    this.#told.fault(null, error.code ?? error.message)
  }

  /** @param {string} note */
  failed(note) {
    this.#row('in', { station: null, bytes: EMPTY, note })
  }

  /** @param {{ kind: string, bytes: Buffer, complete: boolean, reason?: string }} message */
  message({ kind, bytes, complete, reason }) {
    const damaged = kind === 'damaged' || !complete
    this.stats.count('messagesIn')
    if (damaged) this.stats.count('damagedMessages')
    this.#row('in', { station: null, bytes, note: reason ?? (damaged ? 'incomplete' : '') })
    if (damaged) this.#told.fault(null, reason ?? 'incomplete')
    else this.#told.good(null)
  }

  // --- bytes that nobody asked for

  echoed(bytes) {
    this.stats.count('echoes')
    this.#row('in', { station: null, bytes, note: 'echo' })
  }

  /** @param {'skipped'|'stray'} note @param {Buffer} bytes */
  unclaimed(note, bytes) {
    this.stats.add(note === 'skipped' ? 'skippedBytes' : 'strayBytes', bytes.length)
    this.trace.addStray({ t: this.#clock.wall(), bytes, note })
  }
}

module.exports = { Recorder }
