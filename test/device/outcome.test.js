'use strict'

const assert = require('node:assert/strict')
const { PlcError } = require('../../lib')
const { outcomeOf, unsent, wordFor } = require('../../lib/device/outcome')

const error = (code, details = {}) => new PlcError(code, { station: 1, ...details })
const entry = (name, from, to) => ({ item: { text: name, name }, value: 7, from, to })
const CONFIRMED = { outcome: 'confirmed' }
const REFUSED = { outcome: 'refused', error: error('PLC_OUT_OF_RANGE') }
const FAILED = { outcome: 'failed', error: error('LINE_DOWN') }
const OTHER = { outcome: 'failed', error: error('VERIFY_FAILED') }
const UNKNOWN = { outcome: 'unknown', error: error('WRITE_UNKNOWN') }
const NOT_SENT = { outcome: 'notSent' }
const words = ({ outcome, code, items }) => [outcome, code, items.map(item => [item.outcome, item.code])]

describe('what became of a write', () => {
  it('the worst word of an item is its own, the worst item’s that of the whole', () => {
    const of = (...points) => words(outcomeOf([entry('A', 0, points.length)], points, 1))
    assert.deepEqual(of(CONFIRMED, CONFIRMED), ['confirmed', undefined, [['confirmed', undefined]]])
    assert.deepEqual(of(CONFIRMED, UNKNOWN), ['unknown', 'WRITE_UNKNOWN', [['unknown', 'WRITE_UNKNOWN']]])
    assert.deepEqual(of(REFUSED), ['refused', 'PLC_OUT_OF_RANGE', [['refused', 'PLC_OUT_OF_RANGE']]])
    assert.deepEqual(of(REFUSED, FAILED), ['failed', 'LINE_DOWN', [['failed', 'LINE_DOWN']]])
    assert.deepEqual(of(CONFIRMED, OTHER), ['failed', 'VERIFY_FAILED', [['failed', 'VERIFY_FAILED']]])
    const two = outcomeOf([entry('A', 0, 1), entry('B', 1, 2), entry('C', 2, 3)], [CONFIRMED, REFUSED, NOT_SENT], 1)
    const whole = [
      ['confirmed', undefined],
      ['refused', 'PLC_OUT_OF_RANGE'],
      ['notSent', undefined]
    ]
    assert.deepEqual(words(two), ['refused', 'PLC_OUT_OF_RANGE', whole])
    assert.equal(two.error, REFUSED.error)
  })

  it('an item of which only a part was carried out is unknown, and says how much', () => {
    for (const [rest, why] of [
      [REFUSED, 'PLC_OUT_OF_RANGE'],
      [FAILED, 'LINE_DOWN']
    ]) {
      const got = outcomeOf([entry('A', 0, 3)], [CONFIRMED, CONFIRMED, rest], 1)
      assert.deepEqual(words(got), ['unknown', 'WRITE_UNKNOWN', [['unknown', 'WRITE_UNKNOWN']]])
      const { reason, item, station } = got.error.details
      assert.deepEqual([reason, item, station], [`2 of 3 values were written, then ${why}`, 'A', 1])
      assert.equal(got.error.cause, rest.error)
    }
  })

  it('what was not sent because of another item: the cause is that one’s', () => {
    const got = outcomeOf([entry('A', 0, 2), entry('B', 2, 3)], [CONFIRMED, NOT_SENT, FAILED], 1)
    assert.equal(got.error.details.reason, '1 of 2 values were written, then LINE_DOWN')
    assert.equal(got.error.cause, FAILED.error)
  })

  it('nothing was sent: each item says so, whatever the reason was', () => {
    const one = unsent(error('READ_ONLY', { item: 'A' }), [entry('A', 0, 1), { item: 'B', value: 1 }])
    assert.deepEqual(words(one), [
      'refused',
      'READ_ONLY',
      [
        ['notSent', undefined],
        ['notSent', undefined]
      ]
    ])
    assert.deepEqual(
      one.items.map(({ item, name }) => [item, name]),
      [
        ['A', 'A'],
        ['B', 'B']
      ]
    )
    assert.deepEqual([one.attempts, one.ms], [0, 0])
    assert.equal(unsent(new Error('boom'), [], 'failed').outcome, 'failed')
    assert.equal(unsent(new Error('boom'), []).code, 'BAD_VALUE')
  })

  it('what a failed request means', () => {
    for (const [code, word] of [
      ['WRITE_UNKNOWN', 'unknown'],
      ['BROADCAST_UNCONFIRMED', 'unknown'],
      ['PLC_OUT_OF_RANGE', 'refused'],
      ['MODBUS_ILLEGAL_ADDRESS', 'refused'],
      ['STEP_TOO_LARGE', 'refused'],
      ['WRITE_TOO_SOON', 'refused'],
      ['NOT_A_VALUE', 'refused'],
      ['LINE_DOWN', 'failed'],
      ['TIMEOUT', 'failed'],
      ['STATION_DEMOTED', 'failed']
    ]) {
      assert.equal(wordFor(error(code)), word, code)
    }
  })
})
