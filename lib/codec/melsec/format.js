'use strict'

/** How messages look on the wire of a C24 port, complete and checked: what `message.js` and `bidirectional.js` work from. Pure. */

const { PlcError } = require('../../error')

const DC1 = 0x11
const DC3 = 0x13
const EMPTY = Buffer.alloc(0)
const FRAMINGS = Object.freeze(['end', 'count', 'gap'])
const MOST = 1000000
const MOST_FRAME = 80
/** ms: a half byte that was lost in hexadecimal characters is found out by silence only. */
const HEX_SILENCE = 100
/** ms without a byte after which what follows cannot belong to a damaged frame of the bidirectional protocol. */
const FRAME_SILENCE = 50
/** ms that an ACK stands alone, at least: then it is no damaged head of a frame. */
const ACK_SILENCE = 2

const bad = (setting, value, reason) => new PlcError('BAD_SETTING', { setting, value, reason })
const shown = bytes => Buffer.from(bytes).toString('hex').toUpperCase()

const number = (setting, value, { least, most }) => {
  if (Number.isInteger(value) && value >= least && value <= most) return value
  throw bad(setting, value, `a whole number from ${least} to ${most} is needed`)
}

/** Additional code and the codes that it makes transparent (application manual, 12.2). @param {any} options */
const transparency = ({ transparent = EMPTY, dc = false }) => {
  const [additional = null, ...codes] = transparent
  if (additional === DC1 || additional === DC3) {
    throw bad('transparent', shown(transparent), 'DC1 and DC3 are what it has to make transparent')
  }
  const escaped = additional === null ? [] : [additional, ...codes, ...(dc ? [DC1, DC3] : [])]
  return { additional, escaped: new Set(escaped) }
}

/** Codes outside the body: what the flow control, or the removal of additional codes, would take out of them. */
const checkFixed = (setting, bytes, { dc, additional }) => {
  if (dc && (bytes.includes(DC1) || bytes.includes(DC3))) {
    throw bad(setting, shown(bytes), 'DC1 and DC3 are taken by the flow control')
  }
  if (additional !== null && bytes.includes(additional)) {
    throw bad(setting, shown(bytes), 'it contains the additional code, which is removed')
  }
}

/**
 * @typedef {object} MessageOptions all of them may be missing
 * @property {'end'|'count'|'gap'} [framing] what ends a received message
 * @property {Uint8Array} [end] 1 or 2 bytes, for the framing end; default CR LF
 * @property {number} [count] bytes, for the framing count
 * @property {number} [gap] ms of silence: ends a message (framing gap), or gives up one that has begun; 0: none
 * @property {number} [most] bytes of a body
 * @property {Uint8Array} [first] first user frame, up to 80 bytes
 * @property {Uint8Array} [last] last user frame; it ends a message in place of the end code
 * @property {Uint8Array} [transparent] the additional code, then codes that it makes transparent beside DC1 and DC3
 * @property {boolean} [dc] whether DC1 and DC3 are flow control
 * @property {boolean} [asciiBinary] two hexadecimal characters a byte
 * @property {'word'|'byte'} [unit] of the module's counts
 * @property {boolean} [padEven] a zero byte behind an odd body
 */

const checkFraming = ({ framing, end, count, gap, last }) => {
  if (!FRAMINGS.includes(framing)) throw bad('framing', framing, `known are ${FRAMINGS.join(', ')}`)
  if (end.length > 2) throw bad('end', shown(end), 'the receive complete code has 1 or 2 bytes')
  if (framing === 'end' && end.length === 0 && last.length === 0) {
    throw bad('end', 'empty', 'this framing needs an end code or a last frame')
  }
  if (framing === 'count') number('count', count, { least: 1, most: MOST })
  if (framing === 'gap' && gap === 0) throw bad('gap', 0, 'this framing needs a time of silence')
}

