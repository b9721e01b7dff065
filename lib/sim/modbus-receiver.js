'use strict'

const { COLON, CR, LF, fromAscii } = require('../codec/modbus/ascii')
const { EXCEPTION, functionByNumber, LOOPBACK } = require('../codec/modbus/functions')
const { crcFits } = require('../codec/modbus/query')
const { createReceiver } = require('./receiver')

const SHORTEST = 4 // station, function, CRC
const LONGEST = 256
const EMPTY = Buffer.alloc(0)

/**
 * The receiver of a MODBUS RTU station (receiver.js). MODBUS frames do not say how long they are: the length follows from the function,
 * and on a line with several stations the answers of the others pass by, too.
 *
 * @param {{ gap: number, station: number, counts: { badCrc: number, strayBytes: number } }} options gap: ms of silence, 3.5 characters
 * @returns {(bytes: Buffer, times: { start: number, end: number }) => ModbusFrame[]} frames with a right CRC, whoever they are for
 */
function createRtuReceiver({ gap, station, counts }) {
  const decodeAt = (held, at, aligned) => {
    const lengths = lengthsAt(held, at, { mine: held[at] === station, aligned })
    const length = lengths.find(each => each <= held.length - at && crcFits(held, at, each))
    if (length === undefined) return null
    const bytes = held.subarray(at, at + length)
    return { bytes, rtu: bytes }
  }
  const lengthAt = (held, at) => {
    const lengths = knownLengths(held, at, held[at] === station)
    return lengths.length > 0 ? Math.max(...lengths) : LONGEST
  }
  const isMine = byte => byte === station
  return createReceiver({ gap, counts, shortest: SHORTEST, lengthAt, decodeAt, isMine })
}

/** Lengths that a frame may have that begins here, the likeliest one first. */
function lengthsAt(held, at, { mine, aligned }) {
  const known = knownLengths(held, at, mine)
  // behind a damaged frame only a whole query to this station counts
  if (!aligned) return mine ? known : []
  if (mine && known.length > 0) return known
  // a function without a length of its own, or another protocol on the same line: whatever has come so far
  const whole = held.length - at
  return whole <= LONGEST ? [...known, whole] : known
}

function knownLengths(held, at, mine) {
  const row = functionByNumber(held[at + 1])
  const lengths = []
  if (held[at + 1] === LOOPBACK) return [8]
  if (row) {
    if (row.request !== 'multiple') lengths.push(8)
    else if (held.length - at > 6) lengths.push(9 + held[at + 6])
    else lengths.push(LONGEST)
    // the answer of another station
    if (!mine) lengths.push(row.answer === 'echo' ? 8 : 5 + held[at + 2])
  } else if (!mine && functionByNumber(held[at + 1] & ~EXCEPTION)) lengths.push(5)
  return lengths
}

/**
 * The receiver of a MODBUS ASCII station: `:` begins a frame, LF ends it; whatever stands outside is dropped.
 * @param {{ gap: number, counts: { badCrc: number, strayBytes: number } }} options gap: ms that may pass between two characters (1000)
 * @returns {(bytes: Buffer, times: { start: number, end: number }) => ModbusFrame[]} frames with a right LRC, whoever they are for
 */
function createAsciiReceiver({ gap, counts }) {
  /** @type {Buffer} */
  let held = EMPTY
  let heardUntil = -Infinity

  const forget = count => {
    counts.strayBytes += count
    held = held.subarray(count)
  }
  const next = () => {
    for (let end = held.indexOf(LF); end >= 0; end = held.indexOf(LF)) {
      // the last colon before the end: what stands before it was cut short
      const start = held.lastIndexOf(COLON, end)
      if (start !== 0) {
        forget(start > 0 ? start : end + 1)
        continue
      }
      const bytes = held.subarray(0, end + 1)
      const rtu = bytes[end - 1] === CR ? fromAscii(bytes) : null
      if (rtu) {
        held = held.subarray(end + 1)
        return { bytes, rtu }
      }
      counts.badCrc++
      forget(end + 1)
    }
    if (held.length > 2 * LONGEST + 1) forget(held.length)
    return null
  }
  return (bytes, { start, end }) => {
    if (start - heardUntil > gap) forget(held.length)
    heardUntil = end
    held = held.length === 0 ? bytes : Buffer.concat([held, bytes])
    const frames = []
    for (let frame = next(); frame; frame = next()) frames.push(frame)
    return frames
  }
}

/** @typedef {{ bytes: Buffer, rtu: Buffer }} ModbusFrame `bytes`: as on the wire; `rtu`: the same as an RTU frame with its CRC */

module.exports = { createRtuReceiver, createAsciiReceiver }
