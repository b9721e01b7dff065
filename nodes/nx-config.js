'use strict'
const { openDeviceNode } = require('./device-config')
const { testHandler } = require('./test-read')

module.exports = function (RED) {
  /** @this {any} */
  function NxConfig(config) {
    RED.nodes.createNode(this, config)
    openDeviceNode(RED, this, { type: 'nx-config', config })
  }

  RED.nodes.registerType('nx-config', NxConfig)
  RED.httpAdmin.post('/nx-config/test', RED.auth.needsPermission('plc-line.write'), testHandler(RED, 'nx-config'))
}
