'use strict'

/**
 * The one closed list of error codes. Pure: every level may import it, it imports nothing.
 * A row is `CODE: [what happened, what to do about it]`; `{name}` is filled in from the error's details.
 * docs/errors.md has a heading for each row (a test compares them).
 */
const CODES = Object.freeze({
  // --- what the user typed: found before anything is sent
  BAD_ADDRESS: [
    '"{address}" is not an address: {reason}',
    'Write M0, K127.12, W10:float32 or M0..M127 for an NX PLC; 400108, 401001.05, hr107:float32 or 001001..001016 for MODBUS.'
  ],
  UNKNOWN_AREA: [
    '"{address}" names the area {area}, which this station does not have',
    'Known areas: {known}. Add a row to the area table if the CPU has more.'
  ],
  OUT_OF_AREA: [
    '"{address}" lies outside its area: {area} has {range}',
    'Use an address inside the area, or correct the area table, or the address mode.'
  ],
  BAD_BIT: ['"{address}" asks for bit {bit}', 'Bits are numbered in decimal from 0 to 15.'],
  BAD_COUNT: ['{count} {unit} cannot be asked for at once: {reason}', 'Ask for {least} to {most}.'],
  BAD_TYPE: ['"{type}" is not a data type: {reason}', 'Known types: {known}.'],
  BAD_TAG: ['the tag {name} is not valid: {reason}', 'Correct the tag table.'],
  BAD_AREA: ['the area row {name} is not valid: {reason}', 'Correct the area table.'],
  BAD_STATION: ['station {station} is not possible: {reason}', 'Use the number that is set on the device.'],
  BAD_MASTER_ID: [
    'master ID {id} is not possible: {reason}',
    'Use 192 to 254, or a number of 0 to 191 that no station of the line has.'
  ],
  BAD_SETTING: ['{setting} is {value}: {reason}', 'Correct the setting.'],
  ENV_MISSING: [
    'the environment variable {variable} that {setting} refers to is not set',
    'Set it where Node-RED is started, or type the value.'
  ],
  BAD_ITEMS: [
    'the list of items cannot be used: {reason}',
    'Give addresses or tag names: an array of strings, or one string with commas.'
  ],
  BAD_VALUE: ['{item} cannot take the value {value}: {reason}', 'Send a value that fits the type.'],
  VALUE_OUT_OF_RANGE: ['{item} cannot take {value}: allowed is {least} to {most}', 'Send a value inside the limits.'],
  NOTHING_TO_WRITE: [
    'the message names nothing to write: {reason}',
    'Set a target in the node, an object of name: value as payload, or the item as topic.'
  ],
  // --- guards: refused before anything is sent
  READ_ONLY: [
    '{item} was not written: station {station} is read-only here',
    'Set Access to "read and write" in the configuration of the device.'
  ],
  NOT_WRITABLE: [
    '{item} was not written: {reason}',
    'Mark the tag as writable, add its range to the writable ranges, or fix the target in the node.'
  ],
  RETAINED_REFUSED: [
    'a retained MQTT message was not written to {item}',
    'Publish set values without retain, or accept retained messages in the node.'
  ],
  STEP_TOO_LARGE: [
    '{item} was not written: it is {now} now, and {value} is a step of more than {most}',
    'Go there in smaller steps, or allow a larger step in the tag table.'
  ],
  WRITE_TOO_SOON: [
    '{item} was not written: it may be written again in {wait} ms',
    'Write less often, let the node write only the latest value, or shorten the write interval of the device.'
  ],
  SENDING_OFF: ['{node} sent nothing: it only receives', 'Set Access to "receive and send" in the node.'],
  FUNCTION_REFUSED: [
    'the function {function} is never sent',
    'Only the functions that read and write bits and words are used.'
  ],
  FRAME_TOO_LONG: ['{what} does not fit into one frame: {got} of at most {most} bytes', 'Split it.'],
  TOO_MANY: ['{count} {unit} at once are too many: at most {most}', 'Split the message.'],
  END_CODE_INSIDE: [
    'the message was not sent: it contains {code} at byte {at}; {reason}',
    'Change the message, choose another end code, or use ASCII-binary conversion on both sides.'
  ],
  FLOW_CODE_INSIDE: [
    'the message was not sent: its byte {at} is {code}, which the flow control takes out',
    'Set a transparent code on both sides, or use ASCII-binary conversion or flow control by wire.'
  ],
  ODD_COUNT: [
    'the message was not sent: {count} bytes are an odd count; {reason}',
    'Switch "pad to even" on, send an even count, or use byte units on both sides.'
  ],
  // --- the station's own word
  PLC_WRONG_FUNCTION: [
    'station {station} answers error 1: wrong function code',
    'This CPU does not know the function. Try the other number of steps.'
  ],
  PLC_OUT_OF_RANGE: [
    'station {station} answers error 2: {address} is out of range',
    'The CPU does not have this address. Correct it, or the area table.'
  ],
  PLC_WRONG_FRAME: [
    'station {station} answers error 3: wrong frame structure',
    'Report it with a trace: this is a fault of the frame.'
  ],
  PLC_NOT_PERFORMED: [
    'station {station} answers error 4: the CPU did not perform it',
    'Look at the mode switch and the state of the CPU.'
  ],
  PLC_FRAME_TOO_LONG: [
    'station {station} answers error 5: the frame is too long',
    'Lower the limits per frame in the configuration of the PLC.'
  ],
  PLC_NO_SERVICE: [
    'station {station} answers "no service"',
    'This CPU does not offer the function. Try the other number of steps.'
  ],
  MODBUS_ILLEGAL_FUNCTION: [
    'station {station} answers exception 01: illegal function ({function})',
    'The device does not have this function. Choose the other write function, or another kind of address.'
  ],
  MODBUS_ILLEGAL_ADDRESS: [
    'station {station} answers exception 02: it does not have {address}',
    'Correct the address or the address mode (1-base, 0-base); a device may also refuse a range that is too long.'
  ],
  MODBUS_ILLEGAL_VALUE: [
    'station {station} answers exception 03: illegal data value',
    'Send a value that the device accepts, or lower the counts per request in the configuration of the regulator.'
  ],
  MODBUS_DEVICE_FAILURE: [
    'station {station} answers exception 04: slave device failure',
    'The device failed while it carried out the request. Look at its display.'
  ],
  MODBUS_ACKNOWLEDGE: [
    'station {station} answers exception 05: accepted, but it takes a long time',
    'Read the result later.'
  ],
  MODBUS_BUSY: ['station {station} answers exception 06: slave device busy', 'Ask again later, or poll less often.'],
  MODBUS_NEGATIVE_ACKNOWLEDGE: [
    'station {station} answers exception 07: it cannot carry this out',
    'Look at the mode of the device: it may be in local or program operation.'
  ],
  MODBUS_MEMORY_PARITY: [
    'station {station} answers exception 08: memory parity error',
    'The device found its memory damaged. Have it serviced.'
  ],
  MODBUS_GATEWAY_PATH: [
    'station {station} answers exception 0A: the gateway has no path to it',
    'Correct the configuration of the gateway.'
  ],
  MODBUS_GATEWAY_TARGET: [
    'station {station} answers exception 0B: the device behind the gateway does not answer',
    'Check power, cable and station number behind the gateway.'
  ],
  MODBUS_EXCEPTION: [
    'station {station} answers exception {exception}, which the protocol does not name',
    'Look it up in the manual of the device.'
  ],
  C24_NAK: [
    '{station} did not take the message: NAK {nak}, {reason}',
    'Look the code up in the manual of the module; send it again when the cause is gone.'
  ],
  PEER_RESTARTED: [
    '{station} has started anew: whether it had taken the line before is not known',
    'Look at the controller before you send the line again.'
  ],
  OWN_ECHO: [
    '{line} hears what it sends, so that nothing it hears can be taken for an acknowledgement',
    'Set Echo of the line to "on": the adapter hears itself.'
  ],
  // --- the conversation
  TIMEOUT: [
    'station {station} did not answer within {timeout} ms',
    'Check power, cable, A and B, station number and speed.'
  ],
  STATION_DEMOTED: [
    'station {station} was not asked: it has been silent for {lasting}, and is probed {when}',
    'Check its power, cable and station number. It comes back by itself.'
  ],
  INCOMPLETE: [
    'the answer of station {station} stopped after {got} of {expected} bytes',
    'Check cable, earth and terminators; a serial server may cut frames.'
  ],
  CRC_ERROR: [
    'the answer of station {station} was damaged: {got}',
    'Check cable, earth, terminators, speed and parity.'
  ],
  BAD_ANSWER: [
    'the answer of station {station} makes no sense: {reason}',
    'Check that no other master uses this number.'
  ],
  WRITE_UNKNOWN: [
    'it is not known whether station {station} carried out the write of {item}: {reason}',
    'Read it back before you write again.'
  ],
  NOT_A_VALUE: ['{item} cannot be read as {type}: {reason}', 'Check the data type and the word order of the item.'],
  VERIFY_FAILED: [
    '{item} reads {got} after {expected} was written',
    'The program of the PLC, or the device itself, may overwrite it.'
  ],
  // --- the line
  QUEUE_FULL: ['the queue of {line} is full ({most} requests)', 'Poll less often, or fewer items.'],
  DEADLINE: [
    'the request waited longer than {limit} ms on {line} and was not sent',
    'The line is overloaded: poll less often, or fewer items.'
  ],
  LINE_CLOSED: [
    '{line} was closed while the request waited',
    'Nothing to do after a deploy; else look at the events of the line.'
  ],
  LINE_DOWN: ['{line} is not connected: {reason}', 'It reconnects by itself once the cause is gone.'],
  LINE_JAMMED: [
    '{line} is never silent: {bytes} bytes without a pause',
    'Something sends without being asked: check the wiring, the speed and other masters.'
  ],
  WRITE_STALLED: [
    '{line} does not take the bytes: flow control was not released',
    'Switch flow control off, or check the CTS wire.'
  ],
  PORT_NOT_FOUND: [
    'the port {path} does not exist',
    'Plug the adapter in, or choose another port. Names in /dev/serial/by-id stay the same.'
  ],
  PORT_BUSY: [
    'the port {path} is in use by another program',
    'Close the other program (a terminal, ModemManager, another Node-RED).'
  ],
  PORT_DENIED: [
    'the port {path} may not be opened by this user',
    'Add the user that runs Node-RED to the group dialout (or uucp), then log in again.'
  ],
  PORT_GONE: ['the port {path} has gone', 'Plug the adapter in again; it reconnects by itself.'],
  PORT_ERROR: ['the port {path} failed: {reason}', 'Look at the cause.'],
  CONNECT_FAILED: [
    '{path} does not accept the connection: {reason}',
    'Check address, port and the number of connections that the serial server allows.'
  ],
  WIRE_IN_USE: [
    '{path} is the same wire as {other}, which {owner} already uses',
    'Use one line configuration for one wire.'
  ],
  WIRE_CONFLICT: [
    '{owner} and {other} use {path} with different settings: {reason}',
    'Use one line configuration, or the same settings.'
  ],
  LINE_USE: [
    '{owner} and {other} cannot share {line}: {reason}',
    'Give one of them a line of its own: a line asks stations, or listens to messages in one way.'
  ],
  SUPERSEDED: [
    '{item} was not written: a newer value came while this one waited',
    'Nothing to do; switch "only the latest" off in the node to write every value.'
  ],
  MIXED_LINE: [
    '{owner} and {other} cannot share {line}: {reason}',
    'Change one of the numbers, or give one of them a line of its own.'
  ],
  BROADCAST_REFUSED: [
    '{what} cannot be broadcast: {reason}',
    'Allow broadcasts in the configuration, or address one station.'
  ],
  BROADCAST_UNCONFIRMED: [
    '{item} was sent to all stations of {line}; no station acknowledges a broadcast',
    'Read the stations one by one if you must know.'
  ],
  DUPLICATE_STATION: [
    '{owner} and {other} are both station {station} of {line}',
    'Use one configuration for one device, or correct the number.'
  ],
  // --- the simulator
  SIM_DEADLOCK: ['nothing can happen any more, but this is still open: {open}', 'Report it with the seed of the run.'],
  NO_PTY: [
    'no virtual serial port can be made: {reason}',
    'Use TCP, or install @lydell/node-pty beside this package (Linux, macOS).'
  ],
  NO_CONFIGURATION: ['{node} has no {what}', 'Choose one in the dialog of the node.']
})

