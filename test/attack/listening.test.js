'use strict'

const assert = require('node:assert/strict')
const { createC24Port, createInconLink, createPool } = require('../../lib')
const { createRandom, createVirtualClock } = require('../../lib/sim')
const { c24Bench } = require('../device/c24-bench')
const { inconBench } = require('../device/incon-bench')
const { createWire } = require('../line/support/bench')

/** Far more than any of these calls needs, and far less than the seconds that each of them once took. */
const MOST = 500

/** ms of processor time until it settles: a busy machine does not lengthen it. */
const blocked = async work => {
  const start = process.cpuUsage()
  await work()
  const { user, system } = process.cpuUsage(start)
  return (user + system) / 1000
}

const longOnPaper = () => {
  const payload = []
  payload.length = 2e7
  return payload
}

const PORTS = {
  'C24, text': () => c24Bench(),
  'C24, EUC-KR': () => c24Bench({ port: { encoding: 'euc-kr' } }),
  'C24, bytes': () => c24Bench({ port: { format: 'bytes' } }),
  'C24, words': () => c24Bench({ port: { format: 'words' } }),
  'C24, bidirectional': () => c24Bench({ port: { bidirectional: true } }),
  INCON: () => inconBench(),
  'INCON, UTF-8': () => inconBench({ link: { encoding: 'utf8' } })
}

describe('attack: hostile payloads for what is sent as messages', () => {
  // 3 s and a gigabyte each, and the end of the process from 4e9 on: all of it was copied, or stood in the error's text
  for (const [name, open] of Object.entries(PORTS)) {
    it(`${name}: what is far too long is refused at once`, async () => {
      const b = open()
      await b.clock.advance(5)
      const values = [longOnPaper(), new Float64Array(1e6), new Uint16Array(1e6), '가'.repeat(1e6), new Uint8Array(1e6)]
      for (const value of values) {
        let outcome
        const ms = await blocked(async () => (outcome = await b.run(b.device.send(value))))
        assert.equal(outcome.outcome, 'refused')
        assert.match(outcome.code, /^(FRAME_TOO_LONG|BAD_VALUE)$/)
        assert.ok(ms < MOST, `${ms} ms`)
      }
      await b.close()
    })

    it(`${name}: what is no message is refused, and nothing goes out`, async () => {
      const b = open()
      await b.clock.advance(5)
      const values = [
        ...[Symbol('x'), 1n, [1n], [NaN], [1.5], ['1'], [[1]], new Array(3), null, undefined, true, NaN, Infinity],
        ...[{ length: 1 }, JSON.parse('{"__proto__":[65]}'), Object.create(null), new Date(0), () => 65],
        ...[new DataView(new ArrayBuffer(4)), new ArrayBuffer(4), new BigInt64Array(1), new Float32Array([NaN])],
        ...(name === 'C24, text' ? [] : ['\ud800'])
      ]
      for (const [n, value] of values.entries()) {
        const { outcome, code } = await b.run(b.device.send(value))
        assert.deepEqual([outcome, code], ['refused', 'BAD_VALUE'], `value ${n}`)
      }
      assert.equal(b.lease.line.stats().bytesOut ?? 0, 0)
      await b.close()
    })
  }
})

