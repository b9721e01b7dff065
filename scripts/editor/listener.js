'use strict'
const { done, open } = require('./check')
const { fillDefaults, say, tabs } = require('./widgets')
const { t } = require('./texts')

/** The dialogs of melsec-c24 and incon-link. */

const PREFIX = 'node-input-'
const field = name => $(`#${PREFIX}${name}`)
const value = name => field(name).val()
const isTicked = name => field(name).prop('checked')

const PAGES = {
  messages: 'tab.messages',
  sending: 'tab.sending',
  details: 'tab.details'
}

const NAMES = { '0D': 'CR', '0A': 'LF', '02': 'STX', '03': 'ETX', '04': 'EOT', 10: 'DLE', '00': 'NUL' }

/** "CR LF" for "0D 0A" */
const bytesByName = text =>
  (
    String(text)
      .toUpperCase()
      .match(/[0-9A-F]{2}/g) || []
  )
    .map(byte => NAMES[byte] || `${byte}h`)
    .join(' ')

const noteEnd = () => {
  const name = bytesByName(value('end'))
  say($('#nxline-c24-end'), name ? t('editor.ends', { name }) : t('editor.noEnd'), !name && !value('last'))
}

const showC24 = () => {
  const twoWay = isTicked('bidirectional')
  const framing = value('framing')
  $('.nxline-two-way').toggle(twoWay)
  $('.nxline-free').toggle(!twoWay)
  $('#nxline-c24-gap').text(t(twoWay ? 'editor.gapAuto' : framing === 'gap' ? 'editor.gapEnds' : 'editor.gapTorn'))
  for (const each of ['end', 'count']) $(`.nxline-framing-${each}`).toggle(!twoWay && framing === each)
  $('.nxline-text').toggle(value('format') === 'text')
  $('.nxline-words').toggle(value('format') === 'words' || twoWay)
  $('.nxline-dc').toggle(value('flow') === 'dc')
  $('.nxline-driver').toggle(value('flow') === 'driver')
  $('.nxline-held').toggle(value('flow') !== 'none')
}

const showLink = () => {
  const checked = isTicked('checked')
  // what cannot be without it must not stay behind it
  if (!checked) field('acknowledge').prop('checked', false)
  const acks = isTicked('acknowledge')
  $('.nxline-checked').toggle(checked)
  $('.nxline-acks').toggle(acks)
  // acknowledgements are sent, too
  $('.nxline-pauses').toggle(acks || value('access') !== 'read')
}

const SHOW = { 'melsec-c24': showC24, 'incon-link': showLink }

/** What the access leaves, last: it hides what the others have shown. */
const showAccess = () => {
  const sends = value('access') !== 'read'
  if (!sends) $('.nxline-sends').hide()
  else $('.nxline-sends').not('.nxline-free, .nxline-two-way').show()
  $('.nxline-silent').toggle(!sends)
}

const COUNTS = ['end', 'count', 'gap', 'flow']

/** oneditprepare of both. */
const editListener = node => {
  const { type } = node
  open(node, PREFIX)
  fillDefaults(node, PREFIX)
  const show = () => {
    SHOW[type]()
    showAccess()
  }
  const deciding = ['bidirectional', 'framing', 'format', 'flow', 'checked', 'acknowledge', 'access']
  for (const name of deciding) field(name).on('change', show)
  // what counts depends on them: let the others be judged again
  for (const name of ['bidirectional', 'framing'])
    field(name).on('change', () => COUNTS.forEach(each => field(each).trigger('change')))
  if (type === 'melsec-c24') {
    $('#node-input-end, #node-input-last').on('input change', noteEnd)
    noteEnd()
  }
  const pages = Object.keys(PAGES).filter(page => $(`#nxline-${type}-${page}`).length > 0)
  tabs(
    `nxline-${type}-tabs`,
    pages.map(page => [`nxline-${type}-${page}`, t(PAGES[page])])
  )
  show()
}

/** oneditsave of both: received, sent, not sent. */
const saveListener = node => {
  const sends = value('access') !== 'read'
  node.outputs = sends ? 2 + (value('onFailure') === 'output' ? 1 : 0) : 1
  done()
}

module.exports = { bytesByName, editListener, saveListener }
