'use strict'
const { createDevice, deviceSettings } = require('./device-settings')
const { onStarted } = require('./started')

/** The events that somebody should act on; what comes and goes by itself is for `plc-monitor`. */
const ADVICE = ['late', 'jammed', 'fixedMasterId', 'slow', 'overrun']

/** What the line or the device advises, once for each kind: it stands in the log and in the debug sidebar. */
const adviser = deviceNode => {
  const told = new Set()
  return ({ event, station, cause, remedy }) => {
    if (!ADVICE.includes(event) || told.has(event)) return
    if (station !== null && station !== deviceNode.station) return
    told.add(event)
    deviceNode.warn([cause, remedy].filter(Boolean).join('. '))
  }
}

/**
 * @param {any} deviceNode the config node
 * @param {Map<any, (line: { state: string, reason: any }) => void>} users who is told of the line
 */
const openDevice = (deviceNode, users) => {
  const lease = deviceNode.lineNode.lease({ id: deviceNode.id, name: deviceNode.label })
  try {
    const { plcs, settings: wire } = deviceNode.lineNode
    const more = { name: deviceNode.label, stations: plcs.stations(), gap: wire.gap }
    const settings = deviceSettings(deviceNode.settings, more)
    const { device, tagFault } = createDevice(lease, settings)
    if (tagFault && !deviceNode.tagFault) deviceNode.error(tagFault)
    deviceNode.tagFault = tagFault
    lease.on('state', (state, reason) => users.forEach(tell => tell({ state, reason })))
    lease.on('event', adviser(deviceNode))
    return { lease, device }
  } catch (error) {
    lease.release()
    throw error
  }
}

/**
 * The device of a configuration: made for its first user, given back when a deploy has left it without one. In the middle of a
 * deploy a changed user goes and comes back: the port stays open for it.
 * @param {any} deviceNode the config node
 * @param {{ on: Function, off: Function }} events of the runtime
 */
const deviceHolder = (deviceNode, events) => {
  const users = new Map()
  /** @type {{ lease: any, device: any } | null} */
  let open = null
  let closing = Promise.resolve()

  /** @returns {Promise<void>} of the port's close */
  const release = () => {
    if (!open) return closing
    open.device.close()
    closing = open.lease.release()
    open = null
    return closing
  }

  const settle = () => {
    if (users.size === 0) release()
  }
  const stop = onStarted(events, settle)

  return {
    /**
     * @param {any} node on a tab
     * @param {(line: { state: string, reason: any }) => void} tell how the line is, now and whenever it changes
     * @returns {any} the device
     * @throws {Error} why the configuration cannot be used
     */
    attach(node, tell) {
      deviceNode.users[node.id] = node
      if (deviceNode.lineNode) deviceNode.lineNode.users[node.id] = node
      if (deviceNode.fault) throw deviceNode.fault
      open ??= openDevice(deviceNode, users)
      users.set(node, tell)
      const { state, reason } = open.lease.line
      tell({ state, reason })
      return open.device
    },
    /** @param {any} node that attached */
    detach(node) {
      users.delete(node)
      if (deviceNode.users[node.id] === node) delete deviceNode.users[node.id]
      if (deviceNode.lineNode?.users[node.id] === node) delete deviceNode.lineNode.users[node.id]
    },
    close() {
      stop()
      return release()
    }
  }
}

module.exports = { deviceHolder }
