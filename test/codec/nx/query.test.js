'use strict'
const assert = require('node:assert/strict')
const fc = require('fast-check')
const { encodeQuery, encodeResponseRequest, decodeQuery, isRepeatable } = require('../../../lib/codec/nx/query')
const {
  encodeAnswer,
  encodeAcknowledge,
  encodeError,
  encodeNoService,
  readAnswer
} = require('../../../lib/codec/nx/answer')
const { decodeFrame } = require('../../../lib/codec/nx/frame')
const { limitsOf } = require('../../../lib/codec/nx/limits')
const { frame, hex, show } = require('../support/oracle')
const { EXCHANGES, QA, RR, ERROR_2 } = require('../../vectors/nx')

const ends = { station: 1, master: 0xe2 }
const codeOf = call => {
  try {
    call()
  } catch (error) {
    return error.code ?? error
  }
  return 'sent'
}

describe('NX queries and answers: the vectors', () => {
  for (const { name, steps, query, q, values, r, station = 1, master = 0xe2 } of EXCHANGES) {
    it(name, () => {
      assert.equal(show(encodeQuery(query, { station, master, steps })), show(hex(q)))
      assert.deepEqual(decodeQuery(decodeFrame(hex(q))), { query, steps })
      if (!r) return
      assert.equal(show(encodeAnswer(query, values, { station, master, steps })), show(hex(r)))
      const phase = steps === 4 ? 'request' : 'query'
      assert.deepEqual(readAnswer(decodeFrame(hex(r)), query, { steps, phase }), { values, nonStandard: false })
    })
  }

  it('QA, RR, errors', () => {
    assert.equal(show(encodeAcknowledge(ends)), QA)
    assert.equal(show(encodeResponseRequest(ends)), RR)
    assert.deepEqual(decodeQuery(decodeFrame(hex(RR))), { responseRequest: true })
    assert.equal(show(encodeError(2, { ...ends, fn: 0x23 })), ERROR_2[0])
    assert.equal(show(encodeError(2, { ...ends, fn: 0x23, printed: false })), ERROR_2[1])
    assert.equal(show(encodeError(2, { ...ends, fn: 0x03, printed: false })), ERROR_2[0])
    assert.equal(show(encodeNoService(ends)), show(frame([0xe2, 1, 0], [0])))
  })
})

// the oracle: each function's INFO by hand from the manual's figures
const oracle = {
  readBits: ({ base, count }) => [base % 256, base >> 8, count],
  readWords: ({ base, count }) => [base % 256, base >> 8, count],
  writeBits: ({ base, values }) => [base % 256, base >> 8, ...values.map(value => (value ? 255 : 0))],
  writeWords: ({ base, values }) => [base % 256, base >> 8, ...values.map(value => [value % 256, value >> 8]).flat()],
  readMixed: ({ addresses }) =>
    addresses.map(at => [at.address % 256, (at.address >> 8) + (at.kind === 'word' ? 64 : 0)]).flat(),
  writeMixed: ({ writes }) =>
    writes
      .map(({ kind, address, value }) =>
        kind === 'word'
          ? [address % 256, (address >> 8) + 64, value % 256, value >> 8]
          : [address % 256, address >> 8, value ? 255 : 0]
      )
      .flat()
}
const CODE = { readBits: 1, writeBits: 2, readWords: 3, writeWords: 4, readMixed: 5, writeMixed: 6 }

const record = model => fc.record(model, { noNullPrototype: true })
const kind = fc.constantFrom('bit', 'word')
const place = record({ kind, address: fc.nat(0x3fff) })
const withValue = place.chain(at =>
  record({
    kind: fc.constant(at.kind),
    address: fc.constant(at.address),
    value: at.kind === 'bit' ? fc.boolean() : fc.nat(0xffff)
  })
)
const list = (of, maxLength) => fc.array(of, { minLength: 1, maxLength, size: 'max' })
const anyQuery = fc.oneof(
  record({ ask: fc.constant('readBits'), base: fc.nat(0xff00), count: fc.integer({ min: 1, max: 255 }) }),
  record({ ask: fc.constant('readWords'), base: fc.nat(0xff00), count: fc.integer({ min: 1, max: 128 }) }),
  record({ ask: fc.constant('writeBits'), base: fc.nat(0xff00), values: list(fc.boolean(), 254) }),
  record({ ask: fc.constant('writeWords'), base: fc.nat(0xff00), values: list(fc.nat(0xffff), 127) }),
  record({ ask: fc.constant('readMixed'), addresses: list(place, 128) }),
  record({ ask: fc.constant('writeMixed'), writes: list(withValue, 64) })
)
const limits = limitsOf({ writeWords: 127 })