describe('attack: a line that was cut off before a redeploy', () => {
  const cut = async (baudRate, after) => {
    const clock = createVirtualClock()
    const wire = createWire(clock)
    const pool = createPool({ clock, random: () => 0.5 })
    const open = () => {
      const lease = pool.open({ transport: 'simulated', wire, baudRate }, { id: 'a', name: 'a' })
      return { lease, link: createInconLink({ lease, clock }) }
    }
    const first = open()
    await clock.advance(10)
    const torn = first.link.send('O1234'.padEnd(200, ' '))
    await clock.advance(after)
    return { clock, wire, open, first, torn }
  }
  const texts = wire => wire.sent.slice(1).map(({ bytes }) => bytes.toString('latin1'))

  // the next line was glued to what the controller held of the first one: "O12" and "O99" CR LF were O12O99
  it('INCON: unplugged, then deployed: the cut line is ended before the next one', async () => {
    const { clock, wire, open, first, torn } = await cut(9600, 3)
    wire.unplug()
    assert.equal((await clock.run(torn)).outcome, 'unknown')
    first.link.close()
    await clock.run(first.lease.release())
    const second = open()
    await clock.advance(10)
    const outcomes = await clock.run(Promise.all([second.link.send('O99'), second.link.send('O98')]))
    assert.deepEqual(texts(wire), ['?\r\n', 'O99\r\n', 'O98\r\n'])
    assert.deepEqual(
      outcomes.map(({ outcome, bytes }) => [outcome, bytes]),
      [
        ['sent', 5],
        ['sent', 5]
      ]
    )
    // each apart, as the PLC needs it
    const [, end, next] = wire.sent.map(({ at }) => at)
    assert.ok(next - end >= 50, `${next - end} ms`)
    second.link.close()
    await clock.run(second.lease.release())
  })

  it('INCON: also if the next line waits already while the port is being closed', async () => {
    const { clock, wire, open, first, torn } = await cut(1200, 100)
    first.link.close()
    const released = first.lease.release()
    const second = open()
    const next = second.link.send('O99')
    await clock.run(Promise.all([released, torn]))
    assert.equal((await clock.run(next)).outcome, 'sent')
    assert.deepEqual(texts(wire), ['?\r\n', 'O99\r\n'])
    second.link.close()
    await clock.run(second.lease.release())
    assert.equal(clock.pending(), 0)
  })

  it('INCON: lost again while the cut line is being ended: it is ended once more', async () => {
    const { clock, wire, first, torn } = await cut(9600, 3)
    wire.unplug()
    await clock.run(torn)
    await clock.advance(2000)
    const lost = first.link.send('O99')
    clock.setTimer(() => wire.unplug(), 8)
    const { outcome, bytes } = await clock.run(lost)
    assert.deepEqual([outcome, bytes], ['failed', 0])
    await clock.advance(5000)
    assert.equal((await clock.run(first.link.send('O98'))).outcome, 'sent')
    assert.deepEqual(texts(wire), ['?\r\n', '?\r\n', 'O98\r\n'])
    first.link.close()
    await clock.run(first.lease.release())
    assert.equal(clock.pending(), 0)
  })
})

/** ENQ, length in words, data, sum: made here, not by the codec. */
const frame = text => {
  const section = [text.length / 2, 0, ...Buffer.from(text)]
  const sum = section.reduce((a, b) => a + b, 0)
  return Buffer.from([5, ...section, sum & 255, sum >> 8])
}

describe('attack: CTS that is never released', () => {
  // 05 01 00 41 42 84 00 again and again: a thousand ACKs waited in the port, and all would have gone out at once, an hour late
  it('does not collect acknowledgements without end', async () => {
    const clock = createVirtualClock()
    let end
    let kept = 0
    const transport = () => ({
      open(handlers) {
        end = handlers
        clock.setTimer(() => handlers.opened(), 1)
      },
      write: () => void kept++,
      hint() {},
      close: done => done(),
      id: () => 'the port'
    })
    const pool = createPool({ clock, random: () => 0.5, transports: { serial: transport } })
    const line = { transport: 'serial', path: '/dev/ttyS0', flowControl: 'rtscts' }
    const lease = pool.open(line, { id: 'a', name: 'a' })
    const port = createC24Port({ lease, clock, bidirectional: true, flow: 'driver' })
    let received = 0
    port.listen(() => received++)
    await clock.advance(10)
    for (let n = 0; n < 200; n++) {
      end.data(frame('AB'))
      await clock.advance(1000)
    }
    assert.equal(received, 200)
    assert.ok(kept <= 16, `${kept} acknowledgements in the port`)
    // over a new connection they are sent again
    end.closed(null)
    await clock.advance(5000)
    kept = 0
    end.data(frame('CD'))
    assert.equal(kept, 1)
    port.close()
    await clock.run(lease.release())
    assert.equal(clock.pending(), 0)
  })
})

describe('attack: a message that waits behind one that is not answered', () => {
  // it was told 5 s after its 100 ms had passed
  it('bidirectional: its deadline is told when it has passed', async () => {
    const b = c24Bench({ port: { bidirectional: true, ackTimeout: 5000 } })
    await b.clock.advance(5)
    const first = b.device.send('AB')
    const { outcome, code, attempts, ms } = await b.send('CD', { deadline: 100 })
    assert.deepEqual([outcome, code, attempts, Math.round(ms)], ['failed', 'DEADLINE', 0, 100])
    const last = b.device.send('EF')
    await b.clock.run(first)
    // and that of the late answer of the first one
    await b.clock.advance(6000)
    assert.match(b.peer.hex(), /^050100414284000501004546/)
    await b.close()
    assert.equal((await last).outcome, 'unknown')
    assert.equal(b.clock.pending(), 0)
  })
})

