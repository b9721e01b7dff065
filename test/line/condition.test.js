'use strict'

const assert = require('node:assert/strict')
const { PlcError } = require('../../lib/error')
const { Condition } = require('../../lib/line/condition')

const create = () => {
  const told = []
  const condition = new Condition({ line: 'L1', changed: (state, reason) => told.push([state, reason?.code]) })
  return { condition, told }
}
const gone = new PlcError('PORT_GONE', { path: '/dev/x' })

describe('line: its condition', () => {
  it('nothing can be sent over a closed line, or one that is being given up', () => {
    const { condition } = create()
    assert.deepEqual(
      [condition.refusal().code, condition.refusal().details],
      ['LINE_CLOSED', { line: 'L1', sent: false }]
    )
    condition.become('open')
    assert.equal(condition.refusal(), null)
    condition.closing = true
    assert.equal(condition.refusal().code, 'LINE_CLOSED')
  })

  it('the first opening is waited for, but nothing is sent before it', () => {
    const { condition } = create()
    condition.become('opening')
    assert.equal(condition.rejection(), null)
    assert.deepEqual(condition.refusal().details, { line: 'L1', reason: 'it is still being opened', sent: false })
    condition.closing = true
    assert.equal(condition.rejection().code, 'LINE_CLOSED')
  })

  it('while it waits the reason is given, each time as an error of its own', () => {
    const { condition } = create()
    condition.become('waiting', gone)
    const [one, two] = [condition.refusal(), condition.rejection()]
    assert.notEqual(one, two)
    assert.deepEqual([one.code, one.details, one.cause], ['PORT_GONE', { path: '/dev/x', sent: false }, gone])
    assert.equal(two.code, 'PORT_GONE')
  })

  it('tells a change, once', () => {
    const { condition, told } = create()
    condition.become('opening')
    condition.become('opening')
    condition.become('waiting', gone)
    condition.become('waiting', new PlcError('PORT_GONE', { path: '/dev/y' }))
    condition.become('waiting', new PlcError('PORT_BUSY', { path: '/dev/x' }))
    condition.become('open')
    assert.deepEqual(told, [
      ['opening', undefined],
      ['waiting', 'PORT_GONE'],
      ['waiting', 'PORT_BUSY'],
      ['open', undefined]
    ])
    assert.equal(condition.reason, null)
  })

  it('what a transport said becomes a reason', () => {
    const { condition } = create()
    assert.equal(condition.asReason(gone), gone)
    const fault = new Error('EIO')
    const reason = condition.asReason(fault)
    assert.deepEqual([reason.code, reason.details.reason, reason.cause], ['LINE_DOWN', 'EIO', fault])
    for (const nothing of [null, undefined]) {
      assert.equal(condition.asReason(nothing).details.reason, 'the connection was closed')
    }
  })
})
