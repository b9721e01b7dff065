'use strict'

const assert = require('node:assert/strict')
const { Awaited } = require('../../lib/line/awaited')

/** An error has five bytes; a character takes a millisecond. */
const NEED = 5
const create = ({ slack = 100 } = {}) => new Awaited({ character: 1, slack })
const STEP = { usual: 20, timeout: 1000 }
const whole = { usual: 20 }

describe('line: how many bytes of an answer are worth reading', () => {
  it('those of an error, where nobody tells how long an answer is, or it is not longer', () => {
    assert.equal(create().bytes({ timeout: 1000 }, NEED, 0), 5)
    assert.equal(create().bytes({ usual: 0, timeout: 1000 }, NEED, 3), 5)
    assert.equal(create().bytes({ usual: 5, timeout: 1000 }, NEED, 0), 5)
    assert.equal(create().bytes({ usual: 4, timeout: 1000 }, NEED, 0), 5)
  })

  it('the whole answer, with our own echo before it, if an error is seen at most 25 ms later', () => {
    const of = (usual, echo) => create().bytes({ usual, timeout: 1000 }, NEED, echo)
    assert.deepEqual([of(20, 0), of(30, 0), of(31, 0)], [20, 30, 5])
    assert.deepEqual([of(20, 10), of(20, 11)], [30, 5])
    const half = new Awaited({ character: 0.5, slack: 100 })
    assert.deepEqual(
      [half.bytes({ usual: 55, timeout: 1000 }, NEED, 0), half.bytes({ usual: 56, timeout: 1000 }, NEED, 0)],
      [55, 5]
    )
  })

  it('or half of the slack', () => {
    const of = usual => create({ slack: 40 }).bytes({ usual, timeout: 1000 }, NEED, 0)
    assert.deepEqual([of(25), of(26)], [25, 5])
  })

  it('60 ms behind a whole answer, but not more than a quarter of the timeout', () => {
    const awaited = create({ slack: 2 })
    const of = (usual, timeout) => awaited.bytes({ usual, timeout }, NEED, 0)
    assert.equal(of(20, 1000), 5)
    awaited.answered(Buffer.alloc(20), whole)
    assert.deepEqual([of(65, 1000), of(66, 1000)], [65, 5])
    assert.deepEqual([of(45, 160), of(46, 160)], [45, 5])
  })

  for (const [what, change] of /** @type {[string, (awaited: Awaited) => void][]} */ ([
    ['an error', awaited => awaited.answered(Buffer.alloc(5), whole)],
    ['an answer of which nobody tells how long it is', awaited => awaited.answered(Buffer.alloc(20), {})],
    ['a failure', awaited => awaited.forget()]
  ])) {
    it(`as before behind ${what}`, () => {
      const awaited = create({ slack: 2 })
      awaited.answered(Buffer.alloc(20), whole)
      assert.equal(awaited.bytes(STEP, NEED, 0), 20)
      change(awaited)
      assert.equal(awaited.bytes(STEP, NEED, 0), 5)
    })
  }
})
