'use strict'

const { PlcError } = require('../error')
const { acknowledgement, DC1, DC3 } = require('./c24-bytes')
const { createC24Memory } = require('./c24-memory')
const { createC24Program } = require('./c24-program')
const { createC24Receiver } = require('./c24-receiver')
const { createC24Sender } = require('./c24-sender')
const { AREA_WORDS, OS_AREA, c24Settings } = require('./c24-settings')

const EMPTY_COUNTS = [
  ...['bytesIn', 'messages', 'taken', 'bytesTaken', 'discarded', 'sioErrors', 'stops', 'goes', 'mostHeld', 'timeouts'],
  ...[
    'skipped',
    'conversionErrors',
    'refused',
    'invalid',
    'bytesOut',
    'sent',
    'unsent',
    'repeated',
    'halted',
    'resumed'
  ]
]

/**
 * A simulated channel of a MELSEC-Q serial module (QJ71C24) for free messages: non-procedure or bidirectional protocol, with the
 * sequence program that reads and writes its buffer memory. It stands on a wire with `duplex: 'full'` (RS-232, RS-422).
 *
 * - `channel` 1 or 2: where its areas are in the buffer memory · `station` 1: what faults and `wire.setOff` call it
 * - `protocol` `non-procedure` (default) or `bidirectional`; `unit` `word` or `byte`: of counts and lengths
 * - `end` receive complete code, up to 2 bytes in hex (`0D 0A`; '' none); `storeEnd` whether it is stored and counted (the manuals
 *   say both; false); `count` receive data count in units (511); `first`, `last` user frames in hex, in place of `end`
 * - `timer0` time without reception that ends a message, in bytes of 12 bits (0: for ever)
 * - `flow` `none`, `dc` (DC1/DC3, both ways) or `dtr`; `stopFree` 64, `goFree` 263: free bytes of the OS area
 * - `transparent` in hex: the additional code, then codes that get it beside DC1 and DC3; `asciiBinary`
 * - `sumCheck` true, `simultaneous` `both`, `receive`, `send`, `none` (which of two crossing messages count), `ackTimeout` 5000 ms, `retries` 0
 * - `rate` messages/s and `byteRate` bytes/s at which the program reads (no limit; 0: only `take()`); `program` `take`, `echo` or a function
 *   `message → text | Buffer | words | null`, sent `turnaround` ms (2) later; `speaks` `{ every: ms, value(n) }` what it sends by itself
 * - `baudRate`, `bitsPerByte` the wire's; `history` 1000 messages that are kept; `onMessage(message)`, `onSent(record)`
 *
 * @param {{ clock: any, [setting: string]: any }} given
 * @returns {MelsecC24}
 * @throws {PlcError} BAD_SETTING
 */
function createMelsecC24(given) {
  const settings = c24Settings(given)
  const counts = Object.fromEntries(EMPTY_COUNTS.map(name => [name, 0]))
  const memory = createC24Memory(settings)
  const parts = connectParts(settings, { counts, memory })
  const { receiver, sender, program, sent, lines } = parts
  const { speaks, clock } = settings
  const allow = () => settings.flow === 'dtr' && lines.cts(true)
  return {
    station: settings.station,
    settings,
    counts,
    messages: program.messages,
    sent,
    memory,
    receive: bytes => receiver.receive(bytes),
    appetite: receiver.appetite,
    speak(send, port) {
      sender.attach(send, port)
      lines.cts = port?.cts ?? lines.cts
      allow()
      if (speaks) parts.stop = speakOn(speaks, { clock, send: value => sender.message(bytesOf(value), {}) })
    },
    close: () => [parts.stop, receiver.reset, sender.reset, program.reset].forEach(part => part()),
    disguise: (bytes, { random }) => Buffer.from(Array.from(bytes, () => random.integer(0x20, 0x7e))),
    send: (value, options = {}) => sender.message(bytesOf(value), options),
    take: program.take,
    setRate: program.setRate,
    os: () => ({ held: receiver.held(), free: OS_AREA - receiver.held(), stopped: receiver.stopped() }),
    sioError: memory.sioError,
    clearError: () => memory.setSioError(false),
    powerOn() {
      for (const part of [memory.clear, receiver.reset, sender.reset, program.reset]) part()
      // nothing is sent: the other side has to assume that it may send
      allow()
    }
  }
}

