'use strict'
const { PlcError } = require('../lib/index.js')
const { PROPERTIES, readProperty, allowed, applies } = require('./properties')

const REASONS = {
  missing: () => 'it is needed',
  number: row => `a number is needed, ${allowed(row)}`,
  whole: row => `a whole number is needed, ${allowed(row)}`,
  range: row => `allowed is ${allowed(row)}`,
  except: row => `allowed is ${allowed(row)}`,
  choice: row => `known are ${allowed(row)}`,
  flag: () => 'true or false is needed',
  list: () => 'a list is needed',
  bytes: row => `allowed is ${allowed(row)}, as 0D 0A`
}

const shown = value => (value === undefined || value === null || value === '' ? 'empty' : value)

/** @param {import('./properties').Row} row @param {string} name @param {{ value: any, reason: string }} what */
const refusal = ({ isStation }, name, { value, reason }) =>
  isStation
    ? new PlcError('BAD_STATION', { station: value, reason })
    : new PlcError('BAD_SETTING', { setting: name, value, reason })

const readOne = (type, name, config) => {
  const row = PROPERTIES[type][name]
  const { value, problem, variable } = readProperty(row, config[name])
  if (!applies(type, name, config)) return problem || variable ? row.fallback : value
  if (variable) throw new PlcError('ENV_MISSING', { variable, setting: name })
  if (problem === 'missing' && row.kind === 'node') {
    throw new PlcError('NO_CONFIGURATION', { node: config.name || type, what: name })
  }
  if (problem) throw refusal(row, name, { value: shown(config[name]), reason: REASONS[problem](row) })
  return value
}

/**
 * A node's configuration with all defaults, numbers as numbers.
 * @param {string} type the node's type
 * @param {Record<string, any>} config as Node-RED hands it to the constructor
 * @returns {Record<string, any>}
 * @throws {PlcError} ENV_MISSING, BAD_SETTING, NO_CONFIGURATION
 */
const readSettings = (type, config) =>
  Object.fromEntries(Object.keys(PROPERTIES[type]).map(name => [name, readOne(type, name, config)]))

module.exports = { readSettings }
