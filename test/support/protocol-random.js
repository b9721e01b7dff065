'use strict'

/**
 * Random bytes for all that recognises and reads answers of NX and MODBUS stations, driven as the line drives it: no exception but a coded one, no
 * verdict that the contract does not know, always an end.
 */

const assert = require('node:assert/strict')
const { PlcError } = require('../../lib/error')
const modbus = {
  ...require('../../lib/codec/modbus/answer'),
  ...require('../../lib/codec/modbus/ascii'),
  ...require('../../lib/codec/modbus/query'),
  dialog: require('../../lib/codec/modbus/dialog')
}
const nx = {
  ...require('../../lib/codec/nx/answer'),
  ...require('../../lib/codec/nx/frame'),
  ...require('../../lib/codec/nx/query'),
  dialog: require('../../lib/codec/nx/dialog')
}
const { exchange } = require('../../lib/device/modbus-exchange')
const { createRandom } = require('../../lib/sim')

const MOST_STEPS = 40
/** Of a frame: that of MODBUS ASCII. */
const LONGEST = 513
const EMPTY = Buffer.alloc(0)

const toolsOf = seed => {
  const random = createRandom(seed)
  const below = most => Math.floor(random.next() * most)
  const pick = list => list[below(list.length)]
  const bytes = length => Buffer.from(Array.from({ length }, () => below(256)))
  const list = (length, make) => Array.from({ length }, make)
  return { below, pick, bytes, list, bit: () => below(2) === 1, word: () => below(0x10000) }
}

// --- what is asked, and what a station would answer

const NX_QUERIES = {
  readBits: ({ below }) => ({ ask: 'readBits', base: below(2000), count: 1 + below(255) }),
  readWords: ({ below }) => ({ ask: 'readWords', base: below(2000), count: 1 + below(125) }),
  readMixed: ({ below, list, pick }) => ({
    ask: 'readMixed',
    addresses: list(1 + below(20), () => ({ kind: pick(['bit', 'word']), address: below(2000) }))
  }),
  writeWords: ({ below, list, word }) => ({ ask: 'writeWords', base: below(2000), values: list(1 + below(20), word) }),
  writeBits: ({ below, list, bit }) => ({ ask: 'writeBits', base: below(2000), values: list(1 + below(20), bit) })
}
const nxValues = (query, { bit, word }) => {
  if (query.ask.startsWith('write')) return true
  if (query.ask === 'readMixed') return query.addresses.map(({ kind }) => (kind === 'bit' ? bit() : word()))
  return Array.from({ length: query.count }, query.ask === 'readBits' ? bit : word)
}

/** @param {any} tools @param {{ steps: 2|4, station: number }} own */
const nxTalk = (tools, { steps, station }) => {
  const query = tools.pick(Object.values(NX_QUERIES))(tools)
  const reads = query.ask.startsWith('read')
  const talk = nx.dialog[reads ? 'readDialog' : 'writeDialog'](query, { station, steps, attempts: 2 })
  const answer = send => {
    const ends = { station: station === 255 ? tools.below(255) : station, master: send[1], steps }
    if (tools.below(8) === 0) return nx.encodeError(tools.pick([1, 2, 3, 4, 5]), { ...ends, fn: send[2] })
    if (tools.below(16) === 0) return nx.encodeNoService(ends)
    if (steps === 4 && tools.bit()) return nx.encodeAcknowledge(ends)
    return nx.encodeAnswer(query, nxValues(query, tools), ends)
  }
  return { talk, answer }
}

const MODBUS_QUERIES = [
  ...[1, 2].map(fn => ({ below }) => ({ fn, base: below(1000), count: 1 + below(200) })),
  ...[3, 4].map(fn => ({ below }) => ({ fn, base: below(1000), count: 1 + below(125) })),
  ({ below, bit }) => ({ fn: 5, base: below(1000), value: bit() }),
  ({ below, word }) => ({ fn: 6, base: below(1000), value: word() }),
  ({ below, list, bit }) => ({ fn: 15, base: below(1000), values: list(1 + below(40), bit) }),
  ({ below, list, word }) => ({ fn: 16, base: below(1000), values: list(1 + below(40), word) })
]
const modbusValues = ({ fn, count }, { bit, word }) =>
  fn > 4 ? true : Array.from({ length: count }, fn < 3 ? bit : word)

