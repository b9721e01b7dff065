'use strict'

const assert = require('node:assert')
const { createVirtualClock } = require('../../lib/sim/clock')
const { createRandom } = require('../../lib/sim/random')

describe('virtual clock', () => {
  it('runs timers by time, then in the order in which they were set', async () => {
    const clock = createVirtualClock()
    const seen = []
    for (const [ms, name] of [
      [5, 'd'],
      [1, 'b'],
      [0, 'a'],
      [1, 'c'],
      [5, 'e']
    ]) {
      clock.setTimer(() => seen.push(`${name}@${clock.now()}`), Number(ms))
    }
    await clock.advance(5)
    assert.deepStrictEqual(seen, ['a@0', 'b@1', 'c@1', 'd@5', 'e@5'])
    assert.strictEqual(clock.pending(), 0)
  })

  it('agrees with a sorted list on thousands of random timers, set and cleared', async () => {
    const random = createRandom(11)
    const clock = createVirtualClock()
    const seen = []
    const timers = Array.from({ length: 3000 }, (_, n) => {
      const at = random.integer(0, 500)
      return { at, n, timer: clock.setTimer(() => seen.push(n), at, { quiet: true }) }
    })
    const kept = timers.filter(({ timer }) => !random.chance(0.3) || void clock.clearTimer(timer))
    assert.strictEqual(clock.pending(), kept.length)
    await clock.drain()
    const expected = kept.sort((a, b) => a.at - b.at || a.n - b.n).map(({ n }) => n)
    assert.deepStrictEqual(seen, expected)
  })

  it('advance stops exactly: later timers wait', async () => {
    const clock = createVirtualClock()
    let late = 0
    clock.setTimer(() => late++, 10.5)
    await clock.advance(10)
    assert.deepStrictEqual([clock.now(), late], [10, 0])
    await clock.advance(0.5)
    assert.deepStrictEqual([clock.now(), late], [10.5, 1])
  })

  it('lets promises come to rest before time goes on', async () => {
    const clock = createVirtualClock()
    const sleep = ms => new Promise(resolve => clock.setTimer(() => resolve(undefined), ms))
    const log = []
    const chain = async () => {
      await sleep(1)
      for (let depth = 0; depth < 20; depth++) await null
      log.push(`chain ${clock.now()}`)
    }
    clock.setTimer(() => log.push('two'), 2)
    await clock.run(Promise.all([chain(), sleep(3)]))
    assert.deepStrictEqual(log, ['chain 1', 'two'])
  })

  it('run settles as its promise does', async () => {
    const clock = createVirtualClock()
    const later = value => new Promise(resolve => clock.setTimer(() => resolve(value), 5))
    assert.strictEqual(await clock.run(later(7)), 7)
    await assert.rejects(
      clock.run(async () => {
        await later(1)
        throw new Error('no')
      }),
      /no/
    )
    assert.strictEqual(clock.now(), 10)
  })

  it('names what is open when nothing can happen any more', async () => {
    const clock = createVirtualClock()
    const done = clock.work('write K0')
    const stuck = clock.run(new Promise(() => {}), { name: 'read M0' })
    await assert.rejects(stuck, error => error.code === 'SIM_DEADLOCK' && /write K0, read M0/.test(error.message))
    await assert.rejects(clock.drain(), { code: 'SIM_DEADLOCK' })
    done()
    done()
    await clock.drain()
  })

  it('run has a limit of virtual time', async () => {
    const clock = createVirtualClock()
    const again = () => clock.setTimer(again, 1, { quiet: true })
    again()
    await assert.rejects(clock.run(new Promise(() => {}), { limit: 1000 }), { code: 'SIM_DEADLOCK' })
    assert.strictEqual(clock.now(), 1000)
  })

  it('hands on what an event throws', async () => {
    const clock = createVirtualClock()
    clock.setTimer(() => {
      throw new Error('in the event')
    }, 1)
    await assert.rejects(clock.advance(5), /in the event/)
  })

  it('the wall clock jumps alone', () => {
    const clock = createVirtualClock({ start: 100, epoch: 1e12 })
    clock.jumpWall(-3600e3)
    assert.deepStrictEqual([clock.now(), clock.wall()], [100, 1e12 + 100 - 3600e3])
  })
})

describe('random', () => {
  it('is decided by the seed', () => {
    const draw = seed => Array.from({ length: 50 }, createRandom(seed).next)
    assert.deepStrictEqual(draw(7), draw(7))
    assert.notDeepStrictEqual(draw(7), draw(8))
    assert.ok(draw(9).every(x => x >= 0 && x < 1))
  })

  it('is even enough', () => {
    const random = createRandom(3)
    const counts = new Array(10).fill(0)
    for (let n = 0; n < 100000; n++) counts[random.integer(0, 9)]++
    assert.ok(
      counts.every(count => Math.abs(count - 10000) < 500),
      String(counts)
    )
  })
})
