'use strict'

const { createPeerLine } = require('../../lib/sim')
const { offer } = require('./offer')

const PRESS_BAUD_RATE = 19200
const MACHINE_BAUD_RATE = 9600

/** What the machine reports; the name of a program, such as O1234, is answered by a line of its own. */
const EVENTS = ['PART DONE', 'TOOL 4', 'PART DONE', 'ALARM 12 DOOR OPEN', 'ALARM 12 CLEARED', 'PART DONE', 'TOOL 7']

/**
 * The sequence program behind the C24: a heated press. It sends four words every second (pieces, recipe, temperature and set value in tenths
 * of a degree) and takes a recipe as four words (number, set value).
 */
function createPress() {
  const press = { pieces: 0, recipe: 1, temperature: 850, set: 1600 }
  return {
    words() {
      press.pieces = (press.pieces + 1) % 10000
      press.temperature += Math.round((press.set - press.temperature) / 5)
      return [press.pieces, press.recipe, press.temperature, press.set]
    },
    obey({ bytes }) {
      if (bytes.length < 4) return null // torn
      press.recipe = bytes.readUInt16LE(0)
      press.set = bytes.readUInt16LE(2)
      return null
    }
  }
}

function pressLine() {
  const press = createPress()
  return createPeerLine({
    device: 'c24',
    baudRate: PRESS_BAUD_RATE,
    settings: {
      end: '',
      count: 4, // words
      timer0: 400, // bytes of 12 bits: 250 ms, after which a torn recipe is given up
      program: press.obey,
      speaks: { every: 1000, value: press.words }
    }
  })
}

const machineLine = () =>
  createPeerLine({
    device: 'incon',
    baudRate: MACHINE_BAUD_RATE,
    settings: {
      events: EVENTS,
      every: 2000,
      answer: text => (/^O\d{4}$/.test(text) ? `PROGRAM ${text} SELECTED` : null)
    }
  })

/** A line and its device, offered to programs. */
async function offerLine({ wire, device }, { name, baudRate }) {
  try {
    const { close, ...offered } = await offer({ wire, name, baudRate })
    return {
      device,
      ...offered,
      async close() {
        device.close()
        await close()
      }
    }
  } catch (error) {
    device.close()
    throw error
  }
}

/**
 * A press behind a simulated MELSEC-Q serial module (C24), as {@link createPress}.
 * @returns {Promise<import('./offer').Offer & { device: import('../../lib/sim/melsec-c24').MelsecC24 }>}
 */
const startPress = () => offerLine(pressLine(), { name: 'c24-line', baudRate: PRESS_BAUD_RATE })

/**
 * A machine tool with a simulated INCON controller.
 * @returns {Promise<import('./offer').Offer & { device: import('../../lib/sim/incon-controller').InconController }>}
 */
const startMachine = () => offerLine(machineLine(), { name: 'incon-line', baudRate: MACHINE_BAUD_RATE })

module.exports = { startPress, startMachine }
