'use strict'
const { check, done, open } = require('./check')
const { exportTags, importTags, tagTable } = require('./tags')
const { rowsOf } = require('./table')
const { fillDefaults, tabs } = require('./widgets')
const { capital, causeText, errorText, t } = require('./texts')

/** What the dialogs of nx-config and chino-config have in common: tags with their CSV files, what may be written, Test. */

const PREFIX = 'node-config-input-'
const field = name => $(`#${PREFIX}${name}`)
const value = name => field(name).val()

/** A property as it stands in the dialog. */
const fieldValue = name => (field(name).is(':checkbox') ? field(name).prop('checked') : value(name))

/** The rows of an editable list that say something. */
const tagRows = list => rowsOf(list).filter(row => row.name || row.address)

// --- CSV

const wireCsv = ({ part, list, device }, node) => {
  part('export').on('click', () => {
    exportTags(list, value('name') || node.id)
    if (device().type === 'chino-config') RED.notify(t('editor.exported'), 'warning')
  })
  part('import').on('click', () => part('file').val('').trigger('click'))
  part('file').on('change', async function () {
    try {
      const { count, doubt } = importTags(list, await this.files[0].text(), device())
      RED.notify(t('editor.imported', { number: count }), 'success')
      if (doubt) RED.notify($('<span>').text(doubt).html(), { type: 'warning', timeout: 15000 })
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

/** Without what to do about it: the cause knows better. */
const withoutRemedy = text => text.split(/(?<=\.) (?=\S)/)[0]

const failure = ({ reached, error }, short) => {
  const { deployFirst, value: path } = error.details || {}
  if (deployFirst) return t('test.deployFirst', { path })
  const text = short ? withoutRemedy(errorText(error)) : errorText(error)
  // an error's text is made to follow a name; here it is the sentence
  return reached ? t('test.reached', { text }) : t('test.failed', { text: text.replace(/^(?:the|station)\b/, capital) })
}

/**
 * What the test says: a sentence, and the likely cause if it found one that says more.
 * @param {any} answer of the server
 * @returns {string[]}
 */
const sentences = answer => {
  const { ok, cause, error } = answer
  if (ok) return [t(answer.value === null ? 'test.noItem' : 'test.ok', answer)]
  if (!cause || cause.code === error.code) return [failure(answer, false)]
  return [failure(answer, true), t('test.cause', { text: causeText(cause) })]
}

const showAnswer = (block, lines, colour) =>
  block
    .show()
    .empty()
    .append(lines.map(line => $('<div>').text(line)))
    .css({ borderLeft: `4px solid var(${colour})` })

const httpError = xhr => {
  const error = (xhr.responseJSON && xhr.responseJSON.error) || null
  if (error) return { ok: false, error }
  const message = t(xhr.status === 401 || xhr.status === 403 ? 'test.denied' : 'test.unreachable')
  return { ok: false, error: { message } }
}

/** What the fields themselves say is wrong, each by its label; a server that refuses them says it in English. */
const wrongFields = ({ device }, node) => {
  const { type, ...settings } = device()
  return Object.entries(settings)
    .map(([name, given]) => [name, field(name).length > 0 ? check(type, name).call(node, given) : true])
    .filter(([, verdict]) => typeof verdict === 'string')
    .map(([name, verdict]) => `${$(`label[for="${PREFIX}${name}"]`).first().text().trim()}: ${verdict}`)
}

const runTest = (own, node) => {
  const { part, list, device, url } = own
  const button = part('test').prop('disabled', true)
  const result = part('test-result')
  const finish = (lines, colour = '--red-ui-text-color-error') => {
    button.prop('disabled', false)
    showAnswer(result, lines, colour)
  }
  if (device().type === 'chino-config' && Number(value('station') || NaN) === 0) return finish([t('test.broadcast')])
  showAnswer(result, [t('test.running')], '--red-ui-secondary-text-color')
  const data = JSON.stringify({
    plc: { id: node.id, ...device(), tags: tagRows(list) },
    line: lineProperties(value('line')),
    // one short read more, and RTU where ASCII is set, or the other way round, is told
    tryOtherModes: device().type === 'chino-config'
  })
  $.ajax({ url, type: 'POST', contentType: 'application/json', data }).then(
    answer => finish(sentences(answer), answer.ok ? '--red-ui-text-color-success' : undefined),
    xhr => {
      const wrong = xhr.status === 400 ? wrongFields(own, node) : []
      finish(wrong.length > 0 ? wrong : sentences(httpError(xhr)))
    }
  )
}

// --- the dialog

const TABS = {
  plc: 'tab.plc',
  regulator: 'tab.regulator',
  tags: 'tab.tags',
  writing: 'tab.writing',
  details: 'tab.details'
}

let dialogHeight = 0

/** The tag table takes the height that the dialog has; a list that is hidden cannot be measured. */
const fitTags = list => {
  if (dialogHeight > 0 && list.is(':visible')) list.editableList('height', Math.max(200, dialogHeight - 150))
}

const judgeRows = list =>
  list
    .editableList('items')
    .toArray()
    .forEach(row => row.data('nxline').judge())

/**
 * The dialog of a device's configuration. Its parts have ids that begin with `nxline-` and its name: `-test`, `-test-result`, `-tag-list`, `-import`,
 * `-export`, `-file`, `-tabs`, and one for each page.
 * @param {string} name
 * @param {{ type: string, pages: string[], fields: string[], more?: () => any, judged: string[] }} own `fields`: properties that have a field
 *   and that tags or the Test depend on; `more`: properties that have none; `judged`: fields after whose change the tags say something else
 */
const deviceDialog = (name, { type, pages, fields, more = () => ({}), judged }) => {
  const part = id => $(`#nxline-${name}-${id}`)
  const device = () => ({ type, ...Object.fromEntries(fields.map(each => [each, fieldValue(each)])), ...more() })
  const judge = () => judgeRows(part('tag-list'))

  return {
    /** oneditprepare; what `before` makes is there when the tags are judged. */
    edit(node, before = () => {}) {
      open(node, PREFIX)
      fillDefaults(node, PREFIX)
      before()
      const list = part('tag-list')
      tagTable(list, node.tags, device)
      const own = { part, list, device, url: `${type}/test` }
      wireCsv(own, node)
      part('test').on('click', () => runTest(own, node))
      judged.forEach(each => field(each).on('change', judge))
      field('line').on('change', () => field('station').trigger('change'))
      field('access')
        .on('change', function () {
          $('.nxline-writing').toggle($(this).val() !== 'read')
          $('.nxline-reading').toggle($(this).val() === 'read')
        })
        .trigger('change')
      part('tags').on('nxline-shown', () => {
        fitTags(list)
        judge()
      })
      tabs(
        `nxline-${name}-tabs`,
        pages.map(page => [`nxline-${name}-${page}`, t(TABS[page])])
      )
    },
    /** oneditsave */
    save(node) {
      Object.assign(node, more(), { tags: tagRows(part('tag-list')) })
      done()
    },
    /** oneditresize */
    resize(size) {
      dialogHeight = size.height
      fitTags(part('tag-list'))
    }
  }
}

module.exports = { deviceDialog, field, fieldValue, sentences, value }
