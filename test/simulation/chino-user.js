'use strict'

/**
 * What the users of regulators do in a safety run: the first 128 registers, inputs and coils live; what is written lies apart. Addresses are
 * absolute, as `heldBetween` takes them.
 */

const { createChinoRegulator } = require('../../lib/device/chino-regulator')

const INPUT = 0x10000
const COILS = 0x200000
const DISCRETES = 0x210000
const SET = 320 // set values: registers that are written with numbers
const BITS = 1000 // registers of which one bit is written, each once
const SWITCHES = 2000 // coils, each written once
const MANY = 4096 // as long as a range can be

const words = Array.from({ length: 128 }, (_, n) => [{ at: `ir${n}` }, { at: `hr${n}` }]).flat()
const bits = Array.from({ length: 8 }, (_, n) => [
  { at: `co${16 * n}`, as: 'uint16' },
  { at: `di${16 * n}`, as: 'uint16' }
]).flat()
const LIVE = [...words, ...bits]

const RANGES = [
  `hr${SET}..hr${SET + 127}`,
  `hr${BITS}..hr${BITS + MANY - 1}`,
  `co${SWITCHES}..co${SWITCHES + MANY - 1}`
]

const createDevice = ({ protocol, settings }, common) =>
  createChinoRegulator({ ...common, protocol, ...settings, writableRanges: RANGES })

function randomWord(random) {
  const number = random.integer(0, 127)
  return { text: `ir${number}`, unit: 'word', address: INPUT + number, count: 1 }
}

const two = number => String(number).padStart(2, '0')

function randomItem(random) {
  if (random.chance(0.4)) return randomBits(random)
  const [table, base, first] = random.pick([
    ['ir', INPUT, 0],
    ['hr', 0, 0],
    ['hr', 0, SET]
  ])
  const number = first + random.integer(0, 110)
  if (random.chance(0.3)) {
    const bit = random.integer(0, 15)
    return { text: `${table}${number}.${two(bit)}`, unit: 'bit', address: (base + number) * 16 + bit, count: 1 }
  }
  const count = random.chance(0.3) ? random.integer(2, 16) : 1
  return { text: rangeOf(table, number, count), unit: 'word', address: base + number, count }
}

/** Coils and discrete inputs: one, several, or sixteen as a word, which need not be aligned. */
function randomBits(random) {
  const [table, base] = random.pick([
    ['co', COILS],
    ['di', DISCRETES]
  ])
  const number = random.integer(0, 90)
  if (random.chance(0.3)) return { text: `${table}${number}:uint16`, unit: 'packed', address: base + number, count: 16 }
  const count = random.chance(0.5) ? random.integer(2, 32) : 1
  return { text: rangeOf(table, number, count), unit: 'bit', address: base + number, count }
}

const rangeOf = (table, number, count) =>
  count === 1 ? `${table}${number}` : `${table}${number}..${table}${number + count - 1}`

/** A value that was never written before, or a place that never was, so that each write can be told from all others. */
function newEntry({ serial, random }, number) {
  const fresh = serial()
  const kind = random.next()
  if (kind < 0.5)
    return { item: `hr${SET + number}`, value: fresh & 0xffff, key: `hr${SET + number}:${fresh & 0xffff}` }
  const place = fresh % MANY
  if (kind < 0.75) return { item: `co${SWITCHES + place}`, value: true, key: `co${SWITCHES + place}` }
  return { item: `hr${BITS + place}.${two(random.integer(0, 15))}`, value: true, key: `hr${BITS + place}` }
}

/** The keys of entries that a query writes. */
function keysOf({ fn, base, values, value }) {
  if (fn < 5) return []
  const table = fn === 5 || fn === 15 ? 'co' : 'hr'
  return (values ?? [value]).map((each, n) => {
    const at = base + n
    return table === 'hr' && at < BITS ? `hr${at}:${each}` : `${table}${at}`
  })
}

module.exports = { LIVE, createDevice, keysOf, newEntry, randomItem, randomWord }
