'use strict'

const fs = require('node:fs')
const os = require('node:os')
const path = require('node:path')
const { realClock } = require('../../../lib/line')

/** The machine's clock, some times as fast: real ports without waiting for real back-offs. */
const fastClock = (factor = 5) => {
  const live = new Set()
  return {
    now: () => realClock.now() * factor,
    wall: realClock.wall,
    setTimer: (fn, ms) => {
      const fire = () => {
        live.delete(timer)
        fn()
      }
      const timer = realClock.setTimer(fire, ms / factor)
      live.add(timer)
      return timer
    },
    clearTimer: timer => {
      live.delete(timer)
      realClock.clearTimer(timer)
    },
    pending: () => live.size
  }
}

/** Resolves when the line is in this state. */
const reached = (lease, state) =>
  new Promise(resolve => {
    if (lease.line.state === state) return resolve(lease.line.reason)
    const look = (now, reason) => {
      if (now !== state) return
      lease.off('state', look)
      resolve(reason)
    }
    lease.on('state', look)
  })

const tempFolder = () => fs.mkdtempSync(path.join(os.tmpdir(), 'line-'))

const openFiles = () => fs.readdirSync('/proc/self/fd').length

module.exports = { fastClock, openFiles, reached, tempFolder }
