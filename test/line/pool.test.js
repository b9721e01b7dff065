'use strict'

const assert = require('node:assert/strict')
const { createPool } = require('../../lib/line')
const { createVirtualClock } = require('../../lib/sim/clock')
const { createBench, createWire, failure } = require('./support/bench')
const toy = require('./support/toy')

const answering = (bytes, wire) => wire.reply(toy.answer(bytes[1], [bytes[1]], bytes[2]))
const thrown = fn => {
  try {
    fn()
  } catch (error) {
    return error
  }
  throw new Error('did not throw')
}

/** Serial settings over transports of the test: `{ id, closing }` by path. */
function createPorts(rows) {
  const clock = createVirtualClock()
  const log = []
  const serial = settings => {
    const row = rows[settings.path] ?? {}
    return {
      open: handlers => {
        log.push(`open ${settings.path}`)
        clock.setTimer(() => handlers.opened(), 1)
      },
      write: (_, done) => done(),
      hint: () => {},
      close: done => {
        log.push(`closing ${settings.path}`)
        if (row.stuck) return
        clock.setTimer(() => {
          log.push(`closed ${settings.path}`)
          done()
        }, row.closing ?? 1)
      },
      id: () => row.id ?? settings.path
    }
  }
  const pool = createPool({ clock, random: () => 0.5, transports: { serial } })
  const open = (path, owner = 'reader', extra = {}) => pool.open({ path, ...extra }, { id: owner, name: owner })
  return { clock, log, pool, open, run: promise => clock.run(promise) }
}

