'use strict'

const { parseAddress, TABLES } = require('../codec/modbus/address')
const { createHeating } = require('./heating')
const { createWords } = require('./words')
const { PlcError } = require('../error')

// the four tables side by side, as codec/modbus/address.js numbers them: 2 × 65536 registers, 2 × 65536 bits
const WORDS = 0x22000

/** @type {Map<string, any>} */
const rows = new Map(TABLES.map(row => [row.table, row]))
const UNHEATED = { behaviour: [], values: [], ranges: [], breakHeater: () => {} }

/**
 * The memory of one MODBUS station: four tables (words.js), and which of their addresses it has, protects, and limits.
 *
 * @param {{ now: () => number, addressMode?: '1-base'|'0-base', tables?: Record<string, string[]>, protect?: string[],
 *   ranges?: ReadonlyArray<Record<string, any>>, values?: ReadonlyArray<Record<string, any>>, behaviour?: ReadonlyArray<Record<string, any>>,
 *   heating?: boolean, history?: boolean }} options see chino-regulator.js
 * @returns {ModbusMemory}
 * @throws {PlcError} BAD_ADDRESS, BAD_BIT, OUT_OF_AREA, BAD_TYPE, BAD_SETTING
 */
function createModbusMemory(options) {
  const { now, addressMode, tables = {}, protect = [], behaviour = [], values = [], ranges = [], history } = options
  const locate = text => parseAddress(text, { addressMode })
  const heating = options.heating ? createHeating((text, type) => words.get(text, type)) : UNHEATED
  const live = [...heating.behaviour, ...behaviour]
  /** @type {import('./words').Words} */
  const words = createWords({ size: WORDS, now, locate, behaviour: live, history })
  for (const { at, as, value } of [...heating.values, ...values]) words.set(at, value, as)
  const present = spansOfTables(tables, locate)
  const guarded = protect.map(text => spanOf(locate(text)))
  const limited = [...heating.ranges, ...ranges].map(row => limitOf(row, locate))
  return {
    ...words,
    has: (table, base, count) => {
      if (base + count > 0x10000) return false
      const spans = present.get(table)
      return !spans || each(base, count, wire => spans.some(span => wire >= span.first && wire <= span.last))
    },
    isProtected: (table, base, count) =>
      guarded.some(span => span.table === table && span.first < base + count && span.last >= base),
    takes: (table, wire, value) =>
      limited.every(row => row.table !== table || row.wire !== wire || (value >= row.least && value <= row.most)),
    read: (table, wire) => readOf(words, table, wire),
    write: (table, wire, value) => writeTo(words, table, { wire, value }),
    breakHeater: heating.breakHeater
  }
}

const each = (base, count, test) => Array.from({ length: count }, (_, n) => base + n).every(test)

const readOf = (words, table, wire) => {
  const { kind, base } = rows.get(table)
  return kind === 'bit' ? words.readBit(base + wire) : words.readWord(base + wire)
}

const writeTo = (words, table, { wire, value }) => {
  const { kind, base } = rows.get(table)
  if (kind === 'bit') words.writeBit(base + wire, value)
  else words.writeWord(base + wire, value)
}

/**
 * A range as numbers on the wire; a bit of a register stands for the whole register.
 * @param {import('../codec/modbus/address').Address} place
 */
function spanOf({ table, wire, kind, count, throughWord, address }) {
  const last = throughWord && kind === 'bit' ? wire + ((address + count - 1) >> 4) - (address >> 4) : wire + count - 1
  return { table, first: wire, last }
}

/** What each table that is named has; one that is not named has all. */
function spansOfTables(tables, locate) {
  return new Map(
    Object.entries(tables).map(([table, texts]) => {
      if (!rows.has(table)) throw bad('tables', table, `known are ${[...rows.keys()].join(', ')}`)
      const spans = texts.map(text => spanOf(locate(text)))
      const other = texts.find((_, n) => spans[n].table !== table)
      if (other !== undefined) throw bad('tables', other, `it is no address of ${table}`)
      return [table, spans]
    })
  )
}

/** @param {Record<string, any>} row @param {(text: string) => any} locate */
function limitOf({ at, least = 0, most = 0xffff }, locate) {
  const { table, wire, kind } = locate(at)
  if (kind !== 'word') throw bad('ranges', at, 'only registers have limits')
  return { table, wire, least, most }
}

const bad = (setting, value, reason) => new PlcError('BAD_SETTING', { setting, value, reason })

/**
 * @typedef {import('./words').Words & {
 *   has: (table: string, base: number, count: number) => boolean,
 *   isProtected: (table: string, base: number, count: number) => boolean,
 *   takes: (table: string, wire: number, value: number) => boolean,
 *   read: (table: string, wire: number) => number | boolean,
 *   write: (table: string, wire: number, value: number | boolean) => void,
 *   breakHeater: (broken?: boolean) => void
 * }} ModbusMemory has: whether the station has all these addresses; isProtected: whether one of them cannot be written; takes: whether
 *   a register accepts a value; addresses are numbers on the wire. Absolute addresses (`heldBetween`, `readWord`) are those of
 *   codec/modbus/address.js: a coil is bit 16 w + b of a word, too
 */

module.exports = { createModbusMemory }
