'use strict'
const assert = require('node:assert/strict')
const fc = require('fast-check')
const { fromAscii, toAscii } = require('../../../lib/codec/melsec/ascii-binary')
const convert = require('../../../lib/codec/melsec/convert')
const { IMAGE, TEXT, bytes } = require('../../vectors/melsec')

const { ENCODINGS, FORMATS, bytesToValue, bytesToWords, decodeText, encodeText, valueToBytes, wordsToBytes } = convert
const code = wanted => error => error.code === wanted
const to = (value, format = 'text', encoding = 'latin1') => valueToBytes(value, { format, encoding })

describe('MELSEC values', () => {
  it('words have their low byte first', () => {
    assert.deepEqual(wordsToBytes(IMAGE.words), Buffer.from(TEXT))
    assert.deepEqual(bytesToWords(Buffer.from(TEXT)), IMAGE.words)
    assert.deepEqual(bytesToWords(Buffer.from('ABC')), [0x4241, 0x43])
    assert.deepEqual(to([1, -1, 0x8000, 65535], 'words'), bytes('01 00 FF FF 00 80 FF FF'))
    assert.deepEqual(to(258, 'words'), bytes('02 01'))
    assert.deepEqual(to(new Uint16Array([258]), 'words'), bytes('02 01'))
  })

  it('bytes, and a Buffer in every format', () => {
    assert.deepEqual(to([0, 255], 'bytes'), bytes('00 FF'))
    for (const format of ['text', 'bytes', 'words']) assert.deepEqual(to(bytes('00 FF 01'), format), bytes('00 FF 01'))
  })

  it('text', () => {
    assert.deepEqual(to('Ä'), bytes('C4'))
    assert.deepEqual(to(12.5), Buffer.from('12.5'))
    assert.deepEqual(to('한', 'text', 'utf8'), bytes('ED 95 9C'))
    // KS X 1001 0x1A51 row "가" = B0A1, "한" = C7D1; JIS X 0208 "あ" = 82A0, half width "ｱ" = B1
    assert.deepEqual(to('가한A', 'text', 'euc-kr'), bytes('B0 A1 C7 D1 41'))
    assert.deepEqual(to('あｱ', 'text', 'shift_jis'), bytes('82 A0 B1'))
    assert.deepEqual(to('A\r\n\0~', 'text', 'euc-kr'), bytes('41 0D 0A 00 7E'))
    // the last ones: of hangul, of hanja, of half width, of the encoding
    assert.deepEqual(to('힝詰', 'text', 'euc-kr'), bytes('C8 FE FD FE'))
    assert.deepEqual(to('ｱﾟ熙', 'text', 'shift_jis'), bytes('B1 DF EA A4'))
    assert.deepEqual(to('\xff', 'text', 'latin1'), bytes('FF'))
    assert.deepEqual(to('\x7f', 'text', 'ascii'), bytes('7F'))
  })

  it('refuses what would go out as something else', () => {
    const wrong = [
      ['가', 'text', 'latin1'],
      ['Ä', 'text', 'ascii'],
      ['é', 'text', 'euc-kr'],
      ['\ud800', 'text', 'utf8'],
      [[1, 2], 'text'],
      [null, 'text'],
      [NaN, 'text'],
      [{}, 'text'],
      [[256], 'bytes'],
      ['AB', 'bytes'],
      [[1.5], 'words'],
      [[65536], 'words'],
      [[-32769], 'words'],
      ['258', 'words'],
      [[null], 'words'],
      [[true], 'words'],
      [new Array(2), 'words']
    ]
    for (const [value, format, encoding] of wrong) {
      assert.throws(
        () => to(value, /** @type {any} */ (format), encoding),
        code('BAD_VALUE'),
        `${String(value)} ${format}`
      )
    }
  })

  it('a refusal says what is wrong', () => {
    const says = (value, format, reason, encoding) =>
      assert.throws(
        () => to(value, format, encoding),
        error => error.code === 'BAD_VALUE' && error.details.reason === reason
      )
    assert.throws(() => to({}), { code: 'BAD_VALUE', message: /^the message cannot take the value/ })
    says('A가', 'text', '"가" cannot be written in latin1')
    says('é', 'text', '"é" cannot be written in euc-kr', 'euc-kr')
    says('\ud800', 'text', 'it has half a character', 'utf8')
    says({}, 'text', 'text, a number or a Buffer is needed; for an array of numbers choose the format bytes or words')
    says(12n, 'text', 'text, a number or a Buffer is needed; for an array of numbers choose the format bytes or words')
    says('12', 'bytes', 'a Buffer or an array of bytes is needed')
    says('12', 'words', 'an array of words, one word or a Buffer is needed')
    says([256], 'bytes', 'bytes are whole numbers from 0 to 255')
    says([65536], 'words', 'words are whole numbers from -32768 to 65535')
  })

  it('the formats and encodings that can be set', () => {
    assert.deepEqual([...FORMATS], ['text', 'bytes', 'words'])
    assert.deepEqual([...ENCODINGS], ['latin1', 'utf8', 'ascii', 'euc-kr', 'shift_jis'])
  })

  it('what is too long is not even copied', () => {
    const long = (value, format, most) => () => valueToBytes(value, { format, encoding: 'latin1', most })
    const cases = [
      ['ABC', 'text', 3],
      [bytes('01 02 03'), 'words', 3],
      [[1, 2, 3], 'bytes', 3],
      [[1, 2, 3], 'words', 6],
      [new Uint16Array(3), 'words', 6]
    ]
    for (const [value, format, got] of cases) {
      assert.equal(long(value, format, got)().length, got)
      assert.throws(long(value, format, got - 1), {
        code: 'FRAME_TOO_LONG',
        details: { what: 'the message', got, most: got - 1 }
      })
    }
    assert.throws(long(new Array(1e9), 'words', 100), code('FRAME_TOO_LONG'))
  })

  it('bytes that are no characters are told', () => {
    assert.deepEqual(decodeText(bytes('41 C1'), 'ascii'), { text: 'A\ufffd', valid: false })
    assert.deepEqual(decodeText(bytes('41 80'), 'ascii'), { text: 'A\ufffd', valid: false })
    assert.deepEqual(decodeText(bytes('41 7F'), 'ascii'), { text: 'A\x7f', valid: true })
    assert.equal(decodeText(bytes('ED 95'), 'utf8').valid, false)
    assert.deepEqual(bytesToValue(bytes('B0'), { format: 'text', encoding: 'euc-kr' }).valid, false)
    assert.deepEqual(bytesToValue(bytes('B0'), { format: 'bytes', encoding: 'euc-kr' }).valid, true)
    assert.equal(decodeText(bytes('EF BF BD'), 'utf8').valid, true)
    assert.equal(decodeText(bytes('B0'), 'euc-kr').valid, false)
    assert.equal(decodeText(bytes('EF BB BF 41'), 'utf8').text.length, 2)
    assert.equal(decodeText(bytes('C7 D1'), 'euc-kr').text, '한')
  })

  it('what a flow gets', () => {
    const body = Buffer.from('ABC')
    assert.equal(bytesToValue(body, { format: 'text', encoding: 'latin1' }).value, 'ABC')
    assert.deepEqual(bytesToValue(body, { format: 'words', encoding: 'latin1' }).value, [0x4241, 0x43])
    assert.deepEqual(bytesToValue(body, { format: 'bytes', encoding: 'latin1' }).value, body)
  })

  it('text there and back, in every encoding', () => {
    const characters = [...'ABZ az09~!', ...'가나힣漢字', ...'あアｱ本', ...'äöüÿ'].join('')
    for (const encoding of ENCODINGS) {
      const known = [...characters].filter(character => {
        try {
          return encodeText(character, encoding)
        } catch {
          return false
        }
      })
      assert.ok(known.length >= 10, encoding)
      fc.assert(
        fc.property(fc.array(fc.constantFrom(...known)), list => {
          const value = list.join('')
          assert.deepEqual(decodeText(encodeText(value, encoding), encoding), { text: value, valid: true })
        }),
        { numRuns: 50 }
      )
    }
  })
})

