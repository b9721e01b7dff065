'use strict'

const assert = require('node:assert/strict')
const { EventEmitter } = require('node:events')
const net = require('node:net')
const { lineSettings } = require('../../../lib/line')
const { tcp } = require('../../../lib/line/transports/tcp')
const { createVirtualClock } = require('../../../lib/sim/clock')

/** A socket of the test. */
class Socket extends EventEmitter {
  log = []
  closed = false
  write(bytes, done) {
    this.log.push(`write ${bytes}`)
    this.written = done
  }
  end(done) {
    this.log.push('end')
    this.ended = done
  }
  destroy() {
    this.log.push('destroy')
    if (this.closed) return
    this.closed = true
    this.emit('close')
  }
  pause() {
    this.log.push('pause')
  }
  resume() {
    this.log.push('resume')
  }
  setKeepAlive(on, ms) {
    this.log.push(`keepAlive ${on} ${ms}`)
  }
}

describe('tcp transport: a socket that fails', () => {
  const { connect } = net
  /** @type {Socket} */
  let socket
  let asked
  beforeEach(() => {
    socket = new Socket()
    net.connect = /** @type {any} */ (options => ((asked = options), socket))
  })
  afterEach(() => {
    net.connect = connect
  })

  const create = (extra = {}) => {
    const clock = createVirtualClock()
    const told = []
    const transport = tcp(
      lineSettings({ transport: 'tcp', host: 'Server', port: 4001, baudRate: 9600, ...extra }),
      clock
    )
    const say = name => error => told.push(`${name} ${error.code}: ${error.details.reason}`)
    transport.open({
      opened: () => told.push('opened'),
      data: bytes => void told.push(`${bytes}`),
      closed: say('closed'),
      failed: say('failed')
    })
    return { clock, told, transport }
  }
  const connected = extra => {
    const bench = create(extra)
    socket.emit('connect')
    return bench
  }

  it('is claimed by host and port, whatever the case', () => {
    assert.equal(create().transport.id(), 'server:4001')
  })

  it('connects to host and port; nothing waits for more to be sent; a dead other side is asked for', () => {
    create({ keepAlive: 7000 })
    assert.deepEqual([asked, socket.log], [{ host: 'Server', port: 4001, noDelay: true }, ['keepAlive true 7000']])
    socket = new Socket()
    create({ keepAlive: 0 })
    assert.deepEqual(socket.log, [])
  })

  for (const [code, reason] of [
    ['ECONNREFUSED', 'nothing listens there'],
    ['EHOSTUNREACH', 'the host cannot be reached'],
    ['ENETUNREACH', 'the network cannot be reached'],
    ['ENOTFOUND', 'the name of the host is not known'],
    ['EAI_AGAIN', 'the name of the host cannot be resolved now'],
    ['ECONNRESET', 'the other side broke it off'],
    ['ETIMEDOUT', 'no answer']
  ]) {
    it(`${code}: ${reason}`, () => {
      const { told } = create()
      socket.emit('error', Object.assign(new Error(`connect ${code}`), { code }))
      assert.deepEqual(told, [`failed CONNECT_FAILED: ${reason}`])
    })
  }

  it('a connection that just closes is told', () => {
    const { told } = connected()
    socket.emit('close')
    assert.deepEqual(told, ['opened', 'closed LINE_DOWN: the connection was closed'])
  })

  it('a server that sends more than any wire brings is held', async () => {
    const { told, transport, clock } = connected()
    socket.log = []
    socket.emit('data', Buffer.alloc(1500, 'A'))
    assert.deepEqual([socket.log, transport.waiting], [['pause'], true])
    await clock.advance(2)
    assert.deepEqual([socket.log, transport.waiting], [['pause', 'resume'], false])
    assert.equal(told.slice(1).join(''), 'A'.repeat(1500))
  })

  it('a fault without a known code is told in its own words, once', () => {
    const { told } = create()
    socket.emit('error', Object.assign(new Error('strange'), { code: 'ESTRANGE' }))
    socket.emit('error', new Error('again'))
    socket.emit('connect')
    assert.deepEqual(told, ['failed CONNECT_FAILED: strange'])
  })

  it('not connected in time', async () => {
    const { told, clock } = create({ connectTimeout: 700 })
    await clock.advance(699)
    assert.deepEqual(told, [])
    await clock.advance(1)
    assert.deepEqual(told, ['failed CONNECT_FAILED: no connection within 700 ms'])
    assert.deepEqual(socket.log.slice(-1), ['destroy'])
  })

  it('what comes behind the end is not heard', () => {
    const { told } = connected()
    socket.emit('data', Buffer.from('A'))
    socket.emit('end')
    socket.emit('data', Buffer.from('B'))
    assert.deepEqual(told, ['opened', 'A', 'closed LINE_DOWN: the serial server closed the connection'])
  })

  it('a write before the connection, one that fails, one behind the end', () => {
    const codes = []
    const done = error => codes.push(error?.details.reason)
    const { transport } = create()
    transport.write(Buffer.from('A'), done)
    socket.emit('connect')
    transport.write(Buffer.from('B'), done)
    socket.written()
    transport.write(Buffer.from('C'), done)
    socket.written(new Error('EPIPE'))
    socket.emit('close')
    transport.write(Buffer.from('D'), done)
    const none = 'the connection is not open'
    assert.deepEqual(codes, [none, undefined, 'EPIPE', none])
    assert.deepEqual(
      socket.log.filter(row => row.startsWith('write')),
      ['write B', 'write C']
    )
  })

  it('before it was opened it holds nothing, and closes at once', () => {
    const transport = tcp(lineSettings({ transport: 'tcp', host: 'a', port: 1 }), createVirtualClock())
    let closed = 0
    assert.equal(transport.waiting, false)
    transport.close(() => closed++)
    assert.equal(closed, 1)
  })

  it('closed while it connects: destroyed; nothing is told', () => {
    const { told, transport, clock } = create()
    let closed = 0
    transport.close(() => closed++)
    socket.emit('connect')
    assert.deepEqual([closed, told, clock.pending(), socket.log.includes('destroy')], [1, [], 0, true])
    transport.close(() => closed++)
    assert.equal(closed, 2)
  })

  it('closed: what was written goes out first, for 300 ms at most', async () => {
    for (const wait of [false, true]) {
      socket = new Socket()
      const { transport, clock } = connected()
      let closed = 0
      transport.close(() => closed++)
      assert.deepEqual([closed, socket.log.at(-1)], [0, 'end'])
      if (wait) await clock.advance(299)
      assert.equal(closed, 0)
      if (wait) await clock.advance(1)
      else socket.ended()
      assert.deepEqual([closed, clock.pending(), socket.log.at(-1)], [1, 0, 'destroy'])
    }
  })

  it('a connection over which nobody answers is given up after 5, 10, … 160, then after each 160 requests', () => {
    const dead = []
    for (let all = 1; all <= 1000; all++) {
      socket = new Socket()
      const { told, transport } = connected()
      transport.check({ all, known: 0 })
      if (told.length > 1) dead.push(all)
    }
    assert.deepEqual(dead, [5, 10, 20, 40, 80, 160, 320, 480, 640, 800, 960])
  })

  it('after three of stations that had answered, or ten minutes of silence, too; one minute where nothing was ever heard', async () => {
    const bench = connected()
    bench.transport.check({ all: 2, known: 2 })
    assert.equal(bench.told.length, 1)
    bench.transport.check({ all: 3, known: 3 })
    assert.match(bench.told[1], /^closed LINE_DOWN: 3 requests in a row without an answer: the connection is dead/)
    for (const [heard, limit] of /** @type {const} */ ([
      [true, 600000],
      [false, 60000]
    ])) {
      socket = new Socket()
      const rare = connected()
      const before = rare.told.length
      if (heard) socket.emit('data', Buffer.from([1]))
      await rare.clock.advance(limit - 1)
      rare.transport.check({ all: 1, known: 1 })
      await rare.clock.advance(1)
      rare.transport.check({ all: 0, known: 0 })
      assert.ok(!rare.told.slice(before).some(each => /dead/.test(each)), 'nobody has asked')
      rare.transport.check({ all: 1, known: 1 })
      assert.match(rare.told.at(-1), /1 requests in a row without an answer/)
    }
  })
})
