'use strict'
const { PlcError, createNxPlc } = require('../lib')
const { readSettings } = require('./settings')
const { deviceSettings } = require('./device-settings')
const { testHandler } = require('./test-read')

/**
 * The device of a configuration: made for its first user, given back with its last.
 * @param {any} plc the config node
 */
const deviceHolder = plc => {
  const users = new Map()
  let open = null
  let closing = Promise.resolve()

  const make = () => {
    const lease = plc.lineNode.lease({ id: plc.id, name: plc.name || plc.id })
    try {
      const device = createNxPlc({ lease, ...deviceSettings(plc) })
      lease.on('state', (state, reason) => users.forEach(tell => tell({ state, reason })))
      return { lease, device }
    } catch (error) {
      lease.release()
      throw error
    }
  }

  const release = () => {
    if (!open) return closing
    const { lease, device } = open
    open = null
    closing = Promise.resolve(device.close()).then(() => lease.release())
    return closing
  }

  return {
    /** @param {any} node on a tab @param {(line: { state: string, reason: any }) => void} tell */
    attach(node, tell) {
      plc.users[node.id] = node
      if (plc.lineNode) plc.lineNode.users[node.id] = node
      if (plc.fault) throw plc.fault
      open ??= make()
      users.set(node, tell)
      tell({ state: open.lease.line.state, reason: open.lease.line.reason })
      return open.device
    },
    detach(node) {
      users.delete(node)
      if (plc.users[node.id] === node) delete plc.users[node.id]
      if (plc.lineNode?.users[node.id] === node) delete plc.lineNode.users[node.id]
      return users.size === 0 ? release() : undefined
    },
    release
  }
}

const findLine = (RED, plc) => {
  const line = RED.nodes.getNode(plc.settings.line)
  if (!line) throw new PlcError('NO_CONFIGURATION', { node: plc.name || plc.id, what: 'line' })
  if (line.fault) throw line.fault
  return line
}

const prepare = (RED, plc, config) => {
  plc.settings = readSettings('nx-config', config)
  plc.station = plc.settings.station
  plc.access = plc.settings.access
  plc.lineNode = findLine(RED, plc)
  plc.simulated = plc.lineNode.simulated
  plc.lineNode.plcs.join(plc)
}

module.exports = function (RED) {
  function NxConfig(config) {
    RED.nodes.createNode(this, config)
    this.users = {}
    this.fault = null
    this.simulated = false
    this.label = this.name || `NX PLC ${config.station}`
    try {
      prepare(RED, this, config)
    } catch (error) {
      this.fault = error
      this.error(error)
    }
    const holder = deviceHolder(this)
    this.attach = holder.attach
    this.detach = holder.detach
    this.on('close', (_removed, done) => {
      this.lineNode?.plcs.leave(this)
      holder.release().then(
        () => done(),
        () => done()
      )
    })
  }

  RED.nodes.registerType('nx-config', NxConfig)
  RED.httpAdmin.post('/nx-config/test', RED.auth.needsPermission('plc-line.write'), testHandler(RED))
}
