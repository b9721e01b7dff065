'use strict'

const assert = require('node:assert/strict')
const fs = require('node:fs')
const path = require('node:path')
const { createPool } = require('../../lib/line')
const { createVirtualClock } = require('../../lib/sim/clock')
const { createRandom } = require('../../lib/sim/random')
const { createPty } = require('../../lib/sim/pty')
const { createBench } = require('./support/bench')
const { collect, toyFraming } = require('./support/framing')
const { fastClock, openFiles, reached, tempFolder } = require('./support/real')

const DC1 = '\x11'
const DC3 = '\x13'
const SEED = Number(process.env.SEED ?? 20240501)
const bytes = text => Buffer.from(text, 'latin1')
const isAck = ({ kind }) => kind === 'ack'

describe(`listening line: whatever happens, SEED=${SEED}`, () => {
  it('each message is settled once, none is sent twice or out of order, none is glued to another', async () => {
    const random = createRandom(SEED)
    for (let round = 0; round < 30; round++) {
      const bench = createBench({ settings: { baudRate: 9600, queueLimit: 20 } })
      const { clock, wire } = bench
      const reply = ({ bytes: body }) => (body[0] === 0x71 ? bytes('A') : undefined)
      const options = { flow: 'dc', stallLimit: 400, torn: { first: bytes('!') }, reply }
      const { texts } = collect(bench.lease, options)
      const outcomes = []
      let said = ''
      let settled = 0
      const send = n => {
        const text = `${n}:`.padEnd(4 + random.integer(0, 119), 'x') + ';'
        const awaits = random.chance(0.25) ? { match: isAck, timeout: 60 } : {}
        const more = {
          quiet: random.pick([0, 0, 5]),
          after: random.pick([0, 20]),
          deadline: random.pick([0, 0, 300])
        }
        const count = error => {
          settled++
          outcomes[n] = { text, error }
        }
        bench.lease.send(bytes(text), { ...awaits, ...more }).then(() => count(null), count)
      }
      const acts = [
        () => wire.handlers?.data(bytes(DC3)),
        () => wire.handlers?.data(bytes(DC1)),
        () => wire.handlers?.data(bytes(DC1)),
        () => wire.handlers?.data(bytes('+;')),
        () => {
          const text = random.pick(['q', 'data', 'z'])
          if (bench.lease.line.state !== 'open') return
          wire.handlers.data(bytes(`${text};`))
          said += `${text};`
        },
        () => random.chance(0.25) && wire.open > 0 && wire.unplug()
      ]
      for (let n = 0; n < 60; n++) {
        send(n)
        for (let act = 0; act < 3; act++) {
          random.pick(acts)()
          await clock.advance(random.integer(0, 59))
        }
      }
      if (wire.open > 0) wire.handlers.data(bytes(DC1))
      await clock.advance(5000)
      await bench.run(bench.lease.release())
      assert.equal(settled, 60)
      assert.deepEqual([clock.pending(), wire.open, bench.lease.line.stats().waiting], [0, 0, 0])

      // what the other side saw: our messages without answers, each whole or at the end of a connection
      const seen = wire.sent.map(one => one.bytes.toString('latin1')).join('')
      const numbers = [...seen.matchAll(/(\d+):/g)].map(([, number]) => Number(number))
      assert.deepEqual(
        numbers,
        [...new Set(numbers)].sort((a, b) => a - b),
        `round ${round}`
      )
      for (const [n, { text, error }] of outcomes.entries()) {
        const whole = seen.includes(text)
        if (!error) assert.ok(whole, `${n} was sent`)
        else if (error.details.sent === 0) assert.ok(!numbers.includes(n), `${n}: ${error.code}`)
        else assert.ok(numbers.includes(n), `${n}: ${error.code}`)
      }
      // a torn one is ended before the next begins
      assert.doesNotMatch(seen, /x\d+:/)
      const expected = said.split(';').filter(Boolean)
      assert.deepEqual(
        texts.filter(text => text !== '+'),
        expected
      )
    }
  })

  it('a thousand redeploys and reconnects leave nothing behind', async () => {
    const { clock, wire, pool, open, lease, run } = createBench({ settings: { baudRate: 9600 } })
    await run(lease.release())
    for (let n = 0; n < 1000; n++) {
      const leases = [open({}, 'a'), open({}, 'b')]
      const listeners = leases.map(each => collect(each, { flow: 'dc', framing: toyFraming({ silence: 100 }) }))
      const sent = leases.map(each => each.send(bytes('x'.repeat(n % 150) + ';'), { quiet: n % 3, deadline: 500 }))
      const settled = Promise.allSettled(sent)
      await clock.advance((n * 7) % 90)
      if (wire.open > 0) wire.handlers.data(bytes(n % 4 ? 'half' : DC3))
      if (n % 5 === 0) listeners[0].pause()
      if (n % 3 === 0 && wire.open > 0) wire.unplug()
      if (n % 6 === 0) await clock.advance(400)
      await run(Promise.all(leases.map(each => each.release())))
      await settled
      assert.equal(clock.pending(), 0, `cycle ${n}`)
    }
    assert.equal(wire.open, 0)
    assert.deepEqual(pool.lines(), [])
  })
})

