'use strict'
const { createInconLink } = require('./incon-link')
const { OwnLine, openOnOwnLine } = require('./own-line')

/** A link with a line of its own. */
class InconConnection extends OwnLine {
  #link

  /** @param {{ device: import('./incon-link').InconLink, lease: any }} parts */
  constructor(parts) {
    super(parts)
    this.#link = parts.device
  }

  get link() {
    return this.#link
  }

  /** @param {string|number|Uint8Array} value @param {{ deadline?: number }} [options] as of `InconLink` */
  send(value, options) {
    return this.#link.send(value, options)
  }

  /** @param {(line: import('./incon-link').Received) => void} callback @returns {() => void} stop */
  listen(callback) {
    return this.#link.listen(callback)
  }
}

/**
 * An INCON controller on a line of its own settings, for use without Node-RED. Links with the same settings share a wire.
 *
 * ```js
 * const link = openInconLink({ path: '/dev/ttyUSB0', baudRate: 9600 })
 * link.listen(({ value, complete }) => console.log(value, complete))
 * await link.send('O1234')   // { outcome: 'sent', … }: it has left the port, nobody confirms it
 * await link.close()
 * ```
 * @param {Record<string, any>} options all of `lineSettings` (path, or host and port) and of `createInconLink`; `pool`: another than the shared one
 * @returns {InconConnection}
 * @throws {import('../error').PlcError} BAD_SETTING, WIRE_CONFLICT, LINE_USE
 */
const openInconLink = options =>
  openOnOwnLine(options, {
    name: 'INCON',
    device: createInconLink,
    connection: parts => new InconConnection(parts)
  })

module.exports = { InconConnection, openInconLink }
