'use strict'

/**
 * Simulated stations in a process of their own, behind a virtual serial port that keeps the pace of its speed.
 * That process is this file: `node bench/far-end.js LINK SETTINGS`, settings of `createLine` as JSON.
 */
const { spawn } = require('node:child_process')
const { once } = require('node:events')
const { mkdtempSync, rmSync } = require('node:fs')
const os = require('node:os')
const path = require('node:path')
const { createLine, serveOnPty } = require('../lib/sim')

/**
 * @param {Record<string, any>} settings of `createLine`
 * @returns {Promise<{ link: string, close: () => Promise<void> }>} link: the port to open
 */
async function startFarEnd(settings) {
  const folder = mkdtempSync(path.join(os.tmpdir(), 'bench-'))
  const link = path.join(folder, 'line')
  const child = spawn(process.execPath, [__filename, link, JSON.stringify(settings)], {
    stdio: ['ignore', 'pipe', 'inherit']
  })
  const close = async () => {
    if (child.exitCode === null) {
      child.kill('SIGTERM')
      await once(child, 'exit')
    }
    rmSync(folder, { recursive: true, force: true })
  }
  const ended = once(child, 'exit').then(() => Promise.reject(new Error('the simulator ended')))
  ended.catch(() => {})
  try {
    await Promise.race([once(child.stdout, 'data'), ended])
  } catch (error) {
    await close()
    throw error
  }
  return { link, close }
}

if (require.main === module) {
  const [, , link, settings] = process.argv
  const { wire } = createLine(JSON.parse(settings))
  const server = serveOnPty({ wire, link })
  process.once('SIGTERM', () => {
    server.close()
    process.exit(0)
  })
  process.stdout.write('ready\n')
}

module.exports = { startFarEnd }
