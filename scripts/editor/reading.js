'use strict'
const { isVariable } = require('./check')
const {
  device,
  deviceOf,
  deviceProperty,
  field,
  isItem,
  isModbus,
  notation,
  showsList,
  tagOffers,
  value
} = require('./form')
const { attempt, describe, deviceName, parseItem, unsure } = require('./model')
const { showCost, showSilence } = require('./cost')
const { copyable, flex, note, say, suggest } = require('./widgets')
const { errorText, t } = require('./texts')

/** What is read: the list of items, and an example of the message that comes of it. */

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
  const known = notation()
  try {
    const item = parseItem(text, known)
    const sure = unsure(item, known) ? ` · ${t('editor.unconfirmed')}` : ''
    const key = value('format') === 'object' ? `msg.payload.${item.name}` : item.name
    return { says: `${describe(item, device())}${sure} · `, key }
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
  const input = $('<input type="text" class="nxline-item">')
    .css({ flexGrow: 1, margin: 0 })
    .attr({
      placeholder: t(isModbus() ? 'editor.modbusAddress' : 'editor.itemExample'),
      'aria-label': t('editor.item')
    })
    .val(typeof data === 'string' ? data : data.text || '')
  const message = note()
  const read = () => String(input.val()).trim()
  const judge = () => judgeItem(read(), message)
  container.append(flex(input)).append(message)
  suggest(input, tagOffers, isItem)
  input.on('input change', () => {
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
  object: (rows, topic) => ({ topic, payload: Object.fromEntries(rows) }),
  message: ([[name, one]]) => ({ topic: name, payload: one }),
  envelope: ([[name, one]]) => ({
    topic: name,
    payload: { value: one, quality: 'good', timestamp: 1767225600000, unit: '' }
  }),
  list: (rows, topic) => ({
    topic,
    payload: rows.map(([name, one]) => ({ name, value: one, quality: 'good', timestamp: 1767225600000, unit: '' }))
  })
}

/** What a message will look like, with the first items of the list. */
const showExample = () => {
  showCost(itemTexts())
  const known = notation()
  const items = itemTexts().flatMap(text => attempt(() => singles(parseItem(text, known)), []))
  const rows = items.slice(0, 3).map((item, index) => [item.name, sampleOf(item, index)])
  const shape = EXAMPLES[value('format')]
  const block = $('#nxline-read-example')
  if (rows.length === 0 || !shape || !showsList()) return block.parent().hide()
  const named = deviceOf()
  const text = JSON.stringify(shape(rows, named ? deviceName(named) : 'PLC'))
  block.text(items.length > 3 ? `${text} …` : text)
  return block.parent().show()
}

const prepareReading = node => {
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
  field('itemsType')
    .on('change', () => {
      $('.nxline-list').toggle(showsList())
      showExample()
    })
    .trigger('change')
  field('interval').on('input change', () => showCost(itemTexts()))
  field('report').on('change', showSilence)
  showSilence()
  ;[deviceProperty(), 'format', 'ranges', 'booleans'].forEach(name => field(name).on('change', judgeAll))
  judgeAll()
}

let room = 0

/** The list takes what the other rows leave; beside what is written it is short. */
const fitList = () => {
  if (room === 0 || !showsList()) return
  const others = $('#dialog-form > div:visible').not('.nxline-list').toArray()
  const used = others.reduce((sum, row) => sum + $(row).outerHeight(true), 0)
  const least = $('.nxline-both').is(':visible') ? 200 : 240
  $('#nxline-read-items').editableList('height', Math.max(least, room - used - 100))
}

/** oneditresize of a node that reads. */
const resizeRead = size => {
  room = size.height
  fitList()
}

/** The label of a reader without a name. */
const readLabel = node => {
  if (node.itemsType === 'msg') return 'msg.items'
  const items = node.items || []
  return items.length > 2 ? `${items.slice(0, 2).join(', ')} …` : items.join(', ')
}

module.exports = { fitList, itemTexts, prepareReading, readLabel, resizeRead }
