'use strict'

/** A short run of `npm run endurance -- frames`: what check codes surely see is never taken, the rest as often as theory says. */

const assert = require('node:assert/strict')
const { createRandom, freshSeed } = require('../../lib/sim')
const { damaged, unexplained } = require('../support/damage')
const { bitsOfAscii, fourBits } = require('../support/damage-theory')

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

  it('theory: two bits of an ASCII answer of one register, by trying all pairs', () => {
    const [theory, tried] = [bitsOfAscii({ header: 7, length: 15 }, 2), allPairsOfBits(300)]
    assert.ok(Math.abs(tried - theory) < 0.1 * theory, `${tried}, ${theory}`)
  })
})

/** The share of all pairs of bits after which an LRC still fits and the header is the same: station 11h, function 03, two bytes; random data. */
function allPairsOfBits(frames) {
  const random = createRandom(4)
  const weightOf = at => (at % 2 === 1 ? 16 : 1)
  let [pairs, passed] = [0, 0]
  for (let n = 0; n < frames; n++) {
    const data = [0x11, 3, 2, random.integer(0, 255), random.integer(0, 255)]
    const sum = data.reduce((a, b) => a + b, 0)
    const text = [...data, -sum & 255].map(byte => byte.toString(16).padStart(2, '0')).join('')
    const frame = Buffer.from(`:${text.toUpperCase()}\r\n`)
    // what one flipped bit changes in the sum; 0: it is refused whatever the other one does
    const changes = Array.from({ length: 120 }, (_, bit) => {
      const at = bit >> 3
      const other = String.fromCharCode(frame[at] ^ (1 << (bit & 7)))
      if (at < 7 || at > 12 || !/[0-9A-F]/.test(other)) return 0
      return (parseInt(other, 16) - parseInt(String.fromCharCode(frame[at]), 16)) * weightOf(at)
    })
    for (let a = 0; a < 120; a++)
      for (let b = a + 1; b < 120; b++) {
        pairs++
        if (changes[a] !== 0 && changes[b] !== 0 && (changes[a] + changes[b]) % 256 === 0 && a >> 3 !== b >> 3) passed++
      }
  }
  return passed / pairs
}
