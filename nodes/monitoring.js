'use strict'
const { sharedPool } = require('./pool')
const { openSession } = require('./session')
const { onStarted } = require('./started')

/** The inside of the node that watches a line: it opens none, and holds none open. */

/** What comes before all nodes have been made waits for them. */
const MOST_WAITING = 1000

const WANTED = {
  all: () => true,
  faults: event => event !== 'audit',
  audit: event => event === 'audit',
  none: () => false
}

/** As the config node of a device, for a node that only looks on. @param {any} line the config node @param {string} label */
const watchedLine = (line, label) => ({
  label,
  simulated: Boolean(line.simulated),
  attach(node) {
    line.users[node.id] = node
    if (line.fault) throw line.fault
    return options => sharedPool().monitor(line.settings, options)
  },
  detach(node) {
    if (line.users[node.id] === node) delete line.users[node.id]
  }
})

/** Sends to the outputs; messages of the time before the flows run come when they do. */
const createOutput = (RED, { node, deviceNode }) => {
  const { label, simulated } = deviceNode
  const waiting = []
  let isStarted = false
  const send = messages => {
    if (isStarted) node.send(messages)
    else if (waiting.length < MOST_WAITING) waiting.push(messages)
  }
  const stop = onStarted(RED.events, () => {
    stop()
    isStarted = true
    waiting.splice(0).forEach(messages => node.send(messages))
  })
  const fields = (topic, payload) => ({
    topic,
    // others are told of the same object
    payload: RED.util.cloneMessage(payload),
    device: label,
    ...(simulated ? { simulated: true } : {})
  })
  return { send, stop, fields }
}

const startWatching = (RED, session) => {
  const { settings, display, device: watch, deviceNode } = session
  const { send, stop, fields } = createOutput(RED, session)
  const isWanted = WANTED[settings.events]
  const topic = deviceNode.label
  const monitor = watch({
    interval: settings.interval,
    condition: ({ state, reason, demoted }) => display.update({ phase: 'watching', line: { state, reason }, demoted }),
    event: event => isWanted(event.event) && send([fields(event.event, event), null, null]),
    statistics: all => send([null, fields(topic, all), null]),
    ...(settings.trace ? { frame: row => send([null, null, fields('frame', row)]) } : {})
  })
  return {
    /** What a message asks for, in that message. */
    async answer(msg) {
      const wantsEvidence = Object.hasOwn(msg, 'payload') && msg.payload === 'evidence'
      const [name, all] = wantsEvidence ? ['evidence', await monitor.evidence()] : [topic, monitor.statistics()]
      return Object.assign(msg, fields(name, all))
    },
    stop() {
      monitor.stop()
      stop()
    }
  }
}

/**
 * The inside of the constructor of plc-monitor.
 * @param {any} RED @param {any} node @param {{ type: string, config: any }} own
 */
const openMonitor = (RED, node, { type, config }) => {
  /** @type {any} */
  let answer
  const session = openSession(RED, node, {
    type,
    config,
    seat: (line, { settings }) => watchedLine(line, settings.name || line.name || line.id),
    start(opened) {
      const watching = startWatching(RED, opened)
      answer = watching.answer
      return watching.stop
    }
  })
  node.on('input', (msg, send, done) => {
    if (session.fault) return done(session.fault)
    answer(msg).then(told => {
      send([null, told, null])
      done()
    }, done)
  })
}

module.exports = { openMonitor }
