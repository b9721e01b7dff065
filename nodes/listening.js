'use strict'
const { PlcError, payloadOf } = require('../lib/index.js')
const { withCode } = require('./faults')
const { byOf } = require('./by')
const { LISTENERS } = require('./listening-rules')
const { openSession } = require('./session')
const { onStarted } = require('./started')

/** What the nodes have in common that listen to messages and send them. */

const refusal = ({ code, message }) => ({ outcome: 'refused', code, text: message, attempts: 0, ms: 0, bytes: 0 })

/** @returns {PlcError | null} why the message is not sent at all */
const guard = (msg, { settings: { access, acceptRetained }, deviceNode: { label } }) => {
  if (access !== 'write') return new PlcError('SENDING_OFF', { node: label })
  const retained = Object.hasOwn(msg, 'retain') && msg.retain === true
  return retained && !acceptRetained ? new PlcError('RETAINED_REFUSED', { item: label }) : null
}

const attempt = async (session, msg) => {
  const by = byOf(session.node, msg)
  let payload
  try {
    payload = payloadOf(msg)
    const refused = guard(msg, session)
    if (refused) throw refused
  } catch (/** @type {any} */ error) {
    session.device.refused(payload, error, { by })
    return refusal(error)
  }
  session.display.update({ phase: 'sending' })
  const write = await session.device.send(payload, { by })
  return { ...write, ms: Math.round(write.ms) }
}

const ARRIVED = ['sent', 'confirmed']

const createSender = session => {
  const { settings, deviceNode, display } = session
  const toOutput = settings.access === 'write' && settings.onFailure === 'output'
  return async (msg, send) => {
    const write = await attempt(session, msg)
    if (!session.closed) display.update({ phase: 'sent', outcome: write.outcome, code: write.code })
    msg.write = write
    msg.device = deviceNode.label
    if (deviceNode.simulated) msg.simulated = true
    if (ARRIVED.includes(write.outcome)) return send([null, msg])
    if (toOutput) return send([null, null, msg])
    throw withCode(write.code, write.text)
  }
}

/** A message of the device as one of the flow. */
const messageOf = (message, { label, simulated }) => {
  const { value, bytes, count, complete, reason, timestamp, number, lost, afterOpen, repeated } = message
  return {
    topic: label,
    payload: value,
    count,
    bytes: bytes.length,
    complete,
    ...(complete ? {} : { reason }),
    ...(afterOpen ? { afterOpen } : {}),
    ...(repeated ? { repeated } : {}),
    // of checked lines
    ...(typeof number === 'number' ? { number, lost } : {}),
    quality: complete ? 'good' : 'bad',
    timestamp,
    device: label,
    ...(simulated ? { simulated: true } : {})
  }
}

const startListening = (RED, session) => {
  const { node, device, deviceNode, display } = session
  let received = 0
  let stop = () => {}
  const hear = message => {
    received++
    display.update({ phase: 'received', received, complete: message.complete })
    node.send(messageOf(message, deviceNode))
  }
  // in a constructor the nodes that the wires lead to may not have been made yet: until then the line keeps what comes
  const forget = onStarted(RED.events, () => {
    forget()
    stop = device.listen(hear)
  })
  display.update({ phase: 'listening' })
  return () => {
    forget()
    stop()
  }
}

/**
 * The inside of the constructor of a node that listens.
 * @param {any} RED @param {any} node @param {{ type: string, config: any }} own
 */
const openListener = (RED, node, { type, config }) => {
  /** @type {any} */
  let sendOff
  const session = openSession(RED, node, {
    type,
    config,
    seat: (line, { settings }) => {
      const label = settings.name || `${LISTENERS[type].title} (${line.name || line.id})`
      return line.listeners.member(node, { id: node.id, label, type, settings })
    },
    start(opened) {
      sendOff = createSender(opened)
      return startListening(RED, opened)
    }
  })
  node.on('input', (msg, send, done) => {
    if (session.fault) {
      session.device?.refused(payloadOf(msg), session.fault, { by: byOf(node, msg) })
      return done(session.fault)
    }
    sendOff(msg, send).then(() => done(), done)
  })
}

module.exports = { openListener }
