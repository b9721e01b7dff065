'use strict'
const { CODES, isRefusal } = require('../../error')
const { timeoutFor } = require('../../line')

/**
 * Likely causes, from what was seen. Pure. What is no row here is an error of the line or of the station by its own code (docs/errors.md).
 *
 * @typedef {{ code: string, text: string, remedy: string, details?: Record<string, any> }} Cause `details`: what was filled into the texts
 * @typedef {object} Facts
 * @property {string} code of the read's error
 * @property {string} text of the read's error
 * @property {'nx'|'rtu'|'ascii'} protocol
 * @property {number} station
 * @property {number} timeout ms
 * @property {string} item @property {string} wire what goes out for it, in words
 * @property {string} addressMode MODBUS
 * @property {number} steps NX
 * @property {string} transport @property {string} path of the port, or host:port
 * @property {string} framing `19200 8N1`
 * @property {number} waited ms that was listened in all
 * @property {import('./evidence').Evidence} evidence
 * @property {{ lateness: number, timeout: number } | null} late
 */

/** code: [what it is, what to do, rows of the sheet that are wrong then] */
const CAUSES = Object.freeze({
  NO_BYTES: [
    'not one byte came back from station {station} within {waited} ms',
    'Check power, the cable (A and B, TX and RX), the station number and the speed. {hint}',
    []
  ],
  SERVER_SILENT: [
    '{path} accepts the connection, but not one byte came back from station {station} within {waited} ms',
    'Check the serial side of the server (speed, A and B, raw TCP without a protocol of its own), other clients that hold it, and the station number. {hint}',
    []
  ],
  ECHO_ONLY: [
    'only our own query was heard, no answer of station {station}',
    'The adapter hears itself (2-wire) and works; behind it nobody answers. Check A and B, power, the station number and the speed. {hint}',
    []
  ],
  GARBAGE: [
    '{count} bytes came that are no frame: {bytes}',
    'Mostly the speed or the parity is another one; A and B exchanged, or a missing terminator, look the same. Compare both sides, or try the other speeds.',
    []
  ],
  OTHER_SPEED: [
    'station {station} answers at {found}, not at {framing}',
    'Set {found} in the line, or {framing} at the device.',
    ['speed', 'parity', 'dataBits']
  ],
  OTHER_STATION: [
    'station {other} was heard, station {station} was not',
    'Set the number of the station to {other}, or correct it at the device. Another master that asks station {other} looks the same.',
    ['prefixProject']
  ],
  OTHER_MASTER: [
    'another master asks on this line: its queries were heard, no answer of station {station}',
    'A line has one master. Disconnect the panel or the other program, then test again.',
    ['systemConfiguration']
  ],
  OTHER_MODE: [
    'MODBUS {found} was heard, {mode} is configured',
    'Set the protocol to {found}, or {mode} at the device.{bits}',
    ['protocol']
  ],
  OTHER_PROTOCOL: [
    '{found} was heard from station {other}, {mode} is configured',
    'Use the configuration for {found}, or another line.',
    ['driver', 'protocol']
  ],
  UNEXPECTED: [
    'station {station} sent a whole frame that is no answer to this query: {bytes}',
    'Look whether another master uses the line; else report it with the trace.',
    ['systemConfiguration']
  ],
  WRONG_ADDRESS: [
    'station {station} answers, but it does not have {item} ({wire})',
    'The connection works. Read an address that the manual of the device lists. {hint}',
    ['addressRange']
  ],
  WRONG_STEPS: [
    'station {station} answers, but it does not know the function of the {steps}-step method',
    'Set the number of steps to {found}.',
    ['protocol']
  ],
  FIXED_MASTER_ID: [
    'station {station} answers to the master ID {found}, and not to {used}',
    'Set the master IDs of the PLC to {found} alone.',
    ['otherSettings']
  ],
  UNSTEADY: [
    'station {station} answered one query, and not another one',
    'The settings are right. Check cable, earth and terminators, and whether another master uses the line.',
    ['cable']
  ],
  LATE: [
    'station {station} answered {lateness} ms after its {timeout} ms timeout',
    'Raise the timeout to {advice} ms or more.',
    ['otherSettings']
  ]
})

/** Rows of the sheet that an error of the line concerns. */
const LINE_ROWS = Object.freeze({
  PORT_NOT_FOUND: ['port'],
  PORT_BUSY: ['port'],
  PORT_DENIED: ['port'],
  PORT_GONE: ['port'],
  PORT_ERROR: ['port'],
  CONNECT_FAILED: ['port'],
  WIRE_IN_USE: ['port'],
  LINE_DOWN: ['port'],
  LINE_JAMMED: ['systemConfiguration'],
  WRITE_STALLED: ['otherSettings'],
  MODBUS_ILLEGAL_FUNCTION: ['addressRange']
})

const MODES = { nx: 'NX', rtu: 'RTU', ascii: 'ASCII' }
const LOST = new Set(['TIMEOUT', 'INCOMPLETE', 'CRC_ERROR', 'BAD_ANSWER'])
const NO_ADDRESS = new Set(['PLC_OUT_OF_RANGE', 'MODBUS_ILLEGAL_ADDRESS'])
const NO_FUNCTION = new Set(['PLC_WRONG_FUNCTION', 'PLC_NO_SERVICE'])
const MOST_SHOWN = 24
const ANY_STATION = 255

const fill = (text, facts) => text.replace(/\{(\w+)\}/g, (_, name) => String(facts[name] ?? '')).trim()

