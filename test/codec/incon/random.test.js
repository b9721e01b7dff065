'use strict'
const assert = require('node:assert/strict')
const { inconRandom } = require('../../support/incon-random')

describe('INCON: random bytes', () => {
  it('20,000 inputs: no exception, nothing grows (endurance run "inconrandom": a million)', () => {
    const { lines, sent, taken } = inconRandom({ inputs: 20000, seed: 21 })
    assert.ok(lines > 10000 && sent > 200 && taken > 1000, JSON.stringify({ lines, sent, taken }))
  })
})
