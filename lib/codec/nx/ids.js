'use strict'
const { PlcError } = require('../../error')

// An R carries no address: the master's own ID, which the PLC sends its answer back to, is what tells a late answer from the awaited one.
// So it changes with every query (docs/nx.md).

const LEAST_FREE = 192
const LAST = 254
const DEFAULT_IDS = Object.freeze([0xe2, 0xe3, 0xe4, 0xe5, 0xe6, 0xe7, 0xe8, 0xe9])

/**
 * The master IDs of a configuration.
 * @param {unknown} value a number, a list of numbers, or text: `226`, `0xE2..0xE9`, `$E2..$E9`, `226, 230`; empty: $E2..$E9
 * @param {{ stations?: readonly number[] }} [options] numbers of the line's stations
 * @returns {readonly number[]} without doubles
 * @throws {PlcError} BAD_MASTER_ID unless 192..254, or 0..191 and no station of the line
 */
function masterIdList(value, { stations = [] } = {}) {
  if (value === undefined || value === null || value === '') return DEFAULT_IDS
  const given = Array.isArray(value) ? value : typeof value === 'string' ? value.split(',').flatMap(expand) : [value]
  if (given.length < 1 || given.length > LAST + 1) throw bad(value, 'give 1 to 255 numbers')
  const ids = [...new Set(given)]
  for (const id of ids) checkId(id, stations)
  return Object.freeze(ids)
}

function checkId(id, stations) {
  if (!Number.isInteger(id) || id < 0 || id > LAST) throw bad(id, 'it must be a whole number from 0 to 254')
  if (id >= LEAST_FREE) return
  if (stations.includes(id)) throw bad(id, 'a station of this line has this number')
  if (stations.includes(255)) throw bad(id, 'with station 255 the number of the PLC is not known')
}

function expand(text) {
  const ends = text.split('..').map(part => {
    const clean = part.trim().replace(/^\$/, '0x')
    if (!/^(0x[0-9a-f]{1,2}|\d{1,3})$/i.test(clean)) throw bad(text.trim(), 'it is not a number')
    return Number(clean)
  })
  const [first, last = first] = ends
  if (ends.length > 2 || last < first || last > 255) throw bad(text.trim(), 'it is not a range')
  return Array.from({ length: last - first + 1 }, (_, i) => first + i)
}

const bad = (id, reason) => new PlcError('BAD_MASTER_ID', { id: shown(id), reason })

/** An object may have no text. */
const shown = id => {
  try {
    return String(id)
  } catch {
    return typeof id
  }
}

/**
 * Hands the IDs out in turn, one to a query. One whose exchange failed rests until {@link free}: call that when no answer can come any more
 * (the line begins a run of the station only then). If all rest, the one that has rested longest is used. With one ID nothing can rest.
 * @param {object} [options]
 * @param {readonly number[]} [options.ids] from {@link masterIdList}
 * @param {number} [options.start] any whole number; random, so that a restart does not meet the answers of its former life
 * @param {{ last?: number, resting?: number[] }} [options.memory] plain object that is kept over redeploys; its `last` goes before `start`
 */
function masterIds({ ids = DEFAULT_IDS, start = 0, memory = {} } = {}) {
  if (!Array.isArray(memory.resting)) memory.resting = []
  const resting = memory.resting
  const first = Math.abs(Math.trunc(start)) % ids.length || 0
  // from the memory each time: two who share it never use one ID twice in a row
  const following = () => {
    const remembered = ids.indexOf(memory.last ?? -1)
    return remembered >= 0 ? (remembered + 1) % ids.length : first
  }
  const free = id => {
    if (resting.length === 0) return
    const at = id === undefined ? -1 : resting.indexOf(id)
    if (id === undefined) resting.length = 0
    else if (at >= 0) resting.splice(at, 1)
  }
  return {
    /** @returns {number} the ID of the next query */
    take() {
      let next = following()
      if (resting.length === 0) return (memory.last = ids[next])
      let tries = ids.length
      while (tries-- > 0 && resting.includes(ids[next])) next = (next + 1) % ids.length
      const oldest = resting.find(id => ids.includes(id))
      const id = tries < 0 && oldest !== undefined ? oldest : ids[next]
      memory.last = id
      return id
    },
    /** The exchange of this ID ended with an answer. @param {number} id */
    ok: id => free(id),
    /** It did not: an answer may still come. @param {number} id */
    failed(id) {
      free(id)
      if (ids.length > 1) resting.push(id)
    },
    /** No answer can come any more: to this ID, or to any. @param {number} [id] */
    free,
    /** @returns {number[]} IDs to which an answer may still come */
    resting: () => [...resting],
    ids
  }
}

module.exports = { DEFAULT_IDS, masterIdList, masterIds }
