'use strict'

const assert = require('node:assert')
const { createNxPlc, createPool } = require('../../lib')
const { createNxLine, createVirtualClock } = require('../../lib/sim')

describe('attack: two users of one station', () => {
  // each used the same IDs in the same order: 84 of 600 values were the other one's
  it('a duplicate of the one’s answer is never the other one’s value', async () => {
    const wrong = []
    for (let after = 5; after < 25; after++) {
      const clock = createVirtualClock()
      const line = createNxLine({ clock, baudRate: 38400, quiet: true, collisions: false, stations: [1] })
      line.plcs[0].set('M0', 111)
      line.plcs[0].set('M1', 222)
      const pool = createPool({ clock, random: () => 0.5 })
      const settings = { transport: 'simulated', path: 'x', wire: line.wire, baudRate: 38400 }
      const leases = ['a', 'b'].map(id => pool.open(settings, { id, name: id }))
      const [a, b] = leases.map(lease => createNxPlc({ lease, clock, station: 1, timeout: 200, random: () => 0 }))
      for (let n = 0; n < 5; n++) {
        line.faults.once('duplicated', { argument: after })
        const [[m0], [m1]] = await clock.run(Promise.all([a.read(['M0']), b.read(['M1'])]))
        if (m0.quality === 'good' && m0.value !== 111) wrong.push(['M0', m0.value, after])
        if (m1.quality === 'good' && m1.value !== 222) wrong.push(['M1', m1.value, after])
      }
      for (const device of [a, b]) device.close()
      await clock.run(Promise.all(leases.map(lease => lease.release())))
    }
    assert.deepEqual(wrong, [])
  })
})
