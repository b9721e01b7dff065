'use strict'
const { createDevice, deviceSettings } = require('./device-settings')

/** What the line or the device advises, once for each kind: it stands in the log and in the debug sidebar. */
const adviser = plc => {
  const told = new Set()
  return ({ event, station, cause, remedy }) => {
    if ((station !== null && station !== plc.station) || told.has(event)) return
    told.add(event)
    plc.warn([cause, remedy].filter(Boolean).join('. '))
  }
}

/**
 * @param {any} plc the config node
 * @param {Map<any, (line: { state: string, reason: any }) => void>} users who is told of the line
 */
const openDevice = (plc, users) => {
  const lease = plc.lineNode.lease({ id: plc.id, name: plc.label })
  try {
    const { plcs, settings: wire } = plc.lineNode
    const more = { name: plc.label, stations: plcs.stations(), gap: wire.gap }
    const settings = deviceSettings(plc.settings, more)
    const { device, tagFault } = createDevice(lease, settings)
    if (tagFault && !plc.tagFault) plc.error(tagFault)
    plc.tagFault = tagFault
    lease.on('state', (state, reason) => users.forEach(tell => tell({ state, reason })))
    lease.on('event', adviser(plc))
    return { lease, device }
  } catch (error) {
    lease.release()
    throw error
  }
}

/**
 * The device of a PLC's configuration: made for its first user, given back when a deploy has left it without one. In the middle of a
 * deploy a changed user goes and comes back: the port stays open for it.
 * @param {any} plc the config node
 * @param {{ on: Function, off: Function }} events of the runtime
 */
const deviceHolder = (plc, events) => {
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
  events.on('flows:started', settle)

  return {
    /**
     * @param {any} node on a tab
     * @param {(line: { state: string, reason: any }) => void} tell how the line is, now and whenever it changes
     * @returns {any} the device
     * @throws {Error} why the configuration cannot be used
     */
    attach(node, tell) {
      plc.users[node.id] = node
      if (plc.lineNode) plc.lineNode.users[node.id] = node
      if (plc.fault) throw plc.fault
      open ??= openDevice(plc, users)
      users.set(node, tell)
      const { state, reason } = open.lease.line
      tell({ state, reason })
      return open.device
    },
    /** @param {any} node that attached */
    detach(node) {
      users.delete(node)
      if (plc.users[node.id] === node) delete plc.users[node.id]
      if (plc.lineNode?.users[node.id] === node) delete plc.lineNode.users[node.id]
    },
    close() {
      events.off('flows:started', settle)
      return release()
    }
  }
}

module.exports = { deviceHolder }
