'use strict'

const assert = require('node:assert/strict')
const { PlcError } = require('../../../lib/error')
const { goneError, openError } = require('../../../lib/line/transports/port-errors')

// what the bindings of Linux, macOS and Windows say
const SAID = [
  ['Error: Cannot lock port', 'PORT_BUSY'],
  ['Error Resource temporarily unavailable Cannot lock port', 'PORT_BUSY'],
  ['Error: Resource busy, cannot open /dev/tty.usbserial', 'PORT_BUSY'],
  ['Error: Device or resource busy, cannot open /dev/ttyUSB0', 'PORT_BUSY'],
  ['Opening COM3: Access denied', 'PORT_BUSY'],
  ['Opening COM3: Access is denied', 'PORT_BUSY'],
  ['EBUSY', 'PORT_BUSY'],
  ['Error: Permission denied, cannot open /dev/ttyUSB0', 'PORT_DENIED'],
  ['EACCES', 'PORT_DENIED'],
  ['EPERM: operation not permitted', 'PORT_DENIED'],
  ['Error: No such file or directory, cannot open /dev/ttyUSB0', 'PORT_NOT_FOUND'],
  ['Opening COM3: File not found', 'PORT_NOT_FOUND'],
  ['Error: The system cannot find the file specified', 'PORT_NOT_FOUND'],
  ['Error: No such device', 'PORT_NOT_FOUND'],
  ['ENXIO', 'PORT_NOT_FOUND'],
  ['Error: Input/output error', 'PORT_ERROR']
]

describe('line: what a binding says', () => {
  for (const [text, code] of SAID) {
    it(`"${text}" is ${code}`, () => {
      const fault = new Error(text)
      const error = openError(fault, 'COM3')
      assert.deepEqual([error.code, error.details, error.cause], [code, { path: 'COM3', reason: text }, fault])
    })
  }

  it('what is no error object is one, too', () => {
    assert.equal(openError('EBUSY', 'p').code, 'PORT_BUSY')
    assert.deepEqual(openError(undefined, 'p').details, { path: 'p', reason: 'undefined' })
    assert.deepEqual(goneError(undefined, 'p').details, { path: 'p', reason: '' })
    assert.deepEqual(goneError(new Error('bad file'), 'p').details, { path: 'p', reason: 'bad file' })
  })

  it('an error of ours stays what it is', () => {
    const own = new PlcError('PORT_GONE', { path: 'p' })
    assert.equal(openError(own, 'q'), own)
    assert.equal(goneError(own, 'q'), own)
  })
})
