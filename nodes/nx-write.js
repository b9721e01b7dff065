'use strict'
const { PlcError, entriesOf } = require('../lib/index.js')
const { withCode } = require('./faults')
const { openSession } = require('./session')

const itemNames = entries => entries.map(({ item }) => item)

/** @throws {PlcError} RETAINED_REFUSED: a reconnect to the broker would write last night's set value again */
const checkRetained = (msg, entries) => {
  const retained = Object.hasOwn(msg, 'retain') && msg.retain === true
  if (retained) throw new PlcError('RETAINED_REFUSED', { item: itemNames(entries).join(', ') })
}

const refusal = ({ code, message }) => ({ outcome: 'refused', items: [], code, text: message, attempts: 0, ms: 0 })

/** Sets the topic of what goes out. */
const setTopic = (msg, { settings, plc, entries }) => {
  if (settings.topic === 'fixed') msg.topic = settings.topicText
  if (settings.topic === 'item' && entries.length > 0) {
    msg.topic = entries.length === 1 ? entries[0].item : plc.label
  }
}

const createWriter = session => {
  const { settings, plc, device, display } = session
  const { target, verify, coalesce } = settings

  const attempt = async msg => {
    let entries = []
    try {
      entries = entriesOf(msg, { target })
      if (!settings.acceptRetained) checkRetained(msg, entries)
    } catch (/** @type {any} */ error) {
      return { entries, write: refusal(error) }
    }
    display.update({ phase: 'writing' })
    const write = await device.write(entries, { fixed: target !== '', verify, coalesce })
    return { entries, write: { ...write, ms: Math.round(write.ms) } }
  }

  return async (msg, send) => {
    const { entries, write } = await attempt(msg)
    if (!session.closed) display.update({ phase: 'written', outcome: write.outcome, code: write.code })
    msg.write = write
    msg.device = plc.label
    if (plc.simulated) msg.simulated = true
    setTopic(msg, { settings, plc, entries })
    if (write.outcome === 'confirmed') return send(msg)
    if (settings.onFailure === 'output') return send([null, msg])
    // who asked for the latest value only does not want to hear of each older one
    if (write.code !== 'SUPERSEDED') throw withCode(write.code, write.text)
  }
}

module.exports = function (RED) {
  /** @this {any} */
  function NxWrite(config) {
    RED.nodes.createNode(this, config)
    let write
    const session = openSession(RED, this, {
      type: 'nx-write',
      config,
      start(opened) {
        if (opened.plc.tagFault) throw opened.plc.tagFault
        // a target that can never be written is a mistake of the flow: refused when the flow starts
        if (opened.settings.target) opened.device.checkTarget(opened.settings.target, { fixed: true })
        write = createWriter(opened)
      }
    })
    this.on('input', (msg, send, done) => {
      if (session.fault) return done(session.fault)
      write(msg, send).then(() => done(), done)
    })
  }

  RED.nodes.registerType('nx-write', NxWrite)
}
