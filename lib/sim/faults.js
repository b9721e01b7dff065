'use strict'

const { PlcError } = require('../error')
const { createRandom } = require('./random')

const NX_ERRORS = 5
const span = (least, most) => random => random.integer(least, most)
const whole = context => [{ bytes: context.bytes }]

// kind: what the number behind the rate means (its default, or how it is drawn), what happens to an answer, and in words.
// `lost`, `off` and `error` happen before the query is carried out: the wire does them (wire.js)
const KINDS = {
  lost: { text: 'the query is not heard' },
  silent: { text: 'the query is carried out, the answer is lost', answer: () => [] },
  off: { text: 'the station is dark for n ms (2000)', argument: 2000, least: 1, most: 1e6 },
  // the highest number is the protocol's: `errors` below
  error: { text: 'error number n (4) instead of the answer', argument: 4, least: 1, answer: whole },
  late: { text: 'the answer is n ms late (100..900)', argument: span(100, 900), least: 0, most: 1e6, answer: late },
  crc: { text: 'n bits of the answer are flipped (1..3)', argument: span(1, 3), least: 1, most: 100, answer: damaged },
  truncated: {
    text: 'the last n bytes are missing (1 to all but one)',
    argument: 0,
    least: 0,
    most: 300,
    answer: truncated
  },
  duplicated: {
    text: 'the answer comes twice, n ms apart (0..3)',
    argument: span(0, 3),
    least: 0,
    most: 1e6,
    answer: twice
  },
  foreign: { text: "another station's answer comes first", answer: foreign },
  before: {
    text: 'n bytes of noise before the answer (1..6)',
    argument: span(1, 6),
    least: 1,
    most: 1000,
    answer: noiseBefore
  },
  after: {
    text: 'n bytes of noise after the answer (1..6)',
    argument: span(1, 6),
    least: 1,
    most: 1000,
    answer: noiseAfter
  },
  echo: { text: 'the query comes back before the answer', answer: echo },
  merged: { text: 'the answer before this one follows it without a pause', answer: merged }
}

function late({ bytes, argument }) {
  return [{ bytes, after: argument }]
}

function damaged({ bytes, argument, random }) {
  const copy = Buffer.from(bytes)
  const places = new Set()
  while (places.size < Math.min(argument, copy.length * 8)) places.add(random.integer(0, copy.length * 8 - 1))
  for (const place of places) copy[place >> 3] ^= 1 << (place & 7)
  return [{ bytes: copy }]
}

function truncated({ bytes, argument, random }) {
  const missing = argument > 0 ? argument : random.integer(1, bytes.length - 1)
  return [{ bytes: bytes.subarray(0, Math.max(0, bytes.length - missing)) }]
}

function twice({ bytes, argument }) {
  return [{ bytes }, { bytes, after: argument }]
}

function foreign({ bytes, station, random, taken }) {
  return [{ bytes: station.disguise(bytes, { random, taken }) }, { bytes }]
}

function noiseBefore({ bytes, argument, random }) {
  return [{ bytes: Buffer.concat([random.bytes(argument), bytes]) }]
}

function noiseAfter({ bytes, argument, random }) {
  return [{ bytes: Buffer.concat([bytes, random.bytes(argument)]) }]
}

function echo({ bytes, request }) {
  return [{ bytes: Buffer.concat([request, bytes]) }]
}

function merged({ bytes, previous }) {
  return [{ bytes: previous ? Buffer.concat([bytes, previous]) : bytes }]
}

/**
 * What goes out instead of an answer.
 * @param {string} kind
 * @param {{ bytes: Buffer, previous: Buffer | null, request: Buffer, station: any, random: import('./random').Random, argument: any,
 *   taken: number[] }} context taken: the stations on the wire
 * @returns {{ bytes: Buffer, after?: number }[]} after: ms later than the answer would have started
 */
const applyFault = (kind, context) => KINDS[kind].answer(context)

/**
 * The faults of a wire: each answer suffers at most one, drawn from a seed or ordered beforehand.
 *
 * @param {{ random?: import('./random').Random, rates?: Fault[], errors?: number }} [options] errors: highest number of an error
 * @returns {Faults}
 * @throws {PlcError} BAD_SETTING
 */
