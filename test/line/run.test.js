'use strict'

const assert = require('node:assert/strict')
const { PlcError } = require('../../lib/error')
const { Run, isLineFailure } = require('../../lib/line/run')
const { failure } = require('./support/bench')

const STEP = { send: Buffer.from('q'), match: () => ({}), timeout: 1 }
const create = make => new Run(make, /** @type {any} */ ({}))
const closed = () => new PlcError('LINE_CLOSED', { line: 'mill' })

describe('line: a conversation', () => {
  it('stopped: it ends its own affairs, whatever it throws then, and all who wait hear it', async () => {
    const ended = []
    const run = create(function* () {
      try {
        yield STEP
      } finally {
        ended.push('ended')
        ended.push(JSON.parse('no JSON'))
      }
    })
    const waits = [failure(run.join({})), failure(run.join({}))]
    assert.deepEqual([run.started, run.wanted, run.advance(null), run.started], [false, true, true, true])
    run.sent = true
    assert.equal(run.stop(closed()), false)
    assert.deepEqual([ended, run.wanted], [['ended'], false])
    for (const { code, details } of await Promise.all(waits)) {
      assert.deepEqual([code, details.line, details.sent], ['LINE_CLOSED', 'mill', true])
    }
  })

  it('one who leaves hears it, the others go on', async () => {
    const run = create(function* () {
      return (yield STEP).toString()
    })
    const [one, other] = [{}, {}]
    const gone = failure(run.join(one))
    const stays = run.join(other)
    run.leave({}, closed())
    run.leave(one, closed())
    assert.equal((await gone).code, 'LINE_CLOSED')
    run.advance(null)
    assert.equal(run.advance(null, Buffer.from('a')), false)
    assert.equal(await stays, 'a')
  })

  it('a step needs bytes and, for an answer, a time', async () => {
    for (const [step, message] of /** @type {[any, string][]} */ ([
      [{ ...STEP, send: 'q' }, 'a step needs bytes to send'],
      [{ ...STEP, send: Buffer.alloc(0) }, 'a step needs bytes to send'],
      [undefined, 'a step needs bytes to send'],
      [{ ...STEP, timeout: 0 }, 'a step needs a timeout']
    ])) {
      const run = create(function* () {
        yield step
      })
      const end = failure(run.join({}))
      run.advance(null)
      assert.deepEqual([(await end).name, (await end).message], ['TypeError', message])
    }
  })

  it('failures of the line are told from those of a station', () => {
    const line = ['CLOSED', 'DOWN', 'JAMMED'].map(code => `LINE_${code}`)
    const port = ['NOT_FOUND', 'BUSY', 'DENIED', 'GONE', 'ERROR'].map(code => `PORT_${code}`)
    for (const code of [...line, ...port, 'WRITE_STALLED', 'WIRE_IN_USE', 'CONNECT_FAILED']) {
      assert.equal(isLineFailure({ code }), true, code)
    }
    for (const other of [{ code: 'TIMEOUT' }, { code: 'CRC_ERROR' }, {}, null, undefined]) {
      assert.equal(isLineFailure(other), false)
    }
  })
})
