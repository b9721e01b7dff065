'use strict'

// reflected polynomial $A001, start $FFFF; NX manual "Cyclic Redundancy Checking (CRC)", the same as MODBUS RTU
const POLYNOMIAL = 0xa001
const START = 0xffff

const TABLE = Uint16Array.from({ length: 256 }, (_, byte) => {
  let crc = byte
  for (let bit = 0; bit < 8; bit++) crc = crc & 1 ? (crc >>> 1) ^ POLYNOMIAL : crc >>> 1
  return crc
})

/**
 * CRC-16 over bytes[start..end). It goes onto the wire low byte first.
 * @param {ArrayLike<number>} bytes
 * @param {number} [start] first byte
 * @param {number} [end] byte after the last one
 * @returns {number} 0..65535; 4B37h for the ASCII text 123456789
 */
function crc16(bytes, start = 0, end = bytes.length) {
  let crc = START
  for (let i = start; i < end; i++) crc = (crc >>> 8) ^ TABLE[(crc ^ bytes[i]) & 0xff]
  return crc
}

module.exports = { crc16 }
