'use strict'

const assert = require('node:assert/strict')
const { OpenPort } = require('../../../lib/line/transports/open-port')

const soon = () => new Promise(resolve => setImmediate(resolve))
const canceled = () => Object.assign(new Error('canceled'), { canceled: true })

/** A port whose reads, writes and closing end when the test says; `takes`: bytes that the system takes at once. */
const createPort = (takes = 0) => {
  const log = /** @type {string[]} */ ([])
  const ends = /** @type {any[]} */ ([])
  const later = name => new Promise((resolve, reject) => ends.push({ name, resolve, reject }))
  const end = async (name, result) => {
    const [found] = ends.splice(
      ends.findIndex(each => each.name === name),
      1
    )
    if (result instanceof Error) found.reject(result)
    else found.resolve(result)
    await soon()
  }
  const port = {
    isOpen: true,
    set: flags => later(`set ${JSON.stringify(flags)}`),
    writeNow: bytes => (log.push(`now ${bytes}`), Math.min(takes, bytes.length)),
    write: bytes => (log.push(`write ${bytes}`), later('write')),
    readInto(buffer, offset, length, done) {
      log.push('read')
      later('read').then(text => done(null, buffer.write(text, offset, length)), done)
    },
    close: () => (log.push('close'), later('close').finally(() => (port.isOpen = false)))
  }
  const lost = /** @type {any[]} */ ([])
  const open = new OpenPort(port, error => lost.push(error.message))
  return { open, log, ends, end, lost }
}

describe('open port: what is written', () => {
  const send = ({ open }, text, told) => open.write(Buffer.from(text), error => told.push(error ? error.message : text))

  it('is done in the call itself, if the system takes it at once', () => {
    const bench = createPort(5)
    const told = []
    send(bench, 'ABCDE', told)
    assert.deepEqual([told, bench.log], [['ABCDE'], ['now ABCDE']])
  })

  it('what is left goes through the binding, and what comes behind it waits for it, whatever the system would take', async () => {
    const bench = createPort(3)
    const told = []
    send(bench, 'ABCDE', told)
    send(bench, 'F', told)
    send(bench, 'G', told)
    await soon()
    assert.deepEqual([told, bench.log], [[], ['now ABCDE', 'write DE']])
    await bench.end('write')
    assert.deepEqual([told, bench.log.at(-1)], [['ABCDE'], 'write F'])
    send(bench, 'H', told)
    for (let n = 0; n < 3; n++) await bench.end('write')
    assert.deepEqual(
      [told, bench.log.slice(1)],
      [
        ['ABCDE', 'F', 'G', 'H'],
        ['write DE', 'write F', 'write G', 'write H']
      ]
    )
    send(bench, 'HIJ', told)
    assert.deepEqual([told.at(-1), bench.log.at(-1)], ['HIJ', 'now HIJ'], 'then at once again')
  })

  it('one that fails takes those behind it along; the port is closed, then told as lost, once', async () => {
    const bench = createPort()
    const told = []
    send(bench, 'A', told)
    send(bench, 'B', told)
    await soon()
    await bench.end('write', new Error('EIO'))
    assert.deepEqual([told, bench.lost, bench.open.isOpen], [['EIO', 'EIO'], [], false])
    assert.deepEqual(bench.log.slice(1), ['write A', 'close'])
    await bench.end('close')
    assert.deepEqual([bench.lost, bench.open.closing], [['EIO'], false])
  })

  it('one that was canceled says so, and nothing is lost', async () => {
    const bench = createPort()
    const told = []
    send(bench, 'A', told)
    await soon()
    await bench.end('write', canceled())
    assert.deepEqual([told, bench.lost, bench.open.isOpen], [['canceled'], [], true])
  })
})

