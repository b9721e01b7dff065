'use strict'

const assert = require('node:assert')
const { createChinoRegulator } = require('../../lib/sim')
const { bytes, framed, shown } = require('./support')

/** A regulator alone: feeds it queries one after the other, 100 ms apart. Queries are bodies, the check code is the test's own. */
function bench(settings = {}) {
  const time = { now: 0 }
  const station = createChinoRegulator({ station: 17, heating: false, clock: { now: () => time.now }, ...settings })
  const hear = frame => {
    time.now += 100
    return station.receive(frame, { start: time.now, end: time.now + 5 })
  }
  const answers = (jobs, refuse) => jobs.map(job => job.answer(refuse)).map(answer => answer && shown(answer))
  const ask = (body, refuse) => answers(hear(framed(...bytes(body))), refuse)
  return { station, ask, hear, answers, time }
}

/** A body with its check code, as text. */
const closed = body => shown(framed(...bytes(body)))
const exception = (fn, number) => [shown(framed(17, fn | 0x80, number))]

/** ASCII by hand: the LRC is what makes the sum of all bytes 0. */
const ascii = body => {
  const all = [...bytes(body)]
  const lrc = -all.reduce((sum, byte) => sum + byte, 0) & 0xff
  return `:${[...all, lrc].map(byte => byte.toString(16).toUpperCase().padStart(2, '0')).join('')}\r\n`
}

const setBits = (station, table, first, text) =>
  [...text.replace(/\s/g, '')].forEach((bit, n) => station.set(`${table}${first + n}`, bit === '1'))

// appendix A of the panel manual: [what, query with CRC, answer with CRC, LRCs, memory]. Bits: the lowest address first
const EXAMPLES = [
  [
    'read coils 20 to 56',
    '11 01 00 13 00 25 0E 84',
    '11 01 05 CD 6B B2 0E 1B 45 E6',
    ['B6', 'D6'],
    station => setBits(station, 'co', 19, '10110011 11010110 01001101 01110000 11011')
  ],
  [
    'read inputs 10197 to 10218',
    '11 02 00 C4 00 16 BA A9',
    '11 02 03 AC DB 35 20 18',
    ['13', '2E'],
    station => setBits(station, 'di', 196, '00110101 11011011 101011')
  ],
  [
    'read input register 30009',
    '11 04 00 08 00 01 B2 98',
    '11 04 02 00 0A F8 F4',
    ['E2', 'DF'],
    station => station.set('30009', 10)
  ],
  [
    'read holding registers 40108 to 40110',
    '11 03 00 6B 00 03 76 87',
    '11 03 06 02 2B 00 00 00 64 C8 BA',
    ['7E', '55'],
    station => {
      station.set('400108', 0x22b)
      station.set('hr109', 100)
    }
  ],
  ['preset single register 40002', '11 06 00 01 00 03 9A 9B', '11 06 00 01 00 03 9A 9B', ['E5', 'E5'], () => {}],
  [
    'preset multiple registers',
    '11 10 00 01 00 02 04 00 0A 01 02 C6 F0',
    '11 10 00 01 00 02 12 98',
    ['CB', 'DC'],
    () => {}
  ],
  ['force single coil 173', '11 05 00 AC FF 00 4E 8B', '11 05 00 AC FF 00 4E 8B', ['3F', '3F'], () => {}]
]