/** Elements of a list or an object in an error's text: one of millions must not cost a second and a gigabyte. */
const MOST_SHOWN = 50
const MOST_TEXT = 200

const firstPairs = object => {
  const pairs = []
  for (const key in object) if (Object.hasOwn(object, key) && pairs.push([key, object[key]]) >= MOST_SHOWN) break
  return Object.fromEntries(pairs)
}

const shortened = value => {
  if (Array.isArray(value) || ArrayBuffer.isView(value)) {
    const isLong = /** @type {any} */ (value).length > MOST_SHOWN
    return isLong ? Array.from({ length: MOST_SHOWN }, (_, n) => value[n]) : value
  }
  return value !== null && typeof value === 'object' ? firstPairs(value) : value
}

/** Every list and object takes from the same allowance: they may be nested. */
const asJson = value => {
  let left = MOST_SHOWN
  return JSON.stringify(value, (_, inner) => (left-- > 0 ? shortened(inner) : undefined)) ?? String(value)
}

const textOf = value => {
  if (value === undefined) return '?'
  if (typeof value === 'string') return value
  try {
    return asJson(value)
  } catch {
    return typeof value // BigInt, or an object that contains itself: an error's text must not fail
  }
}

/** What would move the cursor, turn the text round or begin a line of its own in a log. */
// eslint-disable-next-line no-control-regex
const UNSEEN = /[\x00-\x1f\x7f-\x9f\u200e\u200f\u2028-\u202e\u2066-\u2069\ufeff]/g
const escaped = character => `\\u${character.charCodeAt(0).toString(16).padStart(4, '0')}`

