'use strict'
const { PlcError } = require('../../error')

/**
 * @typedef {'certain'|'likely'|'unconfirmed'} Certainty
 * @typedef {'both'|'bits'|'words'} Access how the CPU gives the area out; `bits`: its numbers count contacts, not words
 * @typedef {{ area: string, base: number, words: number, as: Access, certainty: Certainty, writable: boolean, note: string }} Area
 * @typedef {{ list: readonly Area[], get: (name: string) => Area | undefined, at: (word: number) => Area | undefined }} AreaMap
 */

const LAST_WORD = 0xffff
const LAST_BIT = 0xffff
const MOST_ROWS = 64

// The map of the NX-CPU700p family. M and K are proven by the manual's own program, the rest is not (docs/nx.md).
// Written is only what is certain or likely, and never flags, contacts or set and present values: see `confirmed`.
/** @type {readonly Area[]} */
const AREAS = table([
  // area  base   words as       certainty      writable note
  ['R', 0x000, 128, 'both', 'likely', true, 'external I/O'],
  ['L', 0x080, 64, 'both', 'likely', true, 'link'],
  ['M', 0x0c0, 128, 'both', 'certain', true, 'internal relay'],
  ['K', 0x140, 128, 'both', 'certain', true, 'keep (retentive)'],
  ['F', 0x1c0, 16, 'both', 'unconfirmed', false, 'special flags'],
  ['TC', 0x1d0, 16, 'bits', 'unconfirmed', false, 'timer and counter contacts'],
  ['W', 0x200, 2048, 'words', 'unconfirmed', false, 'data'],
  ['SV', 0xa00, 256, 'words', 'unconfirmed', false, 'set values'],
  ['PV', 0xb00, 256, 'words', 'unconfirmed', false, 'present values'],
  ['SR', 0xc00, 512, 'words', 'unconfirmed', false, 'special registers']
])

function table(rows) {
  return Object.freeze(
    rows.map(([area, base, words, as, certainty, writable, note]) =>
      Object.freeze({ area, base, words, as, certainty, writable, note })
    )
  )
}

const ACCESS = ['both', 'bits', 'words']
const PROPERTIES = ['area', 'base', 'words', 'as', 'confirmed', 'writable', 'remove', 'note']

const hex = value => `$${value.toString(16).toUpperCase().padStart(4, '0')}`
const span = row => `${row.area} (${hex(row.base)}..${hex(row.base + row.words - 1)})`

/**
 * The area map of one PLC: {@link AREAS}, with rows replaced, added or removed by its configuration.
 * A row is `{ area, base, words, as, confirmed, writable, remove, note }`; what an existing area's row leaves out stays as it is.
 *  - `area` 1 to 4 letters; `base` absolute word address 0..65535; `words` 1..65536; both also as text, `0x1C0` or `$1C0` in hex
 *  - `as` `both` (default), `bits` (numbers count contacts) or `words`
 *  - `confirmed: true` the user vouches for the row: certain, and writable unless `writable: false`
 *  - `remove: true` the CPU has no such area
 * A changed row that is not confirmed is unconfirmed: readable, not writable.
 * @param {ReadonlyArray<Record<string, any>>} [rows]
 * @returns {AreaMap}
 * @throws {PlcError} BAD_AREA
 */
function areaMap(rows = []) {
  if (!Array.isArray(rows)) throw bad('table', 'it is not a list of rows')
  if (rows.length > MOST_ROWS) throw bad('table', `${rows.length} rows, at most ${MOST_ROWS}`)
  /** @type {Map<string, Area>} */
  const byName = new Map(AREAS.map(row => [row.area, row]))
  const seen = new Set()
  for (const given of rows) {
    const name = nameOf(given)
    if (seen.has(name)) throw bad(name, 'two rows have this name')
    seen.add(name)
    const row = merge(name, given, byName.get(name))
    if (row) byName.set(name, row)
    else byName.delete(name)
  }
  const list = Object.freeze([...byName.values()].sort((a, b) => a.base - b.base))
  for (let i = 1; i < list.length; i++) {
    if (list[i - 1].base + list[i - 1].words > list[i].base) {
      throw bad(list[i].area, `${span(list[i])} overlaps ${span(list[i - 1])}`)
    }
  }
  return Object.freeze({
    list,
    get: name => byName.get(name),
    at: word => list.find(row => word >= row.base && word < row.base + row.words)
  })
}

