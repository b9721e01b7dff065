'use strict'
const assert = require('node:assert/strict')
const fc = require('fast-check')
const {
  decodeAnswer,
  describeQuery,
  encodeAnswer,
  encodeException,
  expectedAnswer
} = require('../../../lib/codec/modbus/answer')
const { fromAscii, toAscii } = require('../../../lib/codec/modbus/ascii')
const { EXCEPTIONS, exceptionByCode, exceptionOf } = require('../../../lib/codec/modbus/exceptions')
const { FUNCTIONS, functionOf, readFunction, writeFunction } = require('../../../lib/codec/modbus/functions')
const { decodeQuery, encodeQuery } = require('../../../lib/codec/modbus/query')
const { CODES } = require('../../../lib/error')
const { closed, hex, show } = require('../support/oracle')
const { WIRES, framed } = require('./support')
const { STATION } = require('../../vectors/modbus')

const code = expected => error => error.code === expected
const word = value => [value >> 8, value & 255]

describe('MODBUS frames: the worked examples', () => {
  for (const { name, protocol, query, values, q, r } of WIRES) {
    const wire = rtu => (protocol === 'ascii' ? toAscii(rtu) : rtu)
    const rtu = bytes => (protocol === 'ascii' ? fromAscii(bytes) : bytes)

    it(`${name}: the request, both ways`, () => {
      assert.equal(show(wire(encodeQuery(query, STATION))), show(q))
      assert.deepEqual(decodeQuery(rtu(q)), { station: STATION, query })
    })

    it(`${name}: the answer, both ways`, () => {
      assert.equal(show(wire(encodeAnswer(query, STATION, values))), show(r))
      assert.deepEqual(decodeAnswer(query, rtu(r), { station: STATION }), values)
      assert.equal(expectedAnswer(query, STATION).length, rtu(r).length)
    })
  }

  it('the exception to preset registers: function 90', () => {
    const frame = closed([0x11, 0x90, 0x02])
    assert.deepEqual(encodeException(16, 17, 2), frame)
    assert.throws(() => decodeAnswer({ fn: 16, base: 1, values: [1] }, frame), code('MODBUS_ILLEGAL_ADDRESS'))
  })
})

