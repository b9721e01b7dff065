'use strict'

const fs = require('node:fs')
const http = require('node:http')
const { createRequire } = require('node:module')
const os = require('node:os')
const path = require('node:path')
const { HOST } = require('./ports')

const root = path.join(__dirname, '..', '..')

/** Nothing goes out: no telemetry, no update checks, no catalogues, no tours. */
const settings = userDir => ({
  userDir,
  flowFile: 'flows.json',
  uiHost: HOST,
  httpAdminRoot: '/',
  httpNodeRoot: '/',
  credentialSecret: false,
  telemetry: { enabled: false, updateNotification: false },
  diagnostics: { enabled: false, ui: false },
  logging: { console: { level: 'error', metrics: false, audit: false } },
  functionExternalModules: false,
  editorTheme: {
    tours: false,
    page: { title: 'Serial PLC demo' },
    header: { title: 'Serial PLC demo' },
    palette: { catalogues: [], categories: ['serial_PLC', 'dashboard_2', 'common', 'function', 'network'] },
    multiplayer: { enabled: false }
  }
})

/** A temporary user directory that holds the flow, and this package as if it had been installed there. */
function makeUserDir(flow) {
  const userDir = fs.mkdtempSync(path.join(os.tmpdir(), 'serial-plc-demo-'))
  const scope = path.join(userDir, 'node_modules', '@nxline')
  fs.mkdirSync(scope, { recursive: true })
  fs.symlinkSync(root, path.join(scope, 'node-red-serial-plc'), 'junction')
  fs.writeFileSync(
    path.join(userDir, 'package.json'),
    JSON.stringify({ name: 'demo', private: true, version: '0.0.0' })
  )
  fs.writeFileSync(path.join(userDir, 'flows.json'), JSON.stringify(flow, null, 2))
  return userDir
}

/**
 * Node-RED in this process, with a flow.
 * @param {{ port: number, flow: object[] }} options
 * @returns {Promise<{ url: string, close(): Promise<void> }>}
 */
async function startRuntime({ port, flow }) {
  const RED = require('node-red')
  const express = createRequire(require.resolve('node-red'))('express')
  const userDir = makeUserDir(flow)
  const app = express()
  const server = http.createServer(app)
  RED.init(server, { ...settings(userDir), uiPort: port })
  app.use('/', RED.httpAdmin)
  app.use('/', RED.httpNode)
  await new Promise((resolve, reject) => {
    server.once('error', reject)
    server.listen(port, HOST, () => resolve(undefined))
  })
  await RED.start()
  const close = async () => {
    await RED.stop()
    server.closeAllConnections()
    await new Promise(resolve => server.close(resolve))
    fs.rmSync(userDir, { recursive: true, force: true })
  }
  return { url: `http://${HOST}:${port}`, close }
}

module.exports = { startRuntime }
