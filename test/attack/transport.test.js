'use strict'

const assert = require('node:assert')
const { createPool } = require('../../lib/line')
const { createVirtualClock } = require('../../lib/sim')
const toy = require('../line/support/toy')

const nothing = () => {}
const opens = clock => handlers => clock.setTimer(() => handlers.opened(), 1)
const base = clock => ({
  open: opens(clock),
  write: (_bytes, done) => done(),
  hint: nothing,
  close: done => done(),
  id: () => 1
})

/** Transports that break their contract, each in its own way. */
const BROKEN = {
  'never opens': clock => ({ ...base(clock), open: nothing }),
  'opens within the call': clock => ({ ...base(clock), open: handlers => handlers.opened() }),
  'says twice that it is open': clock => ({
    ...base(clock),
    open: handlers =>
      clock.setTimer(() => {
        handlers.opened()
        handlers.opened()
      }, 1)
  }),
  'throws when it is opened': clock => ({ ...base(clock), open: () => assert.fail('open') }),
  'has no identity': clock => ({ ...base(clock), id: () => assert.fail('id') }),
  'throws when it is written to': clock => ({ ...base(clock), write: () => assert.fail('write') }),
  'never takes the bytes': clock => ({ ...base(clock), write: nothing }),
  'takes the bytes twice': clock => ({
    ...base(clock),
    write: (_bytes, done) => {
      done()
      done(new Error('again'))
    }
  }),
  'never closes': clock => ({ ...base(clock), close: nothing }),
  'closes twice': clock => ({
    ...base(clock),
    open(handlers) {
      opens(clock)(handlers)
      for (let n = 0; n < 2; n++) clock.setTimer(() => handlers.closed(null), 30)
    }
  })
}

describe('attack: a transport that breaks its contract', () => {
  const times = [0, 2, 40, 300, 1500, 2500, 7000]
  for (const [name, make] of Object.entries(BROKEN)) {
    it(`${name}: every run settles once, whenever the line is given back`, async () => {
      for (const at of times) {
        const clock = createVirtualClock()
        const transports = { serial: (_settings, own) => make(own) }
        const pool = createPool({ clock, random: () => 0.5, transports })
        const lease = pool.open({ transport: 'serial', path: '/dev/ttyS0' }, { id: 'a', name: 'a' })
        let settled = 0
        for (let n = 0; n < 3; n++) {
          lease
            .run(() => toy.ask(1), { station: 1 })
            .catch(error => assert.ok(error.code, error.stack))
            .finally(() => settled++)
        }
        await clock.advance(at)
        const from = clock.now()
        assert.equal(lease.release(), lease.release())
        await clock.run(lease.release())
        assert.ok(clock.now() - from < 2000)
        // the transport's own timers
        await clock.advance(50)
        assert.deepEqual([settled, pool.lines().length, clock.pending()], [3, 0, 0], `released after ${at} ms`)
      }
    })
  }
})
