'use strict'
const { PlcError } = require('../lib/index.js')
const { startReading } = require('./reading')
const { openSession } = require('./session')
const { refuseWrite, startWriting } = require('./writing')

const BROADCAST = 0
const refused = (what, reason) => new PlcError('BROADCAST_REFUSED', { what, reason })

/** What can never work with a broadcast is a mistake of the flow: refused when it starts. */
const checkBroadcast = ({ settings: { mode, verify }, device: { station } }) => {
  if (station !== BROADCAST) return
  if (mode !== 'write') throw refused('reading', 'no station answers; set the mode to "write"')
  if (verify) throw refused('reading back', 'no station answers')
}

/** In a node that also reads, a faulty tag table stops the writing only. */
const writingBesideReading = session => {
  const { tagFault } = session.deviceNode
  if (!tagFault) return startWriting(session, { output: 1 })
  session.warn(tagFault)
  return msg => {
    refuseWrite(session, msg, tagFault)
    return Promise.reject(tagFault)
  }
}

const asks = msg => Object.hasOwn(msg, 'items')

/** Whether a message to a faulty node was to write. */
const writes = ({ settings }, msg) => settings?.mode === 'write' || (settings?.mode === 'both' && !asks(msg))

/** Of a node that both read and wrote: its questions must not become set values. */
const checkWrites = msg => {
  if (!asks(msg)) return
  throw new PlcError('NOTHING_TO_WRITE', { reason: 'it has msg.items, so it asks, and this node only writes' })
}

/** What a message does in each mode; `write` before `read`, since what polls must be stopped again. */
const MODES = {
  read(RED, session) {
    const { ask, stop } = startReading(RED, session)
    return { reads: () => true, ask, stop }
  },
  write(_RED, session) {
    return { reads: () => false, write: startWriting(session, { check: checkWrites }) }
  },
  both(RED, session) {
    const write = writingBesideReading(session)
    const { ask, stop } = startReading(RED, session, { named: true })
    return { reads: asks, ask, write, stop }
  }
}

module.exports = function (RED) {
  /** @this {any} */
  function ChinoRegulator(config) {
    RED.nodes.createNode(this, config)
    /** @type {any} */
    let work
    const session = openSession(RED, this, {
      type: 'chino-regulator',
      config,
      start(opened) {
        checkBroadcast(opened)
        work = MODES[opened.settings.mode](RED, opened)
        return work.stop
      }
    })
    this.on('input', (msg, send, done) => {
      if (session.fault) {
        if (writes(session, msg)) refuseWrite(session, msg, session.fault)
        return done(session.fault)
      }
      const reads = work.reads(msg)
      const failed = reads ? error => session.failed(error, done) : done
      work[reads ? 'ask' : 'write'](msg, send).then(() => done(), failed)
    })
  }

  RED.nodes.registerType('chino-regulator', ChinoRegulator)
}
