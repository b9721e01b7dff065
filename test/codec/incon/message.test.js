'use strict'

const assert = require('node:assert')
const fc = require('fast-check')
const { missingBetween, nextNumber, seal, unseal } = require('../../../lib/codec/incon/check')
const { createLineSplitter, encodeLine, inconFraming } = require('../../../lib/codec/incon/message')
const { createRandom } = require('../../../lib/sim')

const text = message => `${message.bytes.toString('latin1')}${message.complete ? '' : ` (${message.reason})`}`
const split = (bytes, options) => {
  const splitter = createLineSplitter(options)
  return [...splitter.push(Buffer.from(bytes, 'latin1')), ...splitter.flush()].map(text)
}
const refused = (code, value, options) => assert.throws(() => encodeLine(value, options), { code })
// not ours: XOR digit by digit, as a PLC's program would do it
const sealed = body => {
  let check = 0
  for (const letter of body) check ^= letter.charCodeAt(0)
  return `${body}*${'0123456789ABCDEF'[check >> 4]}${'0123456789ABCDEF'[check & 15]}`
}

describe('INCON lines received', () => {
  // 2.14.3: the example sends `Test` CR LF
  const CASES = [
    ['Test\r\n', ['Test']],
    ['Test\n', ['Test']],
    ['\r\n\n\r\nTest\r\n\r\n', ['Test']],
    ['A\r\nB\nC\r\n', ['A', 'B', 'C']],
    ['A\n\rB\n\r', ['A', 'B']],
    ['A\r\r\n', ['A (noLineFeed)']],
    ['A\rB\r\n', ['A (noLineFeed)', 'B']],
    ['A\tB\r\n', ['A\tB']],
    ['A\r\nB', ['A', 'B (silence)']],
    ['A\r', ['A (silence)']],
    ['\r', []],
    ['A\0B\r\nC\r\n', ['A\0B (unprintable)', 'C']],
    ['A\x80\n', ['A\x80 (unprintable)']]
  ]
  for (const [bytes, expected] of CASES) {
    it(`${JSON.stringify(bytes)} → ${JSON.stringify(expected)}`, () => assert.deepStrictEqual(split(bytes), expected))
    it(`${JSON.stringify(bytes)} in any two pieces`, () => {
      for (let at = 0; at <= bytes.length; at++) {
        const splitter = createLineSplitter()
        const [one, two] = [bytes.slice(0, at), bytes.slice(at)].map(piece => Buffer.from(piece, 'latin1'))
        const messages = [...splitter.push(one), ...splitter.push(two), ...splitter.flush()]
        assert.deepStrictEqual(messages.map(text), expected, `cut at ${at}`)
        assert.strictEqual(splitter.held, 0)
      }
    })
  }

  it('a buffer of 256 bytes holds a line of 254 with CR LF; without a line feed it is delivered when it is full', () => {
    const long = 'x'.repeat(254)
    assert.deepStrictEqual(split(`${long}\r\nB\r\n`), [long, 'B'])
    assert.deepStrictEqual(split(`${long}yz\r\nB\r\n`), [`${long}yz (full)`, 'B'])
    assert.deepStrictEqual(split(`${long}yz1234\r\nB\r\n`), [`${long}yz (full)`, '1234 (tail)', 'B'])
    assert.deepStrictEqual(split(`${long}y\r\nB\r\n`), [`${long}y (full)`, 'B'])
    assert.deepStrictEqual(split('abcdefgh\nB\n', { most: 3 }), ['abc (full)', 'def (full)', 'gh (tail)', 'B'])
  })

  it('what is held when the port opens anew is told as torn, and does not run into what follows', () => {
    const splitter = createLineSplitter()
    splitter.push(Buffer.from('O12'))
    assert.strictEqual(splitter.held, 3)
    assert.deepStrictEqual(splitter.reset().map(text), ['O12 (reopened)'])
    assert.deepStrictEqual(splitter.reset(), [])
    assert.deepStrictEqual(splitter.push(Buffer.from('O9\r\n')).map(text), ['O9'])
  })

  it('bytes beyond ASCII are text where the encoding is another', () => {
    assert.deepStrictEqual(split('A\x80\n', { ascii: false }), ['A\x80'])
  })

  it('the key of a framing names all that makes lines different', () => {
    const keys = [{}, { most: 100 }, { silence: 100 }, { ascii: false }, { checked: true }].map(
      each => inconFraming(each).key
    )
    assert.strictEqual(new Set(keys).size, 5)
    assert.strictEqual(inconFraming({ most: 256 }).key, inconFraming().key)
    assert.strictEqual(inconFraming().key, 'INCON lines of 256 bytes, torn after 200 ms, ASCII')
    assert.strictEqual(
      inconFraming({ most: 9, silence: 5, ascii: false, checked: true }).key,
      'INCON lines of 9 bytes, torn after 5 ms, checked'
    )
    assert.strictEqual(inconFraming({ silence: 300 }).create().silence, 300)
  })

  it('a million random bytes, in random pieces: nothing is lost or added but line ends, and no line is longer than a buffer', () => {
    const random = createRandom(7)
    const splitter = createLineSplitter({ most: 16, ascii: false })
    const all = Buffer.alloc(1000000)
    for (let at = 0; at < all.length; at++)
      all[at] = random.chance(0.5) ? random.pick([10, 13]) : random.integer(0, 255)
    const got = []
    for (let at = 0; at < all.length;) {
      const piece = all.subarray(at, (at += random.integer(1, 40)))
      got.push(...splitter.push(piece))
    }
    got.push(...splitter.flush())
    const bare = bytes => bytes.toString('latin1').replace(/[\r\n]/g, '')
    assert.strictEqual(got.map(({ bytes }) => bare(bytes)).join(''), bare(all))
    assert.ok(got.every(({ bytes }) => bytes.length > 0 && bytes.length <= 16 && !bytes.includes(10)))
    assert.ok(got.every(({ complete, bytes }) => !complete || !bytes.includes(13)))
  })
})