describe('simulated regulator: worked examples of the manual', () => {
  for (const [name, query, answer, [lrcOut, lrcBack], prepare] of EXAMPLES) {
    it(`${name}, RTU`, () => {
      const { station, hear, answers } = bench()
      prepare(station)
      assert.deepStrictEqual(answers(hear(bytes(query))), [answer])
    })

    it(`${name}, ASCII`, () => {
      const { station, hear } = bench({ protocol: 'ascii' })
      prepare(station)
      const [out, back] = [query, answer].map(text => text.replace(/\s/g, '').slice(0, -4))
      const jobs = hear(Buffer.from(`:${out}${lrcOut}\r\n`))
      assert.deepStrictEqual(
        jobs.map(job => String(job.answer())),
        [`:${back}${lrcBack}\r\n`]
      )
      assert.strictEqual(String(jobs[0].request), `:${out}${lrcOut}\r\n`)
    })
  }

  it('the writes arrive in the tables', () => {
    const { station, ask } = bench()
    ask('11 06 00 01 00 03')
    assert.strictEqual(station.get('40002'), 3)
    ask('11 10 00 01 00 02 04 00 0A 01 02')
    assert.deepStrictEqual([station.get('400002'), station.get('hr2')], [10, 0x102])
    ask('11 05 00 AC FF 00')
    assert.strictEqual(station.get('000173'), true)
    ask('11 05 00 AC 00 00')
    assert.strictEqual(station.get('co172'), false)
    // not in the manual: 0F. CD 01 = coils 20 to 27 as 1011 0011, 28 and 29 as 1 0
    assert.deepStrictEqual(ask('11 0F 00 13 00 0A 02 CD 01'), [closed('11 0F 00 13 00 0A')])
    const coils = Array.from({ length: 10 }, (_, n) => Number(station.get(`co${19 + n}`)))
    assert.deepStrictEqual(coils, [1, 0, 1, 1, 0, 0, 1, 1, 1, 0])
    assert.deepStrictEqual(Object.fromEntries(station.writes), {
      hr1: 2,
      hr2: 1,
      co172: 2,
      ...Object.fromEntries(coils.map((_, n) => [`co${19 + n}`, 1]))
    })
    assert.deepStrictEqual([station.counts.queries, station.counts.executed, station.counts.errors], [5, 5, 0])
  })

  it('four tables stand apart; 0-base addresses', () => {
    const { station, ask } = bench({ addressMode: '0-base' })
    station.set('400007', 1)
    station.set('300007', 2)
    station.set('000007', true)
    assert.deepStrictEqual(ask('11 03 00 07 00 01'), [closed('11 03 02 00 01')])
    assert.deepStrictEqual(ask('11 04 00 07 00 01'), [closed('11 04 02 00 02')])
    assert.deepStrictEqual(ask('11 01 00 07 00 01'), [closed('11 01 01 01')])
    assert.deepStrictEqual(ask('11 02 00 07 00 01'), [closed('11 02 01 00')])
  })

  it('types and bits of registers: low word first', () => {
    const { station, ask } = bench()
    station.set('400001', 0x12345678, 'uint32')
    assert.deepStrictEqual(ask('11 03 00 00 00 02'), [closed('11 03 04 56 78 12 34')])
    assert.strictEqual(station.get('400001', 'uint32'), 0x12345678)
    station.set('400001', 0xfedcba98, 'uint32')
    assert.deepStrictEqual([station.get('400001', 'uint32'), station.get('400001', 'int32')], [0xfedcba98, -0x01234568])
    station.set('400009.15', true)
    assert.deepStrictEqual([station.get('400009'), station.get('hr8.15')], [0x8000, true])
  })
})

