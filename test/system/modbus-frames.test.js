'use strict'

/**
 * Frames made by pymodbus go through our conversations: the request must be the same bytes, the answer must give the same values or the same
 * exception, also behind noise; with one bit wrong it must give nothing.
 */

const assert = require('node:assert/strict')
const { execFileSync } = require('node:child_process')
const path = require('node:path')
const { crc16 } = require('../../lib/codec/crc16')
const { decodeAnswer } = require('../../lib/codec/modbus/answer')
const { readDialog, writeDialog } = require('../../lib/codec/modbus/dialog')
const { encodeQuery } = require('../../lib/codec/modbus/query')
const { exchange: modbusSerial } = require('../../lib/device/modbus-exchange')
const { createRandom } = require('../../lib/sim')
const { python } = require('./slaves.js')

const PAIRS = 10000
const SEED = Number(process.env.SERIAL_PLC_SEED ?? Math.floor(Math.random() * 0x7fffffff))

// the numbers of the MODBUS specification
const EXCEPTIONS = {
  1: 'MODBUS_ILLEGAL_FUNCTION',
  2: 'MODBUS_ILLEGAL_ADDRESS',
  3: 'MODBUS_ILLEGAL_VALUE',
  4: 'MODBUS_DEVICE_FAILURE',
  5: 'MODBUS_ACKNOWLEDGE',
  6: 'MODBUS_BUSY',
  7: 'MODBUS_NEGATIVE_ACKNOWLEDGE',
  8: 'MODBUS_MEMORY_PARITY',
  10: 'MODBUS_GATEWAY_PATH',
  11: 'MODBUS_GATEWAY_TARGET'
}
const ownExchange = (query, station) => ({
  send: encodeQuery(query, station),
  read: frame => decodeAnswer(query, frame, { station })
})
const FUNCTIONS = [1, 2, 3, 4, 5, 6, 15, 16]

function makeFrames() {
  const args = [path.join(__dirname, 'pymodbus_frames.py'), String(PAIRS), String(SEED)]
  const text = execFileSync(python(), args, { encoding: 'utf8', maxBuffer: 256 * 1024 * 1024 })
  return text.trimEnd().split('\n').map(JSON.parse)
}

/** Our conversation for what pymodbus asked, as a regulator has it; one attempt, so that the first answer decides. */
function conversation({ query, station }, protocol, exchange = modbusSerial) {
  const options = { station, protocol, attempts: 1, exchange }
  return query.fn <= 4 ? readDialog(query, options) : writeDialog({ frames: [query] }, options)
}

/** As the line does it: bytes come in pieces, what is skipped is dropped. Gives the frame taken, or null. */
function receive(match, pieces) {
  let held = Buffer.alloc(0)
  for (const piece of pieces) {
    held = Buffer.concat([held, piece])
    for (;;) {
      const verdict = match(held)
      if (verdict.take) return held.subarray(0, verdict.take)
      if (verdict.bad) return null
      if (!verdict.skip) break
      held = held.subarray(verdict.skip)
    }
  }
  return null
}

function cut(bytes, random) {
  const at = Array.from({ length: random.integer(0, 3) }, () => random.integer(0, bytes.length)).sort((a, b) => a - b)
  return [...at, bytes.length].map((end, n) => bytes.subarray(at[n - 1] ?? 0, end))
}

/** What the conversation makes of the bytes: `{ values }`, `{ code }`, or null where they are not taken for an answer. */
function meaning(pair, protocol, pieces) {
  const talk = conversation(pair, protocol)
  const step = talk.next().value
  const frame = receive(step.match, pieces)
  if (!frame) return null
  try {
    return { values: talk.next(frame).value.values }
  } catch (error) {
    // of a write: 04, 05 and 0B do not say that nothing was done
    return { code: error.code === 'WRITE_UNKNOWN' ? error.cause.code : error.code }
  }
}

const expected = pair => ('exception' in pair ? { code: EXCEPTIONS[pair.exception] } : { values: pair.values })

for (const protocol of ['rtu', 'ascii']) {
  describe(`frames of pymodbus, ${protocol}`, function () {
    this.timeout(120000)
    let pairs, random
    const bytesOf = (pair, which) => Buffer.from(pair[protocol][which], 'hex')
    before(() => {
      pairs = makeFrames()
      random = createRandom(SEED)
    })

    it(`every function and exception is there (seed ${SEED})`, () => {
      assert.equal(pairs.length, PAIRS)
      for (const fn of FUNCTIONS) {
        const of = pairs.filter(({ query }) => query.fn === fn)
        assert.ok(of.some(pair => pair.values))
        for (const code of Object.keys(EXCEPTIONS)) assert.ok(of.some(pair => pair.exception === Number(code)))
      }
      for (const [fn, most] of [
        [1, 2000],
        [2, 2000],
        [3, 125],
        [4, 125],
        [15, 1968],
        [16, 123]
      ])
        // prettier-ignore
        assert.ok(pairs.some(({ query }) => query.fn === fn && (query.count ?? query.values.length) === most))
    })

    for (const [whose, exchange] of [
      ['by our codec', ownExchange],
      ['through modbus-serial', modbusSerial]
    ])
      // prettier-ignore
      it(`${PAIRS} requests are the same bytes, ${whose}`, () => {
        for (const pair of pairs) {
          const { send } = conversation(pair, protocol, exchange).next().value
          assert.equal(send.toString('hex'), pair[protocol].request)
        }
      })

    it(`${PAIRS} answers mean the same`, () => {
      for (const pair of pairs) {
        const got = meaning(pair, protocol, cut(bytesOf(pair, 'answer'), random))
        assert.deepEqual(got, expected(pair), JSON.stringify(pair[protocol]))
      }
    })

    it(`${PAIRS} answers behind noise: no other value, and none lost but where the noise begins like an answer`, () => {
      let held = 0
      for (const pair of pairs) {
        const noise = random.bytes(random.integer(1, 40))
        const stream = Buffer.concat([noise, bytesOf(pair, 'answer')])
        const got = meaning(pair, protocol, cut(stream, random))
        if (got === null && couldBegin(stream, noise.length, pair)) held++
        else assert.deepEqual(got, expected(pair), `${noise.toString('hex')} ${JSON.stringify(pair[protocol])}`)
      }
      if (protocol === 'ascii') assert.equal(held, 0)
      // a station's number and a function by chance: 20 places, 1 of 256, 16 of 256
      else assert.ok(held < PAIRS * 0.01, `${held} held`)
    })

    it('10000 answers with one bit wrong: none accepted', () => {
      for (const pair of pairs) {
        const bytes = bytesOf(pair, 'answer')
        const bit = random.integer(0, bytes.length * 8 - 1)
        bytes[bit >> 3] ^= 1 << (bit & 7)
        const got = meaning(pair, protocol, [bytes])
        assert.equal(got, null, `bit ${bit} of ${JSON.stringify(pair[protocol])}`)
      }
    })
  })
}

/**
 * RTU: the station's number and a function of it stand somewhere in the noise, so it may be the head of an answer; or the noise and the first bytes
 * of the answer are, by chance, a whole frame of another station.
 */
function couldBegin(stream, noise, { station }) {
  for (let at = 0; at < noise; at++) {
    const fn = stream[at + 1]
    if (!FUNCTIONS.includes(fn & 0x7f)) continue
    if (stream[at] === station) return true
    const length = fn & 0x80 ? 5 : fn <= 4 ? 5 + stream[at + 2] : 8
    const end = at + length - 2
    if (end > noise && end + 2 <= stream.length && crc16(stream, at, end) === stream.readUInt16LE(end)) return true
  }
  return false
}
