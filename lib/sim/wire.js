'use strict'

const { PlcError } = require('../error')
const { createRandom } = require('./random')
const { applyFault } = require('./faults')

/**
 * One half-duplex line with several stations and one or more masters. Every byte takes its time on the wire, in both directions;
 * everybody hears everybody; two who send at once spoil each other's bytes.
 *
 * @param {{ clock: any, baudRate?: number, bitsPerByte?: number, echo?: boolean, collisions?: boolean | 'seen', chunk?: number | (() => number),
 *   faults?: import('./faults').Faults | null, random?: import('./random').Random }} options
 *   echo: a master hears itself (2-wire adapter) · chunk: bytes that arrive at once (16, as from a UART), or a function ·
 *   collisions: two who send at once spoil both at random (default) · `seen`: in a way that no check code misses · false: the second one
 *   waits until the line is free
 * @returns {Wire}
 */
function createWire(options) {
  const wire = {
    byteMs: ((options.bitsPerByte ?? 10) * 1000) / (options.baudRate ?? 19200),
    echo: false,
    collisions: true,
    chunk: 16,
    faults: null,
    random: createRandom(1),
    ...options,
    /** @type {Set<any>} */
    parties: new Set(),
    /** @type {any[]} */
    active: [],
    plugged: true,
    counts: { frames: 0, bytes: 0, collisions: 0 }
  }
  return {
    byteMs: wire.byteMs,
    counts: wire.counts,
    add: station => void wire.parties.add(createParty(wire, station)),
    remove: number => partiesOf(wire, number).forEach(party => wire.parties.delete(party)),
    stations: () => stationsOf(wire),
    setOff: (number, off) => partiesOf(wire, number).forEach(party => (party.off = off)),
    connect: handlers => connect(wire, handlers),
    noise: bytes => transmit(wire, { busyUntil: 0 }, { bytes, at: wire.clock.now() }),
    idleAt: () => idleAt(wire),
    setEcho: on => void (wire.echo = on),
    unplug() {
      wire.plugged = false
      const masters = [...wire.parties].filter(party => party.handlers)
      masters.forEach(master => wire.parties.delete(master))
      masters.forEach(master => master.handlers.closed())
    },
    plug: () => void (wire.plugged = true)
  }
}

const idleAt = ({ active }) => active.reduce((latest, { end }) => Math.max(latest, end), 0)

const stationsOf = ({ parties }) => [...parties].filter(({ station }) => station).map(({ station }) => station)
const numbersOf = wire => stationsOf(wire).map(({ station }) => station)
const partiesOf = (wire, number) => [...wire.parties].filter(({ station }) => station?.station === number)

/** A station on the wire: hears bytes, answers after its turnaround, through the faults. */
function createParty(wire, station) {
  const party = { station, busyUntil: 0, off: false, previous: null, hear: /** @type {any} */ (null) }
  party.hear = (bytes, times) => {
    if (party.off) return
    for (const job of station.receive(bytes, times)) serve(wire, party, { ...job, heard: times.end })
  }
  return party
}

function serve(wire, party, job) {
  const { clock, faults, random } = wire
  const fault = faults ? faults.draw(party.station.station) : null
  if (fault?.kind === 'lost') return
  if (fault?.kind === 'off') {
    party.off = true
    clock.setTimer(() => (party.off = false), fault.argument, { quiet: true })
    return
  }
  // by the wire's own time: on a real clock a timer that comes late delays no byte
  const due = job.heard + job.turnaround
  const answer = () => {
    const bytes = job.answer(fault?.kind === 'error' ? fault.argument : undefined)
    if (!bytes) return
    const { previous } = party
    party.previous = bytes
    if (!fault) return transmit(wire, party, { bytes, at: due })
    const { station } = party
    const taken = numbersOf(wire)
    const context = { bytes, previous, request: job.request, station, random, argument: fault.argument, taken }
    for (const piece of applyFault(fault.kind, context)) later(wire, party, piece)
  }
  clock.setTimer(answer, due - clock.now(), { quiet: true })
}

