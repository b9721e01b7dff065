'use strict'
const { PlcError } = require('../error')
const { PRIORITY, realClock, timeoutFor } = require('../line')
const { backEvent, demotedError, demotedEvent, slowEvent } = require('./health-texts')
const { demote, healthOf, noteAlive, noteGood, noteSilence, noteWanted, pardon, sampleOf } = require('./health-record')

/**
 * A station that is silent must not cost the others their time: after some silences in a row it is only probed, and what is asked of it is
 * answered at once. Contract in docs/architecture.md, "Health".
 */

const HOUR = 3600000
const JITTER = 0.2
/** ms that a probe waits, while nothing is learnt of the station, and at least. */
const PATIENCE = 500
const LEAST_PATIENCE = 50
/** So many answers tell how long a probe has to wait, and so many whether the timeout is too short. */
const LEARNT = 10
const WELL_LEARNT = 100
/** Of the timeout: an answer that takes longer may not come in time tomorrow. */
const SLOW = 0.8
const LOOK = 50 // answers between two looks at that
/** Answers that one station alone may have given since: the line as a whole was silent. */
const FEW = 2
const SOON = 500 // ms

/** Something of ours came, if not whole. */
const DAMAGED = new Set(['INCOMPLETE', 'CRC_ERROR'])

class Health {
  #lease
  #clock
  #random
  #settings
  #memory
  #health
  #talk = /** @type {any} */ (null)
  #wake = () => {}
  #timer = null
  #isProbing = false
  #closed = false
  #lineState
  #seen = 0

