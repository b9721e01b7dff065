'use strict'
const { realClock } = require('../line')

/**
 * Passes the first value at once, and of several within `interval` only the last one, once: for the status of a node.
 * @template T
 * @param {{ interval: number, clock?: any }} options interval in ms
 * @param {(value: T) => void} fn
 * @returns {((value: T) => void) & { cancel: () => void }} `cancel`: what waits is dropped
 */
const createThrottle = ({ interval, clock = realClock }, fn) => {
  let timer = null
  /** @type {{ value: T } | null} */
  let waiting = null
  const open = () => {
    timer = null
    if (!waiting) return
    const { value } = waiting
    waiting = null
    pass(value)
  }
  const pass = value => {
    timer = clock.setTimer(open, interval)
    fn(value)
  }
  const call = value => {
    if (timer === null) pass(value)
    else waiting = { value }
  }
  const cancel = () => {
    clock.clearTimer(timer)
    timer = null
    waiting = null
  }
  return Object.assign(call, { cancel })
}

module.exports = { createThrottle }
