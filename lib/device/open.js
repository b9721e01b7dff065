'use strict'
const { createPool } = require('../line')
const { createNxPlc } = require('./nx-plc')

/** @type {any} */
let shared = null

/** The pool of all who bring none: two PLCs on one wire share it. */
const sharedPool = () => (shared ??= createPool())

/**
 * An NX PLC on a line of its own settings, for use without Node-RED.
 *
 * ```js
 * const plc = openNxPlc({ path: '/dev/ttyUSB0', baudRate: 19200, station: 1 })
 * await plc.read(['M0..M3', 'K127.12'])   // [{ name: 'M0_M3', value: [0, 0, 0, 0], quality: 'good', … }, …]
 * await plc.write({ K0: 5 })              // { outcome: 'confirmed', … }, with access: 'write'
 * await plc.close()
 * ```
 *
 * What it writes is fixed by the program that calls it: so no writable tag or range is needed, only `access: 'write'`.
 * @param {Record<string, any> & { station: number|string }} options all of `lineSettings` (path, or host and port) and of
 *   `createNxPlc`; `pool`: another pool than the shared one
 * @returns {NxConnection}
 * @throws {import('../error').PlcError} BAD_SETTING, WIRE_CONFLICT, and those of `createNxPlc`
 */
const openNxPlc = ({ pool = sharedPool(), ...options }) => {
  const transport = options.transport ?? (options.host ? 'tcp' : 'serial')
  const name = options.name ?? `station ${options.station}`
  // the name is the PLC's; the line is called by its path
  const lease = pool.open({ ...options, name: '', transport }, { id: name, name })
  try {
    return new NxConnection(createNxPlc({ ...options, lease }), lease)
  } catch (error) {
    lease.release()
    throw error
  }
}

/** A PLC with its line. */
class NxConnection {
  #lease

  /** @param {import('./nx-plc').NxPlc} plc @param {any} lease */
  constructor(plc, lease) {
    this.plc = plc
    this.#lease = lease
  }

  /** `state`, `reason`, `stats()`, `trace()`, and events by `on` and `off`. */
  get line() {
    return this.#lease.line
  }

  /**
   * As `NxPlc.read`; one text is an array of one.
   * @param {string|string[]} items
   * @param {{ priority?: number }} [options]
   */
  read(items, options) {
    return this.plc.read(typeof items === 'string' ? [items] : items, options)
  }

  /**
   * As `NxPlc.write`, of fixed targets.
   * @param {Record<string, any> | { item: string, value: any }[]} values `{ K0: 5, 'K127.12': true }`, or entries
   * @param {{ fixed?: boolean, verify?: boolean, coalesce?: boolean }} [options]
   */
  write(values, options) {
    const entries = Array.isArray(values) ? values : Object.entries(values).map(([item, value]) => ({ item, value }))
    return this.plc.write(entries, { fixed: true, ...options })
  }

  /**
   * As `NxPlc.subscribe`.
   * @param {{ items: string[], interval: number, immediately?: boolean }} group interval in ms, 10 to a day
   * @param {(results: import('./points').Result[], cycle: import('./subscription').Cycle) => void} callback per cycle
   */
  subscribe(group, callback) {
    return this.plc.subscribe(group, callback)
  }

  /** Ends all and gives the line back. @returns {Promise<void>} */
  close() {
    this.plc.close()
    return this.#lease.release()
  }
}

module.exports = { NxConnection, openNxPlc }
