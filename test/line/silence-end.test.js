'use strict'

const assert = require('node:assert/strict')
const { Silence } = require('../../lib/line/silence')

/** A clock of whole ms whose timers are late, as those of the machine; what is set and lingered for is noted. */
const create = ({ late = 0.1, linger = true, lazy = false } = {}) => {
  const bench = { time: 0, quiet: 0, log: /** @type {any[]} */ ([]), timer: /** @type {any} */ (null) }
  const clock = {
    now: () => bench.time,
    setTimer: (fn, ms) => {
      bench.log.push(Math.round(ms * 10) / 10)
      bench.timer = { fn, at: bench.time + Math.ceil(ms) + late }
      return bench.timer
    },
    clearTimer: () => {},
    ...(linger && {
      linger: until => {
        bench.log.push(`until ${until}`)
        if (!lazy) bench.time = until
      }
    })
  }
  const silence = new Silence({ clock, quietSince: () => bench.quiet })
  const fire = () => {
    const { fn, at } = bench.timer
    bench.timer = null
    bench.time = at
    fn()
  }
  return Object.assign(bench, { silence, fire })
}

describe('silence before a frame', () => {
  for (const [ms, log, end] of /** @type {[number, any[], number][]} */ ([
    [4, [4], 4.1],
    [3.3, [3, 'until 3.3'], 3.3],
    [3.6, [3, 'until 3.6'], 3.6],
    [1.75, [1, 'until 1.75'], 1.75],
    [0.9, ['until 0.9'], 0.9],
    [1, [1], 1.1],
    [10.05, [10], 10.1],
    [0.3, ['until 0.3'], 0.3]
  ])) {
    it(`of ${ms} ms is over after ${end} where timers are a little late`, () => {
      const bench = create()
      let over = -1
      bench.silence.wait(ms, () => (over = bench.time))
      if (bench.timer) bench.fire()
      assert.deepEqual([bench.log, over], [log, end])
    })
  }

  it('is waited for by a timer where there is no lingering any more', () => {
    const bench = create({ lazy: true })
    let over = -1
    bench.silence.wait(3.6, () => (over = bench.time))
    while (bench.timer) bench.fire()
    assert.deepEqual(bench.log, [3, 'until 3.6', 0.5])
    assert.ok(Math.abs(over - 4.2) < 0.001, `${over}`)
  })

  it('is never shorter where a timer comes early', () => {
    const bench = create({ late: -0.9 })
    let over = -1
    bench.silence.wait(3.3, () => (over = bench.time))
    while (bench.timer) bench.fire()
    assert.ok(over >= 3.3, String(over))
  })

  it('begins again with a byte that came while it was waited for', () => {
    const bench = create()
    let over = -1
    bench.silence.wait(3.3, () => (over = bench.time))
    bench.quiet = 2
    bench.fire()
    assert.equal(over, -1)
    bench.fire()
    assert.ok(over >= 5.3, String(over))
  })

  it('is left to timers alone where the clock is exact', () => {
    const bench = create({ late: 0, linger: false })
    let over = -1
    bench.silence.wait(3.3, () => (over = bench.time))
    bench.fire()
    assert.deepEqual([bench.log, over], [[3.3], 4])
  })
})
