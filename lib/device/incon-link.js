'use strict'
const { isUtf8 } = require('node:buffer')
const { PlcError } = require('../error')
const { nextNumber, START, unseal } = require('../codec/incon/check')
const { encodeLine, inconFraming } = require('../codec/incon/message')
const { realClock } = require('../line')
const { createAudit } = require('./audit')
const { asGivenError, asPlcError } = require('./failure')
const { readSettings } = require('./incon-settings')
const { talkOf } = require('./incon-talk')

/**
 * The serial link of an INCON-M84/M86/M86R: lines of text, both ways. Nothing in it confirms a line: one that has left the port is `sent`; only where the
 * controller's program acknowledges lines is it `confirmed` (incon-talk.js).
 */

// Ends the line that was cut off in the controller's buffer, and spoils it: without it the next line would be glued to it,
// and a cut "O1234" would be taken for "O12"
const TORN_END = Buffer.from('?\r\n')

/** What those have in common who send on one line: the number of the next checked line. Survives redeploys. */
const memoryOf = line => (line.memory('INCON').incon ??= { number: START })

const emptyStats = () => ({
  received: 0,
  incomplete: 0,
  damaged: 0,
  lost: 0,
  repeated: 0,
  sent: 0,
  confirmed: 0,
  unknown: 0,
  refused: 0,
  failed: 0,
  repeats: 0,
  acksOut: 0
})

/**
 * @param {'unknown'|'refused'|'failed'} outcome @param {any} error @param {number} [bytes] that went out
 * @returns {Outcome & { error: any }}
 */
const failure = (outcome, error, bytes = 0) => {
  const { code, message: text } = asPlcError(error)
  return { outcome, code, text, attempts: bytes > 0 ? 1 : 0, ms: 0, bytes, error }
}

/** One end of the link on a line. Made by {@link createInconLink}. */
class InconLink {
  #lease
  #clock
  #settings
  #heard
  #audit
  #listeners = new Set()
  #closed = false
  #stats = emptyStats()
  /** @type {import('./incon-talk').InconTalk|null} */
  #talk = null
  /** @type {import('./incon-talk').Port} */
  #port

  /** @param {Record<string, any>} options of {@link createInconLink} */
  constructor({ lease, clock = realClock, random = Math.random, ...given }) {
    this.#settings = readSettings(given)
    this.#lease = lease
    this.#clock = clock
    this.#audit = createAudit({ line: lease.line, device: this.#settings.name })
    const { most, silence, encoding, checked, acknowledge } = this.#settings
    const framing = inconFraming({ most, silence, ascii: encoding === 'ascii', checked, acknowledge })
    const use = { torn: { first: TORN_END, apart: true } }
    this.#heard = lease.listen(framing, (message, { at }) => this.#take(message, at), use)
    const listened = () => this.#listeners.size > 0
    const counts = this.#stats
    this.#port = { lease, settings: this.#settings, counts, listened, random, closed: false, leaving: new Set() }
    if (acknowledge) this.#open(clock)
  }

  #open(clock) {
    const { line } = this.#lease
    const talk = talkOf(line, clock)
    this.#talk = talk
    // what the other side repeats from before a start of ours may be known already
    this.#lease.on('state', this.#greet)
    if (line.state === 'open') talk.greet(this.#port)
  }

