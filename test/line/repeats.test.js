'use strict'

/** An answer that comes twice, and is still in the adapter's buffer while the next query goes out. Bytes and times of a run of `npm run soak` (rtu, seed 1). */

const assert = require('node:assert/strict')
const { createPool } = require('../../lib')
const { createVirtualClock } = require('../../lib/sim')
const { answerTo } = require('../../lib/codec/modbus/match')

const hex = text => Buffer.from(text.replaceAll(' ', ''), 'hex')
const CHARACTER = 10 / 19.2 // ms at 19200 bit/s
const FIRST = { query: hex('0b 03 00 5f 00 01 b4 b2'), answer: hex('0b 03 02 cc 51 b4 b9'), base: 95, value: 0xcc51 }
const NEXT = { query: hex('0b 03 01 44 00 01 c5 49'), answer: hex('0b 03 02 00 00 20 45'), base: 324, value: 0 }

/** A line whose far end answers after `took` ms: (n, bytes of query and answer) → when the answer, and the same again, comes. */
function createSystem(times) {
  const clock = createVirtualClock()
  let n = 0
  const wire = {
    connect: ({ data }) => ({
      write: bytes => {
        const { answer } = [FIRST, NEXT].find(({ query }) => query.equals(bytes)) ?? FIRST
        for (const ms of times(n++, bytes.length + answer.length)) clock.setTimer(() => data(answer), ms)
      },
      close: () => {}
    })
  }
  const pool = createPool({ clock, random: () => 0.5 })
  const lease = pool.open({ transport: 'simulated', path: 'twice', wire }, { id: 't', name: 't' })
  const ask = ({ query, base }) =>
    lease.run(
      function* () {
        const match = answerTo({ fn: 3, base, count: 1 }, { station: 11 })
        return (yield { send: query, match, timeout: 200 }).readUInt16BE(3)
      },
      { station: 11, priority: 1 }
    )
  const all = async list => {
    const values = []
    for (const each of list) values.push(await ask(each).catch(({ code }) => code))
    await lease.release()
    return values
  }
  return { run: list => clock.run(all(list)), line: lease.line }
}

const TURNAROUND = 2
const inTime = (n, bytes) => bytes * CHARACTER + TURNAROUND
const AT_ONCE = 0.1
const valuesOf = list => list.map(({ value }) => value)

describe('an answer that comes twice', () => {
  // the first is read when it is whole, the second 7 bytes later, or as late as an adapter hands it over
  for (const late of [3.65, 5, 7]) {
    it(`again ${late} ms later, after the next query has begun: not taken for its answer`, async () => {
      const twice = (n, bytes) => (n === 0 ? [inTime(n, bytes), inTime(n, bytes) + late] : [inTime(n, bytes)])
      const { run, line } = createSystem(twice)
      assert.deepEqual(await run([FIRST, NEXT, NEXT]), valuesOf([FIRST, NEXT, NEXT]))
      assert.equal(line.stats().skippedBytes, 7)
    })
  }

  it('the same value again and again is an answer, in its time', async () => {
    const { run, line } = createSystem((n, bytes) => [inTime(n, bytes)])
    assert.deepEqual(await run([FIRST, FIRST, FIRST, NEXT]), valuesOf([FIRST, FIRST, FIRST, NEXT]))
    assert.equal(line.stats().timeouts, 0)
  })

  it('where answers take no time of a wire, the same bytes are an answer each time', async () => {
    const { run, line } = createSystem(() => [AT_ONCE])
    assert.deepEqual(await run([FIRST, FIRST, FIRST, NEXT, NEXT]), valuesOf([FIRST, FIRST, FIRST, NEXT, NEXT]))
    assert.equal(line.stats().timeouts, 0)
  })

  it('a far end that turns out to be faster than the line: two time-outs, then it is known', async () => {
    const { run, line } = createSystem((n, bytes) => [n === 0 ? inTime(n, bytes) : AT_ONCE])
    const seen = await run([FIRST, FIRST, FIRST, FIRST, FIRST])
    assert.deepEqual(seen, [FIRST.value, 'TIMEOUT', 'TIMEOUT', FIRST.value, FIRST.value])
    assert.equal(line.stats().timeouts, 2)
  })

  it('a new answer that comes too early for the wire tells it at once', async () => {
    const { run, line } = createSystem((n, bytes) => [n === 0 ? inTime(n, bytes) : AT_ONCE])
    assert.deepEqual(await run([FIRST, NEXT, NEXT, FIRST]), valuesOf([FIRST, NEXT, NEXT, FIRST]))
    assert.equal(line.stats().timeouts, 0)
  })
})
