'use strict'

/**
 * The bidirectional protocol of the C24 (user's manual, ch. 7): ENQ, length, data and sum, answered by ACK, or by NAK and an error code. Pure.
 *
 * It has no number by which a repeated frame could be told from a new one with the same bytes: see `repeats.js`.
 */

const { PlcError } = require('../../error')
const { fromAscii, toAscii } = require('./ascii-binary')
const { keyOf } = require('./format')
const { withTransparency } = require('./message')

const ENQ = 0x05
const ACK = 0x06
const NAK = 0x15

/** @type {Buffer} */
const EMPTY = Buffer.alloc(0)
const ACK_FRAME = Buffer.of(ACK)

/**
 * Error codes behind a NAK (user's manual, ch. 10). Each says that the module has not taken the frame, so it may be sent again; also 7F25H, since a
 * length that was damaged on its way is answered so.
 * @type {ReadonlyMap<number, string>}
 */
const NAK_CODES = new Map([
  [0x7f01, 'buffer full: the data before was not taken yet'],
  [0x7f20, 'ASCII-binary conversion error'],
  [0x7f21, 'error in the head of the frame'],
  [0x7f24, 'sum check error'],
  [0x7f25, 'the data is longer than the receive area'],
  [0x7f31, 'both sides sent at the same time'],
  [0x7f40, 'time-out: the frame stopped'],
  [0x7f41, 'wrong length'],
  [0x7f67, 'overrun'],
  [0x7f68, 'framing error'],
  [0x7f69, 'parity error'],
  [0x7f6a, 'buffer full']
])

/** What we say: 0022H to 005FH are free for the other side of the module (7.2). None contains a control code. */
const OUR_NAK = Object.freeze({ sum: 0x22, length: 0x23, incomplete: 0x24, notHex: 0x25, other: 0x2f })

/** What the code of a NAK says, in words. @param {number} code */
const nakText = code => NAK_CODES.get(code) ?? 'a code that is not in the list'

const word = value => Buffer.of(value & 0xff, (value >> 8) & 0xff)

/** The low 16 bits of the sum of all bytes. @param {Uint8Array} bytes */
const sumOf = bytes => {
  let sum = 0
  for (const byte of bytes) sum = (sum + byte) & 0xffff
  return sum
}

const lengthOf = (body, { unit, padEven, most }) => {
  if (body.length > most) throw new PlcError('FRAME_TOO_LONG', { what: 'the message', got: body.length, most })
  if (body.length === 0) {
    throw new PlcError('BAD_VALUE', { item: 'the message', value: '', reason: 'it is empty' })
  }
  if (unit === 'byte') return { data: padEven && body.length % 2 ? Buffer.concat([body, Buffer.of(0)]) : body }
  if (body.length % 2 === 0) return { data: body }
  if (!padEven) throw new PlcError('ODD_COUNT', { count: body.length, reason: 'the length is counted in words' })
  return { data: Buffer.concat([body, Buffer.of(0)]) }
}

/**
 * The frame of a body.
 * @param {Uint8Array} given
 * @param {any} format of `bidirectionalFormat`
 * @returns {Buffer}
 * @throws {PlcError} ODD_COUNT (word units), FRAME_TOO_LONG, BAD_VALUE (empty)
 */
const encodeFrame = (given, format) => {
  const { unit, sumCheck, additional, escaped, asciiBinary } = format
  const { data } = lengthOf(Buffer.from(given), format)
  const section = Buffer.concat([word(unit === 'word' ? data.length / 2 : data.length), data])
  // length and data are converted and made transparent; the sum is neither, and counts the characters as sent but for additional codes
  const characters = asciiBinary ? toAscii(section) : section
  const sum = sumCheck ? word(sumOf(characters)) : EMPTY
  return Buffer.concat([Buffer.of(ENQ), withTransparency(characters, escaped, additional), sum])
}

/**
 * @param {number} code 0022H to 005FH
 * @param {any} format
 * @returns {Buffer}
 */
const encodeNak = (code, { asciiBinary, additional, escaped }) => {
  const characters = asciiBinary ? toAscii(word(code)) : word(code)
  return Buffer.concat([Buffer.of(NAK), withTransparency(characters, escaped, additional)])
}

/** Nothing awaited, the parts of a frame in order, and what is dropped until the line is silent. */
const IDLE = 'idle'
const LENGTH = 'length'
const DATA = 'data'
const SUM = 'sum'
const CODE = 'code'
const JUNK = 'junk'
/** An ACK came: one byte without a check. */
const ALONE = 'alone'

/**
 * Bytes -> frames, ACK and NAK. After anything that is damaged the rest is dropped until the line is silent: a byte inside it could be taken for
 * an ENQ or an ACK, and the other side awaits our answer anyway. An ACK counts when it stands alone, or before an ENQ.
 *
 * Messages: `{ kind: 'data', bytes }`, `{ kind: 'ack' }`, `{ kind: 'nak', code }`, `{ kind: 'damaged', bytes, reason, began }`; `began`: a frame
 * had begun, so that the other side awaits an answer. Reasons: `stray`, `sum`, `length`, `notHex`, `incomplete`, `closed`.
 */
