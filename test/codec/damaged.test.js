'use strict'

/** A short run of `npm run endurance -- frames`: what check codes surely see is never taken, the rest as often as theory says. */

const assert = require('node:assert/strict')
const { freshSeed } = require('../../lib/sim')
const { damaged, unexplained } = require('../support/damage')
const { fourBits } = require('../support/damage-theory')

describe('damaged frames', () => {
  for (const protocol of ['nx', 'rtu', 'ascii']) {
    it(`${protocol}: 15,000, by class`, () => {
      const rows = damaged({ protocol, frames: 15000, seed: 1 })
      assert.deepEqual(unexplained(rows), [])
      assert.ok(rows.every(({ frames }) => frames >= 900))
    })

    const seed = freshSeed()
    it(`${protocol}, fresh seed ${seed}: nothing of what is claimed`, () => {
      const rows = damaged({ protocol, frames: 3000, seed }).filter(({ expected }) => expected === 0)
      assert.deepEqual(
        rows.filter(({ wrong }) => wrong > 0),
        []
      )
    })
  }

  it('the run has teeth: what an LRC does not see is taken', () => {
    const rows = damaged({ protocol: 'ascii', frames: 5000, seed: 1 })
    const { wrong } = rows.find(({ name }) => name === 'any two digits swapped') ?? { wrong: 0 }
    assert.ok(wrong > 80, String(wrong))
  })

  it('theory: four bits of nine bytes, by counting', () => {
    // a CRC-16 alone passes one in 1930 there
    assert.equal(Math.round(1 / fourBits({ header: 0, length: 9 })), 1930)
  })
})
