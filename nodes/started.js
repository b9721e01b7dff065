'use strict'

/**
 * One listener at the runtime for all nodes: a flow of many nodes must not look like a leak of listeners (`MaxListenersExceededWarning`).
 */

/** @type {WeakMap<object, { waiting: Set<() => void>, hear: () => void }>} */
const known = new WeakMap()

const hub = events => {
  const waiting = new Set()
  const made = { waiting, hear: () => [...waiting].forEach(fn => waiting.has(fn) && fn()) }
  known.set(events, made)
  return made
}

/**
 * Calls `fn` after each deploy, when all nodes have been made.
 * @param {{ on: Function, off: Function }} events of the runtime
 * @param {() => void} fn
 * @returns {() => void} ends it; any number of times
 */
const onStarted = (events, fn) => {
  const { waiting, hear } = known.get(events) ?? hub(events)
  if (waiting.size === 0) events.on('flows:started', hear)
  waiting.add(fn)
  return () => {
    if (waiting.delete(fn) && waiting.size === 0) events.off('flows:started', hear)
  }
}

module.exports = { onStarted }