describe('NX queries and answers: any', () => {
  it('a query has the bytes of the oracle, and is read back', () => {
    fc.assert(
      fc.property(anyQuery, fc.constantFrom(2, 4), fc.nat(191), (query, steps, station) => {
        const bytes = encodeQuery(query, { station, master: 0xe5, steps, limits })
        const fn = CODE[query.ask] + (steps === 2 ? 0x20 : 0)
        assert.equal(show(bytes), show(frame([station, 0xe5, fn], oracle[query.ask](query))))
        assert.deepEqual(decodeQuery(decodeFrame(bytes)), { query, steps })
        assert.equal(isRepeatable(query), query.ask.startsWith('read'))
      })
    )
  })

  it('an answer made by the oracle gives the values', () => {
    const reads = anyQuery.filter(query => query.ask.startsWith('read'))
    fc.assert(
      fc.property(reads, fc.constantFrom(2, 4), fc.infiniteStream(fc.nat(0xffff)), (query, steps, stream) => {
        const kinds =
          query.addresses?.map(at => at.kind) ?? new Array(query.count).fill(query.ask === 'readBits' ? 'bit' : 'word')
        const values = kinds.map(each => (each === 'bit' ? stream.next().value % 2 === 1 : stream.next().value))
        const info = values.flatMap(value =>
          typeof value === 'boolean' ? [value ? 255 : 0] : [value % 256, value >> 8]
        )
        const bytes = frame([0xe2, 1, CODE[query.ask] + (steps === 2 ? 0xa0 : 0x80)], info)
        assert.deepEqual(readAnswer(decodeFrame(bytes), query, { steps, phase: 'request' }).values, values)
        assert.equal(show(encodeAnswer(query, values, { ...ends, steps })), show(bytes))
      })
    )
  })

  it('any frame is understood or has an error number', () => {
    const header = fc.oneof(fc.constantFrom(1, 2, 3, 4, 5, 6, 0x21, 0x22, 0x23, 0x24, 0x25, 0x26), fc.nat(255))
    fc.assert(
      fc.property(header, fc.uint8Array({ minLength: 1, maxLength: 256 }), (fn, info) => {
        const got = decodeQuery({ to: 1, from: 0xe2, fn, info: Buffer.from(info) })
        assert.ok(got.query || got.responseRequest || got.error === 1 || got.error === 3)
      })
    )
  })
})

describe('NX queries: the PLC side refuses', () => {
  const answer = (fn, info) => decodeQuery({ to: 1, from: 0xe2, fn, info: Buffer.from(info) }).error
  it('functions unknown or without description: error 1', () => {
    for (const fn of [0x27, 0x07, 0x20, 0x10, 0x2f, 0x30, 0x80, 0xa3, 0xff]) assert.equal(answer(fn, [0, 0, 1]), 1)
  })
  it('INFO that makes no sense: error 3', () => {
    assert.equal(answer(0x00, [1]), 3)
    assert.equal(answer(0x00, [0, 0]), 3)
    assert.equal(answer(0x22, [0, 0, 255, 1]), 3, 'one bit of two is none')
    assert.equal(answer(0x25, [0, 0, 0, 0x80]), 3, 'one place of two is none')
    assert.equal(answer(0x26, [0, 0, 255, 0]), 3, 'half an address follows')
    assert.equal(answer(0x26, [0, 0, 255, 0, 0]), 3, 'an address without a value follows')
    assert.equal(answer(0x23, [0, 0]), 3)
    assert.equal(answer(0x23, [0, 0, 1, 0]), 3)
    assert.equal(answer(0x22, [0, 0]), 3)
    assert.equal(answer(0x22, [0, 0, 1]), 3)
    assert.equal(answer(0x24, [0, 0]), 3)
    assert.equal(answer(0x24, [0, 0, 1]), 3)
    assert.equal(answer(0x25, [0, 0, 1]), 3)
    assert.equal(answer(0x25, [0, 0x80]), 3)
    assert.equal(answer(0x26, [0, 0]), 3)
    assert.equal(answer(0x26, [0, 0, 1]), 3)
    assert.equal(answer(0x26, [0, 0x40, 1]), 3)
    assert.equal(answer(0x26, [0, 0xc0, 1, 0]), 3)
  })
})

