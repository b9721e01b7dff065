'use strict'

/** A clock whose timers fire when the test says, however late. */
function createLateClock() {
  const timers = new Set()
  let now = 0
  return {
    now: () => now,
    setTimer: (fn, ms) => {
      const timer = { fn, at: now + ms }
      timers.add(timer)
      return timer
    },
    clearTimer: timer => void timers.delete(timer),
    /** When the timers that are set should fire, ms. */
    due: () => [...timers].map(({ at }) => at),
    /** The process wakes up at this moment, and fires what is due by then. */
    wake: at => {
      now = at
      for (const timer of [...timers]) if (timer.at <= now && timers.delete(timer)) timer.fn()
    }
  }
}

module.exports = { createLateClock }
