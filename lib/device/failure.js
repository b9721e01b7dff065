'use strict'
const { PlcError, isRefusal } = require('../error')

/** What an error says about a station. Pure. */

/** A gateway's word, not the station's: nobody behind it answers, whatever the address. */
const GATEWAY = new Set(['MODBUS_GATEWAY_PATH', 'MODBUS_GATEWAY_TARGET'])

/** Errors that say nothing about the address asked for, but about station or line. @param {any} error */
const isStationFailure = error => !isRefusal(error) || GATEWAY.has(error.code)

/** @param {any} error @param {number} [station] @returns {PlcError} */
const asPlcError = (error, station) =>
  error instanceof PlcError ? error : new PlcError('BAD_ANSWER', { station, reason: error?.message, cause: error })

module.exports = { asPlcError, isStationFailure }
