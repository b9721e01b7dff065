'use strict'
const { wrongRows } = require('./causes')

/**
 * The "communication diagnostics sheet" of the panel's manual (3.3), filled in by what was seen. Pure.
 *
 * @typedef {object} Row
 * @property {string} id
 * @property {string} item what the sheet calls it
 * @property {'measured'|'configured'|'byHand'} state how the value is known
 * @property {any} value null: not known here
 * @property {'ok'|'ng'|'open'} result open: neither proven nor disproven
 * @property {string} text what was seen
 *
 * @typedef {{ state: Row['state'], result: Row['result'], text: string }} Verdict
 */

const DRIVERS = {
  nx: 'OE MAX NX PLC',
  rtu: 'CHINO thyristor regulator (MODBUS)',
  ascii: 'CHINO thyristor regulator (MODBUS)'
}
const PROTOCOLS = {
  nx: ({ steps }) => `NX, ${steps}-step`,
  rtu: () => 'MODBUS RTU',
  ascii: () => 'MODBUS ASCII'
}
const SYSTEMS = {
  serial: 'serial port',
  tcp: 'serial server over TCP',
  simulated: 'simulated line'
}

const own = name => facts => facts.wire[name]
const protocolOf = facts => PROTOCOLS[facts.protocol](facts)
const echoText = ({ echo }) => ({ present: ', the adapter hears itself (2-wire)', absent: '' })[echo] ?? ''
/** @param {Record<string, any>} facts */
const systemOf = ({ wire, echo }) => (SYSTEMS[wire.transport] ?? 'line') + echoText({ echo })
/** @param {Record<string, any>} facts */
const timesOf = ({ timeout, wire }) => `timeout ${timeout} ms, gap ${wire.gap || 'automatic'}`

/**
 * A row of the sheet, in the manual's order. kind: `wire` is proven by any answer of the station; `framing` likewise, but for a serial server, which has its own; `port` by a line that is
 * open; `device` is what was heard of the other side; `hand` must be looked at; `address` is proven by a value.
 * @param {string} id @param {string} item @param {string} kind @param {(facts: Record<string, any>) => any} valueOf
 */
const row = (id, item, kind, valueOf) => Object.freeze({ id, item, kind, valueOf })

const ROWS = Object.freeze([
  // id                  item                                          kind       value
  row('systemConfiguration', 'How to connect the system', 'wire', systemOf),
  row('cable', 'Connection cable name', 'hand', () => null),
  row('version', 'Version information', 'hand', () => null),
  row('port', 'Port in use', 'port', facts => facts.path),
  row('driver', 'Driver name', 'wire', ({ protocol }) => DRIVERS[protocol]),
  row('otherSettings', 'Other detailed settings', 'wire', timesOf),
  row('prefixProject', 'Relative prefix: project setting', 'wire', ({ station }) => station),
  row('prefixDiagnosis', 'Relative prefix: communication diagnostics', 'wire', ({ heard }) => heard),
  row('speed', 'Transmission speed', 'framing', own('baudRate')),
  row('dataBits', 'Data bit', 'framing', own('dataBits')),
  row('stopBits', 'Stop bit', 'framing', own('stopBits')),
  row('parity', 'Parity bit', 'framing', own('parity')),
  row('cpuName', 'External device: CPU name', 'hand', () => null),
  row('devicePort', 'External device: communication port name', 'hand', () => null),
  row('protocol', 'External device: protocol (mode)', 'wire', protocolOf),
  row('devicePrefix', 'External device: set-up prefix', 'device', ({ heard }) => heard),
  row('deviceSettings', 'External device: other detailed settings', 'hand', () => null),
  row('deviceSpeed', 'External device: transmission speed', 'device', ({ found }) => found?.baudRate),
  row('deviceDataBits', 'External device: data bit', 'device', ({ found }) => found?.dataBits),
  row('deviceStopBits', 'External device: stop bit', 'hand', () => null),
  row('deviceParity', 'External device: parity bit', 'device', ({ found }) => found?.parity),
  row('addressRange', 'Check address range', 'address', ({ item }) => item)
])

