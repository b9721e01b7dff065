'use strict'

const assert = require('node:assert/strict')
const os = require('node:os')
const { lineSettings } = require('../../../lib/line')
const { serialOver } = require('../../../lib/line/transports/serial')
const { createVirtualClock } = require('../../../lib/sim/clock')

const PATH = '/dev/no-such-port'
const soon = () => new Promise(resolve => setImmediate(resolve))
const turns = async (count = 5) => {
  for (let n = 0; n < count; n++) await soon()
}
const canceled = () => Object.assign(new Error('canceled'), { canceled: true })

/** A binding of the test: what it does when it opens, sets, writes, is what `does` says; each may return a promise. */
const bindingOf = (does = {}) => {
  const log = []
  const call = async (name, ...args) => {
    log.push(name)
    return does[name]?.(...args)
  }
  const open = async openOptions => {
    await call('open', openOptions)
    let stop
    const port = {
      isOpen: true,
      openOptions,
      read: () => new Promise((_, reject) => (stop = (error = canceled()) => reject(error))),
      write: bytes => call('write', bytes),
      set: options => call('set', options),
      close: async () => {
        await call('close')
        port.isOpen = false
        stop?.()
      },
      drain: async () => {},
      flush: async () => {}
    }
    binding.port = port
    binding.lose = () => stop(Object.assign(new Error('bad file descriptor'), { disconnect: true }))
    return port
  }
  const binding = /** @type {any} */ ({ open, list: async () => [], log })
  return binding
}

const create = (does, extra = {}) => {
  const binding = bindingOf(does)
  const clock = createVirtualClock()
  const told = []
  const transport = serialOver({ binding })(lineSettings({ path: PATH, baudRate: 9600, ...extra }), clock)
  const handlers = {
    opened: () => told.push('opened'),
    data: bytes => told.push(bytes.toString()),
    closed: error => told.push(`closed ${error.code}`),
    failed: error => told.push(`failed ${error.code}`)
  }
  return { binding, clock, told, transport, open: () => transport.open(handlers) }
}
/** A promise that the test ends. */
const pending = () => {
  const gate = /** @type {any} */ ({})
  gate.promise = new Promise((resolve, reject) => Object.assign(gate, { resolve, reject }))
  return gate
}

describe('serial transport: a binding that fails', () => {
  it('where something else than a port stands nothing is opened', () => {
    const bench = create({}, { path: os.tmpdir() })
    assert.throws(bench.open, {
      code: 'BAD_SETTING',
      details: { setting: 'path', value: os.tmpdir(), reason: 'it is a directory, not a serial port' }
    })
    assert.deepEqual(bench.binding.log, [])
  })

  it('the port does not open', async () => {
    const bench = create({ open: () => Promise.reject(new Error('Permission denied')) })
    bench.open()
    await turns()
    assert.deepEqual(bench.told, ['failed PORT_DENIED'])
    let closed = 0
    bench.transport.close(() => closed++)
    assert.equal(closed, 1)
  })

  it('DTR and RTS cannot be set: failed, and the port is closed', async () => {
    const bench = create({ set: () => Promise.reject(new Error('Inappropriate ioctl')) }, { dtr: 'on' })
    bench.open()
    await turns()
    assert.deepEqual(bench.told, ['failed PORT_ERROR'])
    assert.deepEqual(bench.binding.log, ['open', 'set', 'close'])
    assert.equal(bench.binding.port.isOpen, false)
  })

  it('unchanged signals are not touched', async () => {
    const bench = create({}, { dtr: 'unchanged', rts: 'unchanged' })
    bench.open()
    await turns()
    assert.deepEqual([bench.told, bench.binding.log], [['opened'], ['open']])
    const set = []
    const other = create(
      { set: options => void set.push([options.dtr, options.rts]) },
      { dtr: 'off', rts: 'unchanged' }
    )
    other.open()
    await turns()
    assert.deepEqual([other.told, set], [['opened'], [[false, true]]])
    for (const { transport } of [bench, other]) await new Promise(resolve => transport.close(resolve))
  })

  for (const name of ['open', 'set']) {
    it(`closed during ${name}: the port is closed when it can be, and nothing is told`, async () => {
      const gate = pending()
      const bench = create({ [name]: () => gate.promise }, { rts: 'off' })
      bench.open()
      await turns()
      let closed = 0
      bench.transport.close(() => closed++)
      gate.resolve()
      await turns()
      assert.deepEqual([closed, bench.told, bench.binding.port.isOpen], [1, [], false])
    })

    it(`closed during ${name}, which fails then`, async () => {
      const gate = pending()
      const bench = create({ [name]: () => gate.promise }, { rts: 'off' })
      bench.open()
      await turns()
      let closed = 0
      bench.transport.close(() => closed++)
      gate.reject(new Error('no'))
      await turns()
      assert.deepEqual([closed, bench.told], [1, []])
    })
  }

  it('closed during the delay behind the opening: no timer is left', async () => {
    const bench = create({}, { openDelay: 500 })
    bench.open()
    await turns()
    assert.deepEqual([bench.told, bench.clock.pending()], [[], 1])
    await new Promise(resolve => bench.transport.close(resolve))
    assert.deepEqual([bench.told, bench.clock.pending()], [[], 0])
  })

  it('what was being written when the port went ends with PORT_GONE, once', async () => {
    const gate = pending()
    const bench = create({ write: () => gate.promise })
    bench.open()
    await turns()
    const ends = []
    bench.transport.write(Buffer.from('A'), error => ends.push(error?.code))
    await turns()
    bench.binding.lose()
    await turns()
    assert.deepEqual([ends, bench.told], [['PORT_GONE'], ['opened', 'closed PORT_GONE']])
    gate.reject(new Error('EIO'))
    await turns()
    assert.deepEqual([ends, bench.told.length], [['PORT_GONE'], 2])
    bench.transport.close(() => ends.push('closed'))
    assert.deepEqual(ends, ['PORT_GONE', 'closed'])
  })

  it('a write that fails, and one behind it, end with PORT_GONE, once', async () => {
    const gate = pending()
    const bench = create({ write: () => gate.promise })
    bench.open()
    await turns()
    const ends = []
    bench.transport.write(Buffer.from('A'), error => ends.push(error?.code))
    await turns()
    gate.reject(new Error('EIO'))
    await turns()
    assert.deepEqual(ends, ['PORT_GONE'])
    bench.transport.write(Buffer.from('B'), error => ends.push(error?.code))
    await turns()
    assert.deepEqual(ends, ['PORT_GONE', 'PORT_GONE'], 'and nothing is written to a port that went')
    assert.deepEqual(bench.told, ['opened', 'closed PORT_GONE'])
    bench.transport.close(() => ends.push('closed'))
    await turns()
    assert.deepEqual(ends, ['PORT_GONE', 'PORT_GONE', 'closed'])
  })

  it('before it is open nothing can be written, and a close is told at once', () => {
    const bench = create()
    let [code, closed] = ['', 0]
    bench.transport.write(Buffer.from('A'), error => (code = error.code))
    bench.transport.close(() => closed++)
    assert.deepEqual([code, closed], ['PORT_GONE', 1])
    bench.transport.check()
  })
})
