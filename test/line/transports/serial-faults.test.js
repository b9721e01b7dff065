'use strict'

const assert = require('node:assert/strict')
const fs = require('node:fs')
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
    const waiting = []
    let ask = null
    const deliver = () => {
      if (!ask || waiting.length === 0) return
      const { buffer, offset, length, resolve } = ask
      ask = null
      const bytes = waiting.shift()
      const bytesRead = bytes.copy(buffer, offset, 0, length)
      if (bytesRead < bytes.length) waiting.unshift(bytes.subarray(bytesRead))
      resolve({ buffer, bytesRead })
    }
    const port = {
      isOpen: true,
      openOptions,
      read: (buffer, offset, length) =>
        new Promise((resolve, reject) => {
          stop = (error = canceled()) => reject(error)
          ask = { buffer, offset, length, resolve }
          deliver()
        }),
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
    binding.bring = bytes => {
      waiting.push(bytes)
      deliver()
    }
    binding.unread = () => waiting.reduce((sum, { length }) => sum + length, 0)
    binding.lose = () => stop(Object.assign(new Error('bad file descriptor'), { disconnect: true }))
    return port
  }
  const binding = /** @type {any} */ ({ open, list: async () => [], log, isOpen: () => binding.port.isOpen })
  return binding
}

const create = (does, extra = {}) => {
  const binding = bindingOf(does)
  const clock = createVirtualClock()
  const told = []
  const transport = serialOver({ binding })(lineSettings({ path: PATH, baudRate: 9600, ...extra }), clock)
  const handlers = {
    opened: () => told.push('opened'),
    data: bytes => void told.push(bytes.toString()),
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
    let closed = 0
    const said = []
    bench.transport.write(Buffer.from('A'), error => said.push(error.code, error.details))
    bench.transport.close(() => closed++)
    assert.deepEqual([said, closed], [['PORT_GONE', { path: PATH }], 1])
    bench.transport.check()
  })

  it('a write that fails while it is being closed: the end is told when the port is free', async () => {
    const [write, close] = [pending(), pending()]
    const bench = create({ write: () => write.promise, close: () => close.promise })
    bench.open()
    await turns()
    let closed = 0
    bench.transport.write(Buffer.from('A'), () => {})
    await turns()
    bench.transport.close(() => closed++)
    write.reject(new Error('EIO'))
    await turns()
    assert.deepEqual([closed, bench.told], [0, ['opened']])
    close.resolve()
    await turns()
    assert.deepEqual([closed, bench.told], [1, ['opened']])
  })

  it('closed while the signals are set: the end is told when the port is free', async () => {
    const [set, close] = [pending(), pending()]
    const bench = create({ set: () => set.promise, close: () => close.promise }, { dtr: 'on' })
    bench.open()
    await turns()
    let closed = 0
    bench.transport.close(() => closed++)
    set.resolve()
    await turns()
    assert.equal(closed, 0)
    close.resolve()
    await turns()
    assert.deepEqual([closed, bench.told, bench.binding.log], [1, [], ['open', 'set', 'close']])
  })
})

describe('serial transport: what goes through it', () => {
  const opened = async (does, extra) => {
    const bench = create(does, extra)
    bench.open()
    await turns()
    return bench
  }
  const closed = ({ transport }) => new Promise(resolve => transport.close(resolve))

  for (const [flowControl, flags] of Object.entries({
    none: [undefined, undefined, undefined],
    rtscts: [true, undefined, undefined],
    xonxoff: [undefined, true, true]
  })) {
    it(`opens with the flow control ${flowControl}`, async () => {
      const bench = await opened({}, { flowControl })
      const { rtscts, xon, xoff } = bench.binding.port.openOptions
      await closed(bench)
      assert.deepEqual([rtscts, xon, xoff], flags)
    })
  }

  it('gives what comes; while it is being closed nothing is heard', async () => {
    const gate = pending()
    const bench = await opened({ close: () => gate.promise })
    bench.binding.bring(Buffer.from('A'))
    await turns()
    const end = closed(bench)
    bench.binding.bring(Buffer.from('B'))
    await turns()
    gate.resolve()
    await end
    assert.deepEqual(bench.told, ['opened', 'A'])
  })

  it('a port that brings more than any wire is held: it stays with the system', async () => {
    const bench = await opened()
    const all = Buffer.alloc(400000, 'x')
    bench.binding.bring(all)
    await turns(50)
    assert.equal(bench.transport.waiting, true)
    // what the stream itself reads ahead is 64 KiB
    assert.ok(bench.binding.unread() > 200000, `${bench.binding.unread()} are left`)
    for (let n = 0; n < 20 && bench.binding.unread() > 0; n++) {
      await bench.clock.advance(100)
      await turns(20)
    }
    await bench.clock.advance(1000)
    assert.deepEqual([bench.transport.waiting, bench.told.slice(1).join('').length], [false, all.length])
    await closed(bench)
  })

  it('is claimed by the device behind its name; where the name leads nowhere, by the name', () => {
    assert.equal(create().transport.id(), PATH)
    const link = `${fs.mkdtempSync(`${os.tmpdir()}/port-`)}/link`
    fs.symlinkSync(os.devNull, link)
    try {
      assert.equal(create({}, { path: link }).transport.id(), fs.realpathSync(os.devNull))
    } finally {
      fs.rmSync(link.slice(0, -'/link'.length), { recursive: true })
    }
  })
})

