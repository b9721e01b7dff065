'use strict'
const { PROPERTIES, readProperty, allowed, applies } = require('../../nodes/properties')
const { lineOfListener, listenerOf } = require('./line-use')
const { t, errorText } = require('./texts')
const { truthy } = require('./widgets')
const { readRanges } = require('../../lib/device/options')
const { mixedConflict } = require('../../lib/device/mixed')
const { masterIdsOf, readSettings } = require('../../lib/device/settings')
const { readTags } = require('../../lib/tag/tags')
const { TYPES, attempt, canOnlyBeRead, deviceName, notationOf, notationWithTags, parseItem } = require('./model')

/** Validators of the dialogs: they answer true, or the reason as a text. */

// the node whose dialog is open: its validators look at the fields, all others at what is saved
const edited = { id: null, prefix: 'node-input-' }

const open = (node, prefix) => Object.assign(edited, { id: node.id, prefix })
const done = () => {
  edited.id = null
}

/** A property as it stands in the open dialog, or as it was saved. */
const current = (node, name) => {
  const field = edited.id === node.id ? $(`#${edited.prefix}${name}`) : $()
  if (field.length === 0) return node[name]
  return field.is(':checkbox') ? field.prop('checked') : field.val()
}

const view = node => new Proxy({}, { get: (_, name) => current(node, String(name)) })

const isVariable = value => typeof value === 'string' && /^\s*\$\{[^}]+\}\s*$/.test(value)

/** Other devices on the line of a device. */
const neighbours = node => {
  const line = current(node, 'line')
  const found = []
  RED.nodes.eachConfig(other => {
    if (TYPES.includes(other.type) && other.id !== node.id && other.line === line && !other.d) found.push(other)
    return true
  })
  return found
}

const memberOf = ({ type, station, masterIds }) => ({
  protocol: type === 'chino-config' ? 'modbus' : 'nx',
  station: Number(station),
  masterIds: [...attempt(() => masterIdsOf(masterIds), [])],
  name: ''
})

/** Whether a number can stand on the line beside the others. */
const checkNumber = type => (node, station) => {
  const own = memberOf({ type, station, masterIds: current(node, 'masterIds') })
  const listener = listenerOf(current(node, 'line'))
  if (listener) return t('problem.listened', { other: listener })
  for (const other of neighbours(node)) {
    const name = deviceName(other)
    if (String(other.station) === String(station).trim()) return t('problem.sameStation', { other: name })
    const reason = isVariable(other.station) ? '' : mixedConflict(own, memberOf(other))
    if (reason) return t('problem.mixed', { other: name, reason })
  }
  return true
}

const checkPlcNumber = checkNumber('nx-config')
const checkRegulatorNumber = checkNumber('chino-config')

/** A unit that is larger than the count would leave nothing to ask for. */
const checkUnit = count => (node, value) => Number(value) <= Number(current(node, count)) || t('problem.unit')

/** The item list of a node whose device, a `type`, is saved under `property`. */
const checkItems = (property, type) => (node, value) => {
  if (current(node, 'itemsType') === 'msg') return true
  if (!value || value.length === 0) return t('problem.noItems')
  const notation = notationWithTags(deviceOf(node, property) || { type })
  value.filter(text => !isVariable(text)).forEach(text => parseItem(text, notation))
  return true
}

const checkTarget = property => (node, value) => {
  if (!String(value || '').trim()) return true
  const device = deviceOf(node, property)
  if (!device) return true
  const item = parseItem(value, notationWithTags(device))
  if (device.access !== 'write') return t('problem.readOnly', { plc: deviceName(device) })
  return canOnlyBeRead(item, device) ? `${value}: ${t('editor.readable')}` : true
}

const deviceOf = (node, property) => RED.nodes.node(current(node, property))

const isBroadcast = node => {
  const device = deviceOf(node, 'regulator')
  return Boolean(device) && String(device.station).trim() === '0'
}

