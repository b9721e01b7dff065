'use strict'

/** The public door: everything that nodes and programs use. No logic here. */

const { CODES, PlcError } = require('./error')
const { areaMap } = require('./codec/nx/areas')
const { describeAddress, formatAddress, parseAddress } = require('./codec/nx/address')
const { PRIORITY, createPool, lineSettings, listPorts } = require('./line')
const { createChinoRegulator } = require('./device/chino-regulator')
const { diagnose } = require('./device/diagnose')
const { createInconLink, openInconLink } = require('./device/incon-link')
const { mixedConflict } = require('./device/mixed')
const { createNxPlc } = require('./device/nx-plc')
const { openChinoRegulator, openNxPlc } = require('./device/open')
const { masterIdsOf } = require('./device/settings')
const { createThrottle } = require('./device/throttle')
const { csvWarnings, tagsFromCsv, tagsToCsv } = require('./tag/csv')
const { parseItem } = require('./tag/item')
const { modbusNotation } = require('./tag/modbus-notation')
const { nxNotation } = require('./tag/nx-notation')
const { parseType } = require('./tag/types')
const { createReport } = require('./output/report')
const { entriesOf, itemsOf } = require('./output/entries')
const { messagesOf } = require('./output/messages')

module.exports = {
  CODES,
  PRIORITY,
  PlcError,
  areaMap,
  createChinoRegulator,
  createInconLink,
  createNxPlc,
  createPool,
  createReport,
  createThrottle,
  csvWarnings,
  describeAddress,
  diagnose,
  entriesOf,
  formatAddress,
  itemsOf,
  lineSettings,
  listPorts,
  masterIdsOf,
  messagesOf,
  mixedConflict,
  modbusNotation,
  nxNotation,
  openChinoRegulator,
  openInconLink,
  openNxPlc,
  parseAddress,
  parseItem,
  parseType,
  tagsFromCsv,
  tagsToCsv
}
