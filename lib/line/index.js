'use strict'

const { realClock } = require('./clock')
const { createPool } = require('./pool')
const { listPorts } = require('./ports')
const { PRIORITY } = require('./queue')
const { SETTINGS, lineSettings, wireKey } = require('./settings')
const timing = require('./timing')

module.exports = { PRIORITY, SETTINGS, createPool, lineSettings, listPorts, realClock, wireKey, ...timing }
