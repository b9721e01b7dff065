'use strict'
const { done } = require('./check')
const { field, openForm, reads, value, writes } = require('./form')
const { fitList, itemTexts, prepareReading, readLabel, resizeRead } = require('./reading')
const { failureOutputs, prepareWriting, writeLabel } = require('./writing')

/** The dialogs of the nodes of the flow. */

/** oneditprepare of nx-read. */
const editRead = node => {
  openForm('nx-read', node)
  prepareReading(node)
}

/** oneditsave of nx-read. */
const saveRead = node => {
  node.items = itemTexts()
  done()
}

/** oneditprepare of nx-write. */
const editWrite = node => {
  openForm('nx-write', node)
  prepareWriting()
}

/** oneditsave of nx-write. */
const saveWrite = node => {
  node.outputs = 1 + failureOutputs()
  done()
}

const showMode = () => {
  $('.nxline-reads').toggle(reads())
  $('.nxline-writes').toggle(writes())
  $('.nxline-both').toggle(value('mode') === 'both')
  // what counts depends on the mode: let it be judged again
  ;['itemsType', 'target', 'interval', 'report'].forEach(name => field(name).trigger('change'))
  fitList()
}

/** oneditprepare of chino-regulator. */
const editRegulator = node => {
  openForm('chino-regulator', node)
  prepareReading(node)
  prepareWriting()
  field('mode').on('change', showMode)
  showMode()
}

/** oneditsave of chino-regulator. */
const saveRegulator = node => {
  node.items = itemTexts()
  node.outputs = (reads() ? 1 : 0) + (writes() ? 1 + failureOutputs() : 0)
  done()
}

/** What an output of a chino-regulator gives: `values`, `confirmed` or `failed`. */
const outputRole = (mode, index) => {
  const roles = { read: ['values'], write: ['confirmed', 'failed'], both: ['values', 'confirmed', 'failed'] }
  return (roles[mode] || roles.read)[index]
}

/** The label of a chino-regulator without a name. */
const modeLabel = node => (node.mode === 'write' ? writeLabel(node) : readLabel(node))

module.exports = {
  editRead,
  saveRead,
  resizeRead,
  readLabel,
  editWrite,
  saveWrite,
  writeLabel,
  editRegulator,
  saveRegulator,
  modeLabel,
  outputRole
}