describe('INCON lines sent', () => {
  const sent = (value, options) => encodeLine(value, options).toString('latin1')

  it('end with CR LF, once', () => {
    assert.strictEqual(sent('Test'), 'Test\r\n')
    assert.strictEqual(sent('Test\n'), 'Test\r\n')
    assert.strictEqual(sent('Test\r\n'), 'Test\r\n')
    assert.strictEqual(sent(1234), '1234\r\n')
    assert.strictEqual(sent(Buffer.from([0x80, 0x07])), '\x80\x07\r\n')
  })

  it("hold at most 255 bytes: the manual's strCopy writes past its array at 256", () => {
    assert.strictEqual(encodeLine('x'.repeat(253)).length, 255)
    refused('FRAME_TOO_LONG', 'x'.repeat(254))
    assert.strictEqual(encodeLine('x'.repeat(246), { checked: true }).length, 255)
    refused('FRAME_TOO_LONG', 'x'.repeat(247), { checked: true })
    for (const value of ['\n'.repeat(256), Buffer.alloc(256)]) {
      assert.throws(() => encodeLine(value), {
        code: 'FRAME_TOO_LONG',
        details: { what: 'the line', got: 256, most: 253 }
      })
    }
  })

  it('a refusal names the byte, or what is wrong with the text', () => {
    const says = (value, reason, options) =>
      assert.throws(
        () => encodeLine(value, options),
        error => error.code === 'BAD_VALUE' && error.details.reason === reason
      )
    says('A\tB', '09h is no printable ASCII; send it as bytes')
    says('A\x7f', '7Fh is no printable ASCII; send it as bytes')
    says('A\x1f', '1Fh is no printable ASCII; send it as bytes')
    says('Größe', 'a letter beyond ASCII is no printable ASCII; send it as bytes')
    says(Buffer.from('A\nB'), '0Ah (line feed) cannot be inside a line')
    says(Buffer.from('A\0B'), '00h (NUL) cannot be inside a line')
    says('A\ud800', 'it has half a character')
    says('\udc00A', 'it has half a character', { encoding: 'utf8' })
    // U+0141 would go out as 41h, an A
    says('\u0141', 'it has letters that latin1 does not have', { encoding: 'latin1' })
    says('', 'an empty line is no message')
    says(true, 'it must be text, a number or bytes')
  })

  it('what cannot be a line is refused', () => {
    for (const value of ['', '\n', '\r\n', Buffer.alloc(0), null, undefined, true, {}, [], NaN, 12n])
      refused('BAD_VALUE', value)
    assert.throws(
      () => encodeLine(''),
      error => error.details.item === 'the line' && error.details.value === ''
    )
    for (const value of ['A\nB', 'A\0', 'A\rB', 'A\tB', 'Größe', '프로그램', 'A\x7f']) refused('BAD_VALUE', value)
    refused('BAD_VALUE', Buffer.from('A\nB'))
    refused('BAD_VALUE', Buffer.from('A\0B'))
    refused('BAD_VALUE', '프로그램', { encoding: 'latin1' })
  })

  it('other encodings where they are set', () => {
    assert.strictEqual(sent('Größe', { encoding: 'latin1' }), 'Gr\xf6\xdfe\r\n')
    assert.strictEqual(encodeLine('가', { encoding: 'utf8' }).toString('hex'), 'eab0800d0a')
    for (const end of ['\n', '\r\n']) assert.strictEqual(sent(`ß${end}`, { encoding: 'latin1' }), '\xdf\r\n')
    assert.strictEqual(sent('A\x7e'), 'A~\r\n')
    refused('BAD_VALUE', 'A\nB\n', { encoding: 'latin1' })
    refused('BAD_VALUE', 'A\x7f', { encoding: 'latin1' })
  })
})

