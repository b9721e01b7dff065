'use strict'

const bytes = text => Buffer.from(text.replace(/\s/g, ''), 'hex')
const shown = buffer => buffer.toString('hex').toUpperCase().replace(/../g, '$& ').trim()

/** CRC bit by bit, as on the protocol page: not the codec's. */
function crc(data) {
  let value = 0xffff
  for (const byte of data) {
    value ^= byte
    for (let bit = 0; bit < 8; bit++) value = value & 1 ? (value >> 1) ^ 0xa001 : value >> 1
  }
  return [value & 255, value >> 8]
}
const framed = (...data) => Buffer.from([...data, ...crc(data)])

module.exports = { bytes, framed, shown }