  #greet = state => {
    if (state === 'open') this.#talk?.greet(this.#port)
  }

  get name() {
    return this.#settings.name
  }

  /**
   * Lines by what became of them; `lost`: numbers of the checked format that never came; `repeated`: came once more and were dropped; `repeats`: lines of
   * ours that went out once more; `acksOut`: acknowledgements.
   */
  get stats() {
    return { ...this.#stats }
  }

  // --- receiving

  #take(message, timestamp) {
    const stats = this.#stats
    if (message.repeated) {
      stats.repeated++
      return
    }
    if (message.kind === 'damaged') stats.damaged++
    else if (!message.complete) stats.incomplete++
    if (!this.#talk) return this.#deliver(message, timestamp)
    // what was damaged comes again
    const heard = message.kind === 'damaged' ? null : this.#talk.hear(message, this.#port)
    if (heard) this.#deliver({ ...message, lost: heard.lost }, timestamp)
  }

  #deliver(message, timestamp) {
    this.#stats.received++
    this.#stats.lost += message.lost ?? 0
    const told = this.#told(message, timestamp)
    if (told.reason === 'encoding') this.#stats.damaged++
    for (const callback of [...this.#listeners]) callback(told)
  }

  #told({ kind, bytes, complete, reason, number, lost }, timestamp) {
    const { encoding, checked } = this.#settings
    const text = bytes.toString(encoding === 'ascii' ? 'latin1' : encoding)
    // what is no character shows as a replacement: then the text is not what was sent
    const valid = encoding !== 'utf8' || isUtf8(bytes)
    const why = complete && !valid ? 'encoding' : reason
    // where a check says no, nobody must take it for a value
    const value = checked && kind === 'damaged' ? null : text
    return {
      value,
      text,
      bytes,
      count: bytes.length,
      complete: complete && valid,
      timestamp,
      ...(why ? { reason: why } : {}),
      ...(checked && complete ? { number, lost } : {})
    }
  }

  /**
   * @param {(line: Received) => void} callback for each line that comes, whole or not
   * @returns {() => void} stop
   */
  listen(callback) {
    const own = line => callback(line)
    this.#listeners.add(own)
    return () => void this.#listeners.delete(own)
  }

  // --- sending

  /**
   * Sends one line; lines go out in the order of the calls, each followed by the quiet time.
   * @param {string|number|Uint8Array} value text of printable characters, or bytes as they are; at most 253 (246 in the checked format)
   * @param {{ deadline?: number, by?: import('./audit').By }} [options] deadline: ms that it may wait for its turn, 0: no limit; by: who asked, for the
   *   event `audit`
   * @returns {Promise<Outcome>} never rejects
   */
  async send(value, { deadline = this.#settings.deadline, by } = {}) {
    const start = this.#clock.now()
    const since = this.#clock.wall()
    const { error, ...outcome } = await this.#outcome(value, deadline)
    this.#stats[outcome.outcome]++
    const whole = { ...outcome, ms: outcome.ms || this.#clock.now() - start }
    this.#audit.message(whole, { value, since, by, error })
    return whole
  }

  /**
   * Tells of a line that its owner does not let go out: the event `audit`, nothing else.
   * @param {unknown} value
   * @param {any} error why
   * @param {{ by?: import('./audit').By }} [options]
   */
  refused(value, error, { by } = {}) {
    const { error: why, ...outcome } = failure('refused', error)
    this.#audit.message(outcome, { value, since: this.#clock.wall(), by, error: why })
  }

  /** @returns {Promise<Outcome & { error?: any }>} */
  async #outcome(value, deadline) {
    const { line } = this.#lease
    const memory = memoryOf(line)
    if (this.#closed) return failure('failed', new PlcError('LINE_CLOSED', { line: line.name }))
    let bytes
    try {
      bytes = encodeLine(value, { ...this.#settings, number: memory.number })
    } catch (error) {
      return failure('refused', asGivenError(error))
    }
    if (this.#talk) return this.#converse(bytes, deadline)
    if (this.#settings.checked) memory.number = nextNumber(memory.number)
    try {
      const { before, pause } = this.#settings
      const { ms } = await this.#lease.send(bytes, { quiet: before, after: pause, deadline, label: this.name })
      return { outcome: 'sent', attempts: 1, ms, bytes: bytes.length }
    } catch (/** @type {any} */ error) {
      const sent = Number(error?.details?.sent) || 0
      return failure(sent > 0 ? 'unknown' : 'failed', error, sent)
    }
  }

  /** @returns {Promise<Outcome>} */
  async #converse(bytes, deadline) {
    const { text } = /** @type {{ text: Buffer }} */ (unseal(bytes.subarray(0, -2)))
    const talk = /** @type {import('./incon-talk').InconTalk} */ (this.#talk)
    return { ...(await talk.send(text, { port: this.#port, deadline })), ms: 0 }
  }

  /** What waits is still settled; the lease stays its owner's. Any number of times. */
  close() {
    this.#closed = true
    this.#port.closed = true
    for (const leave of [...this.#port.leaving]) leave()
    this.#lease.off('state', this.#greet)
    this.#listeners.clear()
    this.#heard.close()
  }
}

/**
 * The serial link of an INCON controller on a line.
 *
 * @param {object} options
 * @param {any} options.lease of the line, from `pool.open`
 * @param {string} [options.name]
 * @param {'ascii'|'latin1'|'utf8'} [options.encoding] of text; default ascii: other bytes that come are marked as damage
 * @param {boolean} [options.checked] lines are `#NN text*HH` both ways (codec/incon/check.js); default false
 * @param {boolean} [options.acknowledge] checked lines are acknowledged, both ways (codec/incon/acknowledge.js); default false
 * @param {number} [options.attempts] of a line that is not acknowledged: 1 to 100, default 5
 * @param {number} [options.ackTimeout] ms until the acknowledgement, default 1000: two scans of the PLC, the longest line and some; a random half of it comes
 *   on top
 * @param {number} [options.most] bytes of a line that comes, with its end: 2 to 4096, default 256
 * @param {number} [options.silence] ms after which a line without line feed is delivered as torn, default 200; 0: never
 * @param {number} [options.scan] ms, the longest scan time of the controller's PLC, default 100: after each line that is sent nothing follows for two scans and
 *   5 ms, or it may see two lines as one
 * @param {number} [options.quiet] ms of that pause at least, default 50
 * @param {number} [options.before] ms of silence on the line before one is sent, default 5
 * @param {number} [options.deadline] ms that a line may wait for its turn, default no limit
 * @param {any} [options.clock] for the times of outcomes
 * @param {() => number} [options.random] 0 to 1, for the times of repetitions
 * @returns {InconLink}
 * @throws {PlcError} BAD_SETTING, LINE_USE, LINE_CLOSED
 */
const createInconLink = options => new InconLink(options)

/**
 * @typedef {object} Received
 * @property {string|null} value the text; null if it is damaged by its own check
 * @property {string} text what came, even so
 * @property {Buffer} bytes
 * @property {number} count bytes
 * @property {boolean} complete one whole line, as far as can be known
 * @property {import('../codec/incon/message').Reason|'encoding'} [reason] why it is not; encoding: some of its bytes are no characters
 * @property {number} timestamp epoch ms
 * @property {number|null} [number] checked format
 * @property {number} [lost] checked format: lines that are missing before this one
 *
 * @typedef {object} Outcome
 * @property {'sent'|'confirmed'|'unknown'|'refused'|'failed'} outcome sent: every byte has left the port, nobody confirms it; confirmed: acknowledged;
 *   unknown: it was interrupted, or not acknowledged; refused: it cannot be a line; failed: nothing went out
 * @property {string} [code]
 * @property {string} [text]
 * @property {number} attempts lines that went out: 0 or 1, more where lines are acknowledged
 * @property {number} ms from the call to the outcome
 * @property {number} bytes that went out
 */

module.exports = { InconLink, createInconLink }
