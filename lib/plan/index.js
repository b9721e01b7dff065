'use strict'
const { planReads } = require('./reads')
const { planWrites } = require('./writes')

module.exports = { planReads, planWrites }
