'use strict'
const { areaMap } = require('../../lib/codec/nx/areas')
const { done, open } = require('./check')
const { attempt, plcLabel } = require('./model')
const { areaTable, exportTags, importTags, rowsOf, tagTable } = require('./table')
const { fillDefaults, tabs } = require('./widgets')
const { errorText, t } = require('./texts')

/** The dialog of nx-config. */

let dialogHeight = 0

const PREFIX = 'node-config-input-'
const value = name => $(`#${PREFIX}${name}`).val()

const areaRows = () => rowsOf($('#nxline-nx-area-list')).filter(row => row.area)
const tagRows = () => rowsOf($('#nxline-nx-tag-list')).filter(row => row.name || row.address)

const context = () => ({ steps: value('steps'), areas: attempt(areaRows, []) })

const judgeAll = () =>
  $('#nxline-nx-tag-list')
    .editableList('items')
    .toArray()
    .forEach(row => row.data('nxline').judge())

const noteAreas = () => {
  const map = attempt(() => areaMap(areaRows()), null)
  if (!map) return
  const names = sure => map.list.filter(row => (row.certainty === 'unconfirmed') === sure).map(row => row.area)
  $('#nxline-nx-area-note').text(
    t('editor.areaNote', { sure: names(false).join(', '), unsure: names(true).join(', ') || '–' })
  )
}

const wireCsv = node => {
  $('#nxline-nx-export').on('click', () => exportTags($('#nxline-nx-tag-list'), value('name') || node.id))
  $('#nxline-nx-import').on('click', () => $('#nxline-nx-file').val('').trigger('click'))
  $('#nxline-nx-file').on('change', async function () {
    try {
      const count = importTags($('#nxline-nx-tag-list'), await this.files[0].text(), areaRows())
      RED.notify(t('editor.imported', { number: count }), 'success')
    } catch (error) {
      RED.notify($('<span>').text(errorText(error)).html(), 'error')
    }
  })
}

// --- Test

const lineProperties = id => {
  const line = RED.nodes.node(id)
  if (!line) return null
  const names = Object.keys(line._def.defaults)
  return { id, ...Object.fromEntries(names.map(name => [name, line[name]])) }
}

const plcProperties = node => {
  const fields = ['name', 'line', 'station', 'steps', 'timeout', 'masterIds']
  return {
    id: node.id,
    ...Object.fromEntries(fields.map(name => [name, value(name)])),
    areas: areaRows(),
    tags: tagRows()
  }
}

const showResult = (text, colour) =>
  $('#nxline-nx-test-result')
    .show()
    .text(text)
    .css({ borderLeft: `4px solid var(${colour})` })

const failure = ({ reached, error }) => {
  const { deployFirst, value: path } = error.details || {}
  if (deployFirst) return t('test.deployFirst', { path })
  // an error's text is made to follow a name; here it is the sentence
  const text = errorText(error).replace(/^(?:the|station)\b/, word => word[0].toUpperCase() + word.slice(1))
  return reached ? t('test.reached', { text: errorText(error) }) : t('test.failed', { text })
}

const sentence = answer =>
  answer.ok ? [t('test.ok', answer), '--red-ui-text-color-success'] : [failure(answer), '--red-ui-text-color-error']

const httpError = xhr => {
  const error = (xhr.responseJSON && xhr.responseJSON.error) || null
  if (error) return { ok: false, error }
  const message = t(xhr.status === 401 || xhr.status === 403 ? 'test.denied' : 'test.unreachable')
  return { ok: false, error: { message } }
}

const runTest = node => {
  const button = $('#nxline-nx-test').prop('disabled', true)
  showResult(t('test.running'), '--red-ui-secondary-text-color')
  const finish = answer => {
    button.prop('disabled', false)
    showResult(...sentence(answer))
  }
  const data = JSON.stringify({ plc: plcProperties(node), line: lineProperties(value('line')) })
  $.ajax({ url: 'nx-config/test', type: 'POST', contentType: 'application/json', data }).then(finish, xhr =>
    finish(httpError(xhr))
  )
}

/** oneditprepare of nx-config. */
const editPlc = node => {
  open(node, PREFIX)
  fillDefaults(node, PREFIX)
  areaTable($('#nxline-nx-area-list'), node.areas, () => noteAreas())
  tagTable($('#nxline-nx-tag-list'), node.tags, context)
  noteAreas()
  wireCsv(node)
  $('#nxline-nx-test').on('click', () => runTest(node))
  $(`#${PREFIX}steps`).on('change', judgeAll)
  $(`#${PREFIX}line`).on('change', () => $(`#${PREFIX}station`).trigger('change'))
  $(`#${PREFIX}access`)
    .on('change', function () {
      $('.nxline-writing').toggle($(this).val() !== 'read')
      $('.nxline-reading').toggle($(this).val() === 'read')
    })
    .trigger('change')
  $('#nxline-nx-tags').on('nxline-shown', () => {
    fitTags()
    judgeAll()
  })
  tabs('nxline-nx-tabs', [
    ['nxline-nx-plc', t('tab.plc')],
    ['nxline-nx-tags', t('tab.tags')],
    ['nxline-nx-writing', t('tab.writing')],
    ['nxline-nx-details', t('tab.details')]
  ])
}

/** oneditsave of nx-config. */
const savePlc = node => {
  node.areas = areaRows()
  node.tags = tagRows()
  done()
}

/** The tag table takes the height that the dialog has; a list that is hidden cannot be measured. */
const fitTags = () => {
  const list = $('#nxline-nx-tag-list')
  if (dialogHeight > 0 && list.is(':visible')) list.editableList('height', Math.max(200, dialogHeight - 150))
}

/** oneditresize of nx-config. */
const resizePlc = size => {
  dialogHeight = size.height
  fitTags()
}

module.exports = { editPlc, savePlc, resizePlc, plcLabel }
