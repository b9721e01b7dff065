'use strict'

const assert = require('node:assert')
const { createNxPlc } = require('../../lib/sim')
const { bytes, framed, shown } = require('./support')

/** A PLC alone: feeds it queries one after the other, 100 ms apart. */
function bench(settings = {}) {
  const time = { now: 0 }
  const plc = createNxPlc({ station: 1, clock: { now: () => time.now }, ...settings })
  const ask = (query, refuse) => {
    time.now += 100
    const jobs = plc.receive(Buffer.isBuffer(query) ? query : bytes(query), { start: time.now, end: time.now + 5 })
    return jobs.map(job => job.answer(refuse)).map(answer => (answer ? shown(answer) : null))
  }
  return { plc, ask, time }
}

// the vectors of the protocol page
const RR = '01 E2 00 01 00 2E 28'
const QA = 'E2 01 80 01 00 DD 92'
const READ_M0_2 = '01 E2 23 03 C0 00 02 58 3C'
const READ_M_ALL_4 = '01 E2 03 03 C0 00 80 59 9A'
const WRITE_K0 = '01 E2 24 04 40 01 34 12 66 20'

describe('simulated NX PLC: vectors of the manual', () => {
  it('reads words', () => {
    const { plc, ask } = bench()
    plc.set('M0', 0x1234)
    plc.set('M1', 0xabcd)
    assert.deepStrictEqual(ask(READ_M0_2), ['E2 01 A3 04 34 12 CD AB 8D 13'])
  })

  it('reads words in 4-step: QA, then R for the RR', () => {
    const { plc, ask } = bench()
    plc.set('M0', 0x1234)
    plc.set('M1', 0xabcd)
    assert.deepStrictEqual(ask(framed(0x01, 0xe2, 0x03, 0x03, 0xc0, 0x00, 0x02)), [QA])
    assert.deepStrictEqual(ask(RR), ['E2 01 83 04 34 12 CD AB 8A 73'])
  })

  it('answers 128 words with LEN 0', () => {
    const { ask } = bench()
    assert.deepStrictEqual(ask(READ_M_ALL_4), [QA])
    assert.deepStrictEqual(ask(RR), [`E2 01 83 00 ${'00 '.repeat(256)}EC AB`])
  })

  it('reads and writes a bit', () => {
    const { plc, ask } = bench()
    assert.deepStrictEqual(ask('01 E2 21 03 FC 1B 01 AB 01'), ['E2 01 A1 01 00 8D 98'])
    assert.deepStrictEqual(ask('01 E2 22 03 FC 1B FF 6E 81'), ['E2 01 A2 01 00 7D 98'])
    assert.deepStrictEqual(ask('01 E2 21 03 FC 1B 01 AB 01'), ['E2 01 A1 01 FF CD D8'])
    assert.strictEqual(plc.get('K127.12'), true)
    assert.strictEqual(plc.get('K127'), 0x1000)
  })

  it('writes a word in 2-step and in 4-step', () => {
    const { plc, ask } = bench()
    assert.deepStrictEqual(ask(WRITE_K0), ['E2 01 A4 01 00 9D 99'])
    assert.strictEqual(plc.get('K0'), 0x1234)
    plc.set('K0', 0)
    assert.deepStrictEqual(ask('01 E2 04 04 40 01 34 12 61 40'), [QA])
    assert.deepStrictEqual(ask(RR), ['E2 01 84 01 00 9C 53'])
    assert.strictEqual(plc.get('K0'), 0x1234)
    assert.strictEqual(plc.writes.get('word:320'), 2)
  })

  it('writes 64 words in 4-step', () => {
    const { plc, ask } = bench()
    assert.deepStrictEqual(ask(`01 E2 04 82 40 01 ${'00 '.repeat(128)}35 FF`), [QA])
    assert.deepStrictEqual(ask(RR), ['E2 01 84 01 00 9C 53'])
    assert.strictEqual(plc.writes.size, 64)
  })

  it('reads and writes bits and words mixed', () => {
    const { plc, ask } = bench()
    assert.deepStrictEqual(ask('01 E2 26 07 FC 1B FF BF 41 78 56 A8 0D'), ['E2 01 A6 01 00 3C 59'])
    assert.strictEqual(plc.get('K127'), 0x5678)
    assert.deepStrictEqual(ask('01 E2 25 04 FC 1B BF 41 45 6B'), ['E2 01 A5 03 FF 78 56 06 8C'])
  })

  it('answers 255, also to another master, with its own number or with 255', () => {
    const query = 'FF BF 03 03 00 00 02 CB 45'
    const own = bench().ask(query)
    assert.deepStrictEqual(own, [shown(framed(0xbf, 0x01, 0x80, 0x01, 0x00))])
    const asked = bench({ answersAs: 'asked' }).ask(query)
    assert.deepStrictEqual(asked, [shown(framed(0xbf, 0xff, 0x80, 0x01, 0x00))])
  })
})