function connectParts(settings, { counts, memory }) {
  const { clock, flow, protocol, turnaround } = settings
  const lines = { cts: on => void on }
  const later = fn => void clock.setTimer(fn, turnaround, { quiet: true })
  const respond = code => later(() => sender.control(acknowledgement(code, settings)))
  const { sent, done } = records(settings)
  const sender = createC24Sender(settings, { counts, memory, done })
  const receiver = createC24Receiver(settings, {
    counts,
    memory,
    tell: stop => (flow === 'dtr' ? lines.cts(!stop) : sender.control(Buffer.of(stop ? DC3 : DC1))),
    allow: sender.allow,
    arrived: message => program.request(message),
    answered: sender.answered,
    refuse(code) {
      counts.refused++
      memory.result('receive', code)
      respond(code)
    },
    crossed: () => crossed(settings, sender)
  })
  const program = createC24Program(settings, {
    counts,
    read() {
      // in the bidirectional protocol the module answers when the program has read
      if (protocol === 'bidirectional') respond(0)
      receiver.released()
    },
    answer: value => void (value != null && later(() => sender.message(bytesOf(value), {})))
  })
  return { receiver, sender, program, sent, lines, stop: () => {} }
}

function records({ history, onSent }) {
  /** @type {any[]} */
  const sent = []
  const done = record => {
    sent.push(record)
    if (sent.length > history) sent.shift()
    onSent?.(record)
  }
  return { sent, done }
}

/** A message comes in while one of ours is not confirmed yet; false: it does not count. */
function crossed({ simultaneous }, sender) {
  if (simultaneous === 'both' || !sender.busy()) return true
  if (simultaneous !== 'send') sender.waive()
  return simultaneous === 'receive'
}

/** Text (a byte a character), bytes or words (low byte first); as much as the sending area holds. */
function bytesOf(value) {
  const bytes = Array.isArray(value)
    ? Buffer.from(value.flatMap(word => [word & 255, (word >> 8) & 255]))
    : Buffer.from(value, 'latin1')
  const most = 2 * (AREA_WORDS - 1)
  if (bytes.length <= most) return bytes
  throw new PlcError('BAD_SETTING', {
    setting: 'message',
    value: `${bytes.length} bytes`,
    reason: `the sending area holds ${most}`
  })
}

function speakOn({ every, value }, { clock, send }) {
  let number = 0
  let timer = null
  const say = () => {
    timer = clock.setTimer(say, every, { quiet: true })
    const said = value(number++)
    if (said != null) send(said)
  }
  timer = clock.setTimer(say, every, { quiet: true })
  return () => clock.clearTimer(timer)
}

/**
 * @typedef {object} MelsecC24
 * @property {number} station
 * @property {any} settings with their defaults
 * @property {Record<string, number>} counts `bytesIn`, `messages` (that came whole into the receive area), `taken`, `bytesTaken`, `discarded` bytes,
 *   `sioErrors`, `stops`, `goes`, `mostHeld` (of the OS area), `timeouts` (timer 0), `skipped` bytes, `conversionErrors`, `refused` (NAK sent), `invalid`
 *   (crossing messages that do not count), `bytesOut`, `sent`, `unsent`, `repeated`, `halted`, `resumed` (by the peer's DC codes)
 * @property {Message[]} messages what the program has read, the last ones
 * @property {any[]} sent `{ at, bytes, attempts, outcome: 'sent'|'confirmed'|'refused'|'failed', code?, reason? }`
 * @property {any} memory `get(0x600)`, `words(0x600, count)`: the buffer memory
 * @property {(bytes: Buffer, times?: any) => never[]} receive
 * @property {() => number} appetite
 * @property {(send: any, port?: any) => void} speak
 * @property {(bytes: Buffer, context: { random: any }) => Buffer} disguise
 * @property {(value: string | Buffer | number[], options?: { end?: boolean }) => void} send with the end code or the user frames, unless `end` is false
 * @property {() => Message | null} take the program reads now
 * @property {(rates: { rate?: number, byteRate?: number }) => void} setRate
 * @property {() => { held: number, free: number, stopped: boolean }} os the OS area
 * @property {() => boolean} sioError the bit in 201H / 202H
 * @property {() => void} clearError
 * @property {() => void} close it says and does nothing by itself any more
 * @property {() => void} powerOn everything is as after switching on
 * @typedef {{ at: number, arrived: number, by: 'code'|'frame'|'count'|'timer'|'length', bytes: Buffer, count: number }} Message `at`: when it was read, ms
 *   of the clock; `count` in units, as at 600H
 */

module.exports = { createMelsecC24 }
