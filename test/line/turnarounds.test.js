'use strict'

const assert = require('node:assert/strict')
const { PRIORITY } = require('../../lib/line')
const { createPool, createNxPlc } = require('../../lib')
const { simulated } = require('../../lib/line/transports/memory')
const { createNxLine, createVirtualClock } = require('../../lib/sim')
const { Turnarounds } = require('../../lib/line/turnarounds')

const MARGIN = 0.5

describe('how long a station takes at least', () => {
  const after = (...list) => {
    const turnarounds = new Turnarounds()
    for (const ms of list) turnarounds.seen(1, ms)
    return turnarounds
  }

  it('is known after four answers: the least of them, and a little for the timer', () => {
    assert.equal(after().of(1), null)
    assert.equal(after(5, 7, 6).of(1), null)
    assert.equal(after(5, 7, 6, 8).of(1), 5 + MARGIN)
    assert.equal(after(5, 7, 6, 8).of(2), null, 'another one')
  })

  it('follows the last four, slower and faster', () => {
    assert.equal(after(5, 20, 22, 21, 23).of(1), 20 + MARGIN)
    assert.equal(after(20, 22, 21, 23, 4).of(1), 4 + MARGIN)
  })

  it('is looked at again each sixteenth time', () => {
    const turnarounds = after(5, 5, 5, 5)
    const seen = Array.from({ length: 48 }, () => turnarounds.of(1))
    const open = seen.flatMap((ms, at) => (ms === null ? [at] : []))
    assert.deepEqual(open, [15, 31, 47])
  })

  it('is not known of what is behind a port that was opened anew', () => {
    const turnarounds = after(5, 5, 5, 5)
    turnarounds.forget()
    assert.equal(turnarounds.of(1), null)
  })
})

describe('who is in a hurry', () => {
  /** Whether each query's answer is awaited from its first byte on. */
  const watched = async use => {
    const clock = createVirtualClock()
    const hurried = /** @type {boolean[]} */ ([])
    const told = (...given) => {
      const transport = simulated(...given)
      return Object.assign(transport, { hint: (_count, _at, once) => hurried.push(!once) })
    }
    const { wire } = createNxLine({ clock, baudRate: 38400, turnaround: 5, quiet: true, stations: [1, 2] })
    const pool = createPool({ clock, transports: { simulated: told } })
    const line = { transport: 'simulated', path: 'x', wire, baudRate: 38400, echo: 'off' }
    const lease = pool.open(line, { id: 'x', name: 'x' })
    const settings = { lease, clock, timeout: 500, access: 'write', writableRanges: 'M0' }
    const [plc, other] = [1, 2].map(station => createNxPlc({ ...settings, station }))
    const poll = (items = ['M0']) => plc.read(items, { priority: PRIORITY.POLL })
    for (let n = 0; n < 4; n++) await clock.run(poll())
    hurried.length = 0
    await clock.run(use({ plc, other, poll }))
    plc.close()
    other.close()
    await clock.run(lease.release())
    return hurried
  }

  it('nobody, for a poll while nothing else waits', async () => {
    assert.deepEqual(await watched(({ poll }) => poll()), [false])
  })

  it('who asks or writes', async () => {
    assert.deepEqual(await watched(({ plc }) => plc.read(['M0'])), [true])
    assert.deepEqual(await watched(({ plc }) => plc.write([{ item: 'M0', value: 1 }])), [true])
  })

  it('who waits behind a poll', async () => {
    const use = ({ other, poll }) => Promise.all([other.read(['M0']), poll(['M0']), poll(['M1'])])
    // the question; a poll while another one waits; that one
    assert.deepEqual(await watched(use), [true, true, false])
  })
})
