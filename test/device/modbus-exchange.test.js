'use strict'

const assert = require('node:assert/strict')
const ModbusRTU = require('modbus-serial')
const { exchange, exchangeOf } = require('../../lib/device/modbus-exchange')
const { bench } = require('./chino-bench')
const { rtu } = require('./slave')

const bytes = text => Buffer.from(text.replace(/ /g, ''), 'hex')
const bitsOf = (...each) => each.flatMap(byte => Array.from({ length: 8 }, (_, at) => Boolean((byte >> at) & 1)))

/** Panel manual, appendix A: the worked examples with the check codes of the protocol page. 0F: MODBUS application protocol 6.11. */
const EXAMPLES = [
  [
    '11 01 0013 0025 0E84',
    { fn: 1, base: 0x13, count: 37 },
    '11 01 05 CD6BB20E1B 45E6',
    bitsOf(0xcd, 0x6b, 0xb2, 0x0e, 0x1b).slice(0, 37)
  ],
  [
    '11 02 00C4 0016 BAA9',
    { fn: 2, base: 0xc4, count: 22 },
    '11 02 03 ACDB35 2018',
    bitsOf(0xac, 0xdb, 0x35).slice(0, 22)
  ],
  ['11 03 006B 0003 7687', { fn: 3, base: 0x6b, count: 3 }, '11 03 06 022B00000064 C8BA', [0x22b, 0, 0x64]],
  ['11 04 0008 0001 B298', { fn: 4, base: 8, count: 1 }, '11 04 02 000A F8F4', [10]],
  ['11 05 00AC FF00 4E8B', { fn: 5, base: 0xac, value: true }, '11 05 00AC FF00 4E8B', true],
  ['11 06 0001 0003 9A9B', { fn: 6, base: 1, value: 3 }, '11 06 0001 0003 9A9B', true],
  ['11 10 0001 0002 04 000A 0102 C6F0', { fn: 16, base: 1, values: [10, 0x102] }, '11 10 0001 0002 1298', true]
]

const EXCEPTIONS = [
  [1, 'MODBUS_ILLEGAL_FUNCTION'],
  [2, 'MODBUS_ILLEGAL_ADDRESS'],
  [3, 'MODBUS_ILLEGAL_VALUE'],
  [4, 'MODBUS_DEVICE_FAILURE'],
  [5, 'MODBUS_ACKNOWLEDGE'],
  [6, 'MODBUS_BUSY'],
  [7, 'MODBUS_NEGATIVE_ACKNOWLEDGE'],
  [8, 'MODBUS_MEMORY_PARITY'],
  [10, 'MODBUS_GATEWAY_PATH'],
  [11, 'MODBUS_GATEWAY_TARGET'],
  [9, 'MODBUS_EXCEPTION'],
  [200, 'MODBUS_EXCEPTION']
]

const codeOf = run => {
  try {
    run()
  } catch (error) {
    return error.code
  }
  return 'none'
}

