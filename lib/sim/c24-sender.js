'use strict'

const { bidirectionalMessage, freeMessage } = require('./c24-bytes')

const MOST_WAITING = 1000

/**
 * Sending side: messages one after the other, byte by byte, so that DC1/DC3 of both sides take effect inside a message.
 *
 * @param {any} settings of c24-settings.js
 * @param {{ counts: any, memory: any, done: (record: any) => void }} out
 */
function createC24Sender(settings, out) {
  const c24 = { settings, out, send: bytes => void bytes, port: /** @type {any} */ (null), ...emptyState() }
  return {
    attach(send, port) {
      c24.send = send
      c24.port = port
    },
    /** @param {Buffer} bytes as they stand in the sending area @param {{ end?: boolean }} options */
    message: (bytes, options) => enqueue(c24, bytes, options),
    /** Ahead of what is left of a message: DC codes, ACK and NAK. */
    control: bytes => void speak(c24, bytes),
    allow(on) {
      if (c24.allowed !== on) out.counts[on ? 'resumed' : 'halted']++
      c24.allowed = on
      next(c24)
    },
    answered: answer => answered(c24, answer),
    busy: () => c24.current !== null,
    /** Nobody is to confirm what is going out now: the peer's message came at the same time. */
    waive: () => void (c24.current && (c24.current.waived = true)),
    waiting: () => c24.queue.length,
    reset() {
      settings.clock.clearTimer(c24.timer)
      Object.assign(c24, emptyState())
    }
  }
}

const emptyState = () => ({
  queue: /** @type {any[]} */ ([]),
  current: /** @type {any} */ (null),
  allowed: true,
  busy: false,
  /** when the next byte is due, ms; null: a pause comes to an end now */
  due: /** @type {number | null} */ (null),
  timer: /** @type {any} */ (null)
})

function enqueue(c24, bytes, { end = true } = {}) {
  const { queue, out } = c24
  if (queue.length === MOST_WAITING) {
    out.counts.unsent++
    return
  }
  queue.push({ bytes: Buffer.from(bytes), end, attempts: 0, waived: false })
  next(c24)
}

/** What goes over the wire for the words of the sending area; `end` false: they alone. */
function wireBytes({ bytes, end }, settings) {
  if (settings.protocol === 'bidirectional') return bidirectionalMessage(bytes, settings)
  const none = Buffer.alloc(0)
  return freeMessage(bytes, end ? settings : { ...settings, first: none, last: none, end: none })
}

function next(c24) {
  if (c24.busy || !c24.allowed) return
  if (!c24.current) begin(c24)
  const { current } = c24
  if (!current || current.awaited) return
  const [part] = current.parts
  if (!part) return sent(c24)
  if (part.after > 0) {
    const { after } = part
    part.after = 0
    c24.due = null
    return pause(c24, after)
  }
  transmit(c24, part)
}

/** One byte; on a real clock, whose timers are late, as many as should have begun by now. */
function transmit(c24, part) {
  const { clock, byteMs } = c24.settings
  const now = clock.now()
  const at = c24.due ?? now
  const count = 1 + Math.max(0, Math.floor((now - at) / byteMs))
  const piece = part.bytes.subarray(0, count)
  part.bytes = part.bytes.subarray(count)
  if (part.bytes.length === 0) c24.current.parts.shift()
  c24.due = Math.max(at + piece.length * byteMs, speak(c24, piece, at))
  pause(c24, c24.due - now)
}

function speak(c24, bytes, at = c24.settings.clock.now()) {
  c24.out.counts.bytesOut += bytes.length
  return c24.send(bytes, { faults: false, at }) ?? at
}

function begin(c24) {
  const record = c24.queue.shift()
  if (!record) return
  const { settings, port, out } = c24
  out.memory.sending(record.bytes)
  const bytes = wireBytes(record, settings)
  record.attempts++
  const pieces = port ? port.faulty(bytes) : [{ bytes }]
  const parts = pieces.filter(piece => piece.bytes.length > 0).map(piece => ({ after: 0, ...piece }))
  c24.current = { ...record, parts, awaited: false, record }
}

/** A timer that does nothing but send on. */
function pause(c24, ms) {
  c24.busy = true
  c24.timer = c24.settings.clock.setTimer(
    () => {
      c24.busy = false
      next(c24)
      if (!c24.busy) c24.due = null
    },
    ms,
    { quiet: !c24.settings.onSent }
  )
}

function sent(c24) {
  const { settings, current } = c24
  if (settings.protocol === 'non-procedure') return finish(c24, { outcome: 'sent' })
  if (current.waived) return finish(c24, { outcome: 'failed', reason: 'simultaneous' })
  current.awaited = true
  c24.timer = settings.clock.setTimer(
    () => repeat(c24, { outcome: 'failed', reason: 'timeout' }),
    settings.ackTimeout,
    {
      quiet: !settings.onSent
    }
  )
}

function answered(c24, { answer, code = 0 }) {
  if (!c24.current?.awaited) return void c24.out.counts.skipped++
  c24.settings.clock.clearTimer(c24.timer)
  if (answer === 'ack') return finish(c24, { outcome: 'confirmed' })
  repeat(c24, { outcome: 'refused', code })
}

/** The module repeats nothing by itself; `retries` is a sequence program that does. */
function repeat(c24, result) {
  const { settings, current, out, queue } = c24
  if (current.record.attempts > settings.retries) return finish(c24, result)
  out.counts.repeated++
  queue.unshift(current.record)
  c24.current = null
  next(c24)
}

function finish(c24, result) {
  const { out, current, settings } = c24
  const { bytes, attempts } = current.record
  c24.current = null
  out.memory.result('send', result.code ?? (result.outcome === 'failed' ? 0x7f40 : 0))
  out.counts[result.outcome === 'failed' || result.outcome === 'refused' ? 'unsent' : 'sent']++
  out.done({ at: settings.clock.now(), bytes, attempts, ...result })
  next(c24)
}

module.exports = { createC24Sender }
