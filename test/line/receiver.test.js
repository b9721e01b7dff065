'use strict'

const assert = require('node:assert/strict')
const { Receiver } = require('../../lib/line/receiver')

const LIMIT = 4096

describe('line: received bytes', () => {
  it('are kept with the time of the first one; taking goes through the chunks', () => {
    const rx = new Receiver()
    assert.equal(rx.firstAt, Infinity)
    rx.push(Buffer.from([1, 2, 3]), 10)
    rx.push(Buffer.from([4, 5]), 20)
    assert.equal(rx.firstAt, 10)
    assert.deepEqual([...rx.take(2)], [1, 2])
    assert.equal(rx.firstAt, 10)
    assert.deepEqual([...rx.take(1)], [3])
    assert.equal(rx.firstAt, 20)
    assert.deepEqual([...rx.take(0)], [])
    assert.deepEqual([...rx.take(9)], [4, 5])
    assert.deepEqual([rx.firstAt, rx.bytes.length, rx.takeAll().length], [Infinity, 0, 0])
  })

  it('what was taken is a copy', () => {
    const rx = new Receiver()
    const chunk = Buffer.from([1, 2])
    rx.push(chunk, 0)
    const taken = rx.take(1)
    chunk[0] = 9
    assert.equal(taken[0], 1)
  })

  it('are bounded: the oldest go first', () => {
    const rx = new Receiver()
    assert.equal(rx.push(Buffer.alloc(LIMIT, 1), 10).length, 0)
    assert.deepEqual([...rx.push(Buffer.from([2, 3]), 20)], [1, 1])
    assert.deepEqual([rx.bytes.length, rx.firstAt, rx.bytes.at(-1)], [LIMIT, 10, 3])
    assert.equal(rx.push(Buffer.alloc(2 * LIMIT, 4), 30).length, 2 * LIMIT)
    assert.deepEqual([rx.bytes.length, rx.firstAt, rx.bytes[0]], [LIMIT, 30, 4])
  })
})
