'use strict'
const { PlcError } = require('../lib/index.js')
const { deviceHolder } = require('./device-holder')
const { kindOf, readDevice } = require('./device-settings')

/** What the config nodes of devices have in common: the line they stand on, their place among its stations, and who uses them. */

const findLine = (RED, deviceNode) => {
  const line = RED.nodes.getNode(deviceNode.settings.line)
  if (line?.type === 'plc-line') return line
  throw new PlcError('NO_CONFIGURATION', { node: deviceNode.name || deviceNode.id, what: 'line' })
}

const prepare = (RED, deviceNode, { type, config, check }) => {
  deviceNode.settings = readDevice(type, config)
  deviceNode.station = deviceNode.settings.station
  deviceNode.label = deviceNode.name || `${kindOf({ type }).title} ${deviceNode.station}`
  deviceNode.lineNode = findLine(RED, deviceNode)
  if (deviceNode.lineNode.fault) throw deviceNode.lineNode.fault
  deviceNode.simulated = deviceNode.lineNode.simulated
  check(deviceNode.settings, deviceNode.lineNode.settings)
  deviceNode.lineNode.plcs.join(deviceNode)
}

/**
 * The inside of a config node's constructor.
 * @param {any} RED
 * @param {any} deviceNode
 * @param {{ type: string, config: any, check?: (settings: any, line: any) => void }} own `check` throws for what the line must be like
 */
const openDeviceNode = (RED, deviceNode, { type, config, check = () => {} }) => {
  const { title } = kindOf({ type })
  const start = { users: {}, fault: null, tagFault: null, simulated: false, label: deviceNode.name || title }
  Object.assign(deviceNode, start)
  try {
    prepare(RED, deviceNode, { type, config, check })
  } catch (error) {
    deviceNode.fault = error
    deviceNode.error(error)
  }
  const holder = deviceHolder(deviceNode, RED.events)
  deviceNode.attach = holder.attach
  deviceNode.detach = holder.detach
  deviceNode.on('close', (_removed, done) => {
    deviceNode.lineNode?.plcs.leave(deviceNode)
    holder.close().then(
      () => done(),
      () => done()
    )
  })
}

module.exports = { openDeviceNode }
