'use strict'

const assert = require('node:assert/strict')
const { Intake } = require('../../../lib/line/transports/intake')
const { createVirtualClock } = require('../../../lib/sim')

const bytesFrom = (from, length) => Buffer.from(Array.from({ length }, (_, n) => (from + n) & 0xff))

/** @param {(bytes: Buffer) => any} [answer] what whoever gets the bytes says */
const bench = (answer = () => undefined) => {
  const clock = createVirtualClock()
  const got = []
  const holds = []
  const intake = new Intake({
    clock,
    data: (bytes, came) => {
      got.push({ at: clock.now(), came, bytes: Buffer.from(bytes) })
      return answer(bytes)
    },
    hold: held => holds.push(held)
  })
  const lengths = () => got.map(({ bytes }) => bytes.length)
  return { clock, intake, got, holds, lengths }
}

describe('intake', () => {
  it('gives at once what a wire brings, as it came', () => {
    const { intake, lengths, holds, clock } = bench()
    for (const length of [1, 513, 510]) intake.take(bytesFrom(0, length))
    assert.deepEqual([lengths(), holds, intake.waiting, clock.pending()], [[1, 513, 510], [], false, 0])
  })

  it('says when what it gives at once came; what had to wait comes now', async () => {
    const { intake, got, clock } = bench()
    await clock.advance(7)
    intake.take(bytesFrom(0, 1500))
    await clock.advance(3)
    assert.deepEqual(
      got.map(({ at, came, bytes }) => [at, came, bytes.length]),
      [
        [7, 7, 1024],
        [8, undefined, 476]
      ]
    )
  })

  it('gives a kilobyte each millisecond, in order, and holds the source meanwhile', async () => {
    const { intake, got, lengths, holds, clock } = bench()
    const all = bytesFrom(3, 5000)
    intake.take(all.subarray(0, 2000))
    // a source that is held may have had something on its way
    intake.take(all.subarray(2000))
    assert.deepEqual([lengths(), holds, intake.waiting], [[1024], [true], true])
    await clock.advance(3)
    assert.deepEqual([holds, intake.waiting], [[true], true])
    await clock.advance(10)
    assert.deepEqual([holds, intake.waiting, clock.pending()], [[true, false], false, 0])
    assert.ok(Buffer.concat(got.map(({ bytes }) => bytes)).equals(all))
    const each = new Map()
    for (const { at, bytes } of got) each.set(at, (each.get(at) ?? 0) + bytes.length)
    assert.deepEqual([...each.values()], [1024, 1024, 1024, 1024, 904])
  })

  it('counts what comes in many small chunks within a moment', async () => {
    const { intake, lengths, holds, clock } = bench()
    for (let n = 0; n < 20; n++) intake.take(bytesFrom(n, 100))
    assert.equal(
      lengths().reduce((a, b) => a + b),
      1024
    )
    assert.deepEqual(holds, [true])
    await clock.advance(2)
    assert.equal(
      lengths().reduce((a, b) => a + b),
      2000
    )
    // a moment later all begins anew
    await clock.advance(1)
    intake.take(bytesFrom(0, 1024))
    assert.equal(intake.waiting, false)
  })

  it('never holds a source that brings a kilobyte each millisecond, or less', async () => {
    for (const [length, apart] of [
      [1024, 1],
      [100, 10]
    ]) {
      const { intake, lengths, holds, clock } = bench()
      for (let n = 0; n < 30; n++) {
        intake.take(bytesFrom(n, length))
        await clock.advance(apart)
      }
      assert.deepEqual([holds, lengths()], [[], new Array(30).fill(length)])
    }
  })

  it('a moment with more than that is held each time', async () => {
    const { intake, lengths, holds, clock } = bench()
    await clock.advance(10)
    intake.take(bytesFrom(0, 1))
    for (let n = 0; n < 20; n++) intake.take(bytesFrom(n, 100))
    assert.equal(
      lengths().reduce((a, b) => a + b),
      1024
    )
    assert.deepEqual(holds, [true])
  })

  it('messages count as so many bytes: sixteen each millisecond, on and on', async () => {
    let messages = 0
    const { intake, clock } = bench(bytes => {
      messages += bytes.length
      return bytes.length
    })
    intake.take(Buffer.alloc(1024, 0x41))
    // the first chunk tells that it is a line of messages
    messages = 0
    intake.take(Buffer.alloc(4096, 0x41))
    assert.equal(messages, 0)
    let most = 0
    for (let n = 0; n < 400; n++) {
      const before = messages
      await clock.advance(1)
      most = Math.max(most, messages - before)
    }
    assert.equal(messages, 4096)
    assert.ok(most <= 64, `${most} messages at once`)
    assert.ok(clock.now() > 4096 / 16, `${clock.now()} ms`)
  })

  it('drops what waits when its source is gone, also from within', async () => {
    const { intake, lengths, holds, clock } = bench(() => stop?.())
    let stop = null
    intake.take(bytesFrom(0, 3000))
    stop = () => intake.stop()
    await clock.advance(10)
    assert.deepEqual([lengths(), holds, intake.waiting, clock.pending()], [[1024, 1024], [true], false, 0])
  })
})
