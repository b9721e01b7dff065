'use strict'

const { PlcError } = require('../error')

// buffer memory of the two channels: first address of each area; error information; results of the bidirectional protocol
const CHANNELS = {
  1: { send: 0x400, receive: 0x600, error: 0x201, sendResult: 0x257, receiveResult: 0x258 },
  2: { send: 0x800, receive: 0xa00, error: 0x202, sendResult: 0x267, receiveResult: 0x268 }
}
const OS_AREA = 8448
// both areas: a count and 511 words; the module's own default
const AREA_WORDS = 512

const bad = (setting, value, reason) => new PlcError('BAD_SETTING', { setting, value, reason })

const oneOf =
  (...list) =>
  (value, name) => {
    if (!list.includes(value)) throw bad(name, value, `it must be ${list.join(', ')}`)
    return value
  }
const number =
  (least, most, { whole = true } = {}) =>
  (value, name) => {
    if (typeof value === 'number' && value >= least && value <= most && (!whole || Number.isInteger(value)))
      return value
    throw bad(name, value, `it must be a ${whole ? 'whole ' : ''}number from ${least} to ${most}`)
  }
const hex = most => (value, name) => {
  if (Buffer.isBuffer(value) && value.length <= most) return value
  const text = String(value).replace(/\s/g, '')
  if (/^([0-9a-f]{2})*$/i.test(text) && text.length <= most * 2) return Buffer.from(text, 'hex')
  throw bad(name, value, `it must be up to ${most} bytes in hex, as in 0D 0A`)
}
const yes = oneOf(true, false)
const rate = number(0, Infinity, { whole: false })

/**
 * Setting: default, check.
 * @type {Record<string, [any, (value: any, name: string) => any]>}
 */
const TABLE = {
  station: [1, number(0, 255)],
  channel: [1, number(1, 2)],
  baudRate: [19200, number(50, 4e6)],
  bitsPerByte: [10, number(7, 12)],
  protocol: ['non-procedure', oneOf('non-procedure', 'bidirectional')],
  unit: ['word', oneOf('word', 'byte')],
  end: ['0D 0A', hex(2)],
  first: ['', hex(80)],
  last: ['', hex(80)],
  storeEnd: [false, yes],
  count: [AREA_WORDS - 1, number(1, 2 * (AREA_WORDS - 1))],
  timer0: [0, number(0, 65535)],
  flow: ['none', oneOf('none', 'dc', 'dtr')],
  stopFree: [64, number(64, 4095)],
  goFree: [263, number(263, 4096)],
  transparent: ['', hex(8)],
  asciiBinary: [false, yes],
  sumCheck: [true, yes],
  simultaneous: ['both', oneOf('both', 'receive', 'send', 'none')],
  ackTimeout: [5000, number(1, 1e6, { whole: false })],
  retries: [0, number(0, 100)],
  turnaround: [2, number(0, 60000, { whole: false })],
  rate: [Infinity, rate],
  byteRate: [Infinity, rate],
  history: [1000, number(0, 1e6)],
  program: ['take', value => value],
  speaks: [null, value => value],
  onMessage: [null, value => value],
  onSent: [null, value => value]
}

/**
 * @param {{ clock: any, [setting: string]: any }} settings see melsec-c24.js
 * @returns {any} with defaults, hex as bytes, and what follows from them
 * @throws {PlcError} BAD_SETTING
 */
function c24Settings({ clock, ...given }) {
  const own = Object.fromEntries(
    Object.entries(TABLE).map(([name, [standard, check]]) => [name, check(given[name] ?? standard, name)])
  )
  if (own.stopFree >= own.goFree) throw bad('goFree', own.goFree, `it must be more than stopFree ${own.stopFree}`)
  if (!['take', 'echo'].includes(own.program) && typeof own.program !== 'function') {
    throw bad('program', own.program, 'it must be take, echo or a function')
  }
  const most = own.unit === 'word' ? AREA_WORDS - 1 : 2 * (AREA_WORDS - 1)
  if (own.count > most) throw bad('count', own.count, `the receive area holds ${most} ${own.unit}s`)
  return {
    ...own,
    clock,
    at: CHANNELS[own.channel],
    byteMs: (own.bitsPerByte * 1000) / own.baudRate,
    // its unit is a byte of 12 bits
    timer0Ms: (own.timer0 * 12000) / own.baudRate,
    mostBytes: own.unit === 'word' ? own.count * 2 : own.count
  }
}

module.exports = { c24Settings, OS_AREA, AREA_WORDS }
