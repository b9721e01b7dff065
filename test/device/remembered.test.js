'use strict'

const assert = require('node:assert/strict')
const { remembered } = require('../../lib/device/remembered')

describe('what is made once for each object', () => {
  it('is made by the first who asks, for equal objects apart, also where it is nothing', () => {
    const made = []
    const nameOf = remembered(({ name }) => (made.push(name), name))
    const [a, twin, nameless] = [{ name: 'a' }, { name: 'a' }, { name: undefined }]
    for (const each of [a, nameless, twin, a, nameless, a]) assert.equal(nameOf(each), each.name)
    assert.deepEqual(made, ['a', undefined, 'a'])
  })

  it('is made again where making it failed', () => {
    let tries = 0
    const fussy = remembered(() => {
      if (++tries === 1) throw new Error('not yet')
      return tries
    })
    const key = {}
    assert.throws(() => fussy(key), /not yet/)
    assert.deepEqual([fussy(key), fussy(key)], [2, 2])
  })
})
