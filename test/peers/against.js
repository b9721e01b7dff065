'use strict'

/**
 * The lines and faults of `npm run soak`, asked by another library in virtual time: one call after the other, as their manuals want it. A program
 * that polls: station by station, some blocks of one table and length, a write now and then. No adapter is unplugged, since they leave that to the
 * program. What ends a program (an exception in the port's listener) is counted; then, and after five errors in a row, the port is opened anew.
 */

const { EventEmitter } = require('node:events')
const ModbusRTU = require('modbus-serial')
const { createLine, createRandom, createVirtualClock } = require('../../lib/sim')
const { drawRun } = require('../simulation/soak.js')
const { isHeld, simulated } = require('../simulation/workload.js')
const { bindingTo, inVirtualTime } = require('./modbus-serial-peer.js')

const SEGMENT = 5000
const SET = 320
const SWITCHES = 2000
const BLOCKS = 4 // that are read of a station before the next one's turn
const PATIENCE = 5 // errors in a row, then a program opens its port anew
const TABLES = { hr: { unit: 'word', at: 0 }, ir: { unit: 'word', at: 0x10000 }, co: { unit: 'bit', at: 0x200000 } }

/** name -> protocols, and a client: `read(unit, table, base, count)`, `write(unit, table, base, value)`, `close()` */
const PEERS = {
  'modbus-serial': { protocols: ['rtu', 'ascii'], open: openModbusSerial },
  jsmodbus: { protocols: ['rtu'], open: openJsmodbus }
}

async function openModbusSerial(wire, { protocol, timeout, baudRate, crashes }) {
  const client = new ModbusRTU()
  const connect = protocol === 'rtu' ? 'connectRTUBuffered' : 'connectAsciiSerial'
  await client[connect]('virtual', { baudRate, binding: bindingTo(wire, crashes) })
  client.setTimeout(timeout)
  const calls = { hr: 'readHoldingRegisters', ir: 'readInputRegisters', co: 'readCoils' }
  return {
    read: async (unit, table, base, count) => {
      client.setID(unit)
      return (await client[calls[table]](base, count)).data.slice(0, count)
    },
    write: (unit, table, { base, value }) => {
      client.setID(unit)
      return table === 'co' ? client.writeCoil(base, value) : client.writeRegister(base, value)
    },
    close: () => new Promise(resolve => client.close(resolve))
  }
}

/** A client has one station, so several share the port. */
async function openJsmodbus(wire, { timeout, crashes }) {
  const { client } = require('jsmodbus')
  const port = Object.assign(new EventEmitter(), { isOpen: true })
  port.setMaxListeners(0)
  const data = bytes => {
    try {
      port.emit('data', bytes)
    } catch (error) {
      crashes.push(error)
    }
  }
  const end = wire.connect({ data, closed: () => {} })
  Object.assign(port, { write: (bytes, done) => (end.write(Buffer.from(bytes)), done?.()) })
  const clients = new Map()
  const of = unit => {
    if (!clients.has(unit)) clients.set(unit, new client.RTU(/** @type {any} */ (port), unit, timeout))
    return clients.get(unit)
  }
  const calls = { hr: 'readHoldingRegisters', ir: 'readInputRegisters', co: 'readCoils' }
  return {
    read: async (unit, table, base, count) => {
      const { response } = await of(unit)[calls[table]](base, count)
      return [...response.body.valuesAsArray].slice(0, count)
    },
    write: (unit, table, { base, value }) =>
      table === 'co' ? of(unit).writeSingleCoil(base, value) : of(unit).writeSingleRegister(base, value),
    close: async () => end.close()
  }
}

const emptyResult = ({ peer, protocol, seed }) => ({
  peer,
  protocol,
  exchanges: 0,
  values: 0,
  wrong: 0,
  confirmed: 0,
  wrongConfirmed: 0,
  doubledWrites: 0,
  errors: 0,
  crashes: 0,
  reopened: 0,
  seed
})

/**
 * @param {{ exchanges: number, seed: number, protocol: string, peer: string, mode?: string, tell?: (total: any) => void }} options
 * @returns {Promise<ReturnType<typeof emptyResult>>} `values` that were given as good, `wrong` of them; writes `confirmed`, and `wrongConfirmed` of these: not carried out
 */
