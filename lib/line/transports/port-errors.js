'use strict'

const { PlcError } = require('../../error')

/** What the bindings of the operating systems say, and what it means. The first that matches counts. */
/** @type {[RegExp, 'PORT_BUSY'|'PORT_DENIED'|'PORT_NOT_FOUND'][]} */
const MEANINGS = [
  [/cannot lock port|resource busy|device or resource busy|EBUSY|temporarily unavailable/i, 'PORT_BUSY'],
  // Windows says so when another program has the port
  [/access(?: is)? denied/i, 'PORT_BUSY'],
  [/permission denied|EACCES|EPERM|operation not permitted/i, 'PORT_DENIED'],
  [/no such file|file not found|ENOENT|cannot find the file|no such device|ENXIO|ENODEV/i, 'PORT_NOT_FOUND']
]

/**
 * Why a port could not be opened.
 * @param {any} error of the binding @param {string} path
 */
function openError(error, path) {
  if (error instanceof PlcError) return error
  const reason = String(error?.message ?? error)
  const found = MEANINGS.find(([pattern]) => pattern.test(reason))
  return new PlcError(found ? found[1] : 'PORT_ERROR', { path, reason, cause: error })
}

/** A port that was open is lost. @param {any} error @param {string} path */
const goneError = (error, path) =>
  error instanceof PlcError ? error : new PlcError('PORT_GONE', { path, reason: error?.message ?? '', cause: error })

module.exports = { goneError, openError }
