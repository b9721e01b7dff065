'use strict'

const assert = require('node:assert')
const { createFaults, createPeerLine, createRandom, createVirtualClock, createWire } = require('../../lib/sim')

/** A station that says what it is told, and keeps what it hears. */
function speaker(station = 1) {
  const own = { station, heard: '', calls: 0, send: /** @type {any} */ (null), port: /** @type {any} */ (null) }
  return Object.assign(own, {
    speak(send, port) {
      own.calls++
      Object.assign(own, { send, port })
    },
    receive(bytes) {
      own.heard += bytes
      return []
    },
    disguise: bytes => Buffer.alloc(bytes.length, 0x3f)
  })
}

function setUp(settings = {}) {
  const clock = createVirtualClock()
  const wire = createWire({ clock, baudRate: 10000, ...settings })
  const station = speaker()
  wire.add(station)
  const heard = []
  const cts = []
  const end = wire.connect({
    data: data => heard.push([clock.now(), String(data)]),
    closed: () => {},
    cts: on => cts.push(on)
  })
  return { clock, wire, station, heard, cts, end, all: () => heard.map(([, text]) => text).join('') }
}

describe('simulated wire: stations that speak by themselves', () => {
  it('are given `send` once; it says when the last byte has passed', async () => {
    const { clock, station, heard } = setUp()
    assert.strictEqual(station.send(Buffer.from('HELLO')), 5)
    assert.strictEqual(station.send(Buffer.from('YOU')), 8)
    await clock.drain()
    assert.deepStrictEqual(heard, [
      [5, 'HELLO'],
      [8, 'YOU']
    ])
    assert.strictEqual(station.calls, 1)
  })
  it('half duplex: both at once are spoilt; full duplex: both arrive', async () => {
    const run = async duplex => {
      const { clock, wire, station, end, all } = setUp({ duplex })
      end.write(Buffer.from('DOWN'))
      station.send(Buffer.from('UP!!'))
      await clock.drain()
      return [station.heard, all(), wire.counts.collisions]
    }
    assert.deepStrictEqual(await run('full'), ['DOWN', 'UP!!', 0])
    const [down, up, collisions] = await run('half')
    assert.ok(down !== 'DOWN' && up !== 'UP!!')
    assert.strictEqual(collisions, 1)
  })
  it('full duplex: stations do not hear each other, nor masters each other; noise is heard by all', async () => {
    const { clock, wire, station, end, all } = setUp({ duplex: 'full' })
    const other = speaker(2)
    wire.add(other)
    let second = ''
    wire.connect({ data: data => (second += data), closed: () => {} })
    station.send(Buffer.from('A'))
    end.write(Buffer.from('B'))
    await clock.drain()
    assert.deepStrictEqual([station.heard, other.heard, all(), second], ['B', 'B', 'A', 'A'])
    wire.noise(Buffer.from('~'))
    await clock.drain()
    assert.deepStrictEqual([station.heard, other.heard, all(), second], ['B~', 'B~', 'A~', 'A~'])
  })
  it('full duplex without collisions: only the same way is waited for', async () => {
    const { clock, station, end, heard } = setUp({ duplex: 'full', collisions: false })
    end.write(Buffer.from('0123456789'))
    station.send(Buffer.from('X'))
    await clock.drain()
    assert.deepStrictEqual(heard, [[1, 'X']])
  })
  it('without power, or removed, nothing goes out', async () => {
    const { clock, wire, station, all } = setUp()
    wire.setOff(1, true)
    assert.strictEqual(station.send(Buffer.from('A')), 0)
    wire.setOff(1, false)
    wire.remove(1)
    station.send(Buffer.from('B'))
    await clock.drain()
    assert.strictEqual(all(), '')
  })
  it('a station that can react to any byte hears no more at once than it says', async () => {
    const { clock, wire, end } = setUp()
    const pieces = []
    wire.remove(1)
    wire.add({ ...speaker(2), appetite: () => 3, receive: bytes => pieces.push([clock.now(), bytes.length]) && [] })
    end.write(Buffer.from('01234567'))
    await clock.drain()
    assert.deepStrictEqual(pieces, [
      [3, 3],
      [6, 3],
      [8, 2]
    ])
  })

  it('and also where one frame follows another without a pause', async () => {
    const { clock, wire, end } = setUp()
    let room = 10
    const pieces = []
    wire.remove(1)
    const receive = bytes => {
      room -= bytes.length
      pieces.push([clock.now(), room])
      return []
    }
    wire.add({ ...speaker(2), appetite: () => Math.max(1, room), receive })
    end.write(Buffer.from('0123456'))
    end.write(Buffer.from('0123456'))
    await clock.drain()
    // the end of the room is seen when it comes
    assert.ok(
      pieces.some(([at, left]) => at === 10 && left === 0),
      JSON.stringify(pieces)
    )
  })

  describe('faults of what they say', () => {
    const cases = [
      ['lost', undefined, 'FIRST'],
      ['silent', undefined, 'FIRST'],
      ['error', 2, 'FIRSTSECOND'],
      ['truncated', 2, 'FIRSTSECO'],
      ['duplicated', 0, 'FIRSTSECONDSECOND'],
      ['merged', undefined, 'FIRSTSECONDFIRST'],
      ['foreign', undefined, 'FIRST??????SECOND'],
      ['echo', undefined, 'FIRSTSECOND']
    ]
    for (const [kind, argument, expected] of cases) {
      it(`${kind}: ${expected}`, async () => {
        const faults = createFaults({ random: createRandom(1) })
        const { clock, station, all } = setUp({ faults })
        station.send(Buffer.from('FIRST'))
        faults.once(String(kind), { argument: /** @type {any} */ (argument) })
        station.send(Buffer.from('SECOND'))
        await clock.drain()
        assert.strictEqual(all(), expected)
      })
    }
    it('late: by as much; off: dark for as long', async () => {
      const faults = createFaults()
      const { clock, station, heard } = setUp({ faults })
      faults.once('late', { argument: 100 })
      assert.strictEqual(station.send(Buffer.from('A')), 101)
      faults.once('off', { argument: 500 })
      station.send(Buffer.from('B'))
      await clock.advance(499)
      station.send(Buffer.from('C'))
      await clock.advance(2)
      station.send(Buffer.from('D'))
      await clock.drain()
      assert.deepStrictEqual(heard, [
        [101, 'A'],
        [502, 'D']
      ])
    })
    it('what is no message suffers none', async () => {
      const faults = createFaults({ rates: [{ kind: 'silent', rate: 1 }] })
      const { clock, station, all } = setUp({ faults })
      station.send(Buffer.from('A'))
      station.send(Buffer.from('B'), { faults: false })
      await clock.drain()
      assert.deepStrictEqual([all(), station.port.faulty(Buffer.from('C'))], ['B', []])
    })
  })

  it('CTS: what the station’s DTR says, at first only if it is off, and off without power', () => {
    const { wire, station, cts } = setUp()
    station.port.cts(true)
    assert.deepStrictEqual(cts, [])
    station.port.cts(false)
    station.port.cts(false)
    const late = []
    wire.connect({ data: () => {}, closed: () => {}, cts: on => late.push(on) })
    station.port.cts(true)
    wire.setOff(1, true)
    wire.setOff(1, false)
    assert.deepStrictEqual(cts, [false, true, false, true])
    assert.deepStrictEqual(late, [false, true, false, true])
  })

  it('wear: single bytes are damaged or lost both ways, at their rates', async () => {
    const count = 20000
    const run = async wear => {
      const { clock, station, end, all } = setUp({ duplex: 'full', wear, random: createRandom(5) })
      end.write(Buffer.alloc(count, 0x41))
      station.send(Buffer.alloc(count, 0x41))
      await clock.drain()
      return [station.heard, all()].map(text => ({ lost: count - text.length, damaged: text.replace(/A/g, '').length }))
    }
    for (const { lost, damaged } of await run({ lost: 0.01, damaged: 0.02 })) {
      // five standard deviations: 70, 99
      assert.ok(Math.abs(lost - 200) < 70 && Math.abs(damaged - 400) < 99, `${lost} ${damaged}`)
    }
    assert.deepStrictEqual(await run(null), Array(2).fill({ lost: 0, damaged: 0 }))
  })
})

