'use strict'

const assert = require('node:assert/strict')
const { PlcError } = require('../../lib/error')
const { createVirtualClock } = require('../../lib/sim/clock')
const { Recorder } = require('../../lib/line/recorder')
const { Stats } = require('../../lib/line/stats')
const { Trace } = require('../../lib/line/trace')

const EPOCH = Date.UTC(2024, 0, 1)
const bytes = hex => Buffer.from(hex, 'hex')
const NONE = Buffer.alloc(0)

const create = () => {
  const clock = createVirtualClock()
  const told = []
  const recorder = new Recorder(clock, {
    fault: (station, code) => told.push(`${station} ${code}`),
    good: station => told.push(`${station} good`)
  })
  const rows = () => recorder.trace.rows().map(({ dir, station, bytes: hex, note }) => [dir, station, hex, note])
  return { clock, told, recorder, rows, counts: () => recorder.stats.snapshot() }
}
const ended = {
  station: 5,
  step: { match: () => ({}) },
  error: null,
  answer: bytes('0503'),
  facts: { sent: true, ms: 12 }
}

describe('line: what happened, counted and kept', () => {
  it('a query and its answer', async () => {
    const { recorder, clock, rows, told, counts } = create()
    await clock.advance(100)
    recorder.sent(5, bytes('01020304'), 'read')
    await clock.advance(30)
    recorder.ended(ended)
    assert.deepEqual(rows(), [
      ['out', 5, '01020304', 'read'],
      ['in', 5, '0503', '']
    ])
    assert.deepEqual(told, ['5 good'])
    const { queries, answers, bytesOut, busy, stations } = counts()
    assert.deepEqual([queries, answers, bytesOut, busy, stations[5].latency.max], [1, 1, 4, 30, 12])
    assert.deepEqual(
      recorder.trace.rows().map(({ t }) => t - EPOCH),
      [100, 130]
    )
  })

  it('a failure by its code, or its text; what never went out took no time of the wire', async () => {
    const { recorder, clock, rows, told, counts } = create()
    recorder.sent(5, bytes('01'), 'read')
    await clock.advance(10)
    for (const [code, counter] of [
      ['TIMEOUT', 'timeouts'],
      ['INCOMPLETE', 'incomplete'],
      ['CRC_ERROR', 'crcErrors']
    ]) {
      const error = new PlcError(/** @type {any} */ (code), { station: 5 })
      recorder.ended({ ...ended, error, facts: { sent: false, ms: 0 } })
      assert.deepEqual([counts()[counter], counts().stations[5][counter]], [1, 1], code)
    }
    recorder.ended({ ...ended, error: new TypeError('boom'), answer: NONE, facts: { sent: false, ms: 0 } })
    assert.deepEqual(rows().slice(1), [
      ['in', 5, '0503', 'TIMEOUT'],
      ['in', 5, '0503', 'INCOMPLETE'],
      ['in', 5, '0503', 'CRC_ERROR'],
      ['in', 5, '', 'boom']
    ])
    assert.deepEqual(told, ['5 TIMEOUT', '5 INCOMPLETE', '5 CRC_ERROR', '5 boom'])
    const { busy, timeouts, incomplete, crcErrors, answers } = counts()
    assert.deepEqual([busy, timeouts, incomplete, crcErrors, answers], [0, 1, 1, 1, 0])
    assert.deepEqual(Object.keys(counts()), Object.keys(create().counts()), 'and nothing else is counted')
  })

  it('a step that awaits no answer has none', () => {
    const { recorder, rows, told, counts } = create()
    recorder.ended({ ...ended, step: { match: null } })
    assert.deepEqual([rows(), told, counts().answers], [[], [], 0])
  })

  it('a late answer, an echo', () => {
    const { recorder, rows, told, counts } = create()
    recorder.late(5, bytes('0503'))
    recorder.echoed(bytes('0102'))
    assert.deepEqual(rows(), [
      ['in', 5, '0503', 'late'],
      ['in', null, '0102', 'echo']
    ])
    assert.deepEqual([told, counts().late, counts().stations[5].late, counts().echoes], [[], 1, 1, 1])
  })

  it('messages that come: whole, damaged, or cut, with the reason', () => {
    const { recorder, rows, told, counts } = create()
    const message = { kind: 'data', bytes: bytes('41'), complete: true }
    recorder.message(message)
    recorder.message({ ...message, kind: 'damaged', reason: 'sum' })
    recorder.message({ ...message, complete: false })
    recorder.message({ ...message, complete: false, reason: 'silent' })
    assert.deepEqual(
      rows().map(row => row[3]),
      ['', 'sum', 'incomplete', 'silent']
    )
    assert.deepEqual(told, ['null good', 'null sum', 'null incomplete', 'null silent'])
    assert.deepEqual([counts().messagesIn, counts().damagedMessages], [4, 3])
  })

  it('messages that go: the time of the wire; one that failed, by its code or its text', () => {
    const { recorder, rows, told, counts } = create()
    recorder.letter(bytes('42'), 'message')
    recorder.letterSent(25)
    recorder.letterFailed(new PlcError('TIMEOUT', { station: 0 }))
    recorder.letterFailed(new Error('boom'))
    assert.deepEqual(rows(), [
      ['out', null, '42', 'message'],
      ['in', null, '', 'TIMEOUT'],
      ['in', null, '', 'boom']
    ])
    const { messagesOut, busy, timeouts, stations } = counts()
    assert.deepEqual([messagesOut, busy, timeouts, stations, told], [1, 25, 1, {}, ['null TIMEOUT', 'null boom']])
    assert.deepEqual(Object.keys(counts()), Object.keys(create().counts()), 'and nothing else is counted')
  })

  it('bytes that nobody asked for, and how many all of them were', () => {
    const { recorder, rows, counts } = create()
    recorder.unclaimed('skipped', bytes('aabb'))
    recorder.unclaimed('stray', bytes('cc'))
    assert.deepEqual(rows(), [
      ['in', null, 'aabb', 'skipped'],
      ['in', null, 'cc', 'stray']
    ])
    assert.deepEqual([counts().skippedBytes, counts().strayBytes, recorder.stats.strays], [2, 1, 3])
    recorder.stats.count('crcErrors', 5)
    assert.equal(recorder.stats.strays, 4)
  })

  it('works where nobody is told', () => {
    const recorder = new Recorder(createVirtualClock())
    recorder.ended(ended)
    recorder.letterFailed(new Error('boom'))
    assert.equal(recorder.trace.rows().length, 2)
  })
})

