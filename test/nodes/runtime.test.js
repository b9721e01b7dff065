'use strict'
const assert = require('node:assert/strict')
const os = require('node:os')
const { createRequire } = require('node:module')
const { startNodeRed } = require('../support/node-red')
const { openWire } = require('./bench')
const { TYPES } = require('./dialogs')
const { freePort } = require('../../examples/demo/ports.js')

// Node-RED's own
const bcrypt = createRequire(require.resolve('node-red/package.json'))('bcryptjs')

/** What the test helper does not show: the catalogue, the admin routes behind a login, the editor's files; in a real Node-RED. */

const PASSWORD = bcrypt.hashSync('password', 4)
const USERS = [
  { username: 'admin', password: PASSWORD, permissions: '*' },
  { username: 'reader', password: PASSWORD, permissions: 'plc-line.read' }
]

describe('nodes in a real Node-RED', function () {
  this.timeout(30000)
  let red
  let wire
  const tokens = {}

  const call = async (method, where, { user, body } = {}) => {
    const answer = await fetch(red.url + where, {
      method,
      headers: {
        'content-type': 'application/json',
        ...(user ? { authorization: `Bearer ${tokens[user]}` } : {})
      },
      body: body === undefined ? undefined : JSON.stringify(body)
    })
    const text = await answer.text()
    return {
      status: answer.status,
      text,
      json: /json/.test(answer.headers.get('content-type')) ? JSON.parse(text) : null
    }
  }
  const login = async (username, scope) => {
    const body = { client_id: 'node-red-admin', grant_type: 'password', scope, username, password: 'password' }
    tokens[username] = (await call('POST', '/auth/token', { body })).json.access_token
  }

  before(async () => {
    wire = await openWire({ stations: [1] })
    wire.plcs[0].set('M0', 4711)
    const at = { z: 'tab', x: 1, y: 1 }
    const flow = [
      { id: 'tab', type: 'tab', label: 'test' },
      { id: 'line', type: 'plc-line', transport: 'tcp', host: '127.0.0.1', port: '${LINE_PORT}', baudRate: '115200' },
      { id: 'plc', type: 'nx-config', name: 'Oven', line: 'line', station: 1, timeout: 300 },
      { id: 'sim', type: 'plc-line', transport: 'simulated' },
      { id: 'simplc', type: 'nx-config', line: 'sim', station: '${NOWHERE}' },
      { id: 'read', type: 'nx-read', ...at, plc: 'plc', items: ['M0'], interval: 100, wires: [[]] },
      { id: 'bad', type: 'nx-read', ...at, plc: 'simplc', items: ['M0'], wires: [[]] }
    ]
    const settings = { adminAuth: { type: 'credentials', users: USERS } }
    red = await startNodeRed({ settings, flow, env: { LINE_PORT: String(wire.port) } })
    await login('admin', '*')
    await login('reader', 'plc-line.read')
  })
  after(async () => {
    await red?.stop()
    await wire?.close()
  })

  it('loads all types without a warning', async () => {
    const { json } = await call('GET', '/nodes', { user: 'admin' }).then(async ({ status }) => {
      assert.equal(status, 200)
      const answer = await fetch(`${red.url}/nodes`, {
        headers: { authorization: `Bearer ${tokens.admin}`, accept: 'application/json' }
      })
      return { json: await answer.json() }
    })
    const own = json.filter(({ module }) => module === '@nxline/node-red-serial-plc')
    assert.deepEqual(own.flatMap(({ types }) => types).sort(), [...TYPES].sort())
    assert.ok(own.every(({ enabled, err }) => enabled && !err))
  })

  it('the errors of a configuration stand in the log, with the variable that is missing', () => {
    assert.match(red.log(), /environment variable NOWHERE that station refers to is not set/)
  })

  it('the dialogs load what they need', async () => {
    const script = await call('GET', '/resources/@nxline/node-red-serial-plc/editor.js')
    assert.equal(script.status, 200)
    assert.match(script.text, /nxlineSerialPlc/)
    const korean = await call('GET', '/locales/@nxline/node-red-serial-plc/nx-read?lng=ko', { user: 'admin' })
    assert.equal(korean.json['nx-read'].label.name, '이름')
    const icon = await call('GET', '/icons/@nxline/node-red-serial-plc/nx-plc-read.svg')
    assert.equal(icon.status, 200)
  })

  it('ports: 401 without a token, a list with one', async () => {
    assert.equal((await call('GET', '/plc-line/ports')).status, 401)
    const { status, json } = await call('GET', '/plc-line/ports', { user: 'reader' })
    assert.equal(status, 200)
    assert.ok(Array.isArray(json.ports))
  })

  it('test: 401 without a token, 403 or 401 with the right to read only', async () => {
    assert.equal((await call('POST', '/nx-config/test', { body: {} })).status, 401)
    assert.ok([401, 403].includes((await call('POST', '/nx-config/test', { user: 'reader', body: {} })).status))
  })

  const tcp = more => ({
    id: 'line',
    transport: 'tcp',
    host: '127.0.0.1',
    port: '${LINE_PORT}',
    baudRate: '115200',
    ...more
  })
  const plc = more => ({ id: 'plc', name: 'Oven', line: 'line', station: '1', timeout: '300', ...more })
  const test = body => call('POST', '/nx-config/test', { user: 'admin', body })

  it('test of the deployed PLC uses its line', async () => {
    const { status, json } = await test({ plc: plc(), line: tcp() })
    assert.equal(status, 200)
    const { ms, rows, ...answer } = json
    assert.deepEqual(answer, { ok: true, station: 1, item: 'M0', value: 4711, cause: null })
    assert.equal(rows.find(({ id }) => id === 'prefixDiagnosis').value, 1)
    assert.ok(ms >= 0 && ms < 2000)
    assert.equal(wire.connections(), 1)
  })

  it('test of a station that is not there', async () => {
    const { json } = await test({ plc: plc({ station: 9, timeout: 100 }), line: tcp() })
    assert.equal(json.ok, false)
    assert.equal(json.reached, false)
    assert.equal(json.error.code, 'TIMEOUT')
  })

  it('test of a PLC that answers, but not this: reached', async () => {
    const body = { plc: plc({ tags: [{ name: 'far', address: '@0x0F00' }] }), line: tcp() }
    const { json } = await test(body)
    assert.equal(json.ok, false)
    assert.equal(json.reached, true)
    assert.equal(json.error.code, 'PLC_OUT_OF_RANGE')
  })

  it('test of a new line, not deployed: over TCP, simulated', async () => {
    const another = await openWire({ stations: [3] })
    const line = { id: 'new', transport: 'tcp', host: '127.0.0.1', port: another.port, baudRate: 115200 }
    assert.equal((await test({ plc: plc({ station: 3, line: 'new' }), line })).json.ok, true)
    await another.close()
    const simulated = { id: 'new', transport: 'simulated' }
    assert.equal((await test({ plc: plc({ station: 5, line: 'new' }), line: simulated })).json.ok, true)
  })

  it('test of a port that nothing listens on says so', async () => {
    const port = await freePort(0)
    const { json } = await test({
      plc: plc({ line: 'new' }),
      line: { id: 'new', transport: 'tcp', host: '127.0.0.1', port }
    })
    assert.equal(json.error.code, 'CONNECT_FAILED')
  })

  it('test of a port that is neither deployed nor listed: the dialog can say that it must be deployed first', async () => {
    const line = { id: 'new', transport: 'serial', path: '/dev/tty-nowhere' }
    const { status, json } = await test({ plc: plc({ line: 'new' }), line })
    assert.equal(status, 400)
    assert.equal(json.error.details.deployFirst, true)
    assert.equal(json.error.details.value, '/dev/tty-nowhere')
  })

  for (const [what, body] of [
    ['nothing', undefined],
    ['an array', []],
    ['no line', { plc: plc() }],
    ['a number as PLC', { plc: 5, line: 7 }],
    ['any file as port', { plc: plc({ line: 'new' }), line: { id: 'new', transport: 'serial', path: '/etc/passwd' } }],
    [
      'a path with dots',
      { plc: plc({ line: 'new' }), line: { id: 'new', transport: 'serial', path: '/dev/../etc/passwd' } }
    ],
    ['an absurd id', { plc: { ...plc(), id: '__proto__' }, line: { id: 'constructor', transport: 'serial' } }],
    ['a station of masters', { plc: plc({ station: 200 }), line: tcp() }],
    ['a variable that only the server knows', { plc: plc({ line: 'new' }), line: tcp({ id: 'new', host: '${HOME}' }) }]
  ]) {
    it(`test with ${what}: 400 and an error in JSON`, async () => {
      const { status, json } = await test(body)
      assert.equal(status, 400)
      assert.equal(json.ok, false)
      assert.match(json.error.code, /^[A-Z_]+$/)
      for (const secret of ['root:', os.homedir()]) assert.ok(!json.error.message.includes(secret), json.error.message)
    })
  }
})
