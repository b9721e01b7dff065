'use strict'
const { accept, createReception, encodeAck, judge, startOver } = require('../codec/incon/acknowledge')
const { START, nextNumber, seal } = require('../codec/incon/check')
const { PlcError } = require('../error')
const { outcomeOf } = require('./c24-talk')
const { asPlcError } = require('./failure')
const { Flight, Turns } = require('./incon-flight')

/**
 * Acknowledged lines (codec/incon/acknowledge.js): one for all links of a line and over redeploys, since the other side knows one sender and one
 * receiver. Stop and wait: a line is repeated until it is acknowledged, then comes the next. Whatever goes out, acknowledgements too, waits for silence
 * and keeps the pause behind it: the controller's PLC would take two for one.
 */

const MOST_WAITING = 1000
const END = '\r\n'
/** The random part of the time between two attempts, of ackTimeout: two that collide do not collide again. */
const SPREAD = 0.5
/** So many lines of ours heard before they were acknowledged: it is the adapter that hears them. */
const OWN = 2

/**
 * @typedef {object} Port one link
 * @property {any} lease
 * @property {any} settings
 * @property {Record<string, number>} counts
 * @property {() => boolean} listened whether somebody takes what comes
 * @property {() => number} random
 * @property {boolean} closed
 * @property {Set<() => void>} leaving what is told when it is closed
 * @typedef {import('./c24-talk').Result} Result
 */

class InconTalk {
  #clock
  /** of the next line */
  #number = nextNumber(START)
  /** that the other side knows of our start */
  #started = false
  #greeting = false
  #reception = createReception()
  #turns = new Turns()
  /** @type {Promise<any>} */
  #turn = Promise.resolve()
  #waiting = 0
  /** @type {Flight|null} the line of ours that is not acknowledged yet */
  #flight = null
  #heard = { message: /** @type {any} */ (null), verdict: /** @type {any} */ (null) }
  /** @type {Set<number>} acknowledgements that wait */
  #acks = new Set()
  #own = 0
  /** when we were last heard by ourselves */
  #echoAt = -Infinity
  /** @type {Buffer|null} our start, always the same */
  #startLine = null
  /** @type {Port|null} who owes the other side an acknowledgement of its start */
  #owed = null

  /** @param {any} clock */
  constructor(clock) {
    this.#clock = clock
  }

  // --- receiving

  /**
   * Each link is told of each message.
   * @param {any} message of the splitter @param {Port} port
   * @returns {{ lost: number } | null} null: it is not given to the flow
   */
  hear(message, port) {
    if (this.#heard.message !== message) this.#heard = { message, verdict: this.#understand(message, port) }
    const { verdict } = this.#heard
    const isRepeated = verdict?.verdict === 'repeated'
    if (isRepeated) port.counts.repeated++
    // what nobody takes is not acknowledged: it comes again
    const isTaken = verdict?.verdict === 'new' && port.listened()
    if (isTaken) accept(this.#reception, { number: message.number, text: message.bytes })
    if (isTaken || isRepeated) this.#acknowledge(message.number, port)
    if (!isTaken) return null
    return { lost: verdict.lost }
  }

  /** What the first link that hears it makes of it, for all of them. */
  #understand({ kind, number, bytes }, port) {
    const flight = this.#flight
    if (kind === 'ack' && flight?.begun && flight.number === number) flight.finish({ kind: 'ack' })
    if (this.#isOwn({ kind, number, bytes })) return this.#hearOwn(kind)
    if (kind === 'start') this.#otherStarted(port)
    if (kind !== 'data') return null
    if (this.#started) return judge(this.#reception, { number, text: bytes })
    // it may have been taken before our start
    this.greet(port)
    return null
  }

  #isOwn(message) {
    const isOurStart = message.kind === 'start' && this.#startLine !== null && message.bytes.equals(this.#startLine)
    return isOurStart || Boolean(this.#flight?.isHeard(message))
  }

  /** Where the adapter hears itself our own acknowledgement would confirm a line of ours. */
  #hearOwn(kind) {
    this.#own++
    // a start has a text that the other side cannot know; two lines may happen to be alike
    if (kind !== 'start' && this.#own < OWN) return null
    this.#started = false
    this.#echoAt = this.#clock.now()
    this.#flight?.finish({ kind: 'echo' })
    return null
  }

  #otherStarted(port) {
    startOver(this.#reception)
    // it does not know any more whether it had taken this one
    if (this.#flight && this.#flight.number !== START && this.#flight.begun) this.#flight.finish({ kind: 'restarted' })
    // it must hear of our start before it believes that we heard of its own: then none of our lines is on its way meanwhile
    const isNews = !this.#started && !(this.#flight?.number === START && this.#flight.begun)
    if (isNews) this.#owed = port
    else this.#acknowledge(START, port)
    this.greet(port)
  }

  /** Our start has gone out: now that of the other side is acknowledged. */
  #settleDebt() {
    const port = this.#owed
    this.#owed = null
    if (port) this.#acknowledge(START, port)
  }

  /** Once, however many links have heard the line. @param {number} number @param {Port} port */
  async #acknowledge(number, port) {
    if (this.#acks.has(number)) return
    this.#acks.add(number)
    const free = await this.#turns.take({ first: true })
    this.#acks.delete(number)
    try {
      await this.#put(encodeAck(number), port)
      port.counts.acksOut++
    } catch {
      // the other side sends its line again
    } finally {
      free()
    }
  }

  #put(bytes, { lease, settings }, deadline = 0) {
    const { before, pause, name } = settings
    return lease.send(bytes, { quiet: before, after: pause, deadline, label: name })
  }

  // --- our start

  /** Says that we have started, if the other side does not know it yet. @param {Port} port */
  greet(port) {
    if (this.#started || this.#greeting) return
    this.#greeting = true
    this.#turn = this.#turn.then(async () => {
      await this.#start(port)
      this.#greeting = false
    })
  }

  /** @param {Port} port @returns {Promise<any>} null, or why the other side does not know of our start */
  async #start(port) {
    if (this.#started) return null
    // an acknowledgement of what the adapter heard may still come
    if (this.#clock.now() < this.#echoAt + port.settings.ackTimeout) return { kind: 'echo' }
    const line = this.#startLine ?? seal(Buffer.from(Math.floor(port.random() * 1e6).toString(36)), START)
    this.#startLine = line
    const flight = new Flight({ number: START, line, text: line, port })
    const end = await this.#fly(flight, 0)
    this.#started = end.kind === 'ack'
    return this.#started ? null : end
  }

  // --- sending

  /**
   * @param {Buffer} text
   * @param {{ port: Port, deadline: number }} options deadline: ms that it may wait for its turn
   * @returns {Promise<Result>}
   */
  send(text, { port, deadline }) {
    const { line } = port.lease
    if (this.#waiting >= MOST_WAITING) {
      return Promise.resolve(failed(new PlcError('QUEUE_FULL', { line: line.name, most: MOST_WAITING })))
    }
    this.#waiting++
    const due = deadline > 0 ? this.#clock.now() + deadline : Infinity
    const tooLate = () => failed(new PlcError('DEADLINE', { line: line.name, limit: deadline }))
    return new Promise(resolve => {
      let over = false
      const settle = result => {
        if (over) return
        over = true
        this.#clock.clearTimer(timer)
        port.leaving.delete(leave)
        resolve(result)
      }
      const leave = () => settle(failed(new PlcError('LINE_CLOSED', { line: line.name })))
      port.leaving.add(leave)
      const timer = deadline > 0 ? this.#clock.setTimer(() => settle(tooLate()), deadline) : null
      // one line with all its repetitions before the next
      this.#turn = this.#turn.then(async () => {
        this.#waiting--
        if (over) return
        port.leaving.delete(leave)
        const refused = await this.#start(port)
        if (refused) return settle(failed(errorOf(refused, port)))
        const now = this.#clock.now()
        const left = due === Infinity ? 0 : due - now
        settle(now >= due ? tooLate() : await this.#exchange(text, { port, left }))
      })
    })
  }

  /** @returns {Promise<Result>} */
  async #exchange(text, { port, left }) {
    const number = this.#number
    const flight = new Flight({ number, line: seal(text, number), text, port })
    const end = await this.#fly(flight, left)
    const { frames, bytes } = flight
    // what has not gone out leaves no gap
    if (frames > 0) this.#number = nextNumber(number)
    if (end.kind === 'ack') return { outcome: 'confirmed', attempts: frames, bytes }
    return outcomeOf(frames > 0 ? 'unknown' : 'failed', errorOf(end, port), { attempts: frames, bytes })
  }

