'use strict'

const assert = require('node:assert')
const { createInconController, createVirtualClock, createWire } = require('../../lib/sim')

describe('simulated INCON controller', () => {
  /** One master on the line; what it hears, with the time of its last byte. */
  function listen({ wire: given = {}, ...settings } = {}) {
    const clock = createVirtualClock()
    const wire = createWire({ clock, baudRate: 9600, chunk: 1, ...given })
    const controller = createInconController({ clock, ...settings })
    wire.add(controller)
    let heard = ''
    const end = wire.connect({ data: data => (heard += data.toString('latin1')), closed: () => {} })
    const write = text => end.write(Buffer.from(text, 'latin1'))
    return { clock, wire, controller, write, heard: () => heard }
  }
  const byteMs = 10000 / 9600

  it('M68 sends Test CR LF; the M code is finished when the program sees finish at a scan', async () => {
    const { clock, controller, heard } = listen({ scan: 10 })
    controller.mCode(68)
    await clock.drain()
    assert.strictEqual(heard(), 'Test\r\n')
    const [{ at, end, text }] = controller.sent
    assert.deepStrictEqual([at, text, controller.counts.mCodes], [10, 'Test', 1])
    assert.ok(Math.abs(end - (10 + 6 * byteMs)) < 1e-6, `${end}`)
    assert.strictEqual(controller.structures.send.length, 0)
  })

  it('another M code does nothing', async () => {
    const { clock, controller, heard } = listen()
    controller.mCode(67)
    await clock.drain()
    assert.strictEqual(heard(), '')
  })

  it('its PLC takes a line at the first scan at which the line feed is the last byte', async () => {
    const { clock, controller, write } = listen({ scan: 10 })
    write('O1234\r\n')
    await clock.drain()
    assert.deepStrictEqual(
      controller.messages.map(({ at, text, shown, full }) => [at, text, shown, full]),
      [[10, 'O1234', 'O1234\r\n', false]]
    )
    const { length, finish } = controller.structures.recv
    assert.deepStrictEqual([length, finish], [0, 0])
  })

  it('lines without a pause are one message for a slow PLC, and lose bytes while finish is set with a fast one', async () => {
    const slow = listen({ scan: 50 })
    slow.write('A\r\nB\r\n')
    await slow.clock.drain()
    assert.deepStrictEqual(
      slow.controller.messages.map(({ text }) => text),
      ['A\r\nB']
    )
    const fast = listen({ scan: 1, restart: 'always' })
    fast.write('A\r\nB\r\n')
    await fast.clock.drain()
    assert.strictEqual(fast.controller.messages[0].text, 'A')
    assert.ok(fast.controller.counts.bytesLost >= 1)
    const kept = listen({ scan: 1, restart: 'once' })
    kept.write('A\r\nB\r\n')
    await kept.clock.drain()
    assert.strictEqual(kept.controller.counts.bytesLost, 0)
  })

  it('a torn line waits for ever, without a scan that costs time', async () => {
    const { clock, controller, write } = listen({ scan: 1 })
    write('O12')
    await clock.drain()
    assert.deepStrictEqual([controller.messages.length, controller.structures.recv.length, clock.pending()], [0, 3, 0])
    write('34\r\n')
    await clock.drain()
    assert.deepStrictEqual(
      controller.messages.map(({ text }) => text),
      ['O1234']
    )
  })

  it("256 bytes without line feed are a message, and the manual's strCopy writes past its array", async () => {
    const { clock, controller, write } = listen({ scan: 1 })
    write('x'.repeat(300))
    await clock.drain()
    const [first, ...others] = controller.messages
    assert.deepStrictEqual([first.full, first.bytes.length, others.length], [true, 256, 0])
    assert.strictEqual(controller.counts.overwritten, 1)
  })

  it('echoes, answers, and says what it is told to, one line after the other', async () => {
    const echo = listen({ answer: 'echo' })
    echo.write('hello\r\n')
    await echo.clock.drain()
    assert.strictEqual(echo.heard(), 'hello\r\n')
    const answer = listen({ answer: text => (text === '?' ? 'READY' : null) })
    answer.write('?\r\n')
    answer.controller.say('one')
    answer.controller.say(Buffer.from('two'))
    await answer.clock.drain()
    assert.strictEqual(answer.heard(), 'one\r\ntwoREADY\r\n')
    assert.strictEqual(answer.controller.counts.reported, 3)
  })

  it('a stale finish: the program takes the second line for sent while it is on the wire, and the third is never sent', async () => {
    const lines = ['a'.repeat(50), 'b'.repeat(50), 'c'.repeat(50)]
    const run = async clears => {
      const { clock, controller, heard } = listen({ scan: 10, clears })
      lines.forEach(controller.say)
      await clock.drain()
      const early = controller.reported.map(({ at }, n) => at < (controller.sent[n]?.end ?? Infinity))
      return { early, heard: heard().split('\r\n').slice(0, -1) }
    }
    assert.deepStrictEqual(await run('finish'), { early: [false, false, false], heard: lines })
    assert.deepStrictEqual(await run('length'), { early: [false, true, true], heard: lines.slice(0, 2) })
  })

  it('a program that never clears finish of what it received hears nothing more', async () => {
    const { clock, controller, write } = listen({ scan: 5, receiveClears: false })
    for (const text of ['A\n', 'B\n', 'C\n']) {
      write(text)
      await clock.advance(500)
    }
    assert.deepStrictEqual([controller.messages.map(({ text }) => text), controller.counts.bytesLost], [['A'], 4])
  })

  it('sends events in turn until it is closed', async () => {
    const { clock, controller, heard } = listen({ events: ['ON', 'OFF'], every: 1000 })
    await clock.advance(3500)
    assert.strictEqual(heard(), 'ON\r\nOFF\r\nON\r\n')
    controller.close()
    await clock.drain()
    assert.strictEqual(clock.pending(), 0)
  })

  it('keeps the latest messages only', async () => {
    const { clock, controller, write } = listen({ keep: 2, scan: 1 })
    for (const text of ['A', 'B', 'C']) {
      write(`${text}\n`)
      await clock.advance(100)
    }
    assert.deepStrictEqual([controller.messages.map(({ text }) => text), controller.counts.messages], [['B', 'C'], 3])
  })

  it('acknowledged lines: says its start until it is answered; answers lines, and repeats its own', async () => {
    const { clock, controller, write, heard } = listen({ acknowledge: true, scan: 10, attempts: 3 })
    await clock.drain()
    // 00 and a text, the XOR of all before the star; three times
    const [start, ...again] = heard().split('\r\n').slice(0, -1)
    assert.match(start, /^#00 [\da-z]+\*[\dA-F]{2}$/)
    assert.deepStrictEqual(again, [start, start])
    write('#01 A*43\r\n')
    await clock.advance(100)
    assert.strictEqual(controller.counts.messages, 0)
    write('!00*21\r\n')
    await clock.advance(200)
    // 23h ^ 30h ^ 32h ^ 20h ^ 42h = 43h
    for (const line of ['#01 A*43', '#01 A*43', '#02 B*43', '#03 C*00']) {
      write(`${line}\r\n`)
      await clock.advance(300)
    }
    assert.deepStrictEqual(
      controller.messages.map(({ text, valid }) => [text, valid]),
      [
        ['A', true],
        ['B', true],
        ['#03 C*00', false]
      ]
    )
    assert.match(heard(), /!01\*20\r\n!01\*20\r\n!02\*23\r\n$/)
    controller.say('X')
    controller.say('Y')
    await clock.advance(100)
    write('!01*20\r\n')
    await clock.drain()
    assert.deepStrictEqual(controller.outcomes, [
      { text: 'X', outcome: 'confirmed', attempts: 1 },
      { text: 'Y', outcome: 'unknown', attempts: 3 }
    ])
    assert.strictEqual(heard().match(/#02 Y\*58/g)?.length, 3)
  })

  it('switched off and on while it sends: the new life is not held up by the old one', async () => {
    const { clock, controller, write, heard } = listen({ acknowledge: true, scan: 10, attempts: 1 })
    await clock.advance(15)
    controller.restart()
    await clock.advance(100)
    assert.strictEqual(heard().match(/#00 /g)?.length, 2)
    write('!00*21\r\n')
    await clock.advance(50)
    controller.say('X')
    await clock.advance(100)
    assert.match(heard(), /#01 X\*5A\r\n$/)
    controller.close()
    await clock.drain()
  })

  it('settings that cannot be are refused', () => {
    const clock = createVirtualClock()
    for (const [code, settings] of [
      ['BAD_STATION', { station: 0 }],
      ['BAD_SETTING', { scan: 0 }],
      ['BAD_SETTING', { scan: '10' }],
      ['BAD_SETTING', { restart: 'never' }],
      ['BAD_SETTING', { clears: 'both' }]
    ]) {
      assert.throws(() => createInconController({ clock, ...settings }), { code })
    }
  })
})
