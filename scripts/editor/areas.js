'use strict'
const { areaMap } = require('../../lib/codec/nx/areas')
const { attempt, hex } = require('./model')
const { readFields, rowsOf } = require('./table')
const { cell, flex, note, pick, say, tick } = require('./widgets')
const { errorText, t } = require('./texts')

/** The area table of nx-config. */

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

module.exports = { areaFault, areaTable }
