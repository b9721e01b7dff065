'use strict'
const { PlcError } = require('../lib/index.js')
const { openDeviceNode } = require('./device-config')
const { testHandler } = require('./test-read')

/** A byte of an RTU frame has all eight bits; ASCII sends characters, which need seven. */
const checkLine = ({ protocol }, { dataBits }) => {
  if (protocol !== 'rtu' || dataBits === 8) return
  const reason = 'RTU needs 8 data bits on the line; ASCII works with 7'
  throw new PlcError('BAD_SETTING', { setting: 'dataBits', value: dataBits, reason })
}

module.exports = function (RED) {
  /** @this {any} */
  function ChinoConfig(config) {
    RED.nodes.createNode(this, config)
    openDeviceNode(RED, this, { type: 'chino-config', config, check: checkLine })
  }

  RED.nodes.registerType('chino-config', ChinoConfig)
  RED.httpAdmin.post('/chino-config/test', RED.auth.needsPermission('plc-line.write'), testHandler(RED, 'chino-config'))
}