const checkFrames = (frames, { dc, additional, escaped, asciiBinary, marker }) => {
  if (!asciiBinary && frames.end.some(byte => escaped.has(byte))) {
    throw bad('end', shown(frames.end), 'it contains a transparent code, and would be taken for data')
  }
  for (const [name, frame] of Object.entries(frames)) {
    if (frame.length > MOST_FRAME) throw bad(name, shown(frame), `a user frame has ${MOST_FRAME} bytes at most`)
    checkFixed(name, frame, { dc, additional })
  }
  const { first } = frames
  if (first.length > 0 && marker.length > 0 && (first.includes(marker) || marker.includes(first))) {
    throw bad('first', shown(first), 'it cannot be told from what ends a message')
  }
}

const defined = options => Object.fromEntries(Object.entries(options).filter(([, value]) => value !== undefined))

/** @type {Readonly<Required<MessageOptions>>} */
const DEFAULTS = Object.freeze({
  framing: 'end',
  end: Buffer.of(0x0d, 0x0a),
  count: 0,
  gap: 0,
  most: 16384,
  first: EMPTY,
  last: EMPTY,
  transparent: EMPTY,
  dc: false,
  asciiBinary: false,
  unit: 'word',
  padEven: false
})

/**
 * @param {MessageOptions} [options]
 * @returns {any} for `encodeMessage` and `messageFraming`
 * @throws {PlcError} BAD_SETTING
 */
const messageFormat = (options = {}) => {
  const given = { ...DEFAULTS, ...defined(options) }
  const { framing, count, gap, most, unit, dc, asciiBinary, padEven } = given
  const [first, last, end] = [given.first, given.last, given.end].map(bytes => Buffer.from(bytes))
  number('gap', gap, { least: 0, most: 3600000 })
  number('most', most, { least: 1, most: MOST })
  checkFraming({ framing, end, count, gap, last })
  if (framing === 'count' && count > most) throw bad('count', count, `it is more than most, ${most}`)
  const { additional, escaped } = transparency(given)
  const marker = last.length > 0 ? last : framing === 'end' ? end : EMPTY
  checkFrames({ first, last, end }, { dc, additional, escaped, asciiBinary, marker })
  const silence = gap || (asciiBinary ? HEX_SILENCE : 0)
  const codes = { dc, first, last, marker, additional, escaped }
  return Object.freeze({ framing, count, most, unit, silence, asciiBinary, padEven, ...codes })
}

/**
 * @param {{ unit?: 'word'|'byte', sumCheck?: boolean, most?: number, gap?: number, transparent?: Uint8Array, asciiBinary?: boolean,
 *   padEven?: boolean, dc?: boolean, character?: number }} [options] gap: ms of silence that ends a damaged frame, 0: automatic;
 *   character: ms that one takes on the line
 * @returns {any} for `encodeFrame` and `bidirectionalFraming`
 * @throws {PlcError} BAD_SETTING; DC1 and DC3 cannot be used: a sum may contain them, and is never made transparent (12.5)
 */
const bidirectionalFormat = (options = {}) => {
  const { unit = 'word', sumCheck = true, most = 16384, gap = 0, dc = false, character = 0 } = options
  if (dc) throw bad('flow', 'dc', 'sums and lengths contain DC1 and DC3; its acknowledgements are the flow control')
  number('most', most, { least: 1, most: unit === 'word' ? 0xffff * 2 : 0xffff })
  number('gap', gap, { least: 0, most: 3600000 })
  const { additional, escaped } = transparency(options)
  const silence = gap || Math.max(FRAME_SILENCE, Math.ceil(4 * character))
  const ackSilence = Math.max(ACK_SILENCE, Math.ceil(4 * character))
  const flags = { asciiBinary: options.asciiBinary === true, padEven: options.padEven === true }
  return Object.freeze({ unit, sumCheck, most, additional, escaped, silence, ackSilence, ...flags })
}

/** A key that is the same for the same format. @param {string} kind @param {Record<string, any>} format */
const keyOf = (kind, format) => {
  const rows = Object.entries(format).map(([name, value]) => {
    if (value instanceof Set) return [name, [...value].sort((a, b) => a - b).join(' ')]
    return [name, Buffer.isBuffer(value) ? value.toString('hex') : value]
  })
  return `${kind} ${rows.map(([name, value]) => `${name}=${value}`).join(' ')}`
}

module.exports = { DC1, DC3, FRAMINGS, bidirectionalFormat, keyOf, messageFormat }
