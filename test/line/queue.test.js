'use strict'

const assert = require('node:assert/strict')
const { PRIORITY, Queue } = require('../../lib/line/queue')

const { WRITE, ASK, POLL } = PRIORITY
const always = () => true

const filled = (entries, options) => {
  const queue = new Queue({ limit: 1000, most: 4, ...options })
  for (const [name, priority, station, share = null] of entries) queue.add({ name, priority, station, share })
  return queue
}

const order = (queue, ready = always) => {
  const names = []
  for (let entry = queue.next(ready); entry; entry = queue.next(ready)) names.push(entry.name)
  return names.join(' ')
}

describe('line: queue', () => {
  it('writes go first, then asks, then polls', () => {
    const queue = filled([
      ['p', POLL, 1],
      ['a', ASK, 1],
      ['w', WRITE, 1]
    ])
    assert.equal(order(queue), 'w a p')
  })

  it('within a class the stations take turns, within a station the oldest goes', () => {
    const queue = filled([
      ['1a', POLL, 1],
      ['1b', POLL, 1],
      ['1c', POLL, 1],
      ['2a', POLL, 2],
      ['3a', POLL, 3],
      ['3b', POLL, 3]
    ])
    assert.equal(order(queue), '1a 2a 3a 1b 3b 1c')
  })

  it('lets one poll through after four writes', () => {
    const queue = filled([
      ...Array.from({ length: 10 }, (_, i) => [`w${i}`, WRITE, 1]),
      ['p0', POLL, 2],
      ['p1', POLL, 2]
    ])
    assert.equal(order(queue), 'w0 w1 w2 w3 p0 w4 w5 w6 w7 p1 w8 w9')
  })

  it('lets asks and polls through, each after so many that went before it', () => {
    const queue = filled(
      [...Array.from({ length: 6 }, (_, i) => [`w${i}`, WRITE, 1]), ['a0', ASK, 2], ['a1', ASK, 2], ['p0', POLL, 2]],
      { most: 2 }
    )
    assert.equal(order(queue), 'w0 w1 a0 p0 w2 w3 a1 w4 w5')
  })

  it('counts only while somebody waits', () => {
    const queue = filled(Array.from({ length: 9 }, (_, i) => [`w${i}`, WRITE, 1]))
    for (let i = 0; i < 6; i++) queue.next(always)
    queue.add({ name: 'p', priority: POLL, station: 1, share: null })
    assert.equal(order(queue), 'w6 w7 w8 p')
  })

  it('passes over stations that are not ready, also if they are starved', () => {
    const queue = filled([
      ['w0', WRITE, 1],
      ['w1', WRITE, 2],
      ['p', POLL, 1]
    ])
    assert.equal(
      order(queue, entry => entry.station === 2),
      'w1'
    )
    assert.equal(queue.size, 2)
    assert.equal(order(queue), 'w0 p')
  })

  it('knows who waits under a key, and forgets him when he goes', () => {
    const queue = filled([['p', POLL, 1, 'key']])
    assert.equal(queue.waiting('key').name, 'p')
    queue.next(always)
    assert.equal(queue.waiting('key'), undefined)
  })

  it('of two under one key the newer one is known, whatever becomes of the older one', () => {
    const queue = filled([
      ['old', POLL, 1, 'key'],
      ['new', POLL, 1, 'key'],
      ['none', POLL, 2]
    ])
    assert.equal(queue.waiting(null), undefined, 'no key is none')
    assert.equal(queue.next(always).name, 'old')
    assert.equal(queue.waiting('key').name, 'new')
  })

  it('removes', () => {
    const queue = filled([['p', POLL, 1, 'key']])
    const entry = queue.waiting('key')
    assert.equal(queue.remove(entry), true)
    assert.equal(queue.remove(entry), false)
    assert.equal(queue.size, 0)
    assert.equal(queue.next(always), undefined)
  })

  it('removes from the middle, and what nobody added is not there', () => {
    const queue = filled([
      ['a', POLL, 1],
      ['b', POLL, 1, 'key'],
      ['c', POLL, 1]
    ])
    const other = { name: 'x', priority: POLL, station: 1, share: null }
    assert.equal(queue.remove(other), false)
    assert.equal(queue.remove({ ...other, station: 2 }), false)
    assert.equal(queue.remove(queue.waiting('key')), true)
    assert.deepEqual([queue.size, queue.waiting('key')], [2, undefined])
    assert.equal(order(queue), 'a c')
  })

  it('one that goes first stands before the others of its station', () => {
    const queue = filled([
      ['a', POLL, 1],
      ['b', POLL, 1]
    ])
    queue.add({ name: 'c', priority: POLL, station: 1, share: null }, { first: true })
    assert.deepEqual(
      queue.all().map(({ name }) => name),
      ['c', 'a', 'b']
    )
    assert.deepEqual(
      [...queue.heads()].map(({ name }) => name),
      ['c']
    )
  })

  it('knows when it is full', () => {
    const queue = filled([['p', POLL, 1]], { limit: 1 })
    assert.equal(queue.full, true)
    queue.next(always)
    assert.equal(queue.full, false)
  })
})
