'use strict'
const { isVariable } = require('./check')
const { PREFIX, device, deviceOf, deviceProperty, field, isItem, notation, tagOffers, value } = require('./form')
const { canOnlyBeRead, describe, deviceName, parseItem } = require('./model')
const { say, suggest } = require('./widgets')
const { errorText, t } = require('./texts')

/** What is written: the target, and how many outputs tell of it. */

const targetVerdict = text => {
  const named = deviceOf()
  const readOnly = named && named.access !== 'write' ? t('problem.readOnly', { plc: deviceName(named) }) : ''
  if (!text) return readOnly ? { says: readOnly, bad: true } : { says: t('editor.noTarget') }
  if (isVariable(text)) return { says: t('editor.variable') }
  try {
    const item = parseItem(text, notation())
    if (readOnly) return { says: readOnly, bad: true }
    return { says: describe(item, device(), { write: true }), bad: canOnlyBeRead(item, device()) }
  } catch (error) {
    return { says: errorText(error), bad: true }
  }
}

const judgeTarget = () => {
  const { says, bad } = targetVerdict(String(value('target') || '').trim())
  say($('#nxline-write-note'), says, bad)
}

const prepareWriting = () => {
  suggest(field('target'), tagOffers, isItem)
  $(`#${PREFIX}target, #${PREFIX}${deviceProperty()}`).on('input change', judgeTarget)
  field(deviceProperty()).on('change', () => field('target').trigger('change'))
  field('topic')
    .on('change', () => field('topicText').toggle(value('topic') === 'fixed'))
    .trigger('change')
  judgeTarget()
}

/** The second output is there only if failures go to it. */
const failureOutputs = () => (value('onFailure') === 'output' ? 1 : 0)

const writeLabel = node => node.target || ''

module.exports = { failureOutputs, prepareWriting, writeLabel }
