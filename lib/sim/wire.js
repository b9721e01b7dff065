'use strict'

const { PlcError } = require('../error')
const { createRandom } = require('./random')
const { applyFault } = require('./faults')
const { cutOff, idleAt, transmit } = require('./wire-bytes')

/**
 * One line with several stations and one or more masters. Every byte takes its time on the wire, in both directions; on a
 * half-duplex line everybody hears everybody, and two who send at once spoil each other's bytes.
 *
 * @param {{ clock: any, baudRate?: number, bitsPerByte?: number, echo?: boolean, collisions?: boolean | 'seen', chunk?: number | (() => number),
 *   duplex?: 'half'|'full', wear?: { damaged?: number, lost?: number } | null, faults?: import('./faults').Faults | null, random?: import('./random').Random }} options
 *   echo: a master hears itself (2-wire adapter) · chunk: bytes that arrive at once (16, as from a UART), or a function ·
 *   collisions: two who send at once spoil both at random (default) · `seen`: in a way that no check code misses · false: the second one
 *   waits until the line is free · duplex: `full` has a pair of wires for each direction (RS-232, RS-422): masters and stations do not
 *   disturb each other · wear: rates (0 to 1) of bytes that are damaged or lost, both ways
 * @returns {Wire}
 */
function createWire(options) {
  const wire = {
    byteMs: ((options.bitsPerByte ?? 10) * 1000) / (options.baudRate ?? 19200),
    echo: false,
    collisions: true,
    duplex: 'half',
    wear: null,
    chunk: 16,
    faults: null,
    random: createRandom(1),
    ...options,
    /** @type {Set<any>} */
    parties: new Set(),
    /** @type {any[]} */
    active: [],
    ctsOn: true,
    plugged: true,
    counts: { frames: 0, bytes: 0, collisions: 0 }
  }
  return {
    byteMs: wire.byteMs,
    counts: wire.counts,
    add: station => join(wire, station),
    remove: number => partiesOf(wire, number).forEach(party => wire.parties.delete(party)),
    stations: () => stationsOf(wire),
    setOff: (number, off) => setOff(wire, number, off),
    connect: handlers => connect(wire, handlers),
    noise: bytes => transmit(wire, { busyUntil: 0 }, { bytes, at: wire.clock.now() }),
    idleAt: () => idleAt(wire),
    setEcho: on => void (wire.echo = on),
    setWear: wear => void (wire.wear = wear),
    unplug: () => unplug(wire),
    plug: () => void (wire.plugged = true)
  }
}

function unplug(wire) {
  wire.plugged = false
  const masters = [...wire.parties].filter(party => party.handlers)
  for (const master of masters) {
    cutOff(wire, master)
    wire.parties.delete(master)
  }
  masters.forEach(master => master.handlers.closed())
}

const stationsOf = ({ parties }) => [...parties].filter(({ station }) => station).map(({ station }) => station)
const numbersOf = wire => stationsOf(wire).map(({ station }) => station)
const partiesOf = (wire, number) => [...wire.parties].filter(({ station }) => station?.station === number)

function setOff(wire, number, off) {
  for (const party of partiesOf(wire, number)) party.off = off
  tellCts(wire)
}

/** A station may also speak by itself: it is given what it needs for it, once. */
function join(wire, station) {
  const party = createParty(wire, station)
  wire.parties.add(party)
  station.speak?.((bytes, options) => speak(wire, party, { bytes, ...options }), {
    faulty: bytes => faulty(wire, party, bytes),
    idleAt: () => idleAt(wire, party),
    cts: on => {
      party.cts = on
      tellCts(wire)
    }
  })
}

/** @returns {number} when the last byte has passed; now, where nothing goes out */
function speak(wire, party, { bytes, faults = true, at }) {
  const now = at ?? wire.clock.now()
  if (party.off || !wire.parties.has(party)) return now
  const pieces = faults ? faulty(wire, party, bytes) : [{ bytes, at }]
  return pieces.reduce((end, piece) => Math.max(end, later(wire, party, piece)), now)
}

