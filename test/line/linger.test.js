'use strict'

const assert = require('node:assert/strict')
const { createLinger } = require('../../lib/line/linger')

const LATE = 0.08

/** A machine whose clock goes on by a thousandth each time that it is looked at. */
const create = (start = 1000) => {
  const bench = { time: start, naps: /** @type {number[]} */ ([]), linger: /** @type {any} */ (null) }
  const nap = ms => {
    bench.naps.push(Math.round(ms * 100) / 100)
    bench.time += ms + LATE
  }
  bench.linger = createLinger({ now: () => (bench.time += 0.001), nap })
  /** For so many ms from now on. @returns {boolean} whether it lasted so long, and hardly longer */
  const lingers = ms => {
    const until = bench.time + ms
    bench.linger(until)
    const late = bench.time - until
    if (late >= 0) assert.ok(late < 0.01, `${late} ms too long`)
    return late >= 0
  }
  return Object.assign(bench, { lingers })
}

describe('lingering for parts of a millisecond', () => {
  it('is a nap, a little shorter, since it takes a little longer', () => {
    const bench = create()
    assert.ok(bench.lingers(0.7))
    assert.deepEqual(bench.naps, [0.62])
  })

  it('is not worth a nap for the last moments; what is over is over', () => {
    const bench = create()
    for (const ms of [0.08, 0.01, 0, -5]) assert.ok(bench.time + ms <= bench.time || bench.lingers(ms))
    const before = bench.time
    bench.linger(before - 5)
    assert.ok(bench.time - before < 0.01)
    assert.deepEqual(bench.naps, [])
  })

  it('takes two ms at once at most, then a tenth of the time, however long there was none', () => {
    for (const long of [0, 7, 100000]) {
      const bench = create()
      bench.time += long
      assert.deepEqual(
        [1, 1, 0.5].map(ms => bench.lingers(ms)),
        [true, true, false],
        `${long}`
      )
      const before = bench.time
      assert.equal(bench.lingers(0.9), false)
      assert.ok(bench.time - before < 0.01, 'returns at once')
      bench.time += 5
      assert.deepEqual([bench.lingers(1), bench.lingers(0.9)], [false, true])
      bench.time += 4
      assert.deepEqual([bench.lingers(0.7), bench.lingers(0.5)], [false, true])
      assert.ok(bench.lingers(0.07), 'without a nap at any time')
    }
  })

  it('in the long run a tenth', () => {
    const bench = create(0)
    let slept = 0
    for (let n = 0; n < 10000; n++) {
      const before = bench.time
      bench.linger(before + 0.9)
      slept += bench.time - before > 0.5 ? bench.time - before : 0
      bench.time += 1
    }
    assert.ok(slept / bench.time > 0.09 && slept / bench.time < 0.115, `${slept / bench.time}`)
  })
})
