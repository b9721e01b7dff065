'use strict'

/** An answer that comes twice, and is still in the adapter's buffer while the next query goes out. Bytes and times of a run of `npm run soak` (rtu, seed 1). */

const assert = require('node:assert/strict')
const { createPool } = require('../../lib')
const { createVirtualClock } = require('../../lib/sim')
const { answerTo } = require('../../lib/codec/modbus/match')
const { Repeats } = require('../../lib/line/repeats')

const hex = text => Buffer.from(text.replaceAll(' ', ''), 'hex')
const CHARACTER = 10 / 19.2 // ms at 19200 bit/s
const FIRST = { query: hex('0b 03 00 5f 00 01 b4 b2'), answer: hex('0b 03 02 cc 51 b4 b9'), base: 95, value: 0xcc51 }
const NEXT = { query: hex('0b 03 01 44 00 01 c5 49'), answer: hex('0b 03 02 00 00 20 45'), base: 324, value: 0 }

/** A line whose far end answers after `took` ms: (n, bytes of query and answer) → when the answer, and the same again, comes. */
function createSystem(times, { behind = _ => /** @type {any} */ (undefined) } = {}) {
  const clock = createVirtualClock()
  let n = 0
  const wire = {
    connect: ({ data }) => ({
      write: bytes => {
        const { answer } = [FIRST, NEXT].find(({ query }) => query.equals(bytes)) ?? FIRST
        const due = times(n, bytes.length + answer.length)
        for (const ms of due) clock.setTimer(() => data(answer), ms)
        const old = behind(n++)
        if (old) clock.setTimer(() => data(old.bytes), due[0] + old.ms)
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

  it('one that was never heard comes behind another answer: not taken either, once it is sure that answers take the wire’s time', async () => {
    // ascii, seed 1: an answer that was lost came without a pause behind that of the next query; here with RTU's bytes
    const lost = hex('0b 03 02 77 3a 87 a6')
    const { run, line } = createSystem((n, bytes) => [inTime(n, bytes)], {
      behind: n => (n === 3 ? { bytes: lost, ms: 3.65 } : undefined)
    })
    const asked = [FIRST, NEXT, FIRST, NEXT, FIRST]
    assert.deepEqual(await run(asked), valuesOf(asked))
    assert.deepEqual([line.stats().skippedBytes, line.stats().timeouts], [7, 0])
  })

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

  it('the same where it was sure: two time-outs', async () => {
    const { run, line } = createSystem((n, bytes) => [n < 4 ? inTime(n, bytes) : AT_ONCE])
    const seen = await run([FIRST, NEXT, FIRST, NEXT, FIRST, NEXT, FIRST, NEXT])
    assert.deepEqual(seen.slice(4), ['TIMEOUT', 'TIMEOUT', FIRST.value, NEXT.value])
    assert.equal(line.stats().timeouts, 2)
  })

  it('a new answer that comes too early for the wire tells it at once', async () => {
    const { run, line } = createSystem((n, bytes) => [n === 0 ? inTime(n, bytes) : AT_ONCE])
    assert.deepEqual(await run([FIRST, NEXT, NEXT, FIRST]), valuesOf([FIRST, NEXT, NEXT, FIRST]))
    assert.equal(line.stats().timeouts, 0)
  })
})

describe('what is known of answers that were taken', () => {
  const A = hex('0b 03 02 cc 51 b4 b9')
  const B = hex('0b 03 02 00 00 20 45')
  const LENGTH = 8
  // at 0.97 of 100 ms a character, a query of 8 and an answer of 7
  const SOONEST = 15 * 97
  const at = now => ({ length: LENGTH, sentAt: 0, now })
  const created = (transport = 'simulated', id = '') => {
    const repeats = new Repeats({ character: 100, transport })
    repeats.opened(id)
    return repeats
  }
  const paced = (...frames) => {
    const repeats = created()
    for (const frame of frames) repeats.answered(frame, at(SOONEST))
    return repeats
  }
  const early = at(SOONEST - 1)

  it('an early one is old, if it was taken before, at any time, and answers take the time of the wire', () => {
    assert.equal(created().isOld(A, early), false)
    for (const frame of [A, B]) assert.equal(paced(A, B).isOld(frame, early), true)
    assert.equal(paced(A).isOld(B, early), false)
    assert.equal(paced(A).isOld(A, at(SOONEST)), false, 'just in time')
  })

  it('after three answers it is sure that all take the time of the wire: any early one is old', () => {
    assert.deepEqual(
      [paced(A, B), paced(A, A, B), paced(A, B, A, B)].map(repeats => repeats.isOld(other, early)),
      [false, true, true]
    )
    assert.equal(paced(A, B, A).isOld(other, at(SOONEST)), false, 'just in time')
  })

  const other = hex('0b 03 02 77 3a 87 a6')
  const after = (count, make) => {
    const repeats = make()
    for (let n = 0; n < count; n++) repeats.answered(n === 0 ? A : B, at(SOONEST))
    return [repeats.isOld(A, early), repeats.isOld(other, early)]
  }

  it('a serial port has its speed, by whatever name', () => {
    const names = [
      '/dev/ttyUSB0',
      '/dev/ttyS1',
      '/dev/ttysx',
      '/dev/ttyAMA0',
      'COM3',
      '/dev/cu.usbserial-1',
      '/x/dev/pts/3'
    ]
    for (const id of names) {
      const counts = [0, 1, 2, 3].map(count => after(count, () => created('serial', id)))
      assert.deepEqual(
        counts,
        [
          [false, false],
          [true, false],
          [true, false],
          [true, true]
        ],
        id
      )
    }
  })

  it('where there may be no wire it is believed later: four answers for a copy, twenty for all', () => {
    for (const [transport, id] of [
      ['tcp', 'host:4001'],
      ['serial', '/dev/pts/3'],
      ['serial', '/dev/ttys003'],
      ['serial', '/dev/ttyACM0'],
      ['serial', '/dev/ttyGS0'],
      ['serial', '/dev/cu.usbmodem14101'],
      ['serial', '/dev/tty.usbmodem14101']
    ]) {
      const counts = [3, 4, 19, 20].map(count => after(count, () => created(transport, id)))
      assert.deepEqual(
        counts,
        [
          [false, false],
          [true, false],
          [true, false],
          [true, true]
        ],
        id
      )
    }
  })

  it('there short answers prove nothing: a program may be as slow', () => {
    const repeats = new Repeats({ character: 0.5, transport: 'tcp' })
    repeats.opened('host:4001')
    for (let n = 0; n < 100; n++) repeats.answered(A, { length: LENGTH, sentAt: 0, now: 20 })
    assert.equal(repeats.isOld(A, { length: LENGTH, sentAt: 0, now: 1 }), false)
    const long = Buffer.alloc(93, 1)
    for (let n = 0; n < 20; n++) repeats.answered(long, { length: LENGTH, sentAt: 0, now: 60 })
    assert.equal(repeats.isOld(A, { length: LENGTH, sentAt: 0, now: 1 }), true)
  })

  it('there fifty milliseconds are long', () => {
    const soon = { length: LENGTH, sentAt: 0, now: 1 }
    for (const [length, proves] of /** @type {[number, boolean][]} */ ([
      [91, false],
      [92, true]
    ])) {
      const repeats = new Repeats({ character: 0.5, transport: 'tcp' })
      repeats.opened('host:4001')
      for (let n = 0; n < 20; n++) repeats.answered(Buffer.alloc(length, 1), { length: LENGTH, sentAt: 0, now: 60 })
      assert.equal(repeats.isOld(A, soon), proves, `${length}`)
    }
  })

  it('two steps that fail after one was dropped tell of a faster wire; others do not', () => {
    const repeats = paced(A)
    for (let n = 0; n < 3; n++) repeats.failed()
    assert.equal(repeats.isOld(A, early), true)
    repeats.failed()
    repeats.sent()
    for (let n = 0; n < 3; n++) repeats.failed()
    assert.equal(repeats.isOld(A, early), true)
    repeats.failed()
    assert.equal(repeats.isOld(A, early), false)
  })

  const good = at(SOONEST)
  const mistake = repeats => {
    repeats.sent()
    const old = repeats.isOld(A, early)
    repeats.failed()
    return old
  }
  const answer = (repeats, query = good) => {
    repeats.sent()
    repeats.answered(B, query)
  }

  it('where there may be no wire also with answers between them, unless the right one came behind the dropped one', () => {
    const loose = created('serial', '/dev/pts/3')
    for (let n = 0; n < 4; n++) loose.answered(A, good)
    assert.equal(mistake(loose), true)
    answer(loose)
    loose.sent()
    assert.equal(loose.isOld(A, early), true)
    loose.answered(B, good)
    assert.equal(mistake(loose), true, 'proven right in between: one again')
    answer(loose)
    assert.equal(mistake(loose), true)
    answer(loose)
    assert.equal(loose.isOld(A, early), false)
  })

  it('on a wire a lost answer behind an old one, now and then, changes nothing', () => {
    const sure = paced(A)
    for (let n = 0; n < 5; n++) {
      assert.equal(mistake(sure), true)
      answer(sure)
    }
    assert.equal(sure.isOld(A, early), true)
  })

  it('another opening: nothing is known', () => {
    const repeats = paced(A)
    repeats.opened('')
    repeats.answered(B, at(SOONEST))
    assert.deepEqual([repeats.isOld(A, early), repeats.isOld(B, early)], [false, true])
    repeats.opened('')
    repeats.answered(A, early)
    assert.equal(repeats.isOld(A, early), false, 'this one has no pace')
  })
})
