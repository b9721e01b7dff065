'use strict'
const { PlcError } = require('../error')
const { createPool } = require('../line')
const { createChinoRegulator } = require('./chino-regulator')
const { mixedConflict } = require('./mixed')
const { createNxPlc } = require('./nx-plc')

/** @type {any} */
let shared = null

/** The pool of all who bring none: two stations on one wire share it. */
const sharedPool = () => (shared ??= createPool())

/** Who was opened here on which line. */
const members = new WeakMap()

/** @throws {PlcError} MIXED_LINE */
const join = (line, member) => {
  const others = members.get(line) ?? new Set()
  for (const other of others) {
    const reason = mixedConflict(member, other)
    if (reason) throw new PlcError('MIXED_LINE', { owner: member.name, other: other.name, line: line.name, reason })
  }
  members.set(line, others.add(member))
}

/** A line of the options' own settings with one device on it. */
const openOn = ({ pool = sharedPool(), ...options }, create) => {
  const transport = options.transport ?? (options.host ? 'tcp' : 'serial')
  const name = options.name ?? `station ${options.station}`
  // the name is the device's; the line is called by its path
  const lease = pool.open({ ...options, name: '', transport }, { id: name, name })
  try {
    const device = create({ ...options, lease })
    const { member } = device
    join(lease.line, member)
    const leave = () => members.get(lease.line)?.delete(member)
    return { device, lease, leave }
  } catch (error) {
    lease.release()
    throw error
  }
}

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
 * @throws {PlcError} BAD_SETTING, WIRE_CONFLICT, MIXED_LINE, and those of `createNxPlc`
 */
const openNxPlc = options => new NxConnection(openOn(options, createNxPlc))

/**
 * A CHINO regulator on a line of its own settings, for use without Node-RED; as {@link openNxPlc}. Regulators and PLCs on one wire share
 * its line.
 *
 * ```js
 * const regulator = openChinoRegulator({ path: '/dev/ttyUSB0', baudRate: 19200, station: 11, access: 'write' })
 * await regulator.read(['300001', '300002:int16'])
 * await regulator.write({ 400001: 500 }, { verify: true })
 * await regulator.close()
 * ```
 * @param {Record<string, any> & { station: number|string }} options all of `lineSettings` and of `createChinoRegulator`; `pool`
 * @returns {ChinoConnection}
 * @throws {PlcError} BAD_SETTING (also: RTU needs 8 data bits), WIRE_CONFLICT, MIXED_LINE, and those of `createChinoRegulator`
 */
const openChinoRegulator = options => new ChinoConnection(openOn(options, createRegulator))

const createRegulator = options => {
  const ascii =
    String(options.protocol ?? '')
      .trim()
      .toLowerCase() === 'ascii'
  if (!ascii && Number(options.dataBits || 8) !== 8) {
    throw new PlcError('BAD_SETTING', { setting: 'dataBits', value: options.dataBits, reason: 'RTU needs 8 data bits' })
  }
  return createChinoRegulator(options)
}

/**
 * A station with its line.
 * @template {import('./device').Device} D
 */
class Connection {
  #device
  #lease
  #leave

  /** @param {{ device: D, lease: any, leave: () => void }} parts */
  constructor({ device, lease, leave }) {
    this.#device = device
    this.#lease = lease
    this.#leave = leave
  }

  /** @returns {D} */
  get device() {
    return this.#device
  }

  /** `state`, `reason`, `stats()`, `trace()`, and events by `on` and `off`. */
  get line() {
    return this.#lease.line
  }

  /**
   * As `Device.read`; one text is an array of one.
   * @param {string|string[]} items
   * @param {{ priority?: number }} [options]
   */
  read(items, options) {
    return this.#device.read(typeof items === 'string' ? [items] : items, options)
  }

  /**
   * As `Device.write`, of fixed targets.
   * @param {Record<string, any> | { item: string, value: any }[]} values `{ K0: 5, 'K127.12': true }`, or entries
   * @param {{ fixed?: boolean, verify?: boolean, coalesce?: boolean }} [options]
   */
  write(values, options) {
    const entries = Array.isArray(values) ? values : Object.entries(values).map(([item, value]) => ({ item, value }))
    return this.#device.write(entries, { fixed: true, ...options })
  }

  /**
   * As `Device.subscribe`.
   * @param {{ items: string[], interval: number, immediately?: boolean }} group interval in ms, 10 to a day
   * @param {(results: import('./points').Result[], cycle: import('./subscription').Cycle) => void} callback per cycle
   */
  subscribe(group, callback) {
    return this.#device.subscribe(group, callback)
  }

  /** Ends all and gives the line back. @returns {Promise<void>} */
  close() {
    this.#leave()
    this.#device.close()
    return this.#lease.release()
  }
}

/** A PLC with its line. @extends {Connection<import('./nx-plc').NxPlc>} */
class NxConnection extends Connection {
  get plc() {
    return this.device
  }
}

/** A regulator with its line. @extends {Connection<import('./chino-regulator').ChinoRegulator>} */
class ChinoConnection extends Connection {
  get regulator() {
    return this.device
  }
}

module.exports = { ChinoConnection, NxConnection, openChinoRegulator, openNxPlc, sharedPool }