describe('simulated NX PLC: errors', () => {
  const cases = [
    ['1: unknown function $2F', [0x2f, 1, 0], 1],
    ['1: program functions, named without description', [0x27, 1, 0], 1],
    ['2: first word after M, K, F and TC', [0x23, 3, 0xd0, 0x01, 1], 2],
    ['2: a block that leaves the map', [0x23, 3, 0xff, 0x0d, 2], 2],
    ['2: bit of an area that has only words', [0x21, 3, 0x00, 0x20, 1], 2],
    ['3: read of 0 words', [0x23, 3, 0xc0, 0x00, 0], 3],
    ['3: read with two bytes of INFO', [0x23, 2, 0xc0, 0x00], 3],
    ['3: bit value 01', [0x22, 3, 0xfc, 0x1b, 0x01], 3],
    ['3: half a word', [0x24, 3, 0x40, 0x01, 0x34], 3],
    ['3: mixed read with an odd INFO', [0x25, 3, 0xfc, 0x1b, 0xbf], 3],
    ['3: mixed read with address type 1x', [0x25, 2, 0xfc, 0x9b], 3],
    ['3: mixed write whose last word is cut', [0x26, 3, 0xbf, 0x41, 0x78], 3],
    ['5: 129 words', [0x23, 3, 0xc0, 0x00, 129], 5]
  ]
  for (const [name, [fn, length, ...info], number] of cases) {
    it(String(name), () => {
      const answer = shown(framed(0xe2, 0x01, 0x80 | (fn & 15), 0x01, number))
      const { plc, ask } = bench()
      assert.deepStrictEqual(ask(framed(0x01, 0xe2, fn, length, ...info)), [answer])
      assert.deepStrictEqual([plc.counts.executed, plc.counts.errors, plc.writes.size], [0, 1, 0])
    })
  }

  it('the vector of error 2, in both forms', () => {
    const outside = framed(0x01, 0xe2, 0x23, 0x03, 0x00, 0x90, 0x01)
    assert.deepStrictEqual(bench().ask(outside), ['E2 01 83 01 02 AC 53'])
    assert.deepStrictEqual(bench({ errorForm: 'function' }).ask(outside), ['E2 01 A3 01 02 AD 99'])
  })

  it('4: in program mode, and where memory is protected; nothing is written', () => {
    const refused = [shown(framed(0xe2, 0x01, 0x84, 0x01, 4))]
    const guarded = bench({ protect: ['K0..K9'] })
    assert.deepStrictEqual(guarded.ask(WRITE_K0), refused)
    const { plc, ask } = bench()
    plc.setMode('program')
    assert.deepStrictEqual(ask(WRITE_K0), refused)
    assert.deepStrictEqual([plc.get('K0'), guarded.plc.get('K0'), plc.writes.size], [0, 0, 0])
    plc.setMode('run')
    assert.deepStrictEqual(ask(WRITE_K0), ['E2 01 A4 01 00 9D 99'])
  })

  it('5: a stricter CPU', () => {
    const { ask } = bench({ limits: { readWords: 1 } })
    assert.deepStrictEqual(ask(READ_M0_2), [shown(framed(0xe2, 0x01, 0x83, 0x01, 5))])
  })

  it('in 4-step in place of QA, or of R', () => {
    const outside = framed(0x01, 0xe2, 0x03, 0x03, 0x00, 0x90, 0x01)
    const error = 'E2 01 83 01 02 AC 53'
    assert.deepStrictEqual(bench().ask(outside), [error])
    const late = bench({ errorsAt: 'response' })
    assert.deepStrictEqual([late.ask(outside), late.ask(RR)], [[QA], [error]])
  })

  it('no service', () => {
    const { ask } = bench({ noService: true })
    assert.deepStrictEqual(ask(framed(1, 0xe2, 0x27, 1, 0)), [shown(framed(0xe2, 1, 0, 1, 0))])
  })

  it('a CPU with one of the methods alone', () => {
    assert.deepStrictEqual(bench({ steps: 4 }).ask(READ_M0_2), [shown(framed(0xe2, 1, 0x83, 1, 1))])
    assert.deepStrictEqual(bench({ steps: 2 }).ask(READ_M_ALL_4), [shown(framed(0xe2, 1, 0x83, 1, 1))])
  })

  it('acknowledges every write as the manual prints it', () => {
    const { ask } = bench({ printedAck: true })
    assert.deepStrictEqual(ask(WRITE_K0), ['E2 01 A2 01 00 7D 98'])
  })

  it('refuses bad settings', () => {
    const make = settings => () => bench(settings)
    assert.throws(make({ station: 192 }), { code: 'BAD_STATION' })
    assert.throws(make({ limits: { readWords: 500 } }), { code: 'BAD_SETTING' })
    assert.throws(make({ behaviour: [{ at: 'M0', kind: 'dance' }] }), { code: 'BAD_SETTING' })
    assert.throws(make({ behaviour: [{ at: 'X0', kind: 'counter' }] }), { code: 'UNKNOWN_AREA' })
    assert.throws(make({ behaviour: [{ at: 'M0', as: 'float64', kind: 'counter' }] }), { code: 'BAD_TYPE' })
  })
})

