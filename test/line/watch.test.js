'use strict'

const assert = require('node:assert/strict')
const { PlcError } = require('../../lib/error')
const { createBench, failure } = require('./support/bench')
const { collect } = require('./support/framing')
const toy = require('./support/toy')

const answering = (bytes, wire) => wire.reply(toy.answer(bytes[1], [bytes[1]], bytes[2]))
const gone = () => new PlcError('PORT_NOT_FOUND', { path: '/dev/ttyUSB0' })

/** Keeps what a watcher is told. */
const notes = () => {
  const events = []
  const states = []
  return {
    events,
    states,
    event: event => events.push(event),
    state: (state, reason) => states.push([state, reason?.code])
  }
}
const names = events => events.map(({ event }) => event)

describe('line: outages', () => {
  it('lineDown once, with code, cause and remedy apart, however often opening fails; lineUp with its length', async () => {
    const { clock, wire, lease } = createBench()
    const events = []
    lease.on('event', event => events.push(event))
    await clock.advance(10)
    assert.deepEqual(events, [])
    wire.refuse = gone()
    wire.unplug()
    await clock.advance(20000)
    const [{ since, ...down }, ...more] = events
    assert.deepEqual(down, {
      event: 'lineDown',
      station: null,
      code: 'PORT_GONE',
      cause: 'the port simulated has gone',
      remedy: 'Plug the adapter in again; it reconnects by itself.'
    })
    assert.equal(since, clock.wall() - 20000)
    assert.deepEqual(more, [])
    wire.refuse = null
    await clock.advance(6000)
    assert.deepEqual(names(events), ['lineDown', 'lineUp'])
    assert.equal(events[1].station, null)
    assert.equal(events[1].downFor, events[1].since - since)
  })

  it('a first opening that fails is an outage; its code is that of the port', async () => {
    const bench = createBench()
    bench.wire.refuse = gone()
    const events = []
    bench.lease.on('event', event => events.push(event))
    await bench.clock.advance(4000)
    assert.deepEqual(
      events.map(({ event, code, cause, remedy }) => [event, code, cause, remedy]),
      [['lineDown', 'PORT_NOT_FOUND', 'the port /dev/ttyUSB0 does not exist', gone().remedy]]
    )
  })

  it('each outage is told; a line that is closed on purpose is none', async () => {
    const { clock, wire, lease, run } = createBench()
    const events = []
    lease.on('event', event => events.push(event))
    await clock.advance(10)
    for (let n = 0; n < 3; n++) {
      wire.unplug()
      await clock.advance(10000)
    }
    assert.deepEqual(names(events), ['lineDown', 'lineUp', 'lineDown', 'lineUp', 'lineDown', 'lineUp'])
    await run(lease.release())
    assert.equal(events.length, 6)
  })

  it('a redeploy in an outage begins no new one', async () => {
    const { clock, wire, pool, lease, open, run } = createBench()
    const { events, event } = notes()
    pool.watch({ transport: 'simulated', wire }, { event })
    await clock.advance(10)
    wire.refuse = gone()
    wire.unplug()
    await clock.advance(3000)
    await run(lease.release())
    open({ baudRate: 9600 })
    await clock.advance(10000)
    assert.deepEqual(names(events), ['lineDown'])
    wire.refuse = null
    await clock.advance(10000)
    assert.deepEqual(names(events), ['lineDown', 'lineUp'])
    assert.ok(events[1].downFor > 13000, `${events[1].downFor}`)
  })

  it('a jam is none; its cause does not contain its remedy', async () => {
    const { clock, wire, lease } = createBench({ settings: { jamTime: 100 } })
    const events = []
    lease.on('event', event => events.push(event))
    await clock.advance(1)
    wire.handlers.data(Buffer.from([0xff]))
    const asked = failure(lease.run(() => toy.ask(1), { station: 1 }))
    for (let n = 0; n < 200; n++) {
      await clock.advance(1)
      wire.handlers.data(Buffer.from([0xff]))
    }
    assert.equal((await asked).code, 'LINE_JAMMED')
    assert.deepEqual(names(events), ['jammed'])
    assert.ok(!events[0].cause.includes(events[0].remedy), events[0].cause)
    assert.ok(events[0].remedy.length > 10)
  })
})