describe('NX answers: what they say', () => {
  const MIXED = { ask: 'readMixed', addresses: [{ kind: 'word', address: 0x1bf }] }
  const MIXED_WRITE = { ask: 'writeMixed', writes: [{ kind: 'bit', address: 0x1bfc, value: true }] }
  const read = (query, fn, info) => () => readAnswer({ to: 0xe2, from: 1, fn, info: Buffer.from(info) }, query)

  it('an error names the kind and the first address of the query', () => {
    const cases = [
      [{ ask: 'readBits', base: 0x1bfc, count: 9 }, 'bit address 1BFCh'],
      [{ ask: 'writeBits', base: 0x1bfc, values: [true] }, 'bit address 1BFCh'],
      [{ ask: 'readWords', base: 0x1bf, count: 9 }, 'word address 01BFh'],
      [{ ask: 'writeWords', base: 0x1bf, values: [1] }, 'word address 01BFh'],
      [MIXED, 'first address 01BFh'],
      [MIXED_WRITE, 'first address 1BFCh']
    ]
    for (const [query, address] of cases) {
      const details = { station: 1, address, ask: query.ask }
      assert.throws(read(query, 0xa0, [2]), { code: 'PLC_OUT_OF_RANGE', details })
    }
  })

  it('what is no answer to the query is none', () => {
    const words = { ask: 'readWords', base: 0, count: 2 }
    const wrong = [
      [0xa4, [1, 2, 3, 4]],
      [0xa3, [1, 2, 3]],
      [0xa3, [1, 2, 3, 4, 5]],
      [0x83, [6]]
    ]
    for (const [fn, info] of wrong) assert.throws(read(words, fn, info), { code: 'BAD_ANSWER' })
    assert.throws(read(words, 0x0a, [1, 2, 3]), error => /function 0A with 3 bytes/.test(error.message))
    assert.throws(read(words, 0x00, [0]), { code: 'PLC_NO_SERVICE', details: { station: 1 } })
  })

  it('the PLC side: as many values as were asked for, and no more than a frame holds', () => {
    const words = count => ({ ask: 'readWords', base: 0, count })
    const made = (query, values) => encodeAnswer(query, values, ends)
    for (const values of [[1], [1, 2, 3], true]) {
      const details = { count: values === true ? 0 : values.length, unit: 'values', least: 2, most: 2 }
      assert.throws(
        () => made(words(2), values),
        error =>
          error.code === 'BAD_COUNT' && Object.entries(details).every(([name, value]) => error.details[name] === value)
      )
    }
    assert.equal(made(words(128), new Array(128).fill(7)).length, 262)
    assert.throws(() => made(words(129), new Array(129).fill(7)), {
      code: 'FRAME_TOO_LONG',
      details: { what: 'the answer', got: 258, most: 256 }
    })
  })
})

