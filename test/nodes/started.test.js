'use strict'

const assert = require('node:assert/strict')
const { EventEmitter } = require('node:events')
const { onStarted } = require('../../nodes/started.js')

describe('nodes: after each deploy', () => {
  it('a hundred nodes are one listener, and none is left behind', () => {
    const events = new EventEmitter()
    let calls = 0
    const ends = Array.from({ length: 100 }, () => onStarted(events, () => calls++))
    assert.equal(events.listenerCount('flows:started'), 1)
    events.emit('flows:started')
    events.emit('flows:started')
    assert.equal(calls, 200)
    ends.forEach(end => end())
    ends.forEach(end => end())
    assert.equal(events.listenerCount('flows:started'), 0)
    events.emit('flows:started')
    assert.equal(calls, 200)
  })

  it('one that ends another, or itself, while it is called', () => {
    const events = new EventEmitter()
    const heard = []
    const first = onStarted(events, () => {
      heard.push('first')
      first()
      second()
    })
    const second = onStarted(events, () => heard.push('second'))
    events.emit('flows:started')
    assert.deepEqual(heard, ['first'])
    const third = onStarted(events, () => heard.push('third'))
    events.emit('flows:started')
    third()
    assert.deepEqual(heard, ['first', 'third'])
    assert.equal(events.listenerCount('flows:started'), 0)
  })
})
