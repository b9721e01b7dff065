'use strict'

const assert = require('node:assert/strict')
const fsp = require('node:fs/promises')
const fs = require('node:fs')
const path = require('node:path')
const { Archive } = require('../../lib/line/archive')
const { Evidence } = require('../../lib/line/evidence')
const { EvidenceFile } = require('../../lib/line/evidence-file')
const { createVirtualClock } = require('../../lib/sim/clock')
const { createBench, failure } = require('./support/bench')
const { collect } = require('./support/framing')
const { tempFolder } = require('./support/real')
const toy = require('./support/toy')

const MB = 1024 * 1024
const answering = (bytes, wire) => wire.reply(toy.answer(bytes[1], [bytes[1]], bytes[2]))
const row = n => ({ t: n, dir: 'out', station: 1, bytes: Buffer.from([n >> 8, n & 0xff]), note: '' })

/** The evidence of a wire without a disk: what is given, as short texts. */
const bench = () => {
  const given = []
  const clock = createVirtualClock()
  const text = { frame: e => e.row.t, fault: e => `${e.station} ${e.code}`, event: e => e.event.event }
  const evidence = new Evidence({ clock, give: entry => given.push(text[entry.is](entry)) })
  let n = 0
  return {
    given,
    evidence,
    frames(count) {
      for (let k = 0; k < count; k++) evidence.frame(row(++n))
    },
    report: (event, more = {}) => evidence.event({ event, station: null, since: 0, ...more })
  }
}
const span = (from, to) => Array.from({ length: to - from + 1 }, (_, k) => from + k)

