'use strict'

const assert = require('node:assert')
const fs = require('node:fs')
const net = require('node:net')
const os = require('node:os')
const path = require('node:path')
const { SerialPort } = require('serialport')
const { createNxLine, createPty, serveOnPty, serveOnTcp } = require('../../lib/sim')

const hex = text => Buffer.from(text.replace(/\s/g, ''), 'hex')
const QUERY = hex('01 E2 23 03 C0 00 80 D8 5D') // read M0..M127
const ANSWER_BYTES = 262

const openPort = path_ =>
  new Promise((resolve, reject) => {
    const port = new SerialPort({ path: path_, baudRate: 38400 }, error => (error ? reject(error) : resolve(port)))
  })
const collect = (stream, count) =>
  new Promise(resolve => {
    const parts = []
    const listener = bytes => {
      parts.push(bytes)
      if (Buffer.concat(parts).length < count) return
      stream.off('data', listener)
      resolve(Buffer.concat(parts))
    }
    stream.on('data', listener)
  })
const event = (emitter, name) => new Promise(resolve => emitter.once(name, resolve))

/** How long a query and its answer take, in ms. */
async function exchange(stream) {
  const answer = collect(stream, ANSWER_BYTES)
  const start = performance.now()
  stream.write(QUERY)
  const bytes = await answer
  return { bytes, ms: performance.now() - start }
}

const line = settings => createNxLine({ baudRate: 38400, turnaround: 2, ...settings })
const WIRE_MS = ((9 + ANSWER_BYTES) * 10000) / 38400 + 2 // 72.6

/** The lower bound tightly, the upper one loosely: the machine may be busy. The fastest of a few is near the wire's own time. */
function assertPaced(times) {
  const fastest = Math.min(...times)
  assert.ok(fastest >= WIRE_MS - 1, `${fastest} of ${WIRE_MS}`)
  assert.ok(fastest < WIRE_MS * 1.25, `${fastest} of ${WIRE_MS}`)
}

describe('simulated line on a virtual serial port', function () {
  let folder, link
  before(function () {
    if (process.platform === 'win32') this.skip()
    folder = fs.mkdtempSync(path.join(os.tmpdir(), 'sim-'))
    link = path.join(folder, 'port')
  })
  after(() => folder && fs.rmSync(folder, { recursive: true, force: true }))

  it('answers a real serial port, at the speed of the line', async () => {
    const { wire, plcs } = line()
    const served = serveOnPty({ wire, link })
    const port = await openPort(link)
    try {
      plcs[0].set('M5', 0x1311) // XON and XOFF: the port must be raw
      const times = []
      for (let n = 0; n < 4; n++) {
        const { bytes, ms } = await exchange(port)
        assert.strictEqual(bytes.length, ANSWER_BYTES)
        assert.strictEqual(bytes.readUInt16LE(4 + 10), 0x1311)
        times.push(ms)
      }
      assertPaced(times)
    } finally {
      port.close()
      await event(port, 'close')
      served.close()
    }
    assert.strictEqual(fs.lstatSync(link, { throwIfNoEntry: false }), undefined)
  })

  it('does not echo what a station says before anybody has opened it', async () => {
    const pty = createPty()
    const heard = new Promise(resolve => pty.onData(resolve))
    pty.write(Buffer.from('STATE 3\r\n'))
    // the master reads in order: an echo of the terminal would come before this byte
    const slave = fs.openSync(pty.path(), fs.constants.O_RDWR | fs.constants.O_NOCTTY)
    fs.writeSync(slave, 'y')
    const bytes = /** @type {Buffer} */ (await heard)
    fs.closeSync(slave)
    pty.close()
    assert.equal(bytes.toString(), 'y')
  })

  it('is unplugged and replugged under the same name', async () => {
    const { wire } = line()
    const served = serveOnPty({ wire, link })
    const port = await openPort(link)
    // who does not read does not notice
    port.resume()
    const closed = event(port, 'close')
    // not at once: a hang-up between two reads is a trap of its own
    setTimeout(served.unplug, 20)
    await closed
    assert.strictEqual(fs.existsSync(link), false)
    served.replug()
    const again = await openPort(link)
    assert.strictEqual((await exchange(again)).bytes.length, ANSWER_BYTES)
    again.close()
    await event(again, 'close')
    served.close()
    served.close()
  })

  it('takes over a dead link, but no file and no live link', () => {
    fs.symlinkSync(path.join(folder, 'gone'), link)
    const { wire } = line()
    const served = serveOnPty({ wire, link })
    assert.ok(fs.existsSync(link))
    assert.throws(() => serveOnPty({ wire, link }), { code: 'PORT_BUSY' })
    served.close()
    fs.writeFileSync(link, '')
    assert.throws(() => serveOnPty({ wire, link }), { code: 'PORT_BUSY' })
    fs.unlinkSync(link)
    assert.throws(() => serveOnPty({ wire, link: path.join(folder, 'none', 'port') }), { code: 'PORT_ERROR' })
  })

  it('leaves no descriptor open', function () {
    if (!fs.existsSync('/proc/self/fd')) return this.skip()
    const count = () => fs.readdirSync('/proc/self/fd').length
    const once = () => serveOnPty({ wire: line().wire, link }).close()
    once()
    const before_ = count()
    for (let n = 0; n < 50; n++) once()
    return new Promise(resolve => setTimeout(resolve, 20)).then(() => assert.ok(count() <= before_ + 1, `${count()}`))
  })
})

describe('simulated line over TCP', () => {
  it('paces its bytes, has several connections, and drops them', async () => {
    const { wire } = line()
    const served = await serveOnTcp({ wire })
    assert.strictEqual(served.host, '127.0.0.1')
    const socket = net.connect(served.port, served.host)
    await event(socket, 'connect')
    const times = []
    for (let n = 0; n < 4; n++) times.push((await exchange(socket)).ms)
    assertPaced(times)
    const other = net.connect(served.port, served.host)
    await event(other, 'connect')
    // both hear everything, as on a bus
    const heard = collect(other, QUERY.length + ANSWER_BYTES)
    await exchange(socket)
    assert.ok((await heard).subarray(0, QUERY.length).equals(QUERY))
    assert.strictEqual(served.connections(), 2)
    const closed = Promise.all([event(socket, 'close'), event(other, 'close')])
    served.drop()
    await closed
    await served.close()
  })

  it('ends its connections when the wire is unplugged', async () => {
    const { wire } = line()
    const served = await serveOnTcp({ wire })
    const socket = net.connect(served.port, served.host)
    await event(socket, 'connect')
    const closed = event(socket, 'close')
    while (served.connections() === 0) await new Promise(setImmediate)
    wire.unplug()
    await closed
    await served.close()
  })

  it('names a port that is taken', async () => {
    const first = await serveOnTcp({ wire: line().wire })
    await assert.rejects(serveOnTcp({ wire: line().wire, port: first.port }), { code: 'PORT_BUSY' })
    await first.close()
  })
})