describe('line: the last frames', () => {
  const row = (t, note = 'n') => ({ t, dir: /** @type {const} */ ('in'), station: 1, bytes: bytes('01'), note })

  it('so many, oldest first; each is told', () => {
    const told = []
    const trace = new Trace({ limit: 3, tell: ({ t }, grows) => told.push([t, grows]) })
    for (let t = 1; t <= 5; t++) trace.add(row(t))
    assert.deepEqual(
      trace.rows().map(({ t }) => t),
      [3, 4, 5]
    )
    assert.deepEqual(
      told,
      [1, 2, 3, 4, 5].map(t => [t, false])
    )
  })

  it('of each 600 bytes at most, as they were', () => {
    const trace = new Trace()
    const long = Buffer.alloc(700, 0xaa)
    trace.add({ ...row(1), bytes: long })
    long.fill(0)
    assert.equal(trace.rows()[0].bytes, 'aa'.repeat(600))
  })

  it('noise of one burst is one row: up to 100 ms apart, of one kind', () => {
    const told = []
    const trace = new Trace({ tell: ({ t }, grows) => told.push([t, grows]) })
    const stray = (t, note = 'stray') => trace.addStray({ t, bytes: bytes('0f'), note })
    stray(0)
    stray(100)
    stray(200)
    stray(301)
    stray(302, 'skipped')
    assert.deepEqual(
      trace.rows().map(({ t, note, bytes: hex }) => [t, note, hex]),
      [
        [200, 'stray', '0f0f0f'],
        [301, 'stray', '0f'],
        [302, 'skipped', '0f']
      ]
    )
    assert.deepEqual(told, [
      [0, true],
      [301, true],
      [302, true]
    ])
    for (let n = 0; n < 700; n++) stray(302, 'skipped')
    assert.equal(trace.rows()[2].bytes.length, 1200)
  })
})

describe('line: counters', () => {
  it('of a station that has not answered no latency is known', () => {
    const stats = new Stats()
    stats.count('queries', 7)
    assert.equal(stats.snapshot().stations[7].latency, null)
    stats.count('messagesOut', null)
    assert.deepEqual(Object.keys(stats.snapshot().stations), ['7'])
  })
})
