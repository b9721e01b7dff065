'use strict'
const { openListener } = require('./listening')

module.exports = function (RED) {
  /** @this {any} */
  function MelsecC24(config) {
    RED.nodes.createNode(this, config)
    openListener(RED, this, { type: 'melsec-c24', config })
  }

  RED.nodes.registerType('melsec-c24', MelsecC24)
}