describe('MODBUS requests', () => {
  it('any of them, byte by byte', () => {
    const base = fc.integer({ min: 0, max: 0xffff - 2000 })
    const station = fc.integer({ min: 1, max: 247 })
    fc.assert(
      fc.property(base, station, fc.integer({ min: 1, max: 2000 }), fc.constantFrom(1, 2), (at, to, count, fn) => {
        assert.deepEqual(encodeQuery({ fn, base: at, count }, to), closed([to, fn, ...word(at), ...word(count)]))
      })
    )
    fc.assert(
      fc.property(base, station, fc.array(fc.nat(0xffff), { minLength: 1, maxLength: 123 }), (at, to, values) => {
        const expected = closed([
          to,
          16,
          ...word(at),
          ...word(values.length),
          values.length * 2,
          ...values.flatMap(word)
        ])
        assert.deepEqual(encodeQuery({ fn: 16, base: at, values }, to), expected)
        assert.deepEqual(decodeQuery(expected), { station: to, query: { fn: 16, base: at, values } })
      })
    )
    fc.assert(
      fc.property(base, fc.array(fc.boolean(), { minLength: 1, maxLength: 1968 }), (at, values) => {
        // by other means: each byte out of a text of binary digits, the first coil last
        const text = values.map(Number).join('')
        const bytes = (text.match(/.{1,8}/g) ?? []).map(part => parseInt([...part].reverse().join(''), 2))
        const expected = closed([1, 15, ...word(at), ...word(values.length), bytes.length, ...bytes])
        assert.equal(show(encodeQuery({ fn: 15, base: at, values }, 1)), show(expected))
        assert.deepEqual(decodeQuery(expected), { station: 1, query: { fn: 15, base: at, values } })
      })
    )
  })

  it('off is 0000', () =>
    assert.equal(show(encodeQuery({ fn: 5, base: 1, value: false }, 1)), show(closed([1, 5, 0, 1, 0, 0]))))

  it('a write to station 0 is a broadcast', () => {
    assert.equal(encodeQuery({ fn: 6, base: 1, value: 3 }, 0)[0], 0)
    assert.throws(() => encodeQuery({ fn: 3, base: 1, count: 1 }, 0), code('BROADCAST_REFUSED'))
  })

  const limits = [
    [1, 2000],
    [2, 2000],
    [3, 125],
    [4, 125],
    [15, 1968],
    [16, 123]
  ]
  for (const [fn, most] of limits) {
    it(`function ${fn} takes ${most}, not one more, and none past the end`, () => {
      const value = fn === 15 ? true : 1
      const ask = (base, count) => (fn > 4 ? { fn, base, values: new Array(count).fill(value) } : { fn, base, count })
      assert.ok(encodeQuery(ask(0, most), 1).length <= 256)
      assert.ok(encodeQuery(ask(0x10000 - most, most), 1))
      assert.throws(() => encodeQuery(ask(0, most + 1), 1), code('BAD_COUNT'))
      assert.throws(() => encodeQuery(ask(0, 0), 1), code('BAD_COUNT'))
      assert.throws(() => encodeQuery(ask(0x10000 - most + 1, most), 1), code('BAD_ADDRESS'))
    })
  }

  const refused = [
    [{ fn: 7, base: 0, count: 1 }, 'FUNCTION_REFUSED'],
    [{ fn: 23, base: 0, count: 1 }, 'FUNCTION_REFUSED'],
    [undefined, 'FUNCTION_REFUSED'],
    [{ fn: 3, base: -1, count: 1 }, 'BAD_ADDRESS'],
    [{ fn: 3, base: 65536, count: 1 }, 'BAD_ADDRESS'],
    [{ fn: 3, base: 1.5, count: 1 }, 'BAD_ADDRESS'],
    [{ fn: 3, base: '1', count: 1 }, 'BAD_ADDRESS'],
    [{ fn: 3, base: 1, count: '1' }, 'BAD_COUNT'],
    [{ fn: 3, base: 1 }, 'BAD_COUNT'],
    [{ fn: 5, base: 1, value: 1 }, 'BAD_VALUE'],
    [{ fn: 6, base: 1, value: 65536 }, 'BAD_VALUE'],
    [{ fn: 6, base: 1, value: -1 }, 'BAD_VALUE'],
    [{ fn: 6, base: 1, value: 1.5 }, 'BAD_VALUE'],
    [{ fn: 6, base: 1, value: true }, 'BAD_VALUE'],
    [{ fn: 16, base: 1, values: [1, NaN] }, 'BAD_VALUE'],
    [{ fn: 16, base: 1, values: new Array(2) }, 'BAD_VALUE'],
    [{ fn: 16, base: 1, values: 'ab' }, 'BAD_COUNT'],
    [{ fn: 15, base: 1, values: [1] }, 'BAD_VALUE']
  ]
  refused.forEach(([query, expected], at) => {
    it(`refuses number ${at}: ${expected}`, () => assert.throws(() => encodeQuery(query, 1), code(expected)))
  })

  it('a refusal says what it is about', () => {
    const words = { unit: 'words', least: 1, most: 125 }
    const cases = [
      [{ fn: 7 }, { function: '7' }],
      [
        { fn: 3, base: 1, count: 0 },
        { count: 0, reason: 'there is nothing to ask for', ...words }
      ],
      [
        { fn: 3, base: 1, count: 126 },
        { count: 126, reason: 'too many for one frame', ...words }
      ],
      [
        { fn: 3, base: 1, count: 1.5 },
        { count: 1.5, reason: 'no count', ...words }
      ],
      [
        { fn: 15, base: 1, values: 1 },
        { count: 'no', reason: 'no count', unit: 'bits', least: 1, most: 1968 }
      ],
      [
        { fn: 3, base: 65536, count: 1 },
        { address: '65536', reason: 'the numbers on the wire are 0 to 65535' }
      ],
      [
        { fn: 3, base: 65535, count: 2 },
        { address: '65535', reason: '2 words from there end after the last number 65535' }
      ],
      [
        { fn: 1, base: 65535, count: 2 },
        { address: '65535', reason: '2 bits from there end after the last number 65535' }
      ],
      [
        { fn: 16, base: 7, values: [1, -1] },
        { item: 'wire address 8', value: '-1', reason: 'a register is a whole number from 0 to 65535' }
      ],
      [
        { fn: 5, base: 7, value: 1 },
        { item: 'wire address 7', value: '1', reason: 'a coil is true or false' }
      ]
    ]
    for (const [query, details] of cases) assert.throws(() => encodeQuery(query, 1), { details })
    const one = { fn: 3, base: 1, count: 1 }
    const reason = 'it must be 1 to 247, or 0 for a broadcast'
    assert.throws(() => encodeQuery(one, 248), { details: { station: 248, reason } })
    assert.throws(() => encodeQuery(one, 0), { details: { what: 'a read', reason: 'no station may answer it' } })
    assert.throws(() => encodeQuery({ fn: 3, base: 65536, count: 1 }, 1), code('BAD_ADDRESS'))
    assert.equal(encodeQuery(one, 247)[0], 247)
  })

  it('refuses stations that do not exist', () => {
    for (const station of [-1, 248, 255, 1.5, '1', undefined]) {
      assert.throws(() => encodeQuery({ fn: 6, base: 1, value: 1 }, station), code('BAD_STATION'))
    }
  })
})

