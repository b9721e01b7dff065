'use strict'
const { PlcError } = require('../../error')

/**
 * What a station says instead of an answer; "MODBUS application protocol" 7, panel manual appendix A. No Buffer.
 * @typedef {object} ExceptionRow
 * @property {number} number
 * @property {keyof typeof import('../../error').CODES} code
 * @property {string} words as the protocol calls it
 * @property {boolean} again whether a read may be asked again
 * @property {'refused'|'unknown'} write what it means for a write: 04 may come in the middle of it, 05 may still become done, behind 0B it may have been done
 */

/** @type {readonly ExceptionRow[]} */
const EXCEPTIONS = Object.freeze(
  /** @type {[number, keyof typeof import('../../error').CODES, string, boolean, 'refused'|'unknown'][]} */
  ([
    [0x01, 'MODBUS_ILLEGAL_FUNCTION', 'illegal function', false, 'refused'],
    [0x02, 'MODBUS_ILLEGAL_ADDRESS', 'illegal data address', false, 'refused'],
    [0x03, 'MODBUS_ILLEGAL_VALUE', 'illegal data value', false, 'refused'],
    [0x04, 'MODBUS_DEVICE_FAILURE', 'slave device failure', false, 'unknown'],
    [0x05, 'MODBUS_ACKNOWLEDGE', 'acknowledge', true, 'unknown'],
    [0x06, 'MODBUS_BUSY', 'slave device busy', true, 'refused'],
    [0x07, 'MODBUS_NEGATIVE_ACKNOWLEDGE', 'negative acknowledge', false, 'refused'],
    [0x08, 'MODBUS_MEMORY_PARITY', 'memory parity error', false, 'refused'],
    [0x0a, 'MODBUS_GATEWAY_PATH', 'gateway path unavailable', false, 'refused'],
    [0x0b, 'MODBUS_GATEWAY_TARGET', 'gateway target device failed to respond', false, 'unknown']
  ]).map(([number, code, words, again, write]) => Object.freeze({ number, code, words, again, write }))
)

const byNumber = new Map(EXCEPTIONS.map(row => [row.number, row]))
const byCode = new Map(EXCEPTIONS.map(row => [String(row.code), row]))

/**
 * The row of an exception; of numbers that the protocol does not name nobody knows whether the device did it.
 * @param {number} number 0..255
 * @returns {ExceptionRow}
 */
const exceptionOf = number =>
  byNumber.get(number) ?? {
    number,
    code: 'MODBUS_EXCEPTION',
    words: 'not named by the protocol',
    again: false,
    write: 'unknown'
  }

/**
 * The row behind an error's code.
 * @param {unknown} code
 * @returns {ExceptionRow | undefined} undefined: no exception of a station
 */
const exceptionByCode = code => (code === 'MODBUS_EXCEPTION' ? exceptionOf(-1) : byCode.get(String(code)))

/**
 * The error for an exception.
 * @param {number} number 0..255
 * @param {{ station: number, fn: number, address: string }} facts `address`: what was asked for, in words
 * @returns {PlcError} its `details.exception` is the number in hex
 */
const exceptionError = (number, { station, fn, address }) =>
  new PlcError(exceptionOf(number).code, { station, exception: hex(number), function: hex(fn), address })

const hex = value => value.toString(16).toUpperCase().padStart(2, '0')

module.exports = { EXCEPTIONS, exceptionByCode, exceptionError, exceptionOf }
