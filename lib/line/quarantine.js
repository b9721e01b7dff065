'use strict'

const { EMPTY } = require('./receiver')

/** Whoever looks at the end of a silence this late (ms) may come from a blocked process, whose input has not been read yet. */
const LAG = 2
const BREATH = 10
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
  #freed
  #hasPast
  #openedAt = -Infinity
  /** newest first */
  #watchers = []

  /**
   * @param {{ clock: any, memories: Map<any, any>, late: (fact: any, bytes: Buffer) => void, freed: () => void,
   *   hasPast: boolean }} options memories: per station, kept by the pool; late: told of each late answer; freed: a station
   *   may be asked earlier; hasPast: before this process another one, or another master, may have asked on this wire
   */
  constructor({ clock, memories, late, freed, hasPast }) {
    this.#hasPast = hasPast
    this.#clock = clock
    this.#memories = memories
    this.#late = late
    this.#freed = freed
  }

  /** The station's memory; survives redeploys. */
  memory(station) {
    let memory = this.#memories.get(station)
    if (!memory) {
      memory = { asked: false, base: LEAST_BOUND, lateness: 0, bound: LEAST_BOUND, until: 0, heard: 0 }
      this.#memories.set(station, memory)
    }
    return memory
  }

  /**
   * A step is about to go out. The first one to a station waits until what was asked before this process cannot be answered any more.
   * @param {any} station @param {{ timeout: number, latenessBound: number }} times
   */
  asks(station, { timeout, latenessBound }) {
    const memory = this.memory(station)
    memory.base = latenessBound > 0 ? latenessBound : Math.max(timeout, LEAST_BOUND)
    this.#bind(memory)
    if (!memory.asked && this.#hasPast) memory.until = Math.max(memory.until, this.#openedAt + memory.bound)
    memory.asked = true
  }

  #bind(memory) {
    memory.bound = Math.max(memory.base, memory.lateness * MARGIN)
  }

  /**
   * When the station may be asked, ms of the clock. A silence counts only once it has been listened to: where its end is seen late, the
   * bytes that came meanwhile get a moment to be read.
   */
  readyAt(station) {
    const memory = this.#memories.get(station)
    if (!memory) return 0
    const now = this.#clock.now()
    if (memory.heard !== memory.until && now >= memory.until) {
      if (now > memory.until + LAG) memory.until = now + BREATH
      memory.heard = memory.until
    }
    return memory.until
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
    this.#watchers.unshift({
      station,
      match: guarded(match),
      due,
      timeout,
      bytes: seen,
      since: this.#clock.now(),
      until: from + WATCH * memory.bound
    })
    if (this.#watchers.length > MOST_WATCHERS) this.#watchers.pop()
  }

  /** The port was opened: what lies in the buffers of adapters and servers may be answers to old queries. */
  opened() {
    const now = this.#clock.now()
    this.#openedAt = now
    for (const memory of this.#memories.values()) {
      if (memory.asked) memory.until = Math.max(memory.until, now + memory.bound)
    }
  }

  /** The station has answered what it was asked after all else: in order, so nothing older can come. */
  cleared(station) {
    const memory = this.memory(station)
    const now = this.#clock.now()
    memory.clearedAt = now
    memory.until = Math.min(memory.until, now)
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
    const watchers = this.#watchers
    for (const watcher of watchers) append(watcher, bytes)
    for (const watcher of watchers) {
      const frame = search(watcher)
      if (frame.length > 0) this.#taken(watcher, frame, now)
    }
  }

  #taken(watcher, frame, now) {
    const { station, timeout, due } = watcher
    this.#watchers = this.#watchers.filter(w => w !== watcher)
    // where nothing in the frame tells which query it answers: the newest; the others did not see it
    const others = this.#watchers.filter(w => w.station === station)
    for (const other of others) other.bytes = watcher.bytes
    const memory = this.memory(station)
    // older than what was answered since: answers do not come in order here
    if (memory.clearedAt >= watcher.since) memory.overtaken = true
    const lateness = now - due
    // in time, but nobody waited any more (a redeploy): nothing else can come
    if (lateness <= 0) {
      if (others.length > 0) return
      memory.until = Math.min(memory.until, now)
      return this.#freed()
    }
    memory.lateness = Math.min(MOST_LEARNT, Math.max(memory.lateness, lateness))
    this.#bind(memory)
    memory.until = Math.max(memory.until, now + memory.bound)
    this.#late({ station, lateness, timeout, bound: memory.bound }, frame)
  }
}

/** A recogniser that throws recognises nothing: it has already ended its own run. */
const guarded = match => bytes => {
  try {
    return match(bytes)
  } catch {
    return {}
  }
}

const append = (watcher, bytes) => {
  const all = watcher.bytes.length === 0 ? bytes : Buffer.concat([watcher.bytes, bytes])
  watcher.bytes = all.length > MOST_BYTES ? all.subarray(all.length - MOST_BYTES) : all
}

/** Looks for the awaited frame; takes it and all before it out of the watcher's bytes. Empty: it is not there (yet). */
const search = watcher => {
  while (watcher.bytes.length > 0) {
    const { take, skip, bad, length } = watcher.match(watcher.bytes)
    if (take > 0 && take <= watcher.bytes.length) {
      const frame = watcher.bytes.subarray(0, take)
      watcher.bytes = watcher.bytes.subarray(take)
      return frame
    }
    const drop = bad ? (length ?? watcher.bytes.length) : (skip ?? 0)
    if (!(drop > 0)) return EMPTY
    watcher.bytes = watcher.bytes.subarray(drop)
  }
  return EMPTY
}

module.exports = { Quarantine }
