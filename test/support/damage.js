'use strict'

/**
 * Damaged answers by class through the recognisers of the codecs, as the line asks them. Wrong: a frame is taken, and it is not the one that was sent.
 */

const { crc16 } = require('../../lib/codec/crc16')
const { answerTo: modbusAnswerTo } = require('../../lib/codec/modbus/match')
const { encodeAnswer: modbusAnswer } = require('../../lib/codec/modbus/answer')
const { toAscii } = require('../../lib/codec/modbus/ascii')
const { encodeQuery: modbusQuery } = require('../../lib/codec/modbus/query')
const { answerTo: nxAnswerTo } = require('../../lib/codec/nx/match')
const { encodeAnswer: nxAnswer } = require('../../lib/codec/nx/answer')
const { encodeQuery: nxQuery } = require('../../lib/codec/nx/query')
const { createRandom } = require('../../lib/sim')
const theory = require('./damage-theory')

const COUNTS = [1, 2, 5, 10, 20] // words that are read
const STATION = 17
const MASTER = 0xe5

/** Answers to a read of `count` words: match, bytes of the header, and fresh random data in a frame of the wire. */
const PROTOCOLS = {
  nx(count) {
    const query = /** @type {const} */ ({ ask: 'readWords', base: 0x1bf, count })
    const ends = /** @type {const} */ ({ station: STATION, master: MASTER, steps: 2 })
    const frame = nxAnswer(query, new Array(count).fill(0), /** @type {any} */ (ends))
    const match = nxAnswerTo(query, { ...ends, sent: nxQuery(query, ends) })
    return { match, header: 4, frame, refresh: random => withCrc(frame, { header: 4, random }) }
  },
  rtu(count) {
    const query = /** @type {const} */ ({ fn: 3, base: 107, count })
    const frame = modbusAnswer(query, STATION, new Array(count).fill(0))
    const match = modbusAnswerTo(query, { station: STATION, sent: modbusQuery(query, STATION) })
    return { match, header: 3, frame, refresh: random => withCrc(frame, { header: 3, random }) }
  },
  ascii(count) {
    const query = /** @type {const} */ ({ fn: 3, base: 107, count })
    const frame = toAscii(modbusAnswer(query, STATION, new Array(count).fill(0)))
    const sent = toAscii(modbusQuery(query, STATION))
    const match = modbusAnswerTo(query, { station: STATION, protocol: 'ascii', sent })
    return { match, header: 7, frame, refresh: random => withLrc(frame, random) }
  }
}

function withCrc(frame, { header, random }) {
  const end = frame.length - 2
  for (let at = header; at < end; at++) frame[at] = random.integer(0, 255)
  frame.writeUInt16LE(crc16(frame, 0, end), end)
}

const DIGITS = Buffer.from('0123456789ABCDEF')
const valueOf = digit => (digit <= 0x39 ? digit - 0x30 : digit - 0x37)

function withLrc(frame, random) {
  const end = frame.length - 4
  for (let at = 7; at < end; at++) frame[at] = DIGITS[random.integer(0, 15)]
  let sum = 0
  for (let at = 1; at < end; at += 2) sum += 16 * valueOf(frame[at]) + valueOf(frame[at + 1])
  frame.write((-sum & 255).toString(16).toUpperCase().padStart(2, '0'), end, 'latin1')
}

const flip = (bytes, bit) => void (bytes[bit >> 3] ^= 1 << (bit & 7))

function flipBits(bytes, { random }, count) {
  const places = new Set()
  while (places.size < count) places.add(random.integer(0, 8 * bytes.length - 1))
  for (const bit of places) flip(bytes, bit)
  return bytes
}

/** From the first flipped bit to the last; as the UART sends them: the lowest bit of a byte first. */
function burst(bytes, { random }, length) {
  const first = random.integer(0, 8 * bytes.length - length)
  for (let n = 0; n < length; n++) if (n === 0 || n === length - 1 || random.chance(0.5)) flip(bytes, first + n)
  return bytes
}

function swap(bytes, one, other) {
  const byte = bytes[one]
  bytes[one] = bytes[other]
  bytes[other] = byte
  return bytes
}

/** Draws two different places within `[first, end)`, at most `apart` from each other, whose bytes differ; none: after some tries. */
function twoPlaces(bytes, { random, first, end }, apart) {
  for (let tries = 0; tries < 100; tries++) {
    const one = random.integer(first, end - 1)
    const other = apart === 1 ? one + 1 : random.integer(first, end - 1)
    if (other < end && bytes[one] !== bytes[other]) return [one, other]
  }
  return null
}

function swapped(bytes, frame, apart) {
  const places = twoPlaces(bytes, frame, apart)
  return places && swap(bytes, places[0], places[1])
}

const cut = (bytes, at) => Buffer.concat([bytes.subarray(0, at), bytes.subarray(at + 1)])
const put = (bytes, at, byte) => Buffer.concat([bytes.subarray(0, at), Buffer.of(byte), bytes.subarray(at)])
const lost = (bytes, { random }) => cut(bytes, random.integer(0, bytes.length - 1))
const truncated = (bytes, { random }) => bytes.subarray(0, random.integer(1, bytes.length - 1))
const inserted = (bytes, { random }) => put(bytes, random.integer(0, bytes.length), random.integer(0, 255))

function replaced(bytes, { random }, at) {
  const before = bytes[at]
  while (bytes[at] === before) bytes[at] = DIGITS[random.integer(0, 15)]
}

function replaceTwo(bytes, frame, apart) {
  const { random, first, end } = frame
  const one = random.integer(first, end - 1 - (apart === 1 ? 1 : 0))
  let other = one + 1
  while (apart !== 1 && (other = random.integer(first, end - 1)) === one);
  replaced(bytes, frame, one)
  replaced(bytes, frame, other)
  return bytes
}