const chino = node => {
  const { addressMode, wordOrder } = view(node)
  return { type: 'chino-config', addressMode, wordOrder }
}

/** Where a message ends must be said in the way that was chosen. */
const checkEnd = (node, value) => Boolean(`${value}${current(node, 'last') ?? ''}`.trim()) || t('problem.needsEnd')
const checkCount = (_node, value) => Number(value) > 0 || t('problem.needsCount')
const checkGap = (node, value) =>
  truthy(current(node, 'bidirectional')) ||
  current(node, 'framing') !== 'gap' ||
  Number(value) > 0 ||
  t('problem.needsGap')
const checkFlow = (node, value) => value !== 'dc' || !truthy(current(node, 'bidirectional')) || t('problem.noDc')

const checkAcknowledge = (node, value) =>
  !truthy(value) || truthy(current(node, 'checked')) || t('problem.needsChecked')

/** Checks beyond a property's own row; they throw a PlcError or answer a text. */
const MORE = {
  'nx-config': {
    station: checkPlcNumber,
    masterIds: (_node, value) => Boolean(readSettings({ station: 255, masterIds: value }, 1)),
    writableRanges(node, writableRanges) {
      const { areas } = view(node)
      return Boolean(readSettings({ station: 255, areas: areas || [], writableRanges }, 1))
    },
    areas: (_node, value) => Boolean(notationOf({ areas: value })),
    tags(node, value) {
      readTags(value, notationOf({ areas: node.areas }))
      return true
    }
  },
  'chino-config': {
    station(node, value) {
      const all = Number(value) === 0 && !truthy(current(node, 'broadcast'))
      return all ? t('problem.broadcastOff') : checkRegulatorNumber(node, value)
    },
    protocol(node, value) {
      const line = RED.nodes.node(current(node, 'line'))
      return value === 'rtu' && line && String(line.dataBits) === '7' ? t('problem.dataBits') : true
    },
    coilUnit: checkUnit('coilRead'),
    discreteUnit: checkUnit('discreteRead'),
    writableRanges: (node, value) => Boolean(readRanges(value, notationOf(chino(node)))),
    tags(node, value) {
      readTags(value, notationOf(chino(node)))
      return true
    }
  },
  'nx-read': { items: checkItems('plc', 'nx-config') },
  'nx-write': { target: checkTarget('plc') },
  'chino-regulator': {
    mode: (node, value) => value === 'write' || !isBroadcast(node) || t('problem.broadcastMode'),
    verify: (node, value) => !truthy(value) || !isBroadcast(node) || t('problem.broadcastMode'),
    items: checkItems('regulator', 'chino-config'),
    target: checkTarget('regulator')
  },
  'melsec-c24': {
    line: node => lineOfListener(node, name => current(node, name)),
    end: checkEnd,
    count: checkCount,
    gap: checkGap,
    flow: checkFlow
  },
  'incon-link': {
    line: node => lineOfListener(node, name => current(node, name)),
    acknowledge: checkAcknowledge
  }
}

const isEmpty = value => value === undefined || value === null || value === ''

const verdict = (type, { name, node, value }) => {
  const row = PROPERTIES[type][name]
  if (isVariable(value)) return true
  const { problem } = readProperty(row, value)
  if (problem)
    return t(`problem.${problem}`, { allowed: allowed(row).replace(/^(\d+) to (\d+)/, `$1${t('editor.to')}$2`) })
  const more = MORE[type] && MORE[type][name]
  return more && (row.kind === 'list' || row.blank || !isEmpty(value)) ? more(node, value) : true
}

/**
 * The validator of a property.
 * @param {string} type @param {string} name
 */
const check = (type, name) =>
  // two declared parameters tell the editor that a reason may come as a text
  function (value, _options) {
    try {
      if (!applies(type, name, view(this))) return true
      return verdict(type, { name, node: this, value })
    } catch (error) {
      return errorText(error)
    }
  }

module.exports = { check, current, open, done, isVariable, view }