describe('one exchange by modbus-serial', () => {
  for (const [request, query, answer, values] of EXAMPLES) {
    it(`function ${query.fn}: the manual's example`, () => {
      const { send, read } = exchange(query, 0x11)
      assert.equal(send.toString('hex'), bytes(request).toString('hex'))
      assert.deepEqual(read(bytes(answer)), values)
    })
  }

  it('function 15: ten coils, as the protocol prints them', () => {
    const values = [...bitsOf(0xcd), true, false]
    const { send, read } = exchange({ fn: 15, base: 0x13, values }, 0x11)
    assert.deepEqual(send, rtu(bytes('11 0F 0013 000A 02 CD01')))
    assert.equal(read(rtu(bytes('11 0F 0013 000A'))), true)
  })

  it('a read that comes again keeps its client: answers, exceptions and damage one after the other, each for itself', () => {
    for (const [request, query, answer, values] of EXAMPLES) {
      const first = exchangeOf(query, 0x11)
      assert.equal(first.send.toString('hex'), bytes(request).toString('hex'))
      assert.equal(exchangeOf(query, 0x11) === first, query.fn < 5, `${query.fn}`)
      assert.notEqual(exchangeOf({ ...query }, 0x11), first)
      const good = bytes(answer)
      const damaged = Buffer.from(good)
      damaged[3] ^= 1
      for (let n = 0; n < 3; n++) {
        const { read } = exchangeOf(query, 0x11)
        assert.deepEqual(read(good), values)
        assert.equal(
          codeOf(() => read(rtu([0x11, query.fn | 0x80, 2]))),
          'MODBUS_ILLEGAL_ADDRESS'
        )
        assert.match(
          codeOf(() => read(damaged)),
          /^(CRC_ERROR|BAD_ANSWER)$/
        )
      }
      const other = exchangeOf(query, 0x12)
      assert.equal(other.send[0], 0x12)
      assert.notEqual(
        codeOf(() => other.read(good)),
        'none',
        'of another station'
      )
      assert.equal(exchangeOf(query, 0x11).send[0], 0x11)
    }
  })

  it('maximum sizes', () => {
    const most = [
      [{ fn: 1, base: 0, count: 2000 }, [0x11, 1, 250, ...new Array(250).fill(0xff)], 2000],
      [{ fn: 2, base: 63536, count: 2000 }, [0x11, 2, 250, ...new Array(250).fill(0xff)], 2000],
      [{ fn: 3, base: 65411, count: 125 }, [0x11, 3, 250, ...new Array(250).fill(1)], 125],
      [{ fn: 4, base: 0, count: 125 }, [0x11, 4, 250, ...new Array(250).fill(1)], 125]
    ]
    for (const [query, body, count] of most) {
      const values = exchange(query, 0x11).read(rtu(body))
      assert.equal(values.length, count)
      assert.ok(values.every(value => value === (query.fn < 3 ? true : 0x101)))
    }
    assert.equal(exchange({ fn: 15, base: 0, values: new Array(1968).fill(true) }, 1).send.length, 255)
    assert.equal(exchange({ fn: 16, base: 0, values: new Array(123).fill(1) }, 1).send.length, 255)
    for (const query of [
      { fn: 1, base: 0, count: 2001 },
      { fn: 3, base: 0, count: 126 },
      { fn: 15, base: 0, values: new Array(1969).fill(true) },
      { fn: 16, base: 0, values: new Array(124).fill(1) },
      { fn: 3, base: 65535, count: 2 },
      { fn: 6, base: 0, value: 65536 },
      { fn: 6, base: -1, value: 1 },
      { fn: 16, base: 0, values: [] },
      { fn: 7 }
    ]) {
      assert.match(
        codeOf(() => exchange(query, 1)),
        /^(BAD_|FUNCTION_)/,
        JSON.stringify(query).slice(0, 60)
      )
    }
  })

  for (const [number, code] of EXCEPTIONS) {
    it(`exception ${number}: ${code}, for each function`, () => {
      for (const [, query] of EXAMPLES) {
        const { read } = exchange(query, 0x11, { name: () => 'the item' })
        const body = [0x11, query.fn | 0x80, number]
        assert.throws(
          () => read(rtu(body)),
          error =>
            error.code === code &&
            error.details.station === 0x11 &&
            error.details.exception === number.toString(16).toUpperCase().padStart(2, '0')
        )
        assert.throws(
          () => read(rtu([0x12, ...body.slice(1)])),
          error => error.code === 'BAD_ANSWER'
        )
      }
    })
  }

  it('an answer that is not right in each byte is no answer', () => {
    for (const [, query, answer] of EXAMPLES) {
      const good = bytes(answer)
      const { read } = exchange(query, 0x11)
      const reads = query.fn < 5
      const body = good.subarray(0, -2)
      for (let at = 0; at < (reads ? 3 : body.length); at++) {
        const wrong = Buffer.from(body)
        wrong[at] ^= 1
        assert.equal(
          codeOf(() => read(rtu(wrong))),
          'BAD_ANSWER',
          `function ${query.fn}, byte ${at}`
        )
      }
      for (let bit = 0; bit < good.length * 8; bit++) {
        const wrong = Buffer.from(good)
        wrong[bit >> 3] ^= 1 << (bit & 7)
        assert.match(
          codeOf(() => read(wrong)),
          /^(CRC_ERROR|BAD_ANSWER)$/,
          `function ${query.fn}, bit ${bit}`
        )
      }
      assert.equal(
        codeOf(() => read(good.subarray(0, 4))),
        'BAD_ANSWER'
      )
      assert.deepEqual(
        codeOf(() => read(good)),
        'none',
        'the right one still counts'
      )
    }
  })

  it('starts no timer and keeps nothing', () => {
    const before = process.getActiveResourcesInfo().length
    for (let n = 0; n < 1000; n++) exchange({ fn: 3, base: n, count: 1 }, 1)
    assert.equal(process.getActiveResourcesInfo().length, before)
  })
})

describe('a regulator leaves the bytes of each exchange to modbus-serial', () => {
  const FUNCTIONS = [1, 2, 3, 4, 5, 6, 15, 16]
  const kept = FUNCTIONS.map(fn => [fn, ModbusRTU.prototype[`writeFC${fn}`]])
  const seen = { made: [], read: [] }
  beforeEach(() => {
    Object.assign(seen, { made: [], read: [] })
    for (const [fn, own] of kept) {
      ModbusRTU.prototype[`writeFC${fn}`] = function (...given) {
        const [done, code] = given.slice(3)
        // 01 is carried out by 02, 03 by 04, which get its number as well
        if (code !== undefined) return own.apply(this, given)
        seen.made.push(fn)
        const note = (error, result) => {
          seen.read.push(fn)
          done(error, result)
        }
        return own.call(this, ...given.slice(0, 3), note)
      }
    }
  })
  afterEach(() => kept.forEach(([fn, own]) => (ModbusRTU.prototype[`writeFC${fn}`] = own)))

  for (const protocol of ['rtu', 'ascii']) {
    it(`all functions, ${protocol}`, async () => {
      const b = bench({ device: { protocol } })
      const single = b.make({ coilFunction: '05', holdingFunction: '06' })
      await b.read(['co1', 'di1', 'hr1', 'ir1'])
      await b.write([
        { item: 'co1', value: true },
        { item: 'hr1', value: 1 }
      ])
      const entries = [
        { item: 'co1', value: false },
        { item: 'hr1', value: 2 }
      ]
      assert.equal((await b.run(single.write(entries, { fixed: true }))).outcome, 'confirmed')
      single.close()
      await b.close()
      const sorted = list => list.toSorted((one, other) => one - other)
      assert.deepEqual([sorted(seen.made), sorted(seen.read)], [FUNCTIONS, FUNCTIONS])
    })
  }
})
