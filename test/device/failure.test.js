'use strict'

const assert = require('node:assert/strict')
const { PlcError } = require('../../lib')
const { announced } = require('../../lib/device/announced')
const { asGivenError, asPlcError, isStationFailure } = require('../../lib/device/failure')
const { demotedError } = require('../../lib/device/health-texts')
const { textOf } = require('../../lib/device/options')

describe('what an error says', () => {
  it('whatever is thrown becomes an error with a code; one of ours stays what it is', () => {
    const own = new PlcError('TIMEOUT', { station: 1, timeout: 5 })
    assert.equal(asPlcError(own, 1), own)
    assert.equal(asGivenError(own), own)
    const fault = new TypeError('boom')
    const error = asPlcError(fault, 7)
    assert.deepEqual(
      [error.code, error.details.station, error.details.reason, error.cause],
      ['BAD_ANSWER', 7, 'boom', fault]
    )
    for (const thrown of [undefined, null, 'text', 5, {}]) {
      assert.equal(asPlcError(thrown, 7).code, 'BAD_ANSWER')
      assert.equal(asGivenError(thrown).code, 'BAD_VALUE')
    }
    const given = asGivenError(fault)
    assert.deepEqual([given.code, given.details.reason], ['BAD_VALUE', 'it cannot be looked at: boom'])
  })

  it('of the station, or of the address: a gateway’s word is of the station', () => {
    const isStation = code => isStationFailure(new PlcError(code, { station: 1 }))
    for (const code of ['TIMEOUT', 'CRC_ERROR', 'LINE_DOWN', 'MODBUS_GATEWAY_PATH', 'MODBUS_GATEWAY_TARGET'])
      assert.equal(isStation(code), true, code)
    for (const code of ['PLC_OUT_OF_RANGE', 'MODBUS_ILLEGAL_ADDRESS', 'MODBUS_ILLEGAL_FUNCTION'])
      assert.equal(isStation(code), false, code)
  })

  it('how long a station has been silent, and when it is probed next', () => {
    const said = (now, probeAt) => {
      const health = /** @type {any} */ ({ silentSince: 1000.4, silentAt: 0, probeAt })
      const { lasting, when, since } = demotedError(health, { station: 1, now, probe: 0, sent: false }).details
      return [lasting, when, since]
    }
    assert.deepEqual(said(12000, 17000), ['12 s', 'in 5 s', 1000])
    assert.deepEqual(said(119000, 119000), ['119 s', 'now', 1000])
    assert.deepEqual(said(120000, 0), ['2 min', 'now', 1000])
    assert.deepEqual(said(7199000, 0), ['120 min', 'now', 1000])
    assert.deepEqual(said(7200000, 0), ['2 h', 'now', 1000])
    assert.deepEqual(said(86400000, 86401000), ['24 h', 'in 1 s', 1000])
  })

  it('a setting that is no text', () => {
    assert.deepEqual([textOf('name', ' a '), textOf('name', 5), textOf('name', undefined)], ['a', '5', 'undefined'])
    for (const value of [{}, [], () => {}, Symbol('x'), null]) {
      assert.throws(
        () => textOf('name', value),
        error => error.code === 'BAD_SETTING' && error.details.setting === 'name'
      )
    }
  })
})

describe('a conversation that tells when its frames go out', () => {
  function* twoSteps() {
    const log = []
    for (const send of ['a', 'b']) {
      try {
        log.push(yield { send })
      } catch (/** @type {any} */ error) {
        log.push(error.message)
      }
    }
    return log
  }

  it('adds who is told to each step; answers and failures go through', () => {
    const sent = () => {}
    const dialog = announced(/** @type {any} */ (twoSteps()), sent)
    assert.deepEqual(dialog.next().value, { send: 'a', sent })
    assert.deepEqual(dialog.throw(new Error('lost')).value, { send: 'b', sent })
    const end = dialog.next(Buffer.from('x'))
    assert.deepEqual([end.done, end.value], [true, ['lost', Buffer.from('x')]])
  })

  it('nobody is to be told: the steps are as they were', () => {
    const dialog = announced(/** @type {any} */ (twoSteps()))
    assert.deepEqual(dialog.next().value, { send: 'a' })
    dialog.next(Buffer.from('1'))
    assert.deepEqual(dialog.next(Buffer.from('2')).value, [Buffer.from('1'), Buffer.from('2')])
  })

  it('who leaves it ends what it wraps', () => {
    let over = false
    const inner = (function* () {
      try {
        yield { send: 'a' }
      } finally {
        over = true
      }
    })()
    const dialog = announced(/** @type {any} */ (inner), () => {})
    dialog.next()
    dialog.return(/** @type {any} */ (undefined))
    assert.equal(over, true)
  })
})
