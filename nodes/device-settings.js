'use strict'
const { createNxPlc, nxNotation } = require('../lib/index.js')

const LIMITS = ['readWords', 'writeWords', 'readBits', 'writeBits']

/**
 * What `createNxPlc` gets of the configuration of a PLC.
 * @param {Record<string, any>} settings of nx-config
 * @param {{ name: string, stations: number[], gap?: number }} more `stations`: all that are configured on the line; `gap`: of the
 *   line, in ms; 0: what the protocol asks for
 * @returns {any}
 */
const deviceSettings = (settings, { name, stations, gap = 0 }) => ({
  name,
  station: settings.station,
  steps: Number(settings.steps),
  timeout: settings.timeout,
  attempts: settings.attempts,
  // the line keeps its own gap to the fraction; here it only takes the place of the protocol's
  gap: gap > 0 ? Math.max(1, Math.floor(gap)) : 0,
  masterIds: settings.masterIds,
  soleMaster: settings.soleMaster,
  areas: settings.areas,
  tags: settings.tags,
  access: settings.access,
  writableRanges: settings.writableRanges,
  limits: Object.fromEntries(LIMITS.map(limit => [limit, settings[limit]])),
  stations
})

/** The rows of a tag table that can be used. */
const usableTags = (areas, tags) => {
  const names = new Set()
  return tags.filter(row => {
    try {
      const [name] = [...(nxNotation({ areas, tags: [row] }).tags ?? [])].map(([key]) => key)
      return !names.has(name) && names.add(name)
    } catch {
      return false
    }
  })
}

/**
 * The device; a faulty row of the tag table does not stop the others: the PLC is read without it. It is not written then, since the row may hold
 * limits that somebody relies on.
 * @param {any} lease
 * @param {any} settings of {@link deviceSettings}
 * @returns {{ device: any, tagFault: any }}
 */
const createDevice = (lease, settings) => {
  try {
    return { device: createNxPlc({ lease, ...settings }), tagFault: null }
  } catch (/** @type {any} */ error) {
    if (error.code !== 'BAD_TAG') throw error
    const tags = usableTags(settings.areas, settings.tags)
    return { device: createNxPlc({ lease, ...settings, tags, access: 'read' }), tagFault: error }
  }
}

module.exports = { createDevice, deviceSettings }