describe('simulated regulator: exceptions', () => {
  const LIMITS = [
    ['01', '11 01 00 00 07 D0', '11 01 00 00 07 D1', 2000],
    ['02', '11 02 00 00 07 D0', '11 02 00 00 07 D1', 2000],
    ['03', '11 03 00 00 00 7D', '11 03 00 00 00 7E', 125],
    ['04', '11 04 00 00 00 7D', '11 04 00 00 00 7E', 125]
  ]
  for (const [fn, most, more, count] of LIMITS) {
    it(`${fn}: ${count} at once, not ${count + 1}, not 0`, () => {
      const { ask } = bench()
      const [answer] = ask(most)
      assert.strictEqual(bytes(answer).length, 5 + (count > 125 ? count / 8 : 2 * count))
      assert.deepStrictEqual(ask(more), exception(Number(fn), 3))
      assert.deepStrictEqual(ask(`11 ${fn} 00 00 00 00`), exception(Number(fn), 3))
    })
  }

  it('0F and 10: 1968 and 123 at once', () => {
    const { station, ask } = bench()
    assert.deepStrictEqual(ask(`11 0F 00 00 07 B0 F6 ${'FF '.repeat(246)}`), [closed('11 0F 00 00 07 B0')])
    assert.deepStrictEqual(ask(`11 10 00 00 00 7B F6 ${'00 07 '.repeat(123)}`), [closed('11 10 00 00 00 7B')])
    assert.deepStrictEqual([station.writes.size, station.get('hr122'), station.get('co1967')], [1968 + 123, 7, true])
    // the same numbers with one more do not fit into a frame
    assert.deepStrictEqual(ask(`11 0F 00 00 07 B1 F7 ${'FF '.repeat(247)}`), exception(15, 3))
    assert.deepStrictEqual(ask('11 10 00 00 00 00 00'), exception(16, 3))
    assert.strictEqual(station.writes.size, 1968 + 123)
  })

  const cases = [
    ['1: a function that nobody has', '11 2B 0E 01 00', 0x2b, 1],
    ['2: beyond the last register', '11 03 FF FF 00 02', 3, 2],
    ['2: beyond the last coil', '11 0F FF F8 00 09 02 FF 01', 15, 2],
    ['3: a coil that is neither on nor off', '11 05 00 00 12 34', 5, 3],
    ['3: a byte count that does not fit', '11 10 00 00 00 02 02 00 01', 16, 3],
    ['3: fewer bytes of coils than coils', '11 0F 00 00 00 09 01 FF', 15, 3]
  ]
  for (const [name, query, fn, number] of cases) {
    it(String(name), () => {
      const { station, ask } = bench()
      assert.deepStrictEqual(ask(query), exception(fn, number))
      assert.deepStrictEqual([station.counts.executed, station.counts.errors, station.writes.size], [0, 1, 0])
    })
  }

  it('1: a device without a function', () => {
    const { ask } = bench({ functions: [3, 6] })
    assert.deepStrictEqual(ask('11 10 00 00 00 01 02 00 01'), exception(16, 1))
    assert.deepStrictEqual(ask('11 06 00 00 00 01'), [closed('11 06 00 00 00 01')])
  })

  it('2: what a table does not have; tables that are not named have all', () => {
    const { ask } = bench({ tables: { hr: ['400001..400100', 'hr200'], di: [] } })
    assert.strictEqual(ask('11 03 00 63 00 01')[0].length, 20)
    assert.deepStrictEqual(ask('11 03 00 63 00 02'), exception(3, 2))
    assert.strictEqual(ask('11 03 00 C8 00 01')[0].length, 20)
    assert.deepStrictEqual(ask('11 06 00 C9 00 01'), exception(6, 2))
    assert.deepStrictEqual(ask('11 02 00 00 00 01'), exception(2, 2))
    assert.strictEqual(ask('11 04 FF FF 00 01')[0].length, 20)
  })

  it('3 or 4: protected; nothing of the frame is written', () => {
    const protect = ['400010..400019', 'co5', 'hr30.07']
    const { station, ask } = bench({ protect })
    assert.deepStrictEqual(ask('11 10 00 08 00 02 04 00 01 00 01'), exception(16, 3))
    assert.deepStrictEqual(ask('11 0F 00 00 00 08 01 FF'), exception(15, 3))
    assert.deepStrictEqual(ask('11 06 00 1E 00 01'), exception(6, 3))
    assert.strictEqual(station.writes.size, 0)
    assert.deepStrictEqual(ask('11 06 00 13 00 01'), [closed('11 06 00 13 00 01')])
    assert.deepStrictEqual(ask('11 03 00 09 00 01'), [closed('11 03 02 00 00')])
    assert.deepStrictEqual(bench({ protect, protectError: 4 }).ask('11 05 00 05 FF 00'), exception(5, 4))
  })

  it('3: what a register does not take', () => {
    const { station, ask } = bench({ ranges: [{ at: '400001', least: 10, most: 1000 }] })
    assert.deepStrictEqual(ask('11 06 00 00 03 E9'), exception(6, 3))
    assert.deepStrictEqual(ask('11 10 00 00 00 02 04 00 09 00 01'), exception(16, 3))
    assert.deepStrictEqual([station.get('400001'), station.get('400002')], [0, 0])
    assert.deepStrictEqual(ask('11 06 00 00 03 E8'), [closed('11 06 00 00 03 E8')])
  })

  it('3: shorter frames than the protocol allows', () => {
    const { ask } = bench({ limits: { 3: 8 } })
    assert.deepStrictEqual(ask('11 03 00 00 00 09'), exception(3, 3))
    assert.strictEqual(bytes(ask('11 03 00 00 00 08')[0]).length, 21)
  })

  it('any number, if a fault asks for it', () => {
    const { station, ask } = bench()
    assert.deepStrictEqual(ask('11 06 00 00 00 01', 6), exception(6, 6))
    assert.deepStrictEqual(ask('11 03 00 00 00 01', 0x0b), exception(3, 0x0b))
    assert.strictEqual(station.counts.executed, 0)
  })

  it('broadcasts are carried out without an answer, also where they are refused; reads are nobody’s', () => {
    const { station, ask } = bench({ protect: ['co5'] })
    assert.deepStrictEqual(ask('00 06 00 07 12 34'), [null])
    assert.strictEqual(station.get('hr7'), 0x1234)
    assert.deepStrictEqual(ask('00 05 00 05 FF 00'), [null])
    assert.deepStrictEqual(ask('00 06 00 07 00 00', 4), [null])
    assert.strictEqual(station.get('hr7'), 0x1234)
    assert.deepStrictEqual(ask('00 03 00 07 00 01'), [])
    assert.deepStrictEqual(ask('00 2B 00 07 00 01'), [])
    assert.deepStrictEqual([station.counts.broadcasts, station.counts.foreign], [3, 2])
  })

  const wrong = [
    [{ station: 0 }, 'BAD_STATION'],
    [{ station: 248 }, 'BAD_STATION'],
    [{ station: '11' }, 'BAD_STATION'],
    [{ protocol: 'tcp' }, 'BAD_SETTING'],
    [{ protectError: 2 }, 'BAD_SETTING'],
    [{ tables: { xx: [] } }, 'BAD_SETTING'],
    [{ tables: { hr: ['300001'] } }, 'BAD_SETTING'],
    [{ ranges: [{ at: 'co1' }] }, 'BAD_SETTING'],
    [{ protect: ['400000'] }, 'OUT_OF_AREA'],
    [{ behaviour: [{ at: 'co1', as: 'uint16', kind: 'random' }] }, 'BAD_SETTING']
  ]
  for (const [settings, code] of wrong) {
    it(`refuses ${JSON.stringify(settings)}`, () => {
      assert.throws(() => bench(Object(settings)), { code })
    })
  }
})

