'use strict'
const assert = require('node:assert/strict')
const fc = require('fast-check')
const { describeAddress, formatAddress, parseAddress, placeOf, TABLES } = require('../../../lib/codec/modbus/address')

const ZERO = { addressMode: '0-base' }
const told = (expected, pattern) => error => error.code === expected && pattern.test(error.message)

describe('MODBUS addresses', () => {
  // panel manual 6; by hand: text, kind, absolute, wire, canonical
  const known = [
    ['000001', 'co', 'bit', 0x200000, 0, '000001'],
    ['001001', 'co', 'bit', 0x200000 + 1000, 1000, '001001'],
    ['065536', 'co', 'bit', 0x20ffff, 65535, '065536'],
    ['101001', 'di', 'bit', 0x210000 + 1000, 1000, '101001'],
    ['165536', 'di', 'bit', 0x21ffff, 65535, '165536'],
    ['301101', 'ir', 'word', 0x10000 + 1100, 1100, '301101'],
    ['401001', 'hr', 'word', 1000, 1000, '401001'],
    ['465536', 'hr', 'word', 65535, 65535, '465536'],
    ['400001', 'hr', 'word', 0, 0, '400001'],
    ['301101.05', 'ir', 'bit', (0x10000 + 1100) * 16 + 5, 1100, '301101.05'],
    ['401001.15', 'hr', 'bit', 1000 * 16 + 15, 1000, '401001.15'],
    ['401001.00', 'hr', 'bit', 1000 * 16, 1000, '401001.00'],
    ['465536.15', 'hr', 'bit', 65535 * 16 + 15, 65535, '465536.15'],
    ['365536.15', 'ir', 'bit', 0x1ffff * 16 + 15, 65535, '365536.15'],
    // five digits: appendix A writes 40108, 10197, 30009
    ['40108', 'hr', 'word', 107, 107, '400108'],
    ['10197', 'di', 'bit', 0x210000 + 196, 196, '100197'],
    ['30009', 'ir', 'word', 0x10000 + 8, 8, '300009'],
    ['00020', 'co', 'bit', 0x200000 + 19, 19, '000020'],
    ['40108.07', 'hr', 'bit', 107 * 16 + 7, 107, '400108.07'],
    ['hr107', 'hr', 'word', 107, 107, 'hr107'],
    ['HR107', 'hr', 'word', 107, 107, 'hr107'],
    ['hr00107', 'hr', 'word', 107, 107, 'hr107'],
    ['ir8', 'ir', 'word', 0x10008, 8, 'ir8'],
    ['co19', 'co', 'bit', 0x200013, 19, 'co19'],
    ['Di196', 'di', 'bit', 0x2100c4, 196, 'di196'],
    ['hr107.05', 'hr', 'bit', 107 * 16 + 5, 107, 'hr107.05'],
    ['hr65535', 'hr', 'word', 65535, 65535, 'hr65535'],
    ['  400108  ', 'hr', 'word', 107, 107, '400108']
  ]
  for (const [text, table, kind, address, wire, canonical] of known) {
    it(text, () => {
      const place = parseAddress(text)
      assert.deepEqual(
        [place.table, place.kind, place.address, place.wire, place.text, place.count],
        [table, kind, address, wire, canonical, 1]
      )
      assert.equal(place.writable, table === 'co' || table === 'hr')
      assert.equal(place.style, /[a-z]/i.test(text) ? 'explicit' : 'panel')
      const bit = /\.(\d\d)/.exec(text)
      const expected = bit && { address: address >> 4, bit: Number(bit[1]), writable: table === 'hr' }
      assert.deepEqual(place.throughWord, expected ?? undefined)
      const { table: at, wire: number, bit: of } = placeOf(kind, address)
      assert.deepEqual([at, number, of], [table, wire, bit ? Number(bit[1]) : undefined])
    })
  }

  it('0-base: the panel’s number is the wire’s; explicit ones are the same', () => {
    const wire = text => parseAddress(text, ZERO).wire
    assert.deepEqual(
      ['400000', '400107', '40107', '465535', 'hr107', '001001', '000000'].map(wire),
      [0, 107, 107, 65535, 107, 1001, 0]
    )
    assert.equal(parseAddress('40107.03', ZERO).text, '400107.03')
    assert.throws(() => parseAddress('465536', ZERO), told('OUT_OF_AREA', /0\.\.65535/))
  })

  const ranges = [
    ['400001..400010', 'word', 0, 10, '400001..400010'],
    ['40001..400010', 'word', 0, 10, '400001..400010'],
    ['hr0..hr9', 'word', 0, 10, 'hr0..hr9'],
    ['HR0 .. hr9', 'word', 0, 10, 'hr0..hr9'],
    ['001001..001016', 'bit', 0x2003e8, 16, '001001..001016'],
    ['401001.00..401001.15', 'bit', 16000, 16, '401001.00..401001.15'],
    ['401001.14..401002.01', 'bit', 16014, 4, '401001.14..401002.01'],
    ['co0..co4095', 'bit', 0x200000, 4096, 'co0..co4095'],
    ['hr5..hr5', 'word', 5, 1, 'hr5']
  ]
  for (const [text, kind, address, count, canonical] of ranges) {
    it(text, () => {
      const place = parseAddress(text)
      assert.deepEqual([place.kind, place.address, place.count, place.text], [kind, address, count, canonical])
    })
  }

  const wrong = [
    ['', 'BAD_ADDRESS', /empty/],
    ['   ', 'BAD_ADDRESS', /empty/],
    ['4001', 'BAD_ADDRESS', /4 digits instead of 6 or 5; a zero in front may have been lost, as in 004001/],
    ['1', 'BAD_ADDRESS', /1 digit .*000001/],
    ['4000010', 'BAD_ADDRESS', /7 digits instead of 6 or 5\./],
    ['200001', 'BAD_ADDRESS', /first digit is 2/],
    ['500001', 'BAD_ADDRESS', /first digit is 5/],
    ['20001', 'BAD_ADDRESS', /first digit is 2/],
    ['400000', 'OUT_OF_AREA', /holding registers has the numbers 1\.\.65536/],
    ['000000', 'OUT_OF_AREA', /coils/],
    ['40000', 'OUT_OF_AREA', /1\.\.65536/],
    ['465537', 'OUT_OF_AREA', /1\.\.65536/],
    ['hr65536', 'OUT_OF_AREA', /0\.\.65535/],
    ['401001.1', 'BAD_ADDRESS', /two digits, \.00 to \.15: \.1 could be \.01 or \.10/],
    ['401001.', 'BAD_ADDRESS', /two digits/],
    ['401001.001', 'BAD_ADDRESS', /two digits/],
    ['hr7.5', 'BAD_ADDRESS', /two digits/],
    ['401001.16', 'BAD_BIT', /bit 16/],
    ['401001.99', 'BAD_BIT', /bit 99/],
    ['001001.00', 'BAD_ADDRESS', /a coil is a bit/],
    ['di5.00', 'BAD_ADDRESS', /a discrete input is a bit/],
    ['hr', 'BAD_ADDRESS', /like 400108, 40108 or hr107/],
    ['hr-1', 'BAD_ADDRESS', /like/],
    ['xr5', 'BAD_ADDRESS', /like/],
    ['M0', 'BAD_ADDRESS', /like/],
    ['4x0001', 'BAD_ADDRESS', /like/],
    ['400 108', 'BAD_ADDRESS', /like/],
    ['+400108', 'BAD_ADDRESS', /like/],
    ['4001e2', 'BAD_ADDRESS', /like/],
    ['٤٠٠١٠٨', 'BAD_ADDRESS', /like/],
    ['__proto__', 'BAD_ADDRESS', /like/],
    ['400001..', 'BAD_ADDRESS', /one end of the range is missing/],
    ['..400001', 'BAD_ADDRESS', /one end of the range is missing/],
    ['400001..400002..400003', 'BAD_ADDRESS', /two ends/],
    ['400001..300002', 'BAD_ADDRESS', /one end is of the holding registers, the other of the input registers/],
    ['400001..400002.00', 'BAD_ADDRESS', /one end is a bit/],
    ['400001..hr9', 'BAD_ADDRESS', /same way/],
    ['400009..400001', 'BAD_ADDRESS', /backwards/],
    ['co0..co4096', 'BAD_COUNT', /too long/],
    ['4'.repeat(100), 'BAD_ADDRESS', /more than 64/],
    [400108, 'BAD_ADDRESS', /a number loses its zeros; write the address in quotes/],
    [null, 'BAD_ADDRESS', /not text/],
    [undefined, 'BAD_ADDRESS', /not text/],
    [{}, 'BAD_ADDRESS', /not text/]
  ]
  for (const [text, expected, pattern] of wrong) {
    it(`refuses ${JSON.stringify(text)?.slice(0, 40)}: ${expected}`, () => {
      assert.throws(() => parseAddress(text), told(expected, pattern))
    })
  }

  it('the reason is also there for programs: why, and with what', () => {
    const why = {
      '': { why: 'empty' },
      '400009..400001': { why: 'backwards' },
      M0: { why: 'form' },
      200001: { why: 'firstDigit', digit: '2' },
      4000010: { why: 'digits', digits: 7 },
      4001: { why: 'zeroLost', digits: 4, padded: '004001' },
      '001001.00': { why: 'bitOfBit' },
      401001.1: { why: 'bitDigits' }
    }
    for (const [text, details] of Object.entries(why)) {
      assert.throws(
        () => parseAddress(text),
        error => {
          const { address, reason, notation, ...more } = error.details
          assert.deepEqual([more, notation, address], [details, 'modbus', text])
          return reason.length > 0
        }
      )
    }
    assert.throws(() => parseAddress(/** @type {any} */ (null)), {
      details: { address: '', reason: 'it is not text', notation: 'modbus' }
    })
    assert.throws(
      () => parseAddress('400000'),
      error => error.details.notation === 'modbus'
    )
  })

  it('the two ends of a text: blanks, length, what stands before or behind', () => {
    assert.equal(parseAddress(`${' '.repeat(60)}hr5  `).text, 'hr5')
    assert.equal(parseAddress(`hr${'0'.repeat(61)}5`).text, 'hr5')
    assert.throws(
      () => parseAddress(`hr${'0'.repeat(62)}5`),
      told('BAD_ADDRESS', /^"hr0{18}…" is not an address: it has more than 64/)
    )
    assert.equal(parseAddress('hr1 .. hr2').count, 2)
    for (const text of ['xhr5', 'hr5x', 'hr5.01x']) assert.throws(() => parseAddress(text), told('BAD_ADDRESS', /like/))
    assert.throws(
      () => parseAddress('401001.123'),
      error => !/could be/.test(error.message)
    )
    assert.throws(
      () => parseAddress('co0..co4096'),
      error => error.details.unit === 'bits'
    )
    assert.throws(
      () => parseAddress('hr0..hr4096'),
      error => error.details.unit === 'words'
    )
    assert.equal(parseAddress('hr5').certainty, 'certain')
  })

  it('without a style an address is written as on the panel, from 1 on', () => {
    assert.equal(formatAddress({ kind: 'word', address: 107 }), '400108')
    assert.equal(formatAddress({ kind: 'bit', address: 0x200000 }), '000001')
  })

  it('formatAddress and parseAddress are inverse to each other', () => {
    const place = fc.oneof(
      fc.record({ kind: fc.constant('word'), address: fc.nat(0x1ffff) }),
      fc.record({ kind: fc.constant('bit'), address: fc.nat(0x21ffff) })
    )
    const style = fc.constantFrom('panel', 'explicit')
    const addressMode = fc.constantFrom('1-base', '0-base')
    fc.assert(
      fc.property(place, style, addressMode, ({ kind, address }, as, mode) => {
        const text = formatAddress({ kind, address, style: as }, { addressMode: mode })
        const back = parseAddress(text, { addressMode: mode })
        assert.deepEqual([back.kind, back.address, back.style, back.text], [kind, address, as, text])
        assert.match(text, as === 'panel' ? /^[0134]\d{5}(\.\d\d)?$/ : /^(co|di|ir|hr)\d+(\.\d\d)?$/)
      }),
      { numRuns: 500 }
    )
  })

  it('what no table has, has no notation', () => {
    for (const [kind, address] of [
      ['word', -1],
      ['word', 0x20000],
      ['word', 1.5],
      ['bit', -1],
      ['bit', 0x220000],
      ['word', undefined]
    ]) {
      const reason = `no ${kind} has this absolute address`
      assert.throws(() => placeOf(kind, address), { details: { address: String(address), reason, notation: 'modbus' } })
    }
  })

  it('the tables do not overlap, bits of registers included', () => {
    const spans = TABLES.map(({ kind, base, size }) =>
      kind === 'bit' ? [base, base + size] : [base * 16, (base + size) * 16]
    )
    spans.sort((a, b) => a[0] - b[0])
    for (let i = 1; i < spans.length; i++) assert.ok(spans[i - 1][1] <= spans[i][0])
  })

  const described = [
    ['400108', {}, 'function 03, wire address 107 (006Bh)'],
    ['400108..400111', {}, 'function 03, wire addresses 107–110 (006Bh–006Eh)'],
    ['001001', {}, 'function 01, wire address 1000 (03E8h)'],
    ['101001', {}, 'function 02, wire address 1000 (03E8h)'],
    ['ir8', {}, 'function 04, wire address 8 (0008h)'],
    ['400108.05', {}, 'function 03, wire address 107 (006Bh), bit 5'],
    ['401001.00..401001.15', {}, 'function 03, wire address 1000 (03E8h), 16 bits'],
    ['hr107.05', { write: true }, 'functions 03 and 10, read-modify-write of wire address 107 (006Bh)'],
    [
      'hr107.05',
      { write: true, holdingFunction: 'auto' },
      'functions 03 and 06, read-modify-write of wire address 107 (006Bh)'
    ],
    ['hr107', { write: true }, 'function 10, wire address 107 (006Bh)'],
    ['hr107', { write: true, holdingFunction: '06' }, 'function 06, wire address 107 (006Bh)'],
    ['hr107', { write: true, holdingFunction: 'auto' }, 'function 06, wire address 107 (006Bh)'],
    ['hr107..hr108', { write: true, holdingFunction: 'auto' }, 'function 10, wire addresses 107–108 (006Bh–006Ch)'],
    ['co1', { write: true }, 'function 0F, wire address 1 (0001h)'],
    ['co1', { write: true, coilFunction: '05' }, 'function 05, wire address 1 (0001h)'],
    ['co1..co2', { write: true, coilFunction: 'auto' }, 'function 0F, wire addresses 1–2 (0001h–0002h)'],
    ['di1', { write: true }, 'discrete inputs cannot be written']
  ]
  for (const [text, options, expected] of described) {
    it(`${text} ${JSON.stringify(options)}: ${expected}`, () => {
      assert.equal(describeAddress(parseAddress(text), options), expected)
    })
  }
})
