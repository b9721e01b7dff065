'use strict'

const assert = require('node:assert/strict')
const { PRIORITY } = require('../../lib/line')
const { CHARACTER, createBench, failure } = require('./support/bench')
const toy = require('./support/toy')

const answering =
  (data = [7]) =>
  (bytes, wire) =>
    wire.reply(toy.answer(bytes[1], data, bytes[2]))

const near = (got, wanted, name) => assert.ok(Math.abs(got - wanted) < 0.01, `${name}: ${got}, wanted ${wanted}`)

describe('line: one exchange', () => {
  it('gives the data of the answer', async () => {
    const { lease, run } = createBench({ onQuery: answering([1, 2, 3]) })
    assert.deepEqual(await run(lease.run(() => toy.ask(5), { station: 5 })), [1, 2, 3])
    await run(lease.release())
  })

  it('takes an answer that comes in single bytes', async () => {
    const { lease, run } = createBench({
      onQuery: (bytes, wire) =>
        [...toy.answer(5, [1, 2])].forEach((b, i) => wire.reply(Buffer.from([b]), { after: 5 + i }))
    })
    assert.deepEqual(await run(lease.run(() => toy.ask(5), { station: 5 })), [1, 2])
    await run(lease.release())
  })

  it('times out from the computed end of sending', async () => {
    const { clock, lease, run, wire } = createBench()
    const error = await run(failure(lease.run(() => toy.ask(5, { timeout: 200 }), { station: 5 })))
    assert.equal(error.code, 'TIMEOUT')
    near(clock.now() - wire.sent[0].at, 4 * CHARACTER + 200, 'time until the error')
    await run(lease.release())
  })

  it('keeps the gap after the last byte', async () => {
    const { lease, run, wire } = createBench({ onQuery: answering() })
    await run(Promise.all([1, 2].map(n => lease.run(() => toy.ask(n), { station: n, priority: PRIORITY.POLL }))))
    near(wire.sent[1].at - wire.sent[0].at, 4 * CHARACTER + 5 + 3.5 * CHARACTER, 'from query to query')
    await run(lease.release())
  })
})
