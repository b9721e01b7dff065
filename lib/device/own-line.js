'use strict'
const { sharedPool } = require('./open')

/** A device that listens, with a line of its own: what `openC24Port` and `openInconLink` give. */
class OwnLine {
  #device
  #lease

  /** @param {{ device: any, lease: any }} parts */
  constructor({ device, lease }) {
    this.#device = device
    this.#lease = lease
  }

  /** `state`, `reason`, `stats()`, `trace()`, and events by `on` and `off`. */
  get line() {
    return this.#lease.line
  }

  /** @param {unknown} value @param {{ deadline?: number }} [options] as of the device */
  send(value, options) {
    return this.#device.send(value, options)
  }

  /** @param {(message: any) => void} callback @returns {() => void} stop */
  listen(callback) {
    return this.#device.listen(callback)
  }

  /** Ends all and gives the line back. @returns {Promise<void>} */
  close() {
    this.#device.close()
    return this.#lease.release()
  }
}

/**
 * Opens a line and a device on it; the line is given back if the device cannot be made.
 * @template T, C
 * @param {Record<string, any>} options of the line and of the device; `pool`: another than the shared one
 * @param {{ name: string, device: (options: any) => T, connection: (parts: { device: T, lease: any }) => C, line?: Record<string, any> }} kind name: if
 *   none is given; line: settings of the line that stand whatever the options say
 * @returns {C}
 */
const openOnOwnLine = ({ pool = sharedPool(), ...options }, kind) => {
  const transport = options.transport ?? (options.host ? 'tcp' : 'serial')
  const name = options.name ?? kind.name
  // the name is the device's; the line is called by its path
  const lease = pool.open({ ...options, ...kind.line, name: '', transport }, { id: name, name })
  try {
    return kind.connection({ device: kind.device({ ...options, name, lease }), lease })
  } catch (error) {
    lease.release()
    throw error
  }
}

module.exports = { OwnLine, openOnOwnLine }
