'use strict'

const assert = require('node:assert/strict')
const { lineSettings } = require('../../../lib/line')
const { simulated } = require('../../../lib/line/transports/memory')
const { createVirtualClock } = require('../../../lib/sim/clock')

/** 9600 8N1: ten bits. */
const CHARACTER = 10000 / 9600
const text = length => 'abcdefghijklmnopqrstuvwxyz0123456789'.slice(0, length)

/** A transport over a wire of the test; `log`: what happened, with the character at which it did. */
const create = (extra = {}, connect = () => {}) => {
  const clock = createVirtualClock()
  const log = []
  const say = what => log.push(`${Math.round(clock.now() / CHARACTER)} ${what}`)
  const wire = {
    connect(handlers) {
      connect()
      wire.far = handlers
      return { write: bytes => say(`wire ${bytes}`), close: () => say('wire closed') }
    }
  }
  const settings = lineSettings({ transport: 'simulated', wire, baudRate: 9600, ...extra })
  const transport = simulated(settings, clock)
  const open = () =>
    transport.open({
      opened: () => say('opened'),
      data: bytes => say(`data ${bytes}`),
      closed: error => say(`closed ${error.code} ${error.details.path}`),
      failed: error => say(`failed ${error.message}`)
    })
  const write = (bytes, what = 'written') =>
    transport.write(Buffer.from(bytes), error => say(error ? `${error.code} ${error.details.path}` : what))
  const close = () => transport.close(() => say('closed'))
  const pass = characters => clock.advance(characters * CHARACTER)
  return { clock, wire, log, transport, open, write, close, pass }
}
const opened = async extra => {
  const bench = create(extra)
  bench.open()
  await bench.pass(0)
  assert.deepEqual(bench.log.splice(0), ['0 opened'])
  return bench
}

describe('wire in memory', () => {
  it('opens behind the call, carries bytes both ways at once, closes its end', async () => {
    const bench = create()
    bench.open()
    assert.deepEqual(bench.log, [])
    await bench.pass(0)
    bench.write('ask')
    bench.wire.far.data(Buffer.from('answer'))
    bench.close()
    bench.close()
    assert.deepEqual(bench.log, [
      '0 opened',
      '0 wire ask',
      '0 written',
      '0 data answer',
      '0 wire closed',
      '0 closed',
      '0 closed'
    ])
  })

  it('is claimed by its wire, and there is nothing to be told it', () => {
    const { transport, wire } = create()
    assert.equal(transport.id(), wire)
    transport.hint()
  })

  it('a wire that does not take the connection: failed, and nothing else', async () => {
    const bench = create({}, () => {
      throw new Error('no')
    })
    bench.open()
    await bench.pass(1)
    bench.write('A')
    assert.deepEqual(bench.log, ['0 failed no', '1 PORT_GONE simulated'])
  })

  it('closed before it was opened, it is not opened any more', async () => {
    const bench = create()
    bench.open()
    bench.close()
    await bench.pass(5)
    assert.deepEqual([bench.log, bench.clock.pending()], [['0 closed'], 0])
  })

  it('pulled: told once, under the name of the port; nothing is written then', async () => {
    for (const [path, name] of [
      ['', 'simulated'],
      ['COM7', 'COM7']
    ]) {
      const bench = await opened({ path })
      bench.wire.far.closed()
      bench.write('A')
      bench.close()
      assert.deepEqual(bench.log, [`0 closed PORT_GONE ${name}`, `0 PORT_GONE ${name}`, '0 closed'])
    }
  })

  it('without flow control the other side stops nothing', async () => {
    const bench = await opened()
    bench.wire.far.cts(false)
    bench.write('A')
    assert.deepEqual(bench.log, ['0 wire A', '0 written'])
  })
})

describe('wire in memory: with RTS/CTS', () => {
  const rtscts = { flowControl: 'rtscts' }

  it('sixteen bytes leave at a time, as fast as the wire is; written is what has left', async () => {
    const bench = await opened(rtscts)
    bench.write(text(36))
    await bench.pass(35)
    assert.deepEqual(bench.log.splice(0), ['0 wire abcdefghijklmnop', '16 wire qrstuvwxyz012345', '32 wire 6789'])
    await bench.pass(1)
    assert.deepEqual([bench.log, bench.clock.pending()], [['36 written'], 0])
  })

  it('one write after the other', async () => {
    const bench = await opened(rtscts)
    bench.write('ab', 'first')
    bench.write('cde', 'second')
    await bench.pass(20)
    assert.deepEqual(
      [...bench.log].sort(),
      ['0 wire ab', '2 first', '2 wire cde', '5 second'].sort(),
      'the second waits for the first'
    )
  })

  it('off: what is in the adapter leaves, the rest waits until it is on', async () => {
    const bench = await opened(rtscts)
    bench.write(text(20))
    await bench.pass(3)
    bench.wire.far.cts(false)
    await bench.pass(100)
    assert.deepEqual([bench.log.splice(0), bench.clock.pending()], [['0 wire abcdefghijklmnop'], 0])
    bench.write('X', 'X')
    bench.wire.far.cts(true)
    bench.wire.far.cts(true)
    await bench.pass(10)
    assert.deepEqual(bench.log.sort(), ['103 wire qrst', '107 wire X', '107 written', '108 X'])
  })

  it('off and on while the adapter is busy costs nothing, and doubles nothing', async () => {
    const bench = await opened(rtscts)
    bench.write(text(20))
    await bench.pass(3)
    bench.wire.far.cts(false)
    bench.wire.far.cts(true)
    await bench.pass(30)
    assert.deepEqual(bench.log, ['0 wire abcdefghijklmnop', '16 wire qrst', '20 written'])
  })

  it('bytes that the writer changes afterwards leave as they were', async () => {
    const bench = await opened(rtscts)
    bench.wire.far.cts(false)
    const bytes = Buffer.from('AB')
    bench.transport.write(bytes, () => {})
    bytes.fill(0x7a)
    bench.wire.far.cts(true)
    assert.deepEqual(bench.log, ['0 wire AB'])
  })

  for (const [how, end] of /** @type {[string, (bench: any) => void][]} */ ([
    ['closed', bench => bench.close()],
    ['pulled', bench => bench.wire.far.closed()]
  ])) {
    it(`${how}: what waits is dropped, no timer is left, and the next opening begins anew`, async () => {
      const bench = await opened(rtscts)
      bench.write(text(20), 'never')
      end(bench)
      assert.equal(bench.clock.pending(), 0)
      bench.wire.far.cts(true)
      await bench.pass(50)
      bench.log.splice(0)
      bench.open()
      await bench.pass(0)
      bench.write('new')
      await bench.pass(3)
      assert.deepEqual(bench.log, ['50 opened', '50 wire new', '53 written'])
    })
  }
})
