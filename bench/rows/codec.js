'use strict'

/** Query and answer of the same number of registers, without any port: NX codec beside modbus-serial's. */
const { EventEmitter } = require('node:events')
const ModbusRTU = require('modbus-serial')
const { encodeQuery } = require('../../lib/codec/nx/query')
const { encodeAnswer, readAnswer } = require('../../lib/codec/nx/answer')
const { openFrame } = require('../../lib/codec/nx/frame')
const { answerTo } = require('../../lib/codec/nx/match')
const { crc16 } = require('../../lib/codec/crc16')

const ROUNDS = 5
const ends = { station: 1, master: 0xe2, steps: 2 }

/** One query out and its answer in: what the line asks the codec for. */
function ours(count) {
  const query = { ask: 'readWords', base: 0x0c0, count }
  const answer = encodeAnswer(query, new Array(count).fill(0x1234), ends)
  return () => {
    encodeQuery(query, ends)
    const { take } = answerTo(query, ends)(answer)
    return readAnswer(openFrame(answer.subarray(0, take)), query, ends).values.length
  }
}

class Port extends EventEmitter {
  isOpen = true
  constructor(answer) {
    super()
    this.answer = answer
  }
  open(callback) {
    callback()
  }
  write() {
    this.emit('data', this.answer)
  }
}

function modbusAnswer(count) {
  const bytes = Buffer.alloc(5 + 2 * count)
  bytes.set([1, 3, 2 * count])
  for (let i = 0; i < count; i++) bytes.writeUInt16BE(0x1234, 3 + 2 * i)
  bytes.writeUInt16LE(crc16(bytes, 0, bytes.length - 2), bytes.length - 2)
  return bytes
}

async function peer(count) {
  const client = new ModbusRTU(new Port(modbusAnswer(count)))
  await new Promise(resolve => client.open(resolve))
  client._timeout = undefined
  let seen = 0
  return () => {
    client.writeFC3(1, 0, count, (error, data) => {
      if (error) throw error
      seen = data.data.length
    })
    return seen
  }
}

/** Exchanges per second. */
function rate(exchange, count) {
  const until = performance.now() + 400
  let n = 0
  while (performance.now() < until) {
    for (let i = 0; i < 50; i++) if (exchange() !== count) throw new Error('the exchange gave no values')
    n += 50
  }
  return n / 0.4
}

const median = list => list.sort((a, b) => a - b)[list.length >> 1]

async function* rows() {
  for (const count of [2, 10, 125]) {
    const [mine, theirs] = [ours(count), await peer(count)]
    const pairs = Array.from({ length: ROUNDS }, () => [rate(mine, count), rate(theirs, count)])
    yield {
      name: `codec, ${count} registers`,
      value: median(pairs.map(pair => pair[0])),
      unit: 'exchanges/s',
      against: 'modbus-serial',
      ratio: median(pairs.map(([a, b]) => a / b)),
      goal: ['>=', 1]
    }
  }
}

module.exports = { rows }
