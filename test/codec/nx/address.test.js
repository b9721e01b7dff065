'use strict'
const assert = require('node:assert/strict')
const fc = require('fast-check')
const { areaMap } = require('../../../lib/codec/nx/areas')
const { parseAddress, formatAddress, describeAddress } = require('../../../lib/codec/nx/address')

const areas = areaMap()

/** What a notation means, and how it is written canonically. */
function means(text, kind, [address, count = 1], canonical) {
  it(`${text} is ${kind} ${address.toString(16).toUpperCase()}h${count > 1 ? ` × ${count}` : ''}`, () => {
    const place = parseAddress(text, areas)
    assert.deepEqual([place.kind, place.address, place.count, place.text], [kind, address, count, canonical])
  })
}

function refuses(text, code, part) {
  it(`refuses ${JSON.stringify(text)}: ${code}`, () => {
    assert.throws(
      () => parseAddress(text, areas),
      error => {
        assert.equal(error.code, code)
        assert.match(error.message, part)
        return true
      }
    )
  })
}

describe('NX address', () => {
  // manual "Read bits", "Read words": the two worked examples, and the bases in the program
  means('K127', 'word', [0x01bf], 'K127')
  means('K127.12', 'bit', [0x1bfc], 'K127.12')
  means('M0', 'word', [0x00c0], 'M0')
  means('K64', 'word', [0x0180], 'K64')
  means('m000', 'word', [0x00c0], 'M0')
  means('k127.03', 'bit', [0x1bf3], 'K127.3')
  means(' M5 ', 'word', [0x00c5], 'M5')
  means('TC5', 'bit', [0x1d05], 'TC5')
  means('TC255', 'bit', [0x1dff], 'TC255')
  means('R0.0', 'bit', [0], 'R0.0')
  means('SR511', 'word', [0xdff], 'SR511')
  means('@0x00C0', 'word', [0x00c0], '@0x00C0')
  means('@192', 'word', [0x00c0], '@0x00C0')
  means('@0x01BF.12', 'bit', [0x1bfc], '@0x01BF.12')
  means('@bit:0x1BFC', 'bit', [0x1bfc], '@0x01BF.12')
  means('@BIT:0x1bfc', 'bit', [0x1bfc], '@0x01BF.12')
  means('@0xFFFF', 'word', [0xffff], '@0xFFFF')
  means('M0..M127', 'word', [0x00c0, 128], 'M0..M127')
  means('m1 .. m3', 'word', [0x00c1, 3], 'M1..M3')
  means('M5..M5', 'word', [0x00c5], 'M5')
  means('M0.0..M0.15', 'bit', [0x0c00, 16], 'M0.0..M0.15')
  means('M0.8..M1.7', 'bit', [0x0c08, 16], 'M0.8..M1.7')
  means('TC0..TC9', 'bit', [0x1d00, 10], 'TC0..TC9')
  means('@0x00C0..@0x00C7', 'word', [0x00c0, 8], '@0x00C0..@0x00C7')

  means(`${' '.repeat(60)}M5 `, 'word', [0x00c5], 'M5')
  means(`M${'0'.repeat(7)}5${' '.repeat(45)}..M7`, 'word', [0x00c5, 3], 'M5..M7')
  means('@0x0000..@0x0FFF', 'word', [0, 4096], '@0x0000..@0x0FFF')
  means('W0..W2047', 'word', [0x200, 2048], 'W0..W2047')

  refuses('', 'BAD_ADDRESS', /empty/)
  refuses('  ', 'BAD_ADDRESS', /empty/)
  refuses('?M5', 'BAD_ADDRESS', /neither/)
  refuses('1M5', 'BAD_ADDRESS', /neither/)
  refuses('ABCDE5', 'BAD_ADDRESS', /neither/)
  refuses('?@5', 'BAD_ADDRESS', /neither/)
  refuses('@5?', 'BAD_ADDRESS', /neither/)
  refuses('@5.1x', 'BAD_ADDRESS', /neither/)
  refuses('@0x00C5..M6', 'BAD_ADDRESS', /one area/)
  refuses('@0x0000..@0x1000', 'BAD_COUNT', /4097 words.*the range is too long/)
  refuses(`X${'0'.repeat(80)}`, 'BAD_ADDRESS', /^"X0{19}…" is not an address: it has more than 64 characters/)
  refuses('M', 'BAD_ADDRESS', /neither/)
  refuses('5', 'BAD_ADDRESS', /neither/)
  refuses('M-1', 'BAD_ADDRESS', /neither/)
  refuses('M1.2.3', 'BAD_ADDRESS', /neither/)
  refuses('M1.', 'BAD_ADDRESS', /neither/)
  refuses('M1.A', 'BAD_ADDRESS', /neither/)
  refuses('M１', 'BAD_ADDRESS', /neither/)
  refuses('__proto__', 'BAD_ADDRESS', /neither/)
  refuses('M0..', 'BAD_ADDRESS', /end of the range is missing/)
  refuses('M0..M1..M2', 'BAD_ADDRESS', /two ends/)
  refuses('M5..M4', 'BAD_ADDRESS', /backwards/)
  refuses('M0..K1', 'BAD_ADDRESS', /one area/)
  refuses('M0..@0x00C5', 'BAD_ADDRESS', /one area/)
  refuses('M0..M0.5', 'BAD_ADDRESS', /one end is a bit/)
  refuses('TC5.1', 'BAD_ADDRESS', /without a bit/)
  refuses('@0x10000', 'BAD_ADDRESS', /last word address is 0xFFFF/)
  refuses('@bit:0x10000', 'BAD_ADDRESS', /last bit address is 0xFFFF/)
  refuses('@bit:0x1BFC.1', 'BAD_ADDRESS', /alone/)
  refuses(`M${'0'.repeat(80)}`, 'BAD_ADDRESS', /characters/)
  refuses(7, 'BAD_ADDRESS', /not text/)
  refuses(null, 'BAD_ADDRESS', /not text/)
  refuses({ toString: () => 'M0' }, 'BAD_ADDRESS', /not text/)
  refuses('Q5', 'UNKNOWN_AREA', /Known areas: R, L, M, K, F, TC, W, SV, PV, SR/)
  refuses('M128', 'OUT_OF_AREA', /M0\.\.M127/)
  refuses('M0..M128', 'OUT_OF_AREA', /M0\.\.M127/)
  refuses('M128.3', 'OUT_OF_AREA', /M0\.\.M127/)
  refuses('TC256', 'OUT_OF_AREA', /TC0\.\.TC255/)
  refuses('M0.16', 'BAD_BIT', /bit 16/)
  refuses('@0x0000.16', 'BAD_BIT', /bit 16/)
  refuses('@0x0000..@0xFFFF', 'BAD_COUNT', /65536 words/)
  refuses('W0.0..W2047.15', 'BAD_COUNT', /32768 bits/)

  it('says how sure an address is and whether it may be written', () => {
    const say = text => {
      const { area, certainty, writable } = parseAddress(text, areas)
      return [area, certainty, writable]
    }
    assert.deepEqual(say('M0'), ['M', 'certain', true])
    assert.deepEqual(say('R0'), ['R', 'likely', true])
    assert.deepEqual(say('W0'), ['W', 'unconfirmed', false])
    assert.deepEqual(say('TC0'), ['TC', 'unconfirmed', false])
    // a raw address is no way around the table
    assert.deepEqual(say('@0x0200'), ['W', 'unconfirmed', false])
    assert.deepEqual(say('@0x00C0'), ['M', 'certain', true])
    assert.deepEqual(say('@0x013F..@0x0140'), [null, 'certain', true])
    assert.deepEqual(say('@0x00BF..@0x00C0'), [null, 'likely', true])
    assert.deepEqual(say('@0x01BF..@0x01C0'), [null, 'unconfirmed', false])
    assert.deepEqual(say('@0x01E0'), [null, 'unconfirmed', false])
    assert.deepEqual(say('@0x01BF.15..@0x01C0.0'), [null, 'unconfirmed', false])
    // the last bit, the last word of a row: still inside
    assert.deepEqual(say('@0x01BF.14..@0x01BF.15'), ['K', 'certain', true])
    assert.deepEqual(say('@0x01BE..@0x01BF'), ['K', 'certain', true])
    assert.deepEqual(say('@bit:0x1400..@bit:0x1401'), ['K', 'certain', true])
  })

  it('reads a bit of an area of words through its word', () => {
    const place = parseAddress('W3.5', areas)
    assert.deepEqual(place.throughWord, { address: 0x203, bit: 5, writable: false })
    assert.deepEqual([place.kind, place.address, place.writable], ['bit', 0x2035, false])
    const confirmed = parseAddress('W3.5', areaMap([{ area: 'W', confirmed: true }]))
    assert.equal(confirmed.writable, false)
    assert.deepEqual(confirmed.throughWord, { address: 0x203, bit: 5, writable: true })
    assert.equal(parseAddress('M3.5', areas).throughWord, undefined)
    // bit addresses end at $FFFF, that is word $FFF; written raw a bit goes out as a bit
    assert.deepEqual(parseAddress('@0x1000.3', areas).throughWord, { address: 0x1000, bit: 3, writable: false })
    assert.equal(parseAddress('@0x0203.5', areas).throughWord, undefined)
    assert.equal(parseAddress('@bit:0xFFFF', areas).throughWord, undefined)
    assert.equal(parseAddress('@bit:0xFFFE..@bit:0xFFFF', areas).throughWord, undefined)
    assert.equal(parseAddress('W3', areaMap([{ area: 'W', confirmed: true }])).writable, true)
    assert.deepEqual(parseAddress('@0x0FFF.15..@0x1000.0', areas).throughWord, {
      address: 0xfff,
      bit: 15,
      writable: false
    })
  })

  it('says what goes out', () => {
    const say = (text, options) => describeAddress(parseAddress(text, areas), options)
    assert.equal(say('K127'), 'function 23, word address 01BFh (447)')
    assert.equal(say('K127.12'), 'function 21, bit address 1BFCh')
    assert.equal(say('K127', { steps: 4 }), 'function 03, word address 01BFh (447)')
    assert.equal(say('K127', { write: true }), 'function 24, word address 01BFh (447)')
    assert.equal(say('K127.12', { steps: 4, write: true }), 'function 02, bit address 1BFCh')
    assert.equal(say('M0..M127'), 'function 23, word addresses 00C0h–013Fh (192–319)')
    assert.equal(say('TC0..TC9'), 'function 21, bit addresses 1D00h–1D09h')
    assert.equal(say('W3.5'), 'function 23, word address 0203h (515), bit 5')
    assert.equal(say('W3.8..W4.7'), 'function 23, word addresses 0203h–0204h (515–516), 16 bits')
  })

  it('writes an absolute address by its area, or raw', () => {
    const say = (kind, address, count) => formatAddress({ kind, address, count }, areas)
    assert.equal(say('word', 0xc0), 'M0')
    assert.equal(say('bit', 0x1bfc), 'K127.12')
    assert.equal(say('bit', 0x1d05), 'TC5')
    assert.equal(say('word', 0x1d0), '@0x01D0')
    assert.equal(say('word', 0x1e0), '@0x01E0')
    assert.equal(say('bit', 0x1e07), '@0x01E0.7')
    assert.equal(say('word', 0x13f, 2), '@0x013F..@0x0140')
    assert.equal(say('word', 0x13e, 2), 'M126..M127')
    assert.equal(say('bit', 0x13fe, 2), 'M127.14..M127.15')
    assert.equal(say('word', 0xffff), '@0xFFFF')
    assert.equal(say('bit', 0xfffff), '@0xFFFF.15')
    assert.throws(() => say('bit', 0x100000), {
      details: { address: '1048576', reason: 'no bit has this absolute address' }
    })
    for (const [kind, address, count] of [
      ['word', 0x10000],
      ['word', -1],
      ['word', 1.5],
      ['word', 0xffff, 2],
      ['byte', 1],
      ['bit', 1, 0]
    ]) {
      assert.throws(() => say(kind, address, count), { code: 'BAD_ADDRESS' })
    }
  })

  it('formatAddress and parseAddress are inverse to each other', () => {
    const kinds = fc.constantFrom('word', 'bit')
    fc.assert(
      fc.property(kinds, fc.nat(0xffff), fc.integer({ min: 1, max: 300 }), (kind, address, count) => {
        fc.pre(address + count - 1 <= 0xffff)
        const text = formatAddress({ kind, address, count }, areas)
        const place = parseAddress(text, areas)
        assert.deepEqual([place.kind, place.address, place.count, place.text], [kind, address, count, text])
      })
    )
  })

  it('ends every text in an address or one of its five codes', () => {
    const codes = ['BAD_ADDRESS', 'UNKNOWN_AREA', 'OUT_OF_AREA', 'BAD_BIT', 'BAD_COUNT']
    const near = fc.stringMatching(/^[@MKWTCxb:0-9A-F. ]{0,20}$/)
    fc.assert(
      fc.property(fc.oneof(near, fc.string({ maxLength: 90 }), fc.anything()), text => {
        try {
          assert.ok(parseAddress(text, areas).count >= 1)
        } catch (error) {
          assert.ok(codes.includes(error.code), error.stack)
        }
      }),
      { numRuns: 500 }
    )
  })
})
