'use strict'
const { lrc } = require('../lrc')
const { closed } = require('./query')

/**
 * MODBUS ASCII: `:`, each byte as two digits, LRC, CR LF; panel manual appendix A. The panel's own tables of it have misprints, so the body is
 * the RTU one.
 */

const COLON = 0x3a
const CR = 0x0d
const LF = 0x0a
const DIGITS = /^(?:[0-9A-F]{2})+$/

/**
 * The ASCII frame with the same contents.
 * @param {Uint8Array} rtu with its CRC, which is not looked at
 * @returns {Buffer} 2 × bytes + 1 long
 */
function toAscii(rtu) {
  const body = Buffer.from(rtu.subarray(0, rtu.length - 2))
  const digits = Buffer.concat([body, Buffer.of(lrc(body))])
    .toString('hex')
    .toUpperCase()
  return Buffer.from(`:${digits}\r\n`, 'latin1')
}

/** @param {number} bytes of an RTU frame @returns {number} characters of the same in ASCII */
const asciiLength = bytes => 2 * bytes + 1

/**
 * The RTU frame with the same contents. Strict: capital digits, nothing before or behind.
 * @param {Uint8Array} ascii
 * @returns {Buffer | null} with a CRC of its own; null: it is no frame, or its LRC does not fit
 */
function fromAscii(ascii) {
  const { length } = ascii
  if (length < 9 || ascii[0] !== COLON || ascii[length - 2] !== CR || ascii[length - 1] !== LF) return null
  const digits = Buffer.from(ascii.subarray(1, length - 2)).toString('latin1')
  if (!DIGITS.test(digits)) return null
  const bytes = Buffer.from(digits, 'hex')
  const body = bytes.subarray(0, -1)
  return lrc(body) === bytes[bytes.length - 1] ? closed(body) : null
}

module.exports = { COLON, CR, LF, asciiLength, fromAscii, toAscii }
