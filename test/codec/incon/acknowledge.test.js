'use strict'

const assert = require('node:assert')
const {
  accept,
  ackOf,
  createReception,
  encodeAck,
  judge,
  readAcknowledged,
  startOver
} = require('../../../lib/codec/incon/acknowledge')
const { createLineSplitter, inconFraming } = require('../../../lib/codec/incon/message')

// not ours: XOR letter by letter, as a PLC's program would do it
const sealed = body => {
  let check = 0
  for (const letter of body) check ^= letter.charCodeAt(0)
  return `${body}*${'0123456789ABCDEF'[check >> 4]}${'0123456789ABCDEF'[check & 15]}`
}
const line = (number, text) => ({ number, text: Buffer.from(text) })
const read = text => readAcknowledged(Buffer.from(text, 'latin1'))

describe('INCON acknowledgements', () => {
  it('!NN*HH, HH the XOR of !NN', () => {
    // 21h ^ 30h ^ 37h = 26h; 21h ^ 39h ^ 39h = 21h
    assert.strictEqual(`${encodeAck(7)}`, '!07*26\r\n')
    assert.strictEqual(`${encodeAck(99)}`, '!99*21\r\n')
    assert.strictEqual(`${encodeAck(0)}`, '!00*21\r\n')
    for (let number = 0; number <= 99; number++) {
      const text = sealed(`!${String(number).padStart(2, '0')}`)
      assert.strictEqual(`${encodeAck(number)}`, `${text}\r\n`)
      assert.strictEqual(ackOf(Buffer.from(text)), number)
      assert.strictEqual(ackOf(Buffer.from(text.toLowerCase())), number)
    }
  })

  it('what is none', () => {
    for (const text of ['', '!', '!07*27', '!07*2', '!07*266', '!7*26', '#07*24', '!0A*50', '!07 26', ' !07*26'])
      assert.strictEqual(ackOf(Buffer.from(text)), null, text)
  })

  it('any one damaged bit is seen', () => {
    const whole = Buffer.from('!07*26')
    for (let bit = 0; bit < whole.length * 8; bit++) {
      const copy = Buffer.from(whole)
      copy[bit >> 3] ^= 1 << (bit & 7)
      assert.strictEqual(ackOf(copy), null, copy.toString('latin1'))
    }
  })

  it('what a line is', () => {
    assert.deepStrictEqual(read(sealed('!42')), { kind: 'ack', number: 42 })
    assert.deepStrictEqual(read(sealed('#00 ')), { kind: 'start', number: 0 })
    assert.deepStrictEqual(read(sealed('#00 k3')), { kind: 'start', number: 0 })
    assert.deepStrictEqual(read(sealed('#01 A')), { kind: 'line', number: 1, text: Buffer.from('A') })
    assert.deepStrictEqual(read(sealed('#99 *')), { kind: 'line', number: 99, text: Buffer.from('*') })
    assert.deepStrictEqual(read(sealed('A')), { kind: 'damaged', reason: 'number' })
    assert.deepStrictEqual(read('#01 A*42'), { kind: 'damaged', reason: 'check' })
    assert.deepStrictEqual(read('!01*99'), { kind: 'damaged', reason: 'check' })
    assert.deepStrictEqual(read('A'), { kind: 'damaged', reason: 'noCheck' })
  })

  it('a splitter tells what came, and judges nothing: the same line twice is two messages', () => {
    const splitter = createLineSplitter({ checked: true, acknowledge: true })
    const wire = [sealed('#00 x'), sealed('!05'), sealed('#05 A'), sealed('#05 A'), 'A', '#05 A*00'].join('\r\n')
    const got = splitter.push(Buffer.from(`${wire}\r\n#06 B`)).concat(splitter.flush())
    assert.deepStrictEqual(
      got.map(({ kind, number, bytes, complete, reason }) => [kind, number ?? reason, `${bytes}`, complete]),
      [
        ['start', 0, sealed('#00 x'), true],
        ['ack', 5, sealed('!05'), true],
        ['data', 5, 'A', true],
        ['data', 5, 'A', true],
        ['damaged', 'noCheck', 'A', false],
        ['damaged', 'check', '#05 A*00', false],
        ['damaged', 'silence', '#06 B', false]
      ]
    )
    const keys = [{}, { checked: true }, { checked: true, acknowledge: true }].map(each => inconFraming(each).key)
    assert.strictEqual(new Set(keys).size, 3)
  })
})

describe('INCON lines that come, acknowledged', () => {
  const after = (...lines) => {
    const reception = createReception()
    startOver(reception)
    for (const each of lines) accept(reception, each)
    return reception
  }
  const verdicts = (reception, lines) =>
    lines.map(each => {
      const judged = judge(reception, each)
      if (judged.verdict === 'new') accept(reception, each)
      return judged.verdict === 'new' ? `new ${judged.lost}` : judged.verdict
    })

  it('the next one is new, the same one is repeated', () => {
    const lines = [line(1, 'A'), line(1, 'A'), line(2, 'A'), line(2, 'A'), line(3, 'B')]
    assert.deepStrictEqual(verdicts(after(), lines), ['new 0', 'repeated', 'new 0', 'repeated', 'new 0'])
    assert.deepStrictEqual(verdicts(after(line(99, 'A')), [line(1, 'B')]), ['new 0'])
  })

  it('after a start of the other side its numbers begin anew; after our own any number may come', () => {
    const reception = after(line(1, 'A'))
    startOver(reception)
    assert.deepStrictEqual(verdicts(reception, [line(1, 'A')]), ['new 0'])
    assert.deepStrictEqual(verdicts(createReception(), [line(38, 'A'), line(38, 'A')]), ['new 0', 'repeated'])
  })

  it('a number that is not due counts when the line comes again, or the one behind it, and says what is missing', () => {
    assert.deepStrictEqual(verdicts(after(line(5, 'A')), [line(8, 'B'), line(8, 'B')]), ['doubtful', 'new 2'])
    assert.deepStrictEqual(verdicts(after(line(5, 'A')), [line(8, 'B'), line(9, 'C')]), ['doubtful', 'new 3'])
    assert.deepStrictEqual(verdicts(after(line(5, 'A')), [line(5, 'B'), line(5, 'B')]), ['doubtful', 'new 98'])
    assert.deepStrictEqual(verdicts(after(), [line(2, 'A'), line(2, 'A')]), ['doubtful', 'new 1'])
  })

  it('a damaged number that passes the check: the line comes once, as what it was', () => {
    const lines = [line(17, 'A'), line(6, 'A'), line(17, 'A'), line(7, 'B')]
    assert.deepStrictEqual(verdicts(after(line(5, 'Z')), lines), ['doubtful', 'new 0', 'doubtful', 'new 0'])
  })

  it('what was judged does not change when its buffer is used again', () => {
    const reception = after()
    const text = Buffer.from('A')
    accept(reception, { number: 1, text })
    text[0] = 0x42
    assert.strictEqual(judge(reception, line(1, 'A')).verdict, 'repeated')
    const other = Buffer.from('C')
    judge(reception, { number: 9, text: other })
    other[0] = 0x44
    assert.deepStrictEqual(judge(reception, line(9, 'C')).verdict, 'new')
  })
})
