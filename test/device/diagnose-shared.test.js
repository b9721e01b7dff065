'use strict'
const assert = require('node:assert/strict')
const { createChinoRegulator, createNxPlc, createPool, diagnose } = require('../../lib')
const { createLine, createVirtualClock } = require('../../lib/sim')
const { wrong } = require('./diagnose-bench')

/** A station that is deployed and polled, tested meanwhile over the same line with another protocol or mode. */

const NOTHING = { realpath: () => Promise.reject(new Error('no')), readFile: () => Promise.reject(new Error('no')) }
const DEVICES = {
  nx: options => createNxPlc(options),
  rtu: options => createChinoRegulator({ ...options, protocol: 'rtu' }),
  ascii: options => createChinoRegulator({ ...options, protocol: 'ascii' })
}
const stationOf = (deployed, station) =>
  deployed === 'nx' ? { device: 'nx', station } : { device: 'chino', station, protocol: deployed }

const testAs = async (protocol, { deployed, interval = 100, ...more }) => {
  const clock = createVirtualClock()
  const stations = [11, 12].map(station => stationOf(deployed, station))
  const line = createLine({ clock, baudRate: 19200, quiet: true, collisions: false, stations })
  const pool = createPool({ clock, random: () => 0.5 })
  const settings = {
    transport: 'simulated',
    path: 'x',
    wire: line.wire,
    baudRate: 19200,
    dataBits: 8,
    parity: 'none',
    stopBits: 1
  }
  const [lease, other] = ['deployed', 'test'].map(id => pool.open(settings, { id, name: id }))
  const common = { lease, clock, timeout: 300, random: () => 0 }
  const devices = [11, 12].map(station => DEVICES[deployed]({ ...common, station }))
  const items = [deployed === 'nx' ? 'M0' : '400001']
  devices.forEach(device => device.subscribe({ items, interval }, () => {}))
  await clock.advance(2000)
  const own = { ...settings, clock, pool, lease: other, files: NOTHING, protocol, station: 11, timeout: 300, ...more }
  const { cause, rows } = await clock.run(diagnose(own))
  devices.forEach(device => device.close())
  await clock.run(Promise.all([lease.release(), other.release()]))
  return { cause, rows }
}

describe('diagnose: a station that others poll otherwise', () => {
  // the polls' answers were taken for answers to the test: "answered one query, and not another"
  for (const [deployed, protocol] of [
    ['rtu', 'ascii'],
    ['ascii', 'rtu']
  ]) {
    for (const tryOtherModes of [false, true]) {
      it(`${deployed} tested as ${protocol}${tryOtherModes ? ', with the other mode' : ''}`, async () => {
        const { cause, rows } = await testAs(protocol, { deployed, tryOtherModes })
        assert.equal(cause.code, 'OTHER_MODE')
        const names = [deployed, protocol].map(name => name.toUpperCase())
        assert.equal(cause.text, `MODBUS ${names[0]} was heard, ${names[1]} is configured`)
        assert.deepEqual(wrong(rows), ['protocol'])
      })
    }
  }

  for (const [deployed, protocol, text] of [
    ['nx', 'rtu', /^NX was heard from station 11, MODBUS RTU is configured$/],
    ['nx', 'ascii', /^NX was heard from station 11, MODBUS ASCII is configured$/],
    ['rtu', 'nx', /^MODBUS RTU was heard from station 11, NX is configured$/]
  ]) {
    it(`${deployed} tested as ${protocol}`, async () => {
      const { cause } = await testAs(protocol, { deployed })
      assert.equal(cause.code, 'OTHER_PROTOCOL')
      assert.match(cause.text, text)
    })
  }

  it('polls of the same mode that are answered: the settings are right, something else is not', async () => {
    const { cause } = await testAs('rtu', { deployed: 'rtu' })
    assert.equal(cause, null)
  })
})