describe('simulated NX PLC: RR', () => {
  it('carries the last query out again, with the values of now', () => {
    const { plc, ask } = bench()
    ask(framed(1, 0xe2, 0x23, 3, 0xc0, 0, 1))
    plc.set('M0', 7)
    assert.deepStrictEqual(ask(RR), [shown(framed(0xe2, 1, 0xa3, 2, 7, 0))])
  })

  it('doubles a write: what the master must never do', () => {
    const { plc, ask } = bench()
    ask(WRITE_K0)
    assert.deepStrictEqual(ask(RR), ['E2 01 A4 01 00 9D 99'])
    assert.strictEqual(plc.writes.get('word:320'), 2)
  })

  it('is silent before the first query', () => assert.deepStrictEqual(bench().ask(RR), [null]))

  it('a 4-step write is carried out once, at the RR', () => {
    const { plc, ask } = bench()
    ask('01 E2 04 04 40 01 34 12 61 40')
    assert.strictEqual(plc.writes.size, 0)
    ask(RR)
    assert.strictEqual(plc.writes.get('word:320'), 1)
  })
})

describe('simulated NX PLC: receiver', () => {
  const answer = [shown(framed(0xe2, 1, 0xa3, 4, 0, 0, 0, 0))]

  it('is silent to every single flipped bit', () => {
    for (let bit = 0; bit < 72; bit++) {
      const query = bytes(READ_M0_2)
      query[bit >> 3] ^= 1 << (bit & 7)
      const { plc, ask } = bench()
      assert.deepStrictEqual(ask(query), [], `bit ${bit}`)
      assert.deepStrictEqual(ask(READ_M0_2), answer, `after bit ${bit}`)
      assert.strictEqual(plc.counts.executed, 1)
    }
  })

  it('takes a frame in any pieces', () => {
    const query = bytes(READ_M0_2)
    for (let cut = 1; cut < query.length; cut++) {
      const { plc } = bench()
      const first = plc.receive(query.subarray(0, cut), { start: 0, end: cut })
      const jobs = plc.receive(query.subarray(cut), { start: cut, end: 9 })
      assert.deepStrictEqual([first.length, jobs.length], [0, 1], `cut at ${cut}`)
    }
  })

  it('forgets half a frame after a silence', () => {
    const { plc, ask } = bench()
    plc.receive(bytes(READ_M0_2).subarray(0, 5), { start: 0, end: 5 })
    assert.deepStrictEqual(ask(READ_M0_2), answer)
    assert.strictEqual(plc.counts.strayBytes, 5)
  })

  it('finds a query behind noise', () => {
    // the last one looks like the head of a frame of 232 bytes
    for (const noise of ['00', 'AA 55', '01 E2 23', '00 FF 01', '01 E2 23 E2']) {
      const { ask } = bench()
      assert.deepStrictEqual(ask(Buffer.concat([bytes(noise), bytes(READ_M0_2)])), answer, noise)
    }
  })

  it('ignores other stations, answers on their way, and other masters if told so', () => {
    const { plc, ask } = bench()
    assert.deepStrictEqual(ask(framed(2, 0xe2, 0x23, 3, 0xc0, 0, 2)), [])
    assert.deepStrictEqual(ask(framed(1, 2, 0xa3, 4, 0, 0, 0, 0)), [])
    assert.deepStrictEqual(bench({ onlyMaster: 0xe3 }).ask(READ_M0_2), [])
    assert.deepStrictEqual([plc.counts.queries, plc.counts.foreign], [0, 2])
  })
})

