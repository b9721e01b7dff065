'use strict'

/**
 * Reads of holding registers on a line that keeps the pace of 9600 bit/s, by our device, by modbus-serial alone and by jsmodbus, in turn on the same
 * port in the same run: processor time and cycle time of one request.
 *
 * The bytes arrive one by one, or 16 at once as some adapters deliver them. The peers wake for each arrival, we for a whole answer; what we check
 * and plan beside that costs about a millisecond, which short answers in 16s do not win back. Our cycle has the 3.5 characters of silence that RTU
 * asks for and the peers do not keep, and up to 2 ms of two rounded timers.
 */
const jsmodbus = require('jsmodbus')
const ModbusRTU = require('modbus-serial')
const { SerialPort } = require('serialport')
const { openChinoRegulator } = require('../../lib')
const { startFarEnd } = require('../far-end')

const BAUD = 9600
const STATION = 11
const TURNAROUND = 5
const ROUNDS = 3
const WARM_UP = 3
const TIMEOUT = 2000

const CHARACTER = 10000 / BAUD
const SILENCE = 3.5 * CHARACTER
/** Bytes that arrive at once; registers; requests in a round; the most that our processor time may be of the peers'. */
const CASES = [
  { chunk: 1, count: 10, requests: 40, most: 1.2 },
  { chunk: 1, count: 125, requests: 8, most: 0.25 },
  { chunk: 16, count: 10, requests: 40, most: 2.5 },
  { chunk: 16, count: 125, requests: 8, most: 1 }
]
const TIMERS = 2
/** The noise of the cycle's measurement. */
const NOISE = 1.02

const wireTime = count => (8 + 5 + 2 * count) * CHARACTER + TURNAROUND
const slowest = count => Number((((wireTime(count) + SILENCE + TIMERS) / wireTime(count)) * NOISE).toFixed(3))

const CLIENTS = {
  async ours(link) {
    const device = openChinoRegulator({ path: link, baudRate: BAUD, station: STATION, timeout: TIMEOUT })
    const read = async count => {
      const [{ value, quality, text }] = await device.read([`hr0..hr${count - 1}`])
      if (quality !== 'good') throw new Error(text)
      return value.length
    }
    return { read, close: () => device.close() }
  },
  async 'modbus-serial'(link) {
    const client = new ModbusRTU()
    await client.connectRTUBuffered(link, { baudRate: BAUD })
    client.setID(STATION)
    client.setTimeout(TIMEOUT)
    const read = async count => (await client.readHoldingRegisters(0, count)).data.length
    return { read, close: () => new Promise(resolve => client.close(resolve)) }
  },
  async jsmodbus(link) {
    const port = new SerialPort({ path: link, baudRate: BAUD })
    const client = new jsmodbus.client.RTU(port, STATION, TIMEOUT)
    await new Promise((resolve, reject) => port.once('open', resolve).once('error', reject))
    const read = async count => (await client.readHoldingRegisters(0, count)).response.body.valuesAsArray.length
    return { read, close: () => new Promise(resolve => port.close(resolve)) }
  }
}

/** Milliseconds of processor and of time per request. */
async function measure(name, link, { count, requests }) {
  const client = await CLIENTS[name](link)
  const once = async () => {
    if ((await client.read(count)) !== count) throw new Error(`${name} gave no values`)
  }
  try {
    for (let n = 0; n < WARM_UP; n++) await once()
    const cpu = process.cpuUsage()
    const from = performance.now()
    for (let n = 0; n < requests; n++) await once()
    const cycle = (performance.now() - from) / requests
    const { user, system } = process.cpuUsage(cpu)
    return { cpu: (user + system) / 1000 / requests, cycle }
  } finally {
    await client.close()
  }
}

/** All clients in turn, some rounds; the best of each: what else the machine does only adds. */
async function measureAll(each) {
  const { chunk } = each
  const stations = [{ device: 'chino', station: STATION }]
  const far = await startFarEnd({ stations, baudRate: BAUD, turnaround: TURNAROUND, quiet: true, chunk })
  const names = Object.keys(CLIENTS)
  const seen = Object.fromEntries(names.map(name => [name, []]))
  try {
    for (let round = 0; round < ROUNDS; round++)
      for (const name of names) seen[name].push(await measure(name, far.link, each))
  } finally {
    await far.close()
  }
  const of = (name, what) => Math.min(...seen[name].map(row => row[what]))
  return Object.fromEntries(names.map(name => [name, { cpu: of(name, 'cpu'), cycle: of(name, 'cycle') }]))
}

async function* rows() {
  for (const each of CASES) {
    const { ours, ...peers } = await measureAll(each)
    const { chunk, count, most } = each
    const name = `${count} registers at ${BAUD} bit/s, ${chunk === 1 ? 'byte by byte' : `${chunk} bytes at once`}`
    for (const [against, peer] of Object.entries(peers)) {
      const row = what => ({ name: `${name}, ${what}`, unit: 'ms', against })
      yield { ...row('processor'), value: ours.cpu, ratio: ours.cpu / peer.cpu, goal: ['<=', most] }
      yield { ...row('cycle'), value: ours.cycle, ratio: ours.cycle / peer.cycle, goal: ['<=', slowest(count)] }
    }
  }
}

module.exports = { rows }
