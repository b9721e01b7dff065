'use strict'

/** The packed product in both Node-REDs: it loads, its types are there, its routes are guarded, a thousand redeploys leave nothing. */

const assert = require('node:assert/strict')
const { execFileSync } = require('node:child_process')
const fs = require('node:fs')
const path = require('node:path')
const { startNodeRed } = require('../support/node-red.js')
const { redeploys } = require('../support/redeploys.js')
const { packedProduct, RUNTIMES, modules } = require('./support.js')
const manifest = require('../../package.json')

const TYPES = Object.keys(manifest['node-red'].nodes)
const ROUNDS = Number(process.env.SERIAL_PLC_REDEPLOYS || 1000)

// bcrypt of "secret", from node-red-admin's own library
const hash = () =>
  require(require.resolve('bcryptjs', { paths: [modules, path.dirname(require.resolve('node-red'))] })).hashSync(
    'secret',
    4
  )

for (const { name, red, node, red_, node_ } of RUNTIMES) {
  describe(name, function () {
    this.timeout(600000)
    let product
    before(() => {
      product = packedProduct()
    })

    it('is what it says', () => {
      assert.match(JSON.parse(fs.readFileSync(path.join(red, 'package.json'), 'utf8')).version, red_)
      assert.match(execFileSync(node, ['--version'], { encoding: 'utf8' }), node_)
    })

    it('registers every type of the packed product, without an error', async () => {
      const runtime = await startNodeRed({ red, node, product })
      try {
        const sets = (await runtime.ask('GET', '/nodes')).filter(set => set.module === manifest.name)
        assert.deepEqual(sets.flatMap(set => set.types).toSorted(), TYPES.toSorted())
        for (const set of sets) assert.deepEqual([set.err, set.enabled], [undefined, true], set.name)
        const html = await runtime.ask('GET', '/nodes', undefined, { accept: 'text/html' })
        for (const type of TYPES) assert.ok(html.includes(`data-help-name="${type}"`), `help of ${type}`)
        const editor = await fetch(`${runtime.url}/resources/${manifest.name}/editor.js`)
        assert.equal(editor.status, 200)
        assert.doesNotMatch(runtime.log(), /\[error\]|\[warn\].*nxline|missing/i)
      } finally {
        assert.equal(await runtime.stop(), 'ended')
      }
    })

    it('imports every example without a missing type', async () => {
      const extra = Object.fromEntries(
        ['node-red-contrib-influxdb', 'node-red-node-sqlite'].map(it => [it, path.join(modules, it)])
      )
      const folder = path.join(product, 'examples')
      const flows = fs.readdirSync(folder).flatMap(file => JSON.parse(fs.readFileSync(path.join(folder, file), 'utf8')))
      const runtime = await startNodeRed({ red, node, product, modules: extra, flow: flows })
      try {
        assert.doesNotMatch(runtime.log(), /missing types/)
        const known = new Set((await runtime.ask('GET', '/nodes')).flatMap(set => set.types))
        const builtIn = ['tab', 'group', 'subflow']
        assert.deepEqual(
          flows.map(it => it.type).filter(type => !known.has(type) && !builtIn.includes(type)),
          []
        )
      } finally {
        await runtime.stop()
      }
    })

    it('answers 401 without a token, and lists the ports with one', async () => {
      const users = [{ username: 'admin', password: hash(), permissions: '*' }]
      const runtime = await startNodeRed({
        red,
        node,
        product,
        settings: { adminAuth: { type: 'credentials', users } }
      })
      try {
        const routes = [
          ['GET', '/plc-line/ports'],
          ['POST', '/nx-config/test']
        ]
        for (const [method, route] of routes) {
          const { status } = await fetch(runtime.url + route, { method })
          assert.equal(status, 401, route)
        }
        const login = {
          client_id: 'node-red-admin',
          grant_type: 'password',
          scope: '*',
          username: 'admin',
          password: 'secret'
        }
        const { access_token: token } = await runtime.ask('POST', '/auth/token', login)
        const { ports } = await runtime.ask('GET', '/plc-line/ports', undefined, { authorization: `Bearer ${token}` })
        assert.ok(Array.isArray(ports))
      } finally {
        await runtime.stop()
      }
    })

    // a thousand on one, a tenth on the other: the code is the same, the runtime's part differs
    const rounds = red_.test('4.1.0') ? ROUNDS : Math.ceil(ROUNDS / 10)
    it(`${rounds} redeploys and reconnects leave no port, timer, listener or descriptor behind`, async () => {
      const done = await redeploys({ rounds, red, node, product })
      assert.equal(done.rounds, rounds)
      assert.ok(done.connections > rounds / 4, `only ${done.connections} connections`)
    })
  })
}
