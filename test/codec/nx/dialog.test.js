'use strict'
const assert = require('node:assert/strict')
const { readDialog, writeDialog } = require('../../../lib/codec/nx/dialog')
const { masterIds } = require('../../../lib/codec/nx/ids')
const { frame, hex, show } = require('../support/oracle')
const { play } = require('../support/receiver')
const { EXCHANGES, QA, RR } = require('../../vectors/nx')

const WORDS = { ask: 'readWords', base: 0xc0, count: 2 }
const BIT = { ask: 'readBits', base: 0x1bfc, count: 1 }
const WRITE = { ask: 'writeWords', base: 0x140, values: [0x1234] }
const R4 = 'E2 01 83 04 34 12 CD AB 8A 73'
const LOST = ['TIMEOUT', { sent: true }]
const CUT = ['INCOMPLETE', { got: 7, expected: 10, sent: true }]
const ERROR_CODES = [
  'PLC_WRONG_FUNCTION',
  'PLC_OUT_OF_RANGE',
  'PLC_WRONG_FRAME',
  'PLC_NOT_PERFORMED',
  'PLC_FRAME_TOO_LONG'
]

/** The first ID is E2h, then E3h … */
const fresh = options => ({ station: 1, ids: masterIds(), ...options })
const read = (script, options, query = WORDS) => play(readDialog(query, fresh(options)), script)
const write = (script, options, query = WRITE) => play(writeDialog(query, fresh(options)), script)
const sent = ({ steps }) => steps.map(step => show(step.send))
const answer = (master, fn, info) => frame([master, 1, fn], info)
const WORDS_INFO = [0x34, 0x12, 0xcd, 0xab]
const error = (number, fn = 0x83, master = 0xe2) => answer(master, fn, [number])

describe('NX conversation: as the manual draws it', () => {
  for (const { name, steps, query, q, values, r } of EXCHANGES.filter(each => each.r)) {
    it(name, () => {
      const dialog = query.ask.startsWith('read') ? readDialog : writeDialog
      const script = steps === 4 ? [hex(QA), hex(r)] : [hex(r)]
      const { steps: asked, result } = play(dialog(query, fresh({ steps })), script)
      assert.deepEqual(sent({ steps: asked }), steps === 4 ? [show(hex(q)), RR] : [show(hex(q))])
      assert.deepEqual(result, {
        values,
        attempts: 1,
        nonStandard: false,
        repeated: false,
        master: 0xe2,
        seenStation: 1
      })
    })
  }

  it('waits 3 s and keeps 10 ms before a Q and an RR, both settable, before an RR at least 5 ms', () => {
    const times = options =>
      read([hex(QA), hex(R4)], { steps: 4, ...options }).steps.map(step => [step.gap, step.timeout])
    assert.deepEqual(times(), [
      [10, 3000],
      [10, 3000]
    ])
    assert.deepEqual(times({ gap: 0, timeout: 200 }), [
      [0, 200],
      [5, 200]
    ])
    assert.deepEqual(times({ gap: 50 }), [
      [50, 3000],
      [50, 3000]
    ])
  })
})

