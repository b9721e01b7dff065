'use strict'

const assert = require('node:assert/strict')
const path = require('node:path')
const manifest = require('../../package.json')
const { adminRoutes, mentions } = require('../support/routes')
const { testHandler } = require('../../nodes/test-read')

/** That they really refuse is shown with a real Node-RED in test/system/routes.test.js. */
describe('attack: admin routes', () => {
  it('each asks for a permission of ours; what touches a line or tells what is connected asks to write', () => {
    const routes = adminRoutes()
    assert.ok(routes.length >= 3)
    for (const { method, route, permission } of routes) {
      assert.match(route, /^\/(plc|nx|chino|melsec|incon)-[a-z-/]+$/, route)
      assert.equal(permission, method === 'GET' ? 'plc-line.read' : 'plc-line.write', `${method} ${route}`)
    }
  })

  it('none is registered but by the file of a node', () => {
    const files = Object.values(manifest['node-red'].nodes).map(file => path.basename(file))
    assert.deepEqual(
      mentions().filter(file => !files.includes(file)),
      []
    )
  })

  const RED = { nodes: { getNode: () => null, eachNode: () => {} } }
  const post = (type, body) =>
    new Promise(resolve => {
      let status = 200
      const response = {
        status: code => ((status = code), response),
        json: answer => resolve({ status, json: JSON.parse(JSON.stringify(answer)) })
      }
      testHandler(RED, type)({ body }, response)
    })

  const good = { station: '1', timeout: '50' }
  const BODIES = {
    nothing: undefined,
    null: null,
    text: '{"plc":{}}',
    list: [1, 2],
    'an empty object': {},
    'prototype keys': JSON.parse(
      '{"__proto__":{"plc":1},"plc":{"__proto__":{"station":"1"},"constructor":1},"line":{"__proto__":{"transport":"simulated"}}}'
    ),
    'objects as ids': { plc: { ...good, id: { toString: 1 } }, line: { id: ['a'], path: '/dev/ttyS0' } },
    'a file as path': { plc: good, line: { transport: 'serial', path: '/etc/passwd' } },
    'a path upwards': { plc: good, line: { transport: 'serial', path: '../../etc/passwd' } },
    'a device that is no port': { plc: good, line: { transport: 'serial', path: '/dev/null' } },
    'a zero byte': { plc: good, line: { transport: 'serial', path: '/dev/ttyS0\0' } },
    'a list as path': { plc: good, line: { transport: 'serial', path: ['/dev/ttyS0'] } },
    'an object as host': { plc: good, line: { transport: 'tcp', host: { a: 1 }, port: 1 } },
    'an absurd port': { plc: good, line: { transport: 'tcp', host: '127.0.0.1', port: 1e9 } },
    'an absurd station': { plc: { ...good, station: 1e99 }, line: { transport: 'simulated' } },
    'an absurd timeout': { plc: { ...good, timeout: -1 }, line: { transport: 'simulated' } },
    'tags that are none': { plc: { ...good, tags: { length: 1e9 } }, line: { transport: 'simulated' } },
    'a thousand deep': {
      plc: { ...good, tags: JSON.parse('['.repeat(1000) + ']'.repeat(1000)) },
      line: { transport: 'tcp' }
    }
  }
  for (const type of ['nx-config', 'chino-config']) {
    it(`${type}/test: whatever is posted, 400 with a code and a text`, async () => {
      for (const [name, body] of Object.entries(BODIES)) {
        const { status, json } = await post(type, body)
        assert.deepEqual([status, json.ok], [400, false], `${name}: ${JSON.stringify(json)}`)
        assert.match(json.error.code, /^[A-Z_]+$/, name)
        assert.ok(json.error.message.length < 1000, name)
      }
      assert.equal({}['plc'], undefined)
    })
  }
})
