'use strict'

/**
 * Results of a read -> what goes into messages. Pure. A bad value is never sent as a number: it is left out, or null.
 *
 * @typedef {object} Result see lib/device: `{ name, item, value, quality, timestamp, label, unit, code?, text?, elements? }`
 * @property {string} name
 * @property {any} value
 * @property {'good'|'uncertain'|'bad'} quality
 * @property {number} timestamp
 * @property {string} [item]
 * @property {string} [label]
 * @property {string} [unit]
 * @property {number|string} [deadband]
 * @property {string} [code]
 * @property {string} [text]
 * @property {any[]} [elements]
 *
 * @typedef {object} Shape
 * @property {'object'|'message'|'envelope'|'list'} [format] default object
 * @property {'omit'|'null'} [badValues] default omit
 * @property {'array'|'values'} [ranges] default array
 * @property {'boolean'|'number'} [booleans] default boolean
 * @property {string} [device] name of the PLC
 * @property {string} [id] of the sequence, for `parts`; default device and time
 * @property {boolean} [simulated] marks the messages
 */

const QUALITIES = ['good', 'uncertain', 'bad']

const worst = results => QUALITIES[results.reduce((most, { quality }) => Math.max(most, QUALITIES.indexOf(quality)), 0)]

/**
 * Single values instead of arrays.
 * @param {Result[]} results
 * @returns {Result[]}
 */
const expandRanges = results =>
  results.flatMap(result =>
    result.elements
      ? result.elements.map(element => ({
          ...element,
          item: result.item,
          label: result.label,
          unit: result.unit,
          deadband: result.deadband
        }))
      : [result]
  )

const shown = (value, booleans) => {
  if (booleans !== 'number') return value
  if (Array.isArray(value)) return value.map(one => shown(one, booleans))
  return typeof value === 'boolean' ? Number(value) : value
}

/** `{ name: { code, text } }` of what is bad; nothing if all is good. */
const badOf = results => {
  const rows = results.filter(({ quality }) => quality === 'bad').map(({ name, code, text }) => [name, { code, text }])
  return rows.length > 0 ? { bad: Object.fromEntries(rows) } : {}
}

const named = (key, value) => (value ? { [key]: value } : {})

const common = (results, { device = '', simulated }) => ({
  timestamp: Math.max(...results.map(({ timestamp }) => timestamp)),
  quality: worst(results),
  device,
  ...badOf(results),
  ...(simulated ? { simulated: true } : {})
})

/** @param {Result} result @param {Shape} shape @returns {any} */
const valueOf = (result, { booleans, badValues }) => {
  const whole = result.quality !== 'bad' || badValues === 'null'
  return whole ? shown(result.value, booleans) : null
}

const isSent = (result, shape) => result.quality !== 'bad' || shape.badValues === 'null'

const objectMessage = (results, shape) => {
  const sent = results.filter(result => isSent(result, shape))
  if (sent.length === 0) return []
  const payload = Object.fromEntries(sent.map(result => [result.name, valueOf(result, shape)]))
  return [{ payload, topic: shape.device ?? '', ...common(results, shape) }]
}

const listMessage = (results, shape) => {
  const sent = results.filter(result => isSent(result, shape))
  if (sent.length === 0) return []
  const payload = sent.map(result => ({
    name: result.name,
    value: valueOf(result, shape),
    quality: result.quality,
    timestamp: result.timestamp,
    item: result.item,
    ...named('unit', result.unit),
    ...named('label', result.label),
    ...(result.quality === 'bad' ? { code: result.code, text: result.text } : {})
  }))
  return [{ payload, topic: shape.device ?? '', ...common(results, shape) }]
}

/**
 * One message per result, field by field: there may be thousands of them each second. `parts` lets a join node put them together again by itself.
 * @param {Result[]} results @param {Shape} shape @param {(result: Result, shape: Shape) => any} payloadOf
 */
const messagePer = (results, shape, payloadOf) => {
  const { device = '', simulated } = shape
  const id = shape.id ?? `${device} ${Math.max(...results.map(({ timestamp }) => timestamp))}`
  const count = results.length
  return results.map((result, index) => {
    const { name, timestamp, quality, item, label, unit } = result
    const payload = payloadOf(result, shape)
    const parts = { id, index, count, type: 'object', key: name }
    /** @type {Record<string, any>} */
    const message = { payload, topic: name, timestamp, quality, device, item, parts }
    if (quality === 'bad') message.bad = badOf([result]).bad
    if (simulated) message.simulated = true
    if (label) message.label = label
    if (unit) message.unit = unit
    return message
  })
}

const envelopeOf = (result, shape) => ({
  value: valueOf(result, shape),
  quality: result.quality,
  timestamp: result.timestamp,
  ...named('unit', result.unit)
})

const FORMATS = {
  object: objectMessage,
  list: listMessage,
  message: (results, shape) => {
    const sent = results.filter(result => isSent(result, shape))
    return messagePer(sent, shape, valueOf)
  },
  envelope: (results, shape) => messagePer(results, shape, envelopeOf)
}

/**
 * The messages of a read, as fields to be set on the incoming message or a new one.
 *  - `object` one message, payload `{ name: value }`, topic = device
 *  - `message` one per item, payload = value, topic = name, with `parts`
 *  - `envelope` one per item, payload `{ value, quality, timestamp, unit }`
 *  - `list` one message, payload `[{ name, value, quality, timestamp, item, unit, label }]`
 *
 * Each has `timestamp` (epoch ms), `quality` (the worst), `device`, and `bad` = `{ name: { code, text } }` if something is.
 * What has no good value is sent only as `envelope`, or with `badValues: 'null'`.
 * @param {Result[]} results
 * @param {Shape} [shape]
 * @returns {Record<string, any>[]} may be empty
 */
const messagesOf = (results, shape = {}) => {
  const wanted = shape.ranges === 'values' ? expandRanges(results) : results
  if (wanted.length === 0) return []
  return FORMATS[shape.format ?? 'object'](wanted, shape)
}

module.exports = { expandRanges, messagesOf, worst }
