'use strict'

/** What one frame of an NX PLC takes: docs/nx.md, "What is supported". */
const LIMITS = {
  readBits: 255,
  readWords: 128,
  readMixed: 128,
  writeBits: 254,
  writeWords: 64,
  writeMixed: 85,
  info: 256
}

module.exports = { LIMITS }
