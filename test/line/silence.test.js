'use strict'

const assert = require('node:assert/strict')
const { Alarm } = require('../../lib/line/alarm')
const { Silence } = require('../../lib/line/silence')
const { createLateClock } = require('./support/late-clock')

describe('line: an alarm', () => {
  const setTo = at => {
    const clock = createLateClock()
    const alarm = new Alarm(clock)
    const rung = []
    alarm.set(at, () => rung.push(clock.now()))
    return { clock, alarm, rung }
  }

  it('rings at its moment, once; up to 10 ms late is in time', () => {
    for (const at of [100, 110]) {
      const { clock, rung } = setTo(100)
      clock.wake(99)
      assert.deepEqual(rung, [])
      clock.wake(at)
      assert.deepEqual([rung, clock.due()], [[at], []])
    }
  })

  it('later than that it gives what came meanwhile the same time to be read, 250 ms at most, and once', () => {
    for (const [woken, due] of [
      [111, 122],
      [140, 180],
      [1100, 1350]
    ]) {
      const { clock, rung } = setTo(100)
      clock.wake(woken)
      assert.deepEqual([rung, clock.due()], [[], [due]])
      clock.wake(due + 500)
      assert.deepEqual([rung, clock.due()], [[due + 500], []])
    }
  })

  it('set to a moment that has passed it rings at once; stopped, or set anew, it does not ring', () => {
    const { clock, alarm, rung } = setTo(100)
    clock.wake(50)
    alarm.set(20, () => rung.push('at once'))
    assert.deepEqual(clock.due(), [50])
    clock.wake(50)
    assert.deepEqual(rung, ['at once'])
    alarm.set(60, () => rung.push('stopped'))
    alarm.stop()
    clock.wake(100)
    assert.deepEqual(rung, ['at once'])
  })
})

describe('line: a silence', () => {
  const waitFor = (ms, givenUp) => {
    const clock = createLateClock()
    const heard = { last: 0 }
    const silence = new Silence({ clock, quietSince: () => heard.last })
    const done = []
    silence.wait(ms, () => done.push(clock.now()), givenUp)
    return { clock, heard, silence, done }
  }

  it('is over at its end, seen up to 5 ms late', () => {
    assert.deepEqual(waitFor(0).done, [0])
    for (const at of [10, 14.9]) {
      const { clock, done } = waitFor(10)
      clock.wake(9)
      assert.deepEqual(done, [])
      clock.wake(at)
      assert.deepEqual([done, clock.due()], [[at], []])
    }
  })

  it('seen later what nobody has read yet gets 5 ms, once', () => {
    for (const woken of [20, 60]) {
      const { clock, done } = waitFor(10)
      clock.wake(15)
      assert.deepEqual([done, clock.due()], [[], [20]])
      clock.wake(woken)
      assert.deepEqual([done, clock.due()], [[woken], []])
    }
  })

  it('a byte begins it anew, and whoever asked may give up', () => {
    const { clock, heard, done } = waitFor(10, now => now >= 27)
    heard.last = 8
    clock.wake(10)
    assert.deepEqual(clock.due(), [18])
    heard.last = 17
    clock.wake(18)
    assert.deepEqual([done, clock.due()], [[], [27]])
    heard.last = 26
    clock.wake(27)
    assert.deepEqual([done, clock.due()], [[], []])
  })

  it('that was stopped is never over', () => {
    const { clock, silence, done } = waitFor(10)
    silence.stop()
    clock.wake(10)
    assert.deepEqual(done, [])
  })
})
