'use strict'
const { causeOf } = require('../error')
const { asPlcError } = require('./failure')

/**
 * One event of the line for each write and each refusal, once its outcome is known: `audit`, docs/architecture.md. It goes into logs and files, so
 * what a message brought is shortened, and shown without control characters.
 *
 * @typedef {{ node?: unknown, name?: unknown, message?: unknown }} By who asked: id and name of the node, id of the message
 */

const MOST_ITEMS = 100
const MOST_VALUES = 100
const MOST_TEXT = 80
const MOST_CAUSE = 500

/** @param {unknown} given @param {number} [most] characters */
const printable = (given, most = MOST_TEXT) => {
  const text = String(given)
  const shown = text.length > most ? `${text.slice(0, most - 1)}…` : text
  return shown.replace(/[\p{C}\p{Zl}\p{Zp}]/gu, '·')
}

/** A value of a message may be anything, also what cannot be looked at. */
const shown = value => {
  try {
    if (value === null || value === undefined || typeof value === 'boolean') return value ?? null
    if (typeof value === 'number') return Number.isFinite(value) ? value : String(value)
    if (typeof value === 'string' || typeof value === 'bigint') return printable(value)
    return Array.isArray(value) ? list(value) : `(${typeof value})`
  } catch {
    return `(${typeof value})`
  }
}

const list = values => {
  const first = Array.from(values.slice(0, MOST_VALUES), each => (Array.isArray(each) ? '(array)' : shown(each)))
  return values.length > MOST_VALUES ? [...first, `… ${values.length - MOST_VALUES} more`] : first
}

/** What a message looks like that was sent as text or bytes. */
const preview = value => {
  try {
    if (ArrayBuffer.isView(value)) {
      const { buffer, byteOffset, byteLength } = value
      return printable(Buffer.from(buffer, byteOffset, Math.min(byteLength, MOST_TEXT + 1)).toString('latin1'))
    }
    const plain = shown(value)
    return printable(Array.isArray(plain) ? plain.join(' ') : (plain ?? ''))
  } catch {
    return `(${typeof value})`
  }
}

const known = given => (given === undefined || given === null ? null : shown(given))

/** @param {By | null | undefined} by */
const byOf = by => (by ? { node: known(by.node), name: known(by.name), message: known(by.message) } : null)

/** @param {any} error @param {{ code?: string, text?: string }} outcome if only that is known; no code: nothing went wrong */
const whyOf = (error, outcome) => {
  if (!error) return outcome.code ? { code: outcome.code, cause: printable(outcome.text, MOST_CAUSE) } : {}
  const why = asPlcError(error)
  const { code, remedy } = why
  return { code, cause: printable(causeOf(why), MOST_CAUSE), remedy: printable(remedy, MOST_CAUSE) }
}

const itemOf = ({ item, name, value, outcome, code }) => ({
  item: shown(item),
  name: shown(name),
  value: shown(value),
  outcome,
  ...(code ? { code } : {})
})

/** @param {any[]} items */
const itemsOf = items => ({
  items: items.slice(0, MOST_ITEMS).map(itemOf),
  ...(items.length > MOST_ITEMS ? { more: items.length - MOST_ITEMS } : {})
})

/**
 * @param {{ line: { report: (event: any) => void }, device: string, station?: number | null }} who
 * @returns {{ write: (outcome: any, facts: Facts) => void, message: (outcome: any, facts: Facts & { value: unknown }) => void }}
 *   write: values of a station; message: what was sent as it is
 *
 * @typedef {object} Facts
 * @property {number} since epoch ms when it was asked for
 * @property {By | null} [by]
 * @property {any} [error] why it was not confirmed
 */
const createAudit = ({ line, device, station = null }) => {
  const tell = (whole, /** @type {Facts} */ { since, by, error }, what) => {
    const { outcome, attempts, ms } = whole
    const head = { event: 'audit', station, since: Math.round(since), device, by: byOf(by), outcome }
    try {
      line.report({ ...head, ...whyOf(error, whole), ...what, attempts, ms: Math.round(ms) })
    } catch {
      // a fault of who listens must not change what the caller hears of its write
    }
  }
  return {
    write: (outcome, facts) => tell(outcome, facts, itemsOf(outcome.items)),
    message: (outcome, facts) => tell(outcome, facts, { items: [], bytes: outcome.bytes, text: preview(facts.value) })
  }
}

module.exports = { createAudit }
