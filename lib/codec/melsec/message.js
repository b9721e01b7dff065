'use strict'

/** Messages of the non-procedure protocol: what goes out for a body (user's manual, ch. 6; application manual, ch. 11 to 13). Pure. */

const { PlcError } = require('../../error')
const { toAscii } = require('./ascii-binary')
const { DC1, DC3, keyOf } = require('./format')
const { MessageSplitter } = require('./splitter')

const hex = bytes => [...bytes].map(byte => byte.toString(16).toUpperCase().padStart(2, '0')).join(' ')

/**
 * A body that the other side would cut at another place. One that ends in the first byte of a two-byte end code is refused too: `… CR CR LF`
 * is told right only by a receiver that looks back.
 */
const checkEnd = (body, { marker }) => {
  if (marker.length === 0) return
  const at = Buffer.concat([body, marker]).indexOf(marker)
  if (at < body.length)
    throw new PlcError('END_CODE_INSIDE', { code: hex(marker), at, reason: 'it would be cut there' })
  for (let length = 1; length < marker.length; length++) {
    if (body.length >= length && body.subarray(-length).equals(marker.subarray(0, length))) {
      const reason = 'its last bytes are the beginning of the end code'
      throw new PlcError('END_CODE_INSIDE', { code: hex(marker), at: body.length - length, reason })
    }
  }
}

const checkFirst = (body, { first, marker }) => {
  const at = first.length > 0 && marker.length > 0 ? Buffer.concat([body, marker]).indexOf(first) : -1
  if (at < 0) return
  throw new PlcError('END_CODE_INSIDE', {
    code: hex(first),
    at,
    reason: 'it is the first frame, where a message begins'
  })
}

/** @param {Buffer} bytes @param {Set<number>} codes @param {number|null} additional */
const withTransparency = (bytes, codes, additional) => {
  if (additional === null || !bytes.some(byte => codes.has(byte))) return bytes
  return Buffer.from([...bytes].flatMap(byte => (codes.has(byte) ? [additional, byte] : [byte])))
}

const checkFlow = (bytes, { dc, additional }) => {
  if (!dc || additional !== null) return
  const at = bytes.findIndex(byte => byte === DC1 || byte === DC3)
  if (at >= 0) throw new PlcError('FLOW_CODE_INSIDE', { at, code: bytes[at] === DC1 ? 'DC1 (11H)' : 'DC3 (13H)' })
}

/** An even body, where the module counts words of it and would drop half a word (application manual, 11.2). */
const evenBody = (body, { padEven, unit, first, last }) => {
  if (body.length % 2 === 0) return body
  if (padEven) return Buffer.concat([body, Buffer.of(0)])
  if (unit === 'word' && (first.length > 0 || last.length > 0)) {
    throw new PlcError('ODD_COUNT', {
      count: body.length,
      reason: 'with user frames the module counts whole words and drops the last byte'
    })
  }
  return body
}

/**
 * The bytes that go out for a body.
 *
 * The end code is added for the framing `end`, user frames always. With ASCII-binary conversion body and end code become hexadecimal
 * characters, user frames do not: the module converts before it looks for its complete code, and takes user frames as registered (13.3).
 * @param {Uint8Array} given
 * @param {any} format of `messageFormat`
 * @returns {Buffer}
 * @throws {PlcError} END_CODE_INSIDE, FLOW_CODE_INSIDE, ODD_COUNT, FRAME_TOO_LONG, BAD_VALUE (nothing to send)
 */
const encodeMessage = (given, format) => {
  const { framing, last, first, marker, additional, escaped, asciiBinary, most } = format
  if (given.length > most) throw new PlcError('FRAME_TOO_LONG', { what: 'the message', got: given.length, most })
  const body = evenBody(Buffer.from(given), format)
  if (body.length === 0 && (framing !== 'end' || last.length > 0)) {
    throw new PlcError('BAD_VALUE', {
      item: 'the message',
      value: '',
      reason: 'it is empty, and no end code would be sent'
    })
  }
  checkEnd(body, format)
  checkFirst(body, format)
  const end = last.length > 0 ? Buffer.alloc(0) : marker
  const middle = asciiBinary ? toAscii(Buffer.concat([body, end])) : Buffer.concat([body, end])
  checkFlow(middle, format)
  return Buffer.concat([first, withTransparency(middle, escaped, additional), last])
}

/**
 * How received bytes are cut into messages; for `lease.listen`.
 * @param {any} format of `messageFormat`
 * @returns {{ key: string, create: () => MessageSplitter }}
 */
const messageFraming = format => ({ key: keyOf('melsec', format), create: () => new MessageSplitter(format) })

module.exports = { encodeMessage, messageFraming, withTransparency }