describe('simulated regulator: RTU receiver', () => {
  const READ = framed(...bytes('11 03 00 6B 00 03'))
  const WRITE = framed(...bytes('11 10 00 01 00 02 04 00 0A 01 02'))
  const ZERO = closed('11 03 06 00 00 00 00 00 00')

  it('is silent to every single flipped bit, and hears the next query', () => {
    for (const frame of [READ, WRITE]) {
      for (let bit = 0; bit < frame.length * 8; bit++) {
        const query = Buffer.from(frame)
        query[bit >> 3] ^= 1 << (bit & 7)
        const { station, hear, answers } = bench()
        assert.deepStrictEqual(answers(hear(query)), [], `bit ${bit}`)
        assert.deepStrictEqual(answers(hear(READ)), [ZERO], `after bit ${bit}`)
        assert.deepStrictEqual([station.counts.executed, station.writes.size], [1, 0])
      }
    }
  })

  it('takes a frame in any pieces', () => {
    for (const frame of [READ, WRITE, framed(17, 0x2b, 1, 2)]) {
      for (let cut = 1; cut < frame.length; cut++) {
        const { station } = bench()
        const first = station.receive(frame.subarray(0, cut), { start: 0, end: cut })
        const jobs = station.receive(frame.subarray(cut), { start: cut, end: frame.length })
        assert.deepStrictEqual([first.length, jobs.length], [0, 1], `cut at ${cut}`)
      }
    }
  })

  it('forgets half a frame after 3.5 characters, not before', () => {
    for (const [baudRate, silence] of [
      [9600, 3.6458],
      [19200, 1.8229],
      [115200, 1.75]
    ]) {
      const after = pause => {
        const { station } = bench({ baudRate })
        station.receive(READ.subarray(0, 5), { start: 0, end: 5 })
        return station.receive(READ.subarray(5), { start: 5 + pause, end: 12 }).length
      }
      assert.deepStrictEqual([after(silence - 0.01), after(silence + 0.01)], [1, 0], String(baudRate))
    }
  })

  it('answers after 3.5 characters at the earliest, ASCII at once', () => {
    const [quick] = bench({ turnaround: 0, baudRate: 9600 }).hear(READ)
    assert.ok(Math.abs(quick.turnaround - 3.6458) < 1e-3)
    assert.strictEqual(bench({ turnaround: 20 }).hear(READ)[0].turnaround, 20)
    const [own] = bench({ turnaround: 0, protocol: 'ascii' }).hear(Buffer.from(ascii('11 03 00 6B 00 03')))
    assert.strictEqual(own.turnaround, 0)
  })

  it('hears its query among the frames of others, without a pause between them', () => {
    const others = [
      ['a query to another', closed('12 03 00 6B 00 03')],
      ['the answer of another', closed('12 03 06 11 03 00 6B 00 03')],
      ['another’s answer to a write', closed('12 10 00 01 00 02')],
      ['another’s exception', closed('12 83 02')],
      ['a damaged answer', '12 03 06 11 03 00 6B 00 03 00 00'],
      ['another protocol', closed('01 E2 23 03 C0 00 02')],
      ['noise', '11 03 00'],
      ['what begins like a long frame', '11 10 00 01 00 7B F6'],
      ['a cut broadcast', '00 10 00 01 00 7B F6']
    ]
    for (const [name, frame] of others) {
      const { hear, answers } = bench()
      assert.deepStrictEqual(answers(hear(Buffer.concat([bytes(frame), READ]))), [ZERO], name)
    }
  })

  it('is not addressed by others’ data, nor by its own number in an answer', () => {
    const { station, hear, answers } = bench()
    // a whole broadcast write inside the data of another's answer
    const inside = framed(...bytes('00 06 00 07 12 34'))
    assert.deepStrictEqual(answers(hear(framed(0x12, 3, 8, ...inside))), [])
    const damaged = framed(0x12, 3, 8, ...inside)
    damaged[12] ^= 1
    assert.deepStrictEqual(answers(hear(damaged)), [])
    assert.deepStrictEqual(answers(hear(Buffer.concat([bytes('12 03 02'), inside]))), [])
    // a whole query of its own in there: what follows without a pause is the only one
    assert.deepStrictEqual(answers(hear(Buffer.concat([framed(0x12, 3, 8, ...READ), READ]))), [ZERO])
    assert.deepStrictEqual(answers(hear(framed(...bytes('11 83 02')))), [])
    assert.deepStrictEqual(answers(hear(framed(...bytes('11 03 04 00 00 00 00')))), [])
    assert.strictEqual(station.writes.size, 0)
  })

  it('bounds what it holds', () => {
    const { station } = bench()
    for (let n = 0; n < 100; n++) station.receive(Buffer.alloc(100, 0x12), { start: n, end: n + 1 })
    assert.ok(station.counts.strayBytes > 9000)
  })
})

