'use strict'
const { createNxPlc, createPool } = require('../../lib')
const { createNxLine, createVirtualClock } = require('../../lib/sim')

/**
 * A PLC device, the real line and simulated stations in virtual time.
 * @param {{ sim?: Record<string, any>, plc?: Record<string, any>, line?: Record<string, any> }} [options]
 */
const bench = ({ sim = {}, plc = {}, line = {} } = {}) => {
  const clock = createVirtualClock()
  const queries = []
  const onExecute = ({ query }) => queries.push(query)
  const { stations = [1], ...rest } = sim
  const rows = stations.map(each => ({ onExecute, ...(typeof each === 'number' ? { station: each } : each) }))
  const simulated = createNxLine({ clock, baudRate: 38400, quiet: true, stations: rows, ...rest })
  const pool = createPool({ clock, random: () => 0.5 })
  const settings = { transport: 'simulated', path: 'sim', wire: simulated.wire, baudRate: 38400, echo: 'off', ...line }
  const lease = pool.open(settings, { id: 'a', name: 'bench' })
  const make = own => createNxPlc({ lease, clock, random: () => 0, station: 1, timeout: 200, ...plc, ...own })
  const device = make({})
  return {
    ...simulated,
    clock,
    pool,
    lease,
    device,
    make,
    queries,
    station: simulated.plcs[0],
    run: promise => clock.run(promise),
    close: async () => {
      device.close()
      await clock.run(lease.release())
      // what the stations still have to say
      await clock.advance(5000)
    }
  }
}

module.exports = { bench }
