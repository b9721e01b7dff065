'use strict'

/**
 * The check byte of MODBUS ASCII over bytes[start..end): what makes the sum of all bytes 0. It goes onto the wire as two digits, high one first.
 * @param {ArrayLike<number>} bytes the binary bytes, not their digits
 * @param {number} [start] first byte
 * @param {number} [end] byte after the last one
 * @returns {number} 0..255; 7Eh for 11 03 00 6B 00 03
 */
function lrc(bytes, start = 0, end = bytes.length) {
  let sum = 0
  for (let i = start; i < end; i++) sum += bytes[i]
  return -sum & 0xff
}

module.exports = { lrc }
