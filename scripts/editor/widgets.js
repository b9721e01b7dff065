'use strict'
const { t } = require('./texts')

/** Small parts that several dialogs share. */

/**
 * Tabs over the children of a block.
 * @param {string} id of the ul; the content is `#${id}-content` with one child per tab
 * @param {[string, string][]} pages [id of the child, label]
 */
const tabs = (id, pages) => {
  const widget = RED.tabs.create({
    id,
    onchange(tab) {
      $(`#${id}-content`).children().hide()
      $(`#${tab.id}`).show()
      $(`#${tab.id}`).trigger('nxline-shown')
    }
  })
  pages.forEach(([page, label]) => widget.addTab({ id: page, label }))
  return widget
}

/** A value that a select does not offer (a variable, a later version's) stays what it is. */
const keepUnknown = (field, value) => {
  if (value === undefined || value === null || value === '') return
  const known = field.find('option').filter((_, option) => option.value === String(value)).length > 0
  if (!known) field.append($('<option>').attr('value', value).text(value))
  field.val(String(value))
}

/** A property that was saved before it existed shows its default. */
const fillDefaults = (node, prefix) => {
  for (const [name, { value }] of Object.entries(node._def.defaults)) {
    const field = $(`#${prefix}${name}`)
    if (field.length === 0) continue
    if (node[name] === undefined && value !== '' && !Array.isArray(value)) {
      if (field.is(':checkbox')) field.prop('checked', value)
      else field.val(String(value))
    }
    if (field.is('select') && !field.prop('multiple') && !name.match(/^(line|plc|regulator)$/)) {
      keepUnknown(field, node[name] === undefined ? value : node[name])
    }
  }
}

/** `first` stands before the value where it says more than the value does: the name of an adapter. */
const offerRow = ({ value, hint = '', first = '' }) => ({
  value,
  label: $('<span>')
    .text(first || value)
    .append(
      $('<span>')
        .css({ color: 'var(--red-ui-secondary-text-color)', marginLeft: '8px' })
        .text(first ? value : hint)
    )
})

/**
 * What is offered for a text. Tab and Enter take the first offer: where the text means something by itself it comes first, so that leaving
 * the field never turns M1 into a tag that has M10.
 * @param {string} text as typed
 * @param {{ value: string, hint?: string, first?: string }[]} offers
 * @param {(text: string) => boolean} usable whether a text can stand as it is
 */
const offersFor = (text, offers, usable) => {
  const wanted = text.trim().toLowerCase()
  const found = offers
    .filter(offer => `${offer.value} ${offer.hint || ''} ${offer.first || ''}`.toLowerCase().includes(wanted))
    .slice(0, 50)
  if (wanted === '' || found.length === 0 || !usable(text.trim())) return found
  const others = found.filter(({ value }) => value !== text.trim())
  return others.length === 0 ? [] : [{ value: text.trim() }, ...others]
}

/**
 * Suggestions while typing, all of them for a click into an empty field.
 * @param {any} field @param {() => { value: string, hint?: string }[]} offers @param {(text: string) => boolean} usable
 */
const suggest = (field, offers, usable) => {
  // the editor's widget says nothing when Tab or Enter have taken an offer; this handler comes before its own
  field.on('keydown', ({ key }) => {
    const before = field.val()
    if (key === 'Tab' || key === 'Enter') setTimeout(() => field.val() !== before && field.trigger('change'), 0)
  })
  field.autoComplete({
    minLength: 0,
    search: (value, answer) => answer(offersFor(value, offers(), usable).map(offerRow))
  })
  // it looks when a key comes up
  field.on('click', () => field.val() === '' && field.trigger('keyup'))
}

/** A code to copy: a click puts it on the clipboard. */
const copyable = text =>
  $('<a href="#" class="nxline-copy">')
    .css({ fontFamily: 'var(--red-ui-monospace-font)', whiteSpace: 'nowrap' })
    .attr('title', t('editor.copy'))
    .text(text)
    .prepend('<i class="fa fa-clipboard" style="margin-right: 4px"></i>')
    .on('click', function (event) {
      event.preventDefault()
      RED.clipboard.copyText(text, $(this))
    })

/** A line of small print under a field; `bad` in the colour of errors. */
const note = () =>
  $('<div class="nxline-note">').css({
    fontSize: '12px',
    lineHeight: '16px',
    minHeight: '16px',
    color: 'var(--red-ui-secondary-text-color)'
  })

const say = (block, text, bad = false) =>
  block
    .empty()
    .text(text)
    .css('color', bad ? 'var(--red-ui-text-color-error)' : 'var(--red-ui-secondary-text-color)')

/** A small input of a table, with its name (or what an empty one means) as placeholder, and a tooltip. */
const cell = (
  name,
  value,
  { width = '80px', grow = false, shows = t(`column.${name}`), hint = t(`tooltip.${name}`) } = {}
) =>
  $('<input type="text">')
    .addClass(`nxline-${name}`)
    .attr({ placeholder: shows, title: hint, 'aria-label': t(`column.${name}`) })
    .css({ width, flexGrow: grow ? 1 : 0, minWidth: 0, margin: 0 })
    .val(value === undefined || value === null ? '' : String(value))

/** A small select of a table. `options`: [value, label]. */
const pick = (name, value, options) => {
  const field = $('<select>')
    .addClass(`nxline-${name}`)
    .attr({ title: t(`tooltip.${name}`), 'aria-label': t(`column.${name}`) })
    .css({ width: 'auto', margin: 0 })
  options.forEach(([key, label]) => field.append($('<option>').attr('value', key).text(label)))
  keepUnknown(field, value)
  return field
}

/** A flag may have been saved as a text. */
const truthy = value => Boolean(value) && value !== 'false'

const tick = (name, value) => {
  const box = $('<input type="checkbox">')
    .addClass(`nxline-${name}`)
    .css({ width: 'auto', margin: '0 4px 0 0' })
    .prop('checked', truthy(value))
  const label = $('<label>')
    .css({ width: 'auto', margin: 0, display: 'inline-flex', alignItems: 'center', whiteSpace: 'nowrap' })
    .attr('title', t(`tooltip.${name}`))
    .append(box)
    .append(document.createTextNode(t(`column.${name}`)))
  return { box, label }
}

/** A sign or word between two cells. */
const mark = text =>
  $('<span>').css({ color: 'var(--red-ui-secondary-text-color)', whiteSpace: 'nowrap', fontSize: '12px' }).text(text)

const flex = (...children) =>
  $('<div>').css({ display: 'flex', gap: '4px', alignItems: 'center', marginBottom: '3px' }).append(children)

module.exports = { tabs, fillDefaults, suggest, offersFor, copyable, note, say, cell, pick, tick, truthy, flex, mark }
