'use strict'
const assert = require('node:assert/strict')
const { c24Bench } = require('./c24-bench')

const hex = text => Buffer.from(text.replace(/ /g, ''), 'hex')
const ACK = hex('06')
const VECTOR = hex('05 05 00 41 42 43 44 45 46 47 31 32 33 77 02')

/** From the manual's words, not from our encoder. */
const frameOf = text => {
  const body = Buffer.from(text)
  const section = [body.length / 2, 0, ...body]
  const sum = section.reduce((all, byte) => all + byte, 0)
  return Buffer.from([5, ...section, sum % 256, Math.floor(sum / 256)])
}
const damaged = frame => {
  const bytes = Buffer.from(frame)
  bytes[4] ^= 1
  return bytes
}

describe('C24 port, bidirectional protocol', () => {
  let bench
  afterEach(() => bench?.close())
  /** @param {any} [options] `answers`: what the other side says to each frame of ours, one after the other; null: nothing */
  const opened = async ({ port = {}, answers, delay = 20, line = {} } = {}) => {
    const left = answers && [...answers]
    const onBytes = (bytes, peer) => {
      const answer = bytes[0] === 5 && left ? left.shift() : null
      if (answer) peer.sayIn(bytes.length * (10 / 9.6) + delay, answer)
    }
    bench = c24Bench({ port: { bidirectional: true, ...port }, onBytes, line })
    await bench.clock.advance(10)
    return bench
  }
  const frames = () => bench.peer.heard.filter(bytes => bytes[0] === 5).length

  it('the vector of the manual goes out, and ACK confirms it', async () => {
    await opened({ answers: [ACK] })
    const outcome = await bench.send('ABCDEFG123')
    assert.deepEqual({ ...outcome, ms: 0 }, { outcome: 'confirmed', attempts: 1, bytes: 15, ms: 0 })
    assert.deepEqual(bench.peer.heard, [VECTOR])
  })

  it('the vector comes in: delivered and acknowledged at once', async () => {
    await opened()
    bench.peer.say(VECTOR)
    assert.deepEqual(bench.values(), ['ABCDEFG123'])
    assert.deepEqual(bench.peer.heard, [ACK])
    assert.equal(bench.got[0].count, 5)
  })

  it('does not begin inside a frame of the other side', async () => {
    await opened({ answers: [ACK] })
    bench.peer.say(VECTOR.subarray(0, 7))
    const sending = bench.device.send('AB')
    await bench.clock.advance(20)
    assert.deepEqual(bench.peer.heard, [])
    bench.peer.say(VECTOR.subarray(7))
    assert.equal((await bench.run(sending)).outcome, 'confirmed')
    assert.deepEqual(bench.peer.heard, [ACK, frameOf('AB')])
    // four characters at 9600 bit/s behind our ACK
    const [one, two] = bench.peer.times
    assert.ok(two - one >= (1 + 4) * (10 / 9.6), `${two - one}`)
  })

  it('a damaged frame is answered by NAK when the line is silent, and never delivered', async () => {
    await opened()
    bench.peer.say(damaged(VECTOR))
    assert.deepEqual(bench.peer.heard, [])
    await bench.clock.advance(100)
    assert.deepEqual(bench.got, [])
    assert.deepEqual(bench.peer.heard, [hex('15 22 00')])
    bench.peer.say(VECTOR)
    assert.deepEqual([bench.values(), bench.peer.heard.at(-1)], [['ABCDEFG123'], ACK])
    const { damaged: seen, naksOut, acksOut, repeats } = bench.device.stats
    assert.deepEqual([seen, naksOut, acksOut, repeats], [1, 1, 1, 0])
  })

  it('noise is not answered', async () => {
    await opened()
    bench.peer.say('noise')
    await bench.clock.advance(100)
    assert.deepEqual([bench.peer.heard, bench.got], [[], []])
  })

  it('nobody listens: nothing is acknowledged', async () => {
    await opened()
    bench.device.close()
    const deaf = bench.make({})
    bench.peer.say(VECTOR)
    await bench.clock.advance(100)
    assert.deepEqual(bench.peer.heard, [])
    assert.equal(deaf.stats.unheard, 1)
    deaf.close()
  })

  it('NAK: sent again, as often as attempts says', async () => {
    await opened({ answers: [hex('15 24 7F'), ACK] })
    const { outcome, attempts } = await bench.send('AB')
    assert.deepEqual([outcome, attempts, frames()], ['confirmed', 2, 2])
    await bench.close()
    await opened({ answers: Array(9).fill(hex('15 24 7F')) })
    const refused = await bench.send('AB')
    assert.deepEqual([refused.outcome, refused.code, refused.attempts, frames()], ['refused', 'C24_NAK', 3, 3])
    assert.match(refused.text, /7F24H, sum check error/)
  })

  it('a full buffer is given time', async () => {
    await opened({ answers: [hex('15 6A 7F'), ACK] })
    const { outcome, ms } = await bench.send('AB')
    assert.equal(outcome, 'confirmed')
    assert.ok(ms > 140, `${ms}`)
  })

  it('no answer: unknown, and not sent again', async () => {
    await opened({ port: { ackTimeout: 300 } })
    const { outcome, code, attempts, ms } = await bench.send('AB')
    assert.deepEqual([outcome, code, attempts, frames()], ['unknown', 'TIMEOUT', 1, 1])
    assert.ok(ms >= 300 && ms < 400)
  })

  it('an answer that comes too late does not confirm the next frame', async () => {
    await opened({ port: { ackTimeout: 300 } })
    const both = Promise.all([bench.device.send('AB'), bench.device.send('CD')])
    bench.peer.sayIn(700, ACK)
    const outcomes = await bench.run(both)
    assert.deepEqual(
      outcomes.map(({ outcome }) => outcome),
      ['unknown', 'unknown']
    )
    assert.equal(frames(), 2)
  })

  it('repeatUnanswered: sent again, unless the ACK comes late', async () => {
    await opened({ port: { ackTimeout: 300, repeatUnanswered: true }, answers: [null, ACK] })
    const second = await bench.send('AB')
    assert.deepEqual([second.outcome, second.attempts, frames()], ['confirmed', 2, 2])
    bench.peer.sayIn(700, ACK)
    const late = await bench.send('CD')
    assert.deepEqual([late.outcome, late.attempts, frames()], ['confirmed', 1, 3])
    const none = await bench.send('EF')
    assert.deepEqual([none.outcome, none.attempts, frames()], ['unknown', 3, 6])
  })

  it('repeatUnanswered: a refusal of the repetition does not say that the first was not taken', async () => {
    await opened({
      port: { ackTimeout: 300, repeatUnanswered: true },
      answers: [null, ...Array(2).fill(hex('15 25 7F'))]
    })
    const { outcome, code } = await bench.send('AB')
    assert.deepEqual([outcome, code], ['unknown', 'C24_NAK'])
  })

  it('half an answer, or a damaged one, says nothing', async () => {
    for (const answer of [hex('15 24'), hex('07'), hex('26')]) {
      await opened({ port: { ackTimeout: 300 }, answers: [answer] })
      assert.equal((await bench.send('AB')).outcome, 'unknown')
      await bench.close()
    }
  })

  it('order is kept through repetitions', async () => {
    await opened({ answers: [hex('15 24 7F'), ACK, ACK] })
    const both = await bench.run(Promise.all([bench.device.send('AB'), bench.device.send('CD')]))
    assert.deepEqual(
      both.map(({ attempts }) => attempts),
      [2, 1]
    )
    assert.deepEqual(
      bench.peer.heard.map(bytes => bytes.toString('latin1', 3, 5)),
      ['AB', 'AB', 'CD']
    )
  })

  describe('a frame that comes twice', () => {
    const twice = async (port, wait, second = VECTOR) => {
      await opened({ port })
      bench.peer.say(VECTOR)
      await bench.clock.advance(wait)
      bench.peer.say(second)
      return bench.got.map(({ repeated }) => repeated === true)
    }
    it('is marked: nothing tells it from a new one', async () => {
      assert.deepEqual(await twice({}, 5000), [false, true])
      assert.deepEqual(bench.peer.heard, [ACK, ACK])
      assert.equal(bench.device.stats.repeats, 1)
    })
    it('or dropped, and acknowledged again', async () => {
      assert.deepEqual(await twice({ repeats: 'drop' }, 5000), [false])
      assert.deepEqual(bench.peer.heard, [ACK, ACK])
    })
    it('earlier than the other side can know that its ACK was lost, it is new', async () => {
      assert.deepEqual(await twice({ repeats: 'drop', repeatAfter: 4000 }, 3000), [false, false])
      assert.deepEqual(await twice({ repeats: 'drop', repeatAfter: 4000 }, 4500), [false])
    })
    it('later than anybody repeats, it is new; other bytes are', async () => {
      assert.deepEqual(await twice({}, 11000), [false, false])
      assert.deepEqual(await twice({}, 5000, frameOf('ABCDEFG124')), [false, false])
    })
    it('also over a redeploy, and for each port of the line', async () => {
      await opened()
      bench.peer.say(VECTOR)
      bench.device.close()
      const got = []
      const ports = [bench.make({}), bench.make({})]
      for (const port of ports) port.listen(({ repeated }) => got.push(repeated === true))
      await bench.clock.advance(5000)
      bench.peer.say(VECTOR)
      assert.deepEqual(got, [true, true])
      // one answer for both
      assert.deepEqual(bench.peer.heard, [ACK, ACK])
      for (const port of ports) port.close()
    })
  })

  describe('both send at once', () => {
    const THEIRS = frameOf('CDEF')
    const crossing = async (priority, { answer, at = 5 }) => {
      await opened({ port: { priority, ackTimeout: 300 } })
      const sending = bench.device.send('AB12')
      bench.peer.sayIn(at, THEIRS)
      if (answer) bench.peer.sayIn(answer, ACK)
      return bench.run(sending)
    }
    it('c24: theirs is taken, ours was ignored and goes out again', async () => {
      const { outcome, attempts } = await crossing('c24', { answer: 1450 })
      assert.deepEqual([outcome, attempts, frames(), bench.values()], ['confirmed', 2, 2, ['CDEF']])
      assert.ok(bench.peer.heard.some(bytes => bytes.equals(ACK)))
    })
    it('c24: if ours is acknowledged all the same, it is not sent again', async () => {
      const { outcome, attempts } = await crossing('c24', { answer: 40 })
      assert.deepEqual([outcome, attempts, frames(), bench.values()], ['confirmed', 1, 1, ['CDEF']])
    })
    it('us: theirs was given up and is dropped, ours is acknowledged', async () => {
      const { outcome, attempts } = await crossing('us', { answer: 60 })
      assert.deepEqual([outcome, attempts, bench.values()], ['confirmed', 1, []])
      assert.ok(!bench.peer.heard.some(bytes => bytes.equals(ACK)))
      assert.equal(bench.device.stats.crossed, 1)
    })
    it('both: theirs is taken; without an ACK ours is unknown', async () => {
      const { outcome, attempts } = await crossing('both', {})
      assert.deepEqual([outcome, attempts, frames(), bench.values()], ['unknown', 1, 1, ['CDEF']])
    })
    it('a message that begins after ours has ended is no crossing', async () => {
      for (const priority of ['c24', 'us']) {
        const { outcome, attempts } = await crossing(priority, { at: 100 })
        assert.deepEqual([outcome, attempts, frames(), bench.values()], ['unknown', 1, 1, ['CDEF']], priority)
        await bench.close()
      }
    })
  })

  it('closing: what waits is failed, what is out is unknown, nothing goes out again', async () => {
    await opened({ port: { ackTimeout: 300, repeatUnanswered: true } })
    const sending = [bench.device.send('AB'), bench.device.send('CD')]
    await bench.clock.advance(500)
    bench.device.close()
    const outcomes = await bench.run(Promise.all(sending))
    assert.deepEqual(
      outcomes.map(({ outcome, code }) => [outcome, code]),
      [
        ['unknown', 'LINE_CLOSED'],
        ['failed', 'LINE_CLOSED']
      ]
    )
    assert.equal(frames(), 1)
    await bench.close()
    assert.equal(bench.clock.pending(), 0)
  })

  it('a deadline holds while others are repeated', async () => {
    await opened({ port: { ackTimeout: 300 } })
    const sending = [bench.device.send('AB'), bench.device.send('CD', { deadline: 200 })]
    const [, second] = await bench.run(Promise.all(sending))
    assert.deepEqual([second.outcome, second.code, second.attempts], ['failed', 'DEADLINE', 0])
  })

  it('an answer to nothing is counted, and told nobody', async () => {
    await opened()
    bench.peer.say(ACK)
    await bench.clock.advance(100)
    bench.peer.say(Buffer.concat([ACK, VECTOR]))
    await bench.clock.advance(100)
    bench.peer.say(hex('15 24 7F'))
    await bench.clock.advance(100)
    assert.deepEqual([bench.values(), bench.device.stats.strayAnswers], [['ABCDEFG123'], 3])
    assert.deepEqual(bench.peer.heard, [ACK])
  })

  it('a deadline is that of waiting for the turn; what is on the wire may end', async () => {
    await opened({ port: { ackTimeout: 300 }, answers: [ACK] })
    const { outcome, attempts } = await bench.send('AB', { deadline: 100 })
    assert.deepEqual([outcome, attempts], ['confirmed', 1])
    bench.peer.say(VECTOR.subarray(0, 7))
    const late = await bench.send('CD', { deadline: 30 })
    assert.deepEqual([late.outcome, late.code, late.bytes], ['failed', 'DEADLINE', 0])
  })

  it('its queue is bounded', async () => {
    await opened({ port: { ackTimeout: 10 } })
    const sending = Array.from({ length: 1001 }, () => bench.device.send('AB'))
    const last = await sending.at(-1)
    assert.deepEqual([last.outcome, last.code], ['failed', 'QUEUE_FULL'])
    bench.device.close()
    await bench.run(Promise.all(sending))
  })
})
