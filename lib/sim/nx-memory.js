'use strict'

const { areaMap } = require('../codec/nx/areas')
const { parseAddress } = require('../codec/nx/address')
const { createWords } = require('./words')

const WORDS = 0x10000
const AS_BITS = 1
const AS_WORDS = 2
const ACCESS = { bits: AS_BITS, words: AS_WORDS, both: AS_BITS | AS_WORDS }

/**
 * The memory of one NX PLC: words (words.js), and which of them its CPU gives out, and how.
 *
 * @param {{ now: () => number, areas?: ReadonlyArray<Record<string, any>>, behaviour?: ReadonlyArray<Record<string, any>>,
 *   history?: boolean }} options areas: rows for the area map; the others see words.js
 * @returns {Memory}
 * @throws {PlcError} BAD_AREA, BAD_ADDRESS, BAD_TYPE, BAD_SETTING
 */
function createMemory({ now, areas: rows, behaviour, history }) {
  const areas = areaMap(rows)
  const access = accessOf(areas)
  const locate = text => parseAddress(text, areas)
  return {
    areas,
    has: (kind, address) =>
      kind === 'bit' ? (access[address >> 4] & AS_BITS) !== 0 : (access[address] & AS_WORDS) !== 0,
    ...createWords({ size: WORDS, now, locate, behaviour, history })
  }
}

function accessOf(areas) {
  const access = new Uint8Array(WORDS)
  for (const { base, words, as } of areas.list) access.fill(ACCESS[as], base, base + words)
  return access
}

/**
 * @typedef {import('./words').Words & {
 *   areas: import('../codec/nx/areas').AreaMap,
 *   has: (kind: 'bit'|'word', address: number) => boolean
 * }} Memory has: whether the CPU gives this address out so
 */

module.exports = { createMemory }