async function against({ exchanges, seed, protocol, peer, mode = 'safety', tell = () => {} }) {
  const seeds = createRandom(seed)
  const result = emptyResult({ peer, protocol, seed })
  const size = Math.min(SEGMENT, exchanges)
  while (result.exchanges < exchanges) {
    const run = drawRun(seeds.integer(0, 2 ** 32 - 1), { protocol, mode, exchanges: size })
    await segment({ ...run, protocol, peer }, result)
    tell({ result })
  }
  return result
}

async function segment({ seed, protocol, peer, exchanges, stations: rows, pause, device, ...line }, result) {
  const random = createRandom(seed)
  const clock = createVirtualClock()
  const writes = new Map()
  const { echo, collisions, baudRate, faults: rates } = line
  const { wire, stations } = createLine({
    ...{ clock, echo, collisions, baudRate, rates, seed },
    chunk: () => Math.min(random.pick([1, 3, 16, 64]), Math.floor((16 * baudRate) / 10000)),
    stations: rows.map(row => simulated(row, writes))
  })
  const heard = () => stations.reduce((sum, { counts }) => sum + counts.queries, 0)
  const state = { rows, stations, clock, random, writes, result, serial: 0, failed: 0 }
  const crashes = /** @type {Error[]} */ ([])
  const options = { protocol, timeout: device.timeout, baudRate, crashes }
  const until = clock.now() + 2000 * exchanges
  const anew = async client => {
    if (crashes.length > 0) result.crashes++
    else if (state.failed < PATIENCE) return client
    else result.reopened++
    Object.assign(crashes, { length: 0 })
    state.failed = 0
    await client.close()
    return PEERS[peer].open(wire, options)
  }
  await inVirtualTime(clock, async () => {
    let client = await PEERS[peer].open(wire, options)
    for (const task of tasksOf(state)) {
      if (heard() >= exchanges || clock.now() >= until) break
      await ('value' in task ? write(state, client, task) : read(state, client, task))
      client = await anew(client)
      await new Promise(resolve => clock.setTimer(() => resolve(undefined), random.integer(0, pause)))
    }
    await client.close()
  })
  await clock.drain()
  for (const { times, confirmed } of writes.values()) {
    if (times > 1) result.doubledWrites++
    if (confirmed && times === 0) result.wrongConfirmed++
  }
  result.exchanges += heard()
}

/** Station by station: its blocks, and in a third of its turns a write. */
function* tasksOf({ rows, random }) {
  const lists = rows.map(({ station }) => {
    const table = random.pick(Object.keys(TABLES))
    const count = random.integer(1, 8)
    return Array.from({ length: BLOCKS }, () => ({ station, table, base: random.integer(0, 110), count }))
  })
  for (let n = 0; ; n++) {
    const { station } = rows[n % rows.length]
    yield* lists[n % rows.length]
    const table = random.pick(['hr', 'co'])
    if (random.chance(1 / 3) && table === 'hr') yield { station, table, base: SET + random.integer(0, 100), value: n }
    else if (random.chance(1 / 3)) yield { station, table, base: SWITCHES + n, value: true }
  }
}

async function read(state, client, { station, table, base, count }) {
  const { rows, stations, clock, result } = state
  const held = stations[rows.findIndex(row => row.station === station)]
  const { unit, at } = TABLES[table]
  const from = clock.now()
  const values = await client.read(station, table, base, count).catch(() => null)
  if (values === null) return failed(state)
  state.failed = 0
  values.forEach((value, n) => {
    result.values++
    const item = { unit, address: at + base + n, count: 1 }
    if (!isHeld(held, item, { value: unit === 'bit' ? Boolean(value) : value, from, to: clock.now() })) result.wrong++
  })
}

async function write(state, client, { station, table, base, value }) {
  const { writes, result } = state
  const key = table === 'hr' ? `${station}:hr${base}:${value}` : `${station}:co${base}`
  const confirmed = await client.write(station, table, { base, value }).then(
    () => true,
    () => false
  )
  writes.set(key, { times: 0, ...writes.get(key), confirmed })
  if (!confirmed) return failed(state)
  state.failed = 0
  result.confirmed++
}

function failed(state) {
  state.failed++
  state.result.errors++
}

module.exports = { PEERS, against }
