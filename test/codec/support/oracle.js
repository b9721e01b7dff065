'use strict'

// Written from the manual alone, by other means than lib/codec: bit by bit, with plain arrays. It must not import anything of lib.

/** Manual "CRC-16 calculation subroutine written in C", corrected for the start value. @param {number[]} bytes */
function crc(bytes) {
  let sum = 0xffff
  for (const byte of bytes) {
    sum ^= byte
    for (let i = 0; i < 8; i++) {
      const carry = sum % 2
      sum = Math.floor(sum / 2)
      if (carry === 1) sum ^= 0xa001
    }
  }
  return [sum % 256, Math.floor(sum / 256)]
}

/** Closes `DA SA FN LEN INFO` with its CRC. @param {number[]} bytes */
const closed = bytes => Buffer.from([...bytes, ...crc(bytes)])

/** A frame by hand: LEN is counted here, 256 becomes 0. */
const frame = ([to, from, fn], info) => closed([to, from, fn, info.length === 256 ? 0 : info.length, ...info])

/** '01 E2 …' to bytes */
const hex = text => Buffer.from(text.replace(/\s+/g, ''), 'hex')

/** bytes to '01 E2 …' */
const show = bytes => (bytes.toString('hex').toUpperCase().match(/../g) ?? []).join(' ')

module.exports = { crc, closed, frame, hex, show }
