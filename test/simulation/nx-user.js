'use strict'

/** What the users of NX PLCs do in a safety run: M and W live, K is written. Addresses are absolute, as `heldBetween` takes them. */

const { createNxPlc } = require('../../lib/device/nx-plc')

const M0 = 0xc0
const K0 = 0x140
const W0 = 0x200

const LIVE = Array.from({ length: 128 }, (_, n) => [{ at: `M${n}` }, { at: `W${n}` }]).flat()

const createDevice = (row, common) => {
  const { steps, soleMaster, settings } = row
  return createNxPlc({ ...common, steps, soleMaster, ...settings, writableRanges: 'K0..K127' })
}

function randomWord(random) {
  const number = random.integer(0, 127)
  return { text: `W${number}`, unit: 'word', address: W0 + number, count: 1 }
}

function randomItem(random) {
  const [area, base] = random.pick([
    ['M', M0],
    ['W', W0],
    ['K', K0]
  ])
  const number = random.integer(0, 110)
  if (area !== 'W' && random.chance(0.3)) {
    const bit = random.integer(0, 15)
    return { text: `${area}${number}.${bit}`, unit: 'bit', address: (base + number) * 16 + bit, count: 1 }
  }
  const count = random.chance(0.3) ? random.integer(2, 16) : 1
  const text = count === 1 ? `${area}${number}` : `${area}${number}..${area}${number + count - 1}`
  return { text, unit: 'word', address: base + number, count }
}

/** A value that was never written before, so that each write can be told from all others. */
function newEntry({ serial }, number) {
  const value = serial() & 0xffff
  return { item: `K${number}`, value, key: `${K0 + number}:${value}` }
}

/** The keys of entries that a query writes. */
function keysOf(query) {
  if (!query.ask.startsWith('write')) return []
  const places = query.writes ?? query.values.map((value, n) => ({ address: query.base + n, value }))
  return places.map(({ address, value }) => `${address}:${value}`)
}

module.exports = { LIVE, createDevice, keysOf, newEntry, randomItem, randomWord }
