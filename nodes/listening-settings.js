'use strict'
const lib = /** @type {any} */ (require('../lib/index.js'))

/** What the library makes of the settings of a node that listens: its options are called as the properties are. */

const CREATE = {
  'melsec-c24': options => lib.createC24Port(options),
  'incon-link': options => lib.createInconLink(options)
}

// the node's own, not the port's
const OWN = ['line', 'access', 'onFailure', 'acceptRetained']

/**
 * @param {string} type
 * @param {Record<string, any>} settings of the node
 * @param {{ lease: any, name: string }} more
 * @throws {import('../lib/index.js').PlcError} BAD_SETTING, LINE_USE
 */
const createPort = (type, settings, more) => {
  const options = Object.fromEntries(Object.entries(settings).filter(([name]) => !OWN.includes(name)))
  return CREATE[type]({ ...options, ...more })
}

module.exports = { createPort }
