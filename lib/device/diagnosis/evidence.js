'use strict'
const { findFrames } = require('./frames')

const EMPTY = Buffer.alloc(0)

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

/**
 * What was seen on the wire while a station was asked: out of the trace of the line. What came while another station was asked is that one's.
 *
 * @param {{ t: number, dir: string, station: any, bytes: string, note: string }[]} rows of `line.trace()`
 * @param {{ station: any, since: number, expected: 'nx'|'rtu'|'ascii' }} options since: epoch ms
 * @returns {{ sent: Buffer, seen: Buffer, echo: boolean, frames: import('./frames').Found[], sentAt: number, ms: number }}
 *   sent: the last query, sentAt: when (epoch ms; 0: nothing was sent); seen: all that came and is not our own echo; ms: from the last query out to the last frame in
 */
function evidenceOf(rows, { station, since, expected }) {
  let mine = false
  let sent = EMPTY
  let echo = false
  const times = { out: 0, in: 0 }
  const pieces = []
  for (const row of rows.filter(({ t }) => t >= since)) {
    if (row.dir === 'out') mine = row.station === station
    if (!mine && row.station !== station) continue
    if (row.dir === 'out') sent = Buffer.from(row.bytes, 'hex')
    if (row.station === station) times[row.dir] = row.t
    if (row.dir === 'out') continue
    if (row.note === 'echo') echo = true
    else pieces.push(Buffer.from(row.bytes, 'hex'))
  }
  // where the line was told that there is no echo, it comes as bytes of nobody
  const { rest, found } = without(Buffer.concat(pieces), sent)
  return {
    sent,
    seen: rest,
    echo: echo || found > 0,
    frames: findFrames(rest, expected),
    sentAt: times.out,
    ms: Math.max(0, Math.round(times.in - times.out))
  }
}

module.exports = { evidenceOf }
