'use strict'

/**
 * The checked line format, an option of ours (the controller's PLC program must speak it, too): `#NN text*HH`. HH: the XOR of all bytes before the `*`, two hex digits.
 * NN: the number of the line, 00 for the first one after a start, then 01 to 99 and 01 again: a gap tells how many lines are missing.
 * A line without `#NN ` is taken by its check alone.
 */

const START = 0
const LAST = 99
const HASH = 0x23
const SPACE = 0x20
const STAR = 0x2a
const HEAD = 4 // #NN and a space
const TAIL = 3 // *HH

/** @param {Uint8Array} bytes @returns {number} 0..255; 43h for `#01 A` */
const xor = bytes => bytes.reduce((sum, byte) => sum ^ byte, 0)

/** @param {number} number @returns {number} of the line after that one */
const nextNumber = number => (number >= LAST ? START + 1 : number + 1)

/**
 * How many lines are missing between two.
 * @param {number|null} last number of the line before; null: none came yet
 * @param {number|null} number
 * @returns {number} 0..98; 0 too if the other side has just started, or does not number
 */
const missingBetween = (last, number) => {
  if (last === null || number === null || number === START) return 0
  return (number - nextNumber(last) + LAST) % LAST
}

/**
 * @param {Uint8Array} text
 * @param {number} number 0..99
 * @returns {Buffer} without line end
 */
const seal = (text, number) => {
  const body = Buffer.concat([Buffer.from(`#${String(number).padStart(2, '0')} `), text])
  const digits = xor(body).toString(16).toUpperCase().padStart(2, '0')
  return Buffer.concat([body, Buffer.from(`*${digits}`)])
}

/** The number whose two decimal digits stand at 1 and 2, or null. */
const numberOf = line => {
  if (line.length < HEAD || line[0] !== HASH || line[3] !== SPACE) return null
  const digits = line.toString('latin1', 1, 3)
  return /^\d\d$/.test(digits) ? Number(digits) : null
}

/**
 * @param {Buffer} line without line end
 * @returns {{ text: Buffer, number: number|null } | { reason: 'noCheck'|'check' }} noCheck: it does not end with `*HH`
 */
const unseal = line => {
  const at = line.length - TAIL
  const digits = line.toString('latin1', at + 1)
  if (at < 0 || line[at] !== STAR || !/^[\da-f]{2}$/i.test(digits)) return { reason: 'noCheck' }
  const body = line.subarray(0, at)
  if (xor(body) !== parseInt(digits, 16)) return { reason: 'check' }
  const number = numberOf(body)
  return { text: number === null ? body : body.subarray(HEAD), number }
}

module.exports = { OVERHEAD: HEAD + TAIL, START, missingBetween, nextNumber, seal, unseal, xor }
