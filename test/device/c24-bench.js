'use strict'
const { createC24Port, createPool } = require('../../lib')
const { createVirtualClock } = require('../../lib/sim')

/**
 * A C24 port on the real line in virtual time. The other side is the test's: `peer.say(bytes)` speaks, `peer.heard` is what it got, and
 * `onBytes(bytes, peer)` is called for what the port writes.
 * @param {{ port?: Record<string, any>, line?: Record<string, any>, onBytes?: (bytes: Buffer, peer: any) => void }} [options]
 */
const c24Bench = ({ port = {}, line = {}, onBytes = () => {} } = {}) => {
  const clock = createVirtualClock()
  let end = null
  const peer = {
    heard: [],
    times: [],
    say: bytes => end?.data(Buffer.from(bytes)),
    sayIn: (ms, bytes) => clock.setTimer(() => peer.say(bytes), ms),
    cut: () => end?.closed(),
    text: () => Buffer.concat(peer.heard).toString('latin1'),
    hex: () => Buffer.concat(peer.heard).toString('hex').toUpperCase()
  }
  const wire = {
    connect(handlers) {
      end = handlers
      return {
        write(bytes) {
          peer.heard.push(Buffer.from(bytes))
          peer.times.push(clock.now())
          onBytes(Buffer.from(bytes), peer)
        },
        close: () => void (end = null)
      }
    }
  }
  const pool = createPool({ clock, random: () => 0.5 })
  const settings = { transport: 'simulated', path: 'c24', wire, baudRate: 9600, ...line }
  const lease = pool.open(settings, { id: 'a', name: 'bench' })
  const got = []
  const make = own => createC24Port({ lease, clock, name: 'C24', ...port, ...own })
  const device = make({})
  device.listen(message => got.push(message))
  return {
    clock,
    pool,
    lease,
    settings,
    peer,
    device,
    make,
    got,
    values: () => got.map(({ value }) => value),
    run: promise => clock.run(promise),
    send: (value, options) => clock.run(device.send(value, options)),
    close: async () => {
      device.close()
      await clock.run(lease.release())
    }
  }
}

module.exports = { c24Bench }