describe('NX conversation: reads are repeated', () => {
  const second = answer(0xe3, 0xa3, WORDS_INFO)

  it('a missing, cut, damaged or senseless answer: the Q again, under a new ID', () => {
    const damaged = hex('E2 01 A3 04 34 12 CD AB 8D 12')
    for (const failure of [LOST, CUT, damaged]) {
      const got = read([failure, second])
      assert.deepEqual(sent(got), ['01 E2 23 03 C0 00 02 58 3C', show(frame([1, 0xe3, 0x23], [0xc0, 0, 2]))])
      assert.deepEqual([got.result.values, got.result.attempts, got.result.master], [[0x1234, 0xabcd], 2, 0xe3])
    }
  })

  it('an answer to the former ID is not taken', () => {
    const got = read([LOST, answer(0xe2, 0xa3, WORDS_INFO), answer(0xe4, 0xa3, WORDS_INFO)])
    assert.deepEqual([got.steps.length, got.result.master], [3, 0xe4])
  })

  it('the only ID there is may be the awaited one and a late one: its answer is taken', () => {
    const ids = { take: () => 0xe2, ok() {}, failed() {}, resting: () => [0xe2] }
    assert.equal(read([answer(0xe2, 0xa3, WORDS_INFO)], { ids }).result.attempts, 1)
  })

  it('nor is a frame inside a late answer to the former ID', () => {
    const inside = answer(0xe3, 0xa3, WORDS_INFO)
    const late = answer(0xe2, 0xa3, [...inside, 0, 0])
    assert.deepEqual(read([LOST, Buffer.concat([late, answer(0xe3, 0xa3, [1, 0, 2, 0])])]).result.values, [1, 2])
  })

  it('three tries in all, then the last failure', () => {
    const got = read([LOST, CUT, LOST])
    assert.deepEqual([got.error.code, got.steps.length], ['TIMEOUT', 3])
    assert.equal(read([LOST], { attempts: 1 }).error.code, 'TIMEOUT')
  })

  it('what failed rests, what ended with an answer does not', () => {
    const ids = masterIds()
    read([LOST, error(2, 0x83, 0xe3)], { ids })
    assert.deepEqual(ids.resting(), [0xe2])
    const dialog = readDialog(WORDS, fresh({ ids }))
    dialog.next()
    dialog.return()
    assert.deepEqual(ids.resting(), [0xe2, 0xe4], 'closed in the middle')
  })

  it('a failure of the line ends it', () => {
    for (const code of ['LINE_CLOSED', 'LINE_DOWN', 'PORT_GONE', 'LINE_JAMMED']) {
      assert.equal(read([[code, { sent: false }]]).error.code, code)
    }
  })

  it('a bit that is neither FF nor 00 is no value', () => {
    const bad = answer(0xe2, 0xa1, [0x07])
    const got = read([bad, answer(0xe3, 0xa1, [0xff])], {}, BIT)
    assert.deepEqual([got.result.values, got.result.attempts], [[true], 2])
    assert.equal(read([bad], { attempts: 1 }, BIT).error.code, 'BAD_ANSWER')
    const eight = { ask: 'readBits', base: 0, count: 8 }
    assert.equal(
      read([answer(0xe2, 0xa1, [255, 0, 255, 0, 255, 0, 255, 1])], { attempts: 1 }, eight).error.code,
      'BAD_ANSWER'
    )
  })

  it('the answer to one bit with 1 to 5 in it is an error, not a value', () => {
    assert.equal(read([answer(0xe2, 0xa1, [2])], {}, BIT).error.code, 'PLC_OUT_OF_RANGE')
  })

  it('errors of the PLC end it at once, but for "did not perform"', () => {
    for (const [i, code] of ERROR_CODES.entries()) {
      for (const fn of [0x83, 0xa3, 0x80, 0xa0]) {
        const got = read([error(i + 1, fn)], { attempts: 1 })
        assert.deepEqual([got.error.code, got.error.details.station], [code, 1])
        if (code !== 'PLC_NOT_PERFORMED') assert.equal(read([error(i + 1, fn)]).steps.length, 1)
      }
    }
    assert.deepEqual(read([error(4), second]).result.values, [0x1234, 0xabcd])
    assert.match(read([error(2)]).error.message, /word address 00C0h/)
    assert.equal(read([answer(0xe2, 0x00, [0])]).error.code, 'PLC_NO_SERVICE')
  })
})

describe('NX conversation: reads in 4-step', () => {
  const four = script => read(script, { steps: 4 })
  const qa = master => answer(master, 0x80, [0])

  it('QA missing or damaged: the Q again', () => {
    const got = four([LOST, qa(0xe3), answer(0xe3, 0x83, WORDS_INFO)])
    assert.deepEqual(
      got.steps.map(step => [step.send[1], step.send[2]]),
      [
        [0xe2, 3],
        [0xe3, 3],
        [0xe3, 0]
      ]
    )
    assert.equal(got.result.attempts, 2)
  })

  it('R missing or damaged: the RR again under the same ID, not the Q', () => {
    const got = four([hex(QA), LOST, hex('E2 01 83 04 34 12 CD AB 8A 72'), hex(R4)])
    assert.deepEqual(
      got.steps.map(step => step.send[2]),
      [3, 0, 0, 0]
    )
    assert.ok(got.steps.every(step => step.send[1] === 0xe2))
    assert.deepEqual([got.result.values, got.result.attempts], [[0x1234, 0xabcd], 3])
  })

  it('three tries in all, of Q and RR together', () => {
    const got = four([LOST, qa(0xe3), LOST, LOST])
    assert.deepEqual(
      got.steps.map(step => step.send[2]),
      [3, 3, 0, 0]
    )
    assert.equal(got.error.code, 'TIMEOUT')
  })

  it('an error in place of QA or of R', () => {
    assert.equal(four([error(2)]).error.code, 'PLC_OUT_OF_RANGE')
    assert.equal(four([hex(QA), error(2)]).error.code, 'PLC_OUT_OF_RANGE')
  })
})

