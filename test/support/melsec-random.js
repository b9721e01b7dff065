'use strict'

/** Random bytes for everything that reads bytes of a C24 port: no exception, nothing grows, no more messages than bytes. */

const assert = require('node:assert/strict')
const { fromAscii } = require('../../lib/codec/melsec/ascii-binary')
const { bidirectionalFraming } = require('../../lib/codec/melsec/bidirectional')
const { fromBufferMemory } = require('../../lib/codec/melsec/buffer-memory')
const { ENCODINGS, bytesToValue } = require('../../lib/codec/melsec/convert')
const { bidirectionalFormat, messageFormat } = require('../../lib/codec/melsec/format')
const { messageFraming } = require('../../lib/codec/melsec/message')
const { createRandom } = require('../../lib/sim')

const MOST = 200
const hex = text => Buffer.from(text, 'hex')
/** Bytes that mean something to one of them come often. */
const SIGNS = hex('05061502030D0A10111331304142')

const FRAMINGS = [
  ...[
    {},
    { end: hex('00'), gap: 5 },
    { framing: 'count', count: 7 },
    { framing: 'gap', gap: 9 },
    { first: hex('02'), last: hex('03'), transparent: hex('10') },
    { asciiBinary: true },
    { asciiBinary: true, first: hex('02') }
  ].map(options => messageFraming(messageFormat({ most: MOST, ...options }))),
  ...[{}, { unit: 'byte', sumCheck: false, transparent: hex('1041') }, { asciiBinary: true }].map(options =>
    bidirectionalFraming(bidirectionalFormat({ most: MOST, .../** @type {any} */ (options) }))
  )
]

/** @param {{ inputs: number, seed?: number }} options @returns {{ inputs: number, bytes: number, messages: number }} */
const melsecRandom = ({ inputs, seed = 1 }) => {
  const random = createRandom(seed)
  const below = most => Math.floor(random.next() * most)
  const splitters = FRAMINGS.map(framing => framing.create())
  let bytes = 0
  let messages = 0
  for (let n = 0; n < inputs; n++) {
    const input = Buffer.from(
      Array.from({ length: below(40) }, () => (below(2) ? SIGNS[below(SIGNS.length)] : below(256)))
    )
    bytes += input.length
    const splitter = splitters[n % splitters.length]
    const got = [...splitter.push(input), ...(below(50) ? [] : splitter[below(2) ? 'flush' : 'reset']())]
    // held is bounded by what one message may have
    assert.ok(splitter.held <= MOST + 100, `held ${splitter.held}`)
    for (const message of got) {
      messages++
      assert.ok(message.bytes.length <= MOST)
      assert.ok(message.kind === 'damaged' ? !message.complete && message.reason : message.complete)
    }
    bytesToValue(input, { format: ['text', 'bytes', 'words'][n % 3], encoding: ENCODINGS[n % ENCODINGS.length] })
    fromAscii(input)
    readImage([...input])
  }
  return { inputs, bytes, messages }
}

const readImage = image => {
  try {
    fromBufferMemory(image, { unit: image.length % 2 ? 'word' : 'byte' })
  } catch (error) {
    assert.equal(error.code, 'BAD_VALUE')
  }
}

module.exports = { melsecRandom }