describe('MODBUS requests, as a station reads them', () => {
  const read = body => decodeQuery(closed([...hex(body)]))

  it('what it does not know is exception 1', () => {
    for (const fn of [0, 7, 8, 0x16, 0x17, 0x2b, 0x83]) {
      assert.deepEqual(decodeQuery(closed([1, fn, 0, 0, 0, 1])), { station: 1, fn, exception: 1 })
    }
  })

  it('what makes no sense is exception 3', () => {
    const senseless = [
      '01 03 00 00 00',
      '01 03 00 00 00 01 00',
      '01 05 00 00 FF 01',
      '01 05 00 00 00 FF',
      '01 06 00 00 00 00 00',
      '01 0F 00 13 00 0A 01 CD',
      '01 0F 00 13 00 0A 02 CD',
      '01 10 00 01 00 02 04 00 0A 01',
      '01 10 00 01 00 02 03 00 0A 01',
      '01 10 00 01 00 02 06 00 0A 01 02 00 00',
      '01 10 00 01 00 02 06 00 0A 01 02',
      '01 06 00',
      '01 10 00 01'
    ]
    for (const body of senseless) assert.equal(read(body).exception, 3, body)
    assert.deepEqual(read('01 05 00 07 00 00').query, { fn: 5, base: 7, value: false })
    assert.deepEqual(read('01 06 00 07 12 34').query, { fn: 6, base: 7, value: 0x1234 })
  })

  it('counts and ends are the station’s own business', () => {
    assert.deepEqual(read('01 03 FF FF 00 FF').query, { fn: 3, base: 0xffff, count: 255 })
    assert.equal(read('01 01 00 00 00 00').query.count, 0)
  })
})