/** @param {any} tools @param {{ protocol: 'rtu'|'ascii', own: boolean }} how own: the bytes of our codec, else those of modbus-serial */
const modbusTalk = (tools, { protocol, own }) => {
  const query = tools.pick(MODBUS_QUERIES)(tools)
  const options = { station: 11, protocol, attempts: 2, ...(own ? {} : { exchange }) }
  const { readDialog, writeDialog } = modbus.dialog
  const talk = query.fn < 5 ? readDialog(query, options) : writeDialog({ frames: [query] }, options)
  const answer = () => {
    const frame =
      tools.below(6) === 0
        ? modbus.encodeException(query.fn, 11, tools.below(256))
        : modbus.encodeAnswer(query, 11, modbusValues(query, tools))
    return protocol === 'ascii' ? modbus.toAscii(frame) : frame
  }
  return { talk, answer }
}

const KINDS = {
  'NX, 2-step': tools => nxTalk(tools, { steps: 2, station: 7 }),
  'NX, 4-step': tools => nxTalk(tools, { steps: 4, station: 7 }),
  'NX, station 255': tools => nxTalk(tools, { steps: 2, station: 255 }),
  RTU: tools => modbusTalk(tools, { protocol: 'rtu', own: true }),
  'RTU, modbus-serial': tools => modbusTalk(tools, { protocol: 'rtu', own: false }),
  ASCII: tools => modbusTalk(tools, { protocol: 'ascii', own: true }),
  'ASCII, modbus-serial': tools => modbusTalk(tools, { protocol: 'ascii', own: false })
}

// --- what comes

const flip = (frame, { below }) => {
  const bytes = Buffer.from(frame)
  for (let n = 1 + below(4); n > 0 && bytes.length > 0; n--) bytes[below(bytes.length)] ^= 1 << below(8)
  return bytes
}

/** Noise, answers, damaged answers, cut and doubled ones, our own echo, headers before noise: in any order. */
const PARTS = [
  (_answer, _send, { bytes, below }) => bytes(below(60)),
  answer => answer,
  answer => answer,
  (answer, _send, tools) => flip(answer, tools),
  (answer, _send, { below }) => answer.subarray(0, below(answer.length)),
  (answer, _send, { below }) => answer.subarray(below(answer.length)),
  (_answer, send) => send,
  (_answer, send, tools) => flip(send, tools),
  (answer, _send, { bytes, below }) => Buffer.concat([answer.subarray(0, 4), bytes(below(300))]),
  (_answer, _send, { below, pick }) => Buffer.alloc(below(300), pick([0, 0x0d, 0x3a, 0x0b, 0xe2, 0xff]))
]

const inputOf = (answer, send, tools) =>
  Buffer.concat(Array.from({ length: 1 + tools.below(4) }, () => tools.pick(PARTS)(answer(send), send, tools)))

/** One verdict of the contract; its place in the bytes has to be there. */
const checkVerdict = (verdict, length) => {
  const { need, take, skip, bad } = verdict
  assert.equal([need, take, skip, bad].filter(value => value !== undefined).length, 1, JSON.stringify(verdict))
  if (take !== undefined) assert.ok(take > 0 && take <= length, JSON.stringify(verdict))
  else if (skip !== undefined) assert.ok(skip > 0 && skip <= length, JSON.stringify(verdict))
  else if (bad !== undefined) assert.ok(verdict.length > 0 && verdict.length <= length, JSON.stringify(verdict))
  else assert.ok(need > length && need <= length + LONGEST, JSON.stringify(verdict))
}