  /** Until it is acknowledged, or there is no sense in another attempt. @returns {Promise<any>} how it ended */
  async #fly(flight, deadline) {
    const { port } = flight
    const { attempts, ackTimeout } = port.settings
    const leave = () => flight.finish({ kind: 'closed' })
    port.leaving.add(leave)
    if (port.closed) leave()
    this.#flight = flight
    for (let tries = 1; !flight.end && tries <= attempts; tries++) {
      const error = await this.#transmit(flight, tries === 1 ? deadline : 0)
      if (error && flight.frames === 0) flight.finish({ kind: 'unsent', error })
      const spread = tries < attempts ? port.random() * ackTimeout * SPREAD : 0
      await flight.rest(this.#clock, ackTimeout + spread)
    }
    this.#flight = null
    port.leaving.delete(leave)
    // an adapter hears each of them
    if (flight.heard < flight.frames) this.#own = 0
    return flight.end ?? { kind: 'silent' }
  }

  /** @returns {Promise<PlcError|null>} */
  async #transmit(flight, deadline) {
    const { port } = flight
    const free = await this.#turns.take()
    try {
      if (flight.end) return null
      if (flight.frames > 0) port.counts.repeats++
      flight.begun = true
      await this.#put(Buffer.concat([flight.line, Buffer.from(END)]), port, deadline)
      flight.went(flight.line.length + END.length)
      return null
    } catch (/** @type {any} */ error) {
      const sent = Number(error?.details?.sent) || 0
      if (sent > 0) flight.went(sent)
      return asPlcError(error)
    } finally {
      free()
      if (flight.number === START) this.#settleDebt()
    }
  }
}

/** @param {any} end of a flight @param {Port} port @returns {PlcError} */
const errorOf = ({ kind, error }, { lease, settings: { name, ackTimeout } }) => {
  if (error) return error
  if (kind === 'restarted') return new PlcError('PEER_RESTARTED', { station: name })
  if (kind === 'echo') return new PlcError('OWN_ECHO', { line: lease.line.name })
  if (kind === 'closed') return new PlcError('LINE_CLOSED', { line: lease.line.name })
  return new PlcError('TIMEOUT', { station: name, timeout: ackTimeout })
}

/** @param {PlcError} error nothing of the line went out @returns {Result} */
const failed = error => outcomeOf('failed', error, { attempts: 0, bytes: 0 })

/**
 * The talk of a line, the same one for all its links.
 * @param {any} line @param {any} clock
 * @returns {InconTalk}
 */
const talkOf = (line, clock) => (line.memory('INCON').talk ??= new InconTalk(clock))

module.exports = { InconTalk, talkOf }
