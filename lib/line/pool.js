'use strict'

const { PlcError } = require('../error')
const { Archive } = require('./archive')
const { realClock } = require('./clock')
const { Lease } = require('./lease')
const { Line } = require('./line')
const { Monitor } = require('./monitor')
const { difference, lineName, lineSettings, wireKey } = require('./settings')
const { serial } = require('./transports/serial')
const { simulated } = require('./transports/memory')
const { tcp } = require('./transports/tcp')
const { Watchers } = require('./watch')

const TRANSPORTS = Object.freeze({ serial, tcp, simulated })

/**
 * Shares lines by wire: who asks for the same path or host:port gets the same line; the last one out closes it.
 *
 * @param {object} [options]
 * @param {import('./clock').Clock} [options.clock]
 * @param {Record<string, (settings: any, clock: any) => any>} [options.transports] factories by name; replace the own ones
 * @param {() => number} [options.random] 0 to 1, for the jitter of reconnecting
 * @param {{ folder: string | (() => string) }} [options.evidence] where the frames around each fault are kept; '' or none: nowhere
 */
function createPool({ clock = realClock, transports = {}, random = Math.random, evidence = { folder: '' } } = {}) {
  const pool = {
    clock,
    random,
    transports: { ...TRANSPORTS, ...transports },
    entries: new Map(),
    closing: new Map(),
    claims: new Map(),
    memories: new Map(),
    outages: new Map(),
    watchers: new Watchers(clock),
    archive: new Archive(clock, evidence.folder)
  }
  const watch = (settings, told) => {
    const key = wireKey(settings)
    return pool.watchers.add(key, pool.entries.get(key)?.line ?? null, told)
  }
  return {
    /**
     * @param {any} raw settings of a line, see settings.js
     * @param {{ id: string, name: string }} owner for texts
     * @throws {PlcError} BAD_SETTING, WIRE_CONFLICT
     */
    open: (raw, owner) => lease(pool, lineSettings(raw), owner),
    /**
     * Watches a wire, which need not have a line yet, without opening it or holding it open.
     * @param {any} raw settings of a line; what leads to the wire counts
     * @param {{ event?: (event: any, line: any) => void, state?: (state: string, reason: any, line: any) => void, frame?: (row: any) => void }} told
     *   `state`: now, and at each change; `closed`, if nobody has it open. `frame`: rows as those of `line.trace()`, as they come
     * @returns {() => void} ends it; any number of times
     * @throws {PlcError} BAD_SETTING
     */
    watch: (raw, told) => watch(lineSettings(raw), told),
    /**
     * The same with statistics, see monitor.js.
     * @param {any} raw settings of a line
     * @param {import('./monitor').MonitorOptions} [options]
     * @returns {Monitor} `{ statistics(), evidence(most), stop() }`
     * @throws {PlcError} BAD_SETTING
     */
    monitor(raw, options) {
      const settings = lineSettings(raw)
      const key = wireKey(settings)
      const kept = { facts: () => pool.archive.facts(key), read: most => pool.archive.read(key, most) }
      const wire = { clock, name: lineName(settings), watch: told => watch(settings, told), evidence: kept }
      return new Monitor(wire, options)
    },
    /** The open lines, for tests and monitors: `{ key, line, leases }`. */
    lines: () => [...pool.entries.values()].map(({ key, line, leases }) => ({ key, line, leases: leases.size }))
  }
}

function lease(pool, settings, owner) {
  const key = wireKey(settings)
  const entry = pool.entries.get(key) ?? newEntry(pool, { key, settings, owner })
  const reason = difference(entry.settings, settings)
  if (reason) {
    const other = [...entry.leases][0]?.owner.name ?? entry.owner.name
    throw new PlcError('WIRE_CONFLICT', { owner: owner.name, other, path: key, reason })
  }
  const made = new Lease({ line: entry.line, owner, release: done => leave(pool, entry, { lease: made, done }) })
  entry.leases.add(made)
  return made
}

function newEntry(pool, { key, settings, owner }) {
  const { clock, random, memories } = pool
  /** @type {any} */
  const entry = { key, settings, owner, leases: new Set(), line: null }
  if (!memories.has(key)) memories.set(key, new Map())
  if (!pool.outages.has(key)) pool.outages.set(key, { downAt: null })
  const line = new Line({
    name: lineName(settings),
    settings,
    clock,
    random,
    make: () => pool.transports[settings.transport](settings, clock),
    claims: claimsOf(pool, entry),
    memories: memories.get(key),
    outage: pool.outages.get(key),
    evidence: pool.archive.of(key)?.evidence
  })
  entry.line = line
  pool.entries.set(key, entry)
  pool.watchers.made(key, line)
  line.open()
  // the ports of the lines before may still be on their way to be closed
  const before = pool.closing.get(key)
  if (before) before.waiting.push(() => line.connect())
  else line.connect()
  return entry
}

/** Two names may lead to one wire: it is the real one that is claimed, at each open. */
const claimsOf = (pool, entry) => ({
  take: id => {
    const holder = pool.claims.get(id)
    if (holder && holder !== entry) {
      const owner = [...holder.leases][0]?.owner.name ?? holder.owner.name
      throw new PlcError('WIRE_IN_USE', { path: entry.key, other: holder.key, owner })
    }
    pool.claims.set(id, entry)
  },
  release: id => {
    if (pool.claims.get(id) === entry) pool.claims.delete(id)
  }
})

function leave(pool, entry, { lease: gone, done }) {
  entry.leases.delete(gone)
  if (entry.leases.size > 0) {
    entry.line.drop(gone)
    return done()
  }
  const { key, line } = entry
  pool.entries.delete(key)
  // a line that was never connected closes at once, while the one before it still holds the port
  const closing = pool.closing.get(key) ?? { lines: 0, waiting: [] }
  pool.closing.set(key, closing)
  closing.lines++
  line.close(() => {
    closing.lines--
    if (closing.lines === 0) pool.closing.delete(key)
    settle(pool, key, done)
    if (closing.lines === 0) for (const next of closing.waiting) next()
  })
}

/** The evidence of the last seconds is written before the process may end. */
function settle(pool, key, done) {
  const kept = pool.archive.of(key)
  if (kept) kept.file.settle(done)
  else done()
}

module.exports = { createPool }