  /**
   * @param {{ lease: any, clock?: any, settings: any, random?: () => number }} options settings: `station`, `timeout`, `demoteAfter`, `probeFirst`,
   *   `probeMost`; random: 0 to 1, for the jitter of the probes
   */
  constructor({ lease, clock = realClock, settings, random = Math.random }) {
    this.#lease = lease
    this.#clock = clock
    this.#random = random
    this.#settings = settings
    this.#memory = lease.line.memory(settings.station)
    this.#health = healthOf(this.#memory)
    this.#lineState = lease.line.state
    // it was followed
    if (this.#memory.advice <= settings.timeout) this.#memory.advice = null
    this.#pardon()
    lease.on('state', this.#onState)
    lease.on('event', this.#onEvent)
  }

  /** `{ state, since, probe }`: since its last change (epoch ms, or null); the next probe (epoch ms; null: there is none). */
  get now() {
    const { state, since, probeAt } = this.#health
    const probe = state === 'demoted' ? this.#wallOf(probeAt) : null
    return { state, since, probe }
  }

  /** A timeout that would do, ms; null: no answer came late, or nearly so. */
  get advice() {
    return this.#memory.advice ?? null
  }

  /** @param {{ talk: any, wake: () => void }} device wake: called when the station may answer again */
  serve({ talk, wake }) {
    this.#talk = talk
    this.#wake = wake
  }

  /**
   * As `lease.run`, unless the station is demoted.
   * @param {() => { request: any, dialog: Generator<any, any, any> }} make makes the conversation when its turn has come
   * @param {any} options of `lease.run`; `request`: what is read, if that is known by now
   * @returns {Promise<any>} rejects with STATION_DEMOTED, too
   */
  run(make, options) {
    const { request } = options
    const refusal = this.#refusal(request)
    if (refusal) return Promise.reject(refusal)
    const begin = () => {
      const late = this.#refusal(request)
      if (late) throw late
      return this.#watch(make())
    }
    return this.#lease.run(begin, options)
  }

  get #isDemoted() {
    return this.#health.state === 'demoted' && this.#settings.demoteAfter > 0
  }

  /** @returns {PlcError | null} */
  #refusal(request) {
    // a line that is down has its own reason
    if (!this.#isDemoted || this.#closed || this.#lease.line.reason) return null
    if (request) noteWanted(this.#health, request)
    // another device of the station may have demoted it, and be gone
    if (this.#timer === null) this.#arm()
    return this.#error()
  }

  #error(sent = false) {
    const probe = Math.round(this.#wallOf(this.#health.probeAt))
    return demotedError(this.#health, { station: this.#settings.station, now: this.#clock.now(), probe, sent })
  }

  #wallOf(at) {
    return this.#clock.wall() + at - this.#clock.now()
  }

  // --- what becomes of each frame

  /** A conversation, each of whose steps is looked at. @param {{ request: any, dialog: any }} made @param {number} [patience] of a probe, ms */
  *#watch({ request, dialog }, patience = Infinity) {
    let next = dialog.next()
    try {
      while (!next.done) {
        const step = next.value
        let answer
        try {
          answer = yield this.#heard(step, patience)
        } catch (error) {
          next = this.#failed(error, { request, dialog, step })
          continue
        }
        if (step.clears) this.#revive()
        else if (step.match) this.#answered(request)
        next = dialog.next(answer)
      }
      return next.value
    } finally {
      dialog.return(undefined)
    }
  }

  /**
   * Also an answer that comes too late is heard: the line keeps the recogniser. A probe waits shorter, but is not late sooner. The step itself is
   * changed: a conversation makes a new one each time.
   */
  #heard(step, patience) {
    const { match, timeout } = step
    if (!match) return step
    step.match = bytes => {
      const verdict = match(bytes)
      if (verdict.take > 0 && verdict.take <= bytes.length) this.#revive()
      return verdict
    }
    if (patience < timeout) Object.assign(step, { timeout: patience, lateAfter: timeout })
    return step
  }

  #answered(request) {
    this.#revive()
    noteGood(this.#health, request)
    if (++this.#seen % LOOK === 0) this.#checkSpeed()
  }

  #failed(error, { request, dialog, step }) {
    // it may only not know this query
    const silent = error.code === 'TIMEOUT' && !step.clears
    if (silent) this.#silent(request)
    else if (DAMAGED.has(error.code)) this.#revive()
    const next = dialog.throw(error)
    if (next.done || !silent || !this.#isDemoted) return next
    // it would ask again
    try {
      dialog.throw(this.#error(error.details.sent))
    } catch (/** @type {any} */ end) {
      if (end.code !== 'STATION_DEMOTED') throw end
      throw new PlcError('TIMEOUT', { ...error.details, sent: end.details.sent, cause: error })
    }
    throw error
  }

  #silent(request) {
    const { demoteAfter } = this.#settings
    const times = { now: this.#clock.now(), wall: this.#clock.wall() }
    if (!noteSilence(this.#health, request, { demoteAfter, ...times })) return
    const { line } = this.#lease
    demote(this.#health, request, { answers: line.stats().answers, wall: times.wall })
    this.#health.wait = this.#settings.probeFirst
    this.#schedule()
    if (this.#health.told) return
    this.#health.told = true
    this.#report(demotedEvent)
  }

  #revive() {
    const health = this.#health
    if (this.#closed || (health.state === 'online' && health.silent === 0)) return
    noteAlive(health, this.#clock.wall())
    if (!health.told) return
    health.told = false
    this.#report(backEvent)
  }

  /** Not from inside a conversation: who is told may ask at once. */
  #report(eventOf) {
    const event = eventOf(this.#health, { station: this.#settings.station, now: this.#clock.now() })
    queueMicrotask(() => this.#lease.line.report(event))
  }

  #checkSpeed() {
    const { timeout, station } = this.#settings
    const { waits } = this.#memory
    const now = this.#clock.now()
    if (!waits || waits.size < WELL_LEARNT || now - this.#health.slowAt < HOUR) return
    const p99 = Math.round(waits.p99)
    if (p99 <= SLOW * timeout) return
    this.#health.slowAt = now
    this.#memory.advice = Math.max(this.#memory.advice ?? 0, timeoutFor(p99))
    this.#report(() => slowEvent(p99, { station, timeout }))
  }

  // --- probing

  #schedule() {
    const health = this.#health
    health.probeAt = this.#clock.now() + health.wait * (1 - JITTER / 2 + JITTER * this.#random())
    health.wait = Math.min(2 * health.wait, this.#settings.probeMost)
    this.#arm()
  }

  #arm() {
    this.#disarm()
    if (this.#closed || this.#lease.released || this.#isProbing || !this.#isDemoted) return
    this.#timer = this.#clock.setTimer(this.#due, Math.max(0, this.#health.probeAt - this.#clock.now()))
  }

  #disarm() {
    this.#clock.clearTimer(this.#timer)
    this.#timer = null
  }

  #due = () => {
    this.#timer = null
    if (!this.#isDemoted) return
    // another device of the station has probed
    if (this.#health.probeAt - this.#clock.now() > 1) this.#arm()
    else this.#probe()
  }

  #probe() {
    const { station } = this.#settings
    const make = () => {
      // it came back while the probe waited for its turn
      if (!this.#isDemoted) throw this.#error()
      const request = sampleOf(this.#health)
      return this.#watch({ request, dialog: this.#talk.probing(request) }, this.patience)
    }
    const over = () => {
      this.#isProbing = false
      if (this.#isDemoted) this.#schedule()
    }
    this.#isProbing = true
    this.#lease.run(make, { station, priority: PRIORITY.POLL, key: 'probe', label: 'probe' }).then(over, over)
  }

  /** How long a station is waited for that would answer at once, ms: learnt, or 500. */
  get patience() {
    const { waits } = this.#memory
    const learnt = waits && waits.size >= LEARNT
    return learnt ? Math.max(LEAST_PATIENCE, waits.p99 * 1.5) : PATIENCE
  }

  // --- what others notice

  /** The next request goes out as it is. */
  #pardon() {
    if (!this.#isDemoted) return
    this.#disarm()
    pardon(this.#health, { demoteAfter: this.#settings.demoteAfter, wall: this.#clock.wall() })
  }

  #onState = state => {
    const isBack = state === 'open' && this.#lineState === 'waiting'
    this.#lineState = state
    if (!isBack) return
    this.#pardon()
    queueMicrotask(() => this.#wakeUp())
  }

  #onEvent = ({ event, station }) => {
    if (event !== 'stationBack') return
    if (station === this.#settings.station) this.#wakeUp()
    else if (this.#isDemoted && this.#lease.line.stats().answers - this.#health.answers <= FEW) this.#probeSoon()
  }

  /** Nobody answered, and now one does: the bus was broken, not the stations. */
  #probeSoon() {
    const at = this.#clock.now() + SOON * this.#random()
    if (at >= this.#health.probeAt) return
    this.#health.probeAt = at
    this.#arm()
  }

  #wakeUp() {
    if (this.#closed) return
    this.#disarm()
    this.#wake()
  }

  close() {
    this.#closed = true
    this.#disarm()
    this.#lease.off('state', this.#onState)
    this.#lease.off('event', this.#onEvent)
  }
}

module.exports = { Health }