/**
 * @param {keyof typeof CAUSES} code
 * @param {Record<string, any>} facts for its text
 * @returns {Cause}
 */
const cause = (code, facts) => {
  const [text, remedy] = CAUSES[code]
  const names = [...`${text} ${remedy}`.matchAll(/\{(\w+)\}/g)].map(([, name]) => name)
  const details = Object.fromEntries(names.map(name => [name, facts[name] ?? '']))
  return { code, text: fill(text, facts), remedy: fill(remedy, facts), details }
}

/** An error by its own name. @param {string} code @param {string} text its message @returns {Cause} */
const ownCause = (code, text) => {
  const remedy = CODES[code]?.[1] ?? 'Look at the cause.'
  const ending = `. ${remedy}`
  return { code, text: text.endsWith(ending) ? text.slice(0, -ending.length) : text, remedy }
}

/** Which rows of the sheet are wrong for this reason. @param {string} code @returns {string[]} */
const wrongRows = code => CAUSES[code]?.[2] ?? LINE_ROWS[code] ?? []

const shownBytes = bytes => {
  const hex = bytes.subarray(0, MOST_SHOWN).toString('hex').toUpperCase()
  return `${hex.match(/../g)?.join(' ') ?? ''}${bytes.length > MOST_SHOWN ? ' …' : ''}`
}

const silenceHint = ({ protocol }) =>
  protocol === 'nx'
    ? 'Where one PLC is alone on the line, station 255 finds it whatever its number is.'
    : 'A device that is set to the other mode (RTU, ASCII) is silent, too.'

/** The address mode is the first suspect, where it plays a part. */
const addressHint = ({ protocol, addressMode, item }) => {
  if (protocol === 'nx') return 'Compare the area table with the CPU.'
  if (/^(hr|ir|co|di)/i.test(item)) return 'This number is the one on the wire: many manuals count from 1.'
  const other = addressMode === '0-base' ? '1-base' : '0-base'
  return `In the address mode ${other} it is the neighbour's address.`
}

/** A whole frame was heard that is not the answer: who speaks? @param {Facts} facts @returns {Cause | null} */
function fromFrames(facts) {
  const { protocol, station, evidence } = facts
  const { frames, queries } = evidence
  const same = frames.filter(frame => frame.protocol === protocol && !frame.dataBits)
  const answers = same.filter(({ query }) => !query)
  const toUs = answers.filter(({ to }) => to === undefined || queries.some(query => query[1] === to))
  const isOurs = frame => frame.station === station || (protocol === 'nx' && station === ANY_STATION)
  const other = toUs.find(frame => !isOurs(frame))
  if (toUs.some(isOurs)) {
    return cause('UNEXPECTED', { ...facts, bytes: shownBytes(evidence.stray) })
  }
  if (same.length > toUs.length) return cause('OTHER_MASTER', facts)
  if (other) return cause('OTHER_STATION', { ...facts, other: other.station })
  return frames.length > 0 ? stranger(facts, frames[0]) : null
}

/** @param {Facts} facts @param {any} frame of another protocol or mode @returns {Cause} */
function stranger(facts, frame) {
  const { protocol } = facts
  const mode = MODES[protocol]
  const found = MODES[frame.protocol]
  if (protocol !== 'nx' && frame.protocol !== 'nx') {
    const bits = frame.dataBits ? ' It is sent with 7 data bits and parity.' : ''
    return cause('OTHER_MODE', { ...facts, mode, found, bits })
  }
  const name = frame.protocol === 'nx' ? found : `MODBUS ${found}`
  const own = protocol === 'nx' ? mode : `MODBUS ${mode}`
  return cause('OTHER_PROTOCOL', { ...facts, mode: own, found: name, other: frame.station })
}

/** @param {Facts} facts @returns {Cause} */
function fromLoss(facts) {
  const { code, text, evidence, late, transport } = facts
  const { stray, echo, answers } = evidence
  if (late) {
    const lateness = Math.round(late.lateness)
    const advice = timeoutFor(facts.timeout + lateness)
    return cause('LATE', { ...facts, lateness, advice })
  }
  const spoken = fromFrames(facts)
  if (spoken) return spoken
  // the head was the awaited one: speed and parity are right
  if (code === 'INCOMPLETE' || code === 'CRC_ERROR') return ownCause(code, text)
  // others who ask the same station on this line are answered
  if (answers > 0) return cause('UNSTEADY', facts)
  if (stray.length > 0) return cause('GARBAGE', { ...facts, count: stray.length, bytes: shownBytes(stray) })
  const hint = silenceHint(facts)
  if (echo) return cause('ECHO_ONLY', { ...facts, hint })
  return cause(transport === 'tcp' ? 'SERVER_SILENT' : 'NO_BYTES', { ...facts, hint })
}

/**
 * The likely cause of a failed read.
 * @param {Facts} facts
 * @returns {Cause}
 */
function causeOf(facts) {
  const { code, text } = facts
  if (LOST.has(code)) return fromLoss(facts)
  if (NO_ADDRESS.has(code)) return cause('WRONG_ADDRESS', { ...facts, hint: addressHint(facts) })
  if (NO_FUNCTION.has(code)) return cause('WRONG_STEPS', { ...facts, found: facts.steps === 4 ? 2 : 4 })
  return ownCause(code, text)
}

/** Whether the station itself has spoken, if only to refuse. @param {string} code of a read's error */
const hasSpoken = code => isRefusal({ code }) && !/^MODBUS_GATEWAY/.test(code)

module.exports = { CAUSES, cause, causeOf, hasSpoken, wrongRows }
