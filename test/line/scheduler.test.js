'use strict'

const assert = require('node:assert/strict')
const { PlcError } = require('../../lib/error')
const { Scheduler } = require('../../lib/line/scheduler')
const { PRIORITY } = require('../../lib/line')
const { createLateClock } = require('./support/late-clock')

const SETTINGS = { queueLimit: 10, writesBeforePoll: 4 }

/** @param {Record<string, number>} readyAt when each station may be asked, ms */
const create = readyAt => {
  const clock = createLateClock()
  const woken = []
  const awake = () => woken.push(clock.now())
  const scheduler = new Scheduler({ clock, settings: SETTINGS, readyAt: station => readyAt[station], awake })
  const add = (station, { priority = PRIORITY.ASK, deadline = 0 } = {}) => {
    const late = limit => new PlcError('DEADLINE', { line: 'mill', limit })
    const run = scheduler.add(function* () {}, { station, priority, share: null, deadline }, late)
    run.join({}).catch(() => {})
    return run
  }
  return { clock, woken, scheduler, add }
}

describe('line: who may go', () => {
  it('is woken once, when the first of those who wait may be asked', () => {
    const readyAt = { a: 100, b: 50, c: 70 }
    const { clock, woken, scheduler, add } = create(readyAt)
    add('a')
    assert.deepEqual([scheduler.next(), clock.due()], [undefined, [100]])
    const b = add('b')
    assert.deepEqual([scheduler.next(), clock.due()], [undefined, [50]])
    add('c')
    assert.deepEqual([scheduler.next(), clock.due()], [undefined, [50]])
    clock.wake(50)
    assert.deepEqual([woken, clock.due()], [[50], []])
    assert.equal(scheduler.next(), b)
    // the same moment again is a new one
    readyAt.a = readyAt.c = 50
    clock.wake(49)
    assert.deepEqual([scheduler.next(), clock.due()], [undefined, [50]])
    scheduler.sleep()
    assert.deepEqual(clock.due(), [])
  })

  it('one that keeps its station waits alone for it; nobody else of the station is woken, or goes before', () => {
    const { clock, scheduler, add } = create({ a: 0, b: 0 })
    const held = add('a', { priority: PRIORITY.POLL })
    assert.equal(scheduler.next(), held)
    scheduler.hold(held)
    const other = add('a', { priority: PRIORITY.WRITE })
    const gone = add('a', { priority: PRIORITY.WRITE })
    scheduler.discard(gone, new PlcError('LINE_CLOSED', { line: 'mill' }))
    assert.deepEqual([scheduler.next(), scheduler.next(), scheduler.next()], [held, other, undefined])
    assert.deepEqual(clock.due(), [])
  })

  it('while the station is kept it is the keeper that is woken', () => {
    const readyAt = { a: 0 }
    const { clock, scheduler, add } = create(readyAt)
    const held = add('a', { priority: PRIORITY.POLL })
    scheduler.next()
    scheduler.hold(held)
    add('a', { priority: PRIORITY.WRITE })
    readyAt.a = 30
    assert.deepEqual([scheduler.next(), clock.due()], [undefined, [30]])
    scheduler.discard(held, new PlcError('LINE_CLOSED', { line: 'mill' }))
    clock.wake(30)
    assert.equal(scheduler.next()?.priority, PRIORITY.WRITE)
  })

  it('a deadline is for waiting', () => {
    const { clock, scheduler, add } = create({ a: 0 })
    add('a', { deadline: 20 })
    assert.deepEqual(clock.due(), [20])
    scheduler.next()
    assert.deepEqual(clock.due(), [])
    add('a', { deadline: 20 })
    clock.wake(20)
    assert.deepEqual([scheduler.size, scheduler.next()], [0, undefined])
  })
})
