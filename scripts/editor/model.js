'use strict'
const { functionOf, queryCode } = require('../../lib/codec/nx/functions')
const { parseItem } = require('../../lib/tag/item')
const { nxNotation } = require('../../lib/tag/nx-notation')
const { t } = require('./texts')

/** What the library knows about addresses, for the dialogs: the very code that runs later. */

const attempt = (make, otherwise) => {
  try {
    return make()
  } catch {
    return otherwise
  }
}

/** How addresses are written for a station with these area rows; without tags. Throws BAD_AREA. */
const notationOf = areas => nxNotation({ areas: areas || [] })

/** Rows of a tag table that can be used, as the run time uses them: a faulty one does not take the others with it. */
const usableTags = (areas, tags) => {
  const names = new Set()
  return tags.filter(row => {
    const [name] = attempt(() => [...nxNotation({ areas, tags: [row] }).tags.keys()], [])
    return name !== undefined && !names.has(name) && names.add(name)
  })
}

/** The notation with the tags of a PLC's configuration; what is faulty is left out, its own dialog says so. */
const notationWithTags = plc => {
  const { areas: rows, tags } = plc || {}
  const areas = attempt(() => notationOf(rows) && rows, []) || []
  return (
    attempt(() => nxNotation({ areas, tags: tags || [] }), null) ||
    nxNotation({ areas, tags: usableTags(areas, Array.isArray(tags) ? tags : []) })
  )
}

/** How a PLC is called that has no name, in messages as well. */
const plcLabel = plc => t('editor.station', { station: plc.station === '' ? '?' : plc.station })
const plcName = plc => plc.name || plcLabel(plc)

const hex = (value, digits) => value.toString(16).toUpperCase().padStart(digits, '0')

const unitOf = (item, bits) => {
  const number = item.kind === 'word' ? item.count * item.type.words : item.count
  if (item.throughWord) return t('editor.through')
  if (number === 1) return t(bits ? 'editor.bit' : 'editor.word')
  return t(bits ? 'editor.bits' : 'editor.words', { number })
}

/**
 * What goes out for an item: "function 23, word address 01BFh".
 * @param {any} item of parseItem
 * @param {{ steps?: string|number, write?: boolean }} [options]
 */
const describe = (item, { steps = 2, write = false } = {}) => {
  const bits = item.kind === 'bit' && !item.throughWord
  const row = functionOf((write ? 'write' : 'read') + (bits ? 'Bits' : 'Words'))
  const code = hex(queryCode(row, String(steps) === '4' ? 4 : 2), 2)
  const address = hex(item.throughWord ? Math.floor(item.address / 16) : item.address, 4)
  return t('editor.goesOut', { code, address, what: unitOf(item, bits) })
}

/** The row of the area table that an item lies in is only a guess. */
const unsure = (item, notation) => attempt(() => notation.parse(item.addressText).certainty === 'unconfirmed', false)

module.exports = { notationOf, notationWithTags, plcLabel, plcName, describe, unsure, parseItem, attempt, hex }
