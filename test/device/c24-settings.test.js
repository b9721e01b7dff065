'use strict'

const assert = require('node:assert/strict')
const { readSettings } = require('../../lib/device/c24-settings')

const hex = bytes => Buffer.from(bytes).toString('hex')

describe('C24 settings', () => {
  it('have their defaults, also for a line that tells neither times nor flow control', () => {
    const { format, value, use, ...rest } = readSettings({}, {})
    assert.deepEqual([rest.name, rest.bidirectional, rest.character, rest.quiet], ['C24', false, 0.52, 0])
    assert.deepEqual([rest.ackTimeout, rest.attempts, rest.repeatUnanswered], [1000, 3, false])
    assert.deepEqual([rest.priority, rest.repeats, rest.repeatAfter, rest.repeatWithin], ['both', 'mark', 0, 10000])
    assert.deepEqual(value, { format: 'text', encoding: 'latin1', most: 16384 })
    assert.deepEqual([format.framing, hex(format.marker)], ['end', '0d0a'])
    assert.deepEqual(use, {
      flow: 'none',
      transparent: null,
      room: 64,
      stallLimit: 30000,
      torn: { wait: 0, first: null }
    })
  })

  it('bytes as text in hexadecimal, in any manner, or as bytes', () => {
    for (const end of ['02 03', '0203', '02,03', '02, 03', Buffer.from([2, 3]), new Uint8Array([2, 3])])
      assert.equal(hex(readSettings({ end }, {}).format.marker), '0203')
    for (const end of [null, undefined]) assert.equal(hex(readSettings({ end }, {}).format.marker), '0d0a')
    const reason = 'bytes in hexadecimal are needed, as 0D 0A'
    for (const end of ['0', 'CR', '0x0D', '0D0']) {
      assert.throws(() => readSettings({ end }, {}), {
        code: 'BAD_SETTING',
        details: { setting: 'end', value: end, reason }
      })
    }
  })

  it('flow control: ours, or the driver’s, which the line must have', () => {
    const use = (given, line = {}) => readSettings(given, line).use
    assert.equal(use({ flow: 'dc' }).flow, 'dc')
    assert.equal(use({ flow: 'driver' }, { flowControl: 'rtscts' }).flow, 'none')
    assert.throws(() => use({ flow: 'driver' }), {
      details: { setting: 'flow', value: 'driver', reason: 'the line has no flow control: set it there' }
    })
    assert.throws(() => use({ flow: 'driver' }, { flowControl: 'none' }), { code: 'BAD_SETTING' })
    assert.equal(use({ flow: 'dc', transparent: '10' }).transparent, 0x10)
    assert.throws(() => use({ end: '13' }, { flowControl: 'xonxoff' }), { code: 'BAD_SETTING' })
  })

  it('who answers each other waits four characters before a message', () => {
    const quiet = (given, character) => readSettings({ bidirectional: true, ...given }, { times: { character } }).quiet
    assert.deepEqual([quiet({}, 1.04), quiet({ quiet: 50 }, 1.04), quiet({ quiet: 1 }, 33.4)], [5, 50, 134])
  })

  it('what ends a torn message: the end code, converted where messages are', () => {
    const first = given => readSettings({ tornEnd: true, ...given }, {}).use.torn.first
    assert.equal(hex(first({})), '0d0a')
    assert.equal(first({ asciiBinary: true }).toString(), '0D0A')
    assert.equal(hex(first({ asciiBinary: true, last: '03' })), '03')
    assert.equal(first({ bidirectional: true }), null)
    assert.equal(first({ framing: 'gap', gap: 20 }), null)
    assert.equal(readSettings({}, {}).use.torn.first, null)
  })

  it('by silence: behind a message, and behind a torn one, as long', () => {
    const { after, use } = readSettings({ framing: 'gap', gap: 40, timer0: 10 }, {})
    assert.deepEqual([after, use.torn.wait], [40, 40])
    assert.equal(readSettings({ framing: 'gap', gap: 40, timer0: 90 }, {}).use.torn.wait, 90)
    assert.equal(readSettings({ timer0: 90 }, {}).use.torn.wait, 90)
  })
})
