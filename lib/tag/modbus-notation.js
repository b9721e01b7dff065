'use strict'
const { PlcError } = require('../error')
const { formatAddress, parseAddress, placeOf, TABLES } = require('../codec/modbus/address')
const { readTags } = require('./tags')

/** How items of a MODBUS station are written: addresses of four tables, tags by its table. Pure; the editor bundles this file. */

const MODES = ['1-base', '0-base']

/** The table that holds the whole range. */
const lastOf = ({ kind, address }) => {
  const { table, bit } = placeOf(kind, address)
  const row = /** @type {any} */ (TABLES.find(each => each.table === table))
  const last = row.base + row.size - 1
  return bit === undefined ? last : last * 16 + 15
}

const DIGITS = /^\d+$/
const BIT_OF_REGISTER = /^\d{5,6}\.\d$/
const LAST_NUMBER = 65536

/** Why one end of an address may not be what was typed into a spreadsheet, or ''. */
const doubtOf = (text, isBit) => {
  if (BIT_OF_REGISTER.test(text)) return `${text} may have been ${text}0: a bit has two digits`
  if (!DIGITS.test(text)) return ''
  if (isBit && /^(3|4)(\d{4}|\d{5})$/.test(text)) return `${text} is a register; it may have been the bit ${text}.00`
  if (text.length < 5) return `${text} may have been ${text.padStart(6, '0')}: it has too few digits`
  const eaten = text.length === 5 && text[0] !== '0' && Number(text) <= LAST_NUMBER
  return eaten ? `${text} may have been 0${text}, a coil: write six digits to be sure` : ''
}

/**
 * What a spreadsheet may have eaten of the address of a row: zeros in front, and zeros behind a point.
 * @param {Record<string, any>} row of a tag table
 * @returns {string[]} one text per doubt
 */
const doubtsOf = row => {
  const [address, type = ''] = String(row.address ?? '').split(':')
  const isBit = [type, row.type].some(each => /^\s*bool\s*$/i.test(String(each ?? '')))
  const doubts = address.split('..').map(end => doubtOf(end.trim(), isBit))
  return [...new Set(doubts.filter(Boolean))]
}

/**
 * @param {object} [configuration]
 * @param {'1-base'|'0-base'} [configuration.addressMode] 1-base (default): the number on the wire is the panel's − 1
 * @param {unknown} [configuration.tags] tag table, see `readTags`
 * @param {'low'|'high'} [configuration.wordOrder] of 32-bit values, default low (the panel's L/H)
 * @param {'low'|'high'} [configuration.byteOrder] of strings, default high: registers travel with their high byte first
 * @returns {import('./item').Notation & { addressMode: '1-base'|'0-base' }}
 * @throws {import('../error').PlcError} BAD_SETTING, BAD_TAG, TOO_MANY
 */
const modbusNotation = ({ addressMode = '1-base', tags, wordOrder = 'low', byteOrder = 'high' } = {}) => {
  if (!MODES.includes(addressMode)) {
    const reason = `it must be ${MODES.join(' or ')}`
    throw new PlcError('BAD_SETTING', { setting: 'addressMode', value: addressMode, reason })
  }
  /** @type {import('./item').Notation & { addressMode: '1-base'|'0-base' }} */
  const notation = {
    addressMode,
    example: '400108',
    parse: text => parseAddress(text, { addressMode }),
    format: at => formatAddress(at, { addressMode }),
    last: lastOf,
    packs: address => address.kind === 'bit' && !address.throughWord,
    doubts: doubtsOf,
    wordOrder,
    byteOrder
  }
  return { ...notation, tags: readTags(tags, notation) }
}

module.exports = { modbusNotation }
