'use strict'
const assert = require('node:assert/strict')
const { EventEmitter } = require('node:events')
const { createPool } = require('../../lib')
const { createInconController, createVirtualClock, createWire } = require('../../lib/sim')
const { listenerHolder } = require('../../nodes/listeners')

/** incon-link as a node, with what its dialog sets by default, on a line in virtual time; beside it as many controllers as there are scan times and phases. */

const SCANS = 100

/** The runtime, as far as the node needs it. */
const runtime = line => {
  const events = new EventEmitter()
  /** @type {any} */
  let type
  const RED = {
    events,
    _: key => key,
    nodes: {
      createNode: (node, config) => {
        const emitter = new EventEmitter()
        Object.assign(node, { id: config.id, name: config.name, status() {}, send() {}, error() {} })
        node.on = (event, fn) => emitter.on(event, fn)
        node.emit = (event, ...args) => emitter.emit(event, ...args)
      },
      getNode: id => (id === line.id ? line : null),
      registerType: (_name, constructor) => (type = constructor)
    }
  }
  require('../../nodes/incon-link')(RED)
  line.listeners = listenerHolder(line, events)
  return { events, open: config => new type(config) }
}

const lineOn = (clock, wire) => {
  const pool = createPool({ clock, random: () => 0.5 })
  const settings = { transport: 'simulated', path: 'sim', wire, baudRate: 9600, name: 'L' }
  const lease = owner => pool.open(settings, owner)
  return { id: 'line', type: 'plc-line', name: 'L', users: {}, fault: null, plcs: { members: () => [] }, lease }
}

describe('incon-link with its defaults', () => {
  it('two lines sent at once are two messages for the PLC at each scan time from 1 to 100 ms, at any phase', async () => {
    const clock = createVirtualClock()
    const wire = createWire({ clock, baudRate: 9600 })
    const controllers = []
    for (const restart of ['always', 'once']) {
      for (let scan = 1; scan <= SCANS; scan++) {
        for (let phase = 0; phase < scan; phase++) {
          controllers.push(createInconController({ clock, scan, phase, restart, keep: 3 }))
        }
      }
    }
    controllers.forEach(wire.add)
    const line = lineOn(clock, wire)
    const { events, open } = runtime(line)
    const node = open({ id: 'n', name: 'machine', line: 'line', access: 'write' })
    events.emit('flows:started')
    const sent = ['O1234', 'START'].map(
      payload =>
        new Promise((resolve, reject) =>
          node.emit(
            'input',
            { payload },
            ([, msg]) => resolve(msg.write.outcome),
            error => error && reject(error)
          )
        )
    )
    assert.deepEqual(await clock.run(Promise.all(sent)), ['sent', 'sent'])
    await clock.advance(2 * SCANS + 10)
    const odd = controllers.filter(({ messages }) => messages.map(({ text }) => text).join() !== 'O1234,START')
    assert.deepEqual([controllers.length, odd.length], [SCANS * (SCANS + 1), 0])
    await clock.run(new Promise(resolve => node.emit('close', false, () => resolve(undefined))))
    await clock.run(line.listeners.close())
  })
})
