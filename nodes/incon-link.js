'use strict'
const { openListener } = require('./listening')

module.exports = function (RED) {
  /** @this {any} */
  function InconLink(config) {
    RED.nodes.createNode(this, config)
    openListener(RED, this, { type: 'incon-link', config })
  }

  RED.nodes.registerType('incon-link', InconLink)
}
