'use strict'

/** A real Node-RED with users: every admin route of the packed product refuses whoever has no permission. */

const assert = require('node:assert/strict')
const path = require('node:path')
const { startNodeRed } = require('../support/node-red.js')
const { adminRoutes } = require('../support/routes.js')
const { packedProduct, RUNTIMES, modules } = require('./support.js')

// of node-red-admin's own library
const hash = () =>
  require(require.resolve('bcryptjs', { paths: [modules, path.dirname(require.resolve('node-red'))] })).hashSync(
    'secret',
    4
  )

const USERS = [
  { username: 'admin', permissions: '*' },
  { username: 'reader', permissions: 'read' },
  { username: 'ports', permissions: ['plc-line.read'] },
  { username: 'flows', permissions: ['flows.read', 'flows.write', 'nodes.read'] }
]

for (const { name, red, node } of RUNTIMES) {
  describe(`${name}: admin routes`, function () {
    this.timeout(60000)
    let runtime
    const tokens = {}
    before(async () => {
      const password = hash()
      const users = USERS.map(user => ({ ...user, password }))
      const settings = { adminAuth: { type: 'credentials', users } }
      runtime = await startNodeRed({ red, node, product: packedProduct(), settings })
      for (const { username } of USERS) {
        const login = { client_id: 'node-red-admin', grant_type: 'password', scope: '', username, password: 'secret' }
        tokens[username] = (await runtime.ask('POST', '/auth/token', login)).access_token
      }
    })
    after(() => runtime?.stop())

    const status = async ({ method, route }, authorization) => {
      const headers = { 'content-type': 'application/json', ...(authorization ? { authorization } : {}) }
      const body = method === 'GET' ? undefined : '{}'
      return (await fetch(runtime.url + route, { method, headers, body })).status
    }
    const refused = [401, 403]

    it('refuse who has no token, a false one, or none of their permissions', async () => {
      const routes = adminRoutes()
      assert.ok(routes.length >= 3)
      for (const each of routes) {
        for (const token of [undefined, 'Bearer false', `Basic ${btoa('admin:secret')}`, `Bearer ${tokens.flows}`]) {
          const got = await status(each, token)
          assert.ok(refused.includes(got), `${each.method} ${each.route} with ${token}: ${got}`)
        }
      }
    })

    it('who may only read reads, and touches no line', async () => {
      for (const each of adminRoutes()) {
        for (const user of ['reader', 'ports']) {
          const got = await status(each, `Bearer ${tokens[user]}`)
          const may = each.permission === 'plc-line.read'
          assert.ok(
            may ? !refused.includes(got) : refused.includes(got),
            `${each.method} ${each.route}, ${user}: ${got}`
          )
        }
        assert.ok(!refused.includes(await status(each, `Bearer ${tokens.admin}`)), each.route)
      }
    })
  })
}
