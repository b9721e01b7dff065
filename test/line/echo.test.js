'use strict'

const assert = require('node:assert/strict')
const { createBench, failure } = require('./support/bench')
const { Echo } = require('../../lib/line/echo')
const toy = require('./support/toy')

/** A wire that hears itself (or not), with a station that answers (or not). */
const wired =
  ({ echo = true, answers = true, noise = '' } = {}) =>
  (bytes, wire) => {
    if (echo) wire.reply(Buffer.concat([Buffer.from(noise, 'hex'), bytes]), { after: 0 })
    if (!answers) return
    const answer = bytes[0] === 0x57 ? Buffer.from(bytes) : toy.answer(bytes[1], [7], bytes[2])
    wire.reply(answer, { after: 5 })
  }

const ask = bench => bench.run(bench.lease.run(() => toy.ask(1), { station: 1 }))
const put = bench => bench.run(bench.lease.run(() => toy.put(1, 9), { station: 1 }))

describe('line: the echo of a 2-wire adapter', () => {
  it('is found out from the first answered read, and stripped', async () => {
    const bench = createBench({ onQuery: wired() })
    assert.equal(bench.lease.line.echo, 'unknown')
    assert.deepEqual(await ask(bench), [7])
    assert.equal(bench.lease.line.echo, 'present')
    assert.equal(await put(bench), 'confirmed')
    assert.equal(bench.lease.line.stats().echoes, 2)
  })

  it('is not there: found out likewise, and a copy is an answer', async () => {
    const bench = createBench({ onQuery: wired({ echo: false }) })
    await ask(bench)
    assert.equal(bench.lease.line.echo, 'absent')
    assert.equal(await put(bench), 'confirmed')
  })

  it('is not there: that is believed for half a second, also by whoever looks at the line', async () => {
    const { lease, run, clock } = createBench({
      onQuery: (query, wire) => wire.reply(toy.answer(query[1], [7], query[2]))
    })
    await run(lease.run(() => toy.ask(1), { station: 1 }))
    assert.equal(lease.line.echo, 'absent')
    await clock.advance(501)
    assert.equal(lease.line.echo, 'unknown')
    await run(lease.release())
  })

  it('confirms no write while it is unknown', async () => {
    const bench = createBench({ onQuery: wired({ answers: false }) })
    assert.equal((await failure(put(bench))).code, 'TIMEOUT')
    assert.equal(bench.lease.line.echo, 'unknown')
  })

  it('confirms no write once it is known', async () => {
    const bench = createBench({ onQuery: wired() })
    await ask(bench)
    bench.wire.onQuery = wired({ answers: false })
    assert.equal((await failure(put(bench))).code, 'TIMEOUT')
  })

  it('confirms no write behind a byte of noise', async () => {
    const bench = createBench({ onQuery: wired() })
    await ask(bench)
    bench.wire.onQuery = wired({ answers: false, noise: 'ff' })
    assert.equal((await failure(put(bench))).code, 'TIMEOUT')
  })

  it('is found out behind noise', async () => {
    const bench = createBench({ onQuery: wired({ noise: 'ff00' }) })
    assert.deepEqual(await ask(bench), [7])
    assert.equal(bench.lease.line.echo, 'present')
  })

  it('is not declared absent when it may have come damaged', async () => {
    const bench = createBench({
      onQuery: (bytes, wire) => {
        wire.reply(Buffer.from([0x51, 0x01, 0x80, 0x56]), { after: 0 })
        wire.reply(toy.answer(1, [7]), { after: 5 })
      }
    })
    assert.deepEqual(await ask(bench), [7])
    assert.equal(bench.lease.line.echo, 'unknown')
  })

  it('in unknown state needs two copies for a write', async () => {
    const bench = createBench({ onQuery: wired() })
    assert.equal(await put(bench), 'confirmed')
    assert.equal(bench.lease.line.echo, 'present')
  })

  it('comes in pieces', async () => {
    const bench = createBench({
      onQuery: (bytes, wire) => {
        bytes.forEach((b, i) => wire.reply(Buffer.from([b]), { after: i / 2 }))
        wire.reply(toy.answer(1, [7]), { after: 5 })
      }
    })
    assert.deepEqual(await ask(bench), [7])
    assert.equal(bench.lease.line.echo, 'present')
  })

  it('is asked for anew when the port is opened again', async () => {
    const bench = createBench({ onQuery: wired() })
    await ask(bench)
    bench.wire.unplug()
    await bench.clock.advance(500)
    assert.equal(bench.lease.line.state, 'open')
    assert.equal(bench.lease.line.echo, 'unknown')
  })

  it('that came once by chance is not believed for ever', async () => {
    const bench = createBench({ onQuery: wired() })
    await ask(bench)
    assert.equal(bench.lease.line.echo, 'present')
    bench.wire.onQuery = wired({ echo: false })
    await ask(bench)
    assert.equal(bench.lease.line.echo, 'unknown')
    await ask(bench)
    assert.equal(bench.lease.line.echo, 'absent')
    assert.equal(await put(bench), 'confirmed')
  })

  it('that was missed once confirms no write afterwards', async () => {
    const bench = createBench({ onQuery: wired({ echo: false }) })
    await ask(bench)
    assert.equal(bench.lease.line.echo, 'absent')
    bench.wire.onQuery = wired()
    await ask(bench)
    assert.equal(bench.lease.line.echo, 'unknown')
    bench.wire.onQuery = wired({ answers: false })
    assert.equal((await failure(put(bench))).code, 'TIMEOUT')
  })

  it('can be set', async () => {
    const on = createBench({ settings: { echo: 'on' }, onQuery: wired({ answers: false }) })
    assert.equal((await failure(put(on))).code, 'TIMEOUT')
    const off = createBench({ settings: { echo: 'off' }, onQuery: wired({ echo: false }) })
    assert.equal(await put(off), 'confirmed')
  })
})

