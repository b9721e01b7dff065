'use strict'

const { PlcError } = require('../error')

const HOUR = 3600000

const number = (fallback, least, most) => ({ kind: 'number', fallback, least, most })
const choice = (fallback, ...known) => ({ kind: 'choice', fallback, known })
const text = fallback => ({ kind: 'text', fallback })

/** Every setting of a line: its default and what it may be. Times in ms; 0 = automatic where the default is 0. */
const SETTINGS = Object.freeze({
  transport: choice('serial', 'serial', 'tcp', 'simulated'),
  name: text(''),
  path: text(''),
  host: text(''),
  port: { ...number(0, 0, 65535), whole: true },
  baudRate: { ...number(19200, 1, 10000000), whole: true },
  dataBits: choice(8, 8, 7),
  parity: choice('none', 'none', 'even', 'odd'),
  stopBits: choice(1, 1, 2),
  flowControl: choice('none', 'none', 'rtscts', 'xonxoff'),
  dtr: choice('unchanged', 'unchanged', 'on', 'off'),
  rts: choice('unchanged', 'unchanged', 'on', 'off'),
  openDelay: number(0, 0, 60000),
  gap: number(0, 0, 10000),
  echo: choice('auto', 'auto', 'on', 'off'),
  slack: number(0, 0, 60000),
  latenessBound: number(0, 0, HOUR),
  openGrace: number(2000, 0, 60000),
  connectTimeout: number(5000, 1, HOUR),
  keepAlive: number(10000, 0, HOUR),
  writeTimeout: number(1000, 1, 60000),
  jamTime: number(1000, 10, 60000),
  queueLimit: { ...number(1000, 1, 1000000), whole: true },
  writesBeforePoll: { ...number(4, 1, 1000), whole: true }
})

const bad = (setting, value, reason) =>
  new PlcError('BAD_SETTING', { setting, value: value === '' ? 'empty' : value, reason })

const readNumber = (name, rule, raw) => {
  const value = typeof raw === 'string' ? Number(raw) : raw
  if (!Number.isFinite(value)) throw bad(name, raw, 'a number is needed')
  if (value < rule.least || value > rule.most) throw bad(name, raw, `allowed is ${rule.least} to ${rule.most}`)
  if (rule.whole && !Number.isInteger(value)) throw bad(name, raw, 'a whole number is needed')
  return value
}

const readChoice = (name, rule, raw) => {
  const found = rule.known.find(value => value === raw || (typeof raw === 'string' && String(value) === raw.trim()))
  if (found === undefined) throw bad(name, raw, `known are ${rule.known.join(', ')}`)
  return found
}

const readText = (name, raw) => {
  if (typeof raw !== 'string') throw bad(name, raw, 'text is needed')
  const value = raw.trim()
  if (value.includes('\0')) throw bad(name, 'with a zero byte', 'it cannot be a name')
  return value
}

const read = (name, rule, raw) => {
  if (raw === undefined || raw === null || raw === '') return rule.fallback
  if (rule.kind === 'number') return readNumber(name, rule, raw)
  return rule.kind === 'choice' ? readChoice(name, rule, raw) : readText(name, raw)
}

const UPWARDS = /(^|[\\/])\.\.([\\/]|$)/

/** What each transport cannot do without. */
const NEEDS = {
  serial: s => {
    if (!s.path) throw bad('path', s.path, 'a serial line needs the path of its port')
    if (UPWARDS.test(s.path)) throw bad('path', s.path, 'the name of a port does not lead upwards')
  },
  tcp: s => {
    if (!s.host) throw bad('host', s.host, 'a line over TCP needs the host of the serial server')
    if (!s.port) throw bad('port', s.port, 'allowed is 1 to 65535')
  },
  simulated: s => {
    if (typeof s.wire?.connect !== 'function') throw bad('wire', typeof s.wire, 'a simulated line needs a wire')
  }
}

/**
 * The settings of a line, complete and checked. Numbers may come as text; what is missing or empty is the default;
 * unknown properties are left out.
 * @param {Record<string, any>} raw
 * @returns {Readonly<Record<string, any>>} all of {@link SETTINGS}, and `wire` of a simulated line
 * @throws {PlcError} BAD_SETTING with the name of the setting
 */
function lineSettings(raw) {
  if (raw === null || typeof raw !== 'object') throw bad('the line', raw, 'an object of settings is needed')
  /** @type {Record<string, any>} */
  const settings = {}
  for (const [name, rule] of Object.entries(SETTINGS)) settings[name] = read(name, rule, raw[name])
  if (settings.transport === 'simulated') settings.wire = raw.wire
  NEEDS[settings.transport](settings)
  return Object.freeze(settings)
}

/**
 * The pool's key of a wire: what the user typed.
 * @param {Record<string, any>} settings normalised
 */
const wireKey = settings => {
  if (settings.transport === 'tcp') return `${settings.host.toLowerCase()}:${settings.port}`
  return settings.transport === 'serial' ? settings.path : `simulated:${settings.path}`
}

/** How texts call the line. */
const lineName = settings => settings.name || wireKey(settings)

/**
 * The first setting in which two configurations of one wire differ; the name may.
 * @returns {string} '' if there is none
 */
const difference = (one, other) => {
  const keys = [...Object.keys(SETTINGS), 'wire'].filter(key => key !== 'name')
  const key = keys.find(name => one[name] !== other[name])
  if (key === undefined) return ''
  return key === 'wire' ? 'two different wires' : `${key} ${one[key]} and ${other[key]}`
}

module.exports = { SETTINGS, difference, lineName, lineSettings, wireKey }
