'use strict'
const { PlcError } = require('../error')
const { toAscii } = require('../codec/melsec/ascii-binary')
const { bidirectionalFraming } = require('../codec/melsec/bidirectional')
const { ENCODINGS, FORMATS } = require('../codec/melsec/convert')
const { FRAMINGS, bidirectionalFormat, messageFormat } = require('../codec/melsec/format')
const { messageFraming } = require('../codec/melsec/message')
const { blank, choice, isOn, textOf, wholeNumber } = require('./options')

/** The configuration of a C24 port, read and checked before anything is sent. Times in ms. */

const HOUR = 3600000

/** `0D 0A`, `0d0a`, or bytes. @param {string} setting @param {any} value @param {Buffer} fallback */
const hexBytes = (setting, value, fallback) => {
  if (value instanceof Uint8Array) return Buffer.from(value)
  if (value === undefined || value === null) return fallback
  const text = textOf(setting, value).replace(/[\s,]+/g, '')
  if (/^([\da-f]{2})*$/i.test(text)) return Buffer.from(text, 'hex')
  throw new PlcError('BAD_SETTING', { setting, value, reason: 'bytes in hexadecimal are needed, as 0D 0A' })
}

const number = (given, name, { fallback, least = 0, most = HOUR }) =>
  wholeNumber(name, given[name], { fallback, least, most })

const NONE = Buffer.alloc(0)

/** What goes over the wire. */
const readFormat = (given, { bidirectional, dc, character }) => {
  const shared = {
    most: number(given, 'most', { fallback: 16384, least: 1, most: 1000000 }),
    gap: number(given, 'gap', { fallback: 0 }),
    unit: /** @type {any} */ (choice('unit', given.unit, ['word', 'byte'])),
    transparent: hexBytes('transparent', given.transparent, NONE),
    asciiBinary: isOn(given.asciiBinary),
    padEven: isOn(given.padEven),
    dc
  }
  if (bidirectional) {
    const sumCheck = blank(given.sumCheck) || isOn(given.sumCheck)
    const format = bidirectionalFormat({ ...shared, sumCheck, character })
    return { format, framing: bidirectionalFraming(format) }
  }
  const format = messageFormat({
    ...shared,
    framing: /** @type {any} */ (choice('framing', given.framing, [...FRAMINGS])),
    end: hexBytes('end', given.end, Buffer.of(0x0d, 0x0a)),
    count: number(given, 'count', { fallback: 0, most: 1000000 }),
    first: hexBytes('first', given.first, NONE),
    last: hexBytes('last', given.last, NONE)
  })
  return { format, framing: messageFraming(format) }
}

/** Flow control: ours, or the driver's, which the line has. */
const readFlow = (given, line) => {
  const flow = choice('flow', given.flow, ['none', 'dc', 'driver'])
  const driver = line.flowControl ?? 'none'
  if (flow === 'driver' && driver === 'none') {
    throw new PlcError('BAD_SETTING', {
      setting: 'flow',
      value: flow,
      reason: 'the line has no flow control: set it there'
    })
  }
  return { flow, dc: flow === 'dc' || driver === 'xonxoff' }
}

/** How the line is used: the options of `lease.listen`. */
const readUse = (given, { flow, format, bidirectional }) => {
  const wait = number(given, 'timer0', { fallback: 0 })
  const tornEnd = isOn(given.tornEnd) && !bidirectional && format.marker.length > 0
  const first = tornEnd
    ? format.asciiBinary && format.last.length === 0
      ? toAscii(format.marker)
      : format.marker
    : null
  return {
    flow: flow === 'dc' ? 'dc' : 'none',
    transparent: flow === 'dc' ? format.additional : null,
    room: number(given, 'room', { fallback: 64, least: 1, most: 1000000 }),
    stallLimit: number(given, 'stallLimit', { fallback: 30000, least: 1 }),
    // a torn message must not be continued by the next one
    torn: { wait: format.framing === 'gap' ? Math.max(wait, format.silence) : wait, first }
  }
}

/** The bidirectional protocol: acknowledgement and repetition. */
const readConfirmation = given => ({
  ackTimeout: number(given, 'ackTimeout', { fallback: 1000, least: 1 }),
  attempts: number(given, 'attempts', { fallback: 3, least: 1, most: 20 }),
  repeatUnanswered: isOn(given.repeatUnanswered),
  priority: choice('priority', given.priority, ['both', 'c24', 'us']),
  repeats: choice('repeats', given.repeats, ['mark', 'drop']),
  repeatAfter: number(given, 'repeatAfter', { fallback: 0 }),
  repeatWithin: number(given, 'repeatWithin', { fallback: 10000 })
})

/**
 * @param {Record<string, any>} given see `createC24Port`
 * @param {any} line
 * @throws {PlcError} BAD_SETTING
 */
const readSettings = (given, line) => {
  const bidirectional = isOn(given.bidirectional)
  const { flow, dc } = readFlow(given, line)
  const character = line.times?.character ?? 0.52
  const { format, framing } = readFormat(given, { bidirectional, dc, character })
  const quiet = number(given, 'quiet', { fallback: 0 })
  return {
    name: blank(given.name) ? 'C24' : textOf('name', given.name),
    bidirectional,
    character,
    format,
    framing,
    use: readUse(given, { flow, format, bidirectional }),
    value: {
      format: choice('format', given.format, [...FORMATS]),
      encoding: choice('encoding', given.encoding, [...ENCODINGS]),
      most: format.most
    },
    // two who answer each other do not begin inside what the other one says
    quiet: bidirectional ? Math.max(quiet, Math.ceil(4 * character)) : quiet,
    // the other side needs the silence to see where a message ends
    after: format.framing === 'gap' ? format.silence : 0,
    deadline: number(given, 'deadline', { fallback: 0 }),
    ...readConfirmation(given)
  }
}

module.exports = { readSettings }
