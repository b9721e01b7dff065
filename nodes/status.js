'use strict'

/**
 * What a node shows under itself. Pure: from a state to `{ fill, shape, key, values }`; a ring changes or is wrong, a dot is established.
 *
 * @typedef {object} State
 * @property {{ code?: string } | null} [fault] the configuration cannot be used
 * @property {{ state: string, reason?: { code: string } | null }} [line]
 * @property {'idle'|'writing'|'read'|'failed'|'written'|'listening'|'received'|'sending'|'sent'|'watching'} [phase]
 * @property {number} [count] values of the last read
 * @property {number} [bad] how many of them are bad
 * @property {string} [code] of the last failure
 * @property {number | null} [advice] a timeout that would do for the station, ms; answers come too late
 * @property {string} [outcome] of the last write
 * @property {number} [received] messages since the start
 * @property {boolean} [complete] whether the last one was
 * @property {number} [demoted] stations of the line that are left alone because they do not answer
 */

const MOST = 19

const REASONS = {
  PORT_NOT_FOUND: 'noPort',
  PORT_GONE: 'noPort',
  PORT_BUSY: 'busy',
  PORT_DENIED: 'denied',
  WIRE_IN_USE: 'wire',
  WIRE_CONFLICT: 'wire',
  LINE_JAMMED: 'jammed'
}

const CAUSES = {
  ...REASONS,
  TIMEOUT: 'noAnswer',
  STATION_DEMOTED: 'demoted',
  INCOMPLETE: 'damaged',
  CRC_ERROR: 'damaged',
  BAD_ANSWER: 'damaged',
  PLC_WRONG_FUNCTION: 'refused',
  PLC_OUT_OF_RANGE: 'outOfRange',
  PLC_WRONG_FRAME: 'refused',
  PLC_NOT_PERFORMED: 'refused',
  PLC_FRAME_TOO_LONG: 'refused',
  PLC_NO_SERVICE: 'refused',
  MODBUS_ILLEGAL_FUNCTION: 'rejected',
  MODBUS_ILLEGAL_ADDRESS: 'noAddress',
  MODBUS_ILLEGAL_VALUE: 'rejected',
  MODBUS_DEVICE_FAILURE: 'deviceFailure',
  MODBUS_ACKNOWLEDGE: 'deviceBusy',
  MODBUS_BUSY: 'deviceBusy',
  MODBUS_NEGATIVE_ACKNOWLEDGE: 'rejected',
  MODBUS_MEMORY_PARITY: 'deviceFailure',
  MODBUS_GATEWAY_PATH: 'gateway',
  MODBUS_GATEWAY_TARGET: 'gateway',
  MODBUS_EXCEPTION: 'rejected',
  QUEUE_FULL: 'overload',
  DEADLINE: 'overload',
  LINE_DOWN: 'down',
  LINE_CLOSED: 'down',
  CONNECT_FAILED: 'down',
  PORT_ERROR: 'down',
  READ_ONLY: 'readOnly',
  SENDING_OFF: 'sendingOff',
  C24_NAK: 'rejected',
  WRITE_STALLED: 'held',
  SUPERSEDED: 'superseded'
}

const OUTCOMES = {
  confirmed: { fill: 'green', shape: 'dot', key: 'written' },
  unknown: { fill: 'red', shape: 'ring', key: 'unknown' }
}

/** A message of free text is only sent; with the bidirectional protocol the other side confirms it. */
const SENT = {
  ...OUTCOMES,
  sent: { fill: 'green', shape: 'dot', key: 'sent' },
  confirmed: { fill: 'green', shape: 'dot', key: 'acknowledged' }
}

const show = (fill, shape, key, values = {}) => ({ fill, shape, key, values })
const causeOf = (code, otherwise) => CAUSES[code ?? ''] || otherwise

/** @param {any} line */
const lineStatus = ({ state, reason }) => {
  if (state === 'opening' || state === 'closed') return show('yellow', 'ring', 'connecting')
  if (state === 'jammed') return show('red', 'ring', 'jammed')
  return show('red', 'ring', REASONS[reason?.code] || 'down')
}

/** @param {State} state */
const readStatus = ({ count = 0, bad = 0, code, advice }) => {
  if (bad === 0) return show('green', 'dot', count === 1 ? 'value' : 'values', { count })
  if (bad < count) return show('yellow', 'ring', 'someBad', { bad, count })
  if (code === 'TIMEOUT' && advice) return show('red', 'ring', 'raiseTimeout', { ms: advice })
  return show('red', 'ring', causeOf(code, 'error'))
}

/** @param {State} state @param {Record<string, any>} [outcomes] */
const writeStatus = ({ outcome, code }, outcomes = OUTCOMES) => {
  // nobody acknowledges a broadcast: that is how it works, not a fault
  if (code === 'BROADCAST_UNCONFIRMED') return show('yellow', 'ring', 'broadcast')
  const known = outcomes[outcome ?? '']
  if (known) return show(known.fill, known.shape, known.key)
  return outcome === 'refused'
    ? show('yellow', 'ring', causeOf(code, 'notWritten'))
    : show('red', 'ring', causeOf(code, 'error'))
}

/** @param {State} state */
const receivedStatus = ({ received, complete }) =>
  complete ? show('green', 'dot', 'received', { count: received }) : show('yellow', 'ring', 'incomplete')

/** Of a line that is only watched: closed means that nobody uses it. @param {State} state */
const watchedStatus = ({ line, demoted = 0 }) => {
  if (!line || line.state === 'closed') return show('grey', 'ring', 'unused')
  if (line.state !== 'open') return lineStatus(line)
  return demoted > 0 ? show('yellow', 'ring', 'stationsDemoted', { count: demoted }) : show('green', 'dot', 'open')
}

/** @type {Record<string, (state: State) => { fill: string, shape: string, key: string, values: Record<string, any> }>} */
const PHASES = {
  writing: () => show('blue', 'ring', 'writing'),
  read: readStatus,
  failed: ({ code }) => show('red', 'ring', causeOf(code, 'error')),
  written: state => writeStatus(state),
  listening: () => show('grey', 'dot', 'listening'),
  received: receivedStatus,
  sending: () => show('blue', 'ring', 'sending'),
  sent: state => writeStatus(state, SENT)
}

/**
 * @param {State} state
 * @returns {{ fill: string, shape: string, key: string, values: Record<string, any> }} `key` below `status.` in the catalogue
 */
const statusOf = state => {
  if (state.fault) return show('red', 'ring', state.fault.code === 'READ_ONLY' ? 'readOnly' : 'config')
  if (state.phase === 'watching') return watchedStatus(state)
  if (state.line && state.line.state !== 'open') return lineStatus(state.line)
  const phase = PHASES[state.phase ?? '']
  return phase ? phase(state) : show('grey', 'ring', 'waiting')
}

/**
 * The text that fits under a node.
 * @param {string} text
 * @param {boolean} simulated
 */
const fitted = (text, simulated) => {
  const whole = simulated ? `SIM ${text}` : text
  return whole.length > MOST ? `${whole.slice(0, MOST - 1)}…` : whole
}

module.exports = { statusOf, fitted }
