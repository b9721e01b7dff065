'use strict'
const { done, open } = require('./check')
const { fillDefaults } = require('./widgets')

/** The dialog of plc-monitor. */

const PREFIX = 'node-input-'

/** oneditprepare. */
const editMonitor = node => {
  open(node, PREFIX)
  fillDefaults(node, PREFIX)
}

/** oneditsave: events, statistics, and frames where they are wanted. */
const saveMonitor = node => {
  node.outputs = $(`#${PREFIX}trace`).prop('checked') ? 3 : 2
  done()
}

module.exports = { editMonitor, saveMonitor }
