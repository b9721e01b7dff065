'use strict'

/** Frames that are kept before a fault, and after it. */
const BEFORE = 200
const AFTER = 200
/** Events among them: while a line is down no frame ends a window. */
const MOST_EVENTS = 100
/** Entries that are kept until the oldest are dropped. */
const MOST_KEPT = 2 * (BEFORE + MOST_EVENTS)
/** Stations with faults that go on; one more, and all count as new. */
const MOST_STATIONS = 1000

/** Events after which what was on the wire is worth keeping; of all others they are kept themselves. */
const FAULTS = ['late', 'jammed', 'lineDown', 'stationDemoted', 'fixedMasterId']
/** What became of a write that somebody may ask about. */
const DOUBTFUL = ['unknown', 'failed']
/** Nobody acknowledges a broadcast: that is how it works. */
const USUAL = 'BROADCAST_UNCONFIRMED'

/** A record of a write that is as it should be: there is one for each write. @param {any} event */
const isRoutine = ({ event, outcome, code }) => event === 'audit' && (!DOUBTFUL.includes(outcome) || code === USUAL)
/** @param {any} event */
const isFault = event => FAULTS.includes(event.event) || event.event === 'audit'
const nameOf = ({ event, outcome }) => (event === 'audit' ? `${event} ${outcome}` : event)

/**
 * The frames before and after each fault of a wire, with the events. Each frame is given away once, however many faults it lies between. A fault
 * that goes on (same station, same code, no good answer between) gives nothing more away. Knows no disk: `give` gets what is to be kept, in order:
 * `{ is: 'frame', row }`, `{ is: 'event', event }`, `{ is: 'fault', t, station, code }`.
 */
class Evidence {
  #clock
  #give
  /** What no fault has asked for yet. @type {any[]} */
  #before = []
  #frames = 0
  #after = 0
  #eventsAfter = 0
  /** Of each station what goes on. @type {Map<any, Set<string>>} */
  #going = new Map()

  /** @param {{ clock: any, give: (entry: any) => void }} options */
  constructor({ clock, give }) {
    this.#clock = clock
    this.#give = give
  }

  /** @param {any} row of the trace: the object itself, it may still grow */
  frame(row) {
    if (this.#after > 0) {
      this.#after--
      return this.#give({ is: 'frame', row })
    }
    this.#frames++
    this.#keep({ is: 'frame', row })
  }

  #keep(entry) {
    this.#before.push(entry)
    // many at once: to take the first out of a long list at each frame costs more than all else here
    if (this.#before.length >= MOST_KEPT) this.#trim()
  }

  /** What is too old to be given away. */
  #trim() {
    let count = 0
    while (this.#frames > BEFORE || this.#before.length - count > BEFORE + MOST_EVENTS) {
      if (this.#before[count++].is === 'frame') this.#frames--
    }
    this.#before.splice(0, count)
  }

  /** Something went wrong on the wire. @param {any} station null: the line's @param {string} code */
  fault(station, code) {
    if (this.#isNew(station, code)) this.#open(station, code)
  }

  /** The station, and so the line, works. @param {any} station */
  good(station) {
    if (this.#going.size === 0) return
    this.#going.delete(station)
    this.#going.delete(null)
  }

  /** @param {any} event that was reported */
  event(event) {
    const name = nameOf(event)
    const isNew = !isRoutine(event) && this.#isNew(event.station, name)
    if (isNew && isFault(event)) this.#open(event.station, name)
    const entry = { is: 'event', event }
    if (this.#after > 0 && this.#eventsAfter > 0) {
      this.#eventsAfter--
      this.#give(entry)
    } else if (isNew && !isFault(event)) this.#give(entry)
    else this.#keep(entry)
  }

  #isNew(station, code) {
    if (this.#going.size >= MOST_STATIONS) this.#going.clear()
    const codes = this.#going.get(station) ?? new Set()
    if (codes.has(code)) return false
    this.#going.set(station, codes.add(code))
    return true
  }

  #open(station, code) {
    this.#trim()
    for (const entry of this.#before.splice(0)) this.#give(entry)
    this.#frames = 0
    this.#after = AFTER
    this.#eventsAfter = MOST_EVENTS
    this.#give({ is: 'fault', t: this.#clock.wall(), station, code })
  }
}

module.exports = { Evidence }
