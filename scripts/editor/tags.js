'use strict'
const { csvWarnings, tagsFromCsv, tagsToCsv } = require('../../lib/tag/csv')
const { parseExpression } = require('../../lib/tag/item')
const { readTags } = require('../../lib/tag/tags')
const { describe, notationOf, unsure } = require('./model')
const { merged, readFields, rowsOf } = require('./table')
const { cell, flex, mark, note, pick, say, tick } = require('./widgets')
const { reasonOf, t } = require('./texts')

/** The tag table of a device's dialog, and its CSV files. */

const TYPES = ['', 'bool', 'uint16', 'int16', 'uint32', 'int32', 'float32', 'bcd16', 'bcd32', 'string[8]']
const MOST_DOUBTS = 5

const tagText = (row, device) => {
  const notation = notationOf(device)
  const tag = [...readTags([row], notation).values()][0]
  const item = parseExpression(tag.address, notation, { tag })
  return describe(item, device) + (unsure(item, notation) ? ` · ${t('editor.unconfirmed')}` : '')
}

const judgeTag = (row, block, device) => {
  const modbus = device.type === 'chino-config'
  if (!row.name && !row.address) return say(block, t(modbus ? 'editor.modbusTagHint' : 'editor.tagHint'))
  if (modbus && !row.address) return say(block, t('editor.fillIn'), true)
  try {
    return say(block, tagText(row, device))
  } catch (error) {
    return say(block, reasonOf(error), true)
  }
}

const typeField = value => {
  const known = TYPES.map(type => [type, type || t('editor.byAddress')])
  return pick('type', value, known)
}

/** An empty word order is the device's; where that is always low, an empty one and `low` are the same. */
const orders = (saved, { type }) => {
  const known = [
    ['low', t('editor.lowFirst')],
    ['high', t('editor.highFirst')]
  ]
  if (type === 'chino-config') return [['', t('editor.deviceOrder')], ...known]
  return saved === 'low' ? known : [['', t('editor.lowFirst')], known[1]]
}

/** A cell for a few digits; many stand in a row. */
const narrow = field => field.css({ width: '48px', padding: '4px' })

const tagFields = (data, device) => {
  const writable = tick('writable', data.writable)
  const hint = t(device.type === 'chino-config' ? 'editor.modbusAddress' : 'tooltip.address')
  return {
    name: cell('tagName', data.name, { width: '24%' }),
    address: cell('address', data.address, { width: '22%', hint }),
    type: typeField(data.type),
    label: cell('tagLabel', data.label, { grow: true, width: '20%' }),
    unit: cell('unit', data.unit, { width: '64px' }),
    scale: narrow(cell('scale', data.scale, { shows: '1' })),
    offset: narrow(cell('offset', data.offset, { shows: '0' })),
    deadband: narrow(cell('deadband', data.deadband, { shows: '0' })),
    wordOrder: pick('wordOrder', data.wordOrder, orders(data.wordOrder, device)).css({
      flex: '0 1 132px',
      minWidth: 0,
      padding: '4px'
    }),
    min: narrow(cell('min', data.min, { shows: '–' })),
    max: narrow(cell('max', data.max, { shows: '–' })),
    maxStep: narrow(cell('maxStep', data.maxStep, { shows: '–' })),
    writable
  }
}

const addTag = (container, data, device) => {
  const fields = tagFields(data, device())
  const message = note()
  const read = () => readFields(fields, data)
  const judge = () => judgeTag(read(), message, device())
  container
    .append(flex(fields.name, fields.address, fields.type, fields.label, fields.unit))
    .append(
      flex(
        ...[mark('×'), fields.scale, mark('+'), fields.offset, mark(t('column.deadband')), fields.deadband],
        ...[fields.wordOrder, mark(t('column.min')), fields.min, mark(t('column.max')), fields.max],
        ...[mark(t('column.maxStep')), fields.maxStep, fields.writable.label]
      )
    )
    .append(message)
    .on('input change', judge)
  container.data('nxline', { read, judge })
  judge()
}