/**
 * The other side by the wire's own time: what was on its way when the wire was lost never arrives. Cuts what it has heard as the real one does: at its
 * end code, and by a silence (timer 0).
 */
const listeningPeer = (clock, baudRate) => {
  const character = 10000 / baudRate
  const heard = []
  let end = null
  let free = 0
  return {
    connect(handlers) {
      end = handlers
      return {
        write(bytes) {
          for (const byte of bytes) {
            free = Math.max(free, clock.now()) + character
            heard.push({ byte, at: free })
          }
        },
        close: () => void (end = null)
      }
    },
    unplug() {
      const now = clock.now()
      while (heard.at(-1)?.at > now) heard.pop()
      free = 0
      end?.closed()
    },
    /** @param {string} marker @param {number} silence ms after which what was held is dropped; 0: never */
    messages(marker, silence) {
      const messages = []
      let text = ''
      let last = 0
      for (const { byte, at } of heard) {
        if (silence > 0 && at - last > silence) text = ''
        last = at
        text += String.fromCharCode(byte)
        if (!text.endsWith(marker)) continue
        messages.push(text.slice(0, -marker.length))
        text = ''
      }
      return messages
    }
  }
}

const KINDS = {
  'C24, timer 0': { make: createC24Port, own: { timer0: 50 }, marker: '\r\n', silence: 50, whole: /^M\d{8}$/ },
  'C24, tornEnd': {
    make: createC24Port,
    own: { tornEnd: true },
    marker: '\r\n',
    silence: 0,
    whole: /^(M\d{8}|M?\d*\r?)$/
  },
  'C24, frames': {
    make: createC24Port,
    own: { first: '28', last: '29' },
    marker: ')',
    silence: 0,
    whole: /\(M\d{8}$/
  },
  'C24, DC1/DC3': {
    make: createC24Port,
    own: { timer0: 50, flow: 'dc' },
    marker: '\r\n',
    silence: 50,
    whole: /^M\d{8}$/
  },
  INCON: { make: createInconLink, own: {}, marker: '\r\n', silence: 0, whole: /^(M\d{8}|M?\d*\r?\??)$/ }
}

describe('attack: unplugged or deployed at any moment of a message', () => {
  const run = async ({ make, own, marker, silence }, { at, unplug, deploy }) => {
    const clock = createVirtualClock()
    const wire = listeningPeer(clock, 9600)
    const pool = createPool({ clock, random: () => 0.5 })
    const open = () => {
      const lease = pool.open({ transport: 'simulated', wire, baudRate: 9600 }, { id: 'a', name: 'a' })
      return { lease, port: make({ lease, clock, ...own }) }
    }
    const settled = new Map()
    const send = (port, text) =>
      port.send(text).then(({ outcome }) => settled.set(text, [...(settled.get(text) ?? []), outcome]))
    let user = open()
    await clock.advance(10)
    const sending = ['M10000001', 'M20000002'].map(text => send(user.port, own.last ? text.padEnd(10) : text))
    await clock.advance(at)
    if (unplug) wire.unplug()
    if (deploy) {
      user.port.close()
      const released = user.lease.release()
      user = open()
      await clock.run(released)
    }
    await clock.run(Promise.all(sending))
    await clock.advance(10000)
    const last = own.last ? 'M30000003 ' : 'M30000003'
    await clock.run(send(user.port, last))
    await clock.advance(200)
    user.port.close()
    await clock.run(user.lease.release())
    assert.deepEqual([clock.pending(), pool.lines().length], [0, 0])
    return { settled, seen: wire.messages(marker, silence), last }
  }

  for (const [name, kind] of Object.entries(KINDS)) {
    it(`${name}: one outcome each, none twice, none glued to another`, async () => {
      for (const how of [{ unplug: true }, { deploy: true }, { unplug: true, deploy: true }]) {
        for (let at = 0; at < (name === 'INCON' ? 80 : 30); at += name === 'INCON' ? 1.9 : 0.9) {
          const { settled, seen, last } = await run(kind, { ...how, at })
          const where = `${JSON.stringify(how)} at ${at}: ${JSON.stringify([...settled, seen])}`
          assert.equal(settled.size, 3, where)
          for (const [text, outcomes] of settled) {
            const copies = seen.filter(message => message.includes(text.trim())).length
            assert.equal(outcomes.length, 1, where)
            assert.ok(copies <= 1, where)
            if (outcomes[0] === 'sent') assert.equal(copies, 1, where)
            if (outcomes[0] === 'failed') assert.equal(copies, 0, where)
          }
          assert.deepEqual(settled.get(last), ['sent'], where)
          for (const message of seen) assert.match(message.trimEnd(), kind.whole, where)
        }
      }
    })
  }
})

describe('attack: a redeploy right behind a message', () => {
  const redeployed = async (make, own, text) => {
    const clock = createVirtualClock()
    const wire = createWire(clock)
    const pool = createPool({ clock, random: () => 0.5 })
    const open = () => {
      const lease = pool.open({ transport: 'simulated', wire, baudRate: 9600 }, { id: 'a', name: 'a' })
      return { lease, port: make({ lease, clock, ...own }) }
    }
    const first = open()
    await clock.advance(10)
    const sending = first.port.send(text)
    await clock.advance(own.bidirectional ? 20 : 4)
    first.port.close()
    await clock.run(Promise.all([first.lease.release(), sending]))
    return { clock, wire, ...open() }
  }

  // in 400 real redeploys the controller once took 1795326865681 CR LF 1795326865692 for one message
  for (const [name, make, own, least] of [
    ['INCON', createInconLink, {}, 50],
    ['C24, messages by silence', createC24Port, { framing: 'gap', gap: 100 }, 100]
  ]) {
    it(`${name}: the next one keeps its distance all the same`, async () => {
      const { clock, wire, port, lease } = await redeployed(make, own, 'ABCD')
      assert.equal((await clock.run(port.send('EFGH'))).outcome, 'sent')
      const [one, two] = wire.sent
      const end = one.at + (one.bytes.length * 10000) / 9600
      assert.ok(two.at - end >= least - 0.01, `${two.at - end} ms`)
      port.close()
      await clock.run(lease.release())
      assert.equal(clock.pending(), 0)
    })
  }

  // ENQ AB, redeploy, ENQ CD, and 06 for AB: CD was confirmed
  it('bidirectional: the late ACK of the one before confirms nothing', async () => {
    const { clock, wire, port, lease } = await redeployed(createC24Port, { bidirectional: true }, 'AB')
    clock.setTimer(() => wire.handlers.data(Buffer.of(6)), 40)
    const { outcome } = await clock.run(port.send('CD'))
    assert.deepEqual([outcome, wire.sent.length], ['unknown', 2])
    port.close()
    await clock.run(lease.release())
    assert.equal(clock.pending(), 0)
  })
})

describe('attack: the wall clock is set back while an acknowledgement is awaited', () => {
  // the frame that the module sent 500 ms later counted as sent at the same time: ours was sent again, and came twice
  it('c24 has priority: a frame that came later is no crossing', async () => {
    const b = c24Bench({ port: { bidirectional: true, priority: 'c24' } })
    await b.clock.advance(5)
    const { wall } = b.clock
    b.clock.setTimer(() => (b.clock.wall = () => wall() - 3600000), 100)
    b.peer.sayIn(500, frame('XY'))
    const { outcome, attempts } = await b.send('AB')
    assert.deepEqual([outcome, attempts, b.values()], ['unknown', 1, ['XY']])
    assert.equal(b.peer.hex(), '0501004142840006')
    await b.close()
  })
})

/** Collects what nobody needs, so that what is left can be measured. */
const collectGarbage = () => {
  require('node:v8').setFlagsFromString('--expose-gc')
  require('node:vm').runInNewContext('gc')()
  const { heapUsed, external } = process.memoryUsage()
  return heapUsed + external
}

describe('attack: floods', () => {
  const block = (hex, length = 65536) => Buffer.alloc(length, Buffer.from(hex, 'hex'))
  const noise = createRandom(7)
  const FLOODS = {
    noise: Buffer.from(Array.from({ length: 65536 }, () => noise.integer(0, 255))),
    DC3: block('13'),
    'DC3 and DC1': block('1311'),
    ENQ: block('05'),
    'ENQ and the greatest length': block(`05FFFF${'41'.repeat(300)}`),
    ACK: block('06'),
    'ACK and ENQ': block('0605'),
    NAK: block('15'),
    'text without end': block('41')
  }
  const inconAlone = () => {
    const clock = createVirtualClock()
    const wire = createWire(clock)
    const pool = createPool({ clock, random: () => 0.5 })
    const lease = pool.open({ transport: 'simulated', wire }, { id: 'a', name: 'a' })
    const device = createInconLink({ lease, clock })
    const got = []
    device.listen(message => got.push(message))
    const close = () => {
      device.close()
      return clock.run(lease.release())
    }
    return { clock, got, close, peer: { say: bytes => wire.handlers.data(bytes), heard: [] } }
  }
  const OPENS = {
    'C24, end code': [() => c24Bench({ port: { flow: 'dc', transparent: '10' } }), Buffer.from('OK\r\n')],
    'C24, frames': [() => c24Bench({ port: { first: '02', last: '03' } }), Buffer.from('\x02OK\x03')],
    'C24, bidirectional': [() => c24Bench({ port: { bidirectional: true } }), frame('OK')],
    INCON: [inconAlone, Buffer.from('OK\r\n')]
  }
  for (const [name, [open, good]] of Object.entries(OPENS)) {
    it(`${name}: nothing grows, and after a silence all is as before`, async () => {
      const b = open()
      await b.clock.advance(5)
      const before = collectGarbage()
      for (const [kind, bytes] of Object.entries(FLOODS)) {
        for (let n = 0; n < 2; n++) {
          b.peer.say(bytes)
          await b.clock.advance(1)
        }
        // the first one may end what the flood has begun
        for (let n = 0; n < 2; n++) {
          await b.clock.advance(1000)
          b.peer.say(good)
        }
        assert.deepEqual([b.got.at(-1).value, b.got.at(-1).complete], ['OK', true], kind)
        b.peer.heard.length = 0
        b.got.length = 0
      }
      const grown = collectGarbage() - before
      assert.ok(grown < 10e6, `${grown} bytes`)
      await b.close()
      assert.equal(b.clock.pending(), 0)
    })
  }
})

describe('attack: unplugged or deployed at any moment of an acknowledged message', () => {
  const FRAME = 13 // ENQ, length, 8 characters, sum

  /** A module with timer 0 that answers what came whole, 20 ms later and whoever listens then. */
  const module = clock => {
    const taken = []
    let end = null
    let bytes = []
    let coming = []
    const take = byte => {
      bytes.push(byte)
      if (bytes.length < FRAME) return
      taken.push(Buffer.from(bytes.slice(3, 11)).toString())
      bytes = []
      clock.setTimer(() => end?.data(Buffer.of(6)), 20)
    }
    return {
      taken,
      connect(handlers) {
        end = handlers
        const arrive = (byte, n) => coming.push(clock.setTimer(() => take(byte), ((n + 1) * 10000) / 9600))
        return { write: out => out.forEach(arrive), close: () => void (end = null) }
      },
      unplug() {
        coming.forEach(clock.clearTimer)
        coming = []
        bytes = []
        end?.closed()
        end = null
      }
    }
  }

  for (const own of [{}, { priority: 'c24' }, { attempts: 1 }]) {
    it(`${JSON.stringify(own)}: none twice, and confirmed is what was taken`, async () => {
      for (const how of [{ unplug: true }, { deploy: true }, { unplug: true, deploy: true }]) {
        for (let at = 0; at < 75; at += 2.3) {
          const clock = createVirtualClock()
          const wire = module(clock)
          const pool = createPool({ clock, random: () => 0.5 })
          const open = () => {
            const lease = pool.open({ transport: 'simulated', wire, baudRate: 9600 }, { id: 'a', name: 'a' })
            return { lease, port: createC24Port({ lease, clock, bidirectional: true, ...own }) }
          }
          let user = open()
          await clock.advance(10)
          const sending = ['MESSAGE1', 'MESSAGE2'].map(text => user.port.send(text))
          await clock.advance(at)
          if (how.unplug) wire.unplug()
          if (how.deploy) {
            user.port.close()
            const released = user.lease.release()
            user = open()
            await clock.run(released)
          }
          const outcomes = await clock.run(Promise.all(sending))
          await clock.advance(500)
          outcomes.push(await clock.run(user.port.send('MESSAGE3')))
          const where = JSON.stringify([how, at, wire.taken, outcomes.map(({ outcome }) => outcome)])
          assert.equal(new Set(wire.taken).size, wire.taken.length, where)
          for (const [n, { outcome }] of outcomes.entries()) {
            const taken = wire.taken.includes(`MESSAGE${n + 1}`)
            if (outcome === 'confirmed') assert.ok(taken, where)
            if (outcome === 'failed') assert.ok(!taken, where)
          }
          assert.equal(outcomes[2].outcome, 'confirmed', where)
          user.port.close()
          await clock.run(user.lease.release())
          assert.equal(clock.pending(), 0, where)
        }
      }
    })
  }
})
