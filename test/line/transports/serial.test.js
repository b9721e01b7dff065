'use strict'

const assert = require('node:assert/strict')
const fs = require('node:fs')
const path = require('node:path')
const { SerialPort, SerialPortMock } = require('serialport')
const { createPool, lineSettings, realClock } = require('../../../lib/line')
const { serialOver } = require('../../../lib/line/transports/serial')
const { openError } = require('../../../lib/line/transports/port-errors')
const { createPty } = require('../../../lib/sim/pty')
const { failure } = require('../support/bench')
const { fastClock, reached, tempFolder } = require('../support/real')
const toy = require('../support/toy')

const supported = ['linux', 'darwin'].includes(process.platform)
const answering = pty => bytes => pty.write(toy.answer(bytes[1], [bytes[1], 2, 3], bytes[2]))

;(supported ? describe : describe.skip)('serial transport on a pty', () => {
  let folder, link, pty, clock, pool, leases

  beforeEach(() => {
    folder = tempFolder()
    link = path.join(folder, 'port')
    pty = createPty({ link })
    clock = fastClock()
    pool = createPool({ clock, random: () => 0.5 })
    leases = []
  })
  afterEach(async () => {
    await Promise.all(leases.map(lease => lease.release()))
    pty.close()
    fs.rmSync(folder, { recursive: true })
  })

  const open = (extra = {}) => {
    const owner = `reader ${leases.length + 1}`
    const lease = pool.open(
      { path: link, baudRate: 115200, slack: 2000, latenessBound: 1, ...extra },
      { id: owner, name: owner }
    )
    leases.push(lease)
    return lease
  }
  const ask = (lease, options) =>
    lease.run(() => toy.ask(5, { timeout: 5000, ...options }), { station: 5, latenessBound: 5 })

  it('exchanges frames', async () => {
    pty.onData(answering(pty))
    const lease = open()
    for (let i = 0; i < 5; i++) assert.deepEqual(await ask(lease), [5, 2, 3])
  })

  it('carries all 256 byte values both ways', async () => {
    const all = Buffer.from(Array.from({ length: 256 }, (_, i) => i))
    pty.onData(bytes => pty.write(bytes))
    const lease = open({ echo: 'off' })
    const make = function* () {
      return yield { send: all, match: b => (b.length < 256 ? { need: 256 } : { take: 256 }), timeout: 5000 }
    }
    assert.ok((await lease.run(make, { station: 1 })).equals(all))
  })

  it('notices that the adapter was pulled, and comes back under the same name', async () => {
    pty.onData(answering(pty))
    const lease = open()
    await ask(lease)
    const lost = reached(lease, 'waiting')
    pty.unplug()
    const reason = await lost
    assert.equal(reason.code, 'PORT_GONE')
    assert.match(reason.message, new RegExp(`${link} has gone`))
    assert.ok((await failure(ask(lease))).code.startsWith('PORT_'))
    pty.replug()
    await reached(lease, 'open')
    assert.deepEqual(await ask(lease), [5, 2, 3])
  })

  it('notices it when it was pulled between two reads', async () => {
    let asked
    const query = new Promise(resolve => (asked = resolve))
    pty.onData(bytes => {
      // the beginning of an answer of 255 bytes: the transport sleeps until the rest can be there
      pty.write(toy.answer(5, Array(250).fill(1)).subarray(0, 10))
      asked(bytes)
    })
    const lease = open({ baudRate: 9600 })
    const promise = failure(ask(lease))
    await query
    await new Promise(resolve => setTimeout(resolve, 10))
    pty.unplug()
    assert.equal((await promise).code, 'PORT_GONE')
  })

  it('leaves no timer when it is closed while it sleeps', async () => {
    const query = new Promise(resolve => pty.onData(resolve))
    pty.onData(() => pty.write(toy.answer(5, Array(250).fill(1)).subarray(0, 10)))
    const lease = open({ baudRate: 300 })
    const promise = failure(ask(lease))
    await query
    await new Promise(resolve => setTimeout(resolve, 30))
    await lease.release()
    assert.equal((await promise).code, 'LINE_CLOSED')
    assert.equal(clock.pending(), 0)
  })

  it('says that a port is missing, and opens it when it appears', async () => {
    pty.unplug()
    const lease = open()
    const error = await failure(ask(lease))
    assert.equal(error.code, 'PORT_NOT_FOUND')
    assert.match(error.message, /port does not exist.*by-id/)
    pty.replug()
    pty.onData(answering(pty))
    await reached(lease, 'open')
    assert.deepEqual(await ask(lease), [5, 2, 3])
  })

  it('says that a port is busy, and opens it when it is free', async () => {
    const other = new SerialPort({ path: link, baudRate: 9600, autoOpen: false })
    await new Promise(resolve => other.open(resolve))
    const lease = open()
    const error = await failure(ask(lease))
    assert.equal(error.code, 'PORT_BUSY')
    assert.match(error.message, /in use by another program.*ModemManager/)
    await new Promise(resolve => other.close(resolve))
    await reached(lease, 'open')
  })

  it('claims the device behind the name', async () => {
    const lease = open()
    await reached(lease, 'open')
    const second = open({ path: pty.device() })
    const error = await failure(ask(second))
    assert.equal(error.code, 'WIRE_IN_USE')
    assert.match(error.message, /which reader 1 already uses/)
  })

  it('sleeps until the answer can be there: few reads for many bytes', async () => {
    const { read, readSync } = fs
    let reads = 0
    const counted = fn =>
      /** @type {any} */ (
        (...args) => {
          reads++
          return fn(...args)
        }
      )
    fs.read = counted(read)
    fs.readSync = counted(readSync)
    try {
      const frame = toy.answer(5, Array(100).fill(7))
      const character = 10000 / 9600
      pty.onData(() => {
        const start = performance.now()
        let done = 0
        const tick = setInterval(() => {
          const due = Math.min(frame.length, Math.floor((performance.now() - start) / character))
          if (due > done) pty.write(frame.subarray(done, due))
          done = due
          if (done === frame.length) clearInterval(tick)
        }, 1)
      })
      pool = createPool({ random: () => 0.5 })
      const lease = open({ baudRate: 9600 })
      await reached(lease, 'open')
      reads = 0
      assert.equal((await ask(lease)).length, 100)
    } finally {
      Object.assign(fs, { read, readSync })
    }
    assert.ok(reads > 0 && reads < 8, `${reads} reads for 105 bytes`)
  })
})

