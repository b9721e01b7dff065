'use strict'

const assert = require('node:assert/strict')
const { Holes } = require('../../lib/device/holes')

const word = address => ({ kind: 'word', address, count: 1 })
const bit = address => ({ kind: 'bit', address, count: 1 })

describe('addresses that a block read over, and that the station does not have', () => {
  const learnt = (ask, before, after) => {
    const holes = new Holes()
    holes.learn({ ask }, before, after)
    return holes.list
  }

  it('lie between the two halves that could be read', () => {
    assert.deepEqual(learnt('readWords', [word(2), word(5)], [word(9)]), [{ kind: 'word', start: 6, end: 9 }])
    assert.deepEqual(learnt('readBits', [bit(2)], [bit(9), bit(12)]), [{ kind: 'bit', start: 3, end: 9 }])
  })

  it('bits of a block of words stand in their words', () => {
    const last = { kind: 'bit', address: 5 * 16 + 15, count: 2 } // the second one in word 6
    assert.deepEqual(learnt('readWords', [bit(16), last], [bit(9 * 16 + 3)]), [{ kind: 'word', start: 7, end: 9 }])
  })

  it('neighbours have none between them, and a mixed request reads over nothing', () => {
    assert.deepEqual(learnt('readWords', [word(5)], [word(6)]), [])
    assert.deepEqual(learnt('readWords', [word(6)], [word(5)]), [])
    assert.deepEqual(learnt('readMixed', [word(5)], [word(9)]), [])
  })

  it('are a thousand at most; the same one counts once', () => {
    const holes = new Holes()
    for (let n = 0; n < 1000; n++) holes.learn({ ask: 'readWords' }, [word(4 * n)], [word(4 * n + 3)])
    assert.equal(holes.list.length, 1000)
    holes.learn({ ask: 'readWords' }, [word(4000)], [word(4003)])
    holes.learn({ ask: 'readWords' }, [word(4000)], [word(4003)])
    assert.deepEqual(holes.list, [{ kind: 'word', start: 4001, end: 4003 }])
  })
})
