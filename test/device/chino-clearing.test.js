'use strict'

const assert = require('node:assert/strict')
const { createRandom } = require('../../lib/sim/random')
const { bench } = require('./chino-bench')

/** Function 08 in place of the silence after a timeout. */
describe('CHINO regulator: function 08 after a timeout', () => {
  let b
  const start = ({ device = {}, ...options } = {}) =>
    (b = bench({ device: { probe08: true, attempts: 3, random: createRandom(7).next, ...device }, ...options }))
  afterEach(async () => {
    await b?.close()
    assert.equal(b?.clock.pending() ?? 0, 0, 'a timer is left')
    b = undefined
  })
  const loopbacks = () => b.slave.requests.filter(body => body.startsWith('0b08'))
  const events = name => {
    const list = []
    b.lease.on('event', event => event.event === name && list.push(event))
    return list
  }
  /** ms that a read of one register takes, and its value or code. */
  const read = async (item = '400001') => {
    const from = b.clock.now()
    const [{ value, code }] = await b.read([item])
    return { got: code ?? value, ms: b.clock.now() - from }
  }
  /** A first answer: whether the adapter hears itself is known by it. */
  const settle = async () => {
    b.slave.set('hr', 0, 500, 501, 502)
    assert.equal((await read()).got, 500)
    b.slave.requests.length = 0
  }

  for (const protocol of ['rtu', 'ascii']) {
    it(`${protocol}: an answer to it ends the silence: the repeat goes out at once`, async () => {
      start({ slaves: [{ protocol }], device: { protocol } })
      await settle()
      b.slave.next = [{ lost: true }]
      const { got, ms } = await read()
      assert.equal(got, 500)
      assert.ok(ms > 200 && ms < 270, `${ms} ms`)
      assert.equal(loopbacks().length, 1)
      assert.match(loopbacks()[0], /^0b080000....$/)
      assert.equal(b.slave.requests.length, 3)
    })
  }

  it('is off unless it is asked for: then the silence is waited', async () => {
    start({ device: { probe08: false } })
    await settle()
    b.slave.next = [{ lost: true }]
    const { got, ms } = await read()
    assert.equal(got, 500)
    assert.ok(ms > 1200, `${ms} ms`)
    assert.deepEqual(loopbacks(), [])
  })

  it('a late answer comes before that of 08, is known as late, and never becomes a value', async () => {
    start({ device: { timeout: 300 } })
    await settle()
    const late = events('late')
    // it answers in order: first the read, 300 ms late, then 08
    b.slave.next = [{ turnaround: 450 }, { turnaround: 250 }]
    const { got, ms } = await read('400002')
    assert.equal(got, 501)
    assert.ok(ms < 700, `${ms} ms`)
    assert.equal(late.length, 1)
    assert.equal(b.lease.line.stats().stations[11].late, 1)
  })

  it('unanswered it changes nothing: the silence lasts as long as without it', async () => {
    start()
    await settle()
    b.slave.next = [{ lost: true }, { lost: true }]
    const { got, ms } = await read()
    assert.equal(got, 500)
    assert.ok(ms > 1200 && ms < 1260, `${ms} ms`)
    assert.equal(loopbacks().length, 1)
  })

  it('the answer to an older 08 proves nothing', async () => {
    start()
    await settle()
    b.slave.next = [{ lost: true }, { lost: true }]
    await read()
    const old = Buffer.from(loopbacks()[0], 'hex')
    b.slave.next = [{ lost: true }, { body: old }]
    const { got, ms } = await read()
    assert.equal(got, 500)
    assert.ok(ms > 1200, `${ms} ms`)
    const [first, second] = loopbacks()
    assert.notEqual(first, second)
  })

  it('numbers are not used again soon, whatever chance says', async () => {
    start({ device: { random: () => 0.5, demoteAfter: 0 } })
    await settle()
    for (let n = 0; n < 10; n++) {
      b.slave.next = [{ lost: true }]
      await read()
    }
    assert.equal(new Set(loopbacks()).size, 10)
  })

  it('exception 01: it is not asked again, and proves nothing', async () => {
    start()
    await settle()
    b.slave.next = [{ lost: true }, { exception: 1 }]
    const { ms } = await read()
    assert.ok(ms > 1200, `${ms} ms`)
    b.slave.next = [{ lost: true }]
    assert.ok((await read()).ms > 1200)
    assert.equal(loopbacks().length, 1)
    // nor after a deploy
    b.device.close()
    const again = b.make({})
    b.slave.next = [{ lost: true }]
    await b.run(again.read(['400001']))
    assert.equal(loopbacks().length, 1)
    again.close()
  })

  it('another exception proves nothing, either', async () => {
    start()
    await settle()
    b.slave.next = [{ lost: true }, { exception: 6 }]
    assert.ok((await read()).ms > 1200)
  })

  it('a regulator that is silent to it three times is not asked any more', async () => {
    start()
    await settle()
    for (let n = 0; n < 5; n++) {
      b.slave.next = [{ lost: true }, { lost: n < 3 }]
      assert.equal((await read()).got, 500)
    }
    assert.equal(loopbacks().length, 3)
    assert.equal(b.device.health.state, 'online')
  })

  it('where an answer has overtaken another one it is not used any more', async () => {
    start({ device: { attempts: 1 } })
    await settle()
    b.slave.next = [{ turnaround: 400 }]
    assert.equal((await read('400001')).got, 'TIMEOUT')
    // 08 was answered before it
    assert.equal(loopbacks().length, 1)
    await b.clock.advance(1000)
    assert.equal(b.lease.line.memory(11).overtaken, true)
    b.slave.next = [{ lost: true }]
    assert.equal((await read('400001')).got, 'TIMEOUT')
    assert.equal(loopbacks().length, 1)
    assert.ok((await read('400001')).ms > 900)
  })

  describe('its answer is a copy of the query, so', () => {
    it('an adapter that hears itself, though it is said not to, has it never used', async () => {
      start({ wire: { echo: true } })
      await settle()
      b.slave.next = [{ lost: true }]
      assert.ok((await read()).ms > 1200)
      assert.deepEqual(loopbacks(), [])
    })

    it('not even if our own bytes came damaged the one time they could have been seen', async () => {
      start()
      b.slave.set('hr', 0, 500)
      // what is stepped over before the first answer may have been ourselves
      b.faults.once('before', { argument: 8 })
      assert.equal((await read()).got, 500)
      b.slave.requests.length = 0
      b.slave.next = [{ lost: true }]
      assert.ok((await read()).ms > 1200)
      assert.deepEqual(loopbacks(), [])
    })

    it('where they are heard and taken out, it is the second copy that counts', async () => {
      start({ wire: { echo: true }, line: { echo: 'on' } })
      await settle()
      b.slave.next = [{ lost: true }]
      const { got, ms } = await read()
      assert.equal(got, 500)
      assert.ok(ms < 270, `${ms} ms`)
      // only ourselves
      b.slave.next = [{ lost: true }, { lost: true }]
      assert.ok((await read()).ms > 1200)
    })

    it('while nothing is known of it, it is not used', async () => {
      start({ line: { echo: 'auto' } })
      await settle()
      await b.clock.advance(1000)
      assert.equal(b.lease.line.echo, 'unknown')
      b.slave.next = [{ lost: true }]
      assert.ok((await read()).ms > 1200)
      assert.deepEqual(loopbacks(), [])
    })

    it('what was known is forgotten when the port is opened anew: another adapter may be there', async () => {
      start()
      await settle()
      b.wire.unplug()
      b.wire.plug()
      await b.clock.advance(3000)
      b.slave.next = [{ lost: true }]
      assert.ok((await read()).ms > 1200)
      assert.deepEqual(loopbacks(), [])
    })
  })

  it('a write whose answer is lost stays unknown, is sent once, and what follows need not wait', async () => {
    start()
    await settle()
    b.slave.next = [{ none: true }]
    const { outcome, code } = await b.write([{ item: '400001', value: 7 }])
    assert.deepEqual([outcome, code], ['unknown', 'WRITE_UNKNOWN'])
    const { got, ms } = await read()
    assert.equal(got, 7)
    assert.ok(ms < 50, `${ms} ms`)
    assert.equal(b.slave.requests.filter(body => body.startsWith('0b10')).length, 1)
    assert.equal(loopbacks().length, 1)
  })

  it('a silent station is demoted as soon as without it, and its probes are reads alone', async () => {
    start({ device: { attempts: 1 } })
    await settle()
    b.wire.setOff(11, true)
    for (let n = 0; n < 3; n++) assert.equal((await read()).got, 'TIMEOUT')
    assert.equal((await read()).got, 'STATION_DEMOTED')
    await b.clock.advance(60000)
    const frames = b.lease.line.trace().filter(({ dir }) => dir === 'out')
    const probes = frames.filter(({ note }) => note === 'probe')
    assert.ok(probes.length >= 3)
    for (const { bytes } of probes) assert.match(bytes, /^0b03/i)
  })

  it('a slow and lossy station that answers in order: never a wrong value, and quicker than by silence', async () => {
    const run = async probe08 => {
      start({ device: { probe08, timeout: 100, attempts: 3, demoteAfter: 0 }, slaves: [{}] })
      const random = createRandom(20240501)
      for (let at = 0; at < 100; at++) b.slave.set('hr', at, 1000 + at)
      let free = 0
      const { receive } = b.slave
      // it carries out one query after the other, each in its time
      b.slave.receive = (bytes, times) =>
        receive(bytes, times).flatMap(query => {
          if (random.next() < 0.1) return []
          const takes = random.next() < 0.05 ? random.integer(80, 250) : 2
          const at = Math.max(free, b.clock.now()) + takes
          free = at + 6
          return [{ ...query, turnaround: at - b.clock.now() }]
        })
      const counts = { good: 0, wrong: 0, bad: 0 }
      for (let n = 0; n < 400; n++) {
        const at = random.integer(0, 99)
        const { got } = await read(`hr${at}`)
        counts[got === 1000 + at ? 'good' : typeof got === 'number' ? 'wrong' : 'bad']++
      }
      const { late } = b.lease.line.stats()
      const ms = b.clock.now()
      await b.close()
      b = undefined
      return { ...counts, late, ms }
    }
    const probed = await run(true)
    const waited = await run(false)
    assert.deepEqual([probed.wrong, waited.wrong], [0, 0])
    assert.ok(probed.good > 380, `${probed.good} of 400`)
    assert.ok(probed.late > 10, `${probed.late} late`)
    assert.ok(probed.ms < waited.ms / 2, `${probed.ms} ms, ${waited.ms} ms by silence`)
  })
})
