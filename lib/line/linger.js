'use strict'

/** So much longer (ms) than asked for does a nap take. */
const LATE = 0.08
/** Nobody else in the process gets on meanwhile: so naps take such a part of the time at most, … */
const SHARE = 0.1
/** … and together so much (ms) where there was none for long. */
const MOST = 2

/**
 * Waits for parts of a ms, which timers do not count.
 * @param {{ now: () => number, nap: (ms: number) => void }} machine nap: sleeps without the processor, and a little longer
 * @returns {(until: number) => void} until: ms by `now`. Not to its end, if there was too much of it lately: who calls looks at the time again
 */
const createLinger = ({ now, nap }) => {
  let credit = MOST
  let countedAt = now()
  return until => {
    const from = now()
    const ms = until - from - LATE
    if (ms > 0) {
      credit = Math.min(MOST, credit + (from - countedAt) * SHARE)
      countedAt = from
      if (credit < ms) return
      credit -= ms
      nap(ms)
    }
    while (now() < until);
  }
}

module.exports = { createLinger }
