'use strict'
const { planReads } = require('./reads')
const { planTableWrites, planTables } = require('./tables')
const { planWrites } = require('./writes')

module.exports = { planReads, planTableWrites, planTables, planWrites }