describe('serial transport: a request that was not answered asks whether the port is still there', () => {
  const { realpath, realpathSync } = fs
  const DEVICE = '/dev/ttyUSB7'
  /** @type {any} */
  let answer
  let device, asked
  beforeEach(() => {
    device = DEVICE
    asked = 0
    fs.realpathSync = /** @type {any} */ (
      () => {
        if (!device) throw new Error('ENOENT')
        return device
      }
    )
    fs.realpath = /** @type {any} */ (
      (_path, done) => {
        asked++
        answer = done
      }
    )
  })
  afterEach(() => Object.assign(fs, { realpath, realpathSync }))

  const opened = async () => {
    const bench = create()
    bench.open()
    await turns()
    return bench
  }
  const closed = ({ transport }) => new Promise(resolve => transport.close(resolve))
  const fault = code => Object.assign(new Error(code), { code })

  for (const [what, said] of /** @type {[string, any[]][]} */ ([
    ['the same device is there', [null, DEVICE]],
    ['it cannot be found out', [fault('EACCES')]]
  ])) {
    it(`${what}: nothing happens`, async () => {
      const bench = await opened()
      bench.transport.check()
      answer(...said)
      await turns()
      assert.deepEqual([bench.told, bench.binding.log], [['opened'], ['open']])
      await closed(bench)
    })
  }

  for (const [what, said] of /** @type {[string, any[]][]} */ ([
    ['nothing is there', [fault('ENOENT')]],
    ['another device is there', [null, '/dev/ttyUSB8']]
  ])) {
    it(`${what}: the port is gone, told once, and closed`, async () => {
      const bench = await opened()
      bench.transport.check()
      answer(...said)
      answer(...said)
      await turns()
      assert.deepEqual(
        [bench.told, bench.binding.log],
        [
          ['opened', 'closed PORT_GONE'],
          ['open', 'close']
        ]
      )
      await closed(bench)
    })
  }

  for (const [what, happens] of /** @type {[string, (bench: any) => void][]} */ ([
    ['while it closes because it failed', ({ binding }) => binding.lose()],
    ['and it is asked twice', ({ transport }) => transport.check()]
  ])) {
    it(`the answer comes ${what}: told once; and a close is told when the port is free`, async () => {
      const close = pending()
      const bench = create({ close: () => close.promise })
      bench.open()
      await turns()
      bench.transport.check()
      const first = answer
      happens(bench)
      await turns()
      for (const say of [first, answer]) say(Object.assign(new Error('ENOENT'), { code: 'ENOENT' }))
      let ends = 0
      bench.transport.close(() => ends++)
      await turns()
      const said = ['opened', 'closed PORT_GONE']
      assert.deepEqual([ends, bench.told, bench.binding.log], [0, said, ['open', 'close']])
      close.resolve()
      await turns()
      assert.deepEqual([ends, bench.told, bench.binding.log], [1, said, ['open', 'close']])
    })
  }

  it('only of a port that is open, and whose name led to a device', async () => {
    const early = create()
    early.transport.check()
    device = null
    const nameless = await opened()
    nameless.transport.check()
    await closed(nameless)
    device = DEVICE
    const late = await opened()
    await closed(late)
    late.transport.check()
    assert.equal(asked, 0)
  })
})
