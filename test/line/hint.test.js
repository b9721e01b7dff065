'use strict'

const assert = require('node:assert/strict')
const { Echo } = require('../../lib/line/echo')
const { Exchange } = require('../../lib/line/exchange')
const { createVirtualClock } = require('../../lib/sim')
const toy = require('./support/toy')

const CHARACTER = 1 // ms
const SENT = 4 // bytes of a query
const SHORTEST = 5

/** An exchange over a transport of the test; `hints`: for how many bytes nobody needs to read until when. */
const begin = ({
  usual,
  slack = 50,
  echo = /** @type {any} */ ('off'),
  timeout = 200,
  character = CHARACTER,
  slow = false
}) => {
  const clock = createVirtualClock()
  const bench = {
    clock,
    hints: /** @type {number[][]} */ ([]),
    once: /** @type {boolean[]} */ ([]),
    ended: /** @type {any[]} */ ([]),
    written: /** @type {any} */ (null)
  }
  const link = {
    name: 'test',
    write: (_bytes, done) => (slow ? (bench.written = done) : done()),
    hint: (count, at, once = false) => {
      bench.hints.push([count, at])
      bench.once.push(once)
    },
    waiting: () => false,
    stray() {},
    skipped() {},
    echoed() {}
  }
  const times = { character, gap: 0, slack }
  const settings = { jamTime: 1000, writeTimeout: 1000 }
  const exchange = new Exchange({ clock, settings, times, echo: new Echo(echo, clock.now), link })
  const done = (error, answer) => bench.ended.push(error?.code ?? answer.length)
  const ask = ({ calm = false, ...more }) => {
    const step = { send: toy.query(5), match: toy.answerTo(5), timeout, usual, ...more }
    exchange.start(step, { gap: 0, station: 5, calm, sent() {}, done })
  }
  ask({})
  const come = async (ms, bytes) => {
    await clock.advance(ms - clock.now())
    exchange.data(bytes)
  }
  /** Its last byte comes so many ms after the query has left. */
  const answerIn = async (ms, { parts = 1, values = 20 } = {}) => {
    const answer = toy.answer(5, Array(values).fill(7))
    const end = exchange.sendEnd + ms
    if (parts > 1) await come(end - 20, answer.subarray(0, 5))
    await come(end, parts > 1 ? answer.subarray(5) : answer)
  }
  /** For how many bytes the next one waits. */
  const next = (more = {}) => {
    ask(more)
    return bench.hints.at(-1)?.[0]
  }
  const opened = () => exchange.opened('again')
  return Object.assign(bench, { come, answerIn, next, opened, last: () => bench.hints.at(-1) })
}

