'use strict'
const { PlcError } = require('../lib/index.js')
const { deviceHolder } = require('./device-holder')
const { readSettings } = require('./settings')
const { testHandler } = require('./test-read')

const findLine = (RED, plc) => {
  const line = RED.nodes.getNode(plc.settings.line)
  if (line?.type !== 'plc-line') throw new PlcError('NO_CONFIGURATION', { node: plc.name || plc.id, what: 'line' })
  return line
}

const prepare = (RED, plc, config) => {
  plc.settings = readSettings('nx-config', config)
  plc.station = plc.settings.station
  plc.label = plc.name || `NX PLC ${plc.station}`
  plc.lineNode = findLine(RED, plc)
  if (plc.lineNode.fault) throw plc.lineNode.fault
  plc.simulated = plc.lineNode.simulated
  plc.lineNode.plcs.join(plc)
}

module.exports = function (RED) {
  /** @this {any} */
  function NxConfig(config) {
    RED.nodes.createNode(this, config)
    Object.assign(this, { users: {}, fault: null, tagFault: null, simulated: false, label: this.name || 'NX PLC' })
    try {
      prepare(RED, this, config)
    } catch (error) {
      this.fault = error
      this.error(error)
    }
    const holder = deviceHolder(this, RED.events)
    this.attach = holder.attach
    this.detach = holder.detach
    this.on('close', (_removed, done) => {
      this.lineNode?.plcs.leave(this)
      holder.close().then(
        () => done(),
        () => done()
      )
    })
  }

  RED.nodes.registerType('nx-config', NxConfig)
  RED.httpAdmin.post('/nx-config/test', RED.auth.needsPermission('plc-line.write'), testHandler(RED))
}