describe('INCON lines, both ways', () => {
  const line = fc.string({
    unit: fc.integer({ min: 0x20, max: 0x7e }).map(code => String.fromCharCode(code)),
    minLength: 1,
    maxLength: 246
  })
  for (const checked of [false, true]) {
    it(`what was sent comes, in any pieces${checked ? ', checked' : ''}`, () => {
      const property = fc.property(fc.array(line, { maxLength: 8 }), fc.array(fc.nat(300)), (lines, sizes) => {
        const all = Buffer.concat(lines.map((each, number) => encodeLine(each, { checked, number })))
        const splitter = createLineSplitter({ checked })
        const got = []
        let at = 0
        for (const size of sizes) got.push(...splitter.push(all.subarray(at, (at += size))))
        got.push(...splitter.push(all.subarray(at)))
        assert.deepStrictEqual(got.map(text), lines)
        assert.ok(got.every(({ lost = 0, repeated }) => lost === 0 && !repeated))
      })
      fc.assert(property, { seed: 12, numRuns: 200 })
    })
  }
})

describe('INCON checked lines', () => {
  // #01 A: 23^30^31^20^41 = 43h
  it('number, text and the XOR of both', () => {
    assert.strictEqual(encodeLine('A', { checked: true, number: 1 }).toString(), '#01 A*43\r\n')
    assert.strictEqual(`${seal(Buffer.from('O1234'), 99)}`, sealed('#99 O1234'))
    assert.deepStrictEqual(unseal(Buffer.from('#01 A*43')), { text: Buffer.from('A'), number: 1 })
    assert.deepStrictEqual(unseal(Buffer.from(sealed('no number'))), { text: Buffer.from('no number'), number: null })
    assert.deepStrictEqual(unseal(Buffer.from(sealed('#1x A'))), { text: Buffer.from('#1x A'), number: null })
    assert.deepStrictEqual(unseal(Buffer.from(sealed('#05 a*b'))), { text: Buffer.from('a*b'), number: 5 })
    for (const body of ['x01 A', '#01xA', '#1'])
      assert.deepStrictEqual(unseal(Buffer.from(sealed(body))), { text: Buffer.from(body), number: null })
  })

  it('what does not fit is damaged', () => {
    for (const line of ['', 'A', '*4', '#01 A', '#01 A*4', '#01 A*4G', '#01 A*43 ']) {
      assert.deepStrictEqual(unseal(Buffer.from(line)), { reason: 'noCheck' }, line)
    }
    assert.deepStrictEqual(unseal(Buffer.from('#01 A*42')), { reason: 'check' })
    assert.deepStrictEqual(split('#01 A*43\rB\n#02 A*40\n', { checked: true }), [
      '#01 A*43 (noLineFeed)',
      'B (noCheck)',
      'A'
    ])
  })

  it('check digits are capitals when sent; small ones are understood', () => {
    for (let code = 0x41; code <= 0x5a; code++) {
      const body = `#01 ${String.fromCharCode(code)}~`
      assert.strictEqual(`${seal(Buffer.from(body.slice(4)), 1)}`, sealed(body))
      assert.deepStrictEqual(unseal(Buffer.from(sealed(body).replace(/.{2}$/, hex => hex.toLowerCase()))), {
        text: Buffer.from(body.slice(4)),
        number: 1
      })
    }
    assert.strictEqual(`${seal(Buffer.from('AB'), 0)}`, '#00 AB*00')
    assert.strictEqual(`${seal(Buffer.from('l'), 1)}`, '#01 l*6E')
    assert.deepStrictEqual(unseal(Buffer.from('#01 l*6e')), { text: Buffer.from('l'), number: 1 })
    // a check below 10h has its zero
    assert.strictEqual(`${seal(Buffer.from('\x03'), 1)}`, '#01 \x03*01')
    assert.deepStrictEqual(unseal(Buffer.from('#01 \x03*01')), { text: Buffer.of(3), number: 1 })
  })

  it('a number without text is an empty one; two digits are needed, and nothing else', () => {
    assert.deepStrictEqual(unseal(Buffer.from(sealed('#07 '))), { text: Buffer.alloc(0), number: 7 })
    assert.deepStrictEqual(unseal(Buffer.from('*00')), { text: Buffer.alloc(0), number: null })
    for (const body of ['#x7 A', '#7x A', '#07', '#-1 A', '# 7 A'])
      assert.deepStrictEqual(unseal(Buffer.from(sealed(body))), { text: Buffer.from(body), number: null }, body)
    for (const line of ['A+41', 'A*g1', 'A*1g', '41'])
      assert.deepStrictEqual(unseal(Buffer.from(line)), { reason: 'noCheck' }, line)
  })

  // 23^30^30^20^41 = 42h
  it('what is told of a line', () => {
    const splitter = createLineSplitter({ checked: true })
    const got = splitter.push(
      Buffer.from(['#00 A*42', '#03 B*42', '#03 B*42', 'C*43', 'D*45', '#04 E*42'].join('\r\n') + '\r\n')
    )
    const bytes = value => Buffer.from(value)
    assert.deepStrictEqual(got, [
      { kind: 'data', bytes: bytes('A'), complete: true, number: 0, lost: 0 },
      { kind: 'data', bytes: bytes('B'), complete: true, number: 3, lost: 2 },
      { kind: 'data', bytes: bytes('B'), complete: true, number: 3, lost: 0, repeated: true },
      { kind: 'data', bytes: bytes('C'), complete: true, number: null, lost: 0 },
      { kind: 'damaged', bytes: bytes('D*45'), complete: false, reason: 'check' },
      { kind: 'data', bytes: bytes('E'), complete: true, number: 4, lost: 0 }
    ])
    assert.deepStrictEqual(splitter.push(bytes('#05')), [])
    assert.deepStrictEqual(splitter.flush(), [
      { kind: 'damaged', bytes: bytes('#05'), complete: false, reason: 'silence' }
    ])
    const plain = createLineSplitter()
    assert.deepStrictEqual(plain.push(bytes('A\nB\0\n')), [
      { kind: 'data', bytes: bytes('A'), complete: true },
      { kind: 'damaged', bytes: bytes('B\0'), complete: false, reason: 'unprintable' }
    ])
    plain.push(bytes('C'))
    assert.deepStrictEqual(plain.flush(), [{ kind: 'data', bytes: bytes('C'), complete: false, reason: 'silence' }])
  })

  it('any one damaged bit, any one lost byte, is seen or harmless', () => {
    const whole = Buffer.from('#07 O1234 T5*')
    const line = Buffer.from(sealed(whole.toString('latin1', 0, whole.length - 1)))
    const same = ({ text: one = null }) => one === null || one.toString() === 'O1234 T5'
    for (let bit = 0; bit < line.length * 8; bit++) {
      const copy = Buffer.from(line)
      copy[bit >> 3] ^= 1 << (bit & 7)
      assert.ok(same(/** @type {any} */ (unseal(copy))), copy.toString('latin1'))
    }
    for (let at = 0; at < line.length; at++) {
      const copy = Buffer.concat([line.subarray(0, at), line.subarray(at + 1)])
      assert.ok('reason' in unseal(copy), copy.toString())
    }
  })

  it('numbers: 00 after a start, then 01 to 99 and 01 again; a gap tells how many are missing', () => {
    assert.deepStrictEqual([0, 1, 98, 99].map(nextNumber), [1, 2, 99, 1])
    for (let last = 0; last <= 99; last++) {
      let number = last
      for (let lost = 0; lost < 98; lost++) {
        number = nextNumber(number)
        assert.strictEqual(missingBetween(last, number), lost)
      }
    }
    assert.deepStrictEqual([missingBetween(null, 5), missingBetween(5, 0), missingBetween(5, null)], [0, 0, 0])
  })

  it('a line that comes again is marked, but a start may begin with the same words', () => {
    const splitter = createLineSplitter({ checked: true })
    const lines = ['#00 ON', '#00 ON', '#01 A', '#01 A', '#04 B', '#04 C'].map(each => `${sealed(each)}\r\n`)
    const got = splitter.push(Buffer.from(lines.join('')))
    assert.deepStrictEqual(
      got.map(({ bytes, lost, repeated = false }) => [bytes.toString(), lost, repeated]),
      [
        ['ON', 0, false],
        ['ON', 0, false],
        ['A', 0, false],
        ['A', 0, true],
        ['B', 2, false],
        ['C', 98, false]
      ]
    )
  })

  it('of random lines that look right one in 256 passes the check, as by theory', () => {
    const random = createRandom(3)
    let passed = 0
    const tries = 100000
    for (let n = 0; n < tries; n++) {
      const line = Buffer.from(`#01 ........*${random.integer(0, 255).toString(16).toUpperCase().padStart(2, '0')}`)
      random.bytes(8).copy(line, 4)
      if (!('reason' in unseal(line))) passed++
    }
    const expected = tries / 256
    assert.ok(Math.abs(passed - expected) < 4 * Math.sqrt(expected), `${passed}, expected ${expected}`)
  })
})
