'use strict'
const { PlcError } = require('../error')
const { timeoutFor } = require('../line')

/** What is said of a station's health: the error of what is not asked, and the events. Pure. */

/** @param {number} ms @returns {string} in words: `12 s`, `3 min`, `2 h` */
const lasting = ms => {
  const seconds = Math.ceil(ms / 1000)
  if (seconds < 120) return `${seconds} s`
  return seconds < 7200 ? `${Math.round(seconds / 60)} min` : `${Math.round(seconds / 3600)} h`
}

/**
 * @param {import('./health-record').Health} health
 * @param {{ station: any, now: number, probe: number, sent: boolean }} facts now: of the clock; probe: the next one, epoch ms
 */
const demotedError = ({ silentSince, silentAt, probeAt }, { station, now, probe, sent }) => {
  const texts = { lasting: lasting(now - silentAt), when: probeAt > now ? `in ${lasting(probeAt - now)}` : 'now' }
  return new PlcError('STATION_DEMOTED', { station, since: Math.round(silentSince), probe, ...texts, sent })
}

const demotedEvent = ({ silent, probeAt }, { station, now }) => ({
  ...{ event: 'stationDemoted', station, code: 'TIMEOUT', timeouts: silent, nextProbe: Math.round(probeAt - now) },
  cause: `Station ${station} was silent ${silent} times in a row: it is only probed until it answers`,
  remedy: 'Check its power, cable and station number.'
})

const backEvent = ({ silentAt }, { station, now }) => ({
  ...{ event: 'stationBack', station, downFor: Math.round(now - silentAt) },
  cause: `Station ${station} answers again after ${lasting(now - silentAt)}`
})

const slowEvent = (p99, { station, timeout }) => ({
  ...{ event: 'slow', station, p99, timeout, advice: timeoutFor(p99) },
  cause: `Station ${station} takes up to ${p99} ms to answer; its timeout is ${timeout} ms`,
  remedy: `Raise the timeout to ${timeoutFor(p99)} ms.`
})

module.exports = { backEvent, demotedError, demotedEvent, slowEvent }