describe('line: what is known of an echo', () => {
  const QUERY = Buffer.from('5105')
  const ANSWER = Buffer.from('4107')
  const create = (mode, start = 0) => {
    const time = { now: start }
    const echo = new Echo(mode, () => time.now)
    /** One query, with what is heard before its answer. */
    const step = (heard, answer = ANSWER) => {
      echo.sent(QUERY)
      const own = heard ? echo.look(heard) : 0
      if (heard && own === 0) echo.disturbed(heard)
      echo.answered(answer)
      return own
    }
    return { time, echo, step }
  }

  it('by the setting, whatever comes', () => {
    for (const [mode, state, own] of /** @type {[any, string, number][]} */ ([
      ['on', 'present', QUERY.length],
      ['off', 'absent', 0]
    ])) {
      const { time, echo, step } = create(mode)
      assert.equal(echo.state, state)
      echo.sent(QUERY)
      assert.equal(echo.expected, own)
      step(null)
      assert.equal(step(QUERY), own)
      assert.equal(echo.expected, 0)
      time.now = 1e6
      assert.equal(echo.state, state)
    }
  })

  it('nothing is heard: known by an answer that came clean and is no copy, and believed for half a second', () => {
    const { time, echo, step } = create('auto', 1000)
    assert.equal(echo.state, 'unknown')
    step(null)
    assert.equal(echo.state, 'absent')
    time.now = 1500
    assert.equal(echo.state, 'absent')
    time.now = 1501
    assert.equal(echo.state, 'unknown')
    assert.equal(step(null, QUERY), 0)
    assert.equal(echo.state, 'unknown', 'a copy proves nothing')
    step(Buffer.from('noise'))
    assert.equal(echo.state, 'unknown', 'nor what came behind noise')
    step(null)
    assert.equal(echo.state, 'absent')
  })

  it('what was thought to hear nothing is in doubt after a copy of ours', () => {
    const { echo, step } = create('auto')
    step(null)
    step(Buffer.from('noise'))
    assert.equal(echo.state, 'absent')
    step(Buffer.concat([Buffer.from('x'), QUERY]))
    assert.equal(echo.state, 'unknown')
    assert.equal(step(QUERY), QUERY.length)
    assert.equal(echo.state, 'present')
    echo.disturbed(QUERY)
    assert.equal(echo.state, 'present')
    echo.reset()
    assert.equal(echo.state, 'unknown')
  })

  it('a part of it is too few to tell; behind noise it is recognised', () => {
    const { echo } = create('on')
    echo.sent(QUERY)
    assert.equal(echo.look(QUERY.subarray(0, 1)), -1)
    assert.equal(echo.look(Buffer.from('x')), 0)
    assert.deepEqual([echo.begins(QUERY.subarray(0, 1)), echo.begins(ANSWER), echo.begins(QUERY)], [false, false, true])
    assert.equal(echo.look(Buffer.concat([QUERY, ANSWER])), QUERY.length)
    assert.equal(echo.begins(QUERY), false)
    assert.equal(echo.look(QUERY), 0)
  })
})