describe('a line with one device that speaks', () => {
  it('c24: full duplex, at the speed of the wire; incon: half duplex', async () => {
    const clock = createVirtualClock()
    const settings = { program: 'echo', end: '0A' }
    const { wire, device } = createPeerLine({ device: 'c24', settings, baudRate: 9600, clock })
    let heard = ''
    const end = wire.connect({ data: data => (heard += data), closed: () => {} })
    end.write(Buffer.from('ABC\n'))
    await clock.drain()
    assert.deepStrictEqual([heard, device.settings.baudRate], ['ABC\n', 9600])
    const incon = createPeerLine({ device: 'incon', settings: { answer: 'echo' }, clock })
    const text = []
    incon.wire.connect({ data: data => text.push(data), closed: () => {} }).write(Buffer.from('O1\r\n'))
    await clock.drain()
    assert.strictEqual(String(Buffer.concat(text)), 'O1\r\n')
    const wrong = /** @type {any} */ ({ device: 'fax' })
    assert.throws(() => createPeerLine(wrong), { code: 'BAD_SETTING' })
  })
  it('faults and wear come from the seed', async () => {
    const run = async seed => {
      const clock = createVirtualClock()
      const line = { rates: [{ kind: 'crc', rate: 0.5 }], wear: { lost: 0.05 }, seed, clock }
      const { wire, device, faults } = createPeerLine({ device: 'c24', ...line })
      const heard = []
      wire.connect({ data: data => heard.push(data), closed: () => {} })
      for (let n = 0; n < 50; n++) device.send(`MESSAGE ${n}`)
      await clock.drain()
      return [Buffer.concat(heard).toString('latin1'), faults.counts.crc]
    }
    const first = await run(3)
    assert.deepStrictEqual(await run(3), first)
    assert.notStrictEqual((await run(4))[0], first[0])
    assert.ok(Number(first[1]) > 10 && Number(first[1]) < 40)
  })
})
