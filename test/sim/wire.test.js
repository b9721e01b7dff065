'use strict'

const assert = require('node:assert')
const { createVirtualClock, createWire, createNxLine } = require('../../lib/sim')
const { bytes, framed, shown } = require('./support')

// vector of the protocol page
const READ_M0_2 = '01 E2 23 03 C0 00 02 58 3C'

describe('simulated wire', () => {
  const QUERY = bytes(READ_M0_2)

  /** One master on a line; what it hears, with the time. */
  function listen(settings) {
    const clock = createVirtualClock()
    const line = createNxLine({ clock, baudRate: 9600, turnaround: 3, quiet: true, ...settings })
    const heard = []
    let closed = 0
    const end = line.wire.connect({ data: data => heard.push([clock.now(), shown(data)]), closed: () => closed++ })
    return { ...line, clock, heard, end, closed: () => closed }
  }
  const all = heard => heard.map(([, text]) => text).join(' ')
  const byteMs = 10000 / 9600

  it('every byte takes its time, both ways', async () => {
    const { clock, heard, end } = listen({ chunk: 4 })
    end.write(QUERY)
    await clock.drain()
    assert.strictEqual(all(heard), shown(framed(0xe2, 1, 0xa3, 4, 0, 0, 0, 0)))
    const times = heard.map(([time]) => time)
    const expected = [4, 8, 10].map(count => (9 + count) * byteMs + 3)
    times.forEach((time, n) => assert.ok(Math.abs(time - expected[n]) < 1e-6, `${time} ${expected[n]}`))
    assert.strictEqual(clock.pending(), 0)
  })

  it('has several stations, and each answers for itself', async () => {
    const { clock, heard, end, plcs } = listen({ stations: [1, 2] })
    plcs[1].set('M0', 2)
    end.write(framed(2, 0xe2, 0x23, 3, 0xc0, 0, 1))
    await clock.drain()
    assert.strictEqual(all(heard), shown(framed(0xe2, 2, 0xa3, 2, 2, 0)))
    assert.deepStrictEqual(
      plcs.map(({ counts }) => counts.executed),
      [0, 1]
    )
  })

  it('bytes written while others still go out follow without a pause', async () => {
    const { clock, heard, end } = listen()
    for (const byte of QUERY) end.write(Buffer.of(byte))
    await clock.drain()
    assert.strictEqual(all(heard), shown(framed(0xe2, 1, 0xa3, 4, 0, 0, 0, 0)))
  })

  it('echoes where the adapter hears itself', async () => {
    const { clock, heard, end } = listen({ echo: true })
    end.write(QUERY)
    await clock.drain()
    assert.strictEqual(all(heard), `${READ_M0_2} ${shown(framed(0xe2, 1, 0xa3, 4, 0, 0, 0, 0))}`)
    assert.ok(Math.abs(heard[0][0] - 9 * byteMs) < 1e-6)
  })

  it('two who answer at once spoil each other', async () => {
    const { clock, heard, end, wire, plcs } = listen({ stations: [1, 2] })
    end.write(framed(0xff, 0xe2, 0x23, 3, 0xc0, 0, 2))
    await clock.drain()
    assert.deepStrictEqual([wire.counts.collisions, plcs[0].counts.executed, plcs[1].counts.executed], [1, 1, 1])
    assert.ok(!all(heard).includes(shown(framed(0xe2, 1, 0xa3, 4, 0, 0, 0, 0))))
  })

  it('two masters hear each other and the answers', async () => {
    const { clock, end, wire } = listen()
    const other = []
    wire.connect({ data: data => other.push([0, shown(data)]), closed: () => {} })
    end.write(QUERY)
    await clock.drain()
    assert.strictEqual(all(other), `${READ_M0_2} ${shown(framed(0xe2, 1, 0xa3, 4, 0, 0, 0, 0))}`)
  })

  it('unplugged: closed once, writes go nowhere, no connection until it is plugged in', async () => {
    const { clock, heard, end, wire, plcs, closed } = listen()
    wire.unplug()
    end.write(QUERY)
    end.close()
    assert.throws(() => wire.connect({ data() {}, closed() {} }), { code: 'PORT_GONE' })
    await clock.drain()
    assert.deepStrictEqual([closed(), heard.length, plcs[0].counts.queries], [1, 0, 0])
    wire.plug()
    wire.connect({ data: data => heard.push([0, shown(data)]), closed() {} }).write(QUERY)
    await clock.drain()
    assert.strictEqual(heard.length, 1)
  })

  it('a station without power is silent', async () => {
    const { clock, heard, end, wire } = listen()
    wire.setOff(1, true)
    end.write(QUERY)
    await clock.drain()
    assert.strictEqual(heard.length, 0)
    wire.setOff(1, false)
    end.write(QUERY)
    await clock.drain()
    assert.strictEqual(heard.length, 1)
  })

  it('is made of parts that can be used alone', () => {
    const wire = createWire({ clock: createVirtualClock(), baudRate: 4800 })
    assert.strictEqual(wire.byteMs, 10000 / 4800)
    assert.deepStrictEqual(wire.stations(), [])
  })
})