describe('MELSEC encodings of two bytes', () => {
  // the tables are made at the first use: here by a module of its own
  const file = require.resolve('../../../lib/codec/melsec/convert')
  const anew = () => {
    const old = require.cache[file]
    delete require.cache[file]
    const fresh = require(file)
    require.cache[file] = old
    return fresh
  }
  const span = (from, last) => Array.from({ length: last - from + 1 }, (_, n) => from + n)
  const decoders = { 'euc-kr': new TextDecoder('euc-kr'), shift_jis: new TextDecoder('shift_jis') }
  const characterOf = (encoding, pair) => decoders[encoding].decode(Buffer.from(pair))

  it('EUC-KR: ASCII, all of hangul and hanja of KS X 1001', () => {
    const fresh = anew()
    const pairs = [
      ...span(0xb0, 0xc8).flatMap(lead => span(0xa1, 0xfe).map(trail => [lead, trail])),
      ...span(0xca, 0xfd).flatMap(lead => span(0xa1, 0xfe).map(trail => [lead, trail]))
    ]
    const isOther = pair => !fresh.encodeText(characterOf('euc-kr', pair), 'euc-kr').equals(Buffer.from(pair))
    assert.deepEqual(pairs.filter(isOther), [])
    for (const byte of span(0, 0x7f)) {
      assert.deepEqual([...fresh.encodeText(String.fromCharCode(byte), 'euc-kr')], [byte])
    }
    for (const none of ['\x80', '\xff', '\ufffd', 'é', 'ｱ', '😀'])
      assert.throws(() => fresh.encodeText(none, 'euc-kr'), code('BAD_VALUE'), none)
  })

  it('Shift JIS: ASCII, half width, JIS X 0208 level 1 and the IBM extension', () => {
    const fresh = anew()
    const trails = [...span(0x40, 0x7e), ...span(0x80, 0xfc)]
    const pairs = [
      ...span(0x89, 0x97).flatMap(lead => trails.map(trail => [lead, trail])),
      ...span(0xe0, 0xe9).flatMap(lead => trails.map(trail => [lead, trail])),
      ...span(0xfb, 0xfb).flatMap(lead => span(0x80, 0xfc).map(trail => [lead, trail]))
    ]
    const isOther = pair => !fresh.encodeText(characterOf('shift_jis', pair), 'shift_jis').equals(Buffer.from(pair))
    assert.deepEqual(pairs.filter(isOther), [])
    for (const byte of [...span(0, 0x7f), ...span(0xa1, 0xdf)]) {
      assert.deepEqual([...fresh.encodeText(characterOf('shift_jis', [byte]), 'shift_jis')], [byte])
    }
    for (const none of ['\x80', '\ufffd', '가', 'é'])
      assert.throws(() => fresh.encodeText(none, 'shift_jis'), code('BAD_VALUE'), none)
  })

  it('a table is made once', () => {
    const fresh = anew()
    fresh.encodeText('가', 'euc-kr')
    const start = process.hrtime.bigint()
    for (let n = 0; n < 100; n++) fresh.encodeText('가', 'euc-kr')
    assert.ok(process.hrtime.bigint() - start < 100e6)
  })
})

describe('MELSEC ASCII-binary conversion', () => {
  it('two capital hexadecimal characters a byte', () => {
    // application manual, 13.3: 0212H, BC3AH
    assert.deepEqual(toAscii(bytes('12 02 3A BC')), bytes('31 32 30 32 33 41 42 43'))
    assert.deepEqual(fromAscii(bytes('31 32 30 32 33 41 42 43')), bytes('12 02 3A BC'))
  })

  it('refuses what is no hexadecimal character', () => {
    for (const text of ['1', '1g', 'ab', '1 ', '/0', ':0', '@0', 'G0'])
      assert.equal(fromAscii(Buffer.from(text)), null, text)
    assert.deepEqual(fromAscii(Buffer.alloc(0)), Buffer.alloc(0))
  })

  it('there and back', () => {
    fc.assert(fc.property(fc.uint8Array(), body => assert.deepEqual([...(fromAscii(toAscii(body)) ?? [])], [...body])))
  })
})
