'use strict'

/** What the dialogs share; built into resources/editor.js as `nxlineSerialPlc` (scripts/build-editor.js). */
module.exports = {
  check: require('./check').check,
  done: require('./check').done,
  ...require('./line'),
  ...require('./plc'),
  ...require('./regulator'),
  ...require('./flow'),
  editListener: require('./listener').editListener,
  saveListener: require('./listener').saveListener,
  ...require('./monitor')
}