/** As the line does it, in pieces. @returns {Buffer|null} the answer, or null: none came */
const recognise = (match, input, { below }) => {
  let held = EMPTY
  let at = 0
  while (at < input.length) {
    const piece = input.subarray(at, at + 1 + below(200))
    at += piece.length
    held = Buffer.concat([held, piece])
    for (let turns = 0; held.length > 0; turns++) {
      assert.ok(turns <= 1000, 'it does not end')
      const verdict = match(held)
      checkVerdict(verdict, held.length)
      if (verdict.need) break
      if (verdict.take) return held.subarray(0, verdict.take)
      held = held.subarray(verdict.skip ?? verdict.length)
    }
  }
  return null
}

/** CRC-16 bit by bit, and the LRC: not by the code under test. */
const crcOf = bytes => {
  let crc = 0xffff
  for (const byte of bytes) {
    crc ^= byte
    for (let bit = 0; bit < 8; bit++) crc = crc & 1 ? (crc >> 1) ^ 0xa001 : crc >> 1
  }
  return crc
}
const sound = frame => {
  if (frame[0] !== 0x3a) return crcOf(frame.subarray(0, -2)) === frame.readUInt16LE(frame.length - 2)
  const text = frame.toString('latin1')
  if (!/^:([0-9A-F]{2}){4,}\r\n$/.test(text)) return false
  return Buffer.from(text.slice(1, -2), 'hex').reduce((sum, byte) => (sum + byte) & 0xff, 0) === 0
}

const failures = ['TIMEOUT', 'INCOMPLETE', 'CRC_ERROR']

/** @returns {{ end: string, bytes: number }} a code, or `values` */
const converse = ({ talk, answer }, tools) => {
  let bytes = 0
  let step = talk.next()
  try {
    for (let steps = 0; !step.done; steps++) {
      assert.ok(steps < MOST_STEPS, 'the conversation does not end')
      const { send, match } = step.value
      const input = inputOf(answer, send, tools)
      bytes += input.length
      assert.ok(match(EMPTY).need > 0)
      const frame = recognise(match, input, tools)
      if (frame) assert.ok(sound(frame), `${frame.toString('hex')} was taken, whose check does not fit`)
      step = frame ? talk.next(frame) : talk.throw(new PlcError(tools.pick(failures), { station: 1, sent: true }))
    }
    return { end: 'values', bytes }
  } catch (error) {
    if (!(error instanceof PlcError)) throw error
    return { end: error.code, bytes }
  }
}

/** What reads bytes without knowing what was asked: the simulated stations and the diagnosis. Also frames that are whole, with anything inside. */
const decode = tools => {
  const input = tools.bytes(tools.below(40))
  nx.frameLength(input)
  nx.decodeFrame(input, tools.below(input.length + 1))
  const [to, from, fn] = tools.bytes(3)
  const info = tools.bytes(1 + tools.below(40))
  const frame = nx.decodeFrame(nx.encodeFrame({ to, from, fn: tools.bit() ? fn : 0x20 | (fn & 7), info }))
  assert.ok(frame && frame.info.equals(info))
  nx.decodeQuery(frame)
  modbus.fromAscii(input)
  modbus.fromAscii(Buffer.from(`:${input.toString('hex').toUpperCase()}\r\n`))
  const asked = /** @type {any} */ (
    modbus.decodeQuery(modbus.closed(Buffer.concat([Buffer.of(1, tools.below(24)), input])))
  )
  if (asked.query) assert.ok(modbus.countOf(asked.query) <= 0x10000)
}

/**
 * @param {{ inputs: number, seed?: number }} options
 * @returns {{ inputs: number, bytes: number, ends: Record<string, Record<string, number>> }}
 */
const protocolRandom = ({ inputs, seed = 1 }) => {
  const tools = toolsOf(seed)
  /** @type {Record<string, Record<string, number>>} */
  const ends = {}
  let bytes = 0
  const names = Object.keys(KINDS)
  for (let n = 0; n < inputs; n++) {
    const name = names[n % names.length]
    const done = converse(KINDS[name](tools), tools)
    bytes += done.bytes
    ends[name] ??= {}
    ends[name][done.end] = (ends[name][done.end] ?? 0) + 1
    decode(tools)
  }
  return { inputs, bytes, ends }
}

module.exports = { protocolRandom, toolsOf }