describe('what the transport is told to wait for', () => {
  const answer = toy.answer(5, Array(20).fill(7))

  it('the shortest answer, then what its header says', async () => {
    const bench = begin({ usual: undefined })
    assert.deepEqual(bench.last(), [SHORTEST, SENT + SHORTEST])
    await bench.come(10, answer.subarray(0, 1))
    assert.deepEqual(bench.last(), [SHORTEST - 1, 10 + SHORTEST - 1])
    await bench.come(14, answer.subarray(1, 5))
    assert.deepEqual(bench.last(), [20, 14 + 20])
    await bench.come(34, answer.subarray(5))
    assert.deepEqual(bench.ended, [25])
  })

  it('behind a slow write: what is missing of an answer that has begun, with its echo', async () => {
    const bench = begin({ usual: 25, echo: 'on', slow: true })
    await bench.come(3, Buffer.concat([toy.query(5), answer.subarray(0, 2)]))
    bench.written()
    assert.deepEqual(bench.last(), [23, SENT + 23])
    await bench.come(30, answer.subarray(2))
    assert.deepEqual(bench.ended, [25])
  })

  it('by the time that a character takes', async () => {
    const bench = begin({ usual: 15, character: 2 })
    assert.deepEqual(bench.last(), [15, 2 * (SENT + 15)])
    await bench.come(12, answer.subarray(0, 5))
    assert.deepEqual(bench.last(), [20, 12 + 2 * 20])
  })

  it('the usual answer at once, where an error would be seen hardly later', async () => {
    const bench = begin({ usual: 25 })
    assert.deepEqual(bench.last(), [25, SENT + 25])
    await bench.come(10, answer.subarray(0, 1))
    assert.deepEqual(bench.last(), [24, 34])
    await bench.come(34, answer.subarray(1))
    assert.deepEqual([bench.ended, bench.hints.length], [[25], 2])
  })

  it('what is still missing after a sleep may be there a character sooner: the last byte that has come was not seen coming', async () => {
    const bench = begin({ usual: 25 })
    await bench.come(10, answer.subarray(0, 1))
    await bench.come(34.25, answer.subarray(1, 20))
    assert.deepEqual(bench.last(), [5, 33.25 + 5])
    await bench.come(38.25, answer.subarray(20, 24))
    assert.deepEqual(bench.last(), [1, 38.25], 'at once')
    await bench.come(38.5, answer.subarray(24))
    assert.deepEqual(bench.ended, [25])
  })

  it('by the first byte, and by the time that a character takes', async () => {
    const bench = begin({ usual: 25, character: 2 })
    await bench.come(20, answer.subarray(0, 1))
    await bench.come(43, answer.subarray(1, 12))
    assert.deepEqual(bench.last(), [13, 20 + 11 * 2 + 13 * 2])
  })

  it('by the first byte, where a sleep was short', async () => {
    const bench = begin({ usual: 25 })
    await bench.come(10, answer.subarray(0, 4))
    await bench.come(12.5, answer.subarray(4, 6))
    assert.deepEqual(bench.last(), [19, 12 + 19])
    await bench.come(12.75, answer.subarray(6, 7))
    assert.deepEqual(bench.last(), [18, 12.75 + 18], 'an adapter brings some faster than the wire')
  })

  it('not where it would be seen more than 25 ms later, or half the slack', () => {
    for (const [options, count] of /** @type {[any, number][]} */ ([
      [{ usual: SHORTEST + 25 }, 30],
      [{ usual: SHORTEST + 26 }, SHORTEST],
      [{ usual: SHORTEST + 10, slack: 20 }, 15],
      [{ usual: SHORTEST + 11, slack: 20 }, SHORTEST],
      [{ usual: SHORTEST }, SHORTEST]
    ])) {
      assert.deepEqual(begin(options).last(), [count, SENT + count], JSON.stringify(options))
    }
  })

  describe('after an answer as long as usual', () => {
    const good = async (more = {}) => {
      const bench = begin({ usual: 25, timeout: 1000, ...more })
      await bench.come(30, answer)
      assert.deepEqual(bench.ended, [25])
      return bench
    }

    it('an error may be seen 60 ms later, or a quarter of the timeout', async () => {
      assert.equal((await good()).next({ usual: SHORTEST + 60 }), SHORTEST + 60)
      assert.equal((await good()).next({ usual: SHORTEST + 61 }), SHORTEST)
      assert.equal((await good()).next({ usual: SHORTEST + 50, timeout: 200 }), SHORTEST + 50)
      assert.equal((await good()).next({ usual: SHORTEST + 51, timeout: 200 }), SHORTEST)
    })

    for (const [what, then] of /** @type {[string, (bench: any) => any][]} */ ([
      ['an error', bench => bench.come(100, toy.answer(5, []))],
      ['silence', bench => bench.clock.advance(1100)]
    ])) {
      it(`no longer after ${what}, until the next good one`, async () => {
        const bench = await good()
        bench.next()
        await then(bench)
        assert.equal(bench.ended.length, 2)
        assert.equal(bench.next({ usual: SHORTEST + 60 }), SHORTEST)
        await bench.come(bench.clock.now() + 70, toy.answer(5, Array(60).fill(7)))
        assert.equal(bench.next({ usual: SHORTEST + 60 }), SHORTEST + 60)
      })
    }

    it('no longer after the port was opened anew', async () => {
      const bench = await good()
      bench.opened()
      assert.equal(bench.next({ usual: SHORTEST + 60 }), SHORTEST)
    })
  })

  describe('where nobody is in a hurry', () => {
    const TOOK = 10
    const MARGIN = 0.5
    const WHOLE = TOOK + 25
    /** Four answers, read byte by byte as far as it matters. */
    const known = async (more = {}) => {
      const bench = begin({ usual: 25, timeout: 200, ...more })
      for (let n = 0; n < 4; n++) {
        if (n > 0) bench.next()
        await bench.answerIn(WHOLE)
      }
      return bench
    }
    const hint = bench => bench.hints.at(-1)
    const wholeAt = bench => bench.clock.now() + SENT + WHOLE + MARGIN

    it('once, when the whole answer is there, as long as the station has taken lately', async () => {
      const bench = await known()
      const at = wholeAt(bench)
      bench.next({ calm: true })
      assert.deepEqual([hint(bench), bench.once.at(-1)], [[25, at], true])
      bench.next({ calm: true })
    })

    it('not where somebody is', async () => {
      const bench = await known()
      const now = bench.clock.now()
      bench.next()
      assert.deepEqual(hint(bench), [25, now + SENT + 25])
      assert.equal(bench.once.at(-1), false)
    })

    it('not after so long that the timer of its timeout might come before', async () => {
      const bench = await known()
      const [now, took] = [bench.clock.now(), SHORTEST + TOOK + MARGIN]
      bench.next({ calm: true, usual: undefined, timeout: took + 5 })
      assert.deepEqual(hint(bench), [SHORTEST, now + SENT + SHORTEST])
      await bench.answerIn(WHOLE - 25 + SHORTEST, { values: 0 })
      const then = bench.clock.now()
      bench.next({ calm: true, usual: undefined, timeout: took + 5.1 })
      assert.deepEqual(hint(bench), [SHORTEST, then + SENT + took])
    })

    it('an answer that was there when it was looked at tells nothing of the station; one that came then does', async () => {
      const bench = await known()
      for (let n = 0; n < 8; n++) {
        bench.next({ calm: true })
        await bench.answerIn(WHOLE + 30)
      }
      let at = wholeAt(bench)
      bench.next({ calm: true })
      assert.deepEqual(hint(bench), [25, at])
      await bench.answerIn(WHOLE)
      for (let n = 0; n < 4; n++) {
        bench.next({ calm: true })
        await bench.answerIn(WHOLE + 7, { parts: 2 })
      }
      at = wholeAt(bench) + 7
      bench.next({ calm: true })
      assert.deepEqual(hint(bench), [25, at])
    })

    it('nothing is known after a failure but of the length, after an opening nothing at all', async () => {
      const bench = await known()
      bench.next()
      await bench.clock.advance(300)
      const at = wholeAt(bench)
      bench.next({ calm: true })
      assert.deepEqual(hint(bench), [25, at])
      await bench.answerIn(WHOLE)
      bench.opened()
      const now = bench.clock.now()
      bench.next({ calm: true })
      assert.deepEqual(hint(bench), [25, now + SENT + 25])
    })

    it('a step without an answer tells nothing', async () => {
      const bench = await known()
      for (let n = 0; n < 4; n++) {
        bench.next({ match: undefined, turnaround: 100 })
        await bench.clock.advance(150)
      }
      const at = wholeAt(bench)
      bench.next({ calm: true })
      assert.deepEqual(hint(bench), [25, at])
    })
  })

  it('an error that came meanwhile is seen then, and its header is believed, not what is usual', async () => {
    const bench = begin({ usual: 25 })
    await bench.come(10, answer.subarray(0, 1))
    await bench.come(34, toy.answer(5, []).subarray(1))
    assert.deepEqual(bench.ended, [SHORTEST])
    const longer = begin({ usual: 8 })
    await longer.come(10, answer.subarray(0, 6))
    assert.deepEqual(longer.last(), [19, 29])
  })

  it('an answer that stops is over by its own time, before which the transport has read', async () => {
    const bench = begin({ usual: 30 })
    await bench.come(200, answer.subarray(0, 1))
    const [, until] = /** @type {number[]} */ (bench.last())
    await bench.clock.advance(until - bench.clock.now())
    assert.deepEqual(bench.ended, [])
    await bench.clock.advance(100)
    assert.deepEqual(bench.ended, ['TIMEOUT'])
  })

  it('behind our own echo', async () => {
    const bench = begin({ usual: 25, echo: 'on' })
    assert.deepEqual(bench.last(), [SENT + 25, SENT + 25])
    await bench.come(1, toy.query(5).subarray(0, 1))
    assert.deepEqual(bench.last(), [SENT + 24, 1 + SENT + 24])
    await bench.come(29, Buffer.concat([toy.query(5).subarray(1), answer.subarray(0, 20)]))
    assert.deepEqual(bench.last(), [5, 34])
  })
})
