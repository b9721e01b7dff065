'use strict'
const { createC24Port } = require('./c24-port')
const { OwnLine, openOnOwnLine } = require('./own-line')

/** A C24 port with a line of its own. */
class C24Connection extends OwnLine {
  #port

  /** @param {{ device: import('./c24-port').C24Port, lease: any }} parts */
  constructor(parts) {
    super(parts)
    this.#port = parts.device
  }

  get port() {
    return this.#port
  }

  /** @param {unknown} value @param {{ deadline?: number }} [options] as of `C24Port` */
  send(value, options) {
    return this.#port.send(value, options)
  }

  /** @param {(message: import('./c24-port').Received) => void} callback @returns {() => void} stop */
  listen(callback) {
    return this.#port.listen(callback)
  }
}

/**
 * A C24 port on a line of its own settings, for use without Node-RED. Ports with the same settings share a wire.
 *
 * ```js
 * const c24 = openC24Port({ path: '/dev/ttyUSB0', baudRate: 19200, format: 'words' })
 * c24.listen(({ value, complete }) => console.log(value, complete))
 * await c24.send([100, 250, 3])   // { outcome: 'sent', … }: it has left the port, nobody confirms it
 * await c24.close()
 * ```
 * @param {Record<string, any>} options all of `lineSettings` (path, or host and port) and of `createC24Port`; `pool`: another than the shared one
 * @returns {C24Connection}
 * @throws {import('../error').PlcError} BAD_SETTING, WIRE_CONFLICT, LINE_USE
 */
const openC24Port = options =>
  openOnOwnLine(options, {
    name: 'C24',
    device: createC24Port,
    connection: parts => new C24Connection(parts),
    // the gap of a line is another one than that of messages
    line: { gap: 0 }
  })

module.exports = { C24Connection, openC24Port }