describe('simulated NX PLC: live values', () => {
  const live = (behaviour, settings) => bench({ behaviour, ...settings })

  it('change with the clock', () => {
    const { plc, time } = live([
      { at: 'M0', kind: 'counter', every: 1000 },
      { at: 'M1.3', kind: 'toggle', period: 2000 },
      { at: 'M2', kind: 'ramp', from: 10, to: 20, period: 1000, every: 1 },
      { at: 'W0', as: 'float32', kind: 'sine', from: -1, to: 1, period: 1000, every: 1 },
      { at: 'W2', as: 'int16', kind: () => -5 }
    ])
    const at = now => {
      time.now = now
      return [plc.get('M0'), plc.get('M1.3'), plc.get('M2'), plc.get('W0', 'float32'), plc.get('W2', 'int16')]
    }
    assert.deepStrictEqual(at(0), [0, false, 10, 0, -5])
    assert.deepStrictEqual(at(1250), [1, true, 13, -1, -5])
    assert.strictEqual(at(2750)[3], 1)
  })

  it('a process follows its set value, whoever writes it', () => {
    const { plc, time, ask } = live([{ at: 'W10', as: 'float32', kind: 'follows', of: 'K10', from: 20, tau: 1000 }])
    plc.set('K10', 20)
    time.now = 5000
    assert.strictEqual(Math.round(Number(plc.get('W10', 'float32'))), 20)
    ask(framed(1, 0xe2, 0x24, 4, 0x4a, 0x01, 100, 0))
    time.now += 1000
    const after = Number(plc.get('W10', 'float32'))
    assert.ok(Math.abs(after - (100 - 80 * Math.exp(-1))) < 0.01, String(after))
  })

  it('tells what an address held between two times', () => {
    const { plc, time } = live([{ at: 'M0', kind: 'counter', every: 10 }], { history: true })
    assert.deepStrictEqual(plc.heldBetween(0xc0, 25, 45), [2, 3, 4])
    for (const [at, value] of [
      [100, 1],
      [200, 2],
      [300, 3]
    ]) {
      time.now = at
      plc.set('K0', value)
    }
    assert.deepStrictEqual(plc.heldBetween(0x140, 0, 50), [0])
    assert.deepStrictEqual(plc.heldBetween(0x140, 50, 250), [0, 1, 2])
    assert.deepStrictEqual(plc.heldBetween(0x140, 200, 299), [2])
    assert.deepStrictEqual(plc.heldBetween(0x140, 350, 400), [3])
  })
})
