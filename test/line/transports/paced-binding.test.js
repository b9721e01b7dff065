'use strict'

const assert = require('node:assert/strict')
const fs = require('node:fs')
const { Pace } = require('../../../lib/line/transports/pace')
const { pacedBinding } = require('../../../lib/line/transports/paced-binding')
const { createVirtualClock } = require('../../../lib/sim')

const fault = code => Object.assign(new Error(code), { code })
const canceled = () => Object.assign(new Error('Canceled'), { canceled: true })
const soon = () => new Promise(resolve => setImmediate(resolve))

describe('binding that reads by wire time', () => {
  const { readSync, writeSync } = fs
  let clock, pace, log, results

  /** What the system says to the next calls, in turn: a number of bytes, or an error. */
  const system = name => {
    log.push(name)
    const result = results.shift()
    if (result instanceof Error) throw result
    return result
  }
  beforeEach(() => {
    clock = createVirtualClock()
    pace = new Pace(clock)
    log = []
    results = []
    fs.readSync = /** @type {any} */ (() => system('read'))
    fs.writeSync = /** @type {any} */ ((_fd, bytes) => system(`write ${bytes.length}`))
  })
  afterEach(() => Object.assign(fs, { readSync, writeSync }))

  const open = (extra = {}) => {
    const port = {
      isOpen: true,
      fd: 77,
      tell: /** @type {(error: any) => void} */ (() => {}),
      poller: {
        writers: 0,
        on(event, listener) {
          assert.equal(event, 'readable')
          port.tell = listener
        },
        off(event, listener) {
          assert.deepEqual([event, listener], ['readable', port.tell])
          port.tell = () => {}
        },
        poll(flag) {
          assert.equal(flag, port.poller.writers > 0 ? 3 : 1)
          log.push(flag === 1 ? 'readable' : 'readable, writable')
        },
        stop() {
          log.push('stop')
          // as that of bindings-cpp
          port.tell(canceled())
        },
        listenerCount: event => (event === 'writable' ? port.poller.writers : 1)
      },
      read: async () => ({ bytesRead: 99 }),
      write: async bytes => void log.push(`wrapped ${bytes.toString('hex')}`),
      close: async () => void (port.isOpen = false),
      ...extra
    }
    return pacedBinding({ open: async () => port }, pace).open({})
  }
  const buffer = Buffer.alloc(16)
  /** @returns {{ end: any }} how a read ends, when it does */
  const reading = port => {
    const read = { end: /** @type {any} */ (null) }
    port.readInto(buffer, 0, 16, (error, bytesRead) => {
      assert.equal(read.end, null, 'it ends once')
      read.end = error ?? bytesRead
    })
    return read
  }

  for (const [what, result, taken] of /** @type {[string, any, number][]} */ ([
    ['all', 5, 5],
    ['a part', 3, 3],
    ['nothing now', fault('EAGAIN'), 0],
    ['none, because it fails: the wrapped write says how', fault('EIO'), 0]
  ])) {
    it(`writes in the call itself; the system takes ${what}`, async () => {
      const port = await open()
      results = [result]
      assert.equal(port.writeNow(Buffer.from('0102030405', 'hex')), taken)
      assert.deepEqual(log, ['write 5'])
    })
  }

  it('asks for bytes only when the descriptor has some', async () => {
    const port = await open()
    const read = reading(port)
    await soon()
    assert.deepEqual([log, read.end], [['readable'], null])
    results = [fault('EAGAIN'), 4]
    port.tell(null)
    await soon()
    assert.deepEqual([log, read.end], [['readable', 'read', 'readable'], null])
    port.tell(null)
    await soon()
    assert.equal(read.end, 4)
  })

  for (const code of ['EAGAIN', 'EWOULDBLOCK', 'EINTR']) {
    it(`takes ${code} for nothing yet`, async () => {
      const port = await open()
      const read = reading(port)
      await soon()
      results = [fault(code), 4]
      port.tell(null)
      await soon()
      assert.deepEqual([log, read.end], [['readable', 'read', 'readable'], null])
      port.tell(null)
      await soon()
      assert.equal(read.end, 4)
    })
  }

  it('after a sleep there should be some; else the descriptor tells', async () => {
    const port = await open()
    pace.hint(clock.now() + 20.4)
    const read = reading(port)
    await clock.advance(19)
    assert.deepEqual([log, read.end], [[], null])
    results = [fault('EAGAIN'), 4]
    await clock.advance(1)
    await soon()
    assert.deepEqual([log, read.end], [['read', 'readable'], null])
    port.tell(null)
    await soon()
    assert.equal(read.end, 4)
    assert.equal(clock.pending(), 0)
  })

  it('sleeps whole milliseconds, rather one less: timers are late', async () => {
    for (const [until, sleeps] of [
      [20.7, 20],
      [20.9, 21],
      [1.7, 1]
    ]) {
      const port = await open()
      results = [1]
      pace.hint(clock.now() + until)
      const read = reading(port)
      await clock.advance(sleeps - 0.1)
      assert.equal(read.end, null)
      await clock.advance(0.1)
      await soon()
      assert.equal(read.end, 1, String(until))
    }
  })

  describe('where nobody asks when the first byte comes', () => {
    it('the wait for it is given up: it is read once', async () => {
      const port = await open()
      const read = reading(port)
      await soon()
      pace.hint(clock.now() + 30, true)
      assert.deepEqual(log, ['readable', 'stop'])
      results = [9]
      await clock.advance(29)
      assert.equal(read.end, null)
      await clock.advance(1)
      await soon()
      assert.deepEqual([read.end, log.length, clock.pending()], [9, 3, 0])
    })

    it('in the system alone, where that can be told', async () => {
      const port = await open()
      port.poller.poller = { stop: () => log.push('stop in the system') }
      reading(port)
      await soon()
      pace.hint(clock.now() + 30, true)
      assert.deepEqual(log, ['readable', 'stop in the system'])
    })

    it('and if there is nothing yet, or a part, as ever', async () => {
      const port = await open()
      const read = reading(port)
      await soon()
      pace.hint(clock.now() + 30, true)
      results = [fault('EAGAIN'), 4]
      await clock.advance(30)
      await soon()
      assert.deepEqual([read.end, log.slice(2)], [null, ['read', 'readable']])
      port.tell(null)
      await soon()
      assert.equal(read.end, 4)
    })

    for (const [what, hint] of /** @type {[string, () => void][]} */ ([
      ['it comes soon', () => pace.hint(clock.now() + 1.9, true)],
      ['somebody asks', () => pace.hint(clock.now() + 30)]
    ])) {
      it(`not where ${what}`, async () => {
        const port = await open()
        reading(port)
        await soon()
        hint()
        assert.deepEqual(log, ['readable'])
      })
    }

    it('nor while a write waits, which would end with it', async () => {
      const port = await open()
      port.poller.writers = 1
      const read = reading(port)
      await soon()
      pace.hint(clock.now() + 30, true)
      assert.deepEqual(log, ['readable, writable'])
      port.poller.writers = 0
      pace.hint(clock.now() + 30, true)
      assert.deepEqual(log, ['readable, writable', 'stop'])
      results = [1]
      await clock.advance(30)
      await soon()
      assert.equal(read.end, 1)
    })

    for (const error of [null, fault('EIO')]) {
      it(`nor when it ${error ? 'has failed' : 'has come'}`, async () => {
        const port = await open()
        results = [1]
        reading(port)
        await soon()
        port.tell(error)
        await soon()
        pace.hint(clock.now() + 30, true)
        assert.ok(!log.includes('stop'), log.join())
      })
    }

    it('a port that is closed at the same moment is not asked again', async () => {
      const port = await open()
      const read = reading(port)
      await soon()
      pace.hint(clock.now() + 30, true)
      await port.close()
      await soon()
      assert.deepEqual([read.end?.canceled, log, clock.pending()], [true, ['readable', 'stop'], 0])
    })

    it('a hang-up is seen when it is over', async () => {
      const port = await open()
      const read = reading(port)
      await soon()
      pace.hint(clock.now() + 30, true)
      results = [0]
      await clock.advance(30)
      await soon()
      assert.equal(read.end.disconnect, true)
    })
  })

  it('sleeps for a millisecond', async () => {
    const port = await open()
    pace.hint(clock.now() + 1)
    reading(port)
    await soon()
    assert.deepEqual([log, clock.pending()], [[], 1])
  })

  it('does not sleep for less than a millisecond', async () => {
    const port = await open()
    pace.hint(clock.now() + 0.4)
    reading(port)
    await soon()
    assert.deepEqual([log, clock.pending()], [['readable'], 0])
  })

  for (const slept of [false, true]) {
    it(`takes zero bytes for a hang-up, ${slept ? 'after a sleep, too' : 'never for nothing'}`, async () => {
      const port = await open()
      if (slept) pace.hint(clock.now() + 20)
      results = [0]
      const read = reading(port)
      await clock.advance(20)
      port.tell(null)
      await soon()
      assert.deepEqual([read.end.disconnect, read.end.message], [true, 'the port has hung up'])
    })
  }

  it('a descriptor that cannot be asked: the read fails as the system says, whatever comes behind', async () => {
    const port = await open()
    port.poller.poll = () => {
      throw fault('EBADF')
    }
    const read = reading(port)
    assert.equal(read.end.code, 'EBADF')
    port.tell(null)
    pace.hint(clock.now() + 30, true)
    assert.deepEqual(log, ['stop'])
  })

  it('what the poller asks for by itself, once a write has waited, is stopped; but not while a write waits', async () => {
    const port = await open()
    pace.hint(clock.now() + 20)
    const read = reading(port)
    port.tell(null)
    assert.deepEqual([log, read.end], [['stop'], null])
    port.poller.writers = 1
    port.tell(null)
    assert.deepEqual([log, read.end], [['stop'], null])
  })

  it('what its reader throws is not thrown into the poller, which would end the process without a word', async () => {
    const port = await open()
    const own = process.listeners('uncaughtException')
    process.removeAllListeners('uncaughtException')
    try {
      const thrown = new Promise(resolve => process.once('uncaughtException', resolve))
      results = [1]
      port.readInto(buffer, 0, 16, () => {
        throw new Error('mine')
      })
      port.tell(null)
      const error = await thrown
      assert.equal(error.message, 'mine')
    } finally {
      for (const listener of own) process.on('uncaughtException', listener)
    }
  })

  it('fails as the system says', async () => {
    const port = await open()
    results = [fault('EIO')]
    const read = reading(port)
    await soon()
    port.tell(null)
    await soon()
    assert.equal(read.end.code, 'EIO')
  })

  it('that is closed while it sleeps has ended, without a timer', async () => {
    const port = await open()
    pace.hint(clock.now() + 1000)
    const read = reading(port)
    await port.close()
    await soon()
    assert.deepEqual([read.end.canceled, read.end.message], [true, 'Port is not open'])
    assert.deepEqual([clock.pending(), log], [0, []])
  })

  it('that is closed while the descriptor is asked does not sleep any more', async () => {
    const port = await open()
    const read = reading(port)
    await soon()
    await port.close()
    port.tell(null)
    await soon()
    assert.deepEqual([read.end?.canceled, clock.pending(), log], [true, 0, ['readable']])
  })

  it('lists what the wrapped binding lists', () => {
    const ports = [{ path: 'COM3' }]
    assert.equal(pacedBinding({ list: () => ports }, pace).list(), ports)
  })

  it('where there is no descriptor a port that is closed while it sleeps is not read', async () => {
    const port = await open({ poller: undefined })
    pace.hint(clock.now() + 1000)
    const read = reading(port)
    await port.close()
    await soon()
    assert.deepEqual([read.end.canceled, clock.pending()], [true, 0])
  })

  it('uses the wrapped read and write where there is no descriptor', async () => {
    const port = await open({ fd: undefined })
    const read = reading(port)
    assert.equal(port.writeNow(Buffer.from('01', 'hex')), 0)
    await port.write(Buffer.from('01', 'hex'))
    await soon()
    assert.deepEqual([log, read.end], [['wrapped 01'], 99])
  })
})