describe('serial transport over other bindings', () => {
  const { binding } = SerialPortMock
  afterEach(() => binding.reset())

  const settings = extra => lineSettings({ path: '/dev/mock', ...extra })
  const opened = (transport, told = {}) =>
    new Promise((resolve, reject) => {
      const handlers = { opened: () => resolve(transport), failed: reject, data: () => {}, closed: () => {}, ...told }
      transport.open(handlers)
    })
  const closed = transport => new Promise(resolve => transport.close(resolve))

  it('works where a port has no descriptor', async () => {
    binding.createPort('/dev/mock', { echo: true, readyData: Buffer.alloc(0) })
    const pool = createPool({ transports: { serial: serialOver({ binding }) } })
    const lease = pool.open({ path: '/dev/mock', echo: 'off' }, { id: 'a', name: 'a' })
    assert.equal(await lease.run(() => toy.put(1, 2), { station: 1 }), 'confirmed')
    await lease.release()
  })

  it('hands on speed, parity, stop bits and flow control', async () => {
    const seen = []
    const recording = {
      open: options => {
        seen.push(options)
        return Promise.reject(new Error('enough'))
      }
    }
    const raw = { baudRate: 4800, dataBits: 7, parity: 'even', stopBits: 2, flowControl: 'rtscts' }
    await assert.rejects(opened(serialOver({ binding: recording })(settings(raw), realClock)), { code: 'PORT_ERROR' })
    const [{ path: name, baudRate, dataBits, parity, stopBits, rtscts }] = seen
    assert.deepEqual([name, baudRate, dataBits, parity, stopBits, rtscts], ['/dev/mock', 4800, 7, 'even', 2, true])
  })

  for (const [raw, wanted] of [
    [{}, undefined],
    [{ dtr: 'off' }, { dtr: false, rts: true }],
    [
      { dtr: 'on', rts: 'off' },
      { dtr: true, rts: false }
    ]
  ]) {
    it(`sets the signals of a port-powered converter: ${JSON.stringify(raw)}`, async () => {
      binding.createPort('/dev/mock')
      let set
      const watching = {
        open: async options => {
          const port = await binding.open(options)
          port.set = async flags => void (set = flags)
          return port
        }
      }
      const transport = await opened(serialOver({ binding: watching })(settings(raw), realClock))
      assert.deepEqual(set && { dtr: set.dtr, rts: set.rts }, wanted)
      await closed(transport)
    })
  }

  it('waits for the open delay', async () => {
    binding.createPort('/dev/mock')
    const start = realClock.now()
    const transport = await opened(serialOver({ binding })(settings({ openDelay: 30 }), realClock))
    assert.ok(realClock.now() - start >= 29)
    await closed(transport)
  })

  it('takes no byte once it is closed, and may be closed twice', async () => {
    binding.createPort('/dev/mock')
    const transport = await opened(serialOver({ binding })(settings(), realClock))
    await Promise.all([closed(transport), closed(transport)])
    await closed(transport)
    const error = await new Promise(resolve => transport.write(Buffer.from([1]), resolve))
    assert.equal(error.code, 'PORT_GONE')
  })

  it('can be closed while it opens', async () => {
    binding.createPort('/dev/mock')
    let inner
    const slow = {
      open: async options => {
        await new Promise(resolve => setTimeout(resolve, 10))
        return (inner = await binding.open(options))
      }
    }
    const transport = serialOver({ binding: slow })(settings(), realClock)
    let told = false
    transport.open({ opened: () => (told = true), failed: () => (told = true), data: () => {}, closed: () => {} })
    await closed(transport)
    assert.equal(told, false)
    assert.equal(inner.isOpen, false)
  })

  for (const [what, change] of [
    ['went', name => fs.unlinkSync(name)],
    ['leads to another device', name => (fs.unlinkSync(name), fs.symlinkSync('/dev/ptmx', name))]
  ]) {
    it(`finds out after an unanswered request that the name ${what}`, async () => {
      const folder = tempFolder()
      const name = path.join(folder, 'port')
      fs.symlinkSync('/dev/tty', name)
      binding.createPort(name)
      const told = []
      const gone = new Promise(resolve => told.push(resolve))
      const transport = await opened(serialOver({ binding })(settings({ path: name }), realClock), {
        closed: error => told[0](error.code)
      })
      transport.check()
      await new Promise(resolve => setTimeout(resolve, 10))
      change(name)
      transport.check()
      assert.equal(await gone, 'PORT_GONE')
      await closed(transport)
      fs.rmSync(folder, { recursive: true })
    })
  }

  it('tells once that the port is gone, to the write that failed and to the line', async () => {
    binding.createPort('/dev/mock')
    let inner
    const watching = { open: async options => (inner = await binding.open(options)) }
    const told = []
    const transport = await opened(serialOver({ binding: watching })(settings(), realClock), {
      closed: error => told.push(error.code)
    })
    inner.write = () => Promise.reject(new Error('input/output error'))
    const error = await new Promise(resolve => transport.write(Buffer.from([1]), resolve))
    assert.equal(error.code, 'PORT_GONE')
    await closed(transport)
    assert.deepEqual(told, ['PORT_GONE'])
  })
})

