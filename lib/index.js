'use strict'

/** The public door: everything that nodes and programs use. No logic here. */

const { CODES, PlcError } = require('./error')
const { fromBufferMemory, toBufferMemory } = require('./codec/melsec/buffer-memory')
const { areaMap } = require('./codec/nx/areas')
const { describeAddress, formatAddress, parseAddress } = require('./codec/nx/address')
const { PRIORITY, createPool, lineSettings, listPorts } = require('./line')
const { createC24Port } = require('./device/c24-port')
const { createChinoRegulator } = require('./device/chino-regulator')
const { diagnose } = require('./device/diagnose')
const { createInconLink } = require('./device/incon-link')
const { mixedConflict } = require('./device/mixed')
const { createNxPlc } = require('./device/nx-plc')
const { openChinoRegulator, openNxPlc } = require('./device/open')
const { openC24Port } = require('./device/open-c24')
const { openInconLink } = require('./device/open-incon')
const { predict } = require('./device/predict')
const { masterIdsOf } = require('./device/settings')
const { createThrottle } = require('./device/throttle')
const { csvWarnings, tagsFromCsv, tagsToCsv } = require('./tag/csv')
const { parseItem } = require('./tag/item')
const { modbusNotation } = require('./tag/modbus-notation')
const { nxNotation } = require('./tag/nx-notation')
const { parseType } = require('./tag/types')
const { createReport } = require('./output/report')
const { entriesOf, itemsOf, payloadOf } = require('./output/entries')
const { messagesOf } = require('./output/messages')

module.exports = {
  CODES,
  PRIORITY,
  PlcError,
  areaMap,
  createC24Port,
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
  fromBufferMemory,
  itemsOf,
  lineSettings,
  listPorts,
  masterIdsOf,
  messagesOf,
  mixedConflict,
  modbusNotation,
  nxNotation,
  openC24Port,
  openChinoRegulator,
  openInconLink,
  openNxPlc,
  parseAddress,
  parseItem,
  parseType,
  payloadOf,
  predict,
  tagsFromCsv,
  tagsToCsv,
  toBufferMemory
}
