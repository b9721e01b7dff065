'use strict'
const { truthy } = require('./widgets')

/** What the tables of the dialogs have in common. A row of an editable list keeps `read()`, its present content. */

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

const readFields = (fields, saved) => {
  const content = field => (field.box ? field.box.prop('checked') : String(field.val() ?? '').trim())
  const cells = Object.fromEntries(Object.entries(fields).map(([name, field]) => [name, content(field)]))
  return merged(saved, cells)
}

module.exports = { merged, readFields, rowsOf }
