'use strict'

const { areaMap } = require('../codec/nx/areas')
const { parseAddress } = require('../codec/nx/address')
const { createBehaviour, toWords, fromWords, wordsOf } = require('./behaviour')

const WORDS = 0x10000
const MOST_HISTORY = 1000 // changes of one word that are kept at least
const AS_BITS = 1
const AS_WORDS = 2
const ACCESS = { bits: AS_BITS, words: AS_WORDS, both: AS_BITS | AS_WORDS }

/**
 * The memory of one NX PLC: words; a bit is a view on its word. Live values are brought up to date when they are looked at.
 *
 * @param {{ now: () => number, areas?: ReadonlyArray<Record<string, any>>, behaviour?: ReadonlyArray<Record<string, any>>,
 *   history?: boolean }} options areas: rows for the area map; history: keep what each word held, for `heldBetween`
 * @returns {Memory}
 * @throws {PlcError} BAD_AREA, BAD_ADDRESS, BAD_TYPE, BAD_SETTING
 */
function createMemory({ now, areas: rows, behaviour = [], history = false }) {
  const areas = areaMap(rows)
  const words = new Uint16Array(WORDS)
  const log = history ? new Map() : null
  const access = accessOf(areas)

  const store = (word, value) => {
    if (log && words[word] !== value) {
      const entries = log.get(word) ?? log.set(word, [[-Infinity, words[word]]]).get(word)
      entries.push([now(), value])
      if (entries.length > 2 * MOST_HISTORY) entries.splice(0, MOST_HISTORY)
    }
    words[word] = value
  }
  const peek = word => {
    live.refresh(word)
    return words[word]
  }
  const live = createLive(behaviour, { now, areas, words, store, peek })
  const write = (word, value) => {
    // what follows this word has followed the old value until now
    live.settle()
    store(word, value & 0xffff)
  }
  return {
    areas,
    has: (kind, address) =>
      kind === 'bit' ? (access[address >> 4] & AS_BITS) !== 0 : (access[address] & AS_WORDS) !== 0,
    readWord: peek,
    readBit: bit => ((peek(bit >> 4) >> (bit & 15)) & 1) === 1,
    writeWord: write,
    writeBit(bit, on) {
      const mask = 1 << (bit & 15)
      const old = peek(bit >> 4)
      write(bit >> 4, on ? old | mask : old & ~mask)
    },
    ...byText({ areas, peek, write }),
    heldBetween: (word, from, to) => live.between(word, from, to) ?? heldBetween(log, words[word], { word, from, to })
  }
}

function accessOf(areas) {
  const access = new Uint8Array(WORDS)
  for (const { base, words, as } of areas.list) access.fill(ACCESS[as], base, base + words)
  return access
}

/** Values by notation, for demos and tests: `get('W10', 'float32')`, `set('K127.12', true)`. */
function byText({ areas, peek, write }) {
  const get = (text, type = 'uint16') => {
    const { kind, address } = parseAddress(text, areas)
    if (kind === 'bit') return ((peek(address >> 4) >> (address & 15)) & 1) === 1
    return fromWords(
      type,
      Array.from({ length: wordsOf(type) }, (_, n) => peek(address + n))
    )
  }
  const set = (text, value, type = 'uint16') => {
    const { kind, address } = parseAddress(text, areas)
    if (kind === 'word') return toWords(type, Number(value)).forEach((word, n) => write(address + n, word))
    const mask = 1 << (address & 15)
    write(address >> 4, value ? peek(address >> 4) | mask : peek(address >> 4) & ~mask)
  }
  return { get, set }
}

function heldBetween(log, present, { word, from, to }) {
  const entries = log?.get(word)
  if (!entries) return [present]
  const held = []
  for (let n = entries.length - 1; n >= 0; n--) {
    const [since, value] = entries[n]
    if (since <= to) held.unshift(value)
    if (since <= from) break
  }
  return held
}

/** The live values: which word belongs to which, and bringing one up to date. */
function createLive(rows, { now, areas, words, store, peek }) {
  const byWord = new Map()
  const stateful = []
  for (const row of rows) {
    const cell = createCell(row, { areas, peek })
    for (let n = 0; n < cell.size; n++) byWord.set(cell.word + n, [...(byWord.get(cell.word + n) ?? []), cell])
    if (!cell.behaviour.pure) stateful.push(cell)
  }
  const update = cell => {
    const time = now()
    if (cell.time === time) return
    cell.time = time
    const values = cell.encode(cell.behaviour.at(time), words[cell.word])
    // pure ones can be asked for any moment: they need no history
    if (cell.askable) values.forEach((value, n) => (words[cell.word + n] = value))
    else values.forEach((value, n) => store(cell.word + n, value))
  }
  return {
    refresh: word => byWord.get(word)?.forEach(update),
    settle: () => stateful.forEach(update),
    between(word, from, to) {
      const cell = byWord.get(word)?.[0]
      if (!cell?.askable) return null
      const { every, at } = cell.behaviour
      const held = []
      for (let step = Math.floor(from / every); step * every <= to; step++) {
        held.push(cell.encode(at(step * every), 0)[word - cell.word])
      }
      return held
    }
  }
}

function createCell(row, { areas, peek }) {
  const { kind, address } = parseAddress(row.at, areas)
  const type = row.as ?? 'uint16'
  const target = row.of === undefined ? undefined : targetOf(row, { areas, peek })
  const behaviour = createBehaviour(row, { address, target })
  if (kind === 'bit') {
    const mask = 1 << (address & 15)
    const encode = (on, old) => [on ? old | mask : old & ~mask]
    return { word: address >> 4, size: 1, askable: false, behaviour, encode, time: NaN }
  }
  const encode = value => toWords(type, value)
  return { word: address, size: wordsOf(type), askable: behaviour.pure, behaviour, encode, time: NaN }
}

function targetOf({ of, ofAs = 'uint16' }, { areas, peek }) {
  const { kind, address } = parseAddress(of, areas)
  if (kind === 'bit') return () => (peek(address >> 4) >> (address & 15)) & 1
  const size = wordsOf(ofAs)
  return () =>
    fromWords(
      ofAs,
      Array.from({ length: size }, (_, n) => peek(address + n))
    )
}

/**
 * @typedef {object} Memory
 * @property {import('../codec/nx/areas').AreaMap} areas
 * @property {(kind: 'bit'|'word', address: number) => boolean} has whether the CPU gives this address out so
 * @property {(word: number) => number} readWord
 * @property {(bit: number) => boolean} readBit
 * @property {(word: number, value: number) => void} writeWord
 * @property {(bit: number, on: boolean) => void} writeBit
 * @property {(text: string, type?: string) => number | boolean} get by notation
 * @property {(text: string, value: number | boolean, type?: string) => void} set by notation
 * @property {(word: number, from: number, to: number) => number[]} heldBetween every value that the word held at some
 *   moment between two times of the clock (ms), both ends included
 */

module.exports = { createMemory }