describe('NX conversation: writes are never repeated', () => {
  const unknown = (got, cause, steps) => {
    assert.deepEqual([got.error.code, got.error.cause.code, got.steps.length], ['WRITE_UNKNOWN', cause, steps])
    assert.equal(got.error.details.reason, cause)
  }

  it('no, a cut, a damaged or a senseless answer: outcome unknown', () => {
    unknown(write([LOST]), 'TIMEOUT', 1)
    unknown(write([CUT]), 'INCOMPLETE', 1)
    unknown(write([hex('E2 01 A4 01 00 9D 98')]), 'CRC_ERROR', 1)
    unknown(write([answer(0xe2, 0xa4, [7])]), 'BAD_ANSWER', 1)
    unknown(write([LOST], { attempts: 3 }), 'TIMEOUT', 1)
  })

  it('in 4-step no QA, or no R', () => {
    unknown(write([LOST], { steps: 4 }), 'TIMEOUT', 1)
    unknown(write([hex(QA), LOST], { steps: 4, attempts: 3 }), 'TIMEOUT', 2)
    unknown(write([hex(QA), ['LINE_DOWN', { sent: false }]], { steps: 4 }), 'LINE_DOWN', 2)
  })

  it('the line failed while it was out', () => {
    unknown(write([['PORT_GONE']]), 'PORT_GONE', 1)
    unknown(write([['PORT_GONE', { sent: true }]]), 'PORT_GONE', 1)
  })

  it('never went out: the failure itself', () => {
    assert.equal(write([['LINE_JAMMED', { sent: false }]]).error.code, 'LINE_JAMMED')
    assert.equal(write([['DEADLINE', { sent: false }]]).error.code, 'DEADLINE')
  })

  it('an error of the PLC is a refusal', () => {
    for (const [i, code] of ERROR_CODES.entries()) {
      assert.equal(write([error(i + 1, 0x84)]).error.code, code)
      assert.equal(write([hex(QA), error(i + 1, 0x84)], { steps: 4 }).error.code, code)
    }
    assert.equal(write([answer(0xe2, 0x00, [0])]).error.code, 'PLC_NO_SERVICE')
  })

  it('is not confirmed by what its own echo holds', () => {
    const ack = answer(0xe2, 0xa4, [0])
    const values = [0, 2, 4].map(i => ack.readUInt16LE(i)).concat(ack[6])
    const echo = frame([1, 0xe2, 0x24], [0x40, 0x01, ...ack, 0])
    unknown(write([echo], {}, { ask: 'writeWords', base: 0x140, values }), 'TIMEOUT', 1)
  })

  it('says what was written', () => {
    assert.match(write([LOST]).error.message, /word 0140h/)
    assert.equal(write([LOST]).error.details.item, 'word 0140h')
    const bits = { ask: 'writeBits', base: 0x1bfc, values: [true, false, true] }
    assert.equal(write([LOST], {}, bits).error.details.item, 'bit 1BFCh and 2 more')
    assert.match(write([LOST], { item: 'setpoint' }).error.message, /setpoint/)
    const mixed = {
      ask: 'writeMixed',
      writes: [
        { kind: 'bit', address: 0x1bfc, value: true },
        { kind: 'word', address: 1, value: 2 }
      ]
    }
    assert.match(write([LOST], {}, mixed).error.message, /bit 1BFCh and 1 more/)
  })

  it('the acknowledgement $A2 counts only where it is allowed', () => {
    const printed = answer(0xe2, 0xa2, [0])
    const got = write([printed], { nonStandardAck: true })
    assert.deepEqual([got.result.values, got.result.nonStandard], [true, true])
    unknown(write([printed]), 'TIMEOUT', 1)
    assert.equal(write([answer(0xe2, 0xa4, [0])], { nonStandardAck: true }).result.nonStandard, false)
    const bits = { ask: 'writeBits', base: 1, values: [true] }
    assert.equal(
      write([printed], { nonStandardAck: true }, bits).result.nonStandard,
      false,
      'it is the right one for bits'
    )
  })
})