class FrameSplitter {
  #format
  #state = IDLE
  /** all bytes since the head, for the trace */
  #raw = []
  #part = []
  #need = 0
  #escape = false
  #sum = 0
  /** @type {Buffer} */
  #data = EMPTY
  #reason = ''
  #began = false
  /** @type {any[]} */
  #out = []

  /** @param {any} format of `bidirectionalFormat` */
  constructor(format) {
    this.#format = format
  }

  /** ms without a byte after which `flush` is called: an ACK stands alone sooner than a frame is given up. */
  get silence() {
    return this.#state === ALONE ? this.#format.ackSilence : this.#format.silence
  }

  /** Bytes of what has begun. */
  get held() {
    return this.#raw.length
  }

  /** @param {Buffer} bytes @returns {any[]} */
  push(bytes) {
    for (const byte of bytes) this.#take(byte)
    return this.#taken()
  }

  /** `silence` ms have passed without a byte. @returns {any[]} */
  flush() {
    return this.#giveUp('incomplete')
  }

  /** The port was opened anew. @returns {any[]} */
  reset() {
    return this.#giveUp('closed')
  }

  #giveUp(reason) {
    if (this.#state === ALONE) {
      this.#done({ kind: 'ack', bytes: EMPTY })
    } else if (this.#state !== IDLE) {
      const began = this.#began
      const bytes = Buffer.from(this.#raw)
      this.#out.push({ kind: 'damaged', bytes, complete: false, reason: this.#reason || reason, began })
    }
    this.#idle()
    return this.#taken()
  }

  #taken() {
    const out = this.#out
    this.#out = []
    return out
  }

  #idle() {
    this.#state = IDLE
    this.#raw = []
    this.#part = []
    this.#escape = false
    this.#sum = 0
    this.#data = EMPTY
    this.#reason = ''
    this.#began = false
  }

  #expect(state, bytes) {
    this.#state = state
    this.#part = []
    // the sum is never converted
    this.#need = this.#format.asciiBinary && state !== SUM ? bytes * 2 : bytes
  }

  #junk(reason) {
    this.#state = JUNK
    this.#reason = reason
  }

  #take(byte) {
    if (this.#raw.length < this.#format.most) this.#raw.push(byte)
    if (this.#state === JUNK) return
    if (this.#state === IDLE) return this.#head(byte)
    if (this.#state === ALONE) return this.#behindAck(byte)
    if (this.#state !== SUM && this.#isAdditional(byte)) return
    this.#part.push(byte)
    if (this.#state === LENGTH || this.#state === DATA) this.#sum = (this.#sum + byte) & 0xffff
    if (this.#part.length === this.#need) this.#ended()
  }

  #isAdditional(byte) {
    this.#escape = !this.#escape && byte === this.#format.additional
    return this.#escape
  }

  #head(byte) {
    if (byte === ENQ) {
      this.#began = true
      this.#expect(LENGTH, 2)
    } else if (byte === ACK) {
      this.#state = ALONE
    } else if (byte === NAK) {
      this.#expect(CODE, 2)
    } else {
      this.#junk('stray')
    }
  }

  /** A frame may follow at once. Anything else: the ACK was the damaged head of a frame, or of a NAK. */
  #behindAck(byte) {
    if (byte !== ENQ) return this.#junk('stray')
    this.#done({ kind: 'ack', bytes: EMPTY })
    this.#take(byte)
  }

  #ended() {
    const characters = Buffer.from(this.#part)
    const bytes = this.#format.asciiBinary && this.#state !== SUM ? fromAscii(characters) : characters
    if (!bytes) return this.#junk('notHex')
    if (this.#state === LENGTH) return this.#lengthCame(bytes)
    if (this.#state === CODE) return this.#done({ kind: 'nak', bytes, code: bytes.readUInt16LE(0) })
    if (this.#state === SUM) return this.#sumCame(bytes.readUInt16LE(0))
    this.#data = bytes
    if (this.#format.sumCheck) this.#expect(SUM, 2)
    else this.#done({ kind: 'data', bytes })
  }

  #lengthCame(bytes) {
    const count = bytes.readUInt16LE(0)
    const length = this.#format.unit === 'word' ? count * 2 : count
    if (length === 0 || length > this.#format.most) this.#junk('length')
    else this.#expect(DATA, length)
  }

  #sumCame(sum) {
    if (sum === this.#sum) this.#done({ kind: 'data', bytes: this.#data })
    else this.#junk('sum')
  }

  #done(message) {
    this.#out.push({ ...message, complete: true })
    this.#idle()
  }
}

/**
 * How received bytes are cut; for `lease.listen`.
 * @param {any} format of `bidirectionalFormat`
 * @returns {{ key: string, create: () => FrameSplitter }}
 */
const bidirectionalFraming = format => ({
  key: keyOf('melsec bidirectional', format),
  create: () => new FrameSplitter(format)
})

module.exports = {
  ACK_FRAME,
  NAK_CODES,
  OUR_NAK,
  bidirectionalFraming,
  encodeFrame,
  encodeNak,
  nakText,
  sumOf
}
