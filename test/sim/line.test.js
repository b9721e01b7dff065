'use strict'

const assert = require('node:assert')
const { createLine, createVirtualClock, createWire, simulatedDevices } = require('../../lib/sim')
const { bytes, framed, shown } = require('./support')

const all = heard => shown(Buffer.concat(heard))

/** One master on a line in virtual time. */
function listen(settings) {
  const clock = createVirtualClock()
  const line = createLine({ clock, baudRate: 9600, turnaround: 3, quiet: true, chunk: 1, ...settings })
  const heard = []
  const end = line.wire.connect({ data: data => heard.push(data), closed() {} })
  const ask = async frame => {
    heard.length = 0
    end.write(frame)
    await clock.drain()
    await clock.advance(10)
    return all(heard)
  }
  return { ...line, clock, heard, ask }
}

const MIXED = [
  1,
  { device: 'nx', station: 2 },
  { device: 'chino', station: 11 },
  { device: 'chino', station: 12, protocol: 'ascii' }
]

describe('simulated line of mixed stations', () => {
  it('each answers in its own protocol', async () => {
    const { stations, ask } = listen({ stations: MIXED })
    stations[0].set('M0', 0x1234)
    stations[2].set('400001', 0xabcd)
    stations[3].set('400001', 7)
    assert.strictEqual(await ask(framed(1, 0xe2, 0x23, 3, 0xc0, 0, 1)), shown(framed(0xe2, 1, 0xa3, 2, 0x34, 0x12)))
    assert.strictEqual(await ask(framed(11, 3, 0, 0, 0, 1)), shown(framed(11, 3, 2, 0xab, 0xcd)))
    // :0C 03 0000 0001, LRC F0; the answer 0C 03 02 0007, LRC E8
    const answer = await ask(Buffer.from(':0C0300000001F0\r\n'))
    assert.strictEqual(String(bytes(answer)), ':0C03020007E8\r\n')
    assert.deepStrictEqual(
      stations.map(({ counts }) => counts.executed),
      [1, 0, 1, 1]
    )
  })

  it('a regulator answers after 3.5 characters, every byte takes its time', async () => {
    const times = []
    const clock = createVirtualClock()
    const { wire } = createLine({
      clock,
      baudRate: 9600,
      turnaround: 0,
      stations: [{ device: 'chino', station: 11 }],
      chunk: 1
    })
    const end = wire.connect({ data: () => times.push(clock.now()), closed() {} })
    end.write(framed(11, 3, 0, 0, 0, 1))
    await clock.drain()
    const character = 10000 / 9600
    assert.ok(Math.abs(times[0] - (8 + 3.5 + 1) * character) < 1e-6)
    assert.ok(Math.abs(times[6] - (8 + 3.5 + 7) * character) < 1e-6)
  })

  it('a broadcast reaches all regulators, and no answer comes', async () => {
    const { stations, ask } = listen({ device: 'chino', stations: [11, 12, 13] })
    assert.strictEqual(await ask(framed(0, 6, 0, 7, 0, 9)), '')
    assert.deepStrictEqual(
      stations.map(each => each.get('hr7')),
      [9, 9, 9]
    )
  })

  it('live values unless it is quiet', () => {
    const row = { device: 'chino', station: 11 }
    assert.strictEqual(createLine({ stations: [row] }).stations[0].get('400002'), 1000)
    assert.strictEqual(createLine({ stations: [row], quiet: true }).stations[0].get('400002'), 0)
  })

  it('refuses other devices, and errors that a station of it cannot have', () => {
    assert.throws(() => createLine({ stations: [{ device: 'melsec', station: 1 }] }), { code: 'BAD_SETTING' })
    assert.throws(() => createLine({ device: 'toString' }), { code: 'BAD_SETTING' })
    const rates = [{ kind: 'error', rate: 0.1, argument: 6 }]
    assert.throws(() => createLine({ stations: MIXED, rates }), { code: 'BAD_SETTING' })
    createLine({ device: 'chino', stations: [11], rates })
    assert.deepStrictEqual(simulatedDevices(), [
      { device: 'nx', least: 0, most: 191, errors: 5 },
      { device: 'chino', least: 1, most: 247, errors: 255 }
    ])
  })
})

const lrc = body => [...body, -body.reduce((sum, byte) => sum + byte, 0) & 0xff]
const asciiOf = (...body) => Buffer.from(`:${Buffer.from(lrc(body)).toString('hex').toUpperCase()}\r\n`)

/** Two registers are read from station 17; each fault happens to the answer. */
const PROTOCOLS = {
  rtu: { query: framed(17, 3, 0, 0, 0, 2), right: framed(17, 3, 4, 0x12, 0x34, 0xab, 0xcd), make: framed },
  ascii: { query: asciiOf(17, 3, 0, 0, 0, 2), right: asciiOf(17, 3, 4, 0x12, 0x34, 0xab, 0xcd), make: asciiOf }
}
const open = (protocol, settings) => {
  const line = listen({ device: 'chino', stations: [17], protocol, ...settings })
  const [station] = line.stations
  station.set('400001', 0x1234)
  station.set('400002', 0xabcd)
  return { ...line, station }
}
const suffer = async (protocol, kind, argument) => {
  const line = open(protocol)
  line.faults.once(kind, { argument })
  return { ...line, got: bytes(await line.ask(PROTOCOLS[protocol].query)) }
}

