'use strict'

const assert = require('node:assert')
const { createInconLink, createPool } = require('../../lib')
const { createVirtualClock, createWire } = require('../../lib/sim')
const { inconBench } = require('./incon-bench')

// not ours: XOR letter by letter, as a PLC's program would do it
const sealed = body => {
  let check = 0
  for (const letter of body) check ^= letter.charCodeAt(0)
  return `${body}*${'0123456789ABCDEF'[check >> 4]}${'0123456789ABCDEF'[check & 15]}\r\n`
}
const ack = number => sealed(`!${String(number).padStart(2, '0')}`)
const line = (number, text) => sealed(`#${String(number).padStart(2, '0')} ${text}`)
const isStart = text => /^#00 [\da-z]+\*[\dA-F]{2}\r\n$/.test(text) && text === line(0, text.slice(4, -5))

/** A link on a line whose other end says what the test tells it to say. */
const scripted = ({ wire: own = {}, link = {}, line: lineSettings = {} } = {}) => {
  const clock = createVirtualClock()
  const wire = createWire({ clock, baudRate: 9600, collisions: false, ...own })
  const heard = /** @type {{ at: number, text: string }[]} */ ([])
  let say = /** @type {any} */ (null)
  /** what it says to a line */
  const peer = { answers: (/** @type {string} */ _text) => /** @type {string|null} */ (null), after: 5 }
  wire.add({
    station: 1,
    speak: send => void (say = send),
    receive(bytes) {
      const text = bytes.toString('latin1')
      heard.push({ at: clock.now(), text })
      const answer = peer.answers(text)
      if (answer) clock.setTimer(() => say(Buffer.from(answer, 'latin1')), peer.after)
      return []
    },
    disguise: bytes => bytes
  })
  const pool = createPool({ clock, random: () => 0.5 })
  const settings = { transport: 'simulated', path: 'sim', wire, baudRate: 9600, echo: 'off', ...lineSettings }
  const lease = pool.open(settings, { id: 'a', name: 'bench' })
  const options = { checked: true, acknowledge: true, scan: 0, random: () => 0, clock, ...link }
  const make = more => createInconLink({ lease, ...options, ...more })
  const device = make({})
  const got = []
  device.listen(message => got.push(message))
  return {
    ...{ clock, wire, peer, pool, settings, lease, device, got, make, options },
    say: text => say(Buffer.from(text, 'latin1')),
    texts: () => heard.map(({ text }) => text),
    heard,
    values: () => got.map(({ value }) => value),
    run: promise => clock.run(promise),
    async close() {
      device.close()
      await clock.run(lease.release())
      await clock.drain()
      assert.strictEqual(clock.pending(), 0)
    }
  }
}

/** Acknowledges everything, as it should. */
const obedient = text => (text[0] === '#' ? ack(Number(text.slice(1, 3))) : null)
const short = ({ outcome, code, attempts }) => [outcome, code ?? '', attempts].join(' ').replace('  ', ' ')

