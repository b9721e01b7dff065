'use strict'
const { PlcError } = require('../error')

/** What a set value may look like in a message: dashboards and MQTT send numbers and switches as text. Pure. */

// no two repeats beside each other can take the same digit: a text of a megabyte is refused as fast as it is read
const NUMBER = /^[+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:e[+-]?\d+)?$/i
const HEX = /^0x[0-9a-f]+$/i
const BOOLEANS = new Map([
  ['true', true],
  ['on', true],
  ['1', true],
  ['false', false],
  ['off', false],
  ['0', false]
])

/**
 * The elements of a list, by their places: what it says of its own iteration does not count, that may never end.
 * @param {ArrayLike<any>} list
 * @returns {any[]}
 */
const elementsOf = list => Array.from({ length: list.length }, (_, n) => list[n])

/** Why a value can never be written, or null. */
const absurdity = value => {
  if (value === null || value === undefined) return 'it is empty'
  if (typeof value === 'string' && value.trim() === '') return 'it is empty'
  if (typeof value === 'number' && !Number.isFinite(value)) return 'it is not a finite number'
  return null
}

const refuse = (item, value, reason) => new PlcError('BAD_VALUE', { item, value, reason })

/**
 * A number out of a number or a text (`12`, `-3.5`, `1e3`, `0x1F`).
 * @param {unknown} value
 * @param {string} item for the error's text
 * @returns {number} finite
 * @throws {PlcError} BAD_VALUE
 */
const toNumber = (value, item) => {
  const absurd = absurdity(value)
  if (absurd) throw refuse(item, value, absurd)
  if (typeof value === 'number') return value
  if (typeof value !== 'string') throw refuse(item, value, 'a number is needed')
  const text = value.trim()
  if (!NUMBER.test(text) && !HEX.test(text)) throw refuse(item, value, 'it is not a number')
  const number = Number(text)
  if (!Number.isFinite(number)) throw refuse(item, value, 'it is not a finite number')
  return number
}

/**
 * A boolean out of true, false, 0, 1 or a text (`true`, `false`, `on`, `off`, `0`, `1`, in any case).
 * @param {unknown} value
 * @param {string} item for the error's text
 * @returns {boolean}
 * @throws {PlcError} BAD_VALUE
 */
const toBoolean = (value, item) => {
  if (typeof value === 'boolean') return value
  const absurd = absurdity(value)
  if (absurd) throw refuse(item, value, absurd)
  const known =
    typeof value === 'number' || typeof value === 'string'
      ? BOOLEANS.get(String(value).trim().toLowerCase())
      : undefined
  if (known === undefined) throw refuse(item, value, 'a bit takes true, false, on, off, 1 or 0')
  return known
}

/**
 * A text of characters U+0000..U+00FF, at most `most` of them.
 * @param {unknown} value a string or a finite number
 * @param {string} item for the error's text
 * @param {number} most bytes
 * @returns {string}
 * @throws {PlcError} BAD_VALUE
 */
const toText = (value, item, most) => {
  const absurd = absurdity(value)
  if (absurd && value !== '') throw refuse(item, value, absurd)
  if (typeof value !== 'string' && typeof value !== 'number') throw refuse(item, value, 'a text is needed')
  const text = String(value)
  if (text.length > most) throw refuse(item, value, `it has ${text.length} characters, ${most} fit`)
  for (const character of text) {
    if (/** @type {number} */ (character.codePointAt(0)) > 0xff) {
      throw refuse(item, value, `the character ${character} does not fit into one byte`)
    }
  }
  return text
}

module.exports = { absurdity, elementsOf, toBoolean, toNumber, toText }
