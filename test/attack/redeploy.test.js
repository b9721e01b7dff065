'use strict'

const assert = require('node:assert')
const { createPool } = require('../../lib/line')
const { createVirtualClock } = require('../../lib/sim')

/** A port that takes its time to close, as a serial port does whose last frame is still going out. */
const slowPorts = clock => {
  const seen = { open: 0, most: 0, opened: 0 }
  const transport = () => ({
    open(handlers) {
      clock.setTimer(() => {
        seen.opened++
        seen.most = Math.max(seen.most, ++seen.open)
        handlers.opened()
      }, 1)
    },
    write: (_bytes, done) => done(),
    hint() {},
    close: done =>
      clock.setTimer(() => {
        seen.open--
        done()
      }, 300),
    id: () => 'the device'
  })
  return { seen, transport }
}

describe('attack: redeploys faster than the port closes', () => {
  it('the third line waits for the first one’s port, and is not told that its own wire is in use', async () => {
    const clock = createVirtualClock()
    const { seen, transport } = slowPorts(clock)
    const pool = createPool({ clock, random: () => 0.5, transports: { serial: transport } })
    const open = id => pool.open({ transport: 'serial', path: '/dev/ttyS0' }, { id, name: id })
    const first = open('first')
    await clock.advance(10)
    first.release()
    open('second').release()
    const third = open('third')
    assert.deepEqual([third.line.state, third.line.reason], ['opening', null])
    await clock.advance(302)
    assert.deepEqual([third.line.state, seen.most, seen.opened], ['open', 1, 2])
    await clock.run(third.release())
    assert.deepEqual([clock.pending(), pool.lines().length, seen.open], [0, 0, 0])
  })
})
