'use strict'

const assert = require('node:assert')
const { createInconLink, openInconLink } = require('../../lib')
const { inconBench } = require('./incon-bench')

const bytesOf = text => Buffer.from(text, 'latin1')
const words = outcomes => outcomes.map(({ outcome, code }) => (code ? `${outcome} ${code}` : outcome))

describe('INCON link', () => {
  let bench
  const open = options => (bench = inconBench(options))
  afterEach(() => bench?.close())

  it("sends a line and hears lines; the manual's M68 example sends Test", async () => {
    open()
    const outcome = await bench.run(bench.device.send('O1234'))
    assert.deepStrictEqual({ ...outcome, ms: 0 }, { outcome: 'sent', attempts: 1, ms: 0, bytes: 7 })
    // seven bytes of 10/9600 s
    assert.ok(Math.abs(outcome.ms - 7.29) < 0.1, `${outcome.ms}`)
    bench.controller.mCode(68)
    await bench.clock.drain()
    assert.deepStrictEqual(bench.seen(), ['O1234'])
    const [{ timestamp, ...message }] = bench.got
    assert.deepStrictEqual(message, { value: 'Test', text: 'Test', bytes: bytesOf('Test'), count: 4, complete: true })
    assert.ok(Math.abs(timestamp - bench.clock.wall()) < 200)
    assert.strictEqual(bench.controller.counts.mCodes, 1)
    assert.deepStrictEqual({ ...bench.device.stats }, { ...bench.device.stats, received: 1, sent: 1, incomplete: 0 })
  })

  describe('two lines sent at once are two messages for the PLC', () => {
    const twoLines = async ({ scan, phase, restart, link = {} }) => {
      open({ sim: { scan, phase, restart }, link })
      await bench.run(Promise.all([bench.device.send('O1234'), bench.device.send('START')]))
      await bench.clock.drain()
      const seen = bench.seen()
      await bench.close()
      return seen
    }
    for (const restart of ['always', 'once']) {
      it(`at scan times from 1 to 100 ms, with the defaults (NC: ${restart})`, async () => {
        for (let scan = 1; scan <= 100; scan++) {
          const seen = await twoLines({ scan, phase: (scan * 0.618) % scan, restart })
          assert.deepStrictEqual(seen, ['O1234', 'START'], `scan ${scan}`)
        }
      })
    }

    it('with a scan time that is set, at any phase: twice that and 5 ms, but not less than the quiet time', async () => {
      for (const [scan, link] of /** @type {[number, any][]} */ ([
        [22, { scan: 0 }],
        [22, { scan: 22, quiet: 0 }],
        [7, { scan: 7, quiet: 0 }]
      ])) {
        for (let phase = 0; phase < scan; phase++) {
          const seen = await twoLines({ scan, phase, restart: 'always', link })
          assert.deepStrictEqual(seen, ['O1234', 'START'], `scan ${scan}, phase ${phase}`)
        }
      }
    })

    it('the pause between two lines: the scan time and the quiet time, whichever asks for more', async () => {
      const pauses = []
      for (const link of [{}, { scan: 0 }, { scan: 10 }, { scan: 0, quiet: 0 }, { scan: 30, quiet: 90 }]) {
        open({ link })
        await bench.run(Promise.all([bench.device.send('A'), bench.device.send('B')]))
        const [one, two] = bench.lease.line.trace().filter(({ dir }) => dir === 'out')
        pauses.push(Math.round(two.t - one.t - (3 * 10000) / 9600))
        await bench.close()
      }
      assert.deepStrictEqual(pauses, [205, 50, 50, 5, 90])
    })

    it('a quiet time that is too short for the PLC shows: one message of two lines', async () => {
      open({ sim: { scan: 100, restart: 'always' }, link: { scan: 0, quiet: 20 } })
      await bench.run(Promise.all([bench.device.send('O1234'), bench.device.send('START')]))
      await bench.clock.drain()
      assert.deepStrictEqual(bench.seen(), ['O1234\r\nSTART'])
    })
  })

  it('waits until the controller has been silent, keeps the quiet time and the order', async () => {
    open({ wire: { echo: false }, sim: { scan: 1 }, link: { quiet: 30, scan: 0, before: 5 } })
    bench.controller.say('x'.repeat(100))
    await bench.clock.advance(20)
    const outcomes = bench.run(Promise.all(['A', 'B', 'C'].map(value => bench.device.send(value))))
    assert.deepStrictEqual(words(await outcomes), ['sent', 'sent', 'sent'])
    await bench.clock.drain()
    assert.deepStrictEqual([bench.seen(), bench.heard()], [['A', 'B', 'C'], ['x'.repeat(100)]])
    const frames = bench.lease.line.trace()
    const ends = bench.controller.sent[0].end
    const [first, second] = bench.controller.messages.map(({ at }) => at)
    assert.ok(first > ends + 5 && first < ends + 15, `${first} after ${ends}`)
    assert.ok(second - first >= 30, `${second - first}`)
    assert.ok(frames.length >= 4)
    assert.strictEqual(bench.wire.counts.collisions, 0)
  })

  it('a torn line and a line that is too long are told once, as incomplete', async () => {
    open({ sim: { scan: 1 } })
    bench.controller.say(bytesOf('O12'))
    await bench.clock.drain()
    assert.deepStrictEqual(bench.heard(), [['O12', 'silence']])
    bench.controller.say('y'.repeat(254))
    bench.controller.say(bytesOf('z'.repeat(256)))
    bench.controller.say('tail')
    bench.controller.say('whole')
    await bench.clock.drain()
    const rest = ['y'.repeat(254), ['z'.repeat(256), 'full'], ['tail', 'tail'], 'whole']
    assert.deepStrictEqual(bench.heard().slice(1), rest)
    assert.strictEqual(bench.device.stats.incomplete, 3)
  })

  it('what cannot be a line is refused before anything is sent', async () => {
    open()
    const values = ['', 'A\nB', '가', 'x'.repeat(254), undefined, null, { a: 1 }, Buffer.from('A\0')]
    const outcomes = await bench.run(Promise.all(values.map(value => bench.device.send(value))))
    const refused = outcomes.map(({ outcome, code, attempts, bytes }) => [outcome, code, attempts, bytes])
    const codes = values.map(value => (value === values[3] ? 'FRAME_TOO_LONG' : 'BAD_VALUE'))
    assert.deepStrictEqual(
      refused,
      codes.map(code => ['refused', code, 0, 0])
    )
    assert.ok(outcomes.every(({ text: why }) => why.length > 20))
    assert.strictEqual(bench.wire.counts.frames, 0)
  })

  it('unplugged in the middle: unknown, and nothing is glued to what was cut off', async () => {
    open({ sim: { scan: 5 } })
    await bench.clock.advance(10)
    const cut = bench.device.send('PROGRAM O1234')
    const waiting = bench.device.send('NEVER')
    bench.clock.setTimer(() => bench.wire.unplug(), 11)
    const [one, two] = await bench.run(Promise.all([cut, waiting]))
    assert.strictEqual(one.outcome, 'unknown')
    assert.ok(one.bytes > 3 && one.bytes < 15, `${one.bytes}`)
    assert.deepStrictEqual([two.outcome, two.bytes, two.attempts], ['failed', 0, 0])
    const while_ = await bench.run(bench.device.send('DOWN'))
    assert.strictEqual(while_.outcome, 'failed')
    bench.wire.plug()
    await bench.clock.advance(10000)
    const after = await bench.run(Promise.all([bench.device.send('O5'), bench.device.send('O6')]))
    assert.deepStrictEqual(words(after), ['sent', 'sent'])
    await bench.clock.drain()
    const [torn, ...rest] = bench.seen()
    assert.match(torn, /^PROG?R?.*\?$/)
    assert.deepStrictEqual(rest, ['O5', 'O6'])
    const { sent, unknown, failed } = bench.device.stats
    assert.deepStrictEqual([sent, unknown, failed], [2, 1, 2])
  })

  it('closed: failed; twice is once; the line can be used by another one', async () => {
    open()
    bench.device.close()
    bench.device.close()
    assert.deepStrictEqual(words([await bench.run(bench.device.send('A'))]), ['failed LINE_CLOSED'])
    const other = bench.make({ checked: true })
    assert.strictEqual((await bench.run(other.send('A'))).outcome, 'sent')
    other.close()
  })

  it('links with the same settings share a line; others are refused, naming both', async () => {
    open()
    const lease = bench.pool.open(bench.settings, { id: 'b', name: 'second' })
    const same = createInconLink({ lease, clock: bench.clock, quiet: 60, before: 1 })
    const got = []
    const stop = same.listen(({ value }) => got.push(value))
    bench.controller.say('BOTH')
    await bench.clock.drain()
    assert.deepStrictEqual([got, bench.heard()], [['BOTH'], ['BOTH']])
    stop()
    same.close()
    for (const own of [{ checked: true }, { most: 100 }, { silence: 10 }, { encoding: 'utf8' }]) {
      assert.throws(() => createInconLink({ lease, clock: bench.clock, ...own }), /second and bench|bench and second/)
    }
    await assert.rejects(bench.run(lease.run(() => null, { station: 1 })), { code: 'LINE_USE' })
    await bench.run(lease.release())
  })

  it('a character that UTF-8 does not have is damage', async () => {
    open({ link: { encoding: 'utf8' } })
    bench.wire.noise(Buffer.from('Ofen \u00e4\r\n'))
    await bench.clock.drain()
    bench.wire.noise(Buffer.from('Ofen \u00e4\r\n', 'latin1'))
    await bench.clock.drain()
    assert.deepStrictEqual(bench.heard(), ['Ofen \u00e4', ['Ofen \ufffd', 'encoding']])
    assert.strictEqual(bench.device.stats.damaged, 1)
  })

  it('settings that cannot be are refused', () => {
    open()
    const wrong = [{ most: 1 }, { silence: -1 }, { quiet: 'x' }, { before: 1e6 }, { encoding: 'ebcdic' }]
    for (const own of wrong) {
      const setting = Object.keys(own)[0]
      assert.throws(
        () => bench.make(own),
        ({ code, details }) => code === 'BAD_SETTING' && details.setting === setting
      )
    }
  })

  it('garbage for a while: all of it is told as damaged or incomplete, then lines are lines again', async () => {
    open({ sim: { scan: 1 } })
    bench.wire.noise(Buffer.from(Array.from({ length: 3000 }, (_, n) => ((n * 37) % 128) + 128)))
    await bench.clock.advance(5000)
    bench.controller.say('WELL')
    await bench.clock.drain()
    const last = bench.got.pop()
    assert.strictEqual(last.value, 'WELL')
    assert.ok(bench.got.length >= 11 && bench.got.every(({ complete }) => !complete))
    assert.ok(bench.got.every(({ count }) => count <= 256))
  })

  it('redeployed in the middle of lines: each settles once, no line is cut, none is told as another', async () => {
    open({ wire: { collisions: false }, sim: { scan: 5 } })
    bench.device.close()
    await bench.run(bench.lease.release())
    const settled = []
    for (let n = 0; n < 60; n++) {
      const lease = bench.pool.open(bench.settings, { id: 'a', name: 'again' })
      const link = createInconLink({ lease, clock: bench.clock })
      const send = line => link.send(line).then(({ outcome: word }) => settled.push([line, word]))
      const outcome = Promise.all([send(`LINE ${n}`), send(`LINE ${n} again`)])
      bench.controller.say(`EVENT ${n}`)
      await bench.clock.advance(n * 1.7)
      link.close()
      await bench.run(lease.release())
      await bench.run(outcome)
      await bench.clock.advance(100)
    }
    await bench.clock.drain()
    assert.strictEqual(settled.length, 120)
    // what had begun goes out to its end
    const begun = settled.filter(([, word]) => word !== 'failed').map(([line]) => line)
    assert.deepStrictEqual(bench.seen(), begun)
    assert.deepStrictEqual([...new Set(settled.map(([, word]) => word))].sort(), ['failed', 'sent', 'unknown'])
    assert.deepStrictEqual(bench.pool.lines(), [])
  })

  describe('checked lines', () => {
    const sim = { scan: 5, checked: true }
    const link = { checked: true }

    it('bear a number and a check both ways', async () => {
      open({ sim, link })
      await bench.run(Promise.all(['A', 'B'].map(value => bench.device.send(value))))
      bench.controller.say('C')
      bench.controller.say('D')
      await bench.clock.drain()
      const seen = bench.controller.messages
      assert.deepStrictEqual(
        seen.map(({ bytes }) => `${bytes}`),
        ['#00 A*42\r\n', '#01 B*40\r\n']
      )
      assert.deepStrictEqual(
        seen.map(({ text: shown, valid }) => [shown, valid]),
        [
          ['A', true],
          ['B', true]
        ]
      )
      assert.deepStrictEqual(
        bench.got.map(({ value, number, lost }) => [value, number, lost]),
        [
          ['C', 0, 0],
          ['D', 1, 0]
        ]
      )
    })

    it('a damaged one has no value; a missing one is counted; one that comes twice is told once', async () => {
      open({ sim, link })
      const say = async (value, fault, options) => {
        if (fault) bench.faults.once(fault, options)
        bench.controller.say(value)
        await bench.clock.advance(1000)
      }
      await say('START')
      await say('A', 'crc', { argument: 1 })
      await say('B', 'silent')
      await say('C', 'duplicated', { argument: 0 })
      await say('D')
      const told = bench.got.map(({ value, complete, number, lost }) => [value, complete, number, lost])
      assert.deepStrictEqual(told, [
        ['START', true, 0, 0],
        [null, false, undefined, undefined],
        ['C', true, 3, 2],
        ['D', true, 4, 0]
      ])
      const { received, damaged, lost, repeated } = bench.device.stats
      assert.deepStrictEqual([received, damaged, lost, repeated], [4, 1, 2, 1])
    })

    it('several who send on a line share the numbers, also after a redeploy', async () => {
      open({ sim, link })
      await bench.run(bench.device.send('A'))
      const other = bench.make({})
      await bench.run(other.send('B'))
      other.close()
      await bench.run(bench.device.send('C'))
      await bench.clock.drain()
      assert.deepStrictEqual(
        bench.controller.messages.map(({ number }) => number),
        [0, 1, 2]
      )
      assert.strictEqual(bench.controller.counts.missing, 0)
    })
  })

  it('opened with a line of its own', async () => {
    open()
    await bench.close()
    const { clock, settings, pool } = bench
    const link = openInconLink({ ...settings, pool, clock, name: 'mill' })
    const got = []
    link.listen(({ value }) => got.push(value))
    assert.strictEqual((await clock.run(link.send('A'))).outcome, 'sent')
    bench.controller.say('B')
    await clock.advance(1000)
    assert.deepStrictEqual([got, link.link.name, link.line.state], [['B'], 'mill', 'open'])
    await clock.run(link.close())
    assert.deepStrictEqual(pool.lines(), [])
    assert.throws(() => openInconLink({ ...settings, pool, clock, most: 0 }), { code: 'BAD_SETTING' })
    await clock.advance(3000)
    assert.deepStrictEqual(pool.lines(), [])
  })
})
