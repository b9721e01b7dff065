'use strict'

/**
 * A real Node-RED in a process of its own, as users run it: started with red.js and a temporary user directory, deployed and
 * asked through its admin API. Which one is chosen by the environment, so that the same tests run on all:
 *   SERIAL_PLC_RED      folder of Node-RED (default: the development dependency)
 *   SERIAL_PLC_NODE     the Node.js that runs it (default: this one)
 *   SERIAL_PLC_PACKAGE  folder of our package (default: the repository; the system tests give the unpacked tarball)
 */

const { spawn } = require('node:child_process')
const fs = require('node:fs')
const { createRequire } = require('node:module')
const os = require('node:os')
const path = require('node:path')

const root = path.join(__dirname, '..', '..')
const { freePort } = require('../../examples/demo/ports.js')

const redFolder = () => process.env.SERIAL_PLC_RED || path.dirname(require.resolve('node-red/package.json'))
const nodeBinary = () => process.env.SERIAL_PLC_NODE || process.execPath
const packageFolder = () => process.env.SERIAL_PLC_PACKAGE || root

const SETTINGS = {
  lang: 'en-US',
  flowFile: 'flows.json',
  uiHost: '127.0.0.1',
  credentialSecret: 'test',
  telemetry: { enabled: false, updateNotification: false },
  diagnostics: { enabled: false, ui: false },
  logging: { console: { level: 'info', metrics: false, audit: false } },
  editorTheme: {
    tours: false,
    palette: { catalogues: [] },
    multiplayer: { enabled: false }
  }
}

/**
 * A temporary user directory with links to the packages that the flows need.
 * @param {{ settings?: object, modules?: Record<string, string>, product?: string }} [options] modules: package name -> its folder
 */
function makeUserDir({ settings = {}, modules = {}, product = packageFolder() } = {}) {
  const userDir = fs.mkdtempSync(path.join(os.tmpdir(), 'node-red-test-'))
  const all = { '@nxline/node-red-serial-plc': product, ...modules }
  for (const [name, folder] of Object.entries(all)) {
    const link = path.join(userDir, 'node_modules', name)
    fs.mkdirSync(path.dirname(link), { recursive: true })
    fs.symlinkSync(folder, link, 'junction')
  }
  fs.writeFileSync(path.join(userDir, 'package.json'), '{ "name": "test", "private": true }')
  fs.writeFileSync(
    path.join(userDir, 'settings.js'),
    `module.exports = ${JSON.stringify({ ...SETTINGS, ...settings }, null, 2)}`
  )
  return userDir
}

/** A node without a place would count as a configuration node: gives one to all that lie on a tab. */
const placed = flow => flow.map(node => (node.z ? { x: 100, y: 100, ...node } : node))

async function until(check, { what, patience = 20000, every = 20 }) {
  const end = Date.now() + patience
  for (;;) {
    const found = await check()
    if (found !== undefined && found !== false && found !== null) return found
    if (Date.now() > end)
      throw new Error(`waited ${patience} ms in vain for ${typeof what === 'function' ? what() : what}`)
    await new Promise(resolve => setTimeout(resolve, every))
  }
}

/** The editor's web socket: debug messages and statuses as the sidebar sees them. */
async function listen(url) {
  const WebSocket = createRequire(require.resolve('mqtt'))('ws')
  const socket = new WebSocket(`${url.replace('http', 'ws')}/comms`)
  const debug = []
  const status = new Map()
  socket.on('message', data => {
    for (const { topic, data: body } of [JSON.parse(data.toString())].flat()) {
      if (topic === 'debug') debug.push({ id: body.id, value: valueOf(body), message: body })
      else if (topic?.startsWith('status/')) status.set(topic.slice(7), body)
    }
  })
  await new Promise((resolve, reject) => socket.once('open', resolve).once('error', reject))
  socket.send(JSON.stringify({ subscribe: 'debug' }))
  socket.send(JSON.stringify({ subscribe: 'status/#' }))
  const close = () => new Promise(resolve => socket.once('close', resolve).close())
  return { debug, status, close }
}

/** A debug message's value as it was: the runtime sends objects as JSON text. */
function valueOf({ format, msg }) {
  if (/^(Object|array|buffer|error)/i.test(format)) return JSON.parse(msg)
  if (format === 'number') return Number(msg)
  if (format === 'boolean') return msg === 'true' || msg === true
  return msg
}

/**
 * @param {{ red?: string, node?: string, product?: string, settings?: object, modules?: Record<string, string>, flow?: object[],
 *   env?: object, probe?: boolean, flags?: string[] }} [options] flags: of Node.js; red, node, product: as the variables above; probe: `count()` works
 * @returns {Promise<Runtime>}
 */
