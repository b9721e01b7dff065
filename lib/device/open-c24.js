'use strict'
const { createC24Port } = require('./c24-port')
const { sharedPool } = require('./open')

/** A C24 port with a line of its own. */
class C24Connection {
  #port
  #lease

  /** @param {{ port: import('./c24-port').C24Port, lease: any }} parts */
  constructor({ port, lease }) {
    this.#port = port
    this.#lease = lease
  }

  get port() {
    return this.#port
  }

  /** `state`, `reason`, `stats()`, `trace()`, and events by `on` and `off`. */
  get line() {
    return this.#lease.line
  }

  /** @param {unknown} value @param {{ deadline?: number }} [options] as of `C24Port` */
  send(value, options) {
    return this.#port.send(value, options)
  }

  /** @param {(message: import('./c24-port').Received) => void} callback @returns {() => void} stop */
  listen(callback) {
    return this.#port.listen(callback)
  }

  /** Ends all and gives the line back. @returns {Promise<void>} */
  close() {
    this.#port.close()
    return this.#lease.release()
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
const openC24Port = ({ pool = sharedPool(), ...options }) => {
  const transport = options.transport ?? (options.host ? 'tcp' : 'serial')
  const name = options.name ?? 'C24'
  // the gap of a line is another one than that of messages
  const lease = pool.open({ ...options, name: '', transport, gap: 0 }, { id: name, name })
  try {
    return new C24Connection({ port: createC24Port({ ...options, name, lease }), lease })
  } catch (error) {
    lease.release()
    throw error
  }
}

module.exports = { C24Connection, openC24Port }