describe('NX conversation: repeat by an RR alone', () => {
  it('sends the RR under the ID of the query, in both modes', () => {
    for (const [steps, fn] of [
      [2, 0xa3],
      [4, 0x83]
    ]) {
      const got = read([answer(0xe9, fn, WORDS_INFO)], { again: 0xe9, steps })
      assert.deepEqual(sent(got), [show(frame([1, 0xe9, 0], [0]))])
      assert.deepEqual([got.result.values, got.result.repeated, got.result.master], [[0x1234, 0xabcd], true, 0xe9])
    }
  })

  it('whatever else comes, a Q follows', () => {
    const failures = [LOST, CUT, error(1, 0x83, 0xe9), answer(0xe9, 0xa3, [1, 2]), answer(0xe2, 0xa3, WORDS_INFO)]
    for (const failure of failures) {
      const got = read([failure, answer(0xe2, 0xa3, WORDS_INFO)], { again: 0xe9, attempts: 1 })
      assert.deepEqual(
        got.steps.map(step => step.send[2]),
        [0, 0x23]
      )
      assert.deepEqual([got.result.repeated, got.result.master, got.result.attempts], [false, 0xe2, 2])
    }
  })

  it('a repeat that failed takes no try from the Q', () => {
    const got = read([LOST, LOST, LOST, LOST], { again: 0xe9 })
    assert.deepEqual(
      got.steps.map(step => step.send[2]),
      [0, 0x23, 0x23, 0x23]
    )
  })

  it('the ID of a repeat that was answered, or refused, does not rest; one that the line gave up does', () => {
    const ids = masterIds()
    read([answer(0xe9, 0xa3, WORDS_INFO)], { again: 0xe9, ids })
    read([error(2, 0x83, 0xe9), answer(0xe2, 0xa3, WORDS_INFO)], { again: 0xe9, ids })
    assert.deepEqual(ids.resting(), [])
    const dialog = readDialog(WORDS, fresh({ again: 0xe9, ids }))
    dialog.next()
    dialog.return()
    assert.deepEqual(ids.resting(), [0xe9])
  })

  it('the ID of a repeat that failed rests', () => {
    const ids = masterIds()
    read([LOST, answer(0xe2, 0xa3, WORDS_INFO)], { again: 0xe9, ids })
    assert.deepEqual(ids.resting(), [0xe9])
  })

  it('a failure of the line ends it', () => {
    assert.equal(read([['LINE_CLOSED']], { again: 0xe9 }).error.code, 'LINE_CLOSED')
  })
})

