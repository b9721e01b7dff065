'use strict'
const { createDevice, deviceSettings } = require('./device-settings')

/**
 * @param {any} plc the config node
 * @param {Map<any, (line: { state: string, reason: any }) => void>} users who is told of the line
 */
const openDevice = (plc, users) => {
  const lease = plc.lineNode.lease({ id: plc.id, name: plc.label })
  try {
    const settings = deviceSettings(plc.settings, { name: plc.label, stations: plc.lineNode.plcs.stations() })
    const { device, tagFault } = createDevice(lease, settings)
    if (tagFault && !plc.tagFault) plc.error(tagFault)
    plc.tagFault = tagFault
    lease.on('state', (state, reason) => users.forEach(tell => tell({ state, reason })))
    return { lease, device }
  } catch (error) {
    lease.release()
    throw error
  }
}

/**
 * The device of a PLC's configuration: made for its first user, given back with its last.
 * @param {any} plc the config node
 */
const deviceHolder = plc => {
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
    /** @returns {Promise<void> | undefined} of the port's close, if this was the last user */
    detach(node) {
      users.delete(node)
      if (plc.users[node.id] === node) delete plc.users[node.id]
      if (plc.lineNode?.users[node.id] === node) delete plc.lineNode.users[node.id]
      return users.size === 0 ? release() : undefined
    },
    release
  }
}

module.exports = { deviceHolder }
