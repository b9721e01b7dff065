'use strict'

const { createRealClock } = require('./clock')
const { createFaults } = require('./faults')
const { createInconController } = require('./incon-controller')
const { createMelsecC24 } = require('./melsec-c24')
const { createRandom } = require('./random')
const { createWire } = require('./wire')
const { PlcError } = require('../error')

/**
 * What stands at the other end of a line that is listened to: RS-232 has a pair of wires for each direction, RS-485 one for both.
 * @type {Record<string, { duplex: 'full'|'half', make: (settings: any) => any }>}
 */
const PEERS = {
  c24: { duplex: 'full', make: createMelsecC24 },
  incon: { duplex: 'half', make: createInconController }
}

/**
 * A whole simulated line with one device that also speaks by itself.
 * @param {{ device: 'c24'|'incon', settings?: Record<string, any>, baudRate?: number, bitsPerByte?: number, rates?: import('./faults').Fault[],
 *   seed?: number, clock?: any, [wire: string]: any }} options settings: of melsec-c24.js or incon-controller.js; what else stands here is the
 *   wire's (wire.js)
 * @returns {{ wire: import('./wire').Wire, device: any, faults: import('./faults').Faults, clock: any }}
 * @throws {PlcError} BAD_SETTING, BAD_STATION
 */
function createPeerLine({ device, settings = {}, rates = [], seed = 1, clock = createRealClock(), ...rest }) {
  if (!Object.hasOwn(PEERS, device)) {
    const reason = `known are ${Object.keys(PEERS).join(', ')}`
    throw new PlcError('BAD_SETTING', { setting: 'device', value: device, reason })
  }
  const { duplex, make } = PEERS[device]
  const random = createRandom(seed)
  const faults = createFaults({ random: random.fork(), rates })
  const wire = createWire({ duplex, ...rest, clock, faults, random: random.fork() })
  const { baudRate, bitsPerByte } = rest
  const made = make({ ...(device === 'c24' ? { baudRate, bitsPerByte } : {}), ...settings, clock })
  wire.add(made)
  return { wire, device: made, faults, clock }
}

module.exports = { createPeerLine }