describe('line: watching a wire', () => {
  it('before it has a line, without opening it, over redeploys, until stopped', async () => {
    const { clock, wire, pool, lease, open, run } = createBench()
    await clock.advance(1)
    await run(lease.release())
    const { states, state } = notes()
    const stop = pool.watch({ transport: 'simulated', wire }, { state })
    await clock.advance(1000)
    assert.deepEqual(states, [['closed', undefined]])
    assert.deepEqual(pool.lines(), [])
    const first = open()
    await clock.advance(10)
    const second = open({}, 'other')
    await run(first.release())
    await run(second.release())
    await run(open().release())
    assert.deepEqual(
      states.map(([name]) => name),
      ['closed', 'opening', 'open', 'closed', 'opening', 'closed']
    )
    stop()
    stop()
    open()
    await clock.advance(10)
    assert.equal(states.length, 6)
    assert.equal(pool.lines()[0].leases, 1)
  })

  it('a line that takes the place of one that is still closing: its state counts, the events of both are told', async () => {
    const { clock, wire, pool, lease, open } = createBench({ onQuery: () => {}, settings: { baudRate: 300 } })
    const { states, state, events, event } = notes()
    await clock.advance(1)
    pool.watch({ transport: 'simulated', wire }, { state, event })
    // closing waits for a frame that is being sent
    lease.run(() => toy.ask(1), { station: 1 }).catch(() => {})
    await clock.advance(1)
    const before = lease.line
    lease.release()
    open({ baudRate: 300 })
    before.report({ event: 'late', station: 1, cause: '', remedy: '' })
    await clock.advance(3000)
    assert.deepEqual(
      states.map(([name]) => name),
      ['open', 'opening', 'open']
    )
    assert.deepEqual(names(events), ['late'])
    assert.equal(before.listenerCount('event'), 0)
    assert.equal(before.listenerCount('state'), 0)
  })

  it('other wires are not heard; two watchers hear the same', async () => {
    const { clock, wire, pool } = createBench()
    const one = notes()
    const two = notes()
    const other = notes()
    pool.watch({ transport: 'simulated', wire }, one)
    const stop = pool.watch({ transport: 'simulated', wire }, two)
    pool.watch({ transport: 'tcp', host: 'localhost', port: 4001 }, other)
    await clock.advance(1)
    wire.unplug()
    await clock.advance(1)
    stop()
    await clock.advance(5000)
    assert.deepEqual(names(one.events), ['lineDown', 'lineUp'])
    assert.deepEqual(names(two.events), ['lineDown'])
    assert.deepEqual([other.events, other.states], [[], [['closed', undefined]]])
  })

  it('ending one twice does not end another that came meanwhile', async () => {
    const { clock, pool, wire, lease, open, run } = createBench()
    await run(lease.release())
    const first = pool.watch({ transport: 'simulated', wire }, {})
    first()
    const { states, state } = notes()
    pool.watch({ transport: 'simulated', wire }, { state })
    first()
    open()
    await clock.advance(1)
    assert.deepEqual(states.at(-1), ['open', undefined])
  })

  it('a watcher that throws is a warning; the line and the other watchers go on', async () => {
    const { clock, wire, pool, lease, run } = createBench({ onQuery: answering })
    const warnings = []
    const warned = warning => warnings.push(warning.message)
    process.on('warning', warned)
    const fail = () => {
      throw new Error('mistake')
    }
    const failOtherwise = () => {
      throw 'no error' // eslint-disable-line no-throw-literal
    }
    pool.watch({ transport: 'simulated', wire }, { state: fail, event: fail, frame: failOtherwise })
    const { events, event } = notes()
    pool.watch({ transport: 'simulated', wire }, { event })
    await clock.advance(1)
    assert.deepEqual(await run(lease.run(() => toy.ask(3), { station: 3 })), [3])
    wire.unplug()
    await clock.advance(5000)
    assert.deepEqual(names(events), ['lineDown', 'lineUp'])
    // each of its functions is said once
    assert.deepEqual(
      warnings.sort(),
      ['mistake', 'mistake', 'no error'].map(text => `a watcher of a line failed: ${text}`)
    )
    process.off('warning', warned)
  })

  it('settings that lead to no wire are refused', () => {
    const { pool } = createBench()
    assert.throws(() => pool.watch({ transport: 'serial' }, {}), { code: 'BAD_SETTING' })
    assert.throws(() => pool.monitor({ transport: 'serial' }), { code: 'BAD_SETTING' })
  })
})

