'use strict'
const { areaMap } = require('../../lib/codec/nx/areas')
const { tagsFromCsv, tagsToCsv } = require('../../lib/tag/csv')
const { parseExpression } = require('../../lib/tag/item')
const { readTags } = require('../../lib/tag/tags')
const { attempt, describe, hex, notationOf, unsure } = require('./model')
const { cell, flex, mark, note, pick, say, tick, truthy } = require('./widgets')
const { errorText, reasonOf, t } = require('./texts')

/** The tables of nx-config: tags and areas. A row of the list keeps `read()`, its present content. */

const TYPES = ['', 'bool', 'uint16', 'int16', 'uint32', 'int32', 'float32', 'bcd16', 'bcd32', 'string[8]']

const rowsOf = list =>
  list
    .editableList('items')
    .toArray()
    .map(row => row.data('nxline').read())

/** A cell that nobody touched stays what was saved: a number stays a number, and a table that was only looked at is no change of the flow. */
const kept = (saved, name, value) => {
  const before = saved[name]
  const same = typeof value === 'boolean' ? value === truthy(before) : value === String(before ?? '').trim()
  return same ? before : value
}

const EMPTY = ['', false]

/** A saved row with the present contents of its cells; empty ones are left out. */
const merged = (saved, cells) => {
  const row = { ...saved }
  for (const [name, value] of Object.entries(cells)) {
    row[name] = kept(saved, name, value)
    if (row[name] === undefined || (EMPTY.includes(row[name]) && row[name] !== saved[name])) delete row[name]
  }
  return row
}

const tagText = (row, { steps, areas }) => {
  const notation = notationOf(areas)
  const tag = [...readTags([row], notation).values()][0]
  const item = parseExpression(tag.address, notation, { tag })
  return describe(item, { steps }) + (unsure(item, notation) ? ` · ${t('editor.unconfirmed')}` : '')
}

const judgeTag = (row, block, context) => {
  if (!row.name && !row.address) return say(block, t('editor.tagHint'))
  try {
    return say(block, tagText(row, context()))
  } catch (error) {
    return say(block, reasonOf(error), true)
  }
}

const typeField = value => {
  const known = TYPES.map(type => [type, type || t('editor.byAddress')])
  return pick('type', value, known)
}

const tagFields = data => {
  const writable = tick('writable', data.writable)
  const order = [
    ['', t('editor.lowFirst')],
    ['high', t('editor.highFirst')]
  ]
  return {
    name: cell('tagName', data.name, { width: '24%' }),
    address: cell('address', data.address, { width: '22%' }),
    type: typeField(data.type),
    label: cell('tagLabel', data.label, { grow: true, width: '20%' }),
    unit: cell('unit', data.unit, { width: '64px' }),
    scale: cell('scale', data.scale, { width: '58px', shows: '1' }),
    offset: cell('offset', data.offset, { width: '58px', shows: '0' }),
    deadband: cell('deadband', data.deadband, { width: '52px', shows: '0' }),
    wordOrder: pick('wordOrder', data.wordOrder === 'low' ? '' : data.wordOrder, order),
    min: cell('min', data.min, { width: '52px', shows: '–' }),
    max: cell('max', data.max, { width: '52px', shows: '–' }),
    writable
  }
}

const readFields = (fields, saved) => {
  const content = field => (field.box ? field.box.prop('checked') : String(field.val() ?? '').trim())
  const cells = Object.fromEntries(Object.entries(fields).map(([name, field]) => [name, content(field)]))
  // low is what an empty choice means
  if (cells.wordOrder === '' && saved.wordOrder === 'low') cells.wordOrder = 'low'
  return merged(saved, cells)
}

