'use strict'

/** Bytes on their way: what each takes, who hears them, who spoils them. `wire` is what wire.js makes. */

/** A way is one pair of wires: the masters' and the stations' where both can send at once, else one for all. Noise is on both. */
const sameWay = ({ duplex }, one, other) =>
  duplex !== 'full' || isNoise(one) || isNoise(other) || Boolean(one.handlers) === Boolean(other.handlers)
const isNoise = ({ handlers, station }) => !handlers && !station

const hears = ({ duplex, echo }, party, from) => {
  if (party === from) return Boolean(party.handlers) && echo
  return duplex !== 'full' || isNoise(from) || Boolean(party.handlers) !== Boolean(from.handlers)
}

/** When the last byte has passed, or the last one that would meet those of `from`. */
const idleAt = (wire, from) =>
  wire.active.reduce(
    (latest, each) => (from && !sameWay(wire, each.from, from) ? latest : Math.max(latest, each.end)),
    0
  )

/**
 * Puts bytes on the wire, behind what the same sender still has to send.
 * @returns {number} when the last of them has passed
 */
function transmit(wire, from, { bytes, at }) {
  if (bytes.length === 0) return Math.max(at, from.busyUntil)
  const start = Math.max(at, from.busyUntil, wire.collisions ? 0 : idleAt(wire, from))
  const end = start + bytes.length * wire.byteMs
  const sending = { from, bytes: Buffer.from(bytes), sent: bytes, start, end, told: 0 }
  from.busyUntil = end
  wire.counts.frames++
  wire.counts.bytes += bytes.length
  if (wire.collisions && wire.active.length > 0) collide(wire, sending)
  wire.active.push(sending)
  schedule(wire, sending)
  return end
}

/** Where two senders overlap, both bytes are spoilt; what was heard before stays heard. */
function collide(wire, sending) {
  for (const other of wire.active) {
    if (other.from === sending.from || other.end <= sending.start || sending.end <= other.start) continue
    if (!sameWay(wire, other.from, sending.from)) continue
    wire.counts.collisions++
    spoil(wire, other, sending)
    spoil(wire, sending, other)
  }
}

function spoil({ byteMs, random, collisions }, victim, { start, end }) {
  const first = Math.max(victim.told, Math.floor((start - victim.start) / byteMs))
  const last = Math.min(victim.bytes.length, Math.ceil((end - victim.start) / byteMs))
  for (let n = first; n < last; n++) {
    // the highest bits alone of bytes in a row: no multiple of the CRC's polynomial, and no digit of ASCII
    if (collisions === 'seen') victim.bytes[n] = victim.sent[n] ^ 0x80
    else victim.bytes[n] ^= random.integer(1, 255)
  }
}

function schedule(wire, sending) {
  const { clock, byteMs } = wire
  const { bytes, start, told } = sending
  const listeners = [...wire.parties].filter(party => hears(wire, party, sending.from))
  const until = start + Math.min(bytes.length, told + pieceOf(wire, sending, listeners)) * byteMs
  // nothing but a master, or a station that may let one go on, touches a promise
  const quiet = !listeners.some(({ handlers, station }) => handlers || station.appetite)
  clock.setTimer(() => arrive(wire, sending), until - clock.now(), { quiet })
}

/**
 * How many bytes are heard at once. A master's frame reaches the stations whole: they need no pieces, and a timer each would be
 * wasted; but a station that may react to any byte (`appetite`) says how many it can hear at once.
 */
function pieceOf({ chunk, echo, active }, sending, listeners) {
  const { from, bytes } = sending
  const hungry = listeners.flatMap(({ station }) => (station?.appetite ? [station.appetite()] : []))
  // what they say is not true any more when bytes that are still on their way have come
  if (hungry.length > 0 && active.some(each => each.from === from && each !== sending)) return 1
  const whole = from.handlers && !echo
  const standard = whole ? bytes.length : typeof chunk === 'function' ? chunk() : chunk
  return Math.max(1, Math.min(standard, ...hungry))
}

/** What has come over the wire by now is heard: floor(elapsed × baud / 10) bytes, however late the timer is. */
function arrive(wire, sending) {
  const { clock, byteMs, active } = wire
  const { bytes, start, from } = sending
  // timers of a real clock may overtake each other; the bytes of one sender do not
  const overtaken = each => each.from === from && each.start < start && each.end <= clock.now()
  for (const earlier of active.filter(overtaken)) arrive(wire, earlier)
  const { told } = sending
  if (told === bytes.length) return
  const count = Math.min(bytes.length, Math.floor((clock.now() - start) / byteMs + 1e-6))
  if (count > told) {
    const times = { start: start + told * byteMs, end: start + count * byteMs }
    sending.told = count
    tell(wire, sending, { piece: worn(wire, bytes.subarray(told, count)), times })
  }
  if (count < bytes.length) return schedule(wire, sending)
  active.splice(active.indexOf(sending), 1)
}

/** The sender has no power any more: what it has not begun does not go out. */
function cutOff({ active, byteMs, clock }, from) {
  for (const sending of active.filter(each => each.from === from)) {
    const begun = Math.max(0, Math.ceil((clock.now() - sending.start) / byteMs))
    sending.bytes = sending.bytes.subarray(0, Math.max(sending.told, begun))
    sending.end = sending.start + sending.bytes.length * byteMs
    if (sending.told === sending.bytes.length) active.splice(active.indexOf(sending), 1)
  }
}

function tell(wire, { from }, { piece, times }) {
  if (piece.length === 0) return
  for (const party of [...wire.parties]) if (hears(wire, party, from)) party.hear(piece, times, from)
}

/** Single bytes that are damaged or lost, at the rates of `wear`, on their way to whomever. */
function worn({ wear, random }, piece) {
  if (!wear) return piece
  const { damaged = 0, lost = 0 } = wear
  const left = []
  for (const byte of piece) {
    const share = random.next()
    if (share < lost) continue
    left.push(share < lost + damaged ? byte ^ random.integer(1, 255) : byte)
  }
  return Buffer.from(left)
}

module.exports = { cutOff, idleAt, transmit }
