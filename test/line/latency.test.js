'use strict'
const assert = require('node:assert/strict')
const { latencyTimer } = require('../../lib/line')

const FILE = '/sys/bus/usb-serial/devices/ttyUSB3/latency_timer'

/** A machine with one FTDI adapter. */
const files = (text = '16\n') => ({
  realpath: async path => {
    if (path === '/dev/serial/by-id/usb-FTDI' || path === '/dev/ttyUSB3') return '/dev/ttyUSB3'
    if (path === '/dev/ttyS0') return path
    throw new Error('ENOENT')
  },
  readFile: async path => {
    if (path === FILE) return text
    throw new Error('ENOENT')
  }
})

describe('latency timer of an FTDI adapter', () => {
  for (const [what, path, text, expected] of /** @type {any[]} */ ([
    ['of a device', '/dev/ttyUSB3', '16\n', 16],
    ['of a stable name', '/dev/serial/by-id/usb-FTDI', '1\n', 1],
    ['of another kind of port', '/dev/ttyS0', '16\n', null],
    ['of a port that is not there', '/dev/ttyUSB9', '16\n', null],
    ['no number', '/dev/ttyUSB3', 'rubbish', null],
    ['more than a number', '/dev/ttyUSB3', '16 ms', null],
    ['a number behind something', '/dev/ttyUSB3', 'ms 16', null],
    ['too long', '/dev/ttyUSB3', '1000', null],
    ['empty', '/dev/ttyUSB3', '', null]
  ])) {
    it(`${what}: ${expected === null ? 'none' : `${expected} ms`}`, async () => {
      const found = await latencyTimer(path, files(text))
      assert.deepEqual(found, expected === null ? null : { device: '/dev/ttyUSB3', file: FILE, value: expected })
    })
  }

  it('on this machine: never rejects', async () => {
    assert.equal(await latencyTimer('/dev/nothing-here'), null)
    assert.equal(await latencyTimer(/** @type {any} */ (undefined)), null)
  })
})
