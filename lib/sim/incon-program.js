'use strict'

const { accept, createReception, encodeAck, judge, readAcknowledged, startOver } = require('../codec/incon/acknowledge')
const { START, nextNumber, seal } = require('../codec/incon/check')

const END = Buffer.from('\r\n')

/** After a line of its own it leaves the wire to the other side's acknowledgement, ms: nobody else gives turns. */
const TURN = 100

/**
 * What the program of a simulated controller does where lines are acknowledged (codec/incon/acknowledge.js): one line at a time, repeated until it is
 * acknowledged. It only says what is to be put into SerialLinkSend at a scan, and is told what was taken out of SerialLinkRecv.
 *
 * @param {{ clock: any, random: { next: () => number }, ackTimeout: number, listens: number, attempts: number, counts: any,
 *   settled: (outcome: any) => void }} parts
 */
function createInconProgram(parts) {
  const program = {
    ...parts,
    texts: /** @type {Buffer[]} */ ([]),
    acks: /** @type {number[]} */ ([]),
    reception: createReception(),
    flight: /** @type {any} */ (null),
    number: nextNumber(START),
    started: false,
    greeting: true,
    putLine: false,
    freeAt: -Infinity
  }
  return {
    say: text => void program.texts.push(text),
    take: line => take(program, line),
    next: () => next(program),
    left: () => left(program),
    /** ms until it wants to put something into SerialLinkSend by itself; null: nothing. */
    due: () => due(program)
  }
}

function take(program, line) {
  const { counts } = program
  program.freeAt = -Infinity
  const read = readAcknowledged(line)
  if (read.kind === 'damaged') {
    counts.damaged++
    return { valid: false }
  }
  if (read.kind === 'ack') return acknowledged(program, read.number)
  if (read.kind === 'start') return otherStarted(program)
  return takeLine(program, read)
}

function acknowledged(program, number) {
  const { flight } = program
  if (flight?.number === number && flight.attempts > 0) settle(program, 'confirmed')
  return null
}

function otherStarted(program) {
  const { flight } = program
  startOver(program.reception)
  if (flight?.attempts > 0 && flight.number !== START) settle(program, 'unknown')
  return greet(program, START)
}

function greet(program, ack) {
  if (ack !== undefined) program.acks.push(ack)
  program.greeting = true
  return null
}

function takeLine(program, line) {
  const { counts, reception } = program
  // it may have been taken before this start
  if (!program.started) return greet(program)
  const judged = judge(reception, line)
  if (judged.verdict === 'doubtful') return null
  program.acks.push(line.number)
  if (judged.verdict === 'repeated') {
    counts.repeated++
    return null
  }
  accept(reception, line)
  counts.missing += judged.lost
  return { valid: true, text: line.text.toString('latin1'), number: line.number, missing: judged.lost }
}

/** What is to be sent now: acknowledgements first. @returns {Buffer|null} */
function next(program) {
  const { clock, counts, acks, attempts } = program
  program.putLine = false
  if (clock.now() < program.freeAt) return null
  // its own start comes before the acknowledgement of another's
  const isFirst = !program.started && program.greeting && !(program.flight?.attempts > 0)
  if (acks.length > 0 && !isFirst) {
    counts.acks++
    return encodeAck(/** @type {number} */ (acks.shift()))
  }
  program.flight ??= newFlight(program)
  const { flight } = program
  // who has just spoken listens now
  const answers = isFirst && acks.length > 0
  if (!flight || (clock.now() < flight.at && !answers)) return null
  if (flight.attempts >= attempts) {
    settle(program, 'unknown')
    return next(program)
  }
  if (flight.attempts > 0) counts.repeats++
  flight.attempts++
  flight.at = Infinity
  program.putLine = true
  return flight.bytes
}

function newFlight(program) {
  const { started, greeting, texts, random, clock, listens } = program
  if (started && texts.length === 0) return null
  if (!started && !greeting && texts.length === 0) return null
  const number = started ? program.number : START
  const text = started ? texts[0] : Buffer.from(Math.floor(random.next() * 1e6).toString(36))
  const at = started ? 0 : clock.now() + listens
  return { number, bytes: Buffer.concat([seal(text, number), END]), attempts: 0, at }
}

/** The last byte of what it put there has left. */
function left(program) {
  const { flight, clock, ackTimeout, random } = program
  if (flight && program.putLine) {
    flight.at = clock.now() + ackTimeout * (1 + random.next() / 2)
    program.freeAt = clock.now() + TURN
  }
  program.putLine = false
}

function due({ clock, flight, acks, texts, started, greeting, freeAt }) {
  const from = Math.max(freeAt, acks.length === 0 && flight ? flight.at : 0)
  const wants = acks.length > 0 || flight || texts.length > 0 || (!started && greeting)
  return wants && from < Infinity ? Math.max(0, from - clock.now()) : null
}

function settle(program, outcome) {
  const { flight, counts, texts, settled } = program
  program.flight = null
  if (flight.number === START) {
    program.started = outcome === 'confirmed'
    program.greeting = false
    // nobody is there: what was to be said is given up
    if (!program.started) texts.splice(0).forEach(text => settled({ text: text.toString('latin1'), outcome: 'failed' }))
    return
  }
  program.number = nextNumber(flight.number)
  counts[outcome]++
  const text = /** @type {Buffer} */ (texts.shift())
  settled({ text: text.toString('latin1'), outcome, attempts: flight.attempts })
}

module.exports = { createInconProgram }
