'use strict'

const assert = require('node:assert/strict')
const { PlcError } = require('../../lib/error')
const { Connection } = require('../../lib/line/connection')
const { createVirtualClock } = require('../../lib/sim/clock')

const noClaims = /** @type {any} */ ({ take() {}, release() {} })

/** A connection over transports of the test; `closes: false`: their close is told by the test. */
const create = ({ closes = true, random = () => 0.5, claims = noClaims } = {}) => {
  const clock = createVirtualClock()
  const told = []
  const made = []
  const make = () => {
    const transport = {
      at: clock.now(),
      id: () => `t${made.length}`,
      open: handlers => void (transport.handlers = handlers),
      write: (bytes, done) => done(),
      close: done => {
        transport.closed = done
        if (closes) done()
      },
      hint: (...args) => told.push(['hint', ...args])
    }
    made.push(transport)
    return transport
  }
  const connection = new Connection({
    name: 'L',
    clock,
    make,
    random,
    claims,
    told: {
      opened: () => told.push('opened'),
      data: bytes => told.push(`${bytes}`),
      down: (error, wasOpen) => told.push([error?.code, wasOpen])
    }
  })
  return { clock, told, made, connection }
}
const gone = new PlcError('PORT_GONE', { path: 'p' })

describe('line: one connection after the other', () => {
  it('before it is open nothing is written, hinted or asked', () => {
    const { connection } = create()
    const ends = []
    connection.write(Buffer.from('A'), error => ends.push([error.code, error.details]))
    assert.deepEqual(ends, [['LINE_DOWN', { line: 'L', reason: 'the port is not open' }]])
    connection.hint(1, 2)
    connection.check({ all: 1, known: 1 })
    assert.equal(connection.waiting, false)
    connection.restart(gone)
    let stopped = 0
    connection.stop(() => stopped++)
    assert.equal(stopped, 1)
  })

  it('claims what it opens, and gives it free when it is lost', () => {
    const log = []
    const claims = { take: id => void log.push(`take ${id}`), release: id => void log.push(`release ${id}`) }
    const { connection, made } = create({ claims })
    assert.equal(connection.id, undefined)
    connection.start()
    made[0].handlers.opened()
    assert.deepEqual([connection.id, log], ['t1', ['take t1']])
    made[0].handlers.closed(gone)
    assert.deepEqual([connection.id, log], [undefined, ['take t1', 'release t1']])
    connection.stop(() => log.push('stopped'))
    assert.deepEqual(log.slice(2), ['stopped'])
  })

  it('a claim that is refused is a failed attempt; nothing is given free', () => {
    const log = []
    const claims = {
      take() {
        throw gone
      },
      release: id => log.push(id)
    }
    const { connection, told } = create({ claims })
    connection.start()
    assert.deepEqual([told, log, connection.id], [[['PORT_GONE', false]], [], undefined])
    connection.stop(() => {})
  })

  it('while it is closed to be opened anew nothing is written', () => {
    const { connection, made } = create({ closes: false })
    connection.start()
    made[0].handlers.opened()
    connection.restart(gone)
    const ends = []
    connection.write(Buffer.from('A'), error => ends.push(error?.code))
    assert.deepEqual([connection.isOpen, ends], [false, ['LINE_DOWN']])
  })

  it('a transport that tells twice that it has closed does not end the close of the next one', () => {
    const { connection, made } = create({ closes: false })
    const ends = []
    for (const name of ['first', 'second']) {
      connection.start()
      made.at(-1).handlers.opened()
      connection.stop(() => ends.push(name))
      made[0].closed()
    }
    assert.deepEqual(ends, ['first'])
    made[1].closed()
    assert.deepEqual(ends, ['first', 'second'])
  })

  it('a transport that tells nothing of waiting bytes, and cannot be asked', () => {
    const { connection, made, told } = create()
    connection.start()
    made[0].handlers.opened()
    assert.equal(connection.waiting, false)
    connection.check({ all: 1, known: 1 })
    connection.hint(3, 9, true)
    assert.deepEqual(told, ['opened', ['hint', 3, 9, true]])
    made[0].waiting = true
    made[0].check = missing => told.push(missing)
    connection.check(7)
    assert.deepEqual([connection.waiting, told.at(-1)], [true, 7])
  })

  it('a write that fails in the call', () => {
    const { connection, made } = create()
    connection.start()
    made[0].handlers.opened()
    for (const [thrown, reason] of [
      [new Error('EBADF'), 'EBADF'],
      ['text', 'text'],
      [undefined, 'undefined']
    ]) {
      made[0].write = () => {
        throw thrown
      }
      let error
      connection.write(Buffer.from('A'), failed => (error = failed))
      assert.deepEqual([error.code, error.details.path, error.details.reason], ['PORT_ERROR', 'L', reason])
      assert.equal(error.cause, thrown)
    }
  })

  it('what a transport that was given up still says is not heard', async () => {
    const { connection, made, told, clock } = create()
    connection.start()
    const [first] = made
    first.handlers.opened()
    first.handlers.closed(gone)
    await clock.advance(1000)
    first.handlers.opened()
    first.handlers.data(Buffer.from('late'))
    first.handlers.closed(gone)
    first.handlers.failed(gone)
    assert.equal(made.length, 2)
    assert.deepEqual(told, ['opened', ['PORT_GONE', true]])
  })

  it('the delays: 250 ms, doubled to 5 s, with jitter; for a port that is not there to 1 s', async () => {
    const delays = async (code, random) => {
      const { connection, made, clock } = create({ random })
      connection.start()
      const got = []
      for (let n = 0; n < 8; n++) {
        const from = clock.now()
        made.at(-1).handlers.failed(new PlcError(code, { path: 'p' }))
        await clock.advance(6000)
        got.push(Math.round(made.at(-1).at - from))
      }
      connection.stop(() => {})
      return got
    }
    assert.deepEqual(await delays('PORT_BUSY', () => 0.5), [250, 500, 1000, 2000, 4000, 5000, 5000, 5000])
    assert.deepEqual(await delays('PORT_BUSY', () => 0), [188, 375, 750, 1500, 3000, 3750, 3750, 3750])
    assert.deepEqual(await delays('PORT_BUSY', () => 1), [313, 625, 1250, 2500, 5000, 5000, 5000, 5000])
    for (const code of ['PORT_NOT_FOUND', 'PORT_DENIED'])
      assert.deepEqual(await delays(code, () => 0.5), [250, 500, 1000, 1000, 1000, 1000, 1000, 1000])
  })

  it('after a connection that lived for five seconds, or was answered, the next attempt comes soon', async () => {
    for (const [lived, proven, delay] of [
      [4999, false, 1000],
      [5000, false, 250],
      [10, true, 250]
    ]) {
      const { connection, made, clock } = create()
      connection.start()
      for (let n = 0; n < 2; n++) {
        made.at(-1).handlers.failed(gone)
        await clock.advance(250 * 2 ** n)
      }
      made.at(-1).handlers.opened()
      await clock.advance(lived)
      if (proven) connection.proven()
      const count = made.length
      made.at(-1).handlers.closed(gone)
      await clock.advance(delay - 1)
      assert.equal(made.length, count, `${lived} ${proven}`)
      await clock.advance(1)
      assert.equal(made.length, count + 1, `${lived} ${proven}`)
    }
  })

  it('a restart waits for the close, 800 ms at most; who stops meanwhile waits with it, and once is enough', async () => {
    for (const says of [true, false]) {
      const { connection, made, told, clock } = create({ closes: false })
      connection.start()
      made[0].handlers.opened()
      connection.restart(gone)
      connection.restart(gone)
      assert.deepEqual([connection.isOpen, told], [false, ['opened']])
      const ends = []
      connection.stop(() => ends.push('one'))
      connection.stop(() => ends.push('two'))
      assert.deepEqual(ends, [])
      if (says) {
        made[0].closed()
        made[0].closed()
      } else {
        await clock.advance(799)
        assert.deepEqual(ends, [])
        await clock.advance(1)
        made[0].closed()
      }
      assert.deepEqual(ends, ['one', 'two'])
      assert.deepEqual(told, ['opened', ['PORT_GONE', true]])
      assert.equal(clock.pending(), 0)
      assert.equal(made.length, 1)
    }
  })

  it('a maker that throws is a failed attempt', async () => {
    const { connection, made, told, clock } = create()
    const { push } = made
    made.push = () => {
      throw gone
    }
    connection.start()
    assert.deepEqual(told, [['PORT_GONE', false]])
    made.push = push
    await clock.advance(250)
    assert.equal(made.length, 1)
    connection.stop(() => {})
  })
})
