'use strict'
const { createInconLink, createPool } = require('../../lib')
const { createFaults, createInconController, createRandom, createVirtualClock, createWire } = require('../../lib/sim')

/**
 * An INCON link, the real line and a simulated controller in virtual time.
 * @param {{ wire?: Record<string, any>, sim?: Record<string, any>, link?: Record<string, any>, line?: Record<string, any> }} [options]
 */
const inconBench = ({ wire: given = {}, sim = {}, link = {}, line = {} } = {}) => {
  const clock = createVirtualClock()
  const faults = createFaults({ random: createRandom(5) })
  const wire = createWire({ clock, baudRate: 9600, faults, random: createRandom(11), ...given })
  const controller = createInconController({ clock, ...sim })
  wire.add(controller)
  const pool = createPool({ clock, random: () => 0.5 })
  const settings = { transport: 'simulated', path: 'sim', wire, baudRate: given.baudRate ?? 9600, echo: 'off', ...line }
  const lease = pool.open(settings, { id: 'a', name: 'bench' })
  const make = own => createInconLink({ lease, clock, ...link, ...own })
  const device = make({})
  const got = []
  device.listen(message => got.push(message))
  return {
    clock,
    faults,
    wire,
    controller,
    pool,
    settings,
    lease,
    device,
    make,
    got,
    /** What came, in short. */
    heard: () => got.map(({ value, complete, reason }) => (complete ? value : [value, reason])),
    seen: () => controller.messages.map(({ text }) => text),
    run: promise => clock.run(promise),
    close: async () => {
      device.close()
      controller.close()
      await clock.run(lease.release())
      await clock.drain()
    }
  }
}

module.exports = { inconBench }
