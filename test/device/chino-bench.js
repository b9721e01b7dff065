'use strict'
const { createChinoRegulator, createPool } = require('../../lib')
const { createVirtualClock } = require('../../lib/sim')
const { createFaults } = require('../../lib/sim/faults')
const { createRandom } = require('../../lib/sim/random')
const { createWire } = require('../../lib/sim/wire')
const { createSlave } = require('./slave')

/**
 * A regulator device, the real line and a hand-made slave in virtual time.
 * @param {{ slaves?: any[], device?: Record<string, any>, line?: Record<string, any>, wire?: Record<string, any> }} [options]
 */
const bench = ({ slaves = [{}], device = {}, line = {}, wire: wireOptions = {} } = {}) => {
  const clock = createVirtualClock()
  const random = createRandom(1)
  const faults = createFaults({ random: random.fork(), rates: [] })
  const wire = createWire({ clock, baudRate: line.baudRate ?? 38400, random: random.fork(), faults, ...wireOptions })
  const protocol = device.protocol ?? 'rtu'
  const made = slaves.map(each => createSlave({ protocol, ...each }))
  made.forEach(slave => wire.add(slave))
  const pool = createPool({ clock, random: () => 0.5 })
  const settings = { transport: 'simulated', path: 'sim', wire, baudRate: 38400, echo: 'off', ...line }
  const lease = pool.open(settings, { id: 'a', name: 'bench' })
  const make = own =>
    createChinoRegulator({
      lease,
      clock,
      random: () => 0,
      station: 11,
      timeout: 200,
      access: 'write',
      ...device,
      ...own
    })
  const regulator = make({})
  return {
    wire,
    faults,
    clock,
    pool,
    lease,
    settings,
    make,
    device: regulator,
    slaves: made,
    slave: made[0],
    run: promise => clock.run(promise),
    read: items => clock.run(regulator.read(items)),
    write: (entries, options) => clock.run(regulator.write(entries, { fixed: true, ...options })),
    close: async () => {
      regulator.close()
      await clock.run(lease.release())
      // what the stations still have to say
      await clock.advance(5000)
    }
  }
}

module.exports = { bench }
