'use strict'
const { formatAddress, parseAddress } = require('../codec/nx/address')
const { areaMap, LAST_WORD } = require('../codec/nx/areas')
const { readTags } = require('./tags')

/** How items of an NX PLC are written: addresses by its area map, tags by its table. Pure; the editor bundles this file. */

/** The area that holds the whole range, if one does. */
const lastOf = (address, areas) => {
  const row = address.area === null ? undefined : areas.get(address.area)
  const lastWord = row ? row.base + row.words - 1 : LAST_WORD
  return address.kind === 'word' ? lastWord : lastWord * 16 + 15
}

/**
 * @param {object} [configuration]
 * @param {ReadonlyArray<Record<string, any>>} [configuration.areas] rows that replace or add areas, see `areaMap`
 * @param {unknown} [configuration.tags] tag table, see `readTags`
 * @param {'low'|'high'} [configuration.wordOrder] of 32-bit values, default low
 * @param {'low'|'high'} [configuration.byteOrder] of strings, default low
 * @returns {import('./item').Notation & { areas: import('../codec/nx/areas').AreaMap }}
 * @throws {import('../error').PlcError} BAD_AREA, BAD_TAG, TOO_MANY
 */
const nxNotation = ({ areas: rows = [], tags, wordOrder = 'low', byteOrder = 'low' } = {}) => {
  const areas = areaMap(rows)
  const notation = {
    areas,
    parse: text => parseAddress(text, areas),
    format: at => formatAddress(at, areas),
    last: address => lastOf(address, areas),
    wordOrder,
    byteOrder
  }
  return { ...notation, tags: readTags(tags, notation) }
}

module.exports = { nxNotation }
