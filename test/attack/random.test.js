'use strict'

const assert = require('node:assert/strict')
const { masterIdsOf, modbusNotation, nxNotation, parseType } = require('../../lib')
const { readSettings: c24Settings } = require('../../lib/device/c24-settings')
const { readSettings: chinoSettings } = require('../../lib/device/chino-settings')
const { readSettings: inconSettings } = require('../../lib/device/incon-settings')
const { readSettings: nxSettings } = require('../../lib/device/settings')
const { protocolRandom } = require('../support/protocol-random')
const { textRandom } = require('../support/text-random')

/** A million of each: npm run endurance -- random. Lines of C24 and INCON: test/codec/melsec and test/codec/incon. */
describe('attack: random inputs', () => {
  it('answers of NX and MODBUS stations: no exception, an end, and nothing taken whose check does not fit', () => {
    const { ends } = protocolRandom({ inputs: 420, seed: 30 })
    for (const [name, codes] of Object.entries(ends)) assert.ok(codes.values > 0, `${name}: ${JSON.stringify(codes)}`)
  })

  it('addresses, types, tag tables, CSV, payloads, settings: refused with a code, or sound', () => {
    const { taken, codes } = textRandom({ inputs: 1400, seed: 31 })
    for (const name of ['NX items', 'MODBUS items', 'CSV', 'payloads', 'settings of devices'])
      assert.ok(taken[name] > 3, name)
    assert.ok(Object.keys(codes).length > 10)
  })
})

describe('attack: what has no text', () => {
  // found by the random inputs: "Cannot convert object to primitive value" instead of a code
  const textless = { toString: 1 }
  const cases = {
    'a name of a tag': ['BAD_TAG', () => nxNotation({ tags: [{ name: textless, address: 'M0' }] })],
    'a label of a tag': [
      'BAD_TAG',
      () => modbusNotation({ tags: [{ name: 'a', address: '400001', label: textless }] })
    ],
    'a list of IDs': ['BAD_MASTER_ID', () => masterIdsOf([textless])],
    'a type': ['BAD_TYPE', () => parseType(textless)],
    'a name of a PLC': ['BAD_SETTING', () => nxSettings({ station: 1, name: textless }, 0.5)],
    'a name of a regulator': ['BAD_SETTING', () => chinoSettings({ station: 1, name: textless })],
    'a name of a link': ['BAD_SETTING', () => inconSettings({ name: textless })],
    'a name of a port': ['BAD_SETTING', () => c24Settings({ name: textless }, { flowControl: 'none' })],
    'an end code': ['BAD_SETTING', () => c24Settings({ end: textless }, { flowControl: 'none' })],
    steps: ['BAD_SETTING', () => nxSettings({ station: 1, steps: textless }, 0.5)],
    'writable ranges': ['BAD_SETTING', () => nxSettings({ station: 1, writableRanges: [textless] }, 0.5)]
  }
  for (const [name, [code, call]] of Object.entries(cases)) {
    it(`${name}: ${code}`, () => assert.throws(call, { code }))
  }

  it('no limits are the default', () => {
    assert.deepEqual(nxSettings({ station: 1, limits: null }, 0.5).limits, nxSettings({ station: 1 }, 0.5).limits)
  })
})
