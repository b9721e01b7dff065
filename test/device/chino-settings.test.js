'use strict'

const assert = require('node:assert/strict')
const { readSettings } = require('../../lib/device/chino-settings')

const codeOf = given => {
  try {
    readSettings({ station: 1, ...given })
  } catch (error) {
    return error.code
  }
  return 'good'
}

describe('CHINO regulator: settings', () => {
  it('the panel’s own are the defaults', () => {
    const {
      timeout,
      sendWait,
      attempts,
      addressMode,
      framing,
      access,
      broadcast,
      functions,
      units,
      turnaround,
      name,
      wordOrder
    } = readSettings({ station: '11' })
    assert.deepEqual(
      {
        timeout,
        sendWait,
        attempts,
        addressMode,
        framing,
        access,
        broadcast,
        functions,
        units,
        turnaround,
        name,
        wordOrder
      },
      {
        timeout: 1000,
        sendWait: 0,
        attempts: 3,
        addressMode: '1-base',
        framing: 'rtu',
        access: 'read',
        broadcast: null,
        functions: { co: '0F', hr: '10' },
        units: { 1: 1, 2: 1 },
        turnaround: 100,
        name: 'station 11',
        wordOrder: 'low'
      }
    )
  })

  it('empty means the default; numbers may be texts, functions numbers', () => {
    const settings = readSettings({
      station: ' 7 ',
      coilRead: '',
      holdingRead: '20',
      coilFunction: 5,
      holdingFunction: '6',
      name: ' a '
    })
    assert.deepEqual(
      [settings.coilRead, settings.holdingRead, settings.functions, settings.name],
      [2000, 20, { co: '05', hr: '06' }, 'a']
    )
    assert.deepEqual(readSettings({ station: 1, holdingFunction: 10, coilFunction: '0f' }).functions, {
      co: '0F',
      hr: '10'
    })
  })

  const cases = [
    [{ station: '' }, 'BAD_STATION'],
    [{ station: 248 }, 'BAD_STATION'],
    [{ station: -1 }, 'BAD_STATION'],
    [{ station: 1.5 }, 'BAD_STATION'],
    [{ station: 'x' }, 'BAD_STATION'],
    [{ station: 0 }, 'BROADCAST_REFUSED'],
    [{ station: 0, broadcast: 'true' }, 'good'],
    [{ station: 247 }, 'good'],
    [{ protocol: 'tcp' }, 'BAD_SETTING'],
    [{ addressMode: '2-base' }, 'BAD_SETTING'],
    [{ coilFunction: '10' }, 'BAD_SETTING'],
    [{ holdingFunction: '0F' }, 'BAD_SETTING'],
    [{ coilRead: 2001 }, 'BAD_SETTING'],
    [{ coilRead: 0 }, 'BAD_SETTING'],
    [{ coilWrite: 1969 }, 'BAD_SETTING'],
    [{ discreteRead: 2001 }, 'BAD_SETTING'],
    [{ inputRead: 126 }, 'BAD_SETTING'],
    [{ holdingRead: 126 }, 'BAD_SETTING'],
    [{ holdingWrite: 124 }, 'BAD_SETTING'],
    [{ coilUnit: 17, coilRead: 16 }, 'BAD_SETTING'],
    [{ coilUnit: 16, coilRead: 16 }, 'good'],
    [{ discreteUnit: 9, discreteRead: 8 }, 'BAD_SETTING'],
    [{ coilUnit: 0 }, 'BAD_SETTING'],
    [{ timeout: 5 }, 'BAD_SETTING'],
    [{ sendWait: -1 }, 'BAD_SETTING'],
    [{ attempts: 0 }, 'BAD_SETTING'],
    [{ turnaround: 10001 }, 'BAD_SETTING'],
    [{ wordOrder: 'middle' }, 'BAD_SETTING'],
    [{ access: 'all' }, 'BAD_SETTING'],
    [{ writableRanges: '400001..400010, 000001' }, 'good'],
    [{ writableRanges: '4000' }, 'BAD_ADDRESS'],
    [{ tags: [{ name: 'a', address: '40' }] }, 'BAD_TAG'],
    [{ tags: [{ name: 'a', address: '000001:uint16', min: 1 }] }, 'good']
  ]
  for (const [given, code] of cases) it(`${JSON.stringify(given)}: ${code}`, () => assert.equal(codeOf(given), code))
})
