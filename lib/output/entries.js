'use strict'
const { PlcError, isPlcError, reasonOf } = require('../error')
const { absurdity, elementsOf } = require('../tag/convert')

/** Incoming messages -> what to write, what to read. Pure. Messages are hostile until proven otherwise. */

const MOST_ENTRIES = 1000
const MOST_ITEMS = 1000
const MOST_VALUES = 20000 // of one item
const MOST_TEXT = 100000 // characters of a list of items
const LONGEST = 200 // characters of one item

const own = (object, key) => (Object.hasOwn(object, key) ? object[key] : undefined)

const isPairs = value => {
  if (value === null || typeof value !== 'object' || Array.isArray(value)) return false
  const prototype = Object.getPrototypeOf(value)
  // objects of another context (function nodes) have another Object.prototype
  return prototype === null || Object.getPrototypeOf(prototype) === null
}

const isScalar = value => ['string', 'number', 'boolean'].includes(typeof value)

const checkValue = (item, value) => {
  // before it is copied: an array may be long on paper alone
  if (Array.isArray(value) && value.length > MOST_VALUES) {
    throw new PlcError('TOO_MANY', { count: value.length, unit: 'values to write', most: MOST_VALUES })
  }
  const values = Array.isArray(value) ? elementsOf(value) : [value]
  if (values.length === 0) throw new PlcError('BAD_VALUE', { item, value: [], reason: 'it is empty' })
  for (const one of values) {
    const absurd = absurdity(one)
    if (absurd) throw new PlcError('BAD_VALUE', { item, value: String(one), reason: absurd })
    if (!isScalar(one)) {
      throw new PlcError('BAD_VALUE', { item, value: typeof one, reason: 'a number, a text or true/false is needed' })
    }
  }
  return { item, value: Array.isArray(value) ? values : value }
}

/**
 * What comes in a message may throw whatever it likes when it is looked at: a proxy, a getter.
 * @template T
 * @param {() => T} look @param {(reason: string) => PlcError} refusal @returns {T}
 */
const readably = (look, refusal) => {
  try {
    return look()
  } catch (error) {
    throw isPlcError(error) ? error : refusal(reasonOf(error))
  }
}

const unreadable = reason =>
  new PlcError('BAD_VALUE', { item: 'the message', value: 'its payload', reason: `it cannot be looked at: ${reason}` })

/**
 * The payload of a message that is sent as it is.
 * @param {Record<string, any>} msg only its own `payload` counts
 * @returns {any} undefined: it has none
 * @throws {PlcError} BAD_VALUE: it cannot be looked at
 */
const payloadOf = msg => readably(() => own(msg, 'payload'), unreadable)

/**
 * The values that a message writes: its payload to the fixed target; or the pairs of an object payload; or the payload to
 * the item that `topic` names.
 * @param {Record<string, any>} msg only its own `payload` and `topic` count
 * @param {{ target?: string }} [options] target: item fixed in the node
 * @returns {{ item: string, value: any }[]} at most 1000
 * @throws {PlcError} NOTHING_TO_WRITE, BAD_VALUE (empty, null, NaN, an object), TOO_MANY
 */
const entriesOf = (msg, options = {}) => readably(() => read(msg, options), unreadable)

const read = (msg, { target = '' }) => {
  if (msg === null || typeof msg !== 'object') throw new PlcError('NOTHING_TO_WRITE', { reason: 'there is no message' })
  const payload = own(msg, 'payload')
  if (target.trim() !== '') return [checkValue(target.trim(), payload)]
  if (isPairs(payload)) return pairsOf(payload)
  const topic = own(msg, 'topic')
  if (typeof topic !== 'string' || topic.trim() === '') {
    const reason = 'no target, no object as payload, no item as topic'
    throw new PlcError('NOTHING_TO_WRITE', {
      reason: typeof topic === 'number' ? inQuotes('the topic', topic) : reason
    })
  }
  if (topic.length > LONGEST) throw new PlcError('NOTHING_TO_WRITE', { reason: 'the topic is too long for an item' })
  return [checkValue(topic.trim(), payload)]
}

/** A MODBUS address as a number has lost its zeros: 010197 is another one than 10197. */
const inQuotes = (what, number) => `${what} is the number ${number}; write the address in quotes`

const pairsOf = payload => {
  const names = Object.keys(payload)
  if (names.length === 0) throw new PlcError('NOTHING_TO_WRITE', { reason: 'the payload is an empty object' })
  if (names.length > MOST_ENTRIES) {
    throw new PlcError('TOO_MANY', { count: names.length, unit: 'values to write', most: MOST_ENTRIES })
  }
  return names.map(name => checkValue(name.slice(0, LONGEST), payload[name]))
}

const bad = reason => new PlcError('BAD_ITEMS', { reason })

/**
 * A list of items as it came in `msg.items` or stands in a configuration: an array of texts, or one text with commas,
 * semicolons or line breaks.
 * @param {unknown} given
 * @returns {string[]} 1 to 1000 texts, not parsed yet
 * @throws {PlcError} BAD_ITEMS, TOO_MANY
 */
const itemsOf = given =>
  readably(
    () => listed(given),
    error => bad(`it cannot be looked at: ${error}`)
  )

const listed = given => {
  if (typeof given === 'string' && given.length > MOST_TEXT) throw bad('the text is too long')
  const list = typeof given === 'string' ? given.split(/[,;\r\n]/).filter(text => text.trim() !== '') : given
  if (!Array.isArray(list)) throw bad(given === undefined ? 'it is missing' : `it is of the type ${typeof given}`)
  if (list.length === 0) throw bad('it is empty')
  if (list.length > MOST_ITEMS) throw new PlcError('TOO_MANY', { count: list.length, unit: 'items', most: MOST_ITEMS })
  return elementsOf(list).map((text, index) => {
    if (typeof text === 'number') throw bad(inQuotes(`entry ${index + 1}`, text))
    if (typeof text !== 'string') throw bad(`number ${index + 1} is no text`)
    if (text.trim() === '') throw bad(`number ${index + 1} is empty`)
    if (text.length > LONGEST) throw bad(`number ${index + 1} is too long`)
    return text.trim()
  })
}

module.exports = { entriesOf, itemsOf, payloadOf }
