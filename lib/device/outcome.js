'use strict'
const { PlcError, isRefusal } = require('../error')
const { asGivenError } = require('./failure')

/**
 * What became of a write. Pure.
 *
 * @typedef {'confirmed'|'unknown'|'refused'|'failed'} Word confirmed: the station acknowledged it (and it reads so, with
 *   `verify`); unknown: it went out and no answer says whether it was carried out; refused: by a guard before anything was
 *   sent, or by the station; failed: it never went out, or was acknowledged and reads otherwise
 * @typedef {object} ItemOutcome
 * @property {string} item as the user wrote it
 * @property {string} name
 * @property {any} value as it was given
 * @property {Word|'notSent'} outcome
 * @property {string} [code]
 * @property {string} [text]
 * @typedef {object} Outcome
 * @property {Word} outcome of the whole: unknown if any item is, else confirmed only if all are
 * @property {ItemOutcome[]} items in the order of the entries
 * @property {string} [code]
 * @property {string} [text]
 * @property {number} attempts requests that went out for it
 * @property {number} ms from the call to the outcome
 */

const plain = ({ item, value }) => ({ item: item?.text ?? String(item), name: item?.name ?? String(item), value })

/**
 * Nothing was sent.
 * @param {any} caught
 * @param {{ item: any, value: any }[]} entries
 * @param {'refused'|'failed'} outcome
 * @returns {Outcome & { error: any }}
 */
const unsent = (caught, entries, outcome = 'refused') => {
  const error = asGivenError(caught)
  const { code, message: text } = error
  return {
    outcome,
    items: entries.map(entry => ({ ...plain(entry), outcome: 'notSent' })),
    code,
    text,
    attempts: 0,
    ms: 0,
    error
  }
}

const UNKNOWN = new Set(['WRITE_UNKNOWN', 'BROADCAST_UNCONFIRMED'])
/** Of guards that look when the turn has come. */
const GUARDED = new Set(['STEP_TOO_LARGE', 'WRITE_TOO_SOON', 'NOT_A_VALUE'])

/** @param {import('../error').PlcError} error @returns {Word} what a failed request means */
const wordFor = error => {
  if (UNKNOWN.has(error.code)) return 'unknown'
  return isRefusal(error) || GUARDED.has(error.code) ? 'refused' : 'failed'
}

/** The worst that an item's values met. */
const WORST = ['unknown', 'failed', 'refused', 'notSent', 'confirmed']

/** Nothing of such a value stands in the station. */
const isUndone = ({ outcome, error }) =>
  outcome === 'refused' || outcome === 'notSent' || (outcome === 'failed' && error?.code !== 'VERIFY_FAILED')

/** An item of several frames, of which only the first ones were carried out: neither the old values stand there nor the new ones. */
const partOf = (entry, own, { points, station }) => {
  const written = own.filter(({ outcome }) => outcome === 'confirmed').length
  if (written === 0 || !own.some(isUndone)) return null
  const cause = own.find(({ error }) => error)?.error ?? points.find(({ error }) => error)?.error
  const reason = `${written} of ${own.length} values were written, then ${cause?.code}`
  return {
    outcome: 'unknown',
    error: new PlcError('WRITE_UNKNOWN', { station, item: plain(entry).item, reason, cause })
  }
}

/**
 * @param {{ item: any, value: any, from: number, to: number }[]} entries with the places of their points
 * @param {{ outcome: string, error?: import('../error').PlcError }[]} points
 * @param {number} station
 * @returns {Outcome & { error: any }} error: why it is not confirmed
 */
const outcomeOf = (entries, points, station) => {
  const items = entries.map(entry => {
    const own = points.slice(entry.from, entry.to)
    const part = partOf(entry, own, { points, station })
    const worst = part?.outcome ?? /** @type {any} */ (WORST.find(word => own.some(({ outcome }) => outcome === word)))
    const error = part?.error ?? own.find(({ outcome }) => outcome === worst)?.error
    const why = error ? { code: error.code, text: error.message } : {}
    return { item: { ...plain(entry), outcome: worst, ...why }, error }
  })
  // what was not sent was not sent because of another item: that one's word stands for the whole
  const first = /** @type {any} */ (WORST.map(word => items.find(({ item }) => item.outcome === word)).find(Boolean))
  const { outcome, code, text } = first.item
  const why = code ? { code, text } : {}
  return { outcome, items: items.map(({ item }) => item), ...why, attempts: 0, ms: 0, error: first.error }
}

module.exports = { outcomeOf, unsent, wordFor }