describe('MODBUS answers', () => {
  const query = { fn: 3, base: 107, count: 3 }
  const own = framed('rtu', '11 03 06 02 2B 00 00 00 64')

  it('what is wrong is no value', () => {
    const wrong = [
      ['another station', framed('rtu', '12 03 06 02 2B 00 00 00 64'), 'BAD_ANSWER'],
      ['another function', framed('rtu', '11 04 06 02 2B 00 00 00 64'), 'BAD_ANSWER'],
      ['another count', framed('rtu', '11 03 04 02 2B 00 00'), 'BAD_ANSWER'],
      ['a count that lies', framed('rtu', '11 03 06 02 2B 00 00'), 'BAD_ANSWER'],
      ['an exception of another function', framed('rtu', '11 84 02'), 'BAD_ANSWER'],
      ['too long an exception', framed('rtu', '11 83 02 00'), 'BAD_ANSWER'],
      ['a wrong checksum', Buffer.from([...own.subarray(0, -1), 0]), 'CRC_ERROR'],
      ['nothing', Buffer.alloc(0), 'CRC_ERROR'],
      ['the request', framed('rtu', '11 03 00 6B 00 03'), 'BAD_ANSWER']
    ]
    for (const [name, frame, expected] of wrong) {
      assert.throws(() => decodeAnswer(query, frame, { station: 17 }), code(expected), name)
    }
    const write = { fn: 16, base: 1, values: [10, 258] }
    for (const body of ['11 10 00 01 00 03', '11 10 00 02 00 02', '11 06 00 01 00 02']) {
      assert.throws(() => decodeAnswer(write, framed('rtu', body), { station: 17 }), code('BAD_ANSWER'), body)
    }
    for (const body of ['11 05 00 AC 00 00', '11 05 00 AD FF 00']) {
      assert.throws(
        () => decodeAnswer({ fn: 5, base: 172, value: true }, framed('rtu', body), { station: 17 }),
        code('BAD_ANSWER')
      )
    }
  })

  it('says what came, and to what', () => {
    const read = frame => () => decodeAnswer(query, frame, { station: 17 })
    assert.throws(read(closed([17, 3, 2, 0, 0])), {
      details: {
        station: 17,
        reason: `${closed([17, 3, 2, 0, 0]).toString('hex')} does not answer ${describeQuery(query)}`
      }
    })
    assert.throws(read(hex('11 03 02 00 00 00 00')), { details: { station: 17, got: '11030200000000' } })
    assert.throws(read(closed([18, 0x83, 2])), code('BAD_ANSWER'), 'an exception of another station')
    assert.throws(() => encodeAnswer(query, 17, true), {
      details: { count: 0, unit: 'values', reason: 'the request asks for another number', least: 3, most: 3 }
    })
  })

  it('bits that fill up the last byte mean nothing', () => {
    assert.deepEqual(decodeAnswer({ fn: 1, base: 0, count: 3 }, framed('rtu', '01 01 01 FD')), [true, false, true])
  })

  it('a station must give as many values as were asked for', () => {
    assert.throws(() => encodeAnswer(query, 17, [1, 2]), code('BAD_COUNT'))
    assert.throws(() => encodeAnswer(query, 17, true), code('BAD_COUNT'))
  })

  it('addresses in words', () => {
    assert.equal(describeQuery(query), 'holding register, wire addresses 107–109 (006Bh–006Dh)')
    assert.equal(describeQuery({ fn: 5, base: 172, value: true }), 'coil, wire address 172 (00ACh)')
  })
})

describe('MODBUS exceptions', () => {
  // "MODBUS application protocol" 7; again: of a read; write: what it means for one
  const known = [
    [1, 'MODBUS_ILLEGAL_FUNCTION', false, 'refused'],
    [2, 'MODBUS_ILLEGAL_ADDRESS', false, 'refused'],
    [3, 'MODBUS_ILLEGAL_VALUE', false, 'refused'],
    [4, 'MODBUS_DEVICE_FAILURE', false, 'unknown'],
    [5, 'MODBUS_ACKNOWLEDGE', true, 'unknown'],
    [6, 'MODBUS_BUSY', true, 'refused'],
    [7, 'MODBUS_NEGATIVE_ACKNOWLEDGE', false, 'refused'],
    [8, 'MODBUS_MEMORY_PARITY', false, 'refused'],
    [10, 'MODBUS_GATEWAY_PATH', false, 'refused'],
    [11, 'MODBUS_GATEWAY_TARGET', false, 'unknown']
  ]

  it('every number has its code; unknown ones keep their number', () => {
    for (let number = 0; number < 256; number++) {
      const [, expected = 'MODBUS_EXCEPTION', again = false, write = 'unknown'] =
        known.find(row => row[0] === number) ?? []
      const row = exceptionOf(number)
      assert.deepEqual([row.code, row.again, row.write], [expected, again, write], String(number))
      const shown = number.toString(16).toUpperCase().padStart(2, '0')
      assert.throws(
        () => decodeAnswer({ fn: 3, base: 107, count: 3 }, closed([17, 0x83, number])),
        error =>
          error.code === expected && error.details.exception === shown && error.message.includes(`exception ${shown}`)
      )
    }
  })

  it('stands in the list of codes, and is found by code', () => {
    for (const row of EXCEPTIONS) {
      assert.ok(CODES[row.code])
      assert.equal(exceptionByCode(row.code), row)
    }
    for (const row of [...EXCEPTIONS, exceptionOf(9)]) assert.match(row.words, /^[a-z ]{9,}$/, String(row.number))
    assert.equal(exceptionByCode('MODBUS_EXCEPTION').write, 'unknown')
    assert.equal(exceptionByCode('TIMEOUT'), undefined)
    assert.equal(exceptionByCode(undefined), undefined)
  })
})