describe('open port: what is read', () => {
  const reading = (bench, seen = /** @type {any[]} */ ([])) => {
    bench.open.read(bytes => seen.push(bytes))
    return seen
  }
  const texts = seen => seen.map(String)

  it('nothing, until somebody wants it; then on and on', async () => {
    const bench = createPort()
    bench.open.hold(false)
    assert.deepEqual(bench.log, [])
    const seen = reading(bench)
    for (const text of ['A', 'BC']) await bench.end('read', text)
    assert.equal(seen[0].buffer, seen[1].buffer, 'one buffer for many')
    assert.deepEqual(
      [texts(seen), bench.log],
      [
        ['A', 'BC'],
        ['read', 'read', 'read']
      ]
    )
  })

  it('nothing is written over what was given, however much comes behind it', async () => {
    const bench = createPort()
    const seen = reading(bench)
    const pieces = Array.from({ length: 60 }, (_, n) => String.fromCharCode(65 + n).repeat(200 + 13 * n))
    for (const piece of pieces) await bench.end('read', piece)
    assert.deepEqual(texts(seen), pieces)
  })

  it('a kilobyte fits at any time', async () => {
    const bench = createPort()
    const seen = reading(bench)
    for (let n = 0; n < 40; n++) await bench.end('read', 'x'.repeat(1 + 97 * n < 1024 ? 1 + 97 * n : 1024))
    assert.deepEqual(
      seen.map(({ length }) => length),
      Array.from({ length: 40 }, (_, n) => Math.min(1 + 97 * n, 1024))
    )
  })

  it('held: a read that is under way ends, the next one waits', async () => {
    const bench = createPort()
    const seen = reading(bench)
    bench.open.hold(true)
    await bench.end('read', 'A')
    assert.deepEqual([texts(seen), bench.log], [['A'], ['read']])
    bench.open.hold(false)
    bench.open.hold(false)
    assert.deepEqual(bench.log, ['read', 'read'])
  })

  for (const [what, result, message] of /** @type {[string, any, string][]} */ ([
    ['fails', new Error('EIO'), 'EIO'],
    ['brings no byte', '', 'the port has hung up']
  ])) {
    it(`a read that ${what}: the port is closed, then told as lost, once`, async () => {
      const bench = createPort()
      reading(bench)
      await bench.end('read', result)
      assert.deepEqual([bench.lost, bench.log], [[], ['read', 'close']])
      await bench.end('close', new Error('also that fails'))
      assert.deepEqual([bench.lost, bench.log], [[message], ['read', 'close']])
    })
  }

  it('one that was canceled is asked for again', async () => {
    const bench = createPort()
    const seen = reading(bench)
    await bench.end('read', canceled())
    await bench.end('read', 'A')
    assert.deepEqual([texts(seen), bench.lost], [['A'], []])
  })

  for (const [what, result] of /** @type {[string, any][]} */ ([
    ['brings something', 'A'],
    ['fails', new Error('EBADF')],
    ['is canceled', canceled()]
  ])) {
    it(`while the port is being closed a read that ${what} concerns nobody`, async () => {
      const bench = createPort()
      const seen = reading(bench)
      let closed = 0
      bench.open.close(() => closed++)
      assert.deepEqual([bench.open.isOpen, bench.open.closing], [false, true])
      await bench.end('read', result)
      await bench.end('close')
      assert.deepEqual([seen, bench.lost, closed, bench.log], [[], [], 1, ['read', 'close']])
      assert.equal(bench.open.closing, false)
    })
  }
})

describe('open port: signals', () => {
  it('DTR and RTS as wanted; no break, and CTS is not ours', async () => {
    const bench = createPort()
    const told = /** @type {any[]} */ ([])
    bench.open.set({ dtr: true, rts: false }, error => told.push(error))
    bench.open.set({ dtr: false, rts: true }, error => told.push(error?.message))
    assert.deepEqual(
      bench.ends.map(({ name }) => name),
      ['set {"brk":false,"cts":false,"dtr":true,"rts":false}', 'set {"brk":false,"cts":false,"dtr":false,"rts":true}']
    )
    await bench.end('set {"brk":false,"cts":false,"dtr":true,"rts":false}')
    await bench.end('set {"brk":false,"cts":false,"dtr":false,"rts":true}', new Error('ioctl'))
    assert.deepEqual(told, [undefined, 'ioctl'])
  })
})
