'use strict'

const assert = require('node:assert/strict')
const { createNxPlc, createPool, mixedConflict, openChinoRegulator, openNxPlc } = require('../../lib')
const { createLine, createVirtualClock } = require('../../lib/sim')
const { bench } = require('./chino-bench')

const nx = (station, masterIds = [0xe2]) => ({ protocol: 'nx', station, masterIds, name: `NX ${station}` })
const modbus = station => ({ protocol: 'modbus', station, name: `M ${station}` })

describe('NX PLCs and regulators on one line', () => {
  const rules = [
    [nx(1), modbus(2), ''],
    [nx(1), nx(1), ''],
    [modbus(1), modbus(1), ''],
    [modbus(0), modbus(1), ''],
    [nx(255), nx(0), ''],
    [nx(5), modbus(5), /station 5/],
    [nx(0), modbus(1), /broadcast/],
    [nx(255), modbus(1), /255/],
    [nx(1), modbus(0), /broadcast/],
    [nx(1, [0xe2, 0xe3]), modbus(0xe3), /master ID 227/],
    [nx(1, [0xe2]), modbus(0xe3), ''],
    [{ protocol: 'nx', station: 1, name: 'NX without IDs' }, modbus(0xe3), '']
  ]
  for (const [one, other, reason] of rules) {
    it(`${one.name} and ${other.name}: ${reason || 'may share it'}`, () => {
      for (const said of [mixedConflict(one, other), mixedConflict(other, one)]) {
        if (reason === '') assert.equal(said, '')
        else assert.match(said, reason)
      }
    })
  }

  it('share one pool, one line and one queue, and each reads and writes its own', async () => {
    const clock = createVirtualClock()
    const { wire } = createLine({
      clock,
      baudRate: 38400,
      quiet: true,
      stations: [
        { device: 'nx', station: 1 },
        { device: 'chino', station: 11 },
        { device: 'chino', station: 12 }
      ]
    })
    const pool = createPool({ clock, random: () => 0.5 })
    const common = {
      pool,
      clock,
      random: () => 0,
      transport: 'simulated',
      path: 'sim',
      wire,
      baudRate: 38400,
      access: 'write',
      timeout: 200
    }
    const plc = openNxPlc({ ...common, station: 1 })
    const regulators = [11, 12].map(station => openChinoRegulator({ ...common, station }))
    assert.equal(pool.lines().length, 1)
    assert.equal(pool.lines()[0].leases, 3)
    const outcomes = await clock.run(
      Promise.all([
        plc.write({ K0: 1 }),
        regulators[0].write({ 400100: 11, 400101.05: true }, { verify: true }),
        regulators[1].write({ 400100: 12 })
      ])
    )
    assert.ok(outcomes.every(({ outcome }) => outcome === 'confirmed'))
    const jobs = Array.from({ length: 30 }, () => [
      plc.read(['K0']),
      regulators[0].read(['400100', '400101']),
      regulators[1].read('400100')
    ]).flat()
    const results = await clock.run(Promise.all(jobs))
    results.forEach((result, at) => {
      const expected = [[1], [11, 32], [12]][at % 3]
      assert.deepEqual(
        result.map(({ value }) => value),
        expected
      )
    })
    assert.equal(regulators[0].regulator.station, 11)
    assert.equal(plc.plc.station, 1)
    assert.deepEqual([pool.lines()[0].line.stats().timeouts, pool.lines()[0].line.stats().crcErrors], [0, 0])
    await clock.run(Promise.all([plc, ...regulators].map(each => each.close())))
    assert.equal(pool.lines().length, 0)
    await clock.advance(5000)
    assert.equal(clock.pending(), 0)
  })

  it('those whose numbers can be mistaken are refused when they are opened, and leave nothing open', async () => {
    const clock = createVirtualClock()
    const { wire } = createLine({ clock, quiet: true, stations: [{ device: 'nx', station: 1 }] })
    const pool = createPool({ clock, random: () => 0.5 })
    const common = { pool, clock, transport: 'simulated', path: 'sim', wire }
    const plc = openNxPlc({ ...common, station: 1, name: 'furnace' })
    for (const more of [{ station: 1 }, { station: 0, broadcast: true }, { station: 0xe4 }]) {
      assert.throws(
        () => openChinoRegulator({ ...common, name: 'heater', ...more }),
        error => error.code === 'MIXED_LINE' && /heater and furnace/.test(error.message)
      )
    }
    assert.equal(pool.lines()[0].leases, 1)
    await clock.run(plc.close())
    const regulator = openChinoRegulator({ ...common, station: 1 })
    assert.throws(
      () => openNxPlc({ ...common, station: 255 }),
      error => error.code === 'MIXED_LINE'
    )
    const other = openChinoRegulator({ ...common, station: 2 })
    await clock.run(regulator.close())
    // the line stays open, the number is free again
    await clock.run(openNxPlc({ ...common, station: 1 }).close())
    await clock.run(other.close())
    assert.equal(pool.lines().length, 0)
  })

  it('RTU needs 8 data bits, ASCII does not', async () => {
    const clock = createVirtualClock()
    const { wire } = createLine({ clock, quiet: true, stations: [{ device: 'chino', station: 1 }] })
    const common = {
      pool: createPool({ clock }),
      clock,
      transport: 'simulated',
      path: 'sim',
      wire,
      station: 1,
      dataBits: 7
    }
    assert.throws(
      () => openChinoRegulator(common),
      error => error.code === 'BAD_SETTING' && /8 data bits/.test(error.message)
    )
    assert.throws(
      () => openChinoRegulator({ ...common, dataBits: '7', protocol: 'rtu' }),
      error => error.code === 'BAD_SETTING'
    )
    await clock.run(openChinoRegulator({ ...common, protocol: 'ascii' }).close())
  })

  it('tells who it is', async () => {
    const b = bench({ device: { name: 'heater' } })
    const plc = createNxPlc({ lease: b.lease, station: 1, masterIds: 'E2..E3' })
    assert.deepEqual(b.device.member, { protocol: 'modbus', station: 11, masterIds: [], name: 'heater' })
    assert.deepEqual(plc.member, { protocol: 'nx', station: 1, masterIds: [0xe2, 0xe3], name: 'station 1' })
    plc.close()
    await b.close()
  })
})