describe('MODBUS functions', () => {
  it('read and write of each table', () => {
    assert.deepEqual(['co', 'di', 'ir', 'hr'].map(readFunction), [1, 2, 4, 3])
    assert.deepEqual(
      ['co', 'di', 'ir', 'hr'].map(table => writeFunction(table, { single: true })),
      [5, null, null, 6]
    )
    assert.deepEqual(
      ['co', 'di', 'ir', 'hr'].map(table => writeFunction(table, { single: false })),
      [15, null, null, 16]
    )
  })

  it('bits of coils and discrete inputs, words of registers', () => {
    assert.deepEqual(
      FUNCTIONS.filter(({ fn }) => fn !== 8).map(({ fn, unit }) => [fn, unit]),
      [
        [1, 'bits'],
        [2, 'bits'],
        [3, 'words'],
        [4, 'words'],
        [5, 'bits'],
        [6, 'words'],
        [15, 'bits'],
        [16, 'words']
      ]
    )
  })

  it('only these are ever sent', () => {
    assert.deepEqual(
      FUNCTIONS.map(({ fn }) => fn),
      [1, 2, 3, 4, 5, 6, 15, 16]
    )
    for (const fn of [0, 7, 8, 22, 23, '3', null]) assert.throws(() => functionOf(fn), code('FUNCTION_REFUSED'))
  })
})

describe('MODBUS ASCII', () => {
  it('as the manual prints it: LRC 61 is sent 36 31', () => {
    // a body whose bytes add up to 9Fh
    const ascii = toAscii(closed([0x9f - 3, 3]))
    assert.equal(show(ascii.subarray(5, 7)), '36 31')
    assert.equal(show(ascii.subarray(-2)), '0D 0A')
  })

  it('and back, for any body', () => {
    fc.assert(
      fc.property(fc.uint8Array({ minLength: 2, maxLength: 254 }), body => {
        const ascii = framed('ascii', [...body])
        assert.deepEqual(toAscii(closed([...body])), ascii)
        assert.deepEqual(fromAscii(ascii), closed([...body]))
      })
    )
  })

  it('is strict', () => {
    const own = framed('ascii', '11 03 06 02 2B 00 00 00 64').toString('latin1')
    const wrong = [
      own.toLowerCase(),
      own.slice(1),
      own.slice(0, -1),
      own.slice(0, -2),
      ` ${own}`,
      `${own} `,
      own.replace('\r\n', '\n\r'),
      own.replace(':', ';'),
      own.replace('\r\n', ' \n'),
      own.replace('\r\n', '\r '),
      own.replace('64', '65'),
      own.replace('64', '6 '),
      own.replace('64', '6'),
      own.replace('2B', '2G'),
      ':\r\n',
      ':00\r\n',
      ':0000\r\n',
      ''
    ]
    for (const text of wrong) assert.equal(fromAscii(Buffer.from(text, 'latin1')), null, JSON.stringify(text))
  })
})