describe('evidence: which frames', () => {
  it('the last 200 before a fault and the next 200 after it, in order', () => {
    const { given, evidence, frames } = bench()
    frames(500)
    assert.deepEqual(given, [])
    evidence.fault(1, 'TIMEOUT')
    frames(500)
    assert.deepEqual(given, [...span(301, 500), '1 TIMEOUT', ...span(501, 700)])
  })

  it('of any number of frames and events the last ones that were on the wire', () => {
    for (const count of [200, 201, 599, 600, 601, 1350]) {
      const { given, evidence, frames, report } = bench()
      report('audit', { outcome: 'confirmed' })
      frames(count)
      evidence.fault(1, 'TIMEOUT')
      const events = count === 200 ? ['audit'] : []
      assert.deepEqual(given, [...events, ...span(count - 199, count), '1 TIMEOUT'], `${count}`)
    }
  })

  it('faults that overlap: each frame once, to the end of the last window', () => {
    const { given, evidence, frames } = bench()
    frames(50)
    evidence.fault(1, 'TIMEOUT')
    frames(100)
    evidence.fault(2, 'TIMEOUT')
    evidence.fault(1, 'CRC_ERROR')
    frames(1000)
    assert.deepEqual(given, [
      ...span(1, 50),
      '1 TIMEOUT',
      ...span(51, 150),
      '2 TIMEOUT',
      '1 CRC_ERROR',
      ...span(151, 350)
    ])
  })

  it('windows that touch: what lies between is not lost', () => {
    const { given, evidence, frames } = bench()
    evidence.fault(1, 'TIMEOUT')
    frames(300)
    evidence.fault(2, 'TIMEOUT')
    frames(10)
    assert.deepEqual(given, ['1 TIMEOUT', ...span(1, 200), ...span(201, 300), '2 TIMEOUT', ...span(301, 310)])
  })

  it('a fault that goes on asks for nothing more; a good answer of that station ends it', () => {
    const { given, evidence, frames } = bench()
    for (let n = 0; n < 5000; n++) {
      frames(2)
      evidence.fault(7, 'TIMEOUT')
      frames(2)
      evidence.good(8)
    }
    assert.equal(given.length, 1 + 2 + 200)
    evidence.good(7)
    evidence.fault(7, 'TIMEOUT')
    assert.equal(given.length, 203 + 200 + 1)
  })

  it('what is wrong with the line ends with the first good answer of any station', () => {
    const { given, evidence, frames, report } = bench()
    for (let n = 0; n < 100; n++) {
      report('lineDown')
      report('lineUp')
    }
    frames(400)
    // its own window takes its share of them, then nothing more
    assert.deepEqual([...new Set(given)].slice(0, 3), ['null lineDown', 'lineDown', 'lineUp'])
    assert.equal(given.filter(each => typeof each === 'string').length, 101)
    given.length = 0
    for (let n = 0; n < 100; n++) {
      report('lineDown')
      report('lineUp')
    }
    assert.deepEqual(given, [])
    evidence.good(3)
    report('lineDown')
    assert.deepEqual(given.slice(-2), ['null lineDown', 'lineDown'])
  })

  it('the end of a fault is kept, also after its window; the record of good writes only inside', () => {
    const { given, evidence, frames, report } = bench()
    report('audit', { station: 1, outcome: 'confirmed' })
    evidence.fault(1, 'TIMEOUT')
    report('audit', { station: 1, outcome: 'refused' })
    frames(250)
    given.length = 0
    report('audit', { station: 1, outcome: 'confirmed' })
    report('audit', { station: null, outcome: 'sent' })
    report('audit', { station: 0, outcome: 'unknown', code: 'BROADCAST_UNCONFIRMED' })
    evidence.good(1)
    report('stationBack', { station: 1 })
    report('slow', { station: 1 })
    report('somethingNew', { station: 1 })
    assert.deepEqual(given, ['stationBack', 'slow', 'somethingNew'])
  })

  it('a write that is unknown is a fault of its own', () => {
    const { given, frames, report } = bench()
    frames(3)
    report('audit', { station: 1, outcome: 'unknown' })
    frames(2)
    assert.deepEqual(given, [1, 2, 3, '1 audit unknown', 'audit', 4, 5])
  })

  for (const event of ['late', 'jammed', 'lineDown', 'stationDemoted', 'fixedMasterId']) {
    it(`${event} is a fault`, () => {
      const { given, frames, report } = bench()
      frames(2)
      report(event, { station: 5 })
      frames(1)
      assert.deepEqual(given, [1, 2, `5 ${event}`, event, 3])
    })
  }

  it('a write that failed is a fault; one that was refused, sent or broadcast is none', () => {
    const { given, frames, report } = bench()
    frames(1)
    for (const outcome of ['refused', 'sent', 'confirmed']) report('audit', { station: 5, outcome })
    report('audit', { station: 0, outcome: 'unknown', code: 'BROADCAST_UNCONFIRMED' })
    assert.deepEqual(given, [])
    report('audit', { station: 5, outcome: 'failed', code: 'TIMEOUT' })
    assert.deepEqual(given, [1, 'audit', 'audit', 'audit', 'audit', '5 audit failed', 'audit'])
  })

  it('before a fault only so many events are kept', () => {
    const { given, evidence, frames, report } = bench()
    for (let n = 0; n < 1000; n++) report('audit', { station: 5, outcome: 'confirmed' })
    frames(10)
    evidence.fault(1, 'TIMEOUT')
    assert.equal(given.length, 301)
    assert.deepEqual(given.slice(-11), [...span(1, 10), '1 TIMEOUT'])
  })

  it('events without end in a window without frames are bounded, and so are the stations that are remembered', () => {
    const { given, evidence, report } = bench()
    report('lineDown')
    for (let n = 0; n < 5000; n++) report('audit', { station: 1, outcome: 'failed' })
    assert.ok(given.length < 350, `${given.length}`)
    for (let n = 0; n < 1500; n++) evidence.fault(`s${n}`, 'TIMEOUT')
  })
})

