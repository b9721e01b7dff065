'use strict'
const { createPool } = require('../lib/index.js')

/** @type {ReturnType<typeof createPool> | undefined} */
let pool

/** The one pool of this process: it survives deploys, and with it what was learnt about each wire. */
const sharedPool = () => (pool ??= createPool())

module.exports = { sharedPool }
