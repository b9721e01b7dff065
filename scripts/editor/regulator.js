'use strict'
const { deviceDialog, field } = require('./device')
const { deviceLabel } = require('./model')
const { addTemplate } = require('./tags')

/** The dialog of chino-config. */

const FIELDS = [
  ...[
    'name',
    'line',
    'station',
    'protocol',
    'timeout',
    'sendWait',
    'addressMode',
    'wordOrder',
    'broadcast',
    'turnaround'
  ],
  ...['coilRead', 'coilUnit', 'coilFunction', 'coilWrite', 'discreteRead', 'discreteUnit', 'inputRead'],
  ...['holdingRead', 'holdingFunction', 'holdingWrite']
]

const dialog = deviceDialog('chino', {
  type: 'chino-config',
  pages: ['regulator', 'tags', 'writing', 'details'],
  fields: FIELDS,
  judged: ['addressMode', 'wordOrder']
})

/** oneditprepare of chino-config. */
const editRegulatorConfig = node => {
  dialog.edit(node)
  $('#nxline-chino-template').on('click', () => addTemplate($('#nxline-chino-tag-list')))
  // whether station 0 is possible depends on it
  field('broadcast').on('change', () => field('station').trigger('change'))
  // and the data bits that are needed on the protocol
  field('line').on('change', () => field('protocol').trigger('change'))
}

const regulatorLabel = node => deviceLabel({ type: 'chino-config', station: node.station })

module.exports = {
  editRegulatorConfig,
  saveRegulatorConfig: dialog.save,
  resizeRegulatorConfig: dialog.resize,
  regulatorLabel
}
