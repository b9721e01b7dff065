'use strict'
const { remembered } = require('./remembered')

/**
 * What is known of a station's health, as plain data in the line's memory of it: over redeploys, and for all devices of the station. Pure.
 *
 * @typedef {'online'|'suspect'|'demoted'} State
 * @typedef {{ ask: string, base?: number, count?: number, addresses?: any[], writes?: any[], values?: any[] }} Request of a plan
 * @typedef {object} Health
 * @property {State} state
 * @property {number|null} since epoch ms of its last change
 * @property {number} silent silences in a row
 * @property {number} silentSince epoch ms of the first of them
 * @property {number} silentAt the same by the monotonic clock
 * @property {boolean} told the demotion was reported and not yet taken back
 * @property {Set<string>} good requests that were answered
 * @property {any} lastGood the last of them, as a probe asks
 * @property {Set<string>} keys of the requests that met the silences, two at most
 * @property {boolean} blamed one of these had been answered before
 * @property {any} failed the request that demoted it, as a probe asks
 * @property {any} other another one that was asked for since
 * @property {number} probes since it is demoted
 * @property {number} wait ms to the probe after the next
 * @property {number} probeAt ms of the clock
 * @property {number} answers of the line when it was demoted
 * @property {number} slowAt ms of the clock: when `slow` was reported last
 */

const MOST_GOOD = 200

/** @param {any} memory of the line for the station @returns {Health} */
const healthOf = memory => {
  memory.health ??= {
    ...{ state: 'online', since: null, silent: 0, silentSince: 0, silentAt: 0, told: false },
    ...{ good: new Set(), lastGood: null, keys: new Set(), blamed: false },
    ...{ failed: null, other: null, probes: 0, wait: 0, probeAt: 0, answers: 0, slowAt: -Infinity }
  }
  return memory.health
}

/** @type {(request: Request) => string} equal for equal requests, as far as it matters here */
const keyOf = remembered(({ ask, base, count, addresses, writes, values }) => {
  const places = addresses ?? writes
  return `${ask} ${base ?? places?.[0]?.address} ${count ?? places?.length ?? values?.length}`
})

const READS = Object.freeze({ writeBits: 'readBits', writeWords: 'readWords', writeBitsOfWord: 'readWords' })

/** A request as a read of its first address. @param {Request} request */
const firstOf = ({ ask, base, addresses, writes }) => {
  const [first] = addresses ?? writes ?? []
  if (first) return { ask: first.kind === 'bit' ? 'readBits' : 'readWords', base: first.address, count: 1 }
  return { ask: READS[ask] ?? ask, base, count: 1 }
}

const become = (health, state, wall) => void Object.assign(health, { state, since: wall })

/**
 * A request was not answered.
 * @param {Health} health
 * @param {Request} request
 * @param {{ demoteAfter: number, now: number, wall: number }} options
 * @returns {boolean} whether that demotes the station
 */
const noteSilence = (health, request, { demoteAfter, now, wall }) => {
  const key = keyOf(request)
  health.silent++
  health.blamed ||= health.good.has(key)
  if (health.keys.size < 2) health.keys.add(key)
  if (health.state === 'online') {
    Object.assign(health, { silentSince: wall, silentAt: now })
    become(health, 'suspect', wall)
  }
  if (health.state === 'demoted' || demoteAfter === 0 || health.silent < demoteAfter) return false
  // a request that was never answered, of a station that answers others: it may not know it
  return health.blamed || health.keys.size > 1 || health.good.size === 0
}

/** @param {Health} health @param {Request} request @param {{ answers: number, wall: number }} facts */
const demote = (health, request, { answers, wall }) => {
  const failed = firstOf(request)
  // the request that failed, and another one by turns where the station may only not know the first
  const other = health.good.has(keyOf(request)) ? failed : health.lastGood
  Object.assign(health, { failed, other, probes: 0, answers })
  become(health, 'demoted', wall)
}

/** What the next probe asks. @param {Health} health */
const sampleOf = health => {
  const { failed, other, probes } = health
  health.probes++
  return probes % 2 === 0 ? (other ?? failed) : failed
}

/** Another read was asked for meanwhile. @param {Health} health @param {Request} request */
const noteWanted = (health, request) => {
  if (health.other === null && !health.keys.has(keyOf(request))) health.other = firstOf(request)
}

/** Its next silence demotes it again. @param {Health} health @param {{ demoteAfter: number, wall: number }} options */
const pardon = (health, { demoteAfter, wall }) => {
  Object.assign(health, { silent: demoteAfter - 1, blamed: true })
  become(health, 'suspect', wall)
}

/** It has answered, whatever it said. @param {Health} health @param {number} wall */
const noteAlive = (health, wall) => {
  health.silent = 0
  health.blamed = false
  health.keys.clear()
  if (health.state !== 'online') become(health, 'online', wall)
}

/** @param {Health} health @param {Request} request that was answered */
const noteGood = (health, request) => {
  const key = keyOf(request)
  if (health.good.has(key)) return
  if (health.good.size >= MOST_GOOD) health.good.clear()
  health.good.add(key)
  health.lastGood = firstOf(request)
}

module.exports = { demote, firstOf, healthOf, keyOf, noteAlive, noteGood, noteSilence, noteWanted, pardon, sampleOf }
