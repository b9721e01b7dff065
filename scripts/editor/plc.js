'use strict'
const { areaMap } = require('../../lib/codec/nx/areas')
const { areaTable } = require('./areas')
const { deviceDialog } = require('./device')
const { attempt, deviceLabel } = require('./model')
const { rowsOf } = require('./table')
const { t } = require('./texts')

/** The dialog of nx-config. */

const areaRows = () => rowsOf($('#nxline-nx-area-list')).filter(row => row.area)

const dialog = deviceDialog('nx', {
  type: 'nx-config',
  pages: ['plc', 'tags', 'writing', 'details'],
  fields: ['name', 'line', 'station', 'steps', 'timeout', 'masterIds'],
  more: () => ({ areas: areaRows() }),
  judged: ['steps']
})

const noteAreas = () => {
  const map = attempt(() => areaMap(areaRows()), null)
  if (!map) return
  const names = sure => map.list.filter(row => (row.certainty === 'unconfirmed') === sure).map(row => row.area)
  $('#nxline-nx-area-note').text(
    t('editor.areaNote', { sure: names(false).join(', '), unsure: names(true).join(', ') || '–' })
  )
}

/** oneditprepare of nx-config. */
const editPlc = node =>
  dialog.edit(node, () => {
    areaTable($('#nxline-nx-area-list'), node.areas, noteAreas)
    noteAreas()
  })

const plcLabel = node => deviceLabel({ type: 'nx-config', station: node.station })

module.exports = { editPlc, savePlc: dialog.save, resizePlc: dialog.resize, plcLabel }
