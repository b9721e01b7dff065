'use strict'

const { OS_AREA } = require('./c24-settings')
const { CODES, DC1, DC3, LITERAL } = require('./c24-bytes')
const { BidirectionalFraming, FreeFraming } = require('./c24-framing')

const HEARD_AT_ONCE = 16

/**
 * Receiving side: from the wire through the OS area into the receive area, which holds one message until the sequence program has
 * taken it. While it does, everything else waits in the OS area.
 *
 * @param {any} settings of c24-settings.js
 * @param {{ counts: any, memory: any, tell: (stop: boolean) => void, allow: (on: boolean) => void, arrived: (message: any) => void,
 *   answered: (answer: any) => void, refuse: (code: number) => void, crossed: () => boolean }} out tell: the peer may send or not · allow: the peer's
 *   DC codes · arrived: a message stands in the receive area · crossed: a message comes in; false: it does not count
 */
function createC24Receiver(settings, out) {
  const free = settings.protocol === 'non-procedure'
  const { counts } = out
  /** @type {any} */
  const framing = free ? new FreeFraming(settings, counts) : new BidirectionalFraming(settings, counts)
  const c24 = { settings, out, framing, ...emptyState() }
  return {
    receive: bytes => receive(c24, bytes),
    appetite: () => appetite(c24),
    /** The sequence program has read the receive area. */
    released() {
      c24.occupied = false
      pump(c24)
      regulate(c24)
    },
    held: () => c24.held,
    stopped: () => c24.stopped,
    reset() {
      settings.clock.clearTimer(c24.timer)
      framing.reset()
      Object.assign(c24, emptyState())
    }
  }
}

const emptyState = () => ({
  /** the OS area: bytes (non-procedure) in a ring, or whole messages (bidirectional) */
  ring: new Uint16Array(OS_AREA),
  head: 0,
  held: 0,
  /** places behind which timer 0 ended a message, counted from the first byte ever */
  cuts: /** @type {number[]} */ ([]),
  in: 0,
  passed: 0,
  waiting: /** @type {any[]} */ ([]),
  occupied: false,
  pumping: false,
  stopped: false,
  escaped: false,
  valid: true,
  timer: /** @type {any} */ (null)
})

function receive(c24, bytes) {
  const { settings, out } = c24
  out.counts.bytesIn += bytes.length
  for (const byte of bytes) hear(c24, byte)
  if (settings.timer0Ms > 0) rewind(c24)
  return []
}

/** One byte at the port: transmission control and the transparent code are looked at first. */
function hear(c24, byte) {
  const { settings, out, framing, escaped } = c24
  c24.escaped = false
  if (escaped) return store(c24, byte | LITERAL)
  if (framing.bare?.()) store(c24, byte)
  else if (settings.transparent.length > 0 && byte === settings.transparent[0]) c24.escaped = true
  else if (settings.flow === 'dc' && (byte === DC1 || byte === DC3)) out.allow(byte === DC1)
  else store(c24, byte)
}

function store(c24, value) {
  const { settings, framing } = c24
  if (settings.protocol === 'bidirectional') return converse(c24, value)
  if (c24.occupied) {
    if (!put(c24, value)) return
    return regulate(c24)
  }
  c24.in++
  c24.passed++
  deliver(c24, framing.feed(value))
}

/** Behind the last one in the OS area; without room it is discarded, and the error stays until the program clears it. */
function put(c24, value) {
  if (c24.held === OS_AREA) {
    lose(c24, 1)
    return false
  }
  c24.ring[(c24.head + c24.held++) % OS_AREA] = value
  c24.in++
  return true
}

function lose({ out: { counts, memory } }, bytes) {
  counts.discarded += bytes
  if (!memory.sioError()) counts.sioErrors++
  memory.setSioError(true)
}

/** At `stopFree` bytes or less the peer is asked to stop, at `goFree` or more it may go on. */
function regulate(c24) {
  const { settings, out } = c24
  const room = OS_AREA - c24.held
  out.counts.mostHeld = Math.max(out.counts.mostHeld, c24.held)
  if (settings.flow === 'none') return
  if (!c24.stopped && room <= settings.stopFree) c24.stopped = true
  else if (c24.stopped && room >= settings.goFree) c24.stopped = false
  else return
  out.counts[c24.stopped ? 'stops' : 'goes']++
  out.tell(c24.stopped)
}

/** While the receive area is free, the OS area empties into it. */
function pump(c24) {
  if (c24.pumping) return
  c24.pumping = true
  while (!c24.occupied && c24.waiting.length > 0) {
    const message = c24.waiting.shift()
    c24.held -= message.bytes.length
    deliver(c24, message)
  }
  while (!c24.occupied && (c24.held > 0 || c24.cuts[0] === c24.passed)) {
    if (c24.cuts[0] === c24.passed) {
      c24.cuts.shift()
      deliver(c24, c24.framing.cut())
      continue
    }
    const value = c24.ring[c24.head]
    c24.head = (c24.head + 1) % OS_AREA
    c24.held--
    c24.passed++
    deliver(c24, c24.framing.feed(value))
  }
  c24.pumping = false
}

function deliver(c24, taken) {
  const { settings, out } = c24
  if (!taken) return
  const { counts, memory } = out
  if (taken.by === 'timer') counts.timeouts++
  if (!taken.bytes) return void counts.conversionErrors++
  c24.occupied = true
  counts.messages++
  const { bytes, count } = memory.received(taken.bytes, taken.frames)
  memory.result('receive', 0)
  out.arrived({ at: settings.clock.now(), by: taken.by, bytes, count })
}

/** Bidirectional: answers must not wait behind a full receive area, so messages are cut before they wait. */
function converse(c24, value) {
  const { framing, out } = c24
  if (framing.starts(value)) c24.valid = out.crossed()
  take(c24, framing.feed(value))
}

function take(c24, result) {
  const { out } = c24
  if (!result) return
  if (result.answer) return out.answered(result)
  if (!c24.valid) return void out.counts.invalid++
  if (result.refuse) return out.refuse(result.refuse)
  const { length } = result.bytes
  if (!c24.occupied) return deliver(c24, result)
  if (c24.held + length > OS_AREA) {
    lose(c24, length)
    return out.refuse(CODES.full)
  }
  c24.waiting.push(result)
  c24.held += length
  regulate(c24)
}

/** Timer 0 runs from each byte while a message is not complete. */
function rewind(c24) {
  const { clock, timer0Ms } = c24.settings
  clock.clearTimer(c24.timer)
  c24.timer = clock.setTimer(() => timeUp(c24), timer0Ms, { quiet: true })
}

function timeUp(c24) {
  const { settings, framing } = c24
  if (settings.protocol === 'bidirectional') return take(c24, framing.cut())
  if (c24.held > 0) return void c24.cuts.push(c24.in)
  if (c24.occupied) return
  deliver(c24, framing.cut())
}

/** How many bytes can be heard at once without missing the moment at which the peer must be stopped, or timer 0. */
function appetite({ settings, held, stopped }) {
  const { timer0, flow, stopFree } = settings
  const pause = timer0 > 0 ? Math.floor(timer0 * 1.2) : HEARD_AT_ONCE
  const room = flow === 'none' || stopped ? HEARD_AT_ONCE : OS_AREA - held - stopFree
  return Math.max(1, Math.min(HEARD_AT_ONCE, pause, room))
}

module.exports = { createC24Receiver }
