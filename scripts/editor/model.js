'use strict'
const { functionOf, queryCode } = require('../../lib/codec/nx/functions')
const { TABLES, placeOf } = require('../../lib/codec/modbus/address')
const { readFunction, writeFunction } = require('../../lib/codec/modbus/functions')
const { parseItem } = require('../../lib/tag/item')
const { modbusNotation } = require('../../lib/tag/modbus-notation')
const { nxNotation } = require('../../lib/tag/nx-notation')
const { t } = require('./texts')

/**
 * What the library knows about addresses, for the dialogs: the very code that runs later. A *device* is the configuration of one, as it was saved or as it
 * stands in its open dialog: `{ type, … }` with the properties of its config node; without a type an NX PLC.
 */

const attempt = (make, otherwise) => {
  try {
    return make()
  } catch {
    return otherwise
  }
}

const hex = (value, digits) => value.toString(16).toUpperCase().padStart(digits, '0')

// --- NX

const unitOf = (item, bits) => {
  const number = item.kind === 'word' ? item.count * item.type.words : item.count
  if (item.throughWord) return t('editor.through')
  if (number === 1) return t(bits ? 'editor.bit' : 'editor.word')
  return t(bits ? 'editor.bits' : 'editor.words', { number })
}

/** "function 23, word address 01BFh" */
const describeNx = (item, { steps = 2 }, write) => {
  const bits = item.kind === 'bit' && !item.throughWord
  const row = functionOf((write ? 'write' : 'read') + (bits ? 'Bits' : 'Words'))
  const code = hex(queryCode(row, String(steps) === '4' ? 4 : 2), 2)
  const address = hex(item.throughWord ? Math.floor(item.address / 16) : item.address, 4)
  return t('editor.goesOut', { code, address, what: unitOf(item, bits) })
}

// --- MODBUS

/** How many absolute addresses an item covers: a word type on coils stands on 16 of them for each word. */
const lengthOf = ({ kind, count, type, packed }) =>
  count * (kind === 'word' || packed ? type.words : 1) * (packed ? 16 : 1)

const SINGLE = { '05': () => true, '06': () => true, auto: count => count === 1 }

const writeCode = (table, count, { coilFunction = '0F', holdingFunction = '10' }) => {
  const chosen = table === 'co' ? coilFunction : holdingFunction
  const single = SINGLE[chosen] ? SINGLE[chosen](count) : false
  return hex(writeFunction(table, { single }), 2)
}

const whereOf = (first, last) => {
  const values = { first, last, firstHex: hex(first, 4), lastHex: hex(last, 4) }
  return t(first === last ? 'editor.wire' : 'editor.wires', values)
}

const isWritable = table => TABLES.find(row => row.table === table).writable

/** "function 03, wire address 107 (006Bh)" */
/** Discrete inputs and input registers of a regulator. */
const canOnlyBeRead = (item, { type }) => type === 'chino-config' && !isWritable(placeOf(item.kind, item.address).table)

const describeModbus = (item, device, write) => {
  const length = lengthOf(item)
  const { table, wire, bit } = placeOf(item.kind, item.address)
  const last = placeOf(item.kind, item.address + length - 1).wire
  const where = whereOf(wire, last)
  const read = hex(readFunction(table), 2)
  if (write && !isWritable(table)) return t('editor.readable')
  const code = write ? writeCode(table, last - wire + 1, device) : read
  if (bit === undefined) return t('editor.sent', { code, where })
  if (write) return t('editor.changed', { read, code, where })
  const bits = length === 1 ? t('editor.oneBit', { number: bit }) : t('editor.severalBits', { number: length })
  return `${t('editor.sent', { code, where })}, ${bits}`
}

// --- both

/** A choice that may be a variable, or be missing: then as its default. */
const oneOf = (value, known) => (known.includes(value) ? value : known[0])

const DEVICES = {
  'nx-config': {
    label: 'editor.station',
    notation: ({ areas }, tags) => nxNotation({ areas: areas || [], tags }),
    // faulty area rows count as none
    usable: device => ({ areas: attempt(() => nxNotation({ areas: device.areas || [] }) && device.areas, []) || [] }),
    describe: describeNx
  },
  'chino-config': {
    label: 'editor.regulator',
    notation: ({ addressMode, wordOrder }, tags) =>
      modbusNotation({
        addressMode: oneOf(addressMode, ['1-base', '0-base']),
        wordOrder: oneOf(wordOrder, ['low', 'high']),
        tags
      }),
    usable: device => device,
    describe: describeModbus
  }
}

const TYPES = Object.keys(DEVICES)
const kindOf = device => DEVICES[(device && device.type) || 'nx-config'] || DEVICES['nx-config']

/** How addresses are written for a device; without tags. Throws BAD_AREA. */
const notationOf = device => kindOf(device).notation(device || {})

/** Rows of a tag table that can be used, as the run time uses them: a faulty one does not take the others with it. */
const usableTags = (notation, device, tags) => {
  const names = new Set()
  return tags.filter(row => {
    const [name] = attempt(() => [...notation(device, [row]).tags.keys()], [])
    return name !== undefined && !names.has(name) && names.add(name)
  })
}

/** The notation with the tags of a device; what is faulty is left out, its own dialog says so. */
const notationWithTags = device => {
  const { notation, usable } = kindOf(device)
  const own = usable(device || {})
  const tags = (device && device.tags) || []
  return (
    attempt(() => notation(own, tags), null) ||
    notation(own, usableTags(notation, own, Array.isArray(tags) ? tags : []))
  )
}

/** How a device is called that has no name, in messages as well. */
const deviceLabel = device => t(kindOf(device).label, { station: device.station === '' ? '?' : device.station })
const deviceName = device => device.name || deviceLabel(device)

/**
 * What goes out for an item: "function 23, word address 01BFh", "function 03, wire address 107 (006Bh)".
 * @param {any} item of parseItem
 * @param {any} [device]
 * @param {{ write?: boolean }} [options]
 */
const describe = (item, device, { write = false } = {}) => kindOf(device).describe(item, device || {}, write)

/** The row of the area table that an item lies in is only a guess. */
const unsure = (item, notation) => attempt(() => notation.parse(item.addressText).certainty === 'unconfirmed', false)

module.exports = {
  TYPES,
  notationOf,
  notationWithTags,
  deviceLabel,
  deviceName,
  describe,
  unsure,
  parseItem,
  attempt,
  canOnlyBeRead,
  hex
}
