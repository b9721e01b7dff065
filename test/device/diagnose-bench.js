'use strict'
const assert = require('node:assert/strict')
const { createPool, diagnose } = require('../../lib')
const { simulated } = require('../../lib/line/transports/memory')
const { createVirtualClock } = require('../../lib/sim')
const { closed, crc } = require('../codec/support/oracle')
const { createWire } = require('../line/support/bench')

/** Communication diagnostics on a wire whose other end is a function of the test, in virtual time. */

const rtu = (...bytes) => closed(bytes)

/** `:`, digits, LRC (the two's complement of the sum), CR LF; by hand. */
const ascii = (...bytes) => {
  const lrc = (256 - (bytes.reduce((sum, byte) => sum + byte, 0) % 256)) % 256
  const digits = [...bytes, lrc].map(byte => byte.toString(16).toUpperCase().padStart(2, '0')).join('')
  return Buffer.from(`:${digits}\r\n`)
}

/** An NX frame: receiver, sender, function, INFO. */
const nx = (to, from, fn, ...info) => closed([to, from, fn, info.length, ...info])

const NOTHING = { realpath: () => Promise.reject(new Error('no')), readFile: () => Promise.reject(new Error('no')) }

/** Diagnostics read: any other function would be a fault. */
const isRead = bytes => {
  if (bytes[0] === 0x3a) return ['01', '02', '03', '04'].includes(bytes.toString('latin1').slice(3, 5))
  const fits = bytes.subarray(-2).equals(Buffer.from(crc([...bytes.subarray(0, -2)])))
  const [, fn, nxFn] = bytes
  return fits && ([1, 2, 3, 4].includes(fn) || [0x21, 0x23, 0x25, 0x01, 0x03, 0x05, 0x00].includes(nxFn))
}

/**
 * @param {(bytes: Buffer, wire: any, n: number) => void} [onQuery]
 * @param {Record<string, any>} [options] of `diagnose`
 */
const bench = (onQuery, options = {}) => {
  const clock = createVirtualClock()
  const wire = createWire(clock, onQuery)
  /** @type {any[]} settings of each opening */
  const opened = []
  const over = transport => settings => {
    const end = { connect: handlers => (opened.push(settings), wire.connect(handlers)) }
    return { ...simulated({ ...settings, wire: end }, clock), id: () => settings.path || settings.host, ...transport }
  }
  const transports = { serial: over(), tcp: over() }
  const pools = { clock, random: () => 0.5, transports }
  const pool = createPool(pools)
  const base = { path: '/dev/ttyUSB0', pool, clock, random: () => 0, files: NOTHING, timeout: 200 }
  const run = async (more = {}) => {
    const from = clock.now()
    const trialPool = createPool(pools)
    const answer = await clock.run(diagnose({ ...base, trialPool, ...options, ...more }))
    for (const { bytes } of wire.sent) assert.ok(isRead(bytes), bytes.toString('hex'))
    const row = id => answer.rows.find(each => each.id === id)
    return { ...answer, row, ms: Math.round(clock.now() - from) }
  }
  /** Nothing may be left open. */
  const end = async () => {
    await clock.advance(10000)
    assert.deepEqual([pool.lines().length, wire.open, clock.pending()], [0, 0, 0])
  }
  return { clock, wire, pool, pools, opened, base: { ...base, ...options }, run, end }
}

/** Results of the rows by their id. */
const results = rows => Object.fromEntries(rows.map(({ id, result }) => [id, result]))
const wrong = rows => rows.filter(({ result }) => result === 'ng').map(({ id }) => id)

module.exports = { ascii, bench, nx, results, rtu, wrong }
