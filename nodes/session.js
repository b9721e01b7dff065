'use strict'
const { PlcError, createThrottle } = require('../lib/index.js')
const { readSettings } = require('./settings')
const { onStarted } = require('./started')
const { fitted, statusOf } = require('./status')

const SHARED = '@nxline/node-red-serial-plc/plc-line:status.'
const STATUS_INTERVAL = 1000

const differs = (change, state) => {
  for (const key of Object.keys(change)) if (change[key] !== state[key]) return true
  return false
}

/**
 * Shows a node's state: on change only, at most once a second, the last one always.
 * @param {any} RED @param {any} node
 */
const statusDisplay = (RED, node) => {
  /** @type {Record<string, any>} */
  let state = {}
  let shown = ''
  let simulated = false
  const throttle = createThrottle({ interval: STATUS_INTERVAL }, () => {
    const { fill, shape, key, values } = statusOf(state)
    const status = { fill, shape, text: fitted(RED._(SHARED + key, values), simulated) }
    const signature = JSON.stringify(status)
    if (signature === shown) return
    shown = signature
    node.status(status)
  })
  return {
    /** @param {import('./status').State} change */
    update(change) {
      // a poll says the same many times a second
      if (!differs(change, state)) return
      state = { ...state, ...change }
      throttle(state)
    },
    simulated: value => {
      simulated = value
    },
    stop: () => throttle.cancel()
  }
}

/**
 * Reports what is wrong with the configuration when the flows run: in a constructor no Catch node would hear it.
 * @param {any} RED @param {any} node
 */
const deployReport = (RED, node) => {
  let errors = []
  const stop = onStarted(RED.events, () => {
    stop()
    errors.forEach(error => node.error(error, {}))
    errors = []
  })
  return { add: error => errors.push(error), stop }
}

/** Which property of a node names its device, and what type that has. */
const DEVICES = {
  'nx-read': { property: 'plc', of: 'nx-config' },
  'nx-write': { property: 'plc', of: 'nx-config' },
  'chino-regulator': { property: 'regulator', of: 'chino-config' },
  // who listens has no configuration of a device: it sits on the line itself
  'melsec-c24': { property: 'line', of: 'plc-line' },
  'incon-link': { property: 'line', of: 'plc-line' },
  'plc-monitor': { property: 'line', of: 'plc-line' }
}

const findDevice = (RED, { type, settings, node }) => {
  const { property, of } = DEVICES[type]
  const found = RED.nodes.getNode(settings[property])
  if (found?.type === of) return found
  throw new PlcError('NO_CONFIGURATION', { node: node.name || type, what: property })
}

/**
 * What the nodes of the flow have in common: their settings, the device with its line, the status, and a close that always ends.
 * @param {any} RED @param {any} node
 * @param {{ type: string, config: any, start: (session: any) => (() => void) | void, seat?: (found: any, session: any) => any }} own
 *   `start` runs if the configuration is usable and may throw a PlcError; it returns what stops it. `seat` makes what the node attaches
 *   to of the configuration node that was found
 */
const openSession = (RED, node, { type, config, start, seat = found => found }) => {
  const display = statusDisplay(RED, node)
  const report = deployReport(RED, node)
  /** @type {any} */
  const session = { node, display, warn: report.add, closed: false, fault: null, lineChanged() {} }
  /** @type {any} */
  let stop
  const attached = () => {
    session.settings = readSettings(type, config)
    session.deviceNode = seat(findDevice(RED, { type, settings: session.settings, node }), session)
    display.simulated(session.deviceNode.simulated)
    session.device = session.deviceNode.attach(node, line => {
      display.update({ line })
      session.lineChanged(line)
    })
    stop = start(session)
  }
  try {
    attached()
  } catch (/** @type {any} */ error) {
    session.fault = error
    display.update({ fault: error })
    report.add(error)
  }
  session.failed = (error, done) => {
    if (!session.closed) display.update({ phase: 'failed', code: error.code })
    done(error)
  }
  node.on('close', (_removed, done) => {
    session.closed = true
    display.stop()
    report.stop()
    stop?.()
    session.deviceNode?.detach(node)
    done()
  })
  return session
}

module.exports = { openSession }
