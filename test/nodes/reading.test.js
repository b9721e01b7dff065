'use strict'

const assert = require('node:assert/strict')
const { reconnected } = require('../../nodes/reading')

describe('nodes that read: everything again after the line was lost', () => {
  const count = (...states) => {
    let times = 0
    const tell = reconnected(() => times++)
    states.forEach(state => tell({ state }))
    return times
  }

  it('when it is open again, each time', () => {
    assert.equal(count('open', 'waiting', 'opening', 'open'), 1)
    assert.equal(count('open', 'waiting', 'open', 'open', 'waiting', 'waiting', 'open'), 2)
  })

  it('not when it opens first, nor after a jam, in which nothing is lost', () => {
    assert.equal(count('opening', 'open'), 0)
    assert.equal(count('open', 'jammed', 'open'), 0)
  })
})
