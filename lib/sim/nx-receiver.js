'use strict'

const { decodeFrame, frameLength, SHORTEST } = require('../codec/nx/frame')

/**
 * The receiver of an NX station: takes bytes in any pieces and finds the frames. A silence ends a half-received frame; a
 * frame with a wrong CRC is not answered: the search goes on one byte later, so noise before a query costs nothing, also where
 * it looks like the head of a longer frame.
 *
 * @param {{ gap: number, isMine: (to: number) => boolean, counts: { badCrc: number, strayBytes: number } }} options gap: ms of silence
 * @returns {(bytes: Buffer, times: { start: number, end: number }) => Received[]} complete frames, whoever they are for; `start` and
 *   `end` are when the bytes were on the wire, in ms
 */
function createReceiver({ gap, isMine, counts }) {
  /** @type {Buffer} */
  let held = Buffer.alloc(0)
  let heardUntil = -Infinity

  const forget = count => {
    counts.strayBytes += count
    held = held.subarray(count)
  }
  return (bytes, { start, end }) => {
    if (start - heardUntil > gap) forget(held.length)
    heardUntil = end
    held = held.length === 0 ? bytes : Buffer.concat([held, bytes])
    const frames = []
    let damaged = false
    while (held.length >= SHORTEST) {
      const length = frameLength(held)
      const frame = decodeFrame(held)
      if (frame) {
        frames.push({ ...frame, bytes: held.subarray(0, length) })
        held = held.subarray(length)
      } else if (held.length >= length) {
        damaged = true
        forget(1)
      } else {
        const at = hidden(held, isMine)
        if (at === 0) break
        forget(at)
      }
    }
    if (damaged) counts.badCrc++
    return frames
  }
}

/** Where a complete frame for this station stands inside what looks like a longer one; 0: nowhere. */
function hidden(held, isMine) {
  for (let at = 1; at <= held.length - SHORTEST; at++) {
    if (isMine(held[at]) && held.length - at >= frameLength(held, at) && decodeFrame(held, at)) return at
  }
  return 0
}

/** @typedef {import('../codec/nx/frame').Frame & { bytes: Buffer }} Received `bytes`: the whole frame */

module.exports = { createReceiver }