function createFaults({ random = createRandom(1), rates = [], errors = NX_ERRORS } = {}) {
  /** @type {Map<string, { rate: number, argument?: number }>} */
  const active = new Map()
  /** @type {Record<string, number>} */
  const counts = {}
  /** @type {{ kind: string, argument?: number, station?: number, times: number, skip: number }[]} */
  const ordered = []

  /** @param {{ kind: string, argument?: number }} fault */
  const take = ({ kind, argument }) => {
    counts[kind] = (counts[kind] ?? 0) + 1
    const standard = KINDS[kind].argument
    return { kind, argument: argument ?? (typeof standard === 'function' ? standard(random) : standard) }
  }
  const set = (kind, rate, argument) => {
    const others = [...active].reduce((sum, [name, each]) => sum + (name === kind ? 0 : each.rate), 0)
    check({ kind, rate, argument }, { others, errors })
    if (rate > 0) active.set(kind, { rate, argument })
    else active.delete(kind)
  }
  /** @type {Faults['once']} */
  const once = (kind, { argument, station, times = 1, skip = 0 } = {}) => {
    check({ kind, rate: 0, argument }, { others: 0, errors })
    ordered.push({ kind, argument, station, times, skip })
  }
  const draw = station => {
    const order = nextOrder(ordered, station)
    if (order !== undefined) return order && take(order)
    const kind = active.size > 0 ? pick(active, random.next()) : null
    return kind && take({ kind, argument: active.get(kind)?.argument })
  }
  const clear = () => {
    active.clear()
    ordered.length = 0
  }
  for (const { kind, rate, argument } of rates) set(kind, rate, argument)
  return { draw, set, once, clear, counts }
}

/** What is ordered for this station: a fault, null (not yet), undefined (nothing). */
function nextOrder(ordered, station) {
  const order = ordered.find(each => each.station === undefined || each.station === station)
  if (!order) return undefined
  if (order.skip-- > 0) return null
  if (--order.times <= 0) ordered.splice(ordered.indexOf(order), 1)
  return order
}

function pick(active, share) {
  let left = share
  for (const [kind, { rate }] of active) {
    left -= rate
    if (left < 0) return kind
  }
  return null
}

/**
 * @param {Fault} fault
 * @param {{ others: number, errors: number }} context others: sum of the other rates; errors: highest number of an error
 */
function check({ kind, rate, argument }, { others, errors }) {
  const value = [kind, rate, argument].filter(each => each !== undefined && !Number.isNaN(each)).join(':')
  const refuse = reason => new PlcError('BAD_SETTING', { setting: 'fault', value, reason })
  if (!Object.hasOwn(KINDS, kind)) throw refuse(`known faults are ${Object.keys(KINDS).join(', ')}`)
  if (!(rate >= 0 && rate <= 1)) throw refuse('the rate must be a number from 0 to 1, as in late:0.02')
  if (rate + others > 1 + 1e-9) throw refuse('the rates add up to more than 1')
  if (argument === undefined) return
  const { least, most = errors } = KINDS[kind]
  if (least === undefined) throw refuse(`${kind} takes a rate alone`)
  if (!Number.isInteger(argument) || argument < least || argument > most) {
    throw refuse(`the number after the rate must be a whole one from ${least} to ${most}`)
  }
}

/**
 * Reads `late:0.02,crc:0.01,error:0.05:2`: kind, rate 0..1, and, where the kind has one, a number.
 * @param {string} text '' = none
 * @param {{ errors?: number }} [options] highest number of an error: 5 for NX (default), 255 for MODBUS
 * @returns {Fault[]}
 * @throws {PlcError} BAD_SETTING
 */
function parseFaults(text, { errors = NX_ERRORS } = {}) {
  const parts = text
    .split(',')
    .map(part => part.trim())
    .filter(Boolean)
  let sum = 0
  return parts.map(part => {
    const [kind, rate = '', argument, more] = part.split(':').map(each => each.trim())
    const number = each => (/^\d+(\.\d+)?$/.test(each) ? Number(each) : NaN)
    if (more !== undefined) {
      throw new PlcError('BAD_SETTING', {
        setting: 'fault',
        value: part,
        reason: 'it is kind:rate or kind:rate:number'
      })
    }
    const fault = { kind, rate: number(rate), argument: argument === undefined ? undefined : number(argument) }
    check(fault, { others: sum, errors })
    sum += fault.rate
    return fault
  })
}

/** Kinds and what they do, for help texts. */
const faultKinds = () => Object.entries(KINDS).map(([kind, { text }]) => ({ kind, text }))

/**
 * @typedef {{ kind: string, rate: number, argument?: number }} Fault
 * @typedef {object} Faults
 * @property {(station: number) => { kind: string, argument: any } | null} draw
 * @property {(kind: string, rate: number, argument?: number) => void} set rate 0 switches off
 * @property {(kind: string, options?: { argument?: number, station?: number, times?: number, skip?: number }) => void} once
 *   the next answer (of that station), `times` of them, after `skip` unharmed ones
 * @property {() => void} clear
 * @property {Record<string, number>} counts how often each happened
 */

module.exports = { createFaults, applyFault, parseFaults, faultKinds }
