'use strict'

/** Random bytes for everything that reads lines of an INCON controller: no exception, nothing grows, no line that the bytes do not hold. */

const assert = require('node:assert/strict')
const { accept, createReception, judge } = require('../../lib/codec/incon/acknowledge')
const { START, missingBetween, unseal } = require('../../lib/codec/incon/check')
const { createHandshake, createNcReceiver, createReceiveExample } = require('../../lib/codec/incon/handshake')
const { createLineSplitter, encodeLine } = require('../../lib/codec/incon/message')
const { createRandom } = require('../../lib/sim')

const MOST = 40
/** Bytes that mean something to one of them come often. */
const SIGNS = Buffer.from('\r\n\n#*0123456789AaFf \0')

const WHOLE = ['data', 'ack', 'start']

/** Whoever acknowledges lines takes none twice in a row. */
const createReceiver = () => {
  const reception = createReception()
  return ({ number, bytes }) => {
    const line = { number, text: bytes }
    const { verdict, lost } = judge(reception, line)
    assert.ok(lost >= 0 && lost < 99)
    if (verdict === 'new') accept(reception, line)
    if (verdict !== 'doubtful') assert.equal(judge(reception, line).verdict, 'repeated')
  }
}

/** The manual's structure and program, which take whatever comes. */
const createPlc = restart => {
  const link = createHandshake()
  const nc = createNcReceiver(link, { restart })
  const program = createReceiveExample(link)
  return input => {
    nc.put(input)
    const message = program.scan()
    nc.look()
    program.scan()
    assert.ok(link.length <= 256)
    return message ? 1 : 0
  }
}

/** @param {{ inputs: number, seed?: number }} options @returns {{ inputs: number, bytes: number, lines: number, sent: number, taken: number }} */
const inconRandom = ({ inputs, seed = 1 }) => {
  const random = createRandom(seed)
  const below = most => Math.floor(random.next() * most)
  const splitters = [{}, { ascii: false }, { checked: true }, { most: 2 }, { checked: true, acknowledge: true }].map(
    options => createLineSplitter({ most: MOST, ...options })
  )
  const hear = createReceiver()
  const plcs = [createPlc('always'), createPlc('once')]
  const done = { inputs, bytes: 0, lines: 0, sent: 0, taken: 0 }
  for (let n = 0; n < inputs; n++) {
    const input = Buffer.from(
      Array.from({ length: below(60) }, () => (below(2) ? SIGNS[below(SIGNS.length)] : below(256)))
    )
    done.bytes += input.length
    const splitter = splitters[n % splitters.length]
    const got = [...splitter.push(input), ...(below(50) ? [] : splitter[below(2) ? 'flush' : 'reset']())]
    assert.ok(splitter.held < MOST)
    for (const message of got) {
      done.lines++
      assert.ok(message.bytes.length <= MOST && !message.bytes.includes(0x0a))
      assert.ok(message.complete ? WHOLE.includes(message.kind) : message.reason)
      if (message.kind === 'data' && message.number > 0) hear(message)
      if (message.number !== undefined) assert.ok(missingBetween(START, message.number) < 99)
    }
    done.taken += plcs[n % plcs.length](input)
    const opened = unseal(input)
    assert.ok('reason' in opened || opened.text.length <= input.length)
    done.sent += sendable(input, n)
  }
  return done
}

/** What is not refused is one line for whoever reads it. */
const sendable = (input, n) => {
  const checked = n % 2 === 0
  try {
    const wire = encodeLine(n % 3 ? input : input.toString('latin1'), { checked, number: n % 100 })
    assert.ok(wire.length <= 255 && wire.indexOf(0x0a) === wire.length - 1 && !wire.includes(0))
    return 1
  } catch (error) {
    assert.ok(['BAD_VALUE', 'FRAME_TOO_LONG'].includes(error.code), error.stack)
    return 0
  }
}

module.exports = { inconRandom }