describe('evidence: the file', () => {
  let folder
  let clock
  let made
  beforeEach(() => {
    folder = tempFolder()
    clock = createVirtualClock()
    made = []
  })
  afterEach(async () => {
    await Promise.all(made.map(file => file.flush()))
    fs.rmSync(folder, { recursive: true, force: true })
  })
  const open = (where = folder) => {
    const file = new EvidenceFile({ clock, folder: where, name: 'wire' })
    made.push(file)
    return file
  }
  const frame = (n, length = 2) => ({ is: 'frame', row: { ...row(n), bytes: Buffer.alloc(length, n) } })
  const warnings = () => {
    const texts = []
    const hear = ({ message }) => texts.push(message)
    process.on('warning', hear)
    return { texts, end: () => process.off('warning', hear) }
  }

  const size = file => (fs.existsSync(file) ? fs.statSync(file).size : 0)

  it('lines of JSON with the time as a text, written together after a moment', async () => {
    const file = open(path.join(folder, 'not', 'yet'))
    file.add({
      is: 'frame',
      row: { t: 1500, dir: 'in', station: 'A', bytes: Buffer.from('01ff', 'hex'), note: 'TIMEOUT' }
    })
    file.add({ is: 'fault', t: 1500, station: 'A', code: 'TIMEOUT' })
    file.add({ is: 'event', event: { event: 'late', station: 'A', since: 2000, lateness: 7, cause: 'c', remedy: 'r' } })
    assert.equal(fs.existsSync(file.folder), false)
    await clock.advance(2000)
    await file.flush()
    assert.equal(
      fs.readFileSync(file.file, 'utf8'),
      [
        '{"is":"frame","t":"1970-01-01T00:00:01.500Z","dir":"in","station":"A","bytes":"01ff","note":"TIMEOUT"}',
        '{"is":"fault","t":"1970-01-01T00:00:01.500Z","station":"A","code":"TIMEOUT"}',
        '{"is":"event","t":"1970-01-01T00:00:02.000Z","event":"late","station":"A","lateness":7,"cause":"c","remedy":"r"}\n'
      ].join('\n')
    )
    assert.deepEqual(file.facts, {
      file: file.file,
      previous: file.previous,
      written: 3,
      skipped: 0,
      lost: 0,
      error: null
    })
    assert.equal(clock.pending(), 0)
  })

  it('what comes while it writes is written next, by itself', async () => {
    const { appendFile } = fsp
    let go = () => {}
    const held = new Promise(resolve => (go = () => resolve(undefined)))
    fsp.appendFile = (...facts) => held.then(() => appendFile(...facts))
    try {
      const file = open()
      file.add(frame(1))
      await clock.advance(2000)
      for (let n = 2; n < 5; n++) file.add(frame(n))
      await clock.advance(5000)
      assert.equal(file.facts.written, 0)
      go()
      while (file.facts.written < 1) await new Promise(setImmediate)
      await new Promise(setImmediate)
      assert.equal(clock.pending(), 1)
      await clock.advance(2000)
      while (file.facts.written < 4) await new Promise(setImmediate)
      assert.equal(fs.readFileSync(file.file, 'utf8').trim().split('\n').length, 4)
    } finally {
      fsp.appendFile = appendFile
    }
  })

  it('goes on in the file of before; the folder may go and come', async () => {
    const first = open()
    first.add(frame(1))
    await first.flush()
    const second = open()
    second.add(frame(2))
    await second.flush()
    second.add(frame(3))
    await second.flush()
    assert.match(fs.readFileSync(second.file, 'utf8'), /^[^\n]+01"[^\n]+\n[^\n]+02"[^\n]+\n[^\n]+03"[^\n]+\n$/)
    const { end } = warnings()
    fs.rmSync(folder, { recursive: true })
    second.add(frame(4))
    await second.flush()
    fs.mkdirSync(folder)
    second.add(frame(5))
    await second.flush()
    // the disk is left alone for a minute
    assert.deepEqual([second.facts.written, second.facts.lost, fs.existsSync(second.file)], [2, 2, false])
    fs.rmSync(folder, { recursive: true })
    await clock.advance(60000)
    second.add(frame(6))
    await second.flush()
    end()
    assert.deepEqual([second.facts.written, second.facts.lost, second.facts.error], [3, 2, null])
  })

  it('the last rows come from both files, in order', async () => {
    const file = open()
    fs.writeFileSync(file.previous, '{"n":1}\n{"n":2}\n')
    fs.writeFileSync(file.file, '{"n":3}\n{"n":4}\n')
    const last = async most => (await file.tail(most)).map(({ n }) => n)
    assert.deepEqual(await last(10), [1, 2, 3, 4])
    assert.deepEqual(await last(3), [2, 3, 4])
    assert.deepEqual(await last(1), [4])
  })

  it('closing with nothing to write ends at once', () => {
    let settled = 0
    open().settle(() => settled++)
    assert.deepEqual([settled, clock.pending()], [1, 0])
  })

  it('what cannot be said in a line is lost, and counted', async () => {
    const file = open()
    file.add({ is: 'fault', t: 1, station: 'x'.repeat(5000), code: 'TIMEOUT' })
    file.add(frame(1))
    assert.equal((await file.tail(9)).length, 1)
    assert.deepEqual([file.facts.written, file.facts.lost], [1, 1])
  })

  it('two files of 512 kB at most, whatever comes; every line is whole', async () => {
    const file = open()
    let most = 0
    for (let n = 0; n < 40; n++) {
      for (let k = 0; k < 50; k++) file.add(frame(n, 600))
      await file.flush()
      await clock.advance(70000)
      most = Math.max(most, size(file.file) + size(file.previous))
      assert.ok(size(file.file) <= MB / 2 && size(file.previous) <= MB / 2)
    }
    assert.ok(most > 0.9 * MB && most <= MB, `${most}`)
    const lines = [file.previous, file.file].flatMap(name => fs.readFileSync(name, 'utf8').trim().split('\n'))
    lines.forEach(line => JSON.parse(line))
    const rows = await file.tail(100000)
    assert.equal(rows.length, lines.length)
    const { written, skipped, lost } = file.facts
    assert.deepEqual([written, skipped, lost], [2000, 0, 0])
  })

  it('64 kB a minute on average; the rest is counted, and said where it is missing', async () => {
    const file = open()
    let bytes = 0
    let before = 0
    const minute = 60000
    for (let n = 0; n < 30; n++) {
      for (let k = 0; k < 400; k++) file.add(frame(n, 100))
      await file.flush()
      const now = size(file.file)
      bytes += now >= before ? now - before : now
      before = now
      await clock.advance(minute)
    }
    // what may be written at once after a quiet time comes to it
    assert.ok(bytes < 64 * 1024 * 30 + 256 * 1024 && bytes > 64 * 1024 * 25, `${bytes}`)
    const { written, skipped } = file.facts
    assert.ok(skipped > 3000 && written > 5000, `${written} ${skipped}`)
    const told = (await file.tail(100000)).filter(({ is }) => is === 'skipped')
    assert.ok(told.length > 5 && told.every(({ rows }) => rows > 0))
    for (let k = 0; k < 1000; k++) file.add(frame(1, 100))
    file.add({ is: 'event', event: { event: 'lineDown', station: null, since: 0 } })
    await file.flush()
    assert.equal((await file.tail(1))[0].event, 'lineDown', 'events have a share that frames do not take')
  }).timeout(10000)

  it('a thousand values, or values that JSON cannot say: the event is cut', async () => {
    const file = open()
    const circular = {}
    circular.self = circular
    const trap = {
      get value() {
        throw new Error('trap')
      }
    }
    for (const items of [[{ value: 'x'.repeat(9000) }], [{ value: 5n }], [circular], [trap]]) {
      file.add({
        is: 'event',
        event: { event: 'audit', station: 4, since: 1, cause: 'y'.repeat(9000), outcome: 'failed', items }
      })
    }
    const rows = await file.tail(10)
    assert.deepEqual(
      rows.map(({ event, station, cut, outcome, cause }) => [event, station, cut, outcome, cause.length]),
      Array(4).fill(['audit', 4, true, 'failed', 200])
    )
  })

  it('text of a device cannot begin a line', async () => {
    const file = open()
    file.add({ is: 'event', event: { event: 'late', station: 1, since: 1, cause: 'a\n{"is":"fault"}\r\u2028\u0000' } })
    assert.equal((await file.tail(10)).length, 1)
    assert.equal(
      fs
        .readFileSync(file.file, 'utf8')
        .trim()
        .split(/[\n\r]/).length,
      1
    )
  })

  it('a line that was torn costs itself only', async () => {
    const first = open()
    first.add(frame(1))
    await first.flush()
    fs.appendFileSync(first.file, '{"is":"frame","t":"19')
    const second = open()
    second.add(frame(2))
    second.add(frame(3))
    const rows = await second.tail(10)
    assert.deepEqual(
      rows.map(({ bytes }) => bytes),
      ['0101', '0202', '0303']
    )
  })

  it('a full disk: told once, counted, left alone for a minute, and used again', async function () {
    if (!fs.existsSync('/dev/full')) return this.skip()
    const { texts, end } = warnings()
    const file = open()
    fs.symlinkSync('/dev/full', file.file)
    for (let n = 0; n < 5; n++) {
      file.add(frame(n))
      await file.flush()
      await clock.advance(30000)
    }
    assert.deepEqual([file.facts.written, file.facts.lost, file.facts.error.code], [0, 5, 'ENOSPC'])
    fs.unlinkSync(file.file)
    await clock.advance(60000)
    file.add(frame(9))
    await file.flush()
    end()
    assert.deepEqual([file.facts.written, file.facts.lost, file.facts.error], [1, 5, null])
    assert.equal(texts.length, 1)
    assert.match(texts[0], /wire\.jsonl: ENOSPC/)
  })

  it('a folder that cannot be made: counted, no rejection, nothing to read', async () => {
    const { texts, end } = warnings()
    fs.writeFileSync(path.join(folder, 'file'), '')
    const file = open(path.join(folder, 'file', 'below'))
    for (let n = 0; n < 3; n++) {
      file.add(frame(n))
      await file.flush()
      await clock.advance(70000)
    }
    end()
    assert.deepEqual([file.facts.lost, file.facts.error.code, texts.length], [3, 'ENOTDIR', 1])
    assert.deepEqual(await file.tail(10), [])
  })

  it('a disk that does not answer: memory is bounded, closing does not wait for it', async () => {
    const { appendFile } = fsp
    /** @type {any} */
    let answer
    fsp.appendFile = () => new Promise(resolve => (answer = resolve))
    try {
      const file = open()
      file.add(frame(1))
      await clock.advance(2000)
      while (!answer) await new Promise(setImmediate)
      for (let n = 0; n < 10000; n++) file.add(frame(n))
      assert.equal(file.facts.lost, 8000)
      let settled = 0
      file.settle(() => settled++)
      await clock.advance(249)
      assert.equal(settled, 0)
      await clock.advance(1)
      assert.equal(settled, 1)
      fsp.appendFile = appendFile
      answer()
      await file.flush()
      await clock.advance(1000)
      assert.equal(settled, 1)
    } finally {
      fsp.appendFile = appendFile
    }
  })
})

describe('evidence: of a line', () => {
  let folder
  beforeEach(() => (folder = tempFolder()))
  afterEach(() => fs.rmSync(folder, { recursive: true, force: true }))
  const start = options => createBench({ evidence: { folder }, ...options })
  const wireOf = ({ wire }) => ({ transport: 'simulated', wire })
  const read = async made => {
    const monitor = made.pool.monitor(wireOf(made))
    const all = await monitor.evidence(100000)
    monitor.stop()
    return all
  }
  const brief = rows =>
    rows.map(({ is, dir, station, note, code, event }) => [is, event ?? dir ?? code, station, note].join(' '))

  it('a timeout among good answers: frames before, the fault, frames after', async () => {
    const made = start({ onQuery: (bytes, wire, n) => n !== 3 && answering(bytes, wire) })
    for (const station of [1, 2, 3, 4, 5])
      await made.run(made.lease.run(() => toy.ask(station), { station })).catch(() => {})
    const { file, rows, written, error } = await read(made)
    assert.deepEqual(brief(rows), [
      ...[
        'frame out 1 ',
        'frame in 1 ',
        'frame out 2 ',
        'frame in 2 ',
        'frame out 3 ',
        'frame in 3 TIMEOUT',
        'fault TIMEOUT 3 '
      ],
      ...['frame out 4 ', 'frame in 4 ', 'frame out 5 ', 'frame in 5 ']
    ])
    assert.equal(rows[0].bytes, '510100' + '52')
    assert.equal(rows[0].t, '2024-01-01T00:00:00.000Z')
    assert.deepEqual([written, error], [rows.length, null])
    assert.equal(path.dirname(file), folder)
    assert.deepEqual(fs.readdirSync(folder), [path.basename(file)])
    await made.run(made.lease.release())
  })

  it('a station that is dead for good is not written for ever: a day of polls', async () => {
    const made = start({ onQuery: (bytes, wire) => bytes[1] === 2 && answering(bytes, wire) })
    const { clock, lease } = made
    const day = 24 * 3600000
    for (let n = 0; n < 150; n++) {
      await clock.run(Promise.allSettled([1, 2].map(station => lease.run(() => toy.ask(station), { station }))))
      await clock.advance(day / 150)
    }
    const { rows, skipped, lost } = await read(made)
    assert.ok(lease.line.stats().queries > 250)
    assert.equal(rows.filter(({ is }) => is === 'fault').length, 1)
    assert.ok(rows.length < 210, `${rows.length}`)
    assert.deepEqual([skipped, lost], [0, 0])
    await made.run(lease.release())
  }).timeout(10000)

  it('late answers: the event stands among the frames', async () => {
    const onQuery = (bytes, wire, n) => wire.reply(toy.answer(bytes[1], [1], bytes[2]), { after: n === 1 ? 300 : 5 })
    const made = start({ onQuery })
    const { clock, lease } = made
    await made.run(failure(lease.run(() => toy.ask(1), { station: 1 })))
    await clock.advance(2000)
    const { rows } = await read(made)
    assert.deepEqual(brief(rows), [
      ...[
        'frame out 1 ',
        'frame in 1 TIMEOUT',
        'fault TIMEOUT 1 ',
        'frame in  stray',
        'frame in 1 late',
        'fault late 1 ',
        'event late 1 '
      ]
    ])
    assert.equal(rows.at(-1).lateness, 100)
    await made.run(lease.release())
  })

  it('lost and found again: lineDown and lineUp', async () => {
    const made = start({ onQuery: answering })
    const { clock, lease, wire } = made
    await made.run(lease.run(() => toy.ask(1), { station: 1 }))
    wire.unplug()
    await clock.advance(5000)
    const { rows } = await read(made)
    assert.deepEqual(brief(rows).slice(2), ['fault lineDown  ', 'event lineDown  ', 'event lineUp  '])
    await made.run(lease.release())
  })

  it('a redeploy neither begins a new window nor forgets what came before; a closed line has written all', async () => {
    const made = start({ onQuery: () => {} })
    const { open, run, pool } = made
    let { lease } = made
    for (let n = 0; n < 4; n++) {
      await run(failure(lease.run(() => toy.ask(1), { station: 1 })))
      await run(lease.release())
      lease = open({ gap: n })
    }
    await run(lease.release())
    assert.deepEqual(pool.lines(), [])
    const { file, rows } = await read(made)
    assert.equal(fs.readFileSync(file, 'utf8').trim().split('\n').length, rows.length)
    assert.deepEqual(
      brief(rows).filter(text => text.startsWith('fault')),
      ['fault TIMEOUT 1 ']
    )
    assert.equal(rows.filter(({ dir }) => dir === 'out').length, 4)
  })

  it('messages of a line that listens: damaged ones are faults', async () => {
    const made = start()
    const { clock, lease, wire } = made
    await clock.advance(1)
    collect(lease)
    wire.handlers.data(Buffer.from('A;?B;C;'))
    const { rows } = await read(made)
    assert.deepEqual(
      rows.map(({ is, bytes = '', code = '' }) => `${is} ${Buffer.from(bytes, 'hex')}${code}`),
      ['frame A', 'frame ?B', 'fault incomplete', 'frame C']
    )
    await made.run(lease.release())
  })

  it('by default nothing is kept', async () => {
    const made = createBench({ onQuery: () => {} })
    await made.run(failure(made.lease.run(() => toy.ask(1), { station: 1 })))
    const { file, rows } = await read(made)
    assert.deepEqual([file, rows, made.clock.pending()], [null, [], 0])
    assert.deepEqual(fs.readdirSync(folder), [])
    await made.run(made.lease.release())
  })

  it('each wire has a file of its own in the folder, whatever its name is', () => {
    const archive = new Archive(createVirtualClock(), () => folder)
    const keys = [
      '/dev/../../etc/passwd',
      '..',
      'a/b',
      'a_b',
      '',
      'x'.repeat(300),
      '한글',
      'COM3',
      'a\0b',
      'simulated:1'
    ]
    const files = keys.map(key => archive.facts(key).file)
    assert.equal(new Set(files).size, keys.length)
    for (const file of files) {
      assert.equal(path.dirname(file), folder)
      assert.match(path.basename(file), /^[\w-]{1,80}\.jsonl$/)
    }
    assert.equal(archive.facts('a/b').file, files[2])
  })

  it('a time that is none is null', async () => {
    const file = new EvidenceFile({ clock: createVirtualClock(), folder, name: 'wire' })
    for (const since of [NaN, Infinity, 9e15, undefined])
      file.add({ is: 'event', event: { event: 'late', station: 1, since } })
    assert.deepEqual(
      (await file.tail(9)).map(({ t }) => t),
      [null, null, null, null]
    )
  })
})