function later(wire, party, { bytes, after = 0 }) {
  const { clock } = wire
  const send = () => transmit(wire, party, { bytes, at: clock.now() })
  if (after > 0) clock.setTimer(send, after, { quiet: true })
  else send()
}

function connect(wire, handlers) {
  if (!wire.plugged) throw new PlcError('PORT_GONE', { path: 'simulated' })
  const master = {
    handlers,
    busyUntil: 0,
    hear: (bytes, times, from) => {
      if (from !== master || wire.echo) handlers.data(bytes)
    }
  }
  wire.parties.add(master)
  return {
    write: bytes => {
      if (wire.parties.has(master)) transmit(wire, master, { bytes, at: wire.clock.now() })
    },
    close: () => void wire.parties.delete(master)
  }
}

/** Puts bytes on the wire, behind what the same sender still has to send. */
function transmit(wire, from, { bytes, at }) {
  if (bytes.length === 0) return
  const start = Math.max(at, from.busyUntil, wire.collisions ? 0 : idleAt(wire))
  const end = start + bytes.length * wire.byteMs
  const sending = { from, bytes: Buffer.from(bytes), sent: bytes, start, end, told: 0 }
  from.busyUntil = end
  wire.counts.frames++
  wire.counts.bytes += bytes.length
  if (wire.collisions && wire.active.length > 0) collide(wire, sending)
  wire.active.push(sending)
  schedule(wire, sending)
}

/** Where two senders overlap, both bytes are spoilt; what was heard before stays heard. */
function collide(wire, sending) {
  for (const other of wire.active) {
    if (other.from === sending.from || other.end <= sending.start || sending.end <= other.start) continue
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
  const { bytes, start, told, from } = sending
  // a master's frame reaches the stations whole: they need no pieces, and a timer each would be wasted
  const piece = from.station || wire.echo || !from.handlers ? pieceOf(wire) : bytes.length
  const until = start + Math.min(bytes.length, told + piece) * byteMs
  const quiet = ![...wire.parties].some(party => party.handlers && (party !== from || wire.echo))
  clock.setTimer(() => arrive(wire, sending), until - clock.now(), { quiet })
}

const pieceOf = ({ chunk }) => Math.max(1, typeof chunk === 'function' ? chunk() : chunk)

/** What has come over the wire by now is heard: floor(elapsed × baud / 10) bytes, however late the timer is. */
function arrive(wire, sending) {
  const { clock, byteMs, parties, active } = wire
  const { bytes, start, from } = sending
  // timers of a real clock may overtake each other; the bytes of one sender do not
  const overtaken = each => each.from === from && each.start < start && each.end <= clock.now()
  for (const earlier of active.filter(overtaken)) arrive(wire, earlier)
  const { told } = sending
  if (told === bytes.length) return
  const count = Math.min(bytes.length, Math.floor((clock.now() - start) / byteMs + 1e-6))
  if (count > told) {
    const piece = bytes.subarray(told, count)
    const times = { start: start + told * byteMs, end: start + count * byteMs }
    sending.told = count
    for (const party of [...parties]) if (party !== from || party.handlers) party.hear(piece, times, from)
  }
  if (count < bytes.length) return schedule(wire, sending)
  active.splice(active.indexOf(sending), 1)
}

/**
 * @typedef {object} Wire
 * @property {number} byteMs wire time of one byte
 * @property {{ frames: number, bytes: number, collisions: number }} counts
 * @property {(station: any) => void} add a station (nx-plc.js, chino-regulator.js)
 * @property {(number: number) => void} remove what it still has to answer goes out
 * @property {() => any[]} stations
 * @property {(number: number, off: boolean) => void} setOff a station without power
 * @property {(handlers: { data: (bytes: Buffer) => void, closed: () => void }) => { write: (bytes: Buffer) => void, close: () => void }} connect
 *   a master; throws PORT_GONE while unplugged
 * @property {(bytes: Buffer) => void} noise bytes from nowhere
 * @property {() => number} idleAt when the last byte that is on its way has passed, ms of the clock
 * @property {(on: boolean) => void} setEcho
 * @property {() => void} unplug every master's `closed` is called once
 * @property {() => void} plug
 */

module.exports = { createWire }
