'use strict'
const { PlcError, entriesOf } = require('../lib/index.js')
const { byOf } = require('./by')
const { withCode } = require('./faults')

/** What every node that writes has in common: from a message to values, and from the outcome to an output or an error. */

const itemNames = entries => entries.map(({ item }) => item)

/** @throws {PlcError} RETAINED_REFUSED: a reconnect to the broker would write last night's set value again */
const checkRetained = (msg, entries) => {
  const retained = Object.hasOwn(msg, 'retain') && msg.retain === true
  if (retained) throw new PlcError('RETAINED_REFUSED', { item: itemNames(entries).join(', ') })
}

const refusal = ({ code, message }) => ({ outcome: 'refused', items: [], code, text: message, attempts: 0, ms: 0 })

/** Sets the topic of what goes out. */
const setTopic = (msg, { settings, deviceNode, entries }) => {
  if (settings.topic === 'fixed') msg.topic = settings.topicText
  if (settings.topic === 'item' && entries.length > 0) {
    msg.topic = entries.length === 1 ? entries[0].item : deviceNode.label
  }
}

/** A message on one of the outputs, counted from 0. */
const onOutput = (index, msg) => [...new Array(index).fill(null), msg]

const createWriter = (session, { output, check }) => {
  const { settings, deviceNode, device, display } = session
  const { target, verify, coalesce } = settings

  const attempt = async msg => {
    const by = byOf(session.node, msg)
    let entries = []
    try {
      check(msg)
      entries = entriesOf(msg, { target })
      if (!settings.acceptRetained) checkRetained(msg, entries)
    } catch (/** @type {any} */ error) {
      device.refused(entries, error, { by })
      return { entries, write: refusal(error) }
    }
    display.update({ phase: 'writing' })
    const write = await device.write(entries, { fixed: target !== '', verify, coalesce, by })
    return { entries, write: { ...write, ms: Math.round(write.ms) } }
  }

  return async (msg, send) => {
    const { entries, write } = await attempt(msg)
    if (!session.closed) display.update({ phase: 'written', outcome: write.outcome, code: write.code })
    msg.write = write
    msg.device = deviceNode.label
    if (deviceNode.simulated) msg.simulated = true
    setTopic(msg, { settings, deviceNode, entries })
    if (write.outcome === 'confirmed') return send(onOutput(output, msg))
    if (settings.onFailure === 'output') return send(onOutput(output + 1, msg))
    // who asked for the latest value only does not want to hear of each older one
    if (write.code !== 'SUPERSEDED') throw withCode(write.code, write.text)
  }
}

/**
 * Of a node that cannot write at all: each message is refused with the same error, and told.
 * @param {any} session @param {any} msg @param {any} fault
 */
const refuseWrite = ({ node, device, settings }, msg, fault) => {
  let entries = []
  try {
    entries = entriesOf(msg, { target: settings.target })
  } catch {
    // the node's own fault comes first
  }
  device?.refused(entries, fault, { by: byOf(node, msg) })
}

/**
 * @param {any} session of {@link import('./session').openSession}; settings as those of nx-write
 * @param {{ output?: number, check?: (msg: any) => void }} [options] output: of what is confirmed, counted from 0; what is not goes to the next
 *   one; check: throws for a message that is not meant to write
 * @returns {(msg: any, send: (messages: any) => void) => Promise<void>} rejects with what goes to `done`
 * @throws {Error} why nothing can be written: refused when the flow starts
 */
const startWriting = (session, { output = 0, check = () => {} } = {}) => {
  const { settings, deviceNode, device } = session
  if (deviceNode.tagFault) throw deviceNode.tagFault
  // a target that can never be written is a mistake of the flow
  if (settings.target) device.checkTarget(settings.target, { fixed: true })
  return createWriter(session, { output, check })
}

module.exports = { refuseWrite, startWriting }
