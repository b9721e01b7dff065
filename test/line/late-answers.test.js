'use strict'

const assert = require('node:assert/strict')
const { Quarantine } = require('../../lib/line/quarantine')
const toy = require('./support/toy')

/** A quarantine at the time that the test says. */
const create = ({ hasPast = false } = {}) => {
  const clock = { at: 0, now: () => clock.at }
  const memories = new Map()
  const told = []
  const freed = []
  const quarantine = new Quarantine({
    clock,
    memories,
    hasPast,
    late: ({ station, lateness, timeout, bound }, frame) =>
      told.push([station, lateness, timeout, bound, frame.length]),
    freed: () => freed.push(clock.at)
  })
  const ask = (station, { timeout = 200, latenessBound = 0, nonce = 0, match = toy.answerTo(station, nonce) } = {}) => {
    quarantine.asks(station, { timeout, latenessBound })
    const due = clock.at + timeout
    return (seen = Buffer.alloc(0)) => quarantine.failed({ station, match, due, timeout, seen })
  }
  return { clock, quarantine, told, freed, ask, memories, readyAt: station => quarantine.readyAt(station) }
}

describe('line: what comes too late', () => {
  it('the silence is the timeout, one second at least, from where the answer was due', () => {
    for (const [options, bound] of [
      [{ timeout: 200 }, 1000],
      [{ timeout: 3000 }, 3000],
      [{ timeout: 3000, latenessBound: 50 }, 50]
    ]) {
      const { ask, clock, readyAt } = create()
      const failed = ask(1, options)
      clock.at = options.timeout
      failed()
      assert.equal(readyAt(1), options.timeout + bound)
      assert.equal(readyAt(2), 0, 'nobody has asked that one')
    }
  })

  it('one that is given up before it is due counts from there', () => {
    const { ask, clock, readyAt } = create()
    const failed = ask(1)
    clock.at = 20
    failed()
    assert.equal(readyAt(1), 1200)
  })

  it('where another may have asked before us, the first query waits from the opening on', () => {
    for (const [hasPast, expected] of [
      [true, 1500],
      [false, 0]
    ]) {
      const { ask, clock, quarantine, readyAt } = create({ hasPast })
      clock.at = 500
      quarantine.opened()
      ask(1)
      assert.equal(readyAt(1), expected)
    }
  })

  it('an opening holds back who was asked before, and nobody else', () => {
    const { ask, clock, quarantine, readyAt } = create()
    ask(1)
    quarantine.memory(2)
    clock.at = 500
    quarantine.opened()
    assert.deepEqual([readyAt(1), readyAt(2)], [1500, 0])
  })

  it('a silence whose end is seen late is listened to for a moment more', () => {
    for (const [late, expected] of [
      [0, 1200],
      [2, 1200],
      [3, 1213]
    ]) {
      const { ask, clock, readyAt } = create()
      const failed = ask(1)
      clock.at = 200
      failed()
      clock.at = 1200 + late
      assert.equal(readyAt(1), expected)
      assert.equal(readyAt(1), expected, 'once')
    }
  })

  it('a late answer is told, learnt × 1.5, and begins the silence anew; up to a minute', () => {
    for (const [lateness, learnt] of [
      [400, 1000],
      [900, 1350],
      [1700, 2550]
    ]) {
      const { ask, clock, quarantine, told, readyAt } = create()
      const failed = ask(1)
      clock.at = 200
      failed()
      clock.at = 200 + lateness
      quarantine.offer(Buffer.concat([Buffer.from('noise'), toy.answer(1, [7])]))
      assert.deepEqual(told, [[1, lateness, 200, learnt, 6]])
      assert.equal(readyAt(1), clock.at + learnt)
      quarantine.offer(toy.answer(1, [7]))
      assert.equal(told.length, 1, 'once')
    }
    const { ask, clock, quarantine, memories } = create()
    const failed = ask(1, { latenessBound: 100000 })
    clock.at = 200
    failed()
    clock.at = 150000
    quarantine.offer(toy.answer(1, [7]))
    assert.deepEqual([memories.get(1).lateness, memories.get(1).bound], [60000, 100000])
  })

  it('one in time that nobody waited for any more ends the silence, if it is the only one', () => {
    const { ask, clock, quarantine, freed, told, readyAt } = create()
    ask(1)()
    clock.at = 150
    quarantine.offer(toy.answer(1, [7]))
    assert.deepEqual([freed, told, readyAt(1)], [[150], [], 150])
    const two = create()
    const [first, second] = [two.ask(1), two.ask(1)]
    first()
    second()
    two.clock.at = 150
    two.quarantine.offer(toy.answer(1, [7]))
    assert.deepEqual([two.freed, two.readyAt(1)], [[], 1200])
  })

  it('is looked for as long as twice the bound, in what came in pieces, behind what is damaged', () => {
    const cut = toy.answer(1, [7, 8, 9])
    const { ask, clock, quarantine, told } = create()
    const failed = ask(1)
    clock.at = 200
    failed(cut.subarray(0, 3))
    clock.at = 2199
    quarantine.offer(cut.subarray(3, 5))
    quarantine.offer(cut.subarray(5))
    assert.equal(told.length, 1)
    const late = create()
    const again = late.ask(1)
    late.clock.at = 200
    again()
    late.clock.at = 2200
    late.quarantine.offer(cut)
    assert.deepEqual(late.told, [])
    const damaged = Buffer.from(cut)
    damaged[5] ^= 1
    const third = create()
    third.ask(1)()
    third.clock.at = 300
    third.quarantine.offer(Buffer.concat([damaged, cut]))
    assert.equal(third.told.length, 1)
  })

  it('who says of damaged bytes not how many loses all; who throws, or says nothing, sees nothing', () => {
    const bad = bytes => (bytes.length > 3 ? { bad: 'sum' } : { take: bytes.length })
    const { ask, clock, quarantine, told } = create()
    ask(1, { match: bad })()
    clock.at = 300
    quarantine.offer(Buffer.from('12345'))
    assert.deepEqual(told, [])
    quarantine.offer(Buffer.from('12'))
    assert.deepEqual(told, [[1, 100, 200, 1000, 2]])
    for (const match of [
      () => ({}),
      () => {
        throw new Error('broken')
      }
    ]) {
      const silent = create()
      silent.ask(1, { match })()
      silent.clock.at = 300
      silent.quarantine.offer(Buffer.from('12345'))
      silent.quarantine.answered(1, Buffer.from('1'))
      assert.deepEqual(silent.told, [])
    }
  })

  it('keeps the last 600 bytes', () => {
    const { ask, clock, quarantine, told } = create()
    let most = 0
    const match = bytes => {
      most = Math.max(most, bytes.length)
      return bytes.at(-1) === 9 ? { take: bytes.length } : { need: 5000 }
    }
    ask(1, { match })()
    clock.at = 300
    for (let n = 0; n < 5; n++) quarantine.offer(Buffer.alloc(200, 1))
    quarantine.offer(Buffer.from([9]))
    assert.deepEqual([most, told[0].at(-1)], [600, 600])
  })

  it('of several that one answer fits it is the newest one’s; 32 are remembered', () => {
    const { ask, clock, quarantine, told } = create()
    for (let n = 0; n < 40; n++) {
      clock.at = n
      ask(1)()
    }
    clock.at = 300
    for (let n = 0; n < 40; n++) quarantine.offer(toy.answer(1, [7]))
    assert.equal(told.length, 32)
    assert.deepEqual(
      told.map(([, lateness]) => lateness),
      Array.from({ length: 32 }, (_, n) => 61 + n)
    )
  })

  it('an answer that was taken leaves those that it fits too without a clue; of other stations nothing changes', () => {
    const { ask, clock, quarantine, told } = create()
    ask(1)()
    ask(2)()
    quarantine.answered(1, toy.answer(1, [7]))
    clock.at = 300
    quarantine.offer(toy.answer(1, [7]))
    quarantine.offer(toy.answer(2, [7]))
    assert.deepEqual(
      told.map(([station]) => station),
      [2]
    )
  })

  it('who has answered what was asked after all else is free at once; an older answer behind it says that answers overtake', () => {
    const { ask, clock, quarantine, memories, readyAt } = create()
    ask(1)()
    clock.at = 250
    quarantine.cleared(1)
    assert.equal(readyAt(1), 250)
    assert.equal(memories.get(1).overtaken, undefined)
    clock.at = 300
    quarantine.offer(toy.answer(1, [7]))
    assert.equal(memories.get(1).overtaken, true)
  })
})