function nameOf(given) {
  if (given === null || typeof given !== 'object' || Array.isArray(given)) throw bad('?', 'a row must be an object')
  const name = own(given, 'area')
  if (typeof name !== 'string' || !/^[A-Za-z]{1,4}$/.test(name))
    throw bad(name, 'the name must be 1 to 4 letters A to Z')
  const unknown = Object.keys(given).find(key => !PROPERTIES.includes(key))
  if (unknown !== undefined) throw bad(name, `it has the unknown property ${unknown}`)
  return name.toUpperCase()
}

/** @returns {Area | null} null: removed */
function merge(name, given, old) {
  if (flag(name, given, 'remove')) {
    if (!old) throw bad(name, 'there is no such area to remove')
    return null
  }
  const base = number(name, given, 'base', old)
  const words = number(name, given, 'words', old)
  const as = own(given, 'as') ?? old?.as ?? 'both'
  if (!ACCESS.includes(as)) throw bad(name, '"as" must be both, bits or words')
  if (words < 1) throw bad(name, 'it must have at least one word')
  const last = base + words - 1
  if (last > LAST_WORD) throw bad(name, `it ends at ${hex(last)}, after the last word ${hex(LAST_WORD)}`)
  if (as === 'bits' && last * 16 + 15 > LAST_BIT)
    throw bad(name, `its bits end after ${hex(LAST_BIT)}: use "as": "words"`)
  return Object.freeze({ area: name, base, words, as, ...trust(name, given, { base, words, as, old }) })
}

function trust(name, given, { base, words, as, old }) {
  const confirmed = flag(name, given, 'confirmed')
  const writable = flag(name, given, 'writable')
  const note = own(given, 'note') ?? old?.note ?? ''
  if (typeof note !== 'string') throw bad(name, 'the note must be text')
  const same = old && old.base === base && old.words === words && old.as === as
  /** @type {{ certainty: Certainty, writable: boolean }} */
  const known = same ? old : { certainty: 'unconfirmed', writable: false }
  /** @type {{ certainty: Certainty, writable: boolean }} */
  const sure = confirmed ? { certainty: 'certain', writable: true } : known
  if (writable && !sure.writable) throw bad(name, 'it can be writable only if it is confirmed')
  return { certainty: sure.certainty, writable: sure.writable && writable !== false, note: note.slice(0, 100) }
}

// own properties only: a row comes from a saved flow and must not be able to inherit anything
const own = (row, key) => (Object.hasOwn(row, key) ? row[key] : undefined)

function flag(name, row, key) {
  const value = own(row, key)
  if (value !== undefined && typeof value !== 'boolean') throw bad(name, `"${key}" must be true or false`)
  return value
}

function number(name, row, key, old) {
  const given = own(row, key)
  if ((given === undefined || given === '') && old) return old[key]
  const text = typeof given === 'string' ? given.trim().replace(/^\$/, '0x') : given
  const value = typeof text === 'string' && /^(0x[0-9a-f]{1,5}|\d{1,6})$/i.test(text) ? Number(text) : text
  if (!Number.isInteger(value) || value < 0 || value > LAST_WORD + 1) {
    throw bad(name, `"${key}" must be a whole number from 0 to ${LAST_WORD}, or hex as in 0x1C0`)
  }
  return value
}

const bad = (name, reason) => new PlcError('BAD_AREA', { name, reason })

module.exports = { AREAS, LAST_BIT, LAST_WORD, areaMap }
