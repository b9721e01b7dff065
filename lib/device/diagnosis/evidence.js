'use strict'
const { findFrames } = require('./frames')

const EMPTY = Buffer.alloc(0)
/** More than this of a flood says nothing more. */
const MOST_BYTES = 2000

/**
 * What was seen on the wire while a station was asked.
 * @typedef {object} Evidence
 * @property {Buffer} sent the last query
 * @property {Buffer[]} queries all of them, also those of others who ask this station on the same line
 * @property {Buffer} received all that came and is not our own echo
 * @property {Buffer} stray what of it was no answer
 * @property {import('./frames').Found[]} frames in `stray`, and the answers of the station to others who ask it by another protocol or mode
 * @property {boolean} echo our own query came back
 * @property {number} answers of the station, whoever asked by this protocol and mode
 * @property {number} sentAt when the last query went out, epoch ms; 0: nothing was sent
 * @property {number} ms from the last query out to the last frame in
 */

/** All places of `part` taken out of `bytes`. @returns {{ rest: Buffer, found: number }} */
function without(bytes, part) {
  let rest = bytes
  let found = 0
  for (let at = rest.indexOf(part); part.length > 0 && at >= 0; at = rest.indexOf(part)) {
    rest = Buffer.concat([rest.subarray(0, at), rest.subarray(at + part.length)])
    found++
  }
  return { rest, found }
}

const bytesOf = row => Buffer.from(row.bytes, 'hex')
const joined = rows => Buffer.concat(rows.map(bytesOf)).subarray(0, MOST_BYTES)
const isIn = ({ dir }) => dir === 'in'

/** Frames of a row that are of another protocol, or mode; none where one is of this. */
function otherIn(row, expected) {
  const frames = findFrames(bytesOf(row), expected)
  return frames.some(({ protocol }) => protocol === expected) ? [] : frames
}

/** Rows from a time on that belong to a station: what came while another one was asked is that one's. */
function rowsOf(rows, station, since) {
  let mine = false
  return rows.filter(row => {
    if (row.t < since) return false
    if (row.dir === 'out') mine = row.station === station
    return mine || row.station === station
  })
}

/**
 * @param {{ t: number, dir: string, station: any, bytes: string, note: string }[]} trace `line.trace()`
 * @param {{ station: any, since: number, expected: 'nx'|'rtu'|'ascii' }} options since: epoch ms
 * @returns {Evidence}
 */
function evidenceOf(trace, { station, since, expected }) {
  const rows = rowsOf(trace, station, since)
  // a configuration that polls the same station may speak otherwise than the one that is tested
  const out = rows.filter(row => !isIn(row) && otherIn(row, expected).length === 0)
  const heard = rows.filter(row => isIn(row) && row.note !== 'echo')
  const answers = heard.filter(({ note }) => note === '')
  const others = answers.map(row => otherIn(row, expected)).filter(frames => frames.length > 0)
  const sent = out.length > 0 ? bytesOf(out[out.length - 1]) : EMPTY
  // where the line was told that there is no echo, it comes as bytes of nobody
  const { rest: stray, found } = without(joined(heard.filter(({ note }) => note !== '')), sent)
  const sentAt = out.length > 0 ? out[out.length - 1].t : 0
  const lastIn = rows.findLast(row => isIn(row) && row.station === station)?.t ?? 0
  return {
    sent,
    stray,
    sentAt,
    queries: out.map(bytesOf),
    received: without(joined(heard), sent).rest,
    frames: [...findFrames(stray, expected), ...others.flat()],
    echo: found > 0 || rows.some(({ note }) => note === 'echo'),
    answers: answers.length - others.length,
    ms: Math.max(0, Math.round(lastIn - sentAt))
  }
}

module.exports = { evidenceOf }
