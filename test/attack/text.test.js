'use strict'

const assert = require('node:assert/strict')
const { createInconLink, createPool } = require('../../lib')
const { createVirtualClock } = require('../../lib/sim')
const { createWire } = require('../line/support/bench')

/** What a link makes of these bytes. */
const heard = async (bytes, own) => {
  const clock = createVirtualClock()
  const wire = createWire(clock)
  const pool = createPool({ clock, random: () => 0.5 })
  const lease = pool.open({ transport: 'simulated', wire }, { id: 'a', name: 'a' })
  const link = createInconLink({ lease, clock, ...own })
  const got = []
  link.listen(line => got.push(line))
  await clock.advance(5)
  wire.handlers.data(bytes)
  await clock.advance(500)
  const { damaged } = link.stats
  link.close()
  await clock.run(lease.release())
  return { got, damaged }
}

describe('attack: text that is none', () => {
  // FF 0A and the like came as complete lines of U+FFFD
  const LINES = {
    ff: false,
    c3: false, // the first byte of two
    eda080: false, // half of a pair of surrogates
    c080: false, // a NUL that is written too long
    f4908080: false, // beyond Unicode
    '4fc3a9': true,
    efbfbd: true, // the replacement character itself
    ec98a8eb8f84: true // 온도
  }
  for (const [hex, valid] of Object.entries(LINES)) {
    it(`INCON, UTF-8: ${hex} is ${valid ? 'whole' : 'marked, and its bytes are kept'}`, async () => {
      const bytes = Buffer.from(hex, 'hex')
      const { got, damaged } = await heard(Buffer.concat([bytes, Buffer.from('\r\n')]), { encoding: 'utf8' })
      const [line] = got
      assert.deepEqual([line.complete, line.reason], valid ? [true, undefined] : [false, 'encoding'])
      assert.equal(line.bytes.toString('hex'), hex)
      if (valid) assert.equal(line.value, bytes.toString('utf8'))
      assert.equal(damaged, valid ? 0 : 1)
    })
  }

  it('INCON, other encodings: every byte is a character', async () => {
    const { got, damaged } = await heard(Buffer.from('ff4f0d0a', 'hex'), { encoding: 'latin1' })
    assert.deepEqual([got[0].complete, got[0].value, damaged], [true, 'ÿO', 0])
  })
})
