'use strict'

const assert = require('node:assert/strict')
const { Pace } = require('../../../lib/line/transports/pace')

/** A clock of whole ms whose timers are late, as those of the machine; what is set and lingered for is noted. */
const create = ({ late = 0.1, lazy = false } = {}) => {
  const bench = { time: 0, log: /** @type {any[]} */ ([]), timer: /** @type {any} */ (null), woken: 0 }
  const clock = {
    now: () => bench.time,
    wall: () => 0,
    setTimer: (fn, ms) => {
      bench.log.push(ms)
      bench.timer = { fn, at: bench.time + ms + late }
      return bench.timer
    },
    clearTimer: timer => {
      if (timer === bench.timer) bench.timer = null
    },
    linger: until => {
      bench.log.push(`until ${until.toFixed(2)}`)
      if (!lazy) bench.time = until
    }
  }
  const pace = new Pace(clock)
  const fire = () => {
    const { fn, at } = bench.timer
    bench.time = at
    bench.timer = null
    fn()
  }
  const sleep = () => pace.sleep(() => bench.woken++)
  return Object.assign(bench, { pace, fire, sleep })
}

describe('when the next bytes can be there', () => {
  for (const [ms, log, end] of /** @type {[number, any[], string][]} */ ([
    [25.4, [25, 'until 25.05'], '25.10'],
    [25.5, [25, 'until 25.15'], '25.15'],
    [25.1, [24, 'until 24.75'], '24.75'],
    [264.6, [263, 'until 263.77'], '263.77'],
    [1.5, [1, 'until 1.20'], '1.20']
  ])) {
    it(`in ${ms} ms: a timer, and what is left of a ms without one; a little early, since the byte before was seen a little late`, () => {
      const bench = create()
      bench.pace.hint(ms)
      bench.sleep()
      bench.fire()
      assert.equal(bench.woken, 1)
      const [whole, rest] = bench.log
      assert.deepEqual([whole, rest], log)
      assert.equal(Math.max(bench.time, whole + 0.1).toFixed(2), end)
      assert.equal(bench.timer, null)
    })
  }

  it('within a ms or so: nobody sleeps', () => {
    const bench = create()
    for (const ms of [1.1, 0, -3, -Infinity]) {
      bench.pace.hint(ms)
      assert.equal(bench.sleep(), false)
    }
    assert.deepEqual(bench.log, [])
  })

  it('behind a timer that came far too early nobody lingers for long', () => {
    const bench = create({ late: -5 })
    bench.pace.hint(25.4)
    bench.sleep()
    bench.fire()
    assert.equal(bench.woken, 1)
    assert.deepEqual([bench.log, bench.time], [[25], 20])
  })

  it('a ms more or less, where nobody asks when the first byte comes', () => {
    for (const [ms, whole] of [
      [25.4, 25],
      [25.9, 26],
      [1.7, 1]
    ]) {
      const bench = create()
      bench.pace.hint(ms, true)
      bench.sleep()
      bench.fire()
      assert.equal(bench.woken, 1)
      assert.deepEqual(bench.log, [whole], `${ms}`)
    }
  })

  it('who waits for the first byte is told to sleep where that is worth it: from two ms on', () => {
    const bench = create()
    let givenUp = 0
    bench.pace.watch(() => givenUp++)
    bench.time = 1000
    for (const ms of [1.9, -2000]) bench.pace.hint(1000 + ms, true)
    bench.pace.hint(1030)
    assert.equal(givenUp, 0)
    bench.pace.hint(1002, true)
    assert.equal(givenUp, 1)
  })

  it('who sleeps is woken at the end, without a timer that is left', () => {
    const bench = create()
    bench.pace.hint(25.4)
    bench.sleep()
    for (let n = 0; n < 2; n++) bench.pace.stop()
    assert.deepEqual([bench.log, bench.timer, bench.woken], [[25], null, 1])
    assert.equal(bench.sleep(), false)
  })
})
