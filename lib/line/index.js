'use strict'

const { realClock } = require('./clock')
const { latencyTimer } = require('./latency')
const { createPool } = require('./pool')
const { listPorts } = require('./ports')
const { PRIORITY } = require('./queue')
const { SETTINGS, lineSettings, wireKey } = require('./settings')
const timing = require('./timing')
const { timeoutFor } = require('./waits')

module.exports = {
  PRIORITY,
  SETTINGS,
  createPool,
  latencyTimer,
  lineSettings,
  listPorts,
  realClock,
  timeoutFor,
  wireKey,
  ...timing
}
