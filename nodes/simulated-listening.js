'use strict'
const { createInconController, createMelsecC24, createRealClock, createWire } = require('../lib/sim/index.js')

/** What nodes that listen hear on a simulated line: a C24 whose program runs a small machine, or a controller that runs a program. */

const EVERY = 1000 // ms between two messages of the machine

const SETTINGS = { recipe: 1, target: 1800 }

/** A machine that counts its pieces and follows what a recipe sets, in tenths of a degree. */
const createMachine = () => {
  const machine = { ...SETTINGS, pieces: 0, temperature: 200 }
  return {
    step() {
      machine.pieces = (machine.pieces + 1) % 10000
      machine.temperature += Math.round((machine.target - machine.temperature) / 5)
      return machine
    },
    set(recipe, target) {
      if (Number.isFinite(recipe)) machine.recipe = recipe
      if (Number.isFinite(target)) machine.target = Math.round(target)
    }
  }
}

const wordsOf = ({ pieces, recipe, temperature, target }) => [pieces, recipe, temperature, target]
const bytesOf = words => Buffer.from(words.flatMap(word => [word & 255, (word >> 8) & 255]))

/** Messages of a fixed length are filled up. */
const fitted = (bytes, { framing, count }) =>
  framing === 'count' ? Buffer.concat([bytes, Buffer.alloc(count)]).subarray(0, count) : bytes

const spoken = (machine, settings) => {
  const { pieces, recipe, temperature } = machine
  const text = `PIECES=${pieces};RECIPE=${recipe};TEMP=${(temperature / 10).toFixed(1)}`
  return fitted(settings.format === 'text' ? Buffer.from(text) : bytesOf(wordsOf(machine)), settings)
}

/** A recipe comes as words (number, set value) or as text (RECIPE=7;TEMP=215.5). */
const obey = (machine, bytes, { format }) => {
  if (format !== 'text') {
    return machine.set(bytes.readUInt16LE(0), bytes.length >= 4 ? bytes.readUInt16LE(2) : NaN)
  }
  const text = bytes.toString('latin1')
  const number = name => parseFloat(new RegExp(`${name}=([\\d.]+)`).exec(text)?.[1] ?? '')
  machine.set(number('RECIPE'), number('TEMP') * 10)
}

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
  const machine = createMachine()
  return createMelsecC24({
    ...moduleSettings(settings, line),
    clock,
    baudRate: line.baudRate,
    program: ({ bytes }) => {
      if (bytes.length >= 2) obey(machine, bytes, settings)
      return null
    },
    speaks: { every: EVERY, value: () => spoken(machine.step(), settings) }
  })
}

const EVENTS = ['PART DONE', 'TOOL 4', 'PART DONE', 'ALARM 12 DOOR OPEN', 'ALARM 12 CLEARED']

const createIncon = ({ checked }, { clock }) =>
  createInconController({
    clock,
    checked,
    events: EVENTS,
    every: EVERY,
    // the name of a program is selected, everything else is shown on its screen
    answer: text => (/^O\d{4}$/.test(text) ? `PROGRAM ${text} SELECTED` : null)
  })

const DEVICES = {
  'melsec-c24': { duplex: 'full', create: createC24 },
  'incon-link': { duplex: 'half', create: createIncon }
}

/** Timers of the simulation end when nobody listens any more. */
const stoppableClock = () => {
  const clock = createRealClock()
  const timers = new Set()
  let stopped = false
  return {
    ...clock,
    setTimer(fn, ms) {
      if (stopped) return null
      const timer = clock.setTimer(() => {
        timers.delete(timer)
        fn()
      }, ms)
      timers.add(timer)
      return timer
    },
    clearTimer(timer) {
      timers.delete(timer)
      clock.clearTimer(timer)
    },
    stop() {
      stopped = true
      timers.forEach(clock.clearTimer)
      timers.clear()
    }
  }
}

/**
 * @param {{ type: string, settings: any }} listener
 * @param {{ baudRate: number, flowControl: string }} line
 * @returns {{ wire: any, device: any, stop: () => void }}
 */
const simulatedPeer = ({ type, settings }, line) => {
  const { duplex, create } = DEVICES[type]
  const clock = stoppableClock()
  const wire = createWire({ clock, baudRate: line.baudRate, duplex })
  const device = create(settings, { clock, line })
  wire.add(device)
  return { wire, device, stop: clock.stop }
}

module.exports = { simulatedPeer }