describe('simulated regulator: ASCII receiver', () => {
  const READ = ascii('11 03 00 6B 00 03')
  const ZERO = ascii('11 03 06 00 00 00 00 00 00')
  const speak = (settings = {}) => {
    const { hear, ...rest } = bench({ protocol: 'ascii', ...settings })
    const say = text => hear(Buffer.from(text, 'latin1')).map(job => String(job.answer()))
    return { ...rest, say, hear }
  }

  it('every single flipped bit of every character: silent, or not its query any more', () => {
    for (let bit = 0; bit < READ.length * 8; bit++) {
      const query = Buffer.from(READ)
      query[bit >> 3] ^= 1 << (bit & 7)
      const { station, say } = speak()
      assert.deepStrictEqual(say(query.toString('latin1')), [], `bit ${bit}`)
      assert.deepStrictEqual(say(READ), [ZERO], `after bit ${bit}`)
      assert.strictEqual(station.counts.executed, 1)
    }
  })

  it('takes a frame in any pieces, with up to 1 s between them', () => {
    for (let cut = 1; cut < READ.length; cut++) {
      const after = pause => {
        const { station } = speak()
        station.receive(Buffer.from(READ.slice(0, cut)), { start: 0, end: 10 })
        return station.receive(Buffer.from(READ.slice(cut)), { start: 10 + pause, end: 20 + pause }).length
      }
      assert.deepStrictEqual([after(999), after(1001)], [1, 0], `cut at ${cut}`)
    }
  })

  it('a colon begins anew; what stands outside is dropped', () => {
    for (const noise of [':11030', '\r\n', 'x:', '\x00\xff', ':1103\r\n', READ.slice(0, -1)]) {
      assert.deepStrictEqual(speak().say(noise + READ), [ZERO], JSON.stringify(noise))
    }
  })

  it('is strict: capital digits, whole bytes, CR LF', () => {
    const { say } = speak()
    const small = READ.toLowerCase()
    assert.notStrictEqual(small, READ)
    for (const text of [small, READ.replace('\r', ''), READ.replace(':1', ':'), ':\r\n', ':11\r\n']) {
      assert.deepStrictEqual(say(text), [], JSON.stringify(text))
    }
  })

  it('exceptions and broadcasts as in RTU', () => {
    const { station, say } = speak()
    assert.deepStrictEqual(say(ascii('11 03 00 00 00 7E')), [ascii('11 83 03')])
    assert.deepStrictEqual(say(ascii('11 2B 0E 01')), [ascii('11 AB 01')])
    const [job] = speak().hear(Buffer.from(ascii('00 06 00 07 12 34')))
    assert.strictEqual(job.answer(), null)
    assert.deepStrictEqual(say(ascii('12 03 00 00 00 01')), [])
    assert.strictEqual(station.counts.foreign, 1)
  })

  it('bounds what it holds', () => {
    const { station } = speak()
    for (let n = 0; n < 100; n++) station.receive(Buffer.alloc(100, 0x31), { start: n, end: n + 1 })
    assert.ok(station.counts.strayBytes > 9000)
  })
})
