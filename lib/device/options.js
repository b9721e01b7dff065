'use strict'
const { PlcError } = require('../error')

/**
 * Reading of settings that every station has.
 *
 * @typedef {object} Plan how a station's points become requests; facts of its protocol
 * @property {(points: any[]) => any[]} reads points -> read requests (docs/architecture.md, "Plan")
 * @property {(points: any[]) => any[]} writes points -> write requests
 * @property {Set<string>} splits codes after which a joint read is halved until the bad address stands alone
 * @property {Set<string>} absent codes by which a station says that it does not have an address; it then rests
 * @property {(request: any, error: PlcError) => boolean} simpler whether, from now on, the plan does without what the
 *   station does not know
 */

const blank = value => value === undefined || value === null || (typeof value === 'string' && value.trim() === '')

const wholeNumber = (setting, value, { fallback, least, most }) => {
  if (blank(value)) return fallback
  const number = typeof value === 'string' ? Number(value) : value
  if (Number.isInteger(number) && number >= least && number <= most) return number
  throw new PlcError('BAD_SETTING', { setting, value, reason: `a whole number from ${least} to ${most} is needed` })
}

const choice = (setting, value, known) => {
  if (blank(value)) return known[0]
  const found = known.find(each => String(each) === String(value).trim())
  if (found !== undefined) return found
  throw new PlcError('BAD_SETTING', { setting, value, reason: `known are ${known.join(', ')}` })
}

/** @param {unknown} value @param {number} station @returns {string} */
const nameOf = (value, station) => (blank(value) ? `station ${station}` : String(value).trim())

/** Spans of absolute bits that a message may write to. */
const readRanges = (value, notation) => {
  const given = Array.isArray(value) ? value : blank(value) ? [] : String(value).split(',')
  return given
    .map(text => String(text).trim())
    .filter(text => text !== '')
    .map(text => {
      const { kind, address, count } = notation.parse(text)
      const size = kind === 'word' ? 16 : 1
      return { start: address * size, end: (address + count) * size }
    })
}

/** @param {unknown} value `true` and its text */
const isOn = value => value === true || value === 'true'

module.exports = { blank, choice, isOn, nameOf, readRanges, wholeNumber }