/** What goes out in place of a message that nobody asked for: the faults that concern answers, and silence for the others. */
function faulty(wire, party, bytes) {
  const { random, faults } = wire
  const { previous, station } = party
  party.previous = bytes
  const fault = faults ? faults.draw(station.station) : null
  if (!fault || fault.kind === 'error') return [{ bytes }]
  if (fault.kind === 'lost') return []
  if (fault.kind === 'off') {
    goDark(wire, party, fault.argument)
    return []
  }
  const request = Buffer.alloc(0)
  return applyFault(fault.kind, {
    bytes,
    previous,
    request,
    station,
    random,
    argument: fault.argument,
    taken: numbersOf(wire)
  })
}

function goDark({ clock }, party, ms) {
  party.off = true
  clock.setTimer(() => (party.off = false), ms, { quiet: true })
}

/** A station's DTR is the masters' CTS; one without power has none. */
const isCts = ({ parties }) => ![...parties].some(({ cts, off }) => cts !== undefined && (off || !cts))

function tellCts(wire) {
  const on = isCts(wire)
  if (on === wire.ctsOn) return
  wire.ctsOn = on
  for (const { handlers } of [...wire.parties]) handlers?.cts?.(on)
}

/** A station on the wire: hears bytes, answers after its turnaround, through the faults. */
function createParty(wire, station) {
  const party = { station, busyUntil: 0, off: false, cts: undefined, previous: null, hear: /** @type {any} */ (null) }
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
    return goDark(wire, party, fault.argument)
  }
  // by the wire's own time: on a real clock a timer that comes late delays no byte
  const due = job.heard + job.turnaround
  const answer = () => {
    const bytes = job.answer(fault?.kind === 'error' ? fault.argument : undefined)
    if (!bytes) return
    const { previous } = party
    party.previous = bytes
    if (!fault) return void transmit(wire, party, { bytes, at: due })
    const { station } = party
    const taken = numbersOf(wire)
    const context = { bytes, previous, request: job.request, station, random, argument: fault.argument, taken }
    for (const piece of applyFault(fault.kind, context)) later(wire, party, piece)
  }
  clock.setTimer(answer, due - clock.now(), { quiet: true })
}

function later(wire, party, { bytes, after = 0, at = /** @type {number | undefined} */ (undefined) }) {
  const { clock } = wire
  const send = () => transmit(wire, party, { bytes, at: at ?? clock.now() })
  if (!(after > 0)) return send()
  clock.setTimer(send, after, { quiet: true })
  return clock.now() + after + bytes.length * wire.byteMs
}

function connect(wire, handlers) {
  if (!wire.plugged) throw new PlcError('PORT_GONE', { path: 'simulated' })
  const master = {
    handlers,
    busyUntil: 0,
    hear: bytes => handlers.data(bytes)
  }
  wire.parties.add(master)
  if (!isCts(wire)) handlers.cts?.(false)
  return {
    write: bytes => {
      if (wire.parties.has(master)) transmit(wire, master, { bytes, at: wire.clock.now() })
    },
    close: () => void wire.parties.delete(master)
  }
}

/**
 * @typedef {object} Wire
 * @property {number} byteMs wire time of one byte
 * @property {{ frames: number, bytes: number, collisions: number }} counts
 * @property {(station: any) => void} add a station (nx-plc.js, chino-regulator.js, melsec-c24.js). One that speaks by itself has `speak(send,
 *   port)`, called once: `send(bytes, { faults, at })` → when the last byte has passed (`at`: when they were due, where a timer is late); `port`: `faulty(bytes)` → [{ bytes, after }] that go out
 *   instead, `idleAt()`, `cts(on)`. One that may react to any byte has `appetite()`: how many bytes it can hear at once
 * @property {(number: number) => void} remove what it still has to answer goes out
 * @property {() => any[]} stations
 * @property {(number: number, off: boolean) => void} setOff a station without power
 * @property {(handlers: { data: (bytes: Buffer) => void, closed: () => void, cts?: (on: boolean) => void }) => { write: (bytes: Buffer) => void, close:
 *   () => void }} connect a master; throws PORT_GONE while unplugged. `cts`: what a station's DTR says, at first only if it is off
 * @property {(bytes: Buffer) => void} noise bytes from nowhere
 * @property {() => number} idleAt when the last byte that is on its way has passed, ms of the clock
 * @property {(on: boolean) => void} setEcho
 * @property {(wear: { damaged?: number, lost?: number } | null) => void} setWear
 * @property {() => void} unplug every master's `closed` is called once
 * @property {() => void} plug
 */

module.exports = { createWire }
