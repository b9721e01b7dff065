'use strict'
const { openMonitor } = require('./monitoring')

module.exports = function (RED) {
  /** @this {any} */
  function PlcMonitor(config) {
    RED.nodes.createNode(this, config)
    openMonitor(RED, this, { type: 'plc-monitor', config })
  }

  RED.nodes.registerType('plc-monitor', PlcMonitor)
}
