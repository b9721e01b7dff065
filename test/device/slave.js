'use strict'

/**
 * A MODBUS slave made of other code than the library's: for tests alone. It speaks bytes, keeps four tables, and does what a test tells it.
 */

const crc = bytes => {
  let rest = 0xffff
  for (const byte of bytes) {
    rest ^= byte
    for (let bit = 0; bit < 8; bit++) rest = rest & 1 ? (rest >>> 1) ^ 0xa001 : rest >>> 1
  }
  return [rest & 0xff, rest >> 8]
}
const rtu = body => Buffer.from([...body, ...crc(body)])
const ascii = body => {
  const lrc = (0x100 - (body.reduce((sum, byte) => sum + byte, 0) & 0xff)) & 0xff
  return Buffer.from(
    `:${Buffer.from([...body, lrc])
      .toString('hex')
      .toUpperCase()}\r\n`
  )
}

/** Length of a request, by its function. */
const lengthOf = bytes => (bytes[1] === 15 || bytes[1] === 16 ? (bytes.length > 6 ? 9 + bytes[6] : 9) : 8)

/** Bodies of the frames in what was heard: `[station, function, …]`. */
const createReceiver = asText => {
  let heard = []
  let last = -Infinity
  return (bytes, { start, end }) => {
    if (start - last > 1) heard = []
    last = end
    heard.push(...bytes)
    if (asText) {
      const text = Buffer.from(heard).toString('latin1')
      if (!text.endsWith('\r\n')) return null
      heard = []
      const body = [...Buffer.from(text.slice(text.lastIndexOf(':') + 1, -2), 'hex')]
      return body.reduce((sum, byte) => sum + byte, 0) % 256 === 0 ? body.slice(0, -1) : null
    }
    if (heard.length < 8 || heard.length < lengthOf(heard)) return null
    const body = heard.slice(0, -2)
    const good = crc(body).every((byte, at) => byte === heard[heard.length - 2 + at])
    heard = []
    return good ? body : null
  }
}

const pair = (body, at) => body[at] * 256 + body[at + 1]

/**
 * @param {{ station?: number, protocol?: 'rtu'|'ascii', has?: (table: string, address: number) => boolean, turnaround?: number }} [options]
 *   has: which addresses it has; else exception 02
 */
const createSlave = ({ station = 11, protocol = 'rtu', has = () => true, turnaround = 2 } = {}) => {
  const tables = { co: new Map(), di: new Map(), hr: new Map(), ir: new Map() }
  const receive = createReceiver(protocol === 'ascii')
  const slave = {
    station,
    tables,
    /** hex of each request's body that it carried out, or refused */
    requests: [],
    /** answers to the next requests: `{ body?, none?, turnaround?, exception? }`, or null for its own */
    next: [],
    /** called with each body before it is carried out */
    before: () => {},
    values: (table, from, count) => Array.from({ length: count }, (_, at) => tables[table].get(from + at) ?? 0),
    set: (table, from, ...values) => values.forEach((value, at) => tables[table].set(from + at, value)),
    receive: (bytes, times) => {
      const body = receive(bytes, times)
      if (!body || (body[0] !== station && body[0] !== 0)) return []
      slave.before(body)
      slave.requests.push(Buffer.from(body).toString('hex'))
      const told = body[0] === 0 ? { none: true } : (slave.next.shift() ?? {})
      if (told.lost) return []
      const own = told.exception ? [station, body[1] | 0x80, told.exception] : carryOut(body)
      const answer = told.body ?? own
      const frame = told.none ? null : told.raw ? Buffer.from(told.raw, 'hex') : { rtu, ascii }[protocol](answer)
      return [{ request: Buffer.from(body), turnaround: told.turnaround ?? turnaround, answer: () => frame }]
    },
    disguise: bytes => bytes
  }
  const bits = (table, base, count) => {
    const bytes = new Array(Math.ceil(count / 8)).fill(0)
    slave.values(table, base, count).forEach((value, at) => value && (bytes[at >> 3] |= 1 << (at & 7)))
    return [bytes.length, ...bytes]
  }
  const words = (table, base, count) => [
    2 * count,
    ...slave.values(table, base, count).flatMap(value => [value >> 8, value & 255])
  ]
  const carryOut = body => {
    const [, fn] = body
    // return query data
    if (fn === 8) return body[2] === 0 && body[3] === 0 ? body : [station, 0x88, 1]
    const base = pair(body, 2)
    const count = fn === 5 || fn === 6 ? 1 : pair(body, 4)
    const table = { 1: 'co', 2: 'di', 3: 'hr', 4: 'ir', 5: 'co', 6: 'hr', 15: 'co', 16: 'hr' }[fn]
    for (let at = 0; at < count; at++) if (!has(table, base + at)) return [station, fn | 0x80, 2]
    if (fn <= 2) return [station, fn, ...bits(table, base, count)]
    if (fn <= 4) return [station, fn, ...words(table, base, count)]
    if (fn === 5) slave.set('co', base, body[4] === 0xff ? 1 : 0)
    if (fn === 6) slave.set('hr', base, pair(body, 4))
    if (fn === 15) for (let at = 0; at < count; at++) slave.set('co', base + at, (body[7 + (at >> 3)] >> (at & 7)) & 1)
    if (fn === 16) for (let at = 0; at < count; at++) slave.set('hr', base + at, pair(body, 7 + 2 * at))
    return body.slice(0, 6)
  }
  return slave
}

module.exports = { ascii, createSlave, crc, rtu }
