'use strict'
const ModbusRTU = /** @type {any} */ (require('modbus-serial'))
const { PlcError } = require('../error')
const { describeQuery, expectedAnswer } = require('../codec/modbus/answer')
const { exceptionError } = require('../codec/modbus/exceptions')
const { functionOf } = require('../codec/modbus/functions')
const { check, countOf } = require('../codec/modbus/query')

/**
 * One exchange by modbus-serial: it builds the request's bytes and reads the answer's. It never sees a line: its port is an object that
 * keeps what is written, and each exchange has a client of its own, so that no answer can meet another's request. No timer is ever started,
 * since no timeout is set; nothing listens to it afterwards.
 *
 * @typedef {import('../codec/modbus/query').Query} Query
 */

/**
 * The callback form of each function: the client, the request, the station, the callback.
 * @type {Record<number, (client: any, query: any, station: number, done: (error: any, result: any) => void) => void>}
 */
const CALLS = Object.freeze({
  1: (client, { base, count }, station, done) => client.writeFC1(station, base, count, done),
  2: (client, { base, count }, station, done) => client.writeFC2(station, base, count, done),
  3: (client, { base, count }, station, done) => client.writeFC3(station, base, count, done),
  4: (client, { base, count }, station, done) => client.writeFC4(station, base, count, done),
  5: (client, { base, value }, station, done) => client.writeFC5(station, base, value, done),
  6: (client, { base, value }, station, done) => client.writeFC6(station, base, value, done),
  15: (client, { base, values }, station, done) => client.writeFC15(station, base, values, done),
  16: (client, { base, values }, station, done) => client.writeFC16(station, base, values, done)
})

/** A port that is always open and keeps what is written to it. */
const createPort = () => {
  const port = {
    isOpen: true,
    sent: Buffer.alloc(0),
    /** @type {(frame: Buffer) => void} */
    receive: () => {},
    open: done => done(null),
    on: (event, listener) => {
      if (event === 'data') port.receive = listener
      return port
    },
    once: () => port,
    removeListener: () => port,
    write: bytes => void (port.sent = Buffer.from(bytes))
  }
  return port
}

/**
 * @param {Query} query
 * @param {number} station 1..247; 0: broadcast, writes only
 * @param {{ name?: (query: Query) => string }} [options] how errors call the addresses of the request
 * @returns {{ send: Buffer, read: (frame: Buffer) => any, kept?: object }} `send`: RTU frame; `read`: RTU frame -> the values that were asked for, true for a
 *   write. Throws MODBUS_… for an exception, CRC_ERROR, BAD_ANSWER
 * @throws {PlcError} FUNCTION_REFUSED, BAD_COUNT, BAD_ADDRESS, BAD_VALUE
 */
const exchange = (query, station, { name = describeQuery } = {}) => {
  check(query)
  const port = createPort()
  const client = new ModbusRTU(port)
  client.open(() => {})
  /** @type {{ error?: any, result?: any } | null} */
  let end = null
  // it looks at station, function, length and checksum, but neither at the byte count nor at what a write echoes
  const { header } = expectedAnswer(query, station)
  CALLS[query.fn](client, query, station, (error, result) => (end = { error, result }))
  return {
    send: port.sent,
    read: frame => {
      end = null
      port.receive(Buffer.from(frame))
      return valuesOf(/** @type {any} */ (end), { query, station, frame, name, header })
    }
  }
}

const valuesOf = (end, { query, station, frame, name, header }) => {
  if (!end) throw new PlcError('BAD_ANSWER', { station, reason: 'modbus-serial makes nothing of it' })
  const { error, result } = end
  if (error) throw meaning(error, { query, station, frame, name })
  if (header.compare(frame, 0, header.length) !== 0) {
    const reason = `${frame.toString('hex')} does not answer ${describeQuery(query)}`
    throw new PlcError('BAD_ANSWER', { station, reason })
  }
  return functionOf(query.fn).reads ? result.data.slice(0, countOf(query)) : true
}

const meaning = (error, { query, station, frame, name }) => {
  if (typeof error.modbusCode === 'number' && frame[0] === station) {
    return exceptionError(error.modbusCode, { station, fn: query.fn, address: name(query) })
  }
  if (error.message === 'CRC error') return new PlcError('CRC_ERROR', { station, got: frame.toString('hex') })
  return new PlcError('BAD_ANSWER', { station, reason: String(error.message), cause: error })
}

/** @type {WeakMap<Query, { station: number, made: ReturnType<typeof exchange> }>} */
const kept = new WeakMap()

/**
 * As {@link exchange}. A read that is polled asks the same again and again: while its query is the same object, which nobody may change then, it
 * keeps its client, which knows no other one.
 * @param {Query} query
 * @param {number} station
 */
const exchangeOf = (query, station) => {
  if (!functionOf(query.fn)?.reads) return exchange(query, station)
  const known = kept.get(query)
  if (known?.station === station) return known.made
  const made = { ...exchange(query, station), kept: {} }
  kept.set(query, { station, made })
  return made
}

module.exports = { exchange, exchangeOf }
