'use strict'

/**
 * A C24 whose sequence program reads slowly, and a port that sends as fast as it may, in virtual time: what is sent, and what the program has
 * taken. While it does, the C24 speaks, too.
 */

const { createC24Port, createPool } = require('../../lib')
const { createMelsecC24, createRandom, createVirtualClock, createWire } = require('../../lib/sim')

const BAUD = 19200
const AT_ONCE = 8
const MOST = 1000

/** Flow control: what the port, the line and the module are set to. */
const FLOWS = {
  dc: { port: { flow: 'dc' }, line: {}, module: 'dc' },
  dtr: { port: { flow: 'driver' }, line: { flowControl: 'rtscts' }, module: 'dtr' },
  none: { port: { flow: 'none' }, line: {}, module: 'none' }
}

/** Message n: its number and characters of chance, 8 to MOST bytes; the same whenever it is asked for. */
function createMessages(seed) {
  const random = createRandom(seed)
  const alphabet = 'ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789 ;=.'
  return n => {
    const length = random.integer(8, MOST)
    let text = `${n};`
    while (text.length < length) text += alphabet[random.integer(0, alphabet.length - 1)]
    return text
  }
}

/**
 * @param {{ flow: 'dc'|'dtr'|'none', bytes: number, byteRate?: number, latency?: number, room?: number, seed?: number }} options byteRate: bytes/s
 *   that the program takes; latency: ms that the adapter keeps what the C24 says; room: what the port believes
 * @returns {Promise<any>} `sent`: messages, `bytes`, `outcomes` (counted), `lost`, `wrong`: messages at the other side, `heard`: whether all came that
 *   the C24 said, `counts` of the C24, `stats` of the line, `seconds` of virtual time, `sioError`
 */
async function runFlow({ flow, bytes, byteRate = 1000, latency = 0, room, seed = 1 }) {
  const clock = createVirtualClock()
  const given = createMessages(seed)
  const awaited = new Map()
  const result = { sent: 0, bytes: 0, taken: 0, lost: 0, wrong: 0, outcomes: /** @type {any} */ ({}) }
  const c24 = createMelsecC24({
    clock,
    baudRate: BAUD,
    flow: FLOWS[flow].module,
    byteRate,
    speaks: { every: 500, value: n => `STATE ${n}` },
    onMessage: message => judge(result, awaited, message)
  })
  const wire = createWire({ clock, baudRate: BAUD, duplex: 'full' })
  wire.add(c24)
  const pool = createPool({ clock, random: () => 0.5 })
  const line = {
    transport: 'simulated',
    path: 'sim',
    wire: late(wire, { clock, latency }),
    baudRate: BAUD,
    echo: 'off',
    ...FLOWS[flow].line
  }
  const lease = pool.open(line, { id: 'a', name: 'flow' })
  const port = createC24Port({ lease, clock, room, ...FLOWS[flow].port })
  const heard = []
  port.listen(({ value }) => heard.push(value))

  const sender = async () => {
    while (result.bytes < bytes) {
      const number = result.sent++
      const text = given(number)
      awaited.set(number, text)
      result.bytes += text.length + 2
      const { outcome } = await port.send(text)
      result.outcomes[outcome] = (result.outcomes[outcome] ?? 0) + 1
    }
  }
  await clock.run(Promise.all(Array.from({ length: AT_ONCE }, sender)))
  const seconds = clock.now() / 1000
  // the program takes what is left in the OS area
  await clock.advance(20000)
  const spoken = c24.sent.length
  const said = { first: heard[0], last: heard.at(-1), count: heard.length }
  const stats = lease.line.stats()
  c24.close()
  port.close()
  await clock.run(lease.release())
  await clock.drain()
  const { counts } = c24
  return { ...result, lost: awaited.size, spoken, said, counts, stats, seconds, sioError: c24.sioError() }
}

/** An adapter that collects what comes before it hands it over. */
const late = (wire, { clock, latency }) => ({
  ...wire,
  connect: handlers => {
    const data = bytes => void clock.setTimer(() => handlers.data(bytes), latency)
    return wire.connect(latency > 0 ? { ...handlers, data } : handlers)
  }
})

/** Every message is as it was sent, and none comes before one that was sent earlier. */
function judge(result, awaited, { bytes }) {
  const text = bytes.toString('latin1')
  const number = Number(/^(\d+);/.exec(text)?.[1] ?? NaN)
  if (awaited.get(number) !== text || number < result.taken) result.wrong++
  else {
    awaited.delete(number)
    result.taken = number
  }
}

module.exports = { runFlow }
