'use strict'
const path = require('node:path')
const { createPool } = require('../lib/index.js')

/** @type {ReturnType<typeof createPool> | undefined} */
let pool
let folder = ''

/** Where the frames around each fault are kept. @param {string | undefined} userDir of the runtime */
const keepEvidence = userDir => {
  folder = typeof userDir === 'string' && userDir !== '' ? path.join(userDir, 'serial-plc') : ''
}

/** The one pool of this process: it survives deploys, and with it what was learnt about each wire. */
const sharedPool = () => (pool ??= createPool({ evidence: { folder: () => folder } }))

module.exports = { keepEvidence, sharedPool }
