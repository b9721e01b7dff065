'use strict'

const { decodeFrame, frameLength, SHORTEST } = require('../codec/nx/frame')
const { createReceiver } = require('./receiver')

/**
 * The receiver of an NX station (receiver.js); a frame's length stands in its head.
 * @param {{ gap: number, isMine: (to: number) => boolean, counts: { badCrc: number, strayBytes: number } }} options gap: ms of silence
 * @returns {(bytes: Buffer, times: { start: number, end: number }) => Received[]}
 */
function createNxReceiver(options) {
  return createReceiver({ ...options, shortest: SHORTEST, lengthAt: frameLength, decodeAt })
}

function decodeAt(held, at) {
  const frame = decodeFrame(held, at)
  return frame && { ...frame, bytes: held.subarray(at, at + frame.length) }
}

/** @typedef {import('../codec/nx/frame').Frame & { bytes: Buffer }} Received `bytes`: the whole frame */

module.exports = { createNxReceiver }
