'use strict'

const fs = require('node:fs')
const path = require('node:path')

const nodes = path.join(__dirname, '..', '..', 'nodes')
const METHODS = ['get', 'post', 'put', 'patch', 'delete', 'head', 'options', 'all', 'use']

/**
 * Every admin route that our nodes register, found by letting them register it.
 * @returns {{ method: string, route: string, permission: string|null }[]} permission: null if the route asks for none
 */
const adminRoutes = () => {
  const routes = []
  const record = method => (route, guard) =>
    routes.push({ method: method.toUpperCase(), route, permission: guard?.permission ?? null })
  const RED = {
    httpAdmin: Object.fromEntries(METHODS.map(method => [method, record(method)])),
    auth: { needsPermission: permission => Object.assign(() => {}, { permission }) },
    nodes: { registerType() {} },
    events: { on() {}, off() {}, once() {} },
    settings: {}
  }
  const { 'node-red': own } = require('../../package.json')
  for (const file of Object.values(own.nodes)) require(path.join(nodes, path.basename(file)))(RED)
  return routes
}

/** Files that mention the admin server: none may register a route anywhere else. */
const mentions = () =>
  fs
    .readdirSync(nodes)
    .filter(file => file.endsWith('.js') && /httpAdmin|httpNode/.test(fs.readFileSync(path.join(nodes, file), 'utf8')))

module.exports = { adminRoutes, mentions }
