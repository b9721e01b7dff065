'use strict'

const assert = require('node:assert/strict')
const net = require('node:net')
const { createC24Port, createInconLink, createPool } = require('../../lib')
const { createPty, createVirtualClock } = require('../../lib/sim')
const { fastClock, reached } = require('../line/support/real')
const toy = require('../line/support/toy')

const supported = ['linux', 'darwin'].includes(process.platform)

/** What is on the other side of a line: says all of it at once, as fast as it is taken. */
const overTcp = async () => {
  const sockets = []
  const server = net.createServer(socket => {
    sockets.push(socket.on('error', () => {}))
    socket.resume()
  })
  await new Promise(resolve => server.listen(0, '127.0.0.1', resolve))
  const { port } = /** @type {net.AddressInfo} */ (server.address())
  return {
    line: { transport: 'tcp', host: '127.0.0.1', port },
    lines: 400,
    say: bytes => void sockets[0].write(bytes),
    close: () => {
      sockets.forEach(socket => socket.destroy())
      return new Promise(resolve => server.close(resolve))
    }
  }
}
const overPty = async () => {
  const pty = createPty()
  // a terminal holds 4 kB; who writes more waits for its reader, which is this process
  const line = { transport: 'serial', path: pty.path() }
  return { line, lines: 80, say: pty.write, close: async () => pty.close() }
}
const WIRES = { TCP: overTcp, ...(supported ? { 'a serial port': overPty } : {}) }

/** The most that came between two turns of the event loop. @param {() => any} count @param {() => boolean} over */
const mostInATurn = async (count, over) => {
  let most = 0
  let before = count()
  while (!over()) {
    await new Promise(resolve => setImmediate(resolve))
    most = Math.max(most, count() - before)
    before = count()
  }
  return most
}

describe('attack: all at once', () => {
  for (const [name, open] of Object.entries(WIRES)) {
    // 2 MB were read in one turn over TCP: 20 to 190 ms in which nothing else happened
    it(`${name}: a line takes it in small pieces, all of it, in order`, async () => {
      const wire = await open()
      const pool = createPool({ clock: fastClock(), random: () => 0.5 })
      const lease = pool.open({ ...wire.line, baudRate: 115200 }, { id: 'a', name: 'a' })
      const link = createInconLink({ lease, silence: 0 })
      const got = []
      link.listen(({ value }) => got.push(value))
      await reached(lease, 'open')
      const lines = Array.from({ length: wire.lines }, (_, n) => `O${String(n).padStart(4, '0')} ${'x'.repeat(40)}`)
      wire.say(Buffer.from(lines.join('\n') + '\n'))
      const most = await mostInATurn(
        () => got.length,
        () => got.length === lines.length
      )
      assert.deepEqual(got, lines)
      assert.ok(most < 40, `${most} messages in one turn`)
      link.close()
      await lease.release()
      await wire.close()
    })

    it(`${name}: messages of one byte come a few at a time`, async () => {
      const wire = await open()
      const pool = createPool({ clock: fastClock(), random: () => 0.5 })
      const lease = pool.open({ ...wire.line, baudRate: 115200 }, { id: 'a', name: 'a' })
      const port = createC24Port({ lease, framing: 'count', count: 1 })
      let got = 0
      port.listen(() => got++)
      await reached(lease, 'open')
      // the first chunk tells that these are messages
      wire.say(Buffer.from('A'))
      await mostInATurn(
        () => got,
        () => got === 1
      )
      wire.say(Buffer.alloc(1500, 0x41))
      const most = await mostInATurn(
        () => got,
        () => got === 1501
      )
      assert.ok(most <= 130, `${most} messages in one turn`)
      port.close()
      await lease.release()
      await wire.close()
    })

    it(`${name}: an answer inside it is found, and nothing is sent before all of it was seen`, async () => {
      const wire = await open()
      const pool = createPool({ clock: fastClock(), random: () => 0.5 })
      const lease = pool.open({ ...wire.line, baudRate: 115200, latenessBound: 1, gap: 0.5 }, { id: 'a', name: 'a' })
      const stats = () => lease.line.stats()
      const ask = station => lease.run(() => toy.ask(station, { timeout: 3000 }), { station, latenessBound: 5 })
      const first = ask(5)
      const asked = count => mostInATurn(stats, () => stats().queries === count)
      await asked(1)
      const all = Buffer.concat([Buffer.alloc(1500, 0), toy.answer(5, [7]), Buffer.alloc(2000, 0)])
      wire.say(all)
      const second = ask(6)
      await asked(2)
      assert.equal(stats().bytesIn, all.length)
      wire.say(toy.answer(6, [8]))
      assert.deepEqual(await Promise.all([first, second]), [[7], [8]])
      await lease.release()
      await wire.close()
    })
  }
})

describe('attack: bytes that have come and wait to be looked at', () => {
  const openOn = () => {
    const clock = createVirtualClock()
    const sent = []
    const port = { waiting: true }
    const transport = () => ({
      get waiting() {
        return port.waiting
      },
      open: handlers => clock.setTimer(() => handlers.opened(), 1),
      write: (bytes, done) => {
        sent.push(clock.now())
        done()
      },
      hint() {},
      close: done => done(),
      id: () => 'the port'
    })
    const pool = createPool({ clock, random: () => 0.5, transports: { serial: transport } })
    const lease = pool.open({ transport: 'serial', path: '/dev/ttyS0', gap: 0.5 }, { id: 'a', name: 'a' })
    return { clock, lease, sent, port }
  }
  const ways = {
    'a question': ({ lease }) => void lease.run(() => toy.ask(1), { station: 1 }).catch(() => {}),
    'a line of INCON': ({ lease, clock }) => void createInconLink({ lease, clock }).send('O1')
  }
  for (const [name, send] of Object.entries(ways)) {
    it(`are no silence: ${name} is not sent before they were seen`, async () => {
      const b = openOn()
      send(b)
      // a wait of its own behind the opening
      await b.clock.advance(1900)
      assert.deepEqual(b.sent, [])
      b.port.waiting = false
      await b.clock.advance(100)
      assert.equal(b.sent.length, 1)
      await b.clock.run(b.lease.release())
      await b.clock.advance(5000)
    })
  }
})
