'use strict'
const { startReading } = require('./reading')
const { openSession } = require('./session')

module.exports = function (RED) {
  /** @this {any} */
  function NxRead(config) {
    RED.nodes.createNode(this, config)
    /** @type {any} */
    let ask
    const session = openSession(RED, this, {
      type: 'nx-read',
      config,
      start(opened) {
        const reading = startReading(RED, opened)
        ask = reading.ask
        return reading.stop
      }
    })
    this.on('input', (msg, send, done) => {
      if (session.fault) return done(session.fault)
      ask(msg, send).then(
        () => done(),
        error => session.failed(error, done)
      )
    })
  }

  RED.nodes.registerType('nx-read', NxRead)
}
