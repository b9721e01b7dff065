'use strict'

const assert = require('node:assert/strict')
const fs = require('node:fs')
const path = require('node:path')
const { createPool } = require('../../lib/line')
const { serial } = require('../../lib/line/transports/serial')
const { createPty } = require('../../lib/sim/pty')
const { createBench } = require('./support/bench')
const { fastClock, openFiles, reached, tempFolder } = require('./support/real')
const toy = require('./support/toy')

const resources = () => process.getActiveResourcesInfo().sort().join(' ')
/** Objects that a garbage collection leaves, of those that are only held weakly here. @param {WeakRef<any>[]} refs */
const leftOf = async refs => {
  require('node:v8').setFlagsFromString('--expose-gc')
  const collect = require('node:vm').runInNewContext('gc')
  const left = () => refs.filter(ref => ref.deref() !== undefined).length
  for (let i = 0; i < 20 && left() > 0; i++) {
    await turn()
    collect()
  }
  return left()
}

const turn = () => new Promise(resolve => setImmediate(resolve))

/** Waits (some turns of the loop) until what the process holds is as before. */
const settledTo = async before => {
  for (let i = 0; i < 200 && resources() !== before; i++) await turn()
  return resources()
}

describe('line: a thousand redeploys and reconnects leave nothing behind', () => {
  it('in memory: no timer, no listener, no claim, no open wire', async () => {
    const { clock, wire, pool, open, lease, run } = createBench({
      onQuery: (bytes, w) => w.reply(toy.answer(bytes[1], [1]))
    })
    await run(lease.release())
    for (let n = 0; n < 1000; n++) {
      const leases = [open({}, 'a'), open({}, 'b')]
      const { line } = leases[0]
      leases[0].on('state', () => {})
      leases[1].on('event', () => {})
      const asked = leases.map(l => l.run(() => toy.ask(n % 7, { timeout: 50 }), { station: n % 7, deadline: 500 }))
      const settled = Promise.allSettled(asked)
      await clock.advance((n * 37) % 900)
      if (n % 3 === 0 && wire.open > 0) wire.unplug()
      if (n % 6 === 0) await clock.advance(400)
      await run(Promise.all(leases.map(l => l.release())))
      await settled
      assert.deepEqual([line.listenerCount('state'), line.listenerCount('event')], [0, 0])
      assert.equal(clock.pending(), 0, `cycle ${n}`)
    }
    assert.equal(wire.open, 0)
    assert.deepEqual(pool.lines(), [])
  })

  const supported = process.platform === 'linux'
  ;(supported ? it : it.skip)('on a pty: no descriptor, no handle; the port is free each time', async () => {
    const folder = tempFolder()
    const link = path.join(folder, 'port')
    const pty = createPty({ link })
    pty.onData(bytes => pty.write(toy.answer(bytes[1], [1], bytes[2])))
    const clock = fastClock(10)
    const pool = createPool({ clock, random: () => 0.5 })
    /** @type {WeakRef<any>[]} */
    const lines = []
    const cycle = async n => {
      const lease = pool.open({ path: link, baudRate: 115200, slack: 2000, latenessBound: 1 }, { id: 'a', name: 'a' })
      await reached(lease, 'open')
      lines.push(new WeakRef(lease.line))
      const asked = lease.run(() => toy.ask(1, { timeout: 5000 }), { station: n })
      // some in the middle of an exchange
      if (n % 2 === 0) await asked
      await Promise.all([lease.release(), asked.catch(error => assert.equal(error.code, 'LINE_CLOSED'))])
    }
    for (let n = 0; n < 10; n++) await cycle(n)
    await turn()
    const [files, handles] = [openFiles(), resources()]
    for (let n = 10; n < 1010; n++) await cycle(n)
    assert.equal(await settledTo(handles), handles)
    assert.equal(openFiles(), files)
    assert.equal(clock.pending(), 0)
    // the poller of bindings-cpp lives as long as the process: whoever it knows would, too
    assert.equal(await leftOf(lines), 0)
    pty.close()
    fs.rmSync(folder, { recursive: true })
  })

  ;(supported ? it : it.skip)('unplugged and replugged 50 times under one lease', async () => {
    const folder = tempFolder()
    const link = path.join(folder, 'port')
    const pty = createPty({ link })
    pty.onData(bytes => pty.write(toy.answer(bytes[1], [1], bytes[2])))
    /** @type {WeakRef<any>[]} */
    const made = []
    const noted = (...given) => {
      const transport = serial(.../** @type {[any, any]} */ (given))
      made.push(new WeakRef(transport))
      return transport
    }
    // no faster: a busy machine takes its time to take the bytes
    const pool = createPool({ clock: fastClock(15), random: () => 0, transports: { serial: noted } })
    const lease = pool.open({ path: link, baudRate: 115200, slack: 5000, latenessBound: 1 }, { id: 'a', name: 'a' })
    let files, handles
    for (let n = 0; n < 50; n++) {
      await reached(lease, 'open')
      assert.deepEqual(await lease.run(() => toy.ask(1, { timeout: 50000 }), { station: n }), [1])
      if (n === 5) [files, handles] = [openFiles(), resources()]
      const gone = reached(lease, 'waiting')
      pty.unplug()
      await gone
      pty.replug()
    }
    await reached(lease, 'open')
    assert.equal(openFiles(), files)
    await settledTo(handles)
    assert.equal(lease.line.stats().reconnects, 50)
    // the one before may be known by the error that it ended with
    assert.equal(await leftOf(made.slice(0, -2)), 0)
    await lease.release()
    pty.close()
    fs.rmSync(folder, { recursive: true })
  })
})