function randomBehindHeader(bytes, { random, header, ascii }) {
  const end = ascii ? bytes.length - 2 : bytes.length
  for (let at = header; at < end; at++) bytes[at] = ascii ? DIGITS[random.integer(0, 15)] : random.integer(0, 255)
  return bytes
}

/** name, what is done to the frame, what the check code lets pass by theory (0: claimed). */
const WITH_CRC = [
  ['1 bit', (b, f) => flipBits(b, f, 1), () => 0],
  ['2 bits', (b, f) => flipBits(b, f, 2), () => 0],
  ['3 bits', (b, f) => flipBits(b, f, 3), () => 0],
  ['5 to 15 bits, odd', (b, f) => flipBits(b, f, 2 * f.random.integer(2, 7) + 1), () => 0],
  ['burst of 2 to 16 bits', (b, f) => burst(b, f, f.random.integer(2, 16)), () => 0],
  ['truncated', truncated, () => 0],
  ['a byte lost', lost, () => 0],
  ['two neighbouring bytes swapped', (b, f) => swapped(b, f, 1), () => 0],
  ['any two bytes swapped', (b, f) => swapped(b, f, 0), () => 0],
  ['4 bits', (b, f) => flipBits(b, f, 4), theory.fourBits],
  [
    'burst of 17 bits',
    (b, f) => burst(b, f, 17),
    f => (2 * theory.CRC * (8 * (f.length - f.header) - 16)) / (8 * f.length - 16)
  ],
  [
    'burst of 18 to 32 bits',
    (b, f) => burst(b, f, f.random.integer(18, 32)),
    f => (theory.CRC * (8 * (f.length - f.header) - 24)) / (8 * f.length - 24)
  ],
  ['a byte put in', inserted, f => theory.shifted(f, f.length + 1)],
  [
    'a byte lost, another behind',
    (b, f) => put(lost(b, f), b.length - 1, f.random.integer(0, 255)),
    f => theory.shifted(f, f.length)
  ],
  ['random behind the header', randomBehindHeader, () => theory.CRC]
]

const WITH_LRC = [
  ['1 bit', (b, f) => flipBits(b, f, 1), () => 0],
  ['a digit replaced', (b, f) => (replaced(b, f, f.random.integer(f.first, f.end - 1)), b), () => 0],
  ['two neighbouring digits replaced', (b, f) => replaceTwo(b, f, 1), () => 0],
  ['two neighbouring digits swapped', (b, f) => swapped(b, f, 1), () => 0],
  ['truncated', truncated, () => 0],
  ['a character lost', lost, () => 0],
  ['a character put in', inserted, () => 0],
  ['a character lost, another behind', (b, f) => put(lost(b, f), b.length - 1, f.random.integer(0, 255)), () => 0],
  ['2 bits', (b, f) => flipBits(b, f, 2), f => theory.bitsOfAscii(f, 2)],
  ['3 bits', (b, f) => flipBits(b, f, 3), f => theory.bitsOfAscii(f, 3)],
  ['4 bits', (b, f) => flipBits(b, f, 4), f => theory.bitsOfAscii(f, 4)],
  ['any two digits replaced', (b, f) => replaceTwo(b, f, 0), theory.twoReplaced],
  ['any two digits swapped', (b, f) => swapped(b, f, 0), theory.twoSwapped],
  ['random digits behind the header', randomBehindHeader, () => theory.LRC]
]

/** What the line makes of bytes that come at once: the frame that is taken, or null. */
function taken(match, bytes) {
  let rest = bytes
  while (rest.length > 0) {
    const { take, skip, bad } = match(rest)
    if (take > 0 && take <= rest.length) return rest.subarray(0, take)
    if (bad || !(skip > 0)) return null
    rest = rest.subarray(skip)
  }
  return null
}

const classesOf = protocol => (protocol === 'ascii' ? WITH_LRC : WITH_CRC)

function prepared(protocol, random) {
  const ascii = protocol === 'ascii'
  return COUNTS.map(count => {
    const made = PROTOCOLS[protocol](count)
    const { length } = made.frame
    const [first, end] = ascii ? [made.header, length - 2] : [0, length]
    return { ...made, random, ascii, length, first, end, digits: end - first }
  })
}

/**
 * @param {{ protocol: string, frames: number, seed?: number }} options frames: in all, shared among the classes
 * @returns {{ name: string, frames: number, wrong: number, right: number, expected: number }[]} right: the whole answer was there all the same; expected:
 *   wrong ones by theory
 */
function damaged({ protocol, frames, seed = 1 }) {
  const random = createRandom(seed)
  const kinds = prepared(protocol, random)
  const classes = classesOf(protocol)
  const each = Math.ceil(frames / classes.length / kinds.length)
  return classes.map(([name, damage, passes]) => {
    const row = { name, frames: 0, wrong: 0, right: 0, expected: 0 }
    for (const kind of kinds) {
      for (let n = 0; n < each; n++) {
        kind.refresh(random)
        const bytes = damage(Buffer.from(kind.frame), kind)
        if (!bytes) continue
        row.frames++
        const got = taken(kind.match, bytes)
        if (got?.equals(kind.frame)) row.right++
        else if (got) row.wrong++
      }
      row.expected += each * passes(kind)
    }
    return row
  })
}

/** Rows that theory does not explain: claimed ones with a wrong frame, others beyond five standard deviations. */
const unexplained = rows =>
  rows.filter(({ wrong, expected }) => Math.abs(wrong - expected) > (expected === 0 ? 0 : 5 * Math.sqrt(expected) + 3))

module.exports = { damaged, unexplained }
