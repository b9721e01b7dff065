'use strict'
const { PlcError } = require('../lib')
const { openSession } = require('./session')

const isPlain = value =>
  value !== null && typeof value === 'object' && [Object.prototype, null].includes(Object.getPrototypeOf(value))

const own = (msg, name) => (Object.hasOwn(msg, name) ? msg[name] : undefined)

/**
 * What a message wants to be written.
 * @param {string} target fixed in the node, or ''
 * @param {Record<string, any>} msg
 * @returns {{ item: string, value: unknown, fixed: boolean }[]}
 * @throws {PlcError} NOTHING_TO_WRITE
 */
const entriesOf = (target, msg) => {
  const payload = own(msg, 'payload')
  const topic = own(msg, 'topic')
  if (target) return [{ item: target, value: payload, fixed: true }]
  if (isPlain(payload)) {
    const pairs = Object.entries(payload)
    if (pairs.length === 0) throw new PlcError('NOTHING_TO_WRITE', { reason: 'the payload is an empty object' })
    return pairs.map(([item, value]) => ({ item, value, fixed: false }))
  }
  if (typeof topic === 'string' && topic.trim()) return [{ item: topic.trim(), value: payload, fixed: false }]
  throw new PlcError('NOTHING_TO_WRITE', { reason: 'there is no target, no object as payload and no topic' })
}

const refusal = (error, items) => ({ outcome: 'refused', items, code: error.code, text: error.message, attempts: 0, ms: 0, error })

const topicOf = (settings, entries, msg) => {
  if (settings.topic === 'keep') return msg.topic
  return settings.topic === 'fixed' ? settings.topicText : entries.map(({ item }) => item).join(',')
}

const writer = session => {
  const { settings, plc, device, display } = session

  const attempt = async msg => {
    let items = settings.target ? [settings.target] : []
    try {
      const entries = entriesOf(settings.target, msg)
      items = entries.map(({ item }) => item)
      if (own(msg, 'retain') === true && !settings.acceptRetained) {
        throw new PlcError('RETAINED_REFUSED', { item: items.join(', ') })
      }
      display.update({ phase: 'writing' })
      const outcome = await device.write(entries, { verify: settings.verify, coalesce: settings.coalesce })
      return { outcome, entries }
    } catch (error) {
      return { outcome: refusal(error, items), entries: items.map(item => ({ item })) }
    }
  }

  return async (msg, send) => {
    const { outcome, entries } = await attempt(msg)
    const { error, ...write } = outcome
    if (!session.closed) display.update({ phase: 'written', outcome: write.outcome, code: write.code })
    msg.write = write
    if (plc.simulated) msg.simulated = true
    msg.topic = topicOf(settings, entries, msg)
    if (write.outcome === 'confirmed') return send(msg)
    if (settings.onFailure === 'output') return send([null, msg])
    if (write.code === 'SUPERSEDED') return undefined
    throw error ?? Object.assign(new Error(write.text), { code: write.code })
  }
}

/** A target that can never be written is a mistake of the flow: it is refused when the flow starts. */
const checkTarget = ({ settings, plc, device }) => {
  if (!settings.target) return
  device.item(settings.target)
  if (plc.access !== 'write') throw new PlcError('READ_ONLY', { item: settings.target, station: plc.station })
}

module.exports = function (RED) {
  function NxWrite(config) {
    RED.nodes.createNode(this, config)
    let write
    const session = openSession(RED, this, {
      type: 'nx-write',
      config,
      start(opened) {
        checkTarget(opened)
        write = writer(opened)
      }
    })
    this.on('input', (msg, send, done) => {
      if (session.fault) return done(session.fault)
      write(msg, send).then(() => done(), done)
    })
  }

  RED.nodes.registerType('nx-write', NxWrite)
}
