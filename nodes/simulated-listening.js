'use strict'
const {
  createInconController,
  createMelsecC24,
  createPress,
  createStoppableClock,
  createWire
} = require('../lib/sim/index.js')

/** What nodes that listen hear on a simulated line: a C24 whose program runs a small machine, or a controller that runs a program. */

const EVERY = 1000 // ms between two messages of the machine

const FLOWS = { none: 'none', dc: 'dc', driver: 'dtr' }
const CROSSING = { c24: 'send', us: 'receive', both: 'both' }
const PROTOCOLS = { true: 'bidirectional', false: 'non-procedure' }

/** The module as it has to be set for what the node expects. */
const moduleSettings = (settings, { baudRate, flowControl }) => {
  const { framing, end, count, gap, unit, flow, timer0, bidirectional, transparent } = settings
  const pause = framing === 'gap' ? gap : timer0
  return {
    protocol: PROTOCOLS[bidirectional],
    unit,
    end: framing === 'end' ? end : '',
    ...(framing === 'count' && !bidirectional ? { count: unit === 'word' ? Math.ceil(count / 2) : count } : {}),
    first: settings.first,
    last: settings.last,
    timer0: pause > 0 ? Math.ceil(1 + (pause * baudRate) / 12000) : 0,
    flow: flow === 'driver' && flowControl !== 'rtscts' ? 'none' : FLOWS[flow],
    transparent: transparent.slice(0, 2),
    asciiBinary: settings.asciiBinary,
    sumCheck: settings.sumCheck,
    simultaneous: CROSSING[settings.priority]
  }
}

const createC24 = (settings, { clock, line }) => {
  const press = createPress({ ...settings, count: settings.framing === 'count' ? settings.count : 0 })
  return createMelsecC24({
    ...moduleSettings(settings, line),
    clock,
    baudRate: line.baudRate,
    program: ({ bytes }) => {
      press.obey(bytes)
      return null
    },
    speaks: { every: EVERY, value: press.says }
  })
}

const EVENTS = ['PART DONE', 'TOOL 4', 'PART DONE', 'ALARM 12 DOOR OPEN', 'ALARM 12 CLEARED']

const createIncon = ({ checked, acknowledge }, { clock }) =>
  createInconController({
    clock,
    checked,
    acknowledge,
    // it begins at the same moment as the node
    listens: 300,
    events: EVENTS,
    every: EVERY,
    // the name of a program is selected, everything else is shown on its screen
    answer: text => (/^O\d{4}$/.test(text) ? `PROGRAM ${text} SELECTED` : null)
  })

const DEVICES = {
  'melsec-c24': { duplex: 'full', create: createC24 },
  'incon-link': { duplex: 'half', create: createIncon }
}

/**
 * @param {{ type: string, settings: any }} listener
 * @param {{ baudRate: number, flowControl: string }} line
 * @returns {{ wire: any, device: any, stop: () => void }}
 */
const simulatedPeer = ({ type, settings }, line) => {
  const { duplex, create } = DEVICES[type]
  const clock = createStoppableClock()
  const wire = createWire({ clock, baudRate: line.baudRate, duplex })
  const device = create(settings, { clock, line })
  wire.add(device)
  return { wire, device, stop: clock.stop }
}

module.exports = { simulatedPeer }
