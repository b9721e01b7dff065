'use strict'
const assert = require('node:assert/strict')
const { createChinoRegulator, lineSettings } = require('../../lib')
const { createDevice, deviceSettings } = require('../../nodes/device-settings')
const { poolSettings } = require('../../nodes/line-settings')
const { PROPERTIES } = require('../../nodes/properties')
const { readSettings } = require('../../nodes/settings')

/** A line that nobody asks anything of. */
const bareLease = () => ({ line: { memory: () => ({}) }, on: () => {}, off: () => {} })

describe('settings on their way to the library', () => {
  const line = config => readSettings('plc-line', { path: '/dev/a', ...config })
  const device = gap =>
    deviceSettings(readSettings('nx-config', { line: 'l', station: '1' }), { name: 'a', stations: [], gap })

  it('the gap of a line takes the place of the protocol’s, down to 1 ms', () => {
    assert.deepEqual(
      ['0', '0.5', '3.5', '20'].map(gap => device(line({ gap }).gap).gap),
      [0, 1, 3, 20]
    )
  })

  it('flow control, signals and format reach the port', () => {
    const given = { flowControl: 'rtscts', dtr: 'off', rts: 'on', dataBits: '7', parity: 'even', stopBits: '2' }
    const { flowControl, dtr, rts, dataBits, parity, stopBits } = lineSettings(poolSettings(line(given)))
    assert.deepEqual([flowControl, dtr, rts, dataBits, parity, stopBits], ['rtscts', 'off', 'on', 7, 'even', 2])
    assert.equal(lineSettings(poolSettings(line({}))).flowControl, 'none')
  })

  it('a faulty row of a tag table: the others are read, in the notation of the configuration, and nothing is written', () => {
    const lease = bareLease()
    const config = { line: 'l', station: '1', addressMode: '0-base', access: 'write' }
    const tags = [
      { name: 'first', address: '400000' },
      { name: 'broken', address: '4000' }
    ]
    const settings = { type: 'chino-config', ...readSettings('chino-config', { ...config, tags }) }
    const { device: regulator, tagFault } = createDevice(lease, deviceSettings(settings, { name: 'a', stations: [] }))
    assert.equal(tagFault.code, 'BAD_TAG')
    assert.match(regulator.describe('first').goesOut, /wire address 0 /)
    assert.throws(() => regulator.checkTarget('first', { fixed: true }), { code: 'READ_ONLY' })
    regulator.close()
  })

  it('a regulator’s numbers have the same limits in the node and in the library', () => {
    const lease = bareLease()
    const works = settings => {
      try {
        createChinoRegulator({ lease, station: 1, ...settings }).close()
        return true
      } catch (error) {
        assert.ok(['BAD_SETTING', 'BAD_STATION', 'BROADCAST_REFUSED'].includes(error.code), error.code)
        return false
      }
    }
    for (const [name, { kind, least, most }] of Object.entries(PROPERTIES['chino-config'])) {
      if (kind !== 'number') continue
      const given = [least - 1, least, most, most + 1].map(value =>
        works({ broadcast: true, probeFirst: 100, [name]: value })
      )
      assert.deepEqual(given, [false, true, true, false], name)
    }
  })
})
