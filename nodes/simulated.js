'use strict'
const { DEMO, createChinoRegulator, createNxPlc, createRealClock, createWire } = require('../lib/sim/index.js')
const { simulatedPeer } = require('./simulated-listening')

// what the examples show beside the simulator's own demo values: K0 is a set value in tenths, M10 follows it, M11 is a load
const EXAMPLES = [
  { at: 'M10', as: 'int16', kind: 'follows', of: 'K0', ofAs: 'int16', from: 250, tau: 20000, ripple: 4, every: 100 },
  { at: 'M11', as: 'uint16', kind: 'sine', from: 200, to: 900, period: 60000, every: 100 }
]
const SET_VALUES = { K0: 1800, K10: 600 }
const ONLY_PLC = 255

const newPlc = (station, { areas, clock }) => {
  const plc = createNxPlc({ station, clock, areas, behaviour: [...DEMO, ...EXAMPLES] })
  for (const [address, value] of Object.entries(SET_VALUES)) plc.set(address, value)
  return plc
}

/** Programs and kernels make pauses inside a frame that are none on a wire; ASCII allows a second. */
const pauses = ({ protocol }) => (protocol === 'rtu' ? { gap: 25 } : {})

const newStation = (station, { settings, clock, baudRate }) =>
  settings.type === 'chino-config'
    ? createChinoRegulator({ station, protocol: settings.protocol, clock, baudRate, ...pauses(settings) })
    : newPlc(station, { areas: settings.areas, clock })

/** What a station is: with another device, or another protocol, it is another one. */
const makeOf = ({ type = 'nx-config', protocol = '' }) => `${type} ${protocol}`

/**
 * The wire of a simulated line. A station keeps its values while the line's configuration lives; one that is not configured
 * any more has no power.
 * @param {{ baudRate: number }} settings
 */
const simulatedWire = ({ baudRate }) => {
  const clock = createRealClock()
  const wire = createWire({ clock, baudRate })
  const makes = new Map()
  /** Who keeps the power of a number on: two may stand for the same one. @type {Map<number, Set<number>>} */
  const holders = new Map()
  // the only PLC of a line has a number of its own behind 255
  const numberOf = station => (station === ONLY_PLC ? 1 : station)
  const find = station => wire.stations().find(each => each.station === numberOf(station))
  const place = settings => {
    const number = numberOf(settings.station)
    wire.remove(number)
    wire.add(newStation(number, { settings, clock, baudRate }))
    makes.set(number, makeOf(settings))
  }
  return {
    wire,
    find,
    /**
     * @param {any} settings of a device's config node, with its type; a broadcast is no station; where another one stands already under this
     *   number, it stays
     */
    add(settings) {
      const { type, station } = settings
      if (type === 'chino-config' && station === 0) return
      const number = numberOf(station)
      const own = holders.get(number) ?? new Set()
      const isTaken = [...own].some(each => each !== station)
      holders.set(number, own.add(station))
      if (makes.get(number) === makeOf(settings)) wire.setOff(number, false)
      else if (!isTaken) place(settings)
    },
    /** @param {number} station */
    remove(station) {
      const number = numberOf(station)
      const own = holders.get(number)
      own?.delete(station)
      if (!own?.size) wire.setOff(number, true)
    }
  }
}

const signatureOf = ({ type, settings }) => JSON.stringify([type, settings])

/**
 * The same for a line of a configuration, which may be listened to instead of polled: then one module or controller is at its other end.
 * @param {{ baudRate: number, flowControl: string }} line
 */
const simulatedLine = line => {
  const stations = simulatedWire(line)
  /** @type {{ signature: string, wire: any, device: any, stop: () => void } | null} */
  let peer = null
  const deaf = () => {
    peer?.stop()
    peer = null
  }
  return {
    ...stations,
    wire: { ...stations.wire, connect: handlers => (peer ?? stations).wire.connect(handlers) },
    /** @param {{ type: string, settings: any }} listener the first one of a kind says how its other end is set */
    listen(listener) {
      const signature = signatureOf(listener)
      if (peer?.signature === signature) return
      deaf()
      peer = { signature, ...simulatedPeer(listener, line) }
    },
    deaf,
    /** The simulated module or controller. */
    peer: () => peer?.device ?? null
  }
}

module.exports = { simulatedLine, simulatedWire }
