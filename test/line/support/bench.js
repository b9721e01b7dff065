'use strict'

const { createPool } = require('../../../lib/line')
const { createVirtualClock } = require('../../../lib/sim/clock')

const CHARACTER = 10000 / 19200

/**
 * A wire whose other end is a function of the test. Everything that was sent is kept, with the time of its first byte.
 * `onQuery(bytes, wire, n)` may call `wire.reply(bytes, { after, pieces })`; times count from the end of the query.
 */
function createWire(clock, onQuery = () => {}) {
  const wire = {
    sent: [],
    connects: 0,
    open: 0,
    refuse: null,
    onQuery,
    connect(handlers) {
      if (wire.refuse) throw wire.refuse
      wire.connects++
      wire.open++
      wire.handlers = handlers
      return {
        write(bytes) {
          const n = wire.sent.push({ at: clock.now(), bytes: Buffer.from(bytes), hex: bytes.toString('hex') })
          wire.queryEnd = clock.now() + bytes.length * CHARACTER
          wire.onQuery(bytes, wire, n)
        },
        close() {
          wire.open--
        }
      }
    },
    /** Bytes that arrive `after` ms after the end of the query, all at once. */
    reply(bytes, { after = 5 } = {}) {
      const { handlers } = wire
      clock.setTimer(() => handlers === wire.handlers && handlers.data(bytes), wire.queryEnd - clock.now() + after)
    },
    unplug() {
      wire.open--
      wire.handlers.closed()
    },
    hex: () => wire.sent.map(({ hex }) => hex)
  }
  return wire
}

/** A pool on virtual time with one simulated wire, and one lease of it. */
function createBench({ onQuery, settings = {}, ...options } = {}) {
  const clock = createVirtualClock()
  const wire = createWire(clock, onQuery)
  const pool = createPool({ clock, random: () => 0.5, ...options })
  const raw = { transport: 'simulated', name: 'the line', wire, ...settings }
  const open = (extra = {}, name = 'reader') => pool.open({ ...raw, ...extra }, { id: name, name })
  const lease = open()
  return { clock, wire, pool, open, lease, run: promise => clock.run(promise) }
}

/** What a promise rejects with. */
const failure = promise =>
  promise.then(
    value => {
      throw new Error(`resolved with ${JSON.stringify(value)}`)
    },
    error => error
  )

module.exports = { CHARACTER, createBench, createWire, failure }
