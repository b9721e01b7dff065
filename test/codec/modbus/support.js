'use strict'
const { closed, hex } = require('../support/oracle')
const { EXCHANGES } = require('../../vectors/modbus')

// Written without lib/codec: both framings of a body, by hand.

/** Two's complement of the sum, digit by digit. @param {number[]} body */
function lrcOf(body) {
  let sum = 0
  for (const byte of body) sum = (sum + byte) % 256
  return (256 - sum) % 256
}

const digits = byte => '0123456789ABCDEF'[Math.floor(byte / 16)] + '0123456789ABCDEF'[byte % 16]

/** The bytes on the wire of `station function …`, by protocol. @param {'rtu'|'ascii'} protocol @param {number[]|string} body */
function framed(protocol, body) {
  const bytes = typeof body === 'string' ? [...hex(body)] : body
  if (protocol === 'rtu') return closed(bytes)
  return Buffer.from(`:${[...bytes, lrcOf(bytes)].map(digits).join('')}\r\n`, 'latin1')
}

/** Each worked example in each protocol, with the printed check codes. */
const WIRES = ['rtu', 'ascii'].flatMap(protocol =>
  EXCHANGES.map(({ name, query, q, r, values, crc, lrc }) => {
    const bytes = (body, at) =>
      protocol === 'rtu' ? hex(body + crc[at]) : Buffer.from(`:${(body + lrc[at]).replace(/ /g, '')}\r\n`)
    return { name: `${protocol} ${name}`, protocol, query, values, q: bytes(q, 0), r: bytes(r, 1) }
  })
)

module.exports = { WIRES, framed, lrcOf }
