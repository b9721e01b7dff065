'use strict'
const { PlcError, isPlcError, isRefusal, reasonOf } = require('../error')

/** What an error says about a station. Pure. */

/** A gateway's word, not the station's: nobody behind it answers, whatever the address. */
const GATEWAY = new Set(['MODBUS_GATEWAY_PATH', 'MODBUS_GATEWAY_TARGET'])

/** Errors that say nothing about the address asked for, but about station or line. @param {any} error */
const isStationFailure = error => !isRefusal(error) || GATEWAY.has(error.code)

/** @param {any} error @param {number} [station] @returns {PlcError} */
const asPlcError = (error, station) =>
  isPlcError(error) ? error : new PlcError('BAD_ANSWER', { station, reason: reasonOf(error), cause: error })

/**
 * An error that came while what a user or a message gave was looked at: nothing was sent, so no station had a word in it.
 * @param {any} error @returns {PlcError}
 */
const asGivenError = error => {
  if (isPlcError(error)) return error
  const reason = `it cannot be looked at: ${reasonOf(error)}`
  return new PlcError('BAD_VALUE', { item: 'what is written', value: 'what was given', reason })
}

module.exports = { asGivenError, asPlcError, isStationFailure }
