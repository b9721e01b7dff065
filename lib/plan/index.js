'use strict'
const { loadOf } = require('./prediction')
const { planReads, servedValues } = require('./reads')
const { planTableWrites, planTables } = require('./tables')
const { together } = require('./together')
const { planWrites } = require('./writes')

module.exports = { loadOf, planReads, planTableWrites, planTables, planWrites, servedValues, together }