describe('line: frames for a watcher', () => {
  const watched = async options => {
    const bench = createBench(options)
    const rows = []
    const stop = bench.pool.watch({ transport: 'simulated', wire: bench.wire }, { frame: row => rows.push(row) })
    await bench.clock.advance(1)
    return { ...bench, rows, stop }
  }

  it('each as it comes: time, direction, station, bytes in hex, note', async () => {
    const { lease, run, rows, clock } = await watched({ onQuery: answering })
    await run(lease.run(() => toy.ask(7), { station: 7, label: 'ask' }))
    assert.deepEqual(
      rows.map(({ t, ...row }) => [t <= clock.wall(), row]),
      [
        [true, { dir: 'out', station: 7, bytes: '510700' + '58', note: 'ask' }],
        [true, { dir: 'in', station: 7, bytes: '41070001' + '07' + '50', note: '' }]
      ]
    )
    assert.deepEqual(rows, lease.line.trace())
  })

  it('noise is one row a burst, told when it is over, or after 200 ms', async () => {
    const { wire, lease, run, rows, clock, stop } = await watched({ onQuery: answering })
    for (let n = 0; n < 5; n++) {
      wire.handlers.data(Buffer.from([0x80 + n]))
      await clock.advance(10)
    }
    assert.deepEqual(rows, [])
    await run(lease.run(() => toy.ask(1), { station: 1 }))
    assert.deepEqual(
      rows.map(({ bytes, note }) => `${note} ${bytes}`),
      ['stray 8081828384', ' 51010052', ' 4101000101' + '44']
    )
    wire.handlers.data(Buffer.from([0x99]))
    await clock.advance(199)
    assert.equal(rows.length, 3)
    await clock.advance(2)
    assert.equal(rows[3].bytes, '99')
    await clock.advance(200)
    wire.handlers.data(Buffer.from([0x9a]))
    stop()
    await clock.advance(1000)
    assert.equal(rows.length, 4)
  })

  it('of a listening line as well; none after the end', async () => {
    const { wire, lease, rows, stop, clock } = await watched()
    collect(lease)
    wire.handlers.data(Buffer.from('A;B'))
    await clock.advance(10)
    assert.deepEqual(
      rows.map(({ dir, station, bytes }) => [dir, station, bytes]),
      [['in', null, '41']]
    )
    wire.handlers.data(Buffer.from(';'))
    stop()
    wire.handlers.data(Buffer.from('C;'))
    await clock.advance(1000)
    assert.equal(rows.length, 2)
    assert.equal(clock.pending(), 0)
  })
})