async function startNodeRed(options = {}) {
  const { red = redFolder(), settings, flow } = options
  const userDir = makeUserDir(options)
  if (flow) fs.writeFileSync(path.join(userDir, 'flows.json'), JSON.stringify(flow))
  const port = await freePort(0)
  const child = spawnRed(options, [path.join(red, 'red.js'), '-u', userDir, '-p', String(port)])
  let log = ''
  child.stdout?.on('data', bytes => (log += bytes))
  child.stderr?.on('data', bytes => (log += bytes))
  const exited = new Promise(resolve => child.once('exit', resolve))
  const url = `http://127.0.0.1:${port}`
  const remove = () => fs.rmSync(userDir, { recursive: true, force: true })
  const ended = () => child.exitCode !== null || child.signalCode !== null
  const up = () => /Started flows|missing types/.test(log) && /now running at/.test(log)
  let comms = null
  try {
    await until(() => up() || ended(), { what: () => `Node-RED:\n${log}` })
    if (ended()) throw new Error(`Node-RED ended:\n${log}`)
    if (!settings || !('adminAuth' in settings)) comms = await listen(url)
  } catch (error) {
    child.kill('SIGKILL')
    remove()
    throw error
  }
  const stop = async () => {
    await comms?.close()
    child.kill('SIGTERM')
    const late = setTimeout(() => child.kill('SIGKILL'), 15000)
    await exited
    clearTimeout(late)
    remove()
    return child.signalCode === 'SIGKILL' ? 'killed' : 'ended'
  }
  return { url, userDir, child, stop, log: () => log, ...api(url), ...watching(comms), count: () => countIn(child) }
}

function spawnRed({ node = nodeBinary(), env = {}, probe = false, flags = [] }, args) {
  const preload = probe ? ['--expose-gc', '--require', path.join(__dirname, 'probe.js')] : []
  return spawn(node, [...flags, ...preload, ...args], {
    cwd: args[2],
    env: { ...process.env, ...env },
    stdio: ['ignore', 'pipe', 'pipe', probe ? 'ipc' : 'ignore']
  })
}

/** What the process has open (support/probe.js): by type of handle, file descriptors, listeners of the process, heap. */
const countIn = child =>
  new Promise(resolve => {
    child.once('message', resolve)
    child.send('count')
  })

const ignoreMissing = error => {
  if (!/: 404 /.test(error.message)) throw error
  return false
}

function api(url) {
  const ask = async (method, where, body, headers = {}) => {
    const answer = await fetch(url + where, {
      method,
      headers: {
        'content-type': 'application/json',
        accept: 'application/json',
        'Node-RED-API-Version': 'v2',
        ...headers
      },
      body: body === undefined ? undefined : JSON.stringify(body)
    })
    const text = await answer.text()
    if (!answer.ok) throw new Error(`${method} ${where}: ${answer.status} ${text}`)
    return text && /json/.test(answer.headers.get('content-type')) ? JSON.parse(text) : text
  }
  return {
    ask,
    /** @param {object[]} flows @param {'full'|'nodes'|'flows'|'reload'} [type] */
    deploy: (flows, type = 'full') => ask('POST', '/flows', { flows }, { 'Node-RED-Deployment-Type': type }),
    // a deploy answers before the new nodes have been made
    inject: id =>
      until(() => ask('POST', `/inject/${id}`, {}).then(() => true, ignoreMissing), { what: `inject ${id}` })
  }
}

function watching(comms) {
  if (!comms) return {}
  let taken = 0
  return {
    debug: comms.debug,
    status: comms.status,
    /** Forget what came so far. */
    forget: () => {
      taken = comms.debug.length
    },
    /** The next message of a debug node (or of any) that satisfies `is`, after the last `forget`. */
    next: (id, is = _value => true, patience = 10000) =>
      until(() => comms.debug.slice(taken).find(it => (!id || it.id === id) && is(it.value)), {
        what: () =>
          `a message of ${id}; seen: ${JSON.stringify(comms.debug.slice(-5).map(it => [it.id, it.value])).slice(0, 1500)}`,
        patience
      }).then(it => it.value)
  }
}

/**
 * @typedef {object} Runtime
 * @property {string} url of editor and admin API
 * @property {string} userDir
 * @property {import('node:child_process').ChildProcess} child
 * @property {() => Promise<'ended'|'killed'>} stop ends it and removes its user directory
 * @property {() => string} log what it has printed
 * @property {(method: string, where: string, body?: unknown, headers?: object) => Promise<any>} ask
 * @property {(flows: object[], type?: string) => Promise<any>} deploy
 * @property {(id: string) => Promise<any>} inject presses an inject node's button
 * @property {() => Promise<any>} count only with `probe`
 * @property {(id: string, is?: (value: any) => boolean, patience?: number) => Promise<any>} next
 */

module.exports = { startNodeRed, makeUserDir, placed, until, redFolder, nodeBinary, packageFolder }