const BY_HAND = {
  cable: 'compare it with the wiring page',
  version: 'nothing on the wire tells it',
  cpuName: 'read it from the nameplate',
  devicePort: 'look which connector of the device is used',
  deviceStopBits: 'an answer does not tell one stop bit from two',
  deviceSettings: 'compare them with the manual of the device'
}

/** @param {Record<string, any>} facts @returns {Verdict} */
const proven = facts =>
  facts.answered
    ? { state: 'measured', result: 'ok', text: 'the station answers with it' }
    : { state: 'configured', result: 'open', text: 'not proven: no answer' }

const OF_SERVER = 'the serial server has a setting of its own; this one is for the arithmetic of times'

/** Somebody else's number. @param {string} id @param {Record<string, any>} facts */
const isForeign = (id, { heard, station }) => id === 'devicePrefix' && heard !== station

/** What is not `wrong`: proven, or open. @type {Record<string, (facts: Record<string, any>, value: any, id: string) => Verdict>} */
const KINDS = {
  wire: facts => proven(facts),
  framing: (facts, _value, id) => {
    if (!facts.answered) return proven(facts)
    const text = facts.wire.transport === 'tcp' ? OF_SERVER : id === 'stopBits' ? BY_HAND.deviceStopBits : ''
    return text ? { state: 'configured', result: 'open', text } : proven(facts)
  },
  port: ({ opened }) =>
    opened
      ? { state: 'measured', result: 'ok', text: 'it could be opened, and took the query' }
      : { state: 'configured', result: 'open', text: 'nothing was sent' },
  device: (facts, value, id) =>
    value === null
      ? { state: 'byHand', result: 'open', text: 'look at the device' }
      : { state: 'measured', result: isForeign(id, facts) ? 'open' : 'ok', text: 'heard on the wire' },
  hand: (facts, _value, id) =>
    id === 'cable' && facts.answered
      ? { state: 'byHand', result: 'ok', text: 'it carries frames both ways' }
      : { state: 'byHand', result: 'open', text: BY_HAND[id] },
  address: facts => {
    const { ok, value, goesOut } = facts
    if (value !== undefined) return { state: 'measured', result: 'ok', text: `${goesOut}: ${JSON.stringify(value)}` }
    return ok
      ? { state: 'measured', result: 'open', text: `the device refuses ${goesOut}: enter an address that it has` }
      : { state: 'configured', result: 'open', text: `asked for was ${goesOut}` }
  }
}

/** Linux tells how long an FTDI adapter keeps the end of an answer back; a row of ours, not of the manual. */
/** @param {{ file: string, value: number }} latency @returns {Row} */
const latencyRow = ({ file, value }) => ({
  id: 'latencyTimer',
  item: 'Latency timer of the USB adapter',
  state: 'measured',
  value,
  result: value > 1 ? 'open' : 'ok',
  text:
    value > 1
      ? `each answer comes up to ${value} ms later than need be. To change it: echo 1 > ${file} (as root)`
      : 'it is as short as it can be'
})

/**
 * @param {Record<string, any>} facts `{ wire, path, protocol, station, steps, timeout, echo, item, goesOut, value, ok, answered, opened, heard,
 *   found, cause, latency }`; heard: number under which the station, or another one, was heard; found: framing with which it answers
 * @returns {Row[]}
 */
function fillSheet(facts) {
  const { cause, latency } = facts
  const wrong = cause ? wrongRows(cause.code) : []
  const rows = ROWS.map(({ id, item, kind, valueOf }) => {
    const value = valueOf(facts) ?? null
    const seen = KINDS[kind](facts, value, id)
    const bad = wrong.includes(id) && differs(id, facts)
    /** @type {Verdict} */
    const verdict = bad ? { ...seen, result: 'ng', text: cause.text } : seen
    // what could not even be opened is known for certain, what the wire says is, too
    if (bad && verdict.state === 'configured') verdict.state = 'measured'
    return { id, item, value, ...verdict }
  })
  return latency ? [...rows, latencyRow(latency)] : rows
}

const FRAMING = { speed: 'baudRate', parity: 'parity', dataBits: 'dataBits' }

/** Of a framing only what differs is wrong. @param {string} id @param {Record<string, any>} facts */
const differs = (id, { found, wire }) => !found || !FRAMING[id] || found[FRAMING[id]] !== wire[FRAMING[id]]

module.exports = { ROWS, fillSheet }
