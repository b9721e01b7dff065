'use strict'

const EMPTY = Buffer.alloc(0)

/**
 * How a simulated station finds binary frames in bytes that come in any pieces. A silence ends a half-received frame; after
 * a frame with a wrong check code the search goes on one byte later, so noise before a query costs nothing, also where it
 * looks like the head of a longer frame.
 *
 * @template {{ bytes: Buffer }} Frame
 * @param {object} options
 * @param {number} options.gap ms of silence after which a half-received frame is forgotten
 * @param {number} options.shortest bytes of the shortest frame
 * @param {(held: Buffer, at: number) => number} options.lengthAt bytes that a frame beginning there may have at most
 * @param {(held: Buffer, at: number, aligned: boolean) => Frame | null} options.decodeAt a whole, undamaged frame; aligned: it
 *   begins after a silence or another frame, not somewhere within
 * @param {(byte: number) => boolean} options.isMine whether a frame that begins with this byte is for this station
 * @param {{ badCrc: number, strayBytes: number }} options.counts
 * @returns {(bytes: Buffer, times: { start: number, end: number }) => Frame[]} complete frames, whoever they are for; `start`
 *   and `end` are when the bytes were on the wire, in ms
 */
function createReceiver({ gap, counts, ...form }) {
  /** @type {Buffer} */
  let held = EMPTY
  let heardUntil = -Infinity
  let aligned = true
  let damaged = false

  const forget = count => {
    counts.strayBytes += count
    held = held.subarray(count)
    aligned = false
  }
  /** The next frame, or null while more bytes are needed. */
  const next = () => {
    while (held.length >= form.shortest) {
      const frame = form.decodeAt(held, 0, aligned)
      if (frame) {
        held = held.subarray(frame.bytes.length)
        aligned = true
        return frame
      }
      const whole = held.length >= form.lengthAt(held, 0)
      damaged = damaged || whole
      const at = whole ? 1 : hidden(held, form)
      if (at === 0) return null
      forget(at)
    }
    return null
  }
  return (bytes, { start, end }) => {
    if (start - heardUntil > gap) {
      forget(held.length)
      aligned = true
    }
    heardUntil = end
    held = held.length === 0 ? bytes : Buffer.concat([held, bytes])
    damaged = false
    const frames = []
    for (let frame = next(); frame; frame = next()) frames.push(frame)
    if (damaged) counts.badCrc++
    return frames
  }
}

/** Where a complete frame for this station stands inside what looks like a longer one; 0: nowhere. */
function hidden(held, { shortest, isMine, decodeAt }) {
  for (let at = 1; at <= held.length - shortest; at++) {
    if (isMine(held[at]) && decodeAt(held, at, false)) return at
  }
  return 0
}

module.exports = { createReceiver }