describe('listening line: a serial port', () => {
  it('is asked now and then whether it is still there, as long as somebody listens', async () => {
    const checks = []
    const serial = () => ({
      open: handlers => handlers.opened(),
      write: (_, done) => done(),
      close: done => done(),
      hint: () => {},
      id: () => 'port',
      check: ({ all }) => checks.push(all)
    })
    const clock = createVirtualClock()
    const lease = createPool({ clock, transports: { serial } }).open({ path: 'port' }, { id: 'a', name: 'a' })
    const listener = collect(lease)
    await clock.advance(20001)
    assert.deepEqual(checks, [0, 0, 0, 0])
    listener.close()
    assert.equal(clock.pending(), 0)
    collect(lease)
    await clock.run(lease.release())
    assert.equal(clock.pending(), 0)
  })
})

const supported = process.platform === 'linux'
;(supported ? describe : describe.skip)('listening line on a pty', () => {
  let folder, link, pty, clock, pool
  beforeEach(() => {
    folder = tempFolder()
    link = path.join(folder, 'port')
    pty = createPty({ link })
    clock = fastClock(20)
    pool = createPool({ clock, random: () => 0 })
  })
  afterEach(() => {
    pty.close()
    fs.rmSync(folder, { recursive: true })
  })
  const open = () => pool.open({ path: link, baudRate: 115200 }, { id: 'a', name: 'a' })
  const heard = (lease, count, options) =>
    new Promise(resolve => {
      const texts = []
      lease.listen(
        toyFraming(),
        message => {
          texts.push(message.bytes.toString('latin1'))
          if (texts.length === count) resolve(texts)
          return undefined
        },
        options
      )
    })

  it('messages both ways, none lost, in order', async () => {
    const lease = open()
    let got = ''
    pty.onData(data => {
      got += data.toString('latin1')
      pty.write(data)
    })
    await reached(lease, 'open')
    const texts = Array.from({ length: 50 }, (_, n) => `${n}`.padEnd(200, '.'))
    const echoed = heard(lease, 50)
    await Promise.all(texts.map(text => lease.send(bytes(`${text};`))))
    assert.deepEqual(await echoed, texts)
    assert.equal(got, texts.map(text => `${text};`).join(''))
    await lease.release()
    assert.equal(clock.pending(), 0)
  })

  it('a replug is noticed without anything being sent, 20 of 20', async () => {
    const lease = open()
    const { texts } = collect(lease)
    await reached(lease, 'open')
    let files
    for (let n = 0; n < 20; n++) {
      pty.close()
      await reached(lease, 'waiting')
      pty = createPty({ link })
      await reached(lease, 'open')
      const { length } = texts
      pty.write(bytes(`${n};`))
      while (texts.length === length) await new Promise(resolve => setImmediate(resolve))
      if (n === 1) files = openFiles()
    }
    assert.deepEqual(
      texts,
      Array.from({ length: 20 }, (_, n) => `${n}`)
    )
    assert.equal(openFiles(), files)
    await lease.release()
    assert.equal(clock.pending(), 0)
  })
})
