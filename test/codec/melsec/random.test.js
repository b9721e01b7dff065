'use strict'
const assert = require('node:assert/strict')
const { melsecRandom } = require('../../support/melsec-random')

describe('MELSEC: random bytes', () => {
  it('20,000 inputs: no exception, nothing grows (endurance run "c24random": a million)', () => {
    const { messages, bytes } = melsecRandom({ inputs: 20000, seed: 20 })
    assert.ok(bytes > 100000 && messages > 1000)
  })
})
