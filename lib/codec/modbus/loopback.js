'use strict'
const { fromAscii, toAscii } = require('./ascii')
const { EXCEPTION_LENGTH } = require('./answer')
const { EXCEPTION, LOOPBACK } = require('./functions')
const { frameTo } = require('./match')
const { closed, crcFits } = require('./query')

/**
 * Function 08, sub-function 0000: the station sends back what it was sent ("MODBUS application protocol" 6.8). With a number that was not used lately the
 * answer proves that the station has heard this very query: it answers in order, so nothing older can come any more.
 */

const LENGTH = 8

const bodyOf = (station, data) => Buffer.from([station, LOOPBACK, 0, 0, data >> 8, data & 0xff])

/**
 * @param {number} data 0..65535
 * @param {{ station: number, protocol?: 'rtu'|'ascii' }} options station: 1..247
 * @returns {{ send: Buffer, match: (bytes: Uint8Array) => import('./match').Verdict, proves: (answer: Buffer) => boolean,
 *   exception: (answer: Buffer) => number }} as they go over the wire. `proves`: it is this query's own answer; `exception`: the number of the one that
 *   came instead, or 0. An exception bears no number of ours: it may answer an older query
 */
function loopback(data, { station, protocol = 'rtu' }) {
  const rtu = closed(bodyOf(station, data))
  const ascii = protocol === 'ascii'
  const send = ascii ? toAscii(rtu) : rtu
  const expected = { length: LENGTH, header: rtu.subarray(0, LENGTH - 2) }
  return {
    send,
    match: frameTo(expected, { station, fn: LOOPBACK, protocol, sent: send }),
    proves: answer => Buffer.compare(answer, send) === 0,
    exception: answer => exceptionIn(ascii ? fromAscii(answer) : answer, station)
  }
}

function exceptionIn(frame, station) {
  const is = frame?.length === EXCEPTION_LENGTH && frame[0] === station && frame[1] === (LOOPBACK | EXCEPTION)
  return is && crcFits(frame, 0, EXCEPTION_LENGTH) ? frame[2] : 0
}

module.exports = { loopback }
