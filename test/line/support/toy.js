'use strict'

/**
 * A protocol of our own for testing the line: nothing of a real codec.
 * Query `51 station nonce sum`, answer `41 station nonce count data… sum`; sum = low byte of the sum of all others.
 * A write `57 station value sum` is answered with a copy of itself, as MODBUS does.
 */
const sum = bytes => bytes.reduce((a, b) => (a + b) & 0xff, 0)
const closed = bytes => Buffer.from([...bytes, sum(bytes)])

const query = (station, nonce = 0) => closed([0x51, station, nonce])
const answer = (station, data, nonce = 0) => closed([0x41, station, nonce, data.length, ...data])
const write = (station, value) => closed([0x57, station, value])

const answerTo =
  (station, nonce = 0) =>
  bytes => {
    if (bytes.length === 0) return { need: 5 }
    if (bytes[0] !== 0x41) return { skip: 1 }
    if (bytes.length >= 2 && bytes[1] !== station) return { skip: 1 }
    if (bytes.length >= 3 && bytes[2] !== nonce) return { skip: 1 }
    if (bytes.length < 4) return { need: 5 }
    const length = 5 + bytes[3]
    if (bytes.length < length) return { need: length, ours: true }
    const frame = bytes.subarray(0, length)
    if (sum(frame.subarray(0, -1)) !== frame[length - 1]) return { bad: 'sum', length }
    return { take: length }
  }

const copyOf = sent => bytes => {
  if (bytes.length < sent.length) return { need: sent.length }
  if (!bytes.subarray(0, sent.length).equals(sent)) return { skip: 1 }
  return { take: sent.length }
}

/** Asks once; returns the data as an array. */
function* ask(station, { nonce = 0, timeout = 200, gap } = {}) {
  const bytes = yield { send: query(station, nonce), match: answerTo(station, nonce), timeout, gap }
  return [...bytes.subarray(4, -1)]
}

/** Asks again after each failure. */
function* askAgain(station, { attempts = 3, ...options } = {}) {
  let last
  for (let attempt = 0; attempt < attempts; attempt++) {
    try {
      return yield* ask(station, options)
    } catch (error) {
      last = error
    }
  }
  throw last
}

function* put(station, value, { timeout = 200 } = {}) {
  const send = write(station, value)
  yield { send, match: copyOf(send), timeout }
  return 'confirmed'
}

module.exports = { answer, answerTo, ask, askAgain, put, query, write }
