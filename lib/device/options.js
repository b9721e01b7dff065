'use strict'
const { PlcError } = require('../error')

/**
 * Reading of settings that every station has.
 *
 * @typedef {object} Plan how a station's points become requests; facts of its protocol
 * @property {(points: any[], facts?: Facts) => any[]} reads points -> read requests (docs/architecture.md, "Plan")
 * @property {(points: any[]) => any[]} writes points -> write requests
 * @property {Set<string>} splits codes after which a joint read is halved until the bad address stands alone
 * @property {Set<string>} absent codes by which a station says that it does not have an address; it then rests
 * @property {(request: any, error: PlcError) => boolean} simpler whether, from now on, the plan does without what the
 *   station does not know
 * @property {number} gap ms of silence before each frame of ours
 * @property {number} silences frames of ours in one read
 *
 * @typedef {object} Facts what was learnt of a station
 * @property {any[]} [holes] addresses that it does not have
 * @property {number} [turnaround] ms until it begins to answer
 * @property {boolean} [repeats] whether it repeats a read by its short form, where that is allowed; default true
 */

const TURNAROUND = 5 // ms of a station whose own is not known yet

const blank = value => value === undefined || value === null || (typeof value === 'string' && value.trim() === '')

/**
 * A setting as trimmed text: a flow that was edited by hand may hold anything.
 * @param {string} setting @param {unknown} value @returns {string} @throws {PlcError} BAD_SETTING
 */
const textOf = (setting, value) => {
  if (!['object', 'function', 'symbol'].includes(typeof value)) return String(value).trim()
  throw new PlcError('BAD_SETTING', { setting, value, reason: 'text is needed' })
}

const wholeNumber = (setting, value, { fallback, least, most }) => {
  if (blank(value)) return fallback
  const number = typeof value === 'string' ? Number(value) : value
  if (Number.isInteger(number) && number >= least && number <= most) return number
  throw new PlcError('BAD_SETTING', { setting, value, reason: `a whole number from ${least} to ${most} is needed` })
}

const choice = (setting, value, known) => {
  if (blank(value)) return known[0]
  const found = known.find(each => String(each) === textOf(setting, value))
  if (found !== undefined) return found
  throw new PlcError('BAD_SETTING', { setting, value, reason: `known are ${known.join(', ')}` })
}

/** @param {unknown} value @param {number} station @returns {string} */
const nameOf = (value, station) => (blank(value) ? `station ${station}` : textOf('name', value))

/** Spans of absolute bits that a message may write to. */
const readRanges = (value, notation) => {
  const given = Array.isArray(value) ? value : blank(value) ? [] : textOf('writableRanges', value).split(',')
  return given
    .map(text => textOf('writableRanges', text))
    .filter(text => text !== '')
    .map(text => {
      const { kind, address, count } = notation.parse(text)
      const size = kind === 'word' ? 16 : 1
      return { start: address * size, end: (address + count) * size }
    })
}

/** @param {unknown} value `true` and its text */
const isOn = value => value === true || value === 'true'

/**
 * When a silent station is demoted, and how often it is probed then.
 * @param {Record<string, any>} given
 * @returns {{ demoteAfter: number, probeFirst: number, probeMost: number }} silences in a row (0: never), ms, ms
 * @throws {PlcError} BAD_SETTING
 */
const readHealth = given => {
  const demoteAfter = wholeNumber('demoteAfter', given.demoteAfter, { fallback: 3, least: 0, most: 100 })
  const probeFirst = wholeNumber('probeFirst', given.probeFirst, { fallback: 5000, least: 100, most: 3600000 })
  const fallback = Math.max(60000, probeFirst)
  const probeMost = wholeNumber('probeMost', given.probeMost, { fallback, least: 100, most: 3600000 })
  if (probeMost >= probeFirst) return { demoteAfter, probeFirst, probeMost }
  const reason = `it is less than the time until the first probe, ${probeFirst}`
  throw new PlcError('BAD_SETTING', { setting: 'probeMost', value: probeMost, reason })
}

module.exports = { TURNAROUND, blank, choice, isOn, nameOf, readHealth, readRanges, textOf, wholeNumber }
