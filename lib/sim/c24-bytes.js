'use strict'

// A byte that came behind the transparent code: data, whatever its value
const LITERAL = 0x100
const plain = value => value & 0xff

const [DC1, DC3] = [0x11, 0x13]
const [ENQ, ACK, NAK] = [0x05, 0x06, 0x15]
// error codes of the module
const CODES = { hex: 0x7f20, head: 0x7f21, sum: 0x7f24, length: 0x7f25, timeout: 0x7f40, full: 0x7f6a }

const toHex = bytes => Buffer.from(bytes.toString('hex').toUpperCase(), 'latin1')
/** @returns {Buffer | null} null: half a byte, or characters that are no capital hexadecimal digits */
const fromHex = characters => {
  const text = characters.toString('latin1')
  return /^([0-9A-F]{2})*$/.test(text) ? Buffer.from(text, 'hex') : null
}

/** DC1, DC3 and the transparent code itself get the transparent code before them. */
function escaped(bytes, { transparent }) {
  if (transparent.length === 0) return bytes
  const [code, ...more] = transparent
  return Buffer.from([...bytes].flatMap(byte => ([DC1, DC3, code, ...more].includes(byte) ? [code, byte] : [byte])))
}

const word = value => Buffer.of(value & 255, value >> 8)

/** What the module sends in the non-procedure protocol. It converts its user frames, too. */
function freeMessage(bytes, settings) {
  const { first, last, end, asciiBinary } = settings
  const converted = each => (asciiBinary ? toHex(each) : each)
  const close = first.length + last.length > 0 ? last : end
  return Buffer.concat([converted(first), escaped(converted(bytes), settings), converted(close)])
}

/** What it sends in the bidirectional protocol; an odd byte is padded in words. */
function bidirectionalMessage(bytes, settings) {
  const { unit, sumCheck, asciiBinary } = settings
  const data = unit === 'word' && bytes.length % 2 ? Buffer.concat([bytes, Buffer.of(0)]) : bytes
  const section = Buffer.concat([word(unit === 'word' ? data.length / 2 : data.length), data])
  const characters = asciiBinary ? toHex(section) : section
  const sum = characters.reduce((total, byte) => total + byte, 0) & 0xffff
  return Buffer.concat([Buffer.of(ENQ), escaped(characters, settings), ...(sumCheck ? [word(sum)] : [])])
}

/** ACK, or NAK with a code. */
function acknowledgement(code, settings) {
  if (!code) return Buffer.of(ACK)
  const characters = settings.asciiBinary ? toHex(word(code)) : word(code)
  return Buffer.concat([Buffer.of(NAK), escaped(characters, settings)])
}

module.exports = {
  acknowledgement,
  bidirectionalMessage,
  freeMessage,
  fromHex,
  plain,
  toHex,
  ...{ ACK, CODES, DC1, DC3, ENQ, LITERAL, NAK }
}
