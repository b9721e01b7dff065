'use strict'
const lib = /** @type {any} */ (require('../lib/index.js'))

/** What the library makes of the settings of a node that listens: its options are called as the properties are. */

const CREATE = {
  'melsec-c24': options => lib.createC24Port(options),
  'incon-link': options => lib.createInconLink(options)
}

// the node's own, not the port's
const OWN = ['line', 'access', 'onFailure', 'acceptRetained']

const portSettings = settings => Object.fromEntries(Object.entries(settings).filter(([name]) => !OWN.includes(name)))

/**
 * Whether one port serves both.
 * @param {{ label: string, settings: Record<string, any> }} one
 * @param {{ label: string, settings: Record<string, any> }} other
 */
const isSamePort = (one, other) =>
  one.label === other.label &&
  JSON.stringify(portSettings(one.settings)) === JSON.stringify(portSettings(other.settings))

/**
 * @param {string} type
 * @param {Record<string, any>} settings of the node
 * @param {{ lease: any, name: string }} more
 * @throws {import('../lib/index.js').PlcError} BAD_SETTING, LINE_USE
 */
const createPort = (type, settings, more) => CREATE[type]({ ...portSettings(settings), ...more })

module.exports = { createPort, isSamePort }
