'use strict'

const { START, missingBetween, nextNumber, seal, unseal } = require('../codec/incon/check')
const { createNcSender } = require('../codec/incon/handshake')
const { createInconProgram } = require('./incon-program')
const { prepare } = require('./incon-state')

const END = Buffer.from('\r\n')

/**
 * A simulated INCON-M84/M86/M86R: an NC with the structures SerialLinkSend and SerialLinkRecv, and a PLC that looks at them once a scan.
 *
 * - `station` 1..247: a name for the wire (the link has no addresses)
 * - `scan` ms from one scan of the PLC to the next, 1 to 1000 (10); `phase` ms of the first one after the clock's zero (0)
 * - `restart` what the NC makes of a `finish` of SerialLinkRecv that stays 1: `always` (nothing is kept meanwhile) or `once`
 * - `clears` what the sending program clears: `finish` (as the manual's text says) or `length` (as its example does: a stale `finish`)
 * - `receiveClears` false: the receiving program never clears `finish`
 * - `answer` `none`, `echo`, or a function (text) → text, bytes or null, called for each message that the PLC takes
 * - `events` texts that it sends in turn, one `every` ms (0: none)
 * - `checked` its programs speak the checked format (codec/incon/check.js)
 * - `acknowledge` its programs speak the acknowledged format (codec/incon/acknowledge.js); `ackTimeout` ms until the acknowledgement (1000; a random half of
 *   it comes on top), `attempts` of a line (5), `random` for these times, `listens` ms after its start before it says so (0; two that start at the
 *   same moment and speak at once are not understood)
 * - `keep` so many of the latest messages and lines are kept (1000)
 * - `onMessage(message)` for each message that the PLC's program takes
 *
 * @param {{ station?: number, clock: any, [setting: string]: any }} settings
 * @returns {InconController}
 * @throws {PlcError} BAD_STATION, BAD_SETTING
 */
function createInconController(settings) {
  const incon = prepare(settings)
  begin(incon)
  startEvents(incon)
  return {
    station: incon.station,
    counts: incon.counts,
    messages: incon.messages,
    sent: incon.sent,
    reported: incon.reported,
    outcomes: incon.outcomes,
    structures: { send: incon.send, recv: incon.recv },
    speak: send => void (incon.transmit = send),
    appetite: () => 1,
    receive: bytes => hear(incon, bytes),
    disguise: bytes => Buffer.from(bytes.map(byte => (byte > 0x20 ? 0x58 : byte))),
    say: text => say(incon, text),
    mCode: data => startMCode(incon, data),
    restart: () => switchOn(incon),
    close: () => close(incon)
  }
}

/** The program starts; one that acknowledges says so. */
function begin(incon) {
  const { acknowledge, clock, random, ackTimeout, listens, attempts, counts } = incon
  if (!acknowledge) return
  const settled = outcome => keepIn(incon, incon.outcomes, outcome)
  incon.program = createInconProgram({ clock, random, ackTimeout, listens, attempts, counts, settled })
  wake(incon)
}

/** The controller is switched off and on: what its program knew is gone. */
function switchOn(incon) {
  incon.queue.length = 0
  Object.assign(incon, { busy: false, number: START, lastNumber: null })
  Object.assign(incon.recv, { length: 0, finish: 0 })
  Object.assign(incon.send, { length: 0, finish: 0 })
  // the NC, too: what it was sending concerns nobody any more
  incon.ncSender = createNcSender(incon.send)
  begin(incon)
}

// --- the PLC: one scan after the other, but none where nothing can happen

/** The next scan of its raster. */
function wake(incon) {
  const { clock, scan, phase } = incon
  if (incon.timer) return
  const now = clock.now()
  const next = phase + (Math.floor((now - phase) / scan + 1e-9) + 1) * scan
  incon.timer = clock.setTimer(() => onScan(incon), next - now)
}

const stateOf = ({ send, recv, queue, mCode }) =>
  [send.length, send.finish, recv.length, recv.finish, queue.length, mCode.flag].join()

function onScan(incon) {
  incon.timer = null
  const before = stateOf(incon)
  const taken = incon.receiveProgram.scan()
  if (taken) take(incon, taken)
  if (incon.program) programScan(incon)
  sendScan(incon)
  ncLook(incon)
  // the programs know no time: where a scan has changed nothing, the next one would not either
  if (stateOf(incon) !== before) wake(incon)
}

/** What it puts into the queue for SerialLinkSend at this scan. It does not begin while a line is coming. */
function programScan(incon) {
  const { program, clock, queue, recv } = incon
  const isComing = recv.length > 0 && recv.length !== incon.seenLength
  incon.seenLength = recv.length
  const bytes = queue.length > 0 || isComing ? null : program.next()
  if (bytes) queue.push(bytes)
  clock.clearTimer(incon.dueTimer)
  const ms = queue.length > 0 ? null : program.due()
  if (ms !== null) incon.dueTimer = clock.setTimer(() => wake(incon), ms)
}

function take(incon, { bytes, shown, full }) {
  const { clock, counts, receiveProgram } = incon
  const examined = examine(incon, bytes)
  if (!examined) return
  const message = { at: clock.now(), bytes, text: textOf(bytes), shown, full, ...examined }
  counts.messages++
  counts.overwritten = receiveProgram.overwritten
  keepIn(incon, incon.messages, message)
  incon.onMessage?.(message)
  const { answer } = incon
  const said = answer === 'echo' ? message.text : typeof answer === 'function' ? answer(message.text) : null
  if (said !== null && said !== undefined && message.valid !== false) say(incon, said)
}

