'use strict'
const { areaMap } = require('../../lib/codec/nx/areas')
const { tagsFromCsv, tagsToCsv } = require('../../lib/tag/csv')
const { parseExpression } = require('../../lib/tag/item')
const { readTags } = require('../../lib/tag/tags')
const { describe, hex, notationOf, unsure } = require('./model')
const { cell, flex, mark, note, pick, say, tick } = require('./widgets')
const { errorText, reasonOf, t } = require('./texts')

/** The tables of nx-config: tags and areas. A row of the list keeps `read()`, its present content. */

const TYPES = ['', 'bool', 'uint16', 'int16', 'uint32', 'int32', 'float32', 'bcd16', 'bcd32', 'string[8]']

const rowsOf = list =>
  list
    .editableList('items')
    .toArray()
    .map(row => row.data('nxline').read())

const clean = row =>
  Object.fromEntries(Object.entries(row).filter(([, value]) => value !== '' && value !== undefined && value !== false))

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
    unit: cell('unit', data.unit, { width: '52px' }),
    scale: cell('scale', data.scale, { width: '58px' }),
    offset: cell('offset', data.offset, { width: '58px' }),
    deadband: cell('deadband', data.deadband, { width: '52px' }),
    wordOrder: pick('wordOrder', data.wordOrder === 'low' ? '' : data.wordOrder, order),
    min: cell('min', data.min, { width: '52px' }),
    max: cell('max', data.max, { width: '52px' }),
    writable
  }
}

const readFields = (fields, kept) => {
  const value = name => String(fields[name].val() ?? '').trim()
  const row = { ...kept, writable: fields.writable.box.prop('checked') }
  for (const name of Object.keys(fields)) if (name !== 'writable') row[name] = value(name)
  return clean(row)
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
  rows.forEach(row => list.editableList('addItem', clean(row)))
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
  as: pick('as', data.as || 'both', [
    ['both', t('editor.asBoth')],
    ['bits', t('editor.asBits')],
    ['words', t('editor.asWords')]
  ]),
  note: cell('areaNote', data.note, { grow: true, width: '60px' }),
  confirmed: tick('confirmed', data.confirmed),
  remove: tick('remove', data.remove)
})

const readArea = fields => {
  const value = name => String(fields[name].val() ?? '').trim()
  const area = value('area').toUpperCase()
  if (fields.remove.box.prop('checked')) return { area, remove: true }
  const row = { area, base: value('base'), words: value('words'), as: value('as'), note: value('note') }
  return clean({ ...row, confirmed: fields.confirmed.box.prop('checked') })
}

const judgeArea = (row, block) => {
  if (!row.area) return say(block, t('editor.areaHint'))
  try {
    const known = areaMap([row]).get(row.area)
    if (!known) return say(block, t('editor.areaRemoved'))
    const range = `${hex(known.base, 4)}h..${hex(known.base + known.words - 1, 4)}h`
    return say(block, t(known.writable ? 'editor.areaWritable' : 'editor.areaReadable', { range }))
  } catch (error) {
    return say(block, errorText(error), true)
  }
}

const addArea = (container, data, changed) => {
  const fields = areaFields(data)
  const message = note()
  const read = () => readArea(fields)
  const judge = () => {
    const standard = areaMap().get(read().area)
    if (standard) {
      fields.base.attr('placeholder', `0x${hex(standard.base, 4)}`)
      fields.words.attr('placeholder', standard.words)
    }
    judgeArea(read(), message)
    changed()
  }
  container
    .append(
      flex(fields.area, fields.base, fields.words, fields.as, fields.note, fields.confirmed.label, fields.remove.label)
    )
    .append(message)
    .on('input change', judge)
  container.data('nxline', { read, judge })
  judge()
}

/** The area table: rows that replace, add or remove standard ones. */
const areaTable = (list, areas, changed) => {
  list.editableList({
    addItem: (container, _index, data) => addArea(container, data, changed),
    removeItem: changed,
    addButton: t('editor.addArea'),
    removable: true,
    height: 150
  })
  ;(areas || []).forEach(row => list.editableList('addItem', row))
}

module.exports = { tagTable, areaTable, rowsOf, importTags, exportTags }
