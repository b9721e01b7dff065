'use strict'
const { openSession } = require('./session')
const { refuseWrite, startWriting } = require('./writing')

module.exports = function (RED) {
  /** @this {any} */
  function NxWrite(config) {
    RED.nodes.createNode(this, config)
    /** @type {any} */
    let write
    const session = openSession(RED, this, {
      type: 'nx-write',
      config,
      start(opened) {
        write = startWriting(opened)
      }
    })
    this.on('input', (msg, send, done) => {
      if (session.fault) {
        refuseWrite(session, msg, session.fault)
        return done(session.fault)
      }
      write(msg, send).then(() => done(), done)
    })
  }

  RED.nodes.registerType('nx-write', NxWrite)
}
