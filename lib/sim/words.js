'use strict'

const { createBehaviour, toWords, fromWords, wordsOf } = require('./behaviour')
const { PlcError } = require('../error')

const MOST_HISTORY = 1000 // changes of one word that are kept at least

/**
 * The memory of a simulated station, whatever its protocol: words with absolute addresses; bit 16 w + b is bit b of word w.
 * Live values are brought up to date when they are looked at.
 *
 * @param {{ size: number, now: () => number, locate: (text: string) => { kind: 'bit'|'word', address: number },
 *   behaviour?: ReadonlyArray<Record<string, any>>, history?: boolean }} options size: words; locate: the protocol's notation;
 *   behaviour: live values (behaviour.js); history: keep what each word held, for `heldBetween`
 * @returns {Words}
 * @throws {PlcError} what `locate` throws, BAD_TYPE, BAD_SETTING
 */
function createWords({ size, now, locate, behaviour = [], history = false }) {
  const words = new Uint16Array(size)
  const log = history ? new Map() : null

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
  const readBit = bit => ((peek(bit >> 4) >> (bit & 15)) & 1) === 1
  const live = createLive(behaviour, { now, locate, words, store, peek })
  const writeWord = (word, value) => {
    // what follows this word has followed the old value until now
    live.settle()
    store(word, value & 0xffff)
  }
  const writeBit = (bit, on) => {
    const mask = 1 << (bit & 15)
    const old = peek(bit >> 4)
    writeWord(bit >> 4, on ? old | mask : old & ~mask)
  }
  return {
    readWord: peek,
    readBit,
    writeWord,
    writeBit,
    ...byText({ locate, peek, readBit, writeWord, writeBit }),
    heldBetween: (word, from, to) => live.between(word, from, to) ?? heldBetween(log, words[word], { word, from, to })
  }
}

/** Values by notation, for demos and tests: `get('W10', 'float32')`, `set('401001.05', true)`. */
function byText({ locate, peek, readBit, writeWord, writeBit }) {
  const get = (text, type = 'uint16') => {
    const { kind, address } = locate(text)
    if (kind === 'bit') return readBit(address)
    const values = Array.from({ length: wordsOf(type) }, (_, n) => peek(address + n))
    return fromWords(type, values)
  }
  const set = (text, value, type = 'uint16') => {
    const { kind, address } = locate(text)
    if (kind === 'bit') return writeBit(address, Boolean(value))
    toWords(type, Number(value)).forEach((word, n) => writeWord(address + n, word))
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
function createLive(rows, { now, locate, words, store, peek }) {
  const byWord = new Map()
  const stateful = []
  for (const row of rows) {
    const cell = createCell(row, { locate, peek })
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
  const settle = cell => {
    update(cell)
    // what is written now counts from now: the same moment may be looked at again
    cell.time = NaN
  }
  return {
    refresh: word => byWord.get(word)?.forEach(update),
    settle: () => stateful.forEach(settle),
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

function createCell(row, { locate, peek }) {
  const { kind, address } = locate(row.at)
  const target = row.of === undefined ? undefined : targetOf(row, { locate, peek })
  const behaviour = createBehaviour(row, { address, target })
  if (kind === 'bit' && row.as === undefined) {
    const mask = 1 << (address & 15)
    const encode = (on, old) => [on ? old | mask : old & ~mask]
    return { word: address >> 4, size: 1, askable: false, behaviour, encode, time: NaN }
  }
  const type = row.as ?? 'uint16'
  const encode = value => toWords(type, value)
  const word = kind === 'bit' ? wholeWord(row, address) : address
  return { word, size: wordsOf(type), askable: behaviour.pure, behaviour, encode, time: NaN }
}

/** Bits that live together, as coils under `as: 'uint16'`: they fill words. */
function wholeWord({ at }, address) {
  if (address % 16 === 0) return address / 16
  throw new PlcError('BAD_SETTING', {
    setting: 'behaviour',
    value: at,
    reason: 'bits with a type begin at a multiple of 16'
  })
}

function targetOf({ of, ofAs = 'uint16' }, { locate, peek }) {
  const { kind, address } = locate(of)
  if (kind === 'bit') return () => (peek(address >> 4) >> (address & 15)) & 1
  const size = wordsOf(ofAs)
  return () =>
    fromWords(
      ofAs,
      Array.from({ length: size }, (_, n) => peek(address + n))
    )
}

/**
 * @typedef {object} Words
 * @property {(word: number) => number} readWord
 * @property {(bit: number) => boolean} readBit
 * @property {(word: number, value: number) => void} writeWord
 * @property {(bit: number, on: boolean) => void} writeBit
 * @property {(text: string, type?: string) => number | boolean} get by notation
 * @property {(text: string, value: number | boolean, type?: string) => void} set by notation
 * @property {(word: number, from: number, to: number) => number[]} heldBetween every value that the word held at some
 *   moment between two times of the clock (ms), both ends included
 */

module.exports = { createWords }
