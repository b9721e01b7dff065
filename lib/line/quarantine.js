'use strict'

const { EMPTY } = require('./receiver')

const LEAST_BOUND = 1000
const MARGIN = 1.5
const MOST_WATCHERS = 32
const MOST_BYTES = 600
/** A watcher lives twice the bound: an answer that is later than expected still teaches its lateness. */
const WATCH = 2
/** No station is believed to be later than this, ms. */
const MOST_LEARNT = 60000

/**
 * After a timeout a station is left alone until it has been silent for as long as one of its answers may be late; the
 * other stations go on. The recogniser of each unanswered step is kept and offered all bytes that belong to nobody:
 * so a late answer is seen, its lateness learnt, and the station's silence starts anew.
 */
class Quarantine {
  #clock
  #memories
  #late
  #watchers = []

  /**
   * @param {{ clock: any, memories: Map<any, any>, late: (fact: any, bytes: Buffer) => void }} options
   *   memories: per station, kept by the pool; late: told of each late answer
   */
  constructor({ clock, memories, late }) {
    this.#clock = clock
    this.#memories = memories
    this.#late = late
  }

  /** The station's memory; survives redeploys. */
  memory(station) {
    let memory = this.#memories.get(station)
    if (!memory) {
      memory = { asked: false, base: LEAST_BOUND, lateness: 0, bound: LEAST_BOUND, until: 0 }
      this.#memories.set(station, memory)
    }
    return memory
  }

  /** A step goes out. @param {any} station @param {{ timeout: number, latenessBound: number }} times */
  asked(station, { timeout, latenessBound }) {
    const memory = this.memory(station)
    memory.asked = true
    memory.base = latenessBound > 0 ? latenessBound : Math.max(timeout, LEAST_BOUND)
    this.#bind(memory)
  }

  #bind(memory) {
    memory.bound = Math.max(memory.base, memory.lateness * MARGIN)
  }

  /** When the station may be asked, ms of the clock. */
  readyAt(station) {
    return this.#memories.get(station)?.until ?? 0
  }

  /**
   * A step ended without its answer.
   * @param {{ station: any, match: any, due: number, timeout: number, seen: Buffer }} step
   *   due: when the answer should have begun; seen: bytes of it that came
   */
  failed({ station, match, due, timeout, seen }) {
    const memory = this.memory(station)
    const from = Math.max(this.#clock.now(), due)
    memory.until = Math.max(memory.until, from + memory.bound)
    if (!match) return
    this.#watchers.push({ station, match, due, timeout, bytes: EMPTY, until: from + WATCH * memory.bound })
    if (this.#watchers.length > MOST_WATCHERS) this.#watchers.shift()
    if (seen.length > 0) this.#watchers[this.#watchers.length - 1].bytes = seen
  }

  /** The port was opened: what lies in the buffers of adapters and servers may be answers to old queries. */
  opened() {
    const now = this.#clock.now()
    for (const memory of this.#memories.values()) {
      if (memory.asked) memory.until = Math.max(memory.until, now + memory.bound)
    }
  }

  /** An answer was taken: recognisers that cannot tell it from a late one know nothing any more. */
  answered(station, frame) {
    if (this.#watchers.length === 0) return
    this.#watchers = this.#watchers.filter(w => w.station !== station || !(w.match(frame).take > 0))
  }

  /** Bytes that belong to nobody. @param {Buffer} bytes */
  offer(bytes) {
    if (this.#watchers.length === 0) return
    const now = this.#clock.now()
    this.#watchers = this.#watchers.filter(w => w.until > now)
    for (const watcher of [...this.#watchers]) this.#look(watcher, bytes, now)
  }

  #look(watcher, bytes, now) {
    watcher.bytes = watcher.bytes.length === 0 ? bytes : Buffer.concat([watcher.bytes, bytes])
    while (watcher.bytes.length > 0) {
      const { take, skip, bad, length } = watcher.match(watcher.bytes)
      if (take > 0) return this.#taken(watcher, watcher.bytes.subarray(0, take), now)
      const drop = bad ? (length ?? watcher.bytes.length) : (skip ?? 0)
      if (!(drop > 0)) break
      watcher.bytes = watcher.bytes.subarray(drop)
    }
    if (watcher.bytes.length > MOST_BYTES) watcher.bytes = watcher.bytes.subarray(watcher.bytes.length - MOST_BYTES)
  }

  #taken(watcher, frame, now) {
    const { station, timeout, due } = watcher
    this.#watchers = this.#watchers.filter(w => w !== watcher)
    const memory = this.memory(station)
    const lateness = now - due
    // in time, but nobody waited any more (a redeploy): nothing else can come
    if (lateness <= 0) {
      if (!this.#watchers.some(w => w.station === station)) memory.until = Math.min(memory.until, now)
      return
    }
    memory.lateness = Math.min(MOST_LEARNT, Math.max(memory.lateness, lateness))
    this.#bind(memory)
    memory.until = Math.max(memory.until, now + memory.bound)
    this.#late({ station, lateness, timeout, bound: memory.bound }, frame)
  }
}

module.exports = { Quarantine }