describe('line: monitor', () => {
  it('statistics of a wire that nobody uses: all counters, 0', async () => {
    const { clock, pool, lease, wire, run } = createBench()
    await clock.advance(1)
    const known = Object.keys(lease.line.stats())
    await run(lease.release())
    const monitor = pool.monitor({ transport: 'simulated', wire, name: 'W' })
    const { line, state, reason, echo, timestamp, stations, demoted, busyPercent, period, ...more } =
      monitor.statistics()
    const { predicted, evidence, ...counts } = more
    assert.deepEqual(predicted, { busyPercent: 0, percent: 0, asksMost: '' })
    assert.deepEqual([line, state, reason, echo, timestamp], ['W', 'closed', null, 'unknown', clock.wall()])
    assert.deepEqual([stations, demoted, busyPercent, period, evidence.file], [{}, [], 0, 0, null])
    assert.deepEqual(Object.keys(counts).sort(), known.filter(name => name !== 'stations').sort())
    assert.ok(Object.values(counts).every(value => value === 0))
    monitor.stop()
  })

  it('in intervals: counters, stations, percent busy since the last one', async () => {
    const { clock, pool, lease, wire } = createBench({ onQuery: answering })
    const told = []
    const monitor = pool.monitor(
      { transport: 'simulated', wire },
      { interval: 1000, statistics: all => told.push(all) }
    )
    await clock.advance(500)
    await clock.run(lease.run(() => toy.ask(4), { station: 4 }))
    await clock.advance(501 - (clock.now() - 500))
    assert.equal(told.length, 1)
    const { busy } = lease.line.stats()
    // 4 bytes out, 5 ms, the answer comes all at once
    assert.ok(busy > 7 && busy < 12, `${busy}`)
    assert.deepEqual([told[0].queries, told[0].answers, told[0].stations[4].answers], [1, 1, 1])
    assert.deepEqual([told[0].busyPercent, told[0].period, told[0].state], [Math.round(busy) / 10, 1000, 'open'])
    await clock.advance(2000)
    assert.deepEqual(
      told.map(({ busyPercent }) => busyPercent > 0),
      [true, false, false]
    )
    monitor.stop()
    monitor.stop()
    await clock.advance(5000)
    assert.equal(told.length, 3)
  })

  it('frames; and nothing of it is needed', async () => {
    const { clock, pool, lease, wire } = createBench({ onQuery: answering })
    const rows = []
    const monitors = [{ frame: row => rows.push(row) }, { interval: 100 }, undefined].map(options =>
      pool.monitor({ transport: 'simulated', wire }, options)
    )
    await clock.run(lease.run(() => toy.ask(4), { station: 4 }))
    await clock.advance(300)
    assert.deepEqual(rows, lease.line.trace())
    assert.ok(monitors.every(monitor => monitor.statistics().answers === 1))
    for (const monitor of monitors) monitor.stop()
    assert.equal(clock.pending(), 0)
  })

  it('percent busy counts from the monitor on, and anew with each line', async () => {
    const { clock, pool, lease, open, wire, run } = createBench({ onQuery: answering })
    const ask = one => run(one.run(() => toy.ask(4), { station: 4 }))
    await ask(lease)
    await clock.advance(100)
    const monitor = pool.monitor({ transport: 'simulated', wire })
    await clock.advance(100)
    assert.equal(monitor.statistics().busyPercent, 0)
    await ask(lease)
    await run(lease.release())
    const next = open()
    await ask(next)
    const { busyPercent, queries } = monitor.statistics()
    assert.ok(busyPercent > 0 && busyPercent <= 100, `${busyPercent}`)
    assert.equal(queries, 1)
    monitor.stop()
  })

  it('percent busy goes on over an outage of the line; a line that has closed is not busy', async () => {
    const { clock, pool, lease, wire, run } = createBench({ onQuery: answering })
    const monitor = pool.monitor({ transport: 'simulated', wire })
    await clock.advance(10)
    monitor.statistics()
    const from = clock.now()
    await run(lease.run(() => toy.ask(4), { station: 4 }))
    wire.unplug()
    await clock.advance(500)
    const { state, busyPercent } = monitor.statistics()
    const percent = (100 * lease.line.stats().busy) / (clock.now() - from)
    assert.equal(state, 'open')
    assert.ok(percent > 1 && Math.abs(busyPercent - percent) <= 0.05, `${busyPercent}, not ${percent}`)
    await run(lease.release())
    const closed = monitor.statistics()
    assert.deepEqual([closed.state, closed.queries, closed.busyPercent], ['closed', 0, 0])
    monitor.stop()
  })

  it('the reason of a line that is down: code, cause, remedy', async () => {
    const { clock, pool, wire } = createBench()
    wire.refuse = gone()
    const how = []
    const monitor = pool.monitor({ transport: 'simulated', wire }, { condition: now => how.push(now) })
    await clock.advance(1000)
    const { code, remedy } = gone()
    assert.deepEqual(monitor.statistics().reason, { code, cause: 'the port /dev/ttyUSB0 does not exist', remedy })
    assert.deepEqual(
      how.map(({ state, reason, demoted }) => [state, reason?.code, demoted]),
      [
        ['opening', undefined, 0],
        ['waiting', code, 0]
      ]
    )
    monitor.stop()
  })

  it('demoted stations: counted as soon as a device tells it', async () => {
    const { clock, pool, wire, lease, run } = createBench({ onQuery: answering })
    const how = []
    const events = []
    const told = { condition: ({ demoted }) => how.push(demoted), event: ({ event }) => events.push(event) }
    const monitor = pool.monitor({ transport: 'simulated', wire }, told)
    await clock.advance(1)
    await run(lease.run(() => toy.ask(1), { station: 1 }))
    lease.line.memory(1).health = { state: 'demoted', since: 5 }
    lease.line.report({ event: 'stationDemoted', station: 1, code: 'TIMEOUT' })
    assert.deepEqual(monitor.statistics().demoted, ['1'])
    lease.line.memory(1).health = { state: 'online', since: 6 }
    lease.line.report({ event: 'stationBack', station: 1 })
    assert.deepEqual(how, [0, 0, 1, 0])
    assert.deepEqual(events, ['stationDemoted', 'stationBack'])
    assert.deepEqual(monitor.statistics().demoted, [])
    monitor.stop()
  })
})