describe('NX answers: the headers that are expected', () => {
  // manual "Communication function codes": answers are Q + 80h; of the 2-step codes, Q is the 4-step one + 20h
  const listed = (query, { steps, phase, nonStandardAck }) => {
    const four = CODE[query.ask]
    const [code, printed] = steps === 2 ? [0xa0 + four, 0xa2] : [0x80 + four, 0x82]
    const [words, bits] = [query.ask === 'readWords', query.ask === 'readBits']
    const length = words ? query.count * 2 : bits ? query.count : 1
    const repeatable = words || bits
    const rows = []
    if (steps === 4 && phase === 'query') rows.push(['acknowledge', 0x80, 1])
    else {
      rows.push(['values', code, length])
      if (nonStandardAck && !repeatable && code !== printed) rows.push(['nonStandard', printed, 1])
    }
    for (const fn of new Set([0x80 + four, 0xa0 + four, 0x80, 0xa0])) rows.push(['error', fn, 1])
    return [...rows, ['noService', 0, 1]]
  }
  const modes = [2, 4].flatMap(steps =>
    ['query', 'request'].flatMap(phase => [false, true].map(nonStandardAck => ({ steps, phase, nonStandardAck })))
  )
  const queries = [
    ...Array.from({ length: 255 }, (_, i) => ({ ask: 'readBits', base: 0, count: i + 1 })),
    ...Array.from({ length: 128 }, (_, i) => ({ ask: 'readWords', base: 0, count: i + 1 })),
    { ask: 'writeBits', base: 0, values: [true] },
    { ask: 'writeWords', base: 0, values: [1] },
    { ask: 'writeMixed', writes: [{ kind: 'bit', address: 1, value: true }] }
  ]

  it('are those of the manual for each length and mode, also when they were looked up before', () => {
    // what was looked up is remembered: here by a module of its own
    const file = require.resolve('../../../lib/codec/nx/answer')
    const old = require.cache[file]
    delete require.cache[file]
    const { expectedAnswers } = require(file)
    require.cache[file] = old
    for (const round of [1, 2]) {
      for (const mode of modes) {
        for (const query of queries) {
          const got = expectedAnswers(query, mode).map(({ kind: what, fn, length }) => [what, fn, length])
          const wanted = listed(query, mode)
          if (got.join() !== wanted.join()) assert.fail(`${round} ${JSON.stringify([mode, query, got, wanted])}`)
        }
      }
    }
  })
})

