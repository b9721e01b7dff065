'use strict'
const { PROPERTIES, readProperty, allowed, applies } = require('../../nodes/properties')
const { t, errorText } = require('./texts')
const { readSettings } = require('../../lib/device/settings')
const { readTags } = require('../../lib/tag/tags')
const { notationOf, notationWithTags, parseItem, plcName } = require('./model')

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

const sameStation = (node, station) => {
  const line = current(node, 'line')
  let twin = null
  RED.nodes.eachConfig(other => {
    const known = other.type === 'nx-config' && other.id !== node.id && other.line === line && !other.d
    if (known && String(other.station) === String(station).trim()) twin = other
    return true
  })
  return twin
}

/** Checks beyond a property's own row; they throw a PlcError or answer a text. */
const MORE = {
  'nx-config': {
    station(node, value) {
      const twin = sameStation(node, value)
      return twin ? t('problem.sameStation', { other: plcName(twin) }) : true
    },
    masterIds: (_node, value) => Boolean(readSettings({ station: 255, masterIds: value }, 1)),
    writableRanges(node, writableRanges) {
      const { areas } = view(node)
      return Boolean(readSettings({ station: 255, areas: areas || [], writableRanges }, 1))
    },
    areas: (_node, value) => Boolean(notationOf(value)),
    tags(node, value) {
      readTags(value, notationOf(node.areas))
      return true
    }
  },
  'nx-read': {
    items(node, value) {
      if (current(node, 'itemsType') === 'msg') return true
      if (!value || value.length === 0) return t('problem.noItems')
      const notation = notationWithTags(RED.nodes.node(current(node, 'plc')))
      value.filter(text => !isVariable(text)).forEach(text => parseItem(text, notation))
      return true
    }
  },
  'nx-write': {
    target(node, value) {
      if (!String(value || '').trim()) return true
      const plc = RED.nodes.node(current(node, 'plc'))
      if (!plc) return true
      parseItem(value, notationWithTags(plc))
      return plc.access === 'write' ? true : t('problem.readOnly', { plc: plcName(plc) })
    }
  }
}

const isEmpty = value => value === undefined || value === null || value === ''

const verdict = (type, { name, node, value }) => {
  const row = PROPERTIES[type][name]
  if (isVariable(value)) return true
  const { problem } = readProperty(row, value)
  if (problem) return t(`problem.${problem}`, { allowed: allowed(row) })
  const more = MORE[type] && MORE[type][name]
  return more && (row.kind === 'list' || !isEmpty(value)) ? more(node, value) : true
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