/**
 * The tag table.
 * @param {any} list the ol
 * @param {any[]} tags as saved
 * @param {() => any} device as it stands in the open dialog
 */
const tagTable = (list, tags, device) => {
  list.editableList({
    header: $('<div>')
      .css({ padding: '2px 6px', color: 'var(--red-ui-secondary-text-color)' })
      .text(t('editor.tagHeader')),
    addItem: (container, _index, data) => addTag(container, data, device),
    addButton: t('editor.addTag'),
    removable: true,
    sortable: true,
    scrollOnAdd: true,
    height: 300
  })
  ;(tags || []).forEach(tag => list.editableList('addItem', tag))
}

/** The tags that the manuals name. Their addresses differ from model to model: the user fills them in. */
const TEMPLATE = [
  { name: 'manual_output', label: 'template.manualOutput', unit: '%' },
  { name: 'gradient', label: 'template.gradient', unit: '%' },
  { name: 'elevation', label: 'template.elevation', unit: '%' },
  { name: 'load_voltage', label: 'template.loadVoltage', unit: 'V' },
  { name: 'load_current', label: 'template.loadCurrent', unit: 'A' },
  { name: 'load_power', label: 'template.loadPower', unit: 'W' },
  { name: 'load_resistance', label: 'template.loadResistance', unit: 'Ω' },
  { name: 'alarm', label: 'template.alarm' }
]

/** Rows of the template that the table does not have yet. */
const missingRows = present => {
  const names = new Set(present.map(({ name }) => name))
  return TEMPLATE.filter(({ name }) => !names.has(name)).map(row => ({ ...row, label: t(row.label), address: '' }))
}

/** Adds the template's rows; the table may begin with an empty one. */
const addTemplate = list => {
  missingRows(rowsOf(list)).forEach(row => list.editableList('addItem', row))
  // the list has scrolled to its end: begin with the first one to be filled in
  const empty = list.find('.nxline-address').filter((_, each) => each.value === '')
  if (empty.length === 0) return
  empty[0].closest('li').scrollIntoView({ block: 'nearest' })
  empty[0].focus()
}

/** What a spreadsheet may have eaten of the addresses of these rows; '' if nothing. */
const doubtOf = (rows, notation) => {
  const found = csvWarnings(rows, notation).map(({ name, text }) => `${name}: ${text}`)
  if (found.length === 0) return ''
  const first = found.slice(0, MOST_DOUBTS).join(' · ')
  return t('editor.doubt', { list: found.length > MOST_DOUBTS ? `${first} …` : first })
}

/**
 * Puts the rows of a CSV file into the table: rows of the same name are replaced.
 * @returns {{ count: number, doubt: string }}
 * @throws {import('../../lib/error').PlcError} BAD_TAG, TOO_MANY: nothing is changed then
 */
const importTags = (list, text, device) => {
  const rows = tagsFromCsv(text)
  const notation = notationOf(device)
  readTags(rows, notation)
  const names = new Set(rows.map(row => row.name.trim()))
  list
    .editableList('items')
    .toArray()
    .filter(row => names.has(row.data('nxline').read().name))
    .forEach(row => list.editableList('removeItem', row.data('data')))
  rows.forEach(row => list.editableList('addItem', merged({}, row)))
  return { count: rows.length, doubt: doubtOf(rows, notation) }
}

const download = (name, text) => {
  const url = URL.createObjectURL(new Blob([text], { type: 'text/csv;charset=utf-8' }))
  const link = $('<a>').attr({ href: url, download: name }).appendTo('body')
  link[0].click()
  link.remove()
  URL.revokeObjectURL(url)
}

const exportTags = (list, name) => download(`${name || 'tags'}.csv`, tagsToCsv(rowsOf(list)))

module.exports = { addTemplate, doubtOf, exportTags, importTags, missingRows, tagTable }
