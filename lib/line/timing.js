'use strict'

/** What the transport may add to the wire's own time: USB adapters deliver in 16 ms steps, serial servers in packets. */
const SLACK = Object.freeze({ serial: 50, tcp: 250, simulated: 50 })

/** Above 19200 bit/s the 3.5 characters of silence are a fixed time (MODBUS over serial line, 2.5.1.1). */
const FAST_GAP = 1.75

/**
 * Bits that one character takes on the wire: start bit, data, parity, stop bits.
 * @param {{ dataBits: number, parity: string, stopBits: number }} settings
 */
const bitsPerCharacter = ({ dataBits, parity, stopBits }) => 1 + dataBits + (parity === 'none' ? 0 : 1) + stopBits

/**
 * @param {{ baudRate: number, dataBits: number, parity: string, stopBits: number }} settings
 * @returns {number} ms that one character takes
 */
const characterTime = settings => (bitsPerCharacter(settings) * 1000) / settings.baudRate

/**
 * The silence that the line keeps before it sends, in ms: the setting, or 3.5 characters (1.75 ms above 19200 bit/s).
 * @param {{ gap: number, baudRate: number, dataBits: number, parity: string, stopBits: number }} settings
 */
const gapTime = settings => {
  if (settings.gap > 0) return settings.gap
  return settings.baudRate > 19200 ? FAST_GAP : 3.5 * characterTime(settings)
}

/** @param {{ slack: number, transport: 'serial'|'tcp'|'simulated' }} settings */
const slackTime = settings => settings.slack || SLACK[settings.transport]

/**
 * @param {any} settings normalised settings of a line
 * @returns {{ character: number, gap: number, slack: number }} all in ms
 */
const lineTimes = settings => ({
  character: characterTime(settings),
  gap: gapTime(settings),
  slack: slackTime(settings)
})

module.exports = { bitsPerCharacter, characterTime, gapTime, lineTimes, slackTime }
