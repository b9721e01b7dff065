'use strict'

/** ASCII-binary conversion of the C24: two hexadecimal characters a byte, capital letters (user's manual, application, ch. 13). Pure. */

const DIGITS = Buffer.from('0123456789ABCDEF', 'latin1')

/** @type {Int8Array} character -> 0..15, or -1 */
const VALUES = new Int8Array(256).fill(-1)
DIGITS.forEach((character, value) => (VALUES[character] = value))

/**
 * What one character stands for: the module converts 30H to 39H and 41H to 46H, and reports an error for all others.
 * @param {number} character a byte
 * @returns {number} 0..15, or -1
 */
const hexDigit = character => VALUES[character]

/**
 * @param {Uint8Array} bytes
 * @returns {Buffer} twice as many characters
 */
const toAscii = bytes => {
  const ascii = Buffer.alloc(bytes.length * 2)
  bytes.forEach((byte, n) => {
    ascii[2 * n] = DIGITS[byte >> 4]
    ascii[2 * n + 1] = DIGITS[byte & 15]
  })
  return ascii
}

/**
 * @param {Uint8Array} ascii
 * @returns {Buffer|null} null: an odd count, or a character that is no hexadecimal digit
 */
const fromAscii = ascii => {
  if (ascii.length % 2 !== 0) return null
  const bytes = Buffer.alloc(ascii.length / 2)
  for (let n = 0; n < bytes.length; n++) {
    const high = VALUES[ascii[2 * n]]
    const low = VALUES[ascii[2 * n + 1]]
    if (high < 0 || low < 0) return null
    bytes[n] = (high << 4) | low
  }
  return bytes
}

module.exports = { fromAscii, hexDigit, toAscii }
