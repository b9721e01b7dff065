'use strict'
const { areaMap } = require('../../lib/codec/nx/areas')
const { parseAddress, formatAddress } = require('../../lib/codec/nx/address')
const { functionOf } = require('../../lib/codec/nx/functions')
const { parseItem } = require('../../lib/tag/item')
const { readTags } = require('../../lib/tag/tags')
const { t } = require('./texts')

/** What the library knows about addresses, for the dialogs: the very code that runs later. */

const lastOf = (areas, address) => {
  const row = address.raw ? undefined : areas.get(address.area)
  if (!row) return 0xffff
  return address.kind === 'bit' ? (row.base + row.words) * 16 - 1 : row.base + row.words - 1
}

/** How addresses are written for a station with these area rows. */
const notationOf = areaRows => {
  const areas = areaMap(areaRows || [])
  return {
    areas,
    parse: text => parseAddress(text, areas),
    format: place => formatAddress(place, areas),
    last: address => lastOf(areas, address),
    throughWord: address => Boolean(address.throughWord),
    tags: new Map()
  }
}

const attempt = (make, otherwise) => {
  try {
    return make()
  } catch {
    return otherwise
  }
}

/** The notation with the tags of a PLC's configuration; a faulty table counts as empty, its own dialog says so. */
const notationWithTags = plc => {
  const notation = attempt(() => notationOf(plc && plc.areas), notationOf([]))
  notation.tags = attempt(() => readTags(plc && plc.tags, notation), new Map())
  return notation
}

const hex = (value, digits) => value.toString(16).toUpperCase().padStart(digits, '0')

/**
 * What goes out for an item: "function 23, word address 01BFh".
 * @param {any} item of parseItem
 * @param {{ steps?: string|number, write?: boolean }} [options]
 */
const describe = (item, { steps = 2, write = false } = {}) => {
  const bits = item.kind === 'bit' && !item.throughWord
  const row = functionOf((write ? 'write' : 'read') + (bits ? 'Bits' : 'Words'))
  const code = hex(String(steps) === '4' ? row.four : row.two, 2)
  const address = hex(item.throughWord ? Math.floor(item.address / 16) : item.address, 4)
  const words = item.kind === 'word' ? item.count * item.type.words : item.count
  const key = `editor.${words > 1 ? (bits ? 'bits' : 'words') : bits ? 'bit' : item.throughWord ? 'through' : 'word'}`
  return t('editor.goesOut', { code, address, what: t(key, { count: words, number: words }) })
}

/** The row of the area table that an item lies in is only a guess. */
const unsure = (item, notation) => {
  const address = attempt(() => notation.parse(notation.format(item)), null)
  return Boolean(address) && address.certainty === 'unconfirmed'
}

module.exports = { notationOf, notationWithTags, describe, unsure, parseItem, readTags, attempt, hex }
