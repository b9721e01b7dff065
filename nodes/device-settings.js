'use strict'
const lib = require('../lib/index.js')
const { readSettings } = require('./settings')

const LIMITS = ['readWords', 'writeWords', 'readBits', 'writeBits']

/** What `createNxPlc` gets of the configuration of a PLC. */
const nxSettings = (settings, { name, stations, gap }) => ({
  name,
  station: settings.station,
  steps: Number(settings.steps),
  timeout: settings.timeout,
  attempts: settings.attempts,
  demoteAfter: settings.demoteAfter,
  probeFirst: settings.probeFirst,
  probeMost: settings.probeMost,
  // the line keeps its own gap to the fraction; here it only takes the place of the protocol's
  gap: gap > 0 ? Math.max(1, Math.floor(gap)) : 0,
  masterIds: settings.masterIds,
  soleMaster: settings.soleMaster,
  areas: settings.areas,
  tags: settings.tags,
  access: settings.access,
  writableRanges: settings.writableRanges,
  writeInterval: settings.writeInterval,
  limits: Object.fromEntries(LIMITS.map(limit => [limit, settings[limit]])),
  stations
})

/** What `createChinoRegulator` gets: its options are called as the properties are. */
const chinoSettings = ({ line: _line, ...settings }, { name }) => ({ ...settings, name })

/**
 * The kinds of devices, by the type of their config node. `notation`: how one row of a tag table is read.
 * @type {Record<string, { protocol: 'nx'|'modbus', title: string, settings: Function, create: Function, notation: Function }>}
 */
const DEVICES = {
  'nx-config': {
    protocol: 'nx',
    title: 'NX PLC',
    settings: nxSettings,
    create: options => lib.createNxPlc(options),
    notation: ({ areas }, tags) => lib.nxNotation({ areas, tags })
  },
  'chino-config': {
    protocol: 'modbus',
    title: 'CHINO',
    settings: chinoSettings,
    create: options => lib.createChinoRegulator(options),
    notation: ({ addressMode }, tags) => lib.modbusNotation({ addressMode, tags })
  }
}

/** @param {{ type?: string }} settings */
const kindOf = ({ type = 'nx-config' }) => DEVICES[type]

/**
 * The settings of a device's config node, with its type.
 * @param {string} type
 * @param {Record<string, any>} config as Node-RED hands it to the constructor
 * @returns {Record<string, any>}
 * @throws {import('../lib/index.js').PlcError} ENV_MISSING, BAD_SETTING, BAD_STATION, NO_CONFIGURATION
 */
const readDevice = (type, config) => ({ type, ...readSettings(type, config) })

/**
 * What the library gets of the configuration of a device.
 * @param {Record<string, any>} settings of {@link readDevice}
 * @param {{ name: string, stations: number[], gap?: number }} more `stations`: all that are configured on the line; `gap`: of the
 *   line, in ms; 0: what the protocol asks for
 * @returns {any}
 */
const deviceSettings = ({ type, ...settings }, { name, stations, gap = 0 }) => ({
  ...kindOf({ type }).settings(settings, { name, stations, gap }),
  type
})

/** The rows of a tag table that can be used. */
const usableTags = (notation, settings) => {
  const names = new Set()
  return settings.tags.filter(row => {
    try {
      const [name] = [...(notation(settings, [row]).tags ?? [])].map(([key]) => key)
      return !names.has(name) && names.add(name)
    } catch {
      return false
    }
  })
}

/**
 * The device; a faulty row of the tag table does not stop the others: the device is read without it. It is not written then, since the row may hold
 * limits that somebody relies on.
 * @param {any} lease
 * @param {any} settings of {@link deviceSettings}
 * @returns {{ device: any, tagFault: any }}
 */
const createDevice = (lease, { type, ...options }) => {
  const { create, notation } = kindOf({ type })
  try {
    return { device: create({ lease, ...options }), tagFault: null }
  } catch (/** @type {any} */ error) {
    if (error.code !== 'BAD_TAG') throw error
    const tags = usableTags(notation, options)
    return { device: create({ lease, ...options, tags, access: 'read' }), tagFault: error }
  }
}

module.exports = { createDevice, deviceSettings, kindOf, readDevice }
