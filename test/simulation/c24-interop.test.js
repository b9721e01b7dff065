'use strict'
const assert = require('node:assert/strict')
const { createC24Port, createPool } = require('../../lib')
const { createPeerLine, createVirtualClock } = require('../../lib/sim')

/** The port and the simulated module were written apart: settings that are named alike must mean the same bytes, both ways. */

const SETTINGS = {
  'end code CR LF': {},
  'one byte': { end: '00' },
  'user frames': { first: '02', last: '03', unit: 'byte' },
  'additional code': { transparent: '10', end: '00' },
  'DC1 and DC3 made transparent': { transparent: '10', flow: 'dc', end: '00' },
  'ASCII-binary': { asciiBinary: true },
  'ASCII-binary, DC1 and DC3': { asciiBinary: true, flow: 'dc' },
  bidirectional: { bidirectional: true },
  'bidirectional, bytes': { bidirectional: true, unit: 'byte' },
  'bidirectional, no sum': { bidirectional: true, sumCheck: false },
  'bidirectional, additional code': { bidirectional: true, transparent: '10' },
  'bidirectional, ASCII-binary': { bidirectional: true, asciiBinary: true }
}

/** Every byte, in pieces of even length that start at each place. */
const BODIES = Array.from({ length: 32 }, (_, n) =>
  Buffer.from(Array.from({ length: 16 }, (__, at) => (n * 8 + at) & 255))
)

const exchange = async settings => {
  const clock = createVirtualClock()
  const { bidirectional, ...module } = settings
  const taken = []
  const peer = {
    ...module,
    // the module escapes what its own settings name: DC1, DC3 and the additional code
    ...(bidirectional ? { protocol: 'bidirectional' } : {}),
    onMessage: ({ bytes }) => taken.push(bytes.toString('hex'))
  }
  const { wire, device } = createPeerLine({ device: 'c24', settings: peer, baudRate: 19200, clock, quiet: true })
  const pool = createPool({ clock, random: () => 0.5 })
  const lease = pool.open({ transport: 'simulated', path: 'c24', wire, baudRate: 19200 }, { id: 'a', name: 'a' })
  const port = createC24Port({ lease, clock, format: 'bytes', ...settings })
  const got = []
  port.listen(({ bytes, complete, reason }) => got.push(complete ? bytes.toString('hex') : `${reason}`))
  await clock.advance(100)
  const sent = []
  const refused = []
  for (const body of BODIES) {
    const outcome = await clock.run(port.send(body))
    if (outcome.outcome === 'refused') {
      refused.push(outcome.code)
      continue
    }
    assert.equal(outcome.outcome, bidirectional ? 'confirmed' : 'sent')
    sent.push(body.toString('hex'))
    device.send(body)
    await clock.advance(500)
  }
  await clock.advance(1000)
  port.close()
  await clock.run(lease.release())
  return { sent, refused, taken, got }
}

describe('C24 port and simulated module', () => {
  for (const [name, settings] of Object.entries(SETTINGS)) {
    it(`mean the same bytes: ${name}`, async () => {
      const { sent, refused, taken, got } = await exchange(settings)
      assert.deepEqual(taken, sent)
      assert.deepEqual(got, sent)
      assert.ok(sent.length > BODIES.length / 2)
      for (const code of refused) assert.equal(code, 'END_CODE_INSIDE')
    })
  }
})
