'use strict'

const assert = require('node:assert/strict')
const { realClock, timeText } = require('../../lib/line/clock')

const waited = ms => new Promise(resolve => realClock.setTimer(() => resolve(undefined), ms))

describe('line: the clock of the machine', () => {
  it('counts ms with fractions, tells the time of day, and fires no timer more than a moment too early', async () => {
    const from = realClock.now()
    assert.ok(Math.abs(realClock.wall() - Date.now()) < 1000)
    const fired = []
    realClock.clearTimer(realClock.setTimer(() => fired.push('cleared'), 1))
    realClock.clearTimer(undefined)
    await waited(15.2)
    assert.ok(realClock.now() - from >= 14.5)
    await waited(-5)
    assert.deepEqual(fired, [])
    assert.ok(Object.isFrozen(realClock))
  })

  it('lingers until a moment, for parts of a millisecond', () => {
    const until = realClock.now() + 0.6
    realClock.linger?.(until)
    const late = realClock.now() - until
    assert.ok(late >= 0, `${late}`)
    realClock.linger?.(until - 1000)
  })

  it('lingers almost without the processor, and not for long: others must get on', async () => {
    await waited(20)
    const { user, system } = process.cpuUsage()
    const from = realClock.now()
    realClock.linger?.(from + 1.9)
    const spent = process.cpuUsage({ user, system })
    assert.ok(realClock.now() - from >= 1.9)
    assert.ok(spent.user + spent.system < 1500, `${JSON.stringify(spent)} us`)
    const again = realClock.now() + 1000
    realClock.linger?.(again)
    assert.ok(realClock.now() < again, 'two ms at once at most')
  })

  it('a moment as a text, where a date can say it', () => {
    assert.equal(timeText(0), '1970-01-01T00:00:00.000Z')
    assert.equal(timeText(8.64e15), '+275760-09-13T00:00:00.000Z')
    assert.equal(timeText(-8.64e15), '-271821-04-20T00:00:00.000Z')
    for (const none of [8.64e15 + 2, -Infinity, NaN]) assert.equal(timeText(none), null)
  })
})