describe('INCON link, acknowledged lines', () => {
  let bench
  const open = options => (bench = scripted(options))
  /** Both know each other. */
  const begun = async (options = {}) => {
    open(options)
    bench.peer.answers = obedient
    await bench.clock.advance(200)
    bench.heard.length = 0
    return bench
  }
  afterEach(() => bench?.close())

  it('says its start, repeated until it is acknowledged, then lines from 01 on', async () => {
    open()
    await bench.clock.advance(2500)
    const starts = bench.texts()
    assert.ok(starts.length >= 3 && starts.every(isStart) && new Set(starts).size === 1, starts.join())
    bench.peer.answers = obedient
    const outcomes = await bench.run(Promise.all([bench.device.send('A'), bench.device.send('B')]))
    assert.deepStrictEqual(outcomes.map(short), ['confirmed 1', 'confirmed 1'])
    assert.deepStrictEqual(bench.texts().slice(-2), [line(1, 'A'), line(2, 'B')])
    assert.deepStrictEqual([outcomes[0].bytes, bench.device.stats.confirmed, bench.device.stats.sent], [10, 2, 0])
  })

  it('a line that is not acknowledged is repeated with its number, ackTimeout and a random pause apart, then unknown', async () => {
    await begun({ link: { attempts: 3, ackTimeout: 400, random: () => 0.5 } })
    bench.peer.answers = text => (/B/.test(text) ? obedient(text) : null)
    const outcomes = await bench.run(Promise.all([bench.device.send('A'), bench.device.send('B')]))
    assert.deepStrictEqual(outcomes.map(short), ['unknown TIMEOUT 3', 'confirmed 1'])
    assert.deepStrictEqual(bench.texts(), [line(1, 'A'), line(1, 'A'), line(1, 'A'), line(2, 'B')])
    const [one, two, three] = bench.heard.map(({ at }) => at)
    // 10 bytes are 10.4 ms on the wire; 400 and half of 200 ms behind it
    for (const apart of [two - one, three - two]) assert.ok(apart > 509 && apart < 517, `${apart}`)
    assert.ok(Math.abs(outcomes[0].ms - (2 * 510.4 + 410.4)) < 3, `${outcomes[0].ms}`)
  })

  it('only the right acknowledgement counts, and a late one counts for its own line alone', async () => {
    await begun({ link: { attempts: 2, ackTimeout: 300 } })
    const wrong = [ack(2), '!01*21\r\n', '!01*2\r\n', 'x!01*20\r\n', '#01*22\r\n', ack(0)]
    bench.peer.answers = () => wrong.join('')
    const [one] = await bench.run(Promise.all([bench.device.send('A')]))
    assert.strictEqual(short(one), 'unknown TIMEOUT 2')
    bench.peer.answers = text => (text === line(2, 'B') ? ack(1) : null)
    assert.strictEqual(short(await bench.run(bench.device.send('B'))), 'unknown TIMEOUT 2')
    bench.peer.answers = obedient
    assert.strictEqual(short(await bench.run(bench.device.send('C'))), 'confirmed 1')
    assert.strictEqual(bench.texts().at(-1), line(3, 'C'))
  })

  it('each whole line is answered, one that comes again too, and is told once', async () => {
    await begun()
    const script = [line(1, 'A'), line(1, 'A'), line(2, 'A'), '#03 B*00\r\n', line(3, 'B'), line(3, 'B'), line(4, 'C')]
    for (const text of script) {
      bench.say(text)
      await bench.clock.advance(300)
    }
    assert.deepStrictEqual(bench.texts(), [1, 1, 2, 3, 3, 4].map(ack))
    assert.deepStrictEqual(bench.values(), ['A', 'A', 'B', 'C'])
    assert.ok(bench.got.every(({ complete, lost }) => complete && lost === 0))
    const { received, repeated, damaged, acksOut } = bench.device.stats
    assert.deepStrictEqual(
      { received, repeated, damaged, acksOut },
      { received: 4, repeated: 2, damaged: 1, acksOut: 6 }
    )
  })

  it('numbers that the other side has given up are told as lost', async () => {
    await begun()
    for (const text of [line(1, 'A'), line(4, 'B'), line(4, 'B'), line(5, 'C')]) {
      bench.say(text)
      await bench.clock.advance(300)
    }
    assert.deepStrictEqual(
      bench.got.map(({ value, number, lost }) => [value, number, lost]),
      [
        ['A', 1, 0],
        ['B', 4, 2],
        ['C', 5, 0]
      ]
    )
    assert.deepStrictEqual([bench.texts(), bench.device.stats.lost], [[ack(1), ack(4), ack(5)], 2])
  })

  it('an acknowledgement waits for silence, and keeps the pause behind our own line', async () => {
    await begun({ link: { scan: 50, before: 20 } })
    bench.peer.answers = text => (text[0] === '#' ? ack(1) + line(1, 'A') : null)
    assert.strictEqual(short(await bench.run(bench.device.send('X'))), 'confirmed 1')
    await bench.clock.advance(1000)
    const [sent, answer] = bench.heard
    assert.deepStrictEqual([sent.text, answer.text, bench.values()], [line(1, 'X'), ack(1), ['A']])
    // 8 bytes are 8.3 ms
    assert.ok(Math.abs(answer.at - sent.at - (105 + 8.3)) < 1, `${answer.at - sent.at}`)
    bench.say(line(2, 'B'))
    await bench.clock.advance(1000)
    const busy = 10 * (10000 / 9600)
    const told = bench.heard.at(-1)
    const [{ timestamp }] = bench.got.slice(-1)
    assert.ok(told.at + Date.UTC(2024, 0, 1) - timestamp >= 20 + 8.3 - 0.1 && busy > 0)
  })

  it('before its own start is acknowledged it takes no line: it may have used it in a former life', async () => {
    open()
    bench.say(line(7, 'OLD'))
    await bench.clock.advance(500)
    assert.ok(bench.texts().every(isStart))
    bench.peer.answers = obedient
    await bench.clock.advance(1500)
    bench.say(line(7, 'OLD'))
    await bench.clock.advance(500)
    assert.deepStrictEqual([bench.values(), bench.texts().at(-1)], [['OLD'], ack(7)])
  })

  it('the other side starts: a line on its way is unknown and not repeated, the next ones go on, and its numbers begin anew', async () => {
    await begun()
    bench.say(line(1, 'A'))
    await bench.clock.advance(200)
    bench.peer.answers = text => (/OPEN/.test(text) ? line(0, 'again') : obedient(text))
    const outcomes = await bench.run(Promise.all([bench.device.send('OPEN'), bench.device.send('SHUT')]))
    assert.deepStrictEqual(outcomes.map(short), ['unknown PEER_RESTARTED 1', 'confirmed 1'])
    assert.match(outcomes[0].text, /^INCON has started anew/)
    await bench.clock.advance(3000)
    assert.deepStrictEqual(bench.texts(), [ack(1), line(1, 'OPEN'), ack(0), line(2, 'SHUT')])
    bench.say(line(1, 'A'))
    await bench.clock.advance(200)
    assert.deepStrictEqual(bench.values(), ['A', 'A'])
  })

  it('both start: its own start goes out before it acknowledges the other one', async () => {
    open({ link: { attempts: 1, ackTimeout: 100 } })
    await bench.clock.advance(1000)
    bench.heard.length = 0
    bench.say(line(0, ''))
    await bench.clock.advance(90)
    const [start, answer, ...more] = bench.texts()
    assert.deepStrictEqual([isStart(start), answer, more], [true, ack(0), []])
  })

  it('acknowledgements go before lines that wait', async () => {
    await begun({ link: { scan: 50 } })
    assert.strictEqual(short(await bench.run(bench.device.send('A'))), 'confirmed 1')
    bench.say(line(1, 'X'))
    await bench.clock.advance(15)
    const sent = bench.device.send('B')
    bench.say(line(2, 'Y'))
    assert.strictEqual(short(await bench.run(sent)), 'confirmed 1')
    assert.deepStrictEqual(bench.texts(), [line(1, 'A'), ack(1), ack(2), line(2, 'B')])
  })

  it('links on one line: one number after the other, one acknowledgement, each is told', async () => {
    await begun()
    const other = bench.make({ name: 'other' })
    const told = []
    other.listen(({ value }) => told.push(value))
    const outcomes = await bench.run(Promise.all([bench.device.send('A'), other.send('B'), bench.device.send('C')]))
    assert.deepStrictEqual(outcomes.map(short), ['confirmed 1', 'confirmed 1', 'confirmed 1'])
    bench.say(line(1, 'X') + line(1, 'X'))
    await bench.clock.advance(500)
    assert.deepStrictEqual([told, bench.values()], [['X'], ['X']])
    assert.deepStrictEqual(bench.texts(), [line(1, 'A'), line(2, 'B'), line(3, 'C'), ack(1), ack(1)])
    bench.peer.answers = () => null
    const [flying, waiting, mine] = [other.send('D'), other.send('E'), bench.device.send('F')]
    await bench.clock.advance(100)
    other.close()
    assert.deepStrictEqual((await bench.run(Promise.all([flying, waiting]))).map(short), [
      'unknown LINE_CLOSED 1',
      'failed LINE_CLOSED 0'
    ])
    bench.peer.answers = obedient
    assert.strictEqual(short(await bench.run(mine)), 'confirmed 1')
    assert.strictEqual(bench.texts().at(-1), line(5, 'F'))
  })

  it('over a redeploy: no new start, the next number, and what was accepted is known', async () => {
    await begun()
    await bench.run(bench.device.send('A'))
    bench.say(line(1, 'X'))
    await bench.clock.advance(300)
    bench.device.close()
    await bench.run(bench.lease.release())
    const lease = bench.pool.open(bench.settings, { id: 'a', name: 'bench' })
    const again = createInconLink({ ...bench.options, lease })
    const told = []
    again.listen(({ value }) => told.push(value))
    await bench.clock.advance(1000)
    bench.heard.length = 0
    bench.say(line(1, 'X') + line(2, 'Y'))
    await bench.clock.advance(500)
    assert.strictEqual(short(await bench.run(again.send('B'))), 'confirmed 1')
    assert.deepStrictEqual([told, bench.texts()], [['Y'], [ack(1), ack(2), line(2, 'B')]])
    again.close()
    await bench.run(lease.release())
  })

  it('what nobody listens to is not acknowledged', async () => {
    open()
    bench.peer.answers = obedient
    bench.device.close()
    const deaf = bench.make({})
    await bench.clock.advance(200)
    bench.heard.length = 0
    bench.say(line(1, 'A'))
    await bench.clock.advance(300)
    assert.deepStrictEqual(bench.texts(), [])
    const told = []
    deaf.listen(({ value }) => told.push(value))
    bench.say(line(1, 'A'))
    await bench.clock.advance(300)
    assert.deepStrictEqual([told, bench.texts()], [['A'], [ack(1)]])
    deaf.close()
  })

  for (const after of [5, 45, 52, 60])
    it(`an adapter that hears itself: nothing is sent but starts, and the code says what to set (answers after ${after} ms)`, async () => {
      open({ wire: { echo: true } })
      bench.peer.answers = obedient
      bench.peer.after = after
      const outcome = await bench.run(bench.device.send('A'))
      assert.strictEqual(short(outcome), 'failed OWN_ECHO 0')
      await bench.clock.advance(5000)
      assert.ok(bench.texts().every(isStart), bench.texts().join())
      assert.deepStrictEqual(bench.values(), [])
    })

  it('where the line takes the echo out it works as without', async () => {
    await begun({ wire: { echo: true }, line: { echo: 'on' } })
    assert.strictEqual(short(await bench.run(bench.device.send('A'))), 'confirmed 1')
    bench.say(line(1, 'B'))
    await bench.clock.advance(300)
    assert.deepStrictEqual([bench.values(), bench.texts()], [['B'], [line(1, 'A'), ack(1)]])
  })

  it('an adapter that begins to hear itself: found by two lines, before one is confirmed by our own answers', async () => {
    await begun()
    bench.wire.setEcho(true)
    bench.peer.answers = () => null
    const sent = bench.device.send('A')
    await bench.clock.advance(100)
    assert.deepStrictEqual(bench.values(), [])
    assert.strictEqual(short(await bench.run(sent)), 'unknown OWN_ECHO 2')
  })

  it('both happen to say the same: repeated, and no echo', async () => {
    await begun({ link: { ackTimeout: 300 } })
    for (const number of [1, 2, 3]) {
      bench.peer.answers = () => line(number, 'PING')
      const sent = bench.device.send('PING')
      await bench.clock.advance(100)
      bench.peer.answers = text => (text[0] === '#' ? ack(number) : null)
      assert.strictEqual(short(await bench.run(sent)), 'confirmed 2')
      bench.say(line(number, 'PING'))
      await bench.clock.advance(200)
      assert.strictEqual(bench.got.length, number)
    }
  })

  it('unplugged while it waits: repeated when the port is back, and confirmed', async () => {
    await begun()
    bench.peer.answers = () => null
    const sent = bench.device.send('A')
    await bench.clock.advance(500)
    bench.wire.unplug()
    await bench.clock.advance(100)
    bench.wire.plug()
    bench.peer.answers = obedient
    assert.strictEqual(short(await bench.run(sent)), 'confirmed 2')
    assert.deepStrictEqual(
      bench.texts().filter(text => text[0] === '#'),
      [line(1, 'A'), line(1, 'A')]
    )
  })

  it('not connected: failed at once, and no number is used up', async () => {
    await begun()
    bench.wire.unplug()
    await bench.clock.advance(10)
    const outcome = await bench.run(bench.device.send('A'))
    assert.deepStrictEqual([outcome.outcome, outcome.attempts, outcome.bytes], ['failed', 0, 0])
    bench.wire.plug()
    await bench.clock.advance(6000)
    assert.strictEqual(short(await bench.run(bench.device.send('B'))), 'confirmed 1')
    assert.strictEqual(bench.texts().at(-1), line(1, 'B'))
  })

  it('nobody answers the start: failed, nothing of the line goes out; later it works', async () => {
    open({ link: { attempts: 2, ackTimeout: 100 } })
    assert.strictEqual(short(await bench.run(bench.device.send('A'))), 'failed TIMEOUT 0')
    assert.ok(bench.texts().every(isStart))
    bench.peer.answers = obedient
    assert.strictEqual(short(await bench.run(bench.device.send('B'))), 'confirmed 1')
    assert.strictEqual(bench.texts().at(-1), line(1, 'B'))
  })

  it('who waits too long for its turn is told at once, and goes out never; so is who finds no room', async () => {
    await begun({ link: { attempts: 2, ackTimeout: 500 } })
    bench.peer.answers = () => null
    const first = bench.device.send('A')
    const start = bench.clock.now()
    const late = await bench.run(bench.device.send('B', { deadline: 100 }))
    assert.deepStrictEqual([short(late), bench.clock.now() - start], ['failed DEADLINE 0', 100])
    const all = Array.from({ length: 1001 }, () => bench.device.send('C'))
    const full = await bench.run(all.at(-1))
    assert.strictEqual(short(full), 'failed QUEUE_FULL 0')
    assert.strictEqual(short(await bench.run(first)), 'unknown TIMEOUT 2')
    bench.device.close()
    const rest = await bench.run(Promise.all(all))
    assert.ok(rest.slice(1).every(({ outcome }) => outcome === 'failed'))
    assert.ok(!bench.texts().includes(line(2, 'B')))
  })

  it('a deadline that is long enough changes nothing', async () => {
    await begun()
    assert.strictEqual(short(await bench.run(bench.device.send('A', { deadline: 60000 }))), 'confirmed 1')
  })

  it('needs checked lines, and all links of a line must want it', () => {
    open()
    assert.throws(() => bench.make({ checked: false }), { code: 'BAD_SETTING' })
    assert.throws(() => bench.make({ acknowledge: false }), { code: 'LINE_USE' })
    for (const own of [{ attempts: 0 }, { attempts: 101 }, { ackTimeout: 9 }, { scan: 10001 }, { scan: -1 }]) {
      assert.throws(() => bench.make(own), { code: 'BAD_SETTING' })
    }
  })

  it('two that have sent at once do not meet for ever', async () => {
    bench = inconBench({ link: { checked: true, acknowledge: true }, sim: { acknowledge: true, scan: 1 } })
    await bench.clock.advance(5000)
    const [before, from] = [bench.wire.counts.collisions, bench.clock.now()]
    bench.controller.say('FROM THE CONTROLLER')
    await bench.clock.advance(1.5)
    assert.strictEqual(short(await bench.run(bench.device.send('FROM US'))).slice(0, 9), 'confirmed')
    await bench.clock.drain()
    const taken = bench.controller.messages.filter(({ valid }) => valid).map(({ text }) => text)
    assert.deepStrictEqual([taken, bench.heard()], [['FROM US'], ['FROM THE CONTROLLER']])
    assert.ok(bench.wire.counts.collisions > before && bench.clock.now() - from < 10000)
  })
})