describe('NX conversation: stations and settings', () => {
  it('station 255 reports the number that answered, and keeps to it', () => {
    const from = (id, fn, info) => frame([0xe2, id, fn], info)
    const got = read([from(7, 0x80, [0]), from(7, 0x83, WORDS_INFO)], { station: 255, steps: 4 })
    assert.deepEqual([got.result.seenStation, got.steps.map(step => step.send[0])], [7, [255, 255]])
    const other = read([from(7, 0x80, [0]), from(8, 0x83, WORDS_INFO)], { station: 255, steps: 4, attempts: 1 })
    assert.equal(other.error.code, 'TIMEOUT')
  })

  it('refuses, before anything is sent, what cannot be', () => {
    const code = (dialog, query, options) => play(dialog(query, fresh(options)), []).error.code
    for (const station of [192, 254, 256, -1, 1.5, '1', undefined, null]) {
      assert.equal(code(readDialog, WORDS, { station }), 'BAD_STATION')
      assert.equal(code(writeDialog, WRITE, { station }), 'BAD_STATION')
    }
    assert.equal(code(readDialog, WRITE), 'FUNCTION_REFUSED')
    assert.equal(code(writeDialog, WORDS), 'FUNCTION_REFUSED')
    assert.equal(code(readDialog, { ask: 'readProgram' }), 'FUNCTION_REFUSED')
    assert.equal(code(readDialog, { ...WORDS, count: 300 }), 'BAD_COUNT')
    assert.equal(code(writeDialog, { ...WRITE, values: [70000] }), 'BAD_VALUE')
    const details = (dialog, query, options) => play(dialog(query, fresh(options)), []).error.details
    assert.deepEqual(details(readDialog, WRITE), { function: 'writeWords as a read' })
    assert.deepEqual(details(writeDialog, WORDS), { function: 'readWords as a write' })
    const reason = 'it must be 0 to 191, or 255 for the only PLC of the line'
    assert.deepEqual(details(readDialog, WORDS, { station: 192 }), { station: 192, reason })
    const same = { station: 5, ids: masterIds({ ids: [5] }) }
    assert.deepEqual(details(readDialog, WORDS, same), { id: 5, reason: 'the station has this number' })
    for (const station of [0, 191]) {
      const { value } = readDialog(WORDS, fresh({ station })).next()
      assert.equal(value.send[0], station)
    }
    assert.equal(code(readDialog, WORDS, same), 'BAD_MASTER_ID')
    assert.equal(code(writeDialog, WRITE, same), 'BAD_MASTER_ID')
  })

  it('has its own IDs, from E2h on, and takes an allocator that knows no resting ones', () => {
    const { value } = readDialog(WORDS, { station: 1 }).next()
    assert.equal(show(value.send), '01 E2 23 03 C0 00 02 58 3C')
    const ids = { take: () => 0xe5, ok() {}, failed() {} }
    assert.equal(readDialog(WORDS, { station: 1, ids }).next().value.send[1], 0xe5)
  })

  it('a fault of the program is none of the PLC: a read passes it on, of a write it makes the outcome unknown', () => {
    const fault = new TypeError('boom')
    const reading = readDialog(WORDS, fresh())
    reading.next()
    assert.throws(() => reading.throw(fault), fault)
    const writing = writeDialog(WRITE, fresh())
    writing.next()
    assert.throws(
      () => writing.throw(fault),
      ({ code, details, cause }) => code === 'WRITE_UNKNOWN' && details.reason === 'boom' && cause === fault
    )
  })

  it('the facts are known also after a failure', () => {
    const facts = {}
    read([LOST, LOST, LOST], { facts })
    assert.deepEqual(facts, { attempts: 3, nonStandard: false, repeated: false, master: 0xe4 })
  })

  it('facts that were used before begin anew', () => {
    const facts = { attempts: 7, nonStandard: true, repeated: true, master: 0xe9, seenStation: 5 }
    read([LOST, LOST, LOST], { facts })
    assert.deepEqual(facts, { attempts: 3, nonStandard: false, repeated: false, master: 0xe4 })
  })

  it('the same query to another station, in other steps, from another ID, with other limits has its own bytes', () => {
    const query = { ...WORDS }
    const bytes = options => sent(read([LOST], { attempts: 1, ...options }, query))
    const first = { station: 1, steps: 2 }
    const expected = [
      [first, show(frame([1, 0xe2, 0x23], [0xc0, 0, 2]))],
      [first, show(frame([1, 0xe2, 0x23], [0xc0, 0, 2]))],
      [{ ...first, station: 2 }, show(frame([2, 0xe2, 0x23], [0xc0, 0, 2]))],
      [{ ...first, steps: 4 }, show(frame([1, 0xe2, 0x03], [0xc0, 0, 2]))],
      [{ ...first, ids: masterIds({ ids: [0xe5] }) }, show(frame([1, 0xe5, 0x23], [0xc0, 0, 2]))],
      [first, show(frame([1, 0xe2, 0x23], [0xc0, 0, 2]))]
    ]
    for (const [options, shown] of expected) assert.deepEqual(bytes(options), [shown], JSON.stringify(options))
    const strict = { ...first, limits: { readWords: 1, info: 256 } }
    assert.equal(read([], strict, query).error.code, 'BAD_COUNT')
  })
})