for (const [protocol, { query, right, make }] of Object.entries(PROTOCOLS)) {
  describe(`faults of simulated regulators, ${protocol}`, () => {
    it('none', async () => {
      assert.strictEqual(await open(protocol).ask(query), shown(right))
    })

    it('lost, silent, off', async () => {
      for (const [kind, executed] of Object.entries({ lost: 0, silent: 1, off: 0 })) {
        const { got, station } = await suffer(protocol, kind)
        assert.deepStrictEqual([got.length, station.counts.executed], [0, executed], kind)
      }
    })

    it('error: exception n, nothing carried out', async () => {
      const line = open(protocol)
      line.faults.once('error', { argument: 0x0b })
      const write = make(17, 6, 0, 9, 0, 1)
      assert.strictEqual(await line.ask(write), shown(make(17, 0x86, 0x0b)))
      assert.deepStrictEqual([line.station.counts.executed, line.station.writes.size], [0, 0])
    })

    it('crc: exactly n bits of what is on the wire', async () => {
      const { got } = await suffer(protocol, 'crc', 1)
      const bits = [...got].reduce((sum, byte, n) => sum + ((byte ^ right[n]).toString(2).match(/1/g) ?? []).length, 0)
      assert.deepStrictEqual([got.length, bits], [right.length, 1])
    })

    it('truncated, duplicated, before, after, echo', async () => {
      assert.deepStrictEqual((await suffer(protocol, 'truncated', 3)).got, right.subarray(0, -3))
      assert.deepStrictEqual((await suffer(protocol, 'duplicated', 0)).got, Buffer.concat([right, right]))
      assert.deepStrictEqual((await suffer(protocol, 'before', 4)).got.subarray(4), right)
      assert.deepStrictEqual((await suffer(protocol, 'after', 4)).got.subarray(0, right.length), right)
      assert.deepStrictEqual((await suffer(protocol, 'echo')).got, Buffer.concat([query, right]))
    })

    it('merged: the answer before this one follows it', async () => {
      const line = open(protocol)
      await line.ask(query)
      line.station.set('400001', 0)
      line.faults.once('merged')
      const now = make(17, 3, 4, 0, 0, 0xab, 0xcd)
      assert.strictEqual(await line.ask(query), shown(Buffer.concat([now, right])))
    })

    it("foreign: right in form, other data, a number that is nobody's; then the right one", async () => {
      const line = listen({ device: 'chino', stations: [17, 18, 19, 20], protocol })
      for (const [body, keep] of [
        [[17, 3, 0, 0, 0, 2], 3],
        // a copy of it with the number of a station that is there would be a write to that station
        [[17, 6, 0, 9, 0, 1], 2]
      ]) {
        for (let n = 0; n < 20; n++) {
          line.faults.once('foreign')
          const got = bytes(await line.ask(make(...body)))
          const [foreign, own] = [got.subarray(0, got.length / 2), got.subarray(got.length / 2)]
          const plain = frame =>
            protocol === 'rtu' ? frame.subarray(0, -2) : Buffer.from(String(frame).slice(1, -4), 'hex')
          assert.deepStrictEqual(make(...plain(foreign)), foreign)
          assert.ok(plain(foreign)[0] > 20 && plain(foreign)[0] <= 24, String(plain(foreign)[0]))
          assert.deepStrictEqual(plain(foreign).subarray(1, keep), plain(own).subarray(1, keep))
          assert.notDeepStrictEqual(plain(foreign).subarray(keep), plain(own).subarray(keep))
        }
      }
      const [own, ...others] = line.stations.map(({ writes }) => writes.size)
      assert.deepStrictEqual([own, others], [1, [0, 0, 0]])
    })
  })
}

describe('simulated wire: collisions, and timers that come late', () => {
  it('`seen`: what collides differs in its highest bit, once', async () => {
    const clock = createVirtualClock()
    const wire = createWire({ clock, baudRate: 9600, collisions: 'seen' })
    const heard = []
    const ends = [0, 1].map(() => wire.connect({ data() {}, closed() {} }))
    wire.connect({ data: data => heard.push(data), closed() {} })
    ends[0].write(Buffer.from('0123456789'))
    clock.setTimer(() => ends[1].write(Buffer.from('AB')), (4 * 10000) / 9600)
    await clock.drain()
    const text = Buffer.concat(heard)
    const spoilt = text.filter(byte => byte & 0x80).map(byte => byte & 0x7f)
    assert.deepStrictEqual([...String(Buffer.from(spoilt))].sort().join(''), '45AB')
    assert.strictEqual(wire.counts.collisions, 1)
  })

  it('bytes of one sender keep their order, whichever timer comes first', () => {
    const timers = []
    const time = { now: 0 }
    const clock = { now: () => time.now, setTimer: fn => void timers.push(fn) }
    const wire = createWire({ clock, baudRate: 9600, chunk: 1 })
    const heard = []
    wire.add({ station: 1, receive: data => (heard.push(data), []) })
    const end = wire.connect({ data() {}, closed() {} })
    for (const byte of 'ABC') end.write(Buffer.from(byte))
    time.now = 10
    for (const fn of timers.splice(0).reverse()) fn()
    assert.strictEqual(String(Buffer.concat(heard)), 'ABC')
  })
})
