'use strict'

/**
 * One scripted MODBUS station in virtual time, the same for our device and for a peer. It is a single thread: while it is late with one answer
 * the next request waits. Nothing of our codec is used here.
 */

const BAUD = 19200
const CHARACTER = 10000 / BAUD
const TURNAROUND = 10

function crc(bytes) {
  let sum = 0xffff
  for (const byte of bytes) {
    sum ^= byte
    for (let bit = 0; bit < 8; bit++) sum = sum & 1 ? (sum >> 1) ^ 0xa001 : sum >> 1
  }
  return [sum & 0xff, sum >> 8]
}

const lrc = bytes => -bytes.reduce((sum, byte) => sum + byte, 0) & 0xff
const hex = bytes => Buffer.from(bytes).toString('hex').toUpperCase()

/** `close`: a body with its checksum. `open`: the bodies in what was sent at once; RTU knows its frames by the silence around them. */
const FRAMES = {
  rtu: {
    close: body => Buffer.from([...body, ...crc(body)]),
    open: bytes => {
      const body = [...bytes.subarray(0, -2)]
      return FRAMES.rtu.close(body).equals(bytes) ? [body] : []
    }
  },
  ascii: {
    close: body => Buffer.from(`:${hex([...body, lrc(body)])}\r\n`),
    open: bytes =>
      bytes
        .toString('latin1')
        .split('\r\n')
        .filter(Boolean)
        .map(text => [...Buffer.from(text.slice(1, -2), 'hex')])
  }
}

const word = value => [value >> 8, value & 0xff]
const pack = bits =>
  Array.from({ length: Math.ceil(bits.length / 8) }, (_, at) =>
    bits.slice(8 * at, 8 * at + 8).reduce((sum, bit, n) => sum + (bit ? 2 ** n : 0), 0)
  )

/** Registers and coils that differ from their neighbours, until they are written. */
function createMemory() {
  const written = new Map()
  const first = { hr: at => (at * 7 + 1000) & 0xffff, co: at => (at * 37) % 5 < 2 }
  return {
    get: (table, at) => written.get(`${table}${at}`) ?? first[table](at),
    set: (table, at, value) => void written.set(`${table}${at}`, value)
  }
}

/** What the station carries out, and its answer without checksum. */
function carryOut(memory, [unit, fn, ...rest]) {
  const base = rest[0] * 256 + rest[1]
  const value = rest[2] * 256 + rest[3]
  const list = table => Array.from({ length: value }, (_, n) => memory.get(table, base + n))
  if (fn === 1) return [unit, fn, Math.ceil(value / 8), ...pack(list('co'))]
  if (fn === 3) return [unit, fn, 2 * value, ...list('hr').flatMap(word)]
  if (fn === 5) memory.set('co', base, value === 0xff00)
  else if (fn === 6) memory.set('hr', base, value)
  else if (fn === 16)
    for (let n = 0; n < value; n++) memory.set('hr', base + n, rest[5 + 2 * n] * 256 + rest[6 + 2 * n])
  else return [unit, fn | 0x80, 1]
  return [unit, fn, ...rest.slice(0, 4)]
}

/**
 * @param {any} clock
 * @param {object} script
 * @param {'rtu'|'ascii'} script.protocol
 * @param {boolean} [script.echo] the adapter hears itself
 * @param {(job: { n: number, body: number[], fn: number, run: () => number[], close: (body: number[]) => Buffer }) =>
 *   { bytes?: Buffer, delay?: number } | null} [script.answer] null: silence; default: carried out and answered at once
 * @returns a wire for our line (`connect`), with `held(table, at)` and `requests`
 */
function createStation(clock, { protocol, echo = false, answer = ({ run, close }) => ({ bytes: close(run()) }) }) {
  const { open, close } = FRAMES[protocol]
  const memory = createMemory()
  const station = { requests: 0, held: memory.get, connect }
  let free = 0

  function connect({ data }) {
    const live = { open: true }
    const say = (bytes, at) => clock.setTimer(() => live.open && data(Buffer.from(bytes)), at - clock.now())
    const write = bytes => {
      const sent = clock.now() + bytes.length * CHARACTER
      if (echo) say(bytes, sent)
      for (const body of open(Buffer.from(bytes))) {
        const n = ++station.requests
        const job = answer({ n, body, fn: body[1], run: () => carryOut(memory, body), close })
        if (!job) continue
        free = Math.max(free, sent) + TURNAROUND + (job.delay ?? 0)
        free += job.bytes.length * CHARACTER
        say(job.bytes, free)
      }
    }
    return { write, close: () => void (live.open = false) }
  }
  return station
}

module.exports = { BAUD, createStation }