const shown = value => textOf(value).slice(0, MOST_TEXT).replace(UNSEEN, escaped)

const fill = (text, details) => text.replace(/\{(\w+)\}/g, (_, name) => shown(details[name]))

/**
 * An error with a code from {@link CODES}. Compare codes, never texts.
 * @property {string} code the stable code (own property: Catch nodes show it)
 * @property {Record<string, any>} details what was filled into the text
 * @property {string} remedy what the user can do
 */
class PlcError extends Error {
  /**
   * @param {keyof typeof CODES} code
   * @param {Record<string, any> & { cause?: unknown }} [details] values for the text; `cause` becomes `Error.cause`
   */
  constructor(code, details = {}) {
    const row = CODES[code]
    if (!row) throw new TypeError(`unknown error code ${code}`)
    const { cause, ...rest } = details
    super(`${fill(row[0], rest)}. ${fill(row[1], rest)}`, cause === undefined ? undefined : { cause })
    this.name = 'PlcError'
    this.code = code
    this.details = rest
    this.remedy = fill(row[1], rest)
  }
}

const REFUSAL = /^(PLC|MODBUS|C24)_/

/**
 * Whether an error is the station's own word: an answer came, and it says no.
 * @param {any} error
 */
const isRefusal = error => typeof error?.code === 'string' && REFUSAL.test(error.code)

/**
 * What happened, without the advice: the text of an error is both.
 * @param {PlcError} error
 */
const causeOf = ({ message, remedy }) =>
  message.endsWith(`. ${remedy}`) ? message.slice(0, -remedy.length - 2) : message

/** Whether it is one of ours; what was thrown may be anything, also a proxy that throws when it is asked. @param {any} error @returns {boolean} */
const isPlcError = error => {
  try {
    return error instanceof PlcError
  } catch {
    return false
  }
}

/** What a thrown thing says. @param {any} error */
const reasonOf = error => {
  try {
    return String(error?.message ?? error)
  } catch {
    return 'it does not say why'
  }
}

module.exports = { CODES, PlcError, causeOf, isPlcError, isRefusal, reasonOf }