const textOf = bytes => bytes.toString('latin1').replace(/\r?\n$/, '')

/** In the checked format: whether it is valid, and how many are missing before it. Null: it is no line, or one that came again. */
function examine(incon, bytes) {
  if (incon.program) return incon.program.take(Buffer.from(textOf(bytes), 'latin1'))
  if (!incon.checked) return {}
  const opened = unseal(Buffer.from(textOf(bytes), 'latin1'))
  if ('reason' in opened) {
    incon.counts.damaged++
    return { valid: false }
  }
  const missing = missingBetween(incon.lastNumber, opened.number)
  incon.lastNumber = opened.number ?? incon.lastNumber
  incon.counts.missing += missing
  return { valid: true, text: opened.text.toString('latin1'), number: opened.number, missing }
}

function sendScan(incon) {
  const { mCode, counts, queue, clock } = incon
  if (mCode.flag && !incon.busy) {
    incon.m68.scan(mCode)
    if (!mCode.finish) return
    Object.assign(mCode, { flag: false, finish: 0 })
    counts.mCodes++
    return
  }
  const done = incon.sendProgram.scan(queue[0] ?? null)
  incon.busy = queue.length > 0 && !done
  if (!done) return
  const bytes = /** @type {Buffer} */ (queue.shift())
  counts.reported++
  keepIn(incon, incon.reported, { at: clock.now(), bytes })
}

// --- the NC

function ncLook(incon) {
  const { clock, ncSender, ncReceiver, counts, transmit } = incon
  ncReceiver.look()
  const bytes = ncSender.look()
  if (!bytes) return
  counts.lines++
  const at = clock.now()
  const end = transmit ? transmit(bytes) : at
  keepIn(incon, incon.sent, { at, end, bytes, text: textOf(bytes) })
  const left = () => {
    if (incon.ncSender !== ncSender) return
    ncSender.sent()
    incon.program?.left()
    ncLook(incon)
    wake(incon)
  }
  clock.setTimer(left, end - at, { quiet: true })
}

function hear(incon, bytes) {
  incon.ncReceiver.put(bytes)
  incon.counts.bytesIn += bytes.length
  incon.counts.bytesLost = incon.ncReceiver.lost
  wake(incon)
  return []
}

// --- what it is told to do

function say(incon, text) {
  const bytes = Buffer.from(text)
  if (incon.program) incon.program.say(bytes)
  else queueLine(incon, text, bytes)
  wake(incon)
}

function queueLine(incon, text, bytes) {
  const sealed = incon.checked ? seal(bytes, incon.number) : bytes
  if (incon.checked) incon.number = nextNumber(incon.number)
  // bytes are sent as they are; a text is a line
  incon.queue.push(typeof text === 'string' || incon.checked ? Buffer.concat([sealed, END]) : sealed)
}

function startMCode(incon, data) {
  Object.assign(incon.mCode, { flag: true, data, finish: 0 })
  wake(incon)
}

function startEvents(incon) {
  const { events, every, clock } = incon
  if (events.length === 0 || !(every > 0)) return
  let next = 0
  const tick = () => {
    say(incon, events[next++ % events.length])
    incon.eventTimer = clock.setTimer(tick, every, { quiet: true })
  }
  incon.eventTimer = clock.setTimer(tick, every, { quiet: true })
}

function close({ clock, timer, eventTimer, dueTimer }) {
  clock.clearTimer(timer)
  clock.clearTimer(dueTimer)
  clock.clearTimer(eventTimer)
}

function keepIn({ keep }, list, entry) {
  list.push(entry)
  if (list.length > keep) list.shift()
}

/**
 * @typedef {object} InconController
 * @property {number} station
 * @property {{ messages: number, bytesIn: number, bytesLost: number, damaged: number, missing: number, overwritten: number, lines: number,
 *   reported: number, mCodes: number, confirmed: number, unknown: number, repeats: number, repeated: number, acks: number }} counts bytesLost: for which SerialLinkRecv had no room; damaged, missing: of the checked format;
 *   overwritten: the manual's strCopy wrote past its array; lines: sent; reported: what the program takes for sent; of
 *   the acknowledged format: confirmed and unknown lines of its own, repeats of these, lines that came again, acknowledgements
 * @property {{ at: number, bytes: Buffer, text: string, shown: string, full: boolean, valid?: boolean, number?: number|null, missing?: number }[]} messages
 *   that the PLC's program took: `text` without line end (checked format: without number and check, if `valid`), `shown` what the manual's example displays
 * @property {{ at: number, end: number, bytes: Buffer, text: string }[]} sent
 * @property {{ at: number, bytes: Buffer }[]} reported
 * @property {{ text: string, outcome: 'confirmed'|'unknown'|'failed', attempts?: number }[]} outcomes acknowledged format: of its own lines
 * @property {{ send: import('../codec/incon/handshake').Handshake, recv: import('../codec/incon/handshake').Handshake }} structures
 * @property {(send: (bytes: Buffer) => number) => void} speak for the wire
 * @property {() => number} appetite for the wire
 * @property {(bytes: Buffer, times?: { start: number, end: number }) => any[]} receive for the wire
 * @property {(bytes: Buffer) => Buffer} disguise for the wire
 * @property {(text: string|Uint8Array) => void} say the PLC's program sends a line, or bytes as they are
 * @property {(data: number) => void} mCode the NC's program comes to an M code; 68 sends `Test`
 * @property {() => void} restart it is switched off and on: its programs begin anew
 * @property {() => void} close no scan and no event any more
 */

module.exports = { createInconController }