describe('NX queries: limits', () => {
  const send = (query, settings) =>
    codeOf(() => encodeQuery(query, { ...ends, limits: settings && limitsOf(settings) }))
  const words = n => ({ ask: 'writeWords', base: 0, values: new Array(n).fill(0) })
  const bits = n => ({ ask: 'writeBits', base: 0, values: new Array(n).fill(false) })
  const places = (n, of = 'word') => ({ ask: 'readMixed', addresses: new Array(n).fill({ kind: of, address: 0 }) })
  const writes = (n, of) => ({
    ask: 'writeMixed',
    writes: new Array(n).fill({ kind: of, address: 0, value: of === 'bit' ? true : 7 })
  })

  it('the most of each function, and one more', () => {
    const cases = [
      [{ ask: 'readBits', base: 0, count: 255 }, 'sent'],
      [{ ask: 'readBits', base: 0, count: 256 }, 'BAD_COUNT'],
      [{ ask: 'readBits', base: 0, count: 0 }, 'BAD_COUNT'],
      [{ ask: 'readWords', base: 0, count: 128 }, 'sent'],
      [{ ask: 'readWords', base: 0, count: 129 }, 'BAD_COUNT'],
      [{ ask: 'readWords', base: 0, count: 300 }, 'BAD_COUNT'],
      [{ ask: 'readWords', base: 0, count: 0 }, 'BAD_COUNT'],
      [bits(254), 'sent'],
      [bits(255), 'BAD_COUNT'],
      [bits(0), 'BAD_COUNT'],
      [words(64), 'sent'],
      [words(65), 'BAD_COUNT'],
      [places(128), 'sent'],
      [places(129), 'BAD_COUNT'],
      [places(129, 'bit'), 'BAD_COUNT'],
      [places(0), 'BAD_COUNT'],
      [writes(85, 'bit'), 'sent'],
      [writes(86, 'bit'), 'BAD_COUNT'],
      [writes(64, 'word'), 'sent'],
      [writes(65, 'word'), 'FRAME_TOO_LONG']
    ]
    for (const [query, outcome] of cases) assert.equal(send(query), outcome, JSON.stringify(query).slice(0, 60))
    assert.equal(send(words(127), { writeWords: 127 }), 'sent')
    assert.equal(send(words(128), { writeWords: 127 }), 'BAD_COUNT')
  })

  it('a stricter CPU', () => {
    assert.equal(send(words(8), { info: 18 }), 'sent')
    assert.equal(send(words(9), { info: 18 }), 'FRAME_TOO_LONG')
    assert.equal(send({ ask: 'readWords', base: 0, count: 10 }, { info: 18 }), 'FRAME_TOO_LONG')
    assert.equal(send(places(9, 'bit'), { info: 18 }), 'sent')
    assert.equal(send(places(10, 'bit'), { info: 18 }), 'FRAME_TOO_LONG', 'the query is longer than its answer')
    assert.equal(send({ ask: 'readWords', base: 0, count: 33 }, { readWords: 32 }), 'BAD_COUNT')
    assert.equal(send({ ask: 'readWords', base: 0, count: 32 }, { readWords: '32' }), 'sent')
    assert.deepEqual(limitsOf({ readWords: undefined }), limitsOf())
    assert.deepEqual(limitsOf(/** @type {any} */ (null)), limitsOf())
    assert.equal(send(writes(4, 'word'), { info: 18 }), 'sent')
    assert.equal(send(writes(5, 'word'), { info: 18 }), 'FRAME_TOO_LONG')
    assert.equal(send(writes(6, 'bit'), { info: 18 }), 'sent')
    assert.equal(send(writes(7, 'bit'), { info: 18 }), 'FRAME_TOO_LONG')
    assert.equal(send(places(9, 'word'), { info: 18 }), 'sent')
    assert.equal(send(places(10, 'word'), { info: 18 }), 'FRAME_TOO_LONG')
    assert.deepEqual([limitsOf({ info: 3 }).info, limitsOf({ readBits: 1 }).readBits], [3, 1])
    assert.equal(limitsOf({ readBits: ' 7 ' }).readBits, 7)
    for (const readBits of ['7x', 'x7', '1e1', '0x07', '', [7], true, null]) {
      assert.throws(() => limitsOf(/** @type {any} */ ({ readBits })), { code: 'BAD_SETTING' }, String(readBits))
    }
    assert.throws(() => limitsOf({ info: 2 }), {
      details: { setting: 'limits.info', value: 2, reason: 'it must be 3 to 256' }
    })
    assert.throws(() => limitsOf({ words: 1 }), {
      details: { setting: 'limits.words', value: 1, reason: 'there is no such limit' }
    })
    for (const settings of [
      { writeWords: 128 },
      { readWords: 0 },
      { info: 257 },
      { readBits: 1.5 },
      { readBits: 'x' },
      { words: 1 }
    ]) {
      assert.throws(() => limitsOf(settings), { code: 'BAD_SETTING' })
    }
  })

  it('addresses end at FFFFh, in mixed frames at 3FFFh', () => {
    assert.equal(send({ ask: 'readWords', base: 0xffff, count: 1 }), 'sent')
    assert.equal(send({ ask: 'readWords', base: 0xffff, count: 2 }), 'BAD_ADDRESS')
    assert.equal(send({ ask: 'readBits', base: 0x10000, count: 1 }), 'BAD_ADDRESS')
    for (const base of [-1, 1.5, NaN, '1', undefined])
      assert.equal(send({ ask: 'readWords', base, count: 1 }), 'BAD_ADDRESS')
    for (const each of ['bit', 'word']) {
      assert.equal(send({ ask: 'readMixed', addresses: [{ kind: each, address: 0x3fff }] }), 'sent')
      assert.equal(send({ ask: 'readMixed', addresses: [{ kind: each, address: 0x4000 }] }), 'BAD_ADDRESS')
    }
  })

  it('a refusal says what it is about', () => {
    const row = { ask: 'readWords', base: 0x1bf, count: 1 }
    const bit = { kind: 'bit', address: 7 }
    const range = { least: 1, most: 128 }
    const cases = [
      [
        { ...row, count: 0 },
        { count: 0, unit: 'words', reason: 'there is nothing to ask for', ...range }
      ],
      [
        { ...row, count: 129 },
        { count: 129, unit: 'words', reason: 'too many for one frame', ...range }
      ],
      [
        { ...row, count: 1.5 },
        { count: 1.5, unit: 'words', reason: 'no count', ...range }
      ],
      [
        { ask: 'readMixed', addresses: 'M0' },
        { count: 'no', unit: 'addresses', reason: 'they are not given as a list', ...range }
      ],
      [
        { ...row, base: 65536 },
        { address: '65536', reason: 'the last word address is 65535' }
      ],
      [
        { ask: 'readBits', base: 0xffff, count: 2 },
        { address: '65535', reason: '2 bits from there end after the last address 65535' }
      ],
      [
        { ask: 'readBits', base: -1, count: 2 },
        { address: '-1', reason: 'the last bit address is 65535' }
      ],
      [
        { ask: 'readMixed', addresses: [{ address: 7 }] },
        { address: '7', reason: 'it must be a bit or a word' }
      ],
      [
        { ask: 'readMixed', addresses: [{ kind: 'word', address: 0x4000 }] },
        { address: '16384', reason: 'in mixed frames the last word address is 16383' }
      ],
      [
        { ask: 'writeWords', base: 0x1bf, values: [1, 70000] },
        { item: 'word 01C0h', value: '70000', reason: 'a word is a whole number from 0 to 65535' }
      ],
      [
        { ask: 'writeMixed', writes: [{ ...bit, value: 1 }] },
        { item: 'bit 0007h', value: '1', reason: 'a bit is true or false' }
      ],
      [writes(65, 'word'), { what: 'the query or its answer', got: 260, most: 256 }],
      [{ ask: 'readProgram' }, { function: 'readProgram' }]
    ]
    for (const [query, details] of cases) assert.throws(() => encodeQuery(query, ends), { details })
  })

  it('hostile queries have a code', () => {
    const circular = {}
    circular.self = circular
    const hostile = [
      [undefined, 'FUNCTION_REFUSED'],
      [null, 'FUNCTION_REFUSED'],
      [{ ask: 'deleteProgram', base: 0, count: 1 }, 'FUNCTION_REFUSED'],
      [{ ask: '__proto__' }, 'FUNCTION_REFUSED'],
      [{ ask: 'readWords', base: 0 }, 'BAD_COUNT'],
      [{ ask: 'readWords', base: 0, count: '2' }, 'BAD_COUNT'],
      [{ ask: 'readWords', base: 0, count: NaN }, 'BAD_COUNT'],
      [{ ask: 'readWords', base: 0, count: 2n }, 'BAD_COUNT'],
      [{ ask: 'readWords', base: 0, count: circular }, 'BAD_COUNT'],
      [{ ask: 'writeWords', base: 0 }, 'BAD_COUNT'],
      [{ ask: 'writeWords', base: 0, values: 'ab' }, 'BAD_COUNT'],
      [{ ask: 'writeWords', base: 0, values: { length: 1e9 } }, 'BAD_COUNT'],
      [{ ask: 'writeWords', base: 0, values: new Array(1e9) }, 'BAD_COUNT'],
      [{ ask: 'writeWords', base: 0, values: new Array(2) }, 'BAD_VALUE'],
      [{ ask: 'writeWords', base: 0, values: [65536] }, 'BAD_VALUE'],
      [{ ask: 'writeWords', base: 0, values: [-1] }, 'BAD_VALUE'],
      [{ ask: 'writeWords', base: 0, values: [1.5] }, 'BAD_VALUE'],
      [{ ask: 'writeWords', base: 0, values: [true] }, 'BAD_VALUE'],
      [{ ask: 'writeBits', base: 0, values: [1] }, 'BAD_VALUE'],
      [{ ask: 'writeBits', base: 0, values: [null] }, 'BAD_VALUE'],
      [{ ask: 'readMixed', addresses: [null] }, 'BAD_ADDRESS'],
      [{ ask: 'readMixed', addresses: [{ kind: 'byte', address: 1 }] }, 'BAD_ADDRESS'],
      [{ ask: 'readMixed', addresses: new Array(2) }, 'BAD_ADDRESS'],
      [{ ask: 'writeMixed', writes: [{ kind: 'bit', address: 1, value: 1 }] }, 'BAD_VALUE'],
      [{ ask: 'writeMixed', writes: [{ kind: 'word', address: 1, value: Symbol('x') }] }, 'BAD_VALUE']
    ]
    for (const [query, code] of hostile) assert.equal(send(query), code)
  })
})
