'use strict'

/** What check codes let pass, by arithmetic alone: nothing of lib is used here. Frames have random data. */

const CRC = 2 ** -16
const LRC = 2 ** -8
const BYTE = 256

const crcTable = Array.from({ length: 256 }, (_, byte) => {
  let sum = byte
  for (let bit = 0; bit < 8; bit++) sum = sum & 1 ? (sum >> 1) ^ 0xa001 : sum >> 1
  return sum
})

/** What one flipped bit does to the CRC that is computed over `data` bytes. */
function syndrome(data, bit) {
  let sum = crcTable[1 << (bit & 7)]
  for (let at = (bit >> 3) + 1; at < data; at++) sum = (sum >> 8) ^ crcTable[sum & 255]
  return sum
}

const choose = (n, k) => Array.from({ length: k }, (_, i) => (n - i) / (i + 1)).reduce((a, b) => a * b, 1)

/**
 * Four flipped bits of a frame: the share that the CRC does not see and that leaves the header as it is. Two pairs of bits cancel out if their
 * syndromes are alike; each four of bits consists of three such pairs of pairs.
 * @param {{ header: number, length: number }} frame bytes
 */
function fourBits({ header, length }) {
  const data = length - 2
  const bits = []
  for (let bit = 8 * header; bit < 8 * data; bit++) bits.push(syndrome(data, bit))
  for (let bit = 0; bit < 16; bit++) bits.push(1 << bit)
  const pairs = new Uint32Array(65536)
  for (let a = 0; a < bits.length; a++) for (let b = a + 1; b < bits.length; b++) pairs[bits[a] ^ bits[b]]++
  const same = pairs.reduce((sum, n) => sum + (n * (n - 1)) / 2, 0)
  return same / 3 / choose(8 * length, 4)
}

/** A byte lost or put in: what follows is shifted. Within the last two bytes it would be a burst, which the CRC sees. */
const shifted = ({ header, length }, places) => ((length - 2 - header) / places) * CRC

const DIGITS = [...'0123456789ABCDEF'].map(digit => digit.charCodeAt(0))
const ones = byte => [...byte.toString(2)].filter(bit => bit === '1').length

/** What `count` flipped bits make of a digit that may be any: value changes, with their share of all digits. */
function flips(count) {
  const changes = new Map()
  for (let mask = 0; mask < 256; mask++) {
    if (ones(mask) !== count) continue
    DIGITS.forEach((code, value) => {
      const other = DIGITS.indexOf(code ^ mask)
      if (other >= 0) changes.set(other - value, (changes.get(other - value) ?? 0) + 1 / 16)
    })
  }
  return [...changes]
}

/** Ways to change digits, by bits flipped (or digits replaced) and what happens to the sum: one digit after the other. */
function undetected(digits, most, changesOf) {
  let ways = Array.from({ length: most + 1 }, () => new Float64Array(BYTE))
  ways[0][0] = 1
  const changes = Array.from({ length: most + 1 }, (_, count) => changesOf(count))
  for (let at = 0; at < digits; at++) {
    const weight = at % 2 === 0 ? 16 : 1
    const next = ways.map(row => row.slice())
    for (let count = 1; count <= most; count++)
      for (const [change, share] of changes[count])
        for (let before = 0; before + count <= most; before++)
          for (let sum = 0; sum < BYTE; sum++)
            next[before + count][(sum + change * weight + 16 * BYTE) % BYTE] += ways[before][sum] * share
    ways = next
  }
  return ways[most][0]
}

/** `count` bits of an ASCII frame: the digits of its header are compared, `:` CR LF as well. */
function bitsOfAscii({ header, length }, count) {
  const key = `${header} ${length} ${count}`
  if (!known.has(key)) known.set(key, undetected(length - 2 - header, count, flips) / choose(8 * length, count))
  return known.get(key)
}
const known = new Map()

/** Two digits behind the header replaced by others. */
const ONE_OTHER = Array.from({ length: 31 }, (_, n) => n - 15)
  .filter(Boolean)
  .map(change => [change, (16 - Math.abs(change)) / 16])
const twoReplaced = ({ digits }) =>
  undetected(digits, 2, count => (count === 1 ? ONE_OTHER : [])) / (choose(digits, 2) * 15 * 15)

/** Two different digits swapped: seen unless both are high or both low digits of their byte. */
const twoSwapped = ({ digits }) => (2 * choose(digits / 2, 2)) / choose(digits, 2)

module.exports = { CRC, LRC, bitsOfAscii, fourBits, shifted, twoReplaced, twoSwapped }
