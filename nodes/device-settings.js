'use strict'

const LIMITS = ['readWords', 'writeWords', 'readBits', 'writeBits']

/**
 * What `createNxPlc` gets of the configuration of a PLC.
 * @param {{ settings: Record<string, any>, label: string, lineNode: any }} plc the config node
 */
const deviceSettings = ({ settings, label, lineNode }) => ({
  name: label,
  station: settings.station,
  steps: Number(settings.steps),
  timeout: settings.timeout,
  attempts: settings.attempts,
  masterIds: settings.masterIds,
  soleMaster: settings.soleMaster,
  areas: settings.areas,
  tags: settings.tags,
  access: settings.access,
  writableRanges: settings.writableRanges,
  limits: Object.fromEntries(LIMITS.map(name => [name, settings[name]])),
  stations: lineNode ? lineNode.plcs.stations() : []
})

module.exports = { deviceSettings }