describe('line: pool', () => {
  it('shares a line by wire; the last one out closes it', async () => {
    const { pool, open, lease, wire, run } = createBench({ onQuery: answering })
    const other = open({}, 'writer')
    assert.equal(other.line, lease.line)
    assert.deepEqual(
      pool.lines().map(({ key, leases }) => [key, leases]),
      [['simulated:', 2]]
    )
    await run(Promise.all([lease, other].map(l => l.run(() => toy.ask(1), { station: 1 }))))
    assert.equal(wire.connects, 1)
    await run(lease.release())
    assert.equal(wire.open, 1)
    assert.deepEqual(await run(other.run(() => toy.ask(2), { station: 2 })), [2])
    await run(other.release())
    assert.equal(wire.open, 0)
    assert.deepEqual(pool.lines(), [])
  })

  it('release works once, and gives the same promise again', async () => {
    const { open, lease, run, clock } = createBench()
    const other = open({}, 'other')
    await clock.advance(1)
    const released = lease.release()
    assert.equal(lease.release(), released)
    await run(released)
    assert.equal(other.line.state, 'open')
    assert.equal(lease.released, true)
  })

  it('a released lease runs nothing and hears nothing', async () => {
    const { open, lease, clock, wire, run } = createBench()
    open({}, 'other')
    await clock.advance(1)
    const heard = []
    lease.on('state', state => heard.push(state))
    const kept = () => heard.push('kept')
    lease.on('state', kept).off('state', kept)
    await run(lease.release())
    lease.on('state', state => heard.push(state))
    wire.unplug()
    await clock.advance(10)
    assert.deepEqual(heard, [])
    assert.equal((await failure(lease.run(() => toy.ask(1), { station: 1 }))).code, 'LINE_CLOSED')
    assert.equal(lease.line.listenerCount('state'), 0)
  })

  it('release ends what only this lease waits for; the others go on', async () => {
    const { open, lease, clock, run } = createBench({ onQuery: answering })
    const other = open({}, 'other')
    const mine = [1, 2, 3].map(n => failure(lease.run(() => toy.ask(n), { station: n })))
    const others = [4, 5].map(n => other.run(() => toy.ask(n), { station: n }))
    await clock.advance(1)
    await lease.release()
    const errors = await Promise.all(mine)
    assert.deepEqual(
      errors.map(e => [e.code, e.details.sent]),
      [
        ['LINE_CLOSED', true],
        ['LINE_CLOSED', false],
        ['LINE_CLOSED', false]
      ]
    )
    assert.deepEqual(await run(Promise.all(others)), [[4], [5]])
  })

  it('closing rejects all, and lets a frame on the wire end', async () => {
    const { lease, clock, wire, run } = createBench({ settings: { baudRate: 300 } })
    const asked = [1, 2].map(n => failure(lease.run(() => toy.ask(n), { station: n })))
    await clock.advance(10)
    const start = clock.now()
    const released = lease.release()
    assert.equal(wire.open, 1)
    await run(released)
    assert.ok(Math.abs(clock.now() - (wire.sent[0].at + 4 * (10000 / 300))) < 0.01)
    assert.ok(clock.now() - start < 2000)
    assert.deepEqual(
      (await Promise.all(asked)).map(e => e.code),
      ['LINE_CLOSED', 'LINE_CLOSED']
    )
    assert.equal(clock.pending(), 0)
  })

  it('closing is bounded, even if the port never says that it is closed', async () => {
    const { clock, open, run } = createPorts({ '/dev/a': { stuck: true } })
    const lease = open('/dev/a')
    await clock.advance(5)
    const start = clock.now()
    await run(lease.release())
    assert.ok(clock.now() - start < 2000)
    assert.equal(clock.pending(), 0)
  })

  it('a line that is opened while the one before closes waits for it', async () => {
    const { clock, log, open, run } = createPorts({ '/dev/a': { closing: 300 } })
    const first = open('/dev/a')
    await clock.advance(5)
    first.release()
    const second = open('/dev/a', 'reader', { baudRate: 9600 })
    await clock.advance(400)
    assert.deepEqual(log, ['open /dev/a', 'closing /dev/a', 'closed /dev/a', 'open /dev/a'])
    assert.equal(second.line.state, 'open')
    await run(second.release())
  })

  it('several that come and go meanwhile leave one port open at a time', async () => {
    const { clock, log, open, run } = createPorts({ '/dev/a': { closing: 300 } })
    const leases = [open('/dev/a')]
    await clock.advance(5)
    for (let i = 0; i < 3; i++) {
      const released = leases[i].release()
      leases.push(open('/dev/a'))
      if (i === 1) await run(released)
    }
    await clock.advance(1000)
    assert.equal(leases[3].line.state, 'open')
    let openPorts = 0
    for (const row of log) {
      if (row.startsWith('open')) openPorts++
      if (row.startsWith('closed')) openPorts--
      assert.ok(openPorts <= 1, log.join(', '))
    }
    await run(leases[3].release())
    assert.equal(clock.pending(), 0)
  })

  it('two configurations of one wire with different settings: WIRE_CONFLICT names both', () => {
    const { open } = createPorts({})
    open('/dev/a', 'PLC hall 1')
    const error = thrown(() => open('/dev/a', 'PLC hall 2', { baudRate: 9600 }))
    assert.equal(error.code, 'WIRE_CONFLICT')
    assert.match(error.message, /PLC hall 2 and PLC hall 1 use \/dev\/a .*baudRate 19200 and 9600/)
    assert.doesNotThrow(() => open('/dev/a', 'PLC hall 3', { name: 'another name' }))
  })

  it('a conflict names who has the wire now, not who opened it first', async () => {
    const { clock, open, run } = createPorts({ '/dev/a': { id: '/dev/b' }, '/dev/b': {} })
    const first = open('/dev/a', 'gone')
    const second = open('/dev/a', 'PLC 2')
    await clock.advance(10)
    await run(first.release())
    assert.equal(thrown(() => open('/dev/a', 'PLC 3', { baudRate: 9600 })).details.other, 'PLC 2')
    const other = open('/dev/b', 'PLC 4')
    await clock.advance(10)
    assert.deepEqual([other.line.reason.code, other.line.reason.details.owner], ['WIRE_IN_USE', 'PLC 2'])
    await run(Promise.all([second.release(), other.release()]))
  })

  it('two wires in memory under one path are a conflict too', () => {
    const { open } = createBench()
    assert.equal(thrown(() => open({ wire: createWire(null) }, 'b')).code, 'WIRE_CONFLICT')
  })

  it('two names of one port: the second gets WIRE_IN_USE, keeps trying, and gets it in the end', async () => {
    const { clock, log, open, run } = createPorts({
      '/dev/serial/by-id/x': { id: '/dev/ttyUSB0' },
      '/dev/ttyUSB0': {}
    })
    const first = open('/dev/serial/by-id/x', 'PLC 1')
    const second = open('/dev/ttyUSB0', 'PLC 2')
    await clock.advance(10)
    assert.equal(second.line.state, 'waiting')
    assert.equal(second.line.reason.code, 'WIRE_IN_USE')
    assert.match(
      second.line.reason.message,
      /^\/dev\/ttyUSB0 is the same wire as \/dev\/serial\/by-id\/x, which PLC 1 already uses/
    )
    assert.equal((await failure(second.run(() => toy.ask(1), { station: 1 }))).code, 'WIRE_IN_USE')
    await clock.advance(20000)
    assert.equal(second.line.state, 'waiting')
    await run(first.release())
    await clock.advance(5001)
    assert.equal(second.line.state, 'open')
    assert.deepEqual(log.slice(-1), ['open /dev/ttyUSB0'])
    await run(second.release())
  })

  it('a lease that is released while its port is opened leaves nothing', async () => {
    const { clock, log, open, run } = createPorts({})
    await run(open('/dev/a').release())
    await clock.advance(1000)
    assert.equal(clock.pending(), 0)
    assert.deepEqual(log.slice(0, 2), ['open /dev/a', 'closing /dev/a'])
  })

  it('what a station’s memory holds outlives its leases', async () => {
    const { open, run } = createPorts({})
    const first = open('/dev/a')
    first.line.memory(1).lastMasterId = 0xe4
    await run(first.release())
    assert.equal(open('/dev/a').line.memory(1).lastMasterId, 0xe4)
    assert.equal(open('/dev/b').line.memory(1).lastMasterId, undefined)
  })

  it('refuses bad settings with their name', () => {
    const { pool } = createPorts({})
    assert.equal(thrown(() => pool.open({}, { id: 'a', name: 'a' })).details.setting, 'path')
    assert.deepEqual(pool.lines(), [])
  })
})
