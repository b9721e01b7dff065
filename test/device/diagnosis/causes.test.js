'use strict'
const assert = require('node:assert/strict')
const { causeOf } = require('../../../lib/device/diagnosis/causes')
const { CODES, PlcError } = require('../../../lib/error')

const silent = (stray, more) => ({
  ...{ code: 'TIMEOUT', text: 'no answer', protocol: 'rtu', station: 1, timeout: 200, transport: 'serial' },
  evidence: { frames: [], queries: [], answers: 0, echo: false, stray },
  ...more
})

describe('causes of a failed read', () => {
  it('stray bytes are shown, 24 of them at most', () => {
    const bytes = length => causeOf(silent(Buffer.alloc(length, 0xab))).details.bytes
    assert.equal(bytes(2), 'AB AB')
    assert.equal(bytes(24), new Array(24).fill('AB').join(' '))
    assert.equal(bytes(25), `${new Array(24).fill('AB').join(' ')} …`)
  })

  it('an error by its own name: its text without the remedy, which stands apart', () => {
    const error = new PlcError('PORT_BUSY', { path: 'p' })
    const own = causeOf({ ...silent(Buffer.alloc(0)), code: 'PORT_BUSY', text: error.message })
    assert.equal(own.code, 'PORT_BUSY')
    assert.equal(own.remedy, CODES.PORT_BUSY[1])
    assert.equal(`${own.text}. ${own.remedy}`, error.message)
    assert.equal(causeOf({ ...silent(Buffer.alloc(0)), code: 'PORT_BUSY', text: 'else' }).text, 'else')
    assert.equal(causeOf({ ...silent(Buffer.alloc(0)), code: 'STRANGE', text: 'else' }).remedy, 'Look at the cause.')
  })
})
