'use strict'
const { PlcError } = require('../error')
const { FIELDS } = require('./tags')

/** Tag tables as CSV: what spreadsheets write and read. Pure; the editor bundles this file. */

const SEPARATORS = [',', ';', '\t']

/** The separator that stands most often in the first line, outside quotes: Excel writes `;` where the comma is decimal. */
const separatorOf = text => {
  const line = text.replace(/"(?:[^"]|"")*"/g, '').split(/\r\n|\r|\n/, 1)[0]
  const counts = SEPARATORS.map(separator => line.split(separator).length)
  return SEPARATORS[counts.indexOf(Math.max(...counts))]
}

const unquote = cell => (cell.startsWith('"') ? cell.slice(1, -1).replaceAll('""', '"') : cell)

/** Rows of cells; quoted cells may hold separators, quotes and line breaks. */
const parseCells = (text, separator) => {
  const other = separator === '\t' ? '\\t' : separator
  const cell = new RegExp(`("(?:[^"]|"")*"|[^"${other}\\r\\n][^${other}\\r\\n]*|)(${other}|\\r\\n|\\r|\\n|$)`, 'y')
  /** @type {string[][]} */
  const rows = [[]]
  let line = 1
  while (cell.lastIndex < text.length || rows.at(-1)?.length) {
    const from = cell.lastIndex
    const found = cell.exec(text)
    if (!found)
      throw new PlcError('BAD_TAG', { name: `in line ${line}`, reason: 'a quote is not closed, or text follows it' })
    rows[rows.length - 1].push(unquote(found[1]))
    line += (found[0].match(/\r\n|\r|\n/g) || []).length
    if (found[2] === '') break
    if (found[2] !== separator) rows.push([])
    if (cell.lastIndex === from) break
  }
  return rows.filter(row => row.some(value => value.trim() !== ''))
}

/**
 * The rows of a CSV text, to be checked with `readTags`. The first line names the columns (any order and case; unknown
 * columns are ignored); separator comma, semicolon or tab; a byte order mark is ignored. With a semicolon, a decimal
 * comma in a number is understood.
 * @param {string} text
 * @returns {Record<string, string>[]}
 * @throws {PlcError} BAD_TAG
 */
const tagsFromCsv = text => {
  const body = String(text).replace(/^\uFEFF/, '')
  const separator = separatorOf(body)
  const [head = [], ...rows] = parseCells(body, separator)
  const columns = head.map(title => FIELDS.find(field => field.toLowerCase() === title.trim().toLowerCase()))
  for (const needed of ['name', 'address']) {
    if (!columns.includes(needed))
      throw new PlcError('BAD_TAG', { name: 'table', reason: `the column ${needed} is missing` })
  }
  const decimal = value => (separator === ',' ? value : value.replace(/^(\s*[+-]?\d*),(\d+\s*%?\s*)$/, '$1.$2'))
  const numeric = new Set(['scale', 'offset', 'deadband', 'min', 'max', 'maxStep'])
  return rows.map(cells => {
    /** @type {Record<string, string>} */
    const row = {}
    columns.forEach((field, index) => {
      if (field) row[field] = numeric.has(field) ? decimal(cells[index] ?? '') : (cells[index] ?? '')
    })
    return row
  })
}

/**
 * What a spreadsheet may have eaten of the addresses of a table (`010197` without its zero is another address), for the user to look at.
 * @param {ReadonlyArray<Record<string, any>>} rows as from {@link tagsFromCsv}
 * @param {Pick<import('./item').Notation, 'doubts'>} notation of the station
 * @returns {{ name: string, address: string, text: string }[]} empty for stations whose addresses no spreadsheet takes for numbers
 */
const csvWarnings = (rows, notation) =>
  rows.flatMap(row => {
    const { name = '', address = '' } = row ?? {}
    const texts = notation.doubts?.(row ?? {}) ?? []
    return texts.map(text => ({ name: String(name), address: String(address), text }))
  })

const cellOf = value => {
  const text = value === null || value === undefined ? '' : String(value)
  return /[",;\t\r\n]|^\s|\s$/.test(text) ? `"${text.replaceAll('"', '""')}"` : text
}

/**
 * CSV of a tag table, with a byte order mark so that spreadsheets read the labels as UTF-8.
 * @param {Iterable<Partial<import('./tags').Tag>>} tags
 * @param {{ separator?: ','|';'|'\t' }} [options]
 * @returns {string}
 */
const tagsToCsv = (tags, { separator = ',' } = {}) => {
  const lines = [FIELDS, ...Array.from(tags, tag => FIELDS.map(field => tag[field]))]
  return `\uFEFF${lines.map(cells => cells.map(cellOf).join(separator)).join('\r\n')}\r\n`
}

module.exports = { csvWarnings, tagsFromCsv, tagsToCsv }
