'use strict'
const { done, isVariable, open } = require('./check')
const { attempt, describe, notationWithTags, parseItem, plcName, unsure } = require('./model')
const { copyable, fillDefaults, flex, note, say, suggest } = require('./widgets')
const { errorText, t } = require('./texts')

/** The dialogs of nx-read and nx-write. */

const PREFIX = 'node-input-'
const value = name => $(`#${PREFIX}${name}`).val()
const plcOf = () => RED.nodes.node(value('plc'))

const tagOffers = () =>
  [...notationWithTags(plcOf()).tags.values()].map(tag => ({
    value: tag.name,
    hint: [tag.address, tag.label, tag.unit].filter(Boolean).join(' · ')
  }))

const isItem = text => attempt(() => Boolean(parseItem(text, notationWithTags(plcOf()))), false)

// --- nx-read: the list of items

const itemTexts = () =>
  $('#nxline-read-items')
    .editableList('items')
    .toArray()
    .map(row => row.data('nxline').read())
    .filter(text => text !== '')

/** What stands under an item: a sentence, and the key of its value to copy. */
const verdictOf = text => {
  if (!text) return { says: t('editor.itemHint') }
  if (isVariable(text)) return { says: t('editor.variable') }
  const plc = plcOf()
  const notation = notationWithTags(plc)
  try {
    const item = parseItem(text, notation)
    const sure = unsure(item, notation) ? ` · ${t('editor.unconfirmed')}` : ''
    const key = value('format') === 'object' ? `msg.payload.${item.name}` : item.name
    return { says: `${describe(item, plc || {})}${sure} · `, key }
  } catch (error) {
    return { says: errorText(error), bad: true }
  }
}

const judgeItem = (text, block) => {
  const verdict = verdictOf(text)
  const signature = JSON.stringify(verdict)
  // the key may have the focus: it stays the same element while it says the same
  if (block.data('nxline') === signature) return
  say(block, verdict.says, verdict.bad).data('nxline', signature)
  if (verdict.key) block.append(copyable(verdict.key))
}

const addItem = (container, data) => {
  const field = $('<input type="text" class="nxline-item">')
    .css({ flexGrow: 1, margin: 0 })
    .attr({ placeholder: t('editor.itemExample'), 'aria-label': t('editor.item') })
    .val(typeof data === 'string' ? data : data.text || '')
  const message = note()
  const read = () => String(field.val()).trim()
  const judge = () => judgeItem(read(), message)
  container.append(flex(field)).append(message)
  suggest(field, tagOffers, isItem)
  field.on('input change', () => {
    judge()
    showExample()
  })
  container.data('nxline', { read, judge })
  judge()
}

const judgeAll = () => {
  const rows = $('#nxline-read-items').editableList('items').toArray()
  rows.forEach(row => row.data('nxline').judge())
  showExample()
}

const SAMPLES = { bool: true, float32: 21.5 }

const sampleOf = (item, index) => {
  const one = item.type.name.startsWith('string') ? 'ABC' : (SAMPLES[item.type.name] ?? 120 + index)
  const plain = one === true && value('booleans') === 'number' ? 1 : one
  return item.range && value('ranges') === 'array'
    ? Array.from({ length: Math.min(item.count, 3) }, () => plain)
    : plain
}

const singles = item =>
  item.range && value('ranges') === 'values' ? item.elements.map(({ name }) => ({ ...item, name })) : [item]

const EXAMPLES = {
  object: (rows, device) => ({ topic: device, payload: Object.fromEntries(rows) }),
  message: ([[name, one]]) => ({ topic: name, payload: one }),
  envelope: ([[name, one]]) => ({
    topic: name,
    payload: { value: one, quality: 'good', timestamp: 1767225600000, unit: '' }
  }),
  list: (rows, device) => ({
    topic: device,
    payload: rows.map(([name, one]) => ({ name, value: one, quality: 'good', timestamp: 1767225600000, unit: '' }))
  })
}