const addTag = (container, data, context) => {
  const fields = tagFields(data)
  const message = note()
  const read = () => readFields(fields, data)
  const judge = () => judgeTag(read(), message, context)
  container
    .append(flex(fields.name, fields.address, fields.type, fields.label, fields.unit))
    .append(
      flex(
        ...[mark('×'), fields.scale, mark('+'), fields.offset, mark(t('column.deadband')), fields.deadband],
        ...[fields.wordOrder, mark(t('column.min')), fields.min, mark(t('column.max')), fields.max],
        fields.writable.label
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
 * @param {() => { steps: string, areas: any[] }} context of the open dialog
 */
const tagTable = (list, tags, context) => {
  list.editableList({
    header: $('<div>')
      .css({ padding: '2px 6px', color: 'var(--red-ui-secondary-text-color)' })
      .text(t('editor.tagHeader')),
    addItem: (container, _index, data) => addTag(container, data, context),
    addButton: t('editor.addTag'),
    removable: true,
    sortable: true,
    scrollOnAdd: true,
    height: 300
  })
  ;(tags || []).forEach(tag => list.editableList('addItem', tag))
}

/** Puts the rows of a CSV file into the table: rows of the same name are replaced. */
const importTags = (list, text, areas) => {
  const rows = tagsFromCsv(text)
  readTags(rows, notationOf(areas))
  const names = new Set(rows.map(row => row.name.trim()))
  list
    .editableList('items')
    .toArray()
    .filter(row => names.has(row.data('nxline').read().name))
    .forEach(row => list.editableList('removeItem', row.data('data')))
  rows.forEach(row => list.editableList('addItem', merged({}, row)))
  return rows.length
}

const download = (name, text) => {
  const url = URL.createObjectURL(new Blob([text], { type: 'text/csv;charset=utf-8' }))
  const link = $('<a>').attr({ href: url, download: name }).appendTo('body')
  link[0].click()
  link.remove()
  URL.revokeObjectURL(url)
}

const exportTags = (list, name) => download(`${name || 'tags'}.csv`, tagsToCsv(rowsOf(list)))

const areaFields = data => ({
  area: cell('area', data.area, { width: '60px' }),
  base: cell('base', data.base, { width: '80px' }),
  words: cell('words', data.words, { width: '70px' }),
  as: pick('as', data.as || '', [
    ['', t('editor.asBefore')],
    ['both', t('editor.asBoth')],
    ['bits', t('editor.asBits')],
    ['words', t('editor.asWords')]
  ]),
  note: cell('areaNote', data.note, { grow: true, width: '60px' }),
  confirmed: tick('confirmed', data.confirmed),
  remove: tick('remove', data.remove)
})

const readArea = (fields, saved) => {
  const row = readFields(fields, saved)
  if (row.area) row.area = String(row.area).toUpperCase()
  return row.remove ? { area: row.area, remove: row.remove } : row
}

/** What is wrong with a row, beside the others: an overlap is said by both rows. */
const areaFault = (row, rows) => {
  try {
    areaMap(rows)
    return null
  } catch (error) {
    const { name, reason } = error.details
    return name === row.area || String(reason).includes(`${row.area} (`) ? error : null
  }
}

const areaText = (row, rows) => {
  const map = attempt(() => areaMap(rows), null) || attempt(() => areaMap([row]), null)
  if (!map) return ''
  const known = map.get(row.area)
  if (!known) return t('editor.areaRemoved')
  const range = `${hex(known.base, 4)}h..${hex(known.base + known.words - 1, 4)}h`
  return t(known.writable ? 'editor.areaWritable' : 'editor.areaReadable', { range })
}

const judgeArea = (row, { block, rows }) => {
  if (!row.area) return say(block, t('editor.areaHint'))
  const fault = areaFault(row, rows)
  return fault ? say(block, errorText(fault), true) : say(block, areaText(row, rows))
}

const addArea = (container, data, judgeAll) => {
  const fields = areaFields(data)
  const block = note()
  const read = () => readArea(fields, data)
  const judge = rows => {
    const standard = areaMap().get(read().area)
    fields.base.attr('placeholder', standard ? `0x${hex(standard.base, 4)}` : t('column.base'))
    fields.words.attr('placeholder', standard ? standard.words : t('column.words'))
    judgeArea(read(), { block, rows })
  }
  container
    .append(
      flex(fields.area, fields.base, fields.words, fields.as, fields.note, fields.confirmed.label, fields.remove.label)
    )
    .append(block)
    .on('input change', judgeAll)
  container.data('nxline', { read, judge })
}

/** The area table: rows that replace, add or remove standard ones. */
const areaTable = (list, areas, changed) => {
  const judgeAll = () => {
    const rows = rowsOf(list).filter(row => row.area)
    list
      .editableList('items')
      .toArray()
      .forEach(row => row.data('nxline').judge(rows))
    changed()
  }
  list.editableList({
    addItem: (container, _index, data) => {
      addArea(container, data, judgeAll)
      setTimeout(judgeAll, 0)
    },
    removeItem: judgeAll,
    addButton: t('editor.addArea'),
    removable: true,
    height: 220
  })
  ;(areas || []).forEach(row => list.editableList('addItem', row))
}

module.exports = { tagTable, areaTable, areaFault, merged, rowsOf, importTags, exportTags }
