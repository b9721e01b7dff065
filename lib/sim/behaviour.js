'use strict'

const { PlcError } = require('../error')

/**
 * What makes a simulated value live. A row is data: `{ at: 'W10', as: 'float32', kind: 'follows', of: 'K10', tau: 20000 }`.
 * Values change in steps of `every` ms, as with the scan of a PLC, and are computed from the clock when they are looked at:
 * a simulator with many live values costs nothing while nobody asks.
 */

const { PI, sin, exp, floor } = Math

/** A hash of two numbers: neighbours and successors differ in most bits. */
function mix(a, b) {
  let z = Math.imul(a ^ 0x9e3779b9, 0x85ebca6b) ^ Math.imul(b + 0x7f4a7c15, 0xc2b2ae35)
  z = Math.imul(z ^ (z >>> 15), 0x2c1b3c6d)
  return (z ^ (z >>> 13)) >>> 0
}

// kind: (row, time in ms, address) -> value. Pure ones can be asked for any moment; `follows` keeps a state
const KINDS = {
  counter: ({ from = 0, step = 1, every = 1000 }, t) => from + step * floor(t / every),
  ramp: ({ from = 0, to = 100, period = 60000 }, t) => from + ((to - from) * (t % period)) / period,
  sine: ({ from = 0, to = 100, period = 60000 }, t) => from + ((to - from) * (1 - sin((2 * PI * t) / period))) / 2,
  toggle: ({ period = 2000 }, t) => floor((2 * t) / period) & 1,
  random: ({ seed = 0, every = 100 }, t, address) => mix(address + seed * 65537, floor(t / every)) & 0xffff,
  follows: null
}

const modulo = (value, size) => ((Math.round(value) % size) + size) % size
const float = Buffer.alloc(4)

// data type -> words, low word first
const TYPES = {
  uint16: value => [modulo(value, 0x10000)],
  int16: value => [modulo(value, 0x10000)],
  uint32: value => TYPES.int32(value),
  int32: value => [modulo(value, 0x10000), modulo(floor(Math.round(value) / 0x10000), 0x10000)],
  float32(value) {
    float.writeFloatLE(value)
    return [float.readUInt16LE(0), float.readUInt16LE(2)]
  }
}
const FROM = {
  uint16: ([word]) => word,
  int16: ([word]) => (word << 16) >> 16,
  uint32: ([low, high]) => high * 0x10000 + low,
  int32: ([low, high]) => (high << 16) | low,
  float32([low, high]) {
    float.writeUInt16LE(low, 0)
    float.writeUInt16LE(high, 2)
    return float.readFloatLE(0)
  }
}

/**
 * Words of a number as a PLC holds it: low word first.
 * @param {string} type uint16, int16, uint32, int32 or float32
 * @param {number} value
 * @returns {number[]} one or two words
 * @throws {PlcError} BAD_TYPE
 */
const toWords = (type, value) => typeOf(TYPES, type)(value)

/**
 * @param {string} type
 * @param {number[]} words
 * @returns {number}
 * @throws {PlcError} BAD_TYPE
 */
const fromWords = (type, words) => typeOf(FROM, type)(words)

/** @param {string} type @returns {number} words that the type takes */
const wordsOf = type => typeOf(TYPES, type)(0).length

function typeOf(table, type) {
  if (Object.hasOwn(table, type)) return table[type]
  throw new PlcError('BAD_TYPE', {
    type,
    reason: 'the simulator does not have it',
    known: Object.keys(table).join(', ')
  })
}

/**
 * One live value.
 * @param {{ kind: string | ((time: number, address: number) => number), every?: number, pure?: boolean, [setting: string]: any }} row
 * @param {{ address: number, target?: () => number }} place absolute word (or bit) address; what `follows` follows
 * @returns {{ at: (time: number) => number, every: number, pure: boolean }} `at` gives the value at a moment (ms)
 * @throws {PlcError} BAD_SETTING unknown kind
 */
function createBehaviour(row, { address, target = () => 0 }) {
  const { kind } = row
  const every = row.every ?? 10
  if (typeof kind === 'function') {
    // a function that keeps a state of its own (heating.js) says so: it is asked for the present only
    if (row.pure === false) return { at: t => kind(t, address), every, pure: false }
    return { at: t => kind(floor(t / every) * every, address), every, pure: true }
  }
  if (!Object.hasOwn(KINDS, kind)) {
    const reason = `known are ${Object.keys(KINDS).join(', ')} and functions`
    throw new PlcError('BAD_SETTING', { setting: 'behaviour', value: kind, reason })
  }
  if (kind === 'follows') return { at: follower(row, target), every, pure: false }
  return { at: t => KINDS[kind](row, floor(t / every) * every, address), every, pure: true }
}

/**
 * First-order lag towards the target, as an oven behind its set point; `ripple` keeps the trend alive at rest.
 * @param {Record<string, any>} row
 * @param {() => number} target
 */
function follower({ tau = 20000, from = 0, gain = 1, ripple = 0 }, target) {
  let value = from
  let last = 0
  return t => {
    const goal = gain * target()
    value = goal + (value - goal) * exp(-Math.max(0, t - last) / tau)
    last = t
    return value + ripple * sin(t / 900)
  }
}

module.exports = { createBehaviour, toWords, fromWords, wordsOf, mix }
