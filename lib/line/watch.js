'use strict'

/** A row of noise may still grow: it is told after this, ms, or when the next row begins. */
const GROWS = 200

const shown = row => ({ ...row, bytes: row.bytes.toString('hex') })

/** Tells rows of a trace when they are complete. @param {any} clock @param {(row: any) => void} tell bytes in hex */
const createTeller = (clock, tell) => {
  let held = null
  let timer = null
  const release = () => {
    clock.clearTimer(timer)
    const row = held
    held = null
    if (row) tell(shown(row))
  }
  return {
    /** @param {any} row @param {boolean} grows */
    frame(row, grows) {
      release()
      if (!grows) return tell(shown(row))
      held = row
      timer = clock.setTimer(release, GROWS)
    },
    stop() {
      clock.clearTimer(timer)
      held = null
    }
  }
}

/** What watchers do must not disturb the wire that they watch: the first mistake of each is a warning of the process. */
const guarded = fn => {
  if (!fn) return () => {}
  let failed = false
  return (...facts) => {
    try {
      fn(...facts)
    } catch (/** @type {any} */ error) {
      if (!failed) process.emitWarning(`a watcher of a line failed: ${error?.message ?? error}`)
      failed = true
    }
  }
}

/** One who watches a wire: follows its lines, of which the one before may still be closing. */
class Watcher {
  #told
  #teller
  #lines = new Map()
  /** @type {any} */
  #current = null

  /** @param {any} clock @param {{ event?: Function, state?: Function, frame?: Function }} told */
  constructor(clock, { event, state, frame }) {
    this.#told = { event: guarded(event), state: guarded(state) }
    this.#teller = frame ? createTeller(clock, guarded(frame)) : null
  }

  /** @param {any} line the one that the wire has from now on */
  follow(line) {
    this.#current = line
    const teller = this.#teller
    const listeners = {
      state: (state, reason) => this.#state(line, state, reason),
      event: event => this.#told.event(event, line),
      ...(teller ? { frame: (row, grows) => teller.frame(row, grows) } : {})
    }
    this.#lines.set(line, listeners)
    for (const [name, listener] of Object.entries(listeners)) line.on(name, listener)
  }

  #state(line, state, reason) {
    if (state === 'closed') this.#leave(line)
    if (this.#current === line) this.#told.state(state, reason, line)
  }

  #leave(line) {
    for (const [name, listener] of Object.entries(this.#lines.get(line) ?? {})) line.off(name, listener)
    this.#lines.delete(line)
  }

  /** How it is now. */
  tell() {
    const line = this.#current
    this.#told.state(line?.state ?? 'closed', line?.reason ?? null, line)
  }

  stop() {
    for (const line of [...this.#lines.keys()]) this.#leave(line)
    this.#current = null
    this.#teller?.stop()
  }
}

/** Who watches which wire of a pool; wires need not have a line, and watching does not open one. */
class Watchers {
  #clock
  #wires = new Map()

  /** @param {any} clock */
  constructor(clock) {
    this.#clock = clock
  }

  /** The wire has got a line. @param {string} key @param {any} line */
  made(key, line) {
    for (const watcher of this.#wires.get(key) ?? []) watcher.follow(line)
  }

  /**
   * @param {string} key of the wire @param {any} line that it has now, or null
   * @param {{ event?: Function, state?: Function, frame?: Function }} told
   * @returns {() => void} ends it; any number of times
   */
  add(key, line, told) {
    const watcher = new Watcher(this.#clock, told)
    const all = this.#wires.get(key) ?? new Set()
    this.#wires.set(key, all.add(watcher))
    if (line) watcher.follow(line)
    watcher.tell()
    return () => {
      watcher.stop()
      all.delete(watcher)
      if (all.size === 0 && this.#wires.get(key) === all) this.#wires.delete(key)
    }
  }
}

module.exports = { Watchers }
