'use strict'

const assert = require('node:assert/strict')
const {
  createPool,
  nxNotation,
  openC24Port,
  openChinoRegulator,
  openInconLink,
  openNxPlc,
  parseItem
} = require('../../lib')
const { Grid } = require('../../lib/device/phases')
const { Poller } = require('../../lib/device/poller')
const { Subscription } = require('../../lib/device/subscription')
const { createNxLine, createVirtualClock } = require('../../lib/sim')

const STOP = new Error('far enough')

describe('a device on a line of its own', () => {
  /** What a pool is asked for. */
  const asked = (open, options) => {
    let got
    const pool = {
      open: (settings, owner) => {
        got = { settings, owner }
        throw STOP
      }
    }
    assert.throws(() => open({ pool, ...options }), STOP)
    return got
  }

  for (const [name, open, options, called] of /** @type {[string, any, any, string][]} */ ([
    ['NX PLC', openNxPlc, { station: 3 }, 'station 3'],
    ['regulator', openChinoRegulator, { station: 3 }, 'station 3'],
    ['C24 port', openC24Port, {}, 'C24'],
    ['INCON link', openInconLink, {}, 'INCON']
  ])) {
    it(`${name}: over TCP with a host, else a serial port; the line is called by its path`, () => {
      const transport = more => asked(open, { ...options, ...more }).settings.transport
      assert.equal(transport({ path: '/dev/ttyUSB0' }), 'serial')
      assert.equal(transport({ host: 'server', port: 4001 }), 'tcp')
      assert.equal(transport({ host: 'server', transport: 'simulated' }), 'simulated')
      const plain = asked(open, { ...options, path: 'p' })
      assert.deepEqual([plain.settings.name, plain.owner.name], ['', called])
      assert.equal(asked(open, { ...options, path: 'p', name: 'press' }).owner.name, 'press')
    })
  }
})

describe('what a connection of its own writes', () => {
  it('pairs, or entries in their order', async () => {
    const clock = createVirtualClock()
    const { wire, plcs } = createNxLine({ clock, baudRate: 38400, quiet: true, stations: [{ station: 1 }] })
    const pool = createPool({ clock, random: () => 0.5 })
    const settings = { transport: 'simulated', path: 'sim', wire, baudRate: 38400, echo: 'off', pool, clock }
    const plc = openNxPlc({ ...settings, station: 1, access: 'write' })
    const done = []
    for (const values of [
      { K0: 5, K1: 6 },
      [
        { item: 'K1', value: 7 },
        { item: 'K1', value: 8 }
      ]
    ])
      done.push((await clock.run(plc.write(values))).outcome)
    const [result] = await clock.run(plc.read('K0..K1'))
    assert.deepEqual(
      [done, result.value],
      [
        ['confirmed', 'confirmed'],
        [5, 8]
      ]
    )
    assert.equal(plcs.length, 1)
    await clock.run(plc.close())
  })
})

describe('polling that ends while it reads', () => {
  const create = () => {
    const clock = createVirtualClock()
    const reads = []
    const told = []
    const poller = new Poller({
      clock,
      random: () => 0,
      grid: new Grid(/** @type {any} */ ({}), 1),
      read: () => new Promise((resolve, reject) => reads.push({ resolve, reject })),
      estimate: () => 1,
      overrun: () => {}
    })
    const items = [parseItem('M0', nxNotation({ areas: [] }))]
    const callback = (results, cycle) => told.push([results.length, cycle.failure?.code ?? null, cycle.changed])
    const subscription = new Subscription({ clock, items, interval: 100, callback })
    subscription.repeat = own => poller.now([own])
    poller.add(subscription, { immediately: true })
    const again = () => poller.now([subscription].filter(each => each.again()))
    const stop = () => {
      subscription.stopped = true
      poller.remove(subscription)
    }
    return { clock, reads, told, again, stop }
  }
  const settle = async clock => clock.advance(1)

  it('nothing is told after it was stopped, nor asked again', async () => {
    const { clock, reads, told, again, stop } = create()
    await settle(clock)
    stop()
    again()
    reads[0].resolve([{ raw: [1], at: 0 }])
    await clock.advance(1000)
    assert.deepEqual([told, reads.length, clock.pending()], [[], 1, 0])
  })

  it('a read that is rejected is a cycle without values, told by its code, as a change once', async () => {
    const { clock, reads, told, again, stop } = create()
    const fault = Object.assign(new Error('closed'), { code: 'LINE_CLOSED' })
    await settle(clock)
    reads[0].reject(fault)
    await clock.advance(100)
    reads[1].reject(fault)
    await settle(clock)
    assert.deepEqual(told, [
      [0, 'LINE_CLOSED', true],
      [0, 'LINE_CLOSED', false]
    ])
    again()
    assert.equal(reads.length, 3, 'at once, since the last one failed')
    again()
    reads[2].reject(fault)
    await settle(clock)
    assert.equal(reads.length, 4, 'once more, since it was said while it ran')
    reads[3].resolve([{ raw: [1], at: 0 }])
    await settle(clock)
    again()
    assert.equal(reads.length, 4)
    stop()
  })

  it('a stop inside the callback ends it, also where it would be asked again', async () => {
    const { clock, reads, again, stop } = create()
    await settle(clock)
    again()
    reads[0].reject(new Error('x'))
    stop()
    await clock.advance(500)
    assert.equal(reads.length, 1)
  })
})
