'use strict'

const assert = require('node:assert/strict')
const net = require('node:net')
const { createPool } = require('../../../lib/line')
const { failure } = require('../support/bench')
const { fastClock, reached } = require('../support/real')
const toy = require('../support/toy')

/** A serial server on a free port of the loopback. */
async function createServer(onQuery = () => {}) {
  const sockets = new Set()
  const server = net.createServer(socket => {
    sockets.add(socket)
    state.accepted++
    socket.on('data', bytes => state.onQuery(bytes, socket))
    socket.on('error', () => {})
    socket.on('close', () => sockets.delete(socket))
  })
  const state = {
    accepted: 0,
    onQuery,
    sockets,
    listen: port => new Promise(resolve => server.listen(port, '127.0.0.1', resolve)),
    port: () => server.address().port,
    drop: () => sockets.forEach(socket => socket.destroy()),
    close: () =>
      new Promise(resolve => {
        state.drop()
        server.close(resolve)
      })
  }
  await state.listen(0)
  return state
}

const answering = (bytes, socket) => socket.write(toy.answer(bytes[1], [bytes[1]], bytes[2]))

describe('tcp transport', () => {
  let server, pool, lease
  const open = ({ port = server.port(), ...extra } = {}) => {
    // slow: this server has no wire, and each of its answers shows it
    lease = pool.open(
      { transport: 'tcp', host: '127.0.0.1', port, baudRate: 1200, latenessBound: 1, ...extra },
      { id: 'a', name: 'a' }
    )
    return lease
  }
  const ask = options => lease.run(() => toy.ask(5, { timeout: 5000, ...options }), { station: 5, latenessBound: 5 })

  beforeEach(async () => {
    server = await createServer(answering)
    pool = createPool({ clock: fastClock(), random: () => 0.5 })
  })
  afterEach(async () => {
    await lease.release()
    await server.close()
  })

  it('exchanges frames', async () => {
    open()
    for (let i = 0; i < 5; i++) assert.deepEqual(await ask(), [5])
    assert.equal(lease.line.times.slack, 250)
  })

  it('says that nothing listens: CONNECT_FAILED with host and port', async () => {
    const port = server.port()
    await server.close()
    open({ port })
    const error = await failure(ask())
    assert.equal(error.code, 'CONNECT_FAILED')
    assert.match(error.message, new RegExp(`127.0.0.1:${port} does not accept the connection: nothing listens there`))
    await server.listen(port)
    await reached(lease, 'open')
    assert.deepEqual(await ask(), [5])
  })

  it('says that the name is not known', async () => {
    open({ host: 'no-such-host.invalid' })
    const error = await failure(ask())
    assert.equal(error.code, 'CONNECT_FAILED')
  })

  it('gives up a connection that is not accepted in time', async () => {
    const { connect } = net
    // a host that swallows the first packet cannot be had on the loopback: a socket that never connects stands for it
    net.connect = () => new net.Socket()
    try {
      open({ connectTimeout: 100 })
      const error = await failure(ask())
      assert.equal(error.code, 'CONNECT_FAILED')
      assert.match(error.message, /no connection within 100 ms/)
    } finally {
      net.connect = connect
    }
  })

  it('comes back after the server closed the connection', async () => {
    open()
    await ask()
    const lost = reached(lease, 'waiting')
    server.drop()
    assert.equal((await lost).code, 'LINE_DOWN')
    await reached(lease, 'open')
    assert.deepEqual(await ask(), [5])
    assert.equal(server.accepted, 2)
  })

  it('ends what is under way when the connection breaks', async () => {
    server.onQuery = (_, socket) => socket.destroy()
    open()
    const error = await failure(ask())
    assert.deepEqual([error.code, error.details.sent], ['LINE_DOWN', true])
  })

  const silent = async (count, station = 5) => {
    const errors = []
    for (let i = 0; i < count; i++) {
      const make = () => toy.ask(station, { timeout: 20 })
      errors.push((await failure(lease.run(make, { station, latenessBound: 5 }))).code)
    }
    return errors
  }

  it('takes a connection for half-open after three requests without an answer of a station that has answered on it', async () => {
    open()
    await ask()
    server.onQuery = () => {}
    assert.deepEqual((await silent(3)).slice(0, 2), ['TIMEOUT', 'TIMEOUT'])
    assert.match(lease.line.reason.message, /3 requests in a row without an answer: the connection is dead/)
    server.onQuery = answering
    await reached(lease, 'open')
    assert.deepEqual(await ask(), [5])
    assert.equal(server.accepted, 2)
  })

  it('and after five, of one that has not', async () => {
    server.onQuery = () => {}
    open()
    assert.deepEqual((await silent(5)).slice(0, 4), ['TIMEOUT', 'TIMEOUT', 'TIMEOUT', 'TIMEOUT'])
    assert.match(lease.line.reason.message, /5 requests in a row without an answer: the connection is dead/)
    server.onQuery = answering
    await reached(lease, 'open')
    assert.deepEqual(await ask(), [5])
    assert.equal(server.accepted, 2)
  })

  it('dead stations between living ones are no reason to connect anew', async () => {
    server.onQuery = (bytes, socket) => bytes[1] === 5 && answering(bytes, socket)
    open()
    for (let round = 0; round < 4; round++) {
      await ask()
      for (const station of [6, 7, 8, 9]) await silent(1, station)
    }
    assert.equal(lease.line.state, 'open')
    assert.equal(server.accepted, 1)
  })

  it('a connection on which nothing was heard for ten minutes ends with the next request that is not answered', async () => {
    let ahead = 0
    const clock = fastClock()
    pool = createPool({ clock: { ...clock, now: () => clock.now() + ahead }, random: () => 0.5 })
    open()
    await ask()
    server.onQuery = () => {}
    ahead = 300000
    await silent(1)
    assert.equal(lease.line.state, 'open')
    ahead = 600000
    await silent(1)
    assert.match(lease.line.reason.message, /2 requests in a row/)
  })

  it('one on which nothing was ever heard is not kept for longer than a minute', async () => {
    server.onQuery = () => {}
    let ahead = 0
    const clock = fastClock()
    pool = createPool({ clock: { ...clock, now: () => clock.now() + ahead }, random: () => 0.5 })
    open()
    await silent(1)
    ahead = 40000
    await silent(1)
    assert.equal(lease.line.state, 'open')
    ahead = 60000
    await silent(1)
    assert.match(lease.line.reason.message, /3 requests in a row/)
  })

  it('sends what was written before it closes', async () => {
    let got = Buffer.alloc(0)
    const all = new Promise(resolve => {
      server.onQuery = bytes => {
        got = Buffer.concat([got, bytes])
        if (got.length === 256) resolve(undefined)
      }
    })
    open()
    const make = function* () {
      yield { send: Buffer.alloc(256, 7), match: () => ({ need: 1 }), timeout: 1000 }
    }
    await reached(lease, 'open')
    const promise = failure(lease.run(make, { station: 1 }))
    while (lease.line.stats().bytesOut < 256) await new Promise(resolve => setImmediate(resolve))
    await lease.release()
    await all
    assert.equal((await promise).code, 'LINE_CLOSED')
  })
})
