'use strict'

const { PlcError } = require('../error')
const { createHeap } = require('./heap')

/**
 * Virtual time. Whole systems (line, devices, simulated stations) run on it, thousands of times faster than the wire and
 * always in the same order. `now`, `wall`, `setTimer` and `clearTimer` are the clock that the line takes as parameter
 * (docs/architecture.md); the rest drives it.
 *
 * After each event one `setImmediate` is awaited, so that promises and streams that the event has touched come to
 * rest before time goes on; only timers that their maker declares `quiet` (they touch neither) are run without.
 *
 * @param {{ start?: number, epoch?: number }} [options] start: first `now()` in ms; epoch: `wall()` at now = 0, in ms
 * @returns {VirtualClock}
 */
function createVirtualClock({ start = 0, epoch = Date.UTC(2024, 0, 1) } = {}) {
  const heap = createHeap()
  const open = new Set()
  const state = { now: start, wall: epoch, events: 0, sequence: 0, live: 0, failure: null }

  const setTimer = (fn, ms, { quiet = false } = {}) => {
    if (typeof fn !== 'function') throw new TypeError('setTimer needs a function')
    const timer = { at: state.now + (ms > 0 ? ms : 0), order: state.sequence++, fn, quiet }
    heap.push(timer)
    state.live++
    return timer
  }
  const clearTimer = timer => {
    if (!timer || !timer.fn) return
    timer.fn = null
    state.live--
  }
  const runner = createRunner({ heap, state, open })
  return {
    now: () => state.now,
    wall: () => state.wall + state.now,
    jumpWall: ms => void (state.wall += ms),
    setTimer,
    clearTimer,
    work: name => openEntry(open, name),
    pending: () => state.live,
    events: () => state.events,
    ...runner
  }
}

/** The next live timer that is due until `limit`, taken out of the heap; undefined: none. */
const due = (heap, limit) => {
  for (let first = heap.first(); first; first = heap.first()) {
    if (first.fn && first.at > limit) return undefined
    heap.pop()
    if (first.fn) return first
  }
  return undefined
}

const openEntry = (open, name) => {
  const entry = { name }
  open.add(entry)
  return () => void open.delete(entry)
}

const nothingLeft = open =>
  new PlcError('SIM_DEADLOCK', { open: [...open].map(({ name }) => name).join(', ') || 'unnamed work' })

/**
 * Runs events in order until `over()`; then, or where time cannot go on, calls `end` with 'over', 'empty' (nothing due
 * until `limit`) or what an event has thrown.
 */
function pump({ heap, state }, { limit, over, end }) {
  let idle = 0
  const go = () => {
    while (!over()) {
      const timer = due(heap, limit)
      if (!timer) {
        // streams may need some turns of the loop before they set a timer
        if (idle++ < 8) return void setImmediate(go)
        return end('empty')
      }
      idle = 0
      const { fn, quiet } = timer
      timer.fn = null
      state.live--
      state.now = timer.at
      state.events++
      try {
        fn()
      } catch (error) {
        return end(error)
      }
      if (!quiet) return void setImmediate(go)
    }
    end('over')
  }
  setImmediate(go)
}

function createRunner({ heap, state, open }) {
  const run = (promise, { name = 'the promise that run() waits for', limit = Infinity } = {}) =>
    new Promise((resolve, reject) => {
      const close = openEntry(open, name)
      let settled = false
      const settle = then => value => {
        settled = true
        close()
        then(value)
      }
      const until = state.now + limit
      Promise.resolve(typeof promise === 'function' ? promise() : promise).then(settle(resolve), settle(reject))
      const end = reason => {
        if (reason === 'over') return
        const error = reason === 'empty' ? nothingLeft(open) : reason
        close()
        reject(error)
      }
      pump({ heap, state }, { limit: until, over: () => settled, end })
    })

  const advance = ms =>
    new Promise((resolve, reject) => {
      const until = state.now + ms
      const end = reason => {
        if (reason !== 'empty') return reject(reason)
        state.now = until
        resolve(undefined)
      }
      pump({ heap, state }, { limit: until, over: () => false, end })
    })

  const drain = async () => {
    const reason = await new Promise(end => pump({ heap, state }, { limit: Infinity, over: () => false, end }))
    if (reason !== 'empty') throw reason
    if (open.size > 0) throw nothingLeft(open)
  }

  return { run, advance, drain }
}

/**
 * The clock of the machine, with the same contract. For simulators that real programs talk to.
 * @returns {{ now(): number, wall(): number, setTimer(fn: () => void, ms: number): any, clearTimer(timer: any): void }}
 */
function createRealClock() {
  return {
    now: () => performance.now(),
    wall: () => Date.now(),
    setTimer: (fn, ms) => setTimeout(fn, ms),
    clearTimer: timer => clearTimeout(timer)
  }
}

/**
 * The clock of the machine for a simulation that can be given up: after `stop` none of its timers runs.
 * @returns {{ now(): number, wall(): number, setTimer(fn: () => void, ms: number): any, clearTimer(timer: any): void, stop(): void }}
 */
function createStoppableClock() {
  const clock = createRealClock()
  const timers = new Set()
  let stopped = false
  return {
    ...clock,
    setTimer(fn, ms) {
      if (stopped) return null
      const timer = clock.setTimer(() => {
        timers.delete(timer)
        fn()
      }, ms)
      timers.add(timer)
      return timer
    },
    clearTimer(timer) {
      timers.delete(timer)
      clock.clearTimer(timer)
    },
    stop() {
      stopped = true
      timers.forEach(clock.clearTimer)
      timers.clear()
    }
  }
}

/**
 * @typedef {object} VirtualClock
 * @property {() => number} now monotonic ms, with fractions
 * @property {() => number} wall epoch ms
 * @property {(ms: number) => void} jumpWall moves the wall clock alone, as a wrong time server does
 * @property {(fn: () => void, ms: number, options?: { quiet?: boolean }) => any} setTimer quiet: fn settles nothing
 * @property {(timer: any) => void} clearTimer any number of times; undefined is allowed
 * @property {(name: string) => () => void} work declares something as open until the returned function is called
 * @property {() => number} pending number of live timers: 0 after everything was closed
 * @property {() => number} events number of events so far
 * @property {<T>(promise: Promise<T> | (() => Promise<T>), options?: { name?: string, limit?: number }) => Promise<T>} run
 *   lets time pass until the promise settles. Rejects with SIM_DEADLOCK if nothing can happen any more (within `limit` ms)
 * @property {(ms: number) => Promise<void>} advance lets exactly `ms` pass
 * @property {() => Promise<void>} drain until no timer is left; SIM_DEADLOCK if declared work is still open then
 */

module.exports = { createVirtualClock, createRealClock, createStoppableClock }