/** What a message will look like, with the first items of the list. */
const showExample = () => {
  const notation = notationWithTags(plcOf())
  const items = itemTexts().flatMap(text => attempt(() => singles(parseItem(text, notation)), []))
  const rows = items.slice(0, 3).map((item, index) => [item.name, sampleOf(item, index)])
  const shape = EXAMPLES[value('format')]
  const block = $('#nxline-read-example')
  if (rows.length === 0 || !shape || value('itemsType') !== 'list') return block.parent().hide()
  const plc = plcOf()
  const text = JSON.stringify(shape(rows, plc ? plcName(plc) : 'PLC'))
  block.text(items.length > 3 ? `${text} …` : text)
  return block.parent().show()
}

/** oneditprepare of nx-read. */
const editRead = node => {
  open(node, PREFIX)
  fillDefaults(node, PREFIX)
  const list = $('#nxline-read-items').editableList({
    addItem: (container, _index, data) => addItem(container, data),
    removeItem: () => setTimeout(showExample, 0),
    addButton: t('editor.addItem'),
    removable: true,
    sortable: true,
    height: 240
  })
  ;(node.items || []).forEach(text => list.editableList('addItem', { text }))
  if (!node.items || node.items.length === 0) list.editableList('addItem', { text: '' })
  // a new row scrolls into view: begin at the first one
  setTimeout(() => list.closest('.red-ui-editableList-container').scrollTop(0), 0)
  $(`#${PREFIX}itemsType`)
    .on('change', function () {
      $('.nxline-list').toggle($(this).val() === 'list')
      showExample()
    })
    .trigger('change')
  ;['plc', 'format', 'ranges', 'booleans'].forEach(name => $(`#${PREFIX}${name}`).on('change', judgeAll))
  judgeAll()
}

/** oneditsave of nx-read. */
const saveRead = node => {
  node.items = itemTexts()
  done()
}

/** oneditresize of nx-read: the list takes what the other rows leave. */
const resizeRead = size => {
  const others = $('#dialog-form > div:visible').not('.nxline-list').toArray()
  const used = others.reduce((sum, row) => sum + $(row).outerHeight(true), 0)
  $('#nxline-read-items').editableList('height', Math.max(240, size.height - used - 100))
}

/** The label of a reader without a name. */
const readLabel = node => {
  if (node.itemsType === 'msg') return 'msg.items'
  const items = node.items || []
  return items.length > 2 ? `${items.slice(0, 2).join(', ')} …` : items.join(', ')
}

// --- nx-write

const judgeTarget = () => {
  const text = String(value('target') || '').trim()
  const plc = plcOf()
  const block = $('#nxline-write-note')
  const readOnly = plc && plc.access !== 'write'
  if (readOnly && !text) return say(block, t('problem.readOnly', { plc: plcName(plc) }), true)
  if (!text) return say(block, t('editor.noTarget'))
  if (isVariable(text)) return say(block, t('editor.variable'))
  const notation = notationWithTags(plc)
  try {
    const item = parseItem(text, notation)
    if (readOnly) return say(block, t('problem.readOnly', { plc: plcName(plc) }), true)
    return say(block, describe(item, { ...plc, write: true }))
  } catch (error) {
    return say(block, errorText(error), true)
  }
}

/** oneditprepare of nx-write. */
const editWrite = node => {
  open(node, PREFIX)
  fillDefaults(node, PREFIX)
  suggest($(`#${PREFIX}target`), tagOffers, isItem)
  $(`#${PREFIX}target, #${PREFIX}plc`).on('input change', judgeTarget)
  $(`#${PREFIX}plc`).on('change', () => $(`#${PREFIX}target`).trigger('change'))
  $(`#${PREFIX}topic`)
    .on('change', function () {
      $(`#${PREFIX}topicText`).toggle($(this).val() === 'fixed')
    })
    .trigger('change')
  judgeTarget()
}

/** oneditsave of nx-write: the second output is there only if failures go to it. */
const saveWrite = node => {
  node.outputs = value('onFailure') === 'output' ? 2 : 1
  done()
}

const writeLabel = node => node.target || ''

module.exports = { editRead, saveRead, resizeRead, readLabel, editWrite, saveWrite, writeLabel }