describe('serial transport: what the systems say', () => {
  // Linux and macOS: bindings-cpp serialport_unix.cpp; Windows: serialport_win.cpp
  const rows = [
    ['Error: No such file or directory, cannot open /dev/ttyUSB0', 'PORT_NOT_FOUND'],
    ['Opening COM9: File not found', 'PORT_NOT_FOUND'],
    ['Error: No such device or address, cannot open /dev/ttyUSB0', 'PORT_NOT_FOUND'],
    ['Error Resource temporarily unavailable Cannot lock port', 'PORT_BUSY'],
    ['Error: Device or resource busy, cannot open /dev/ttyUSB0', 'PORT_BUSY'],
    ['Error: Resource busy, cannot open /dev/cu.usbserial', 'PORT_BUSY'],
    ['Opening COM3: Access denied', 'PORT_BUSY'],
    ['Error: Permission denied, cannot open /dev/ttyUSB0', 'PORT_DENIED'],
    ['Error: Inappropriate ioctl for device setting custom baud rate of 9600', 'PORT_ERROR']
  ]
  for (const [text, code] of rows) {
    it(`${code}: ${text}`, () => {
      const error = openError(new Error(text), '/dev/ttyUSB0')
      assert.equal(error.code, code)
      assert.match(error.message, /\/dev\/ttyUSB0/)
      assert.equal(error.cause['message'], text)
    })
  }

  it('PORT_DENIED names the group', () => {
    assert.match(openError(new Error('Error: Permission denied'), '/dev/a').message, /dialout/)
  })
})
