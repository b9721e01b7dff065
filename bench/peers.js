'use strict'

/**
 * Clients that read holding registers of one MODBUS RTU station over a serial port: ours, modbus-serial alone, jsmodbus, and pymodbus where it is
 * installed (`SERIAL_PLC_PYTHON` names its Python; else the one that the system tests set up).
 *
 * @typedef {{ link: string, baudRate: number, station: number, count: number }} Place
 * @typedef {(place: Place) => Promise<{ run: (requests: number) => Promise<{ cpu: number, cycle: number }>, close: () => Promise<any> }>} Client ms of
 *   processor and of time for one request
 */
const { spawn, spawnSync } = require('node:child_process')
const { once } = require('node:events')
const { existsSync } = require('node:fs')
const path = require('node:path')
const readline = require('node:readline')
const jsmodbus = require('jsmodbus')
const ModbusRTU = require('modbus-serial')
const { SerialPort } = require('serialport')
const { openChinoRegulator } = require('../lib')

const TIMEOUT = 2000

/** In this process: what it takes while it runs is what the client takes. */
const running = (read, count) => async requests => {
  const cpu = process.cpuUsage()
  const from = performance.now()
  for (let n = 0; n < requests; n++) if ((await read()) !== count) throw new Error('the answer has no values')
  const cycle = (performance.now() - from) / requests
  const { user, system } = process.cpuUsage(cpu)
  return { cpu: (user + system) / 1000 / requests, cycle }
}

/** @type {Client} */
const ours = async ({ link, baudRate, station, count }) => {
  const device = openChinoRegulator({ path: link, baudRate, station, timeout: TIMEOUT, latenessBound: 1 })
  const item = `hr0..hr${count - 1}`
  const read = async () => {
    const [{ value, quality, text }] = await device.read([item])
    if (quality !== 'good') throw new Error(text)
    return value.length
  }
  return { run: running(read, count), close: () => device.close() }
}

/** @type {Client} */
const modbusSerial = async ({ link, baudRate, station, count }) => {
  const client = new ModbusRTU()
  await client.connectRTUBuffered(link, { baudRate })
  client.setID(station)
  client.setTimeout(TIMEOUT)
  const read = async () => (await client.readHoldingRegisters(0, count)).data.length
  return { run: running(read, count), close: () => new Promise(resolve => client.close(resolve)) }
}

/** @type {Client} */
const jsModbus = async ({ link, baudRate, station, count }) => {
  const port = new SerialPort({ path: link, baudRate })
  const client = new jsmodbus.client.RTU(port, station, TIMEOUT)
  await new Promise((resolve, reject) => port.once('open', resolve).once('error', reject))
  const read = async () => (await client.readHoldingRegisters(0, count)).response.body.valuesAsArray.length
  return { run: running(read, count), close: () => new Promise(resolve => port.close(resolve)) }
}

const root = path.join(__dirname, '..')
const script = path.join(__dirname, 'pymodbus_client.py')

/** The Python that has pymodbus, or null. */
const findPython = () => {
  const candidates = [process.env.SERIAL_PLC_PYTHON, path.join(root, '.cache', 'python', 'bin', 'python'), 'python3']
  const has = python =>
    (!path.isAbsolute(python) || existsSync(python)) &&
    spawnSync(python, ['-c', 'import pymodbus.client, serial'], { stdio: 'ignore', timeout: 20000 }).status === 0
  return candidates.find(python => python && has(python)) ?? null
}

/** In a process of its own, which measures itself. @param {string} python @returns {Client} */
const pymodbus = python => async place => {
  const child = spawn(python, [script, JSON.stringify(place)], { stdio: ['pipe', 'pipe', 'inherit'] })
  const ended = once(child, 'exit')
  const lines = readline.createInterface({ input: child.stdout })[Symbol.asyncIterator]()
  const next = async () => {
    const { value, done } = await lines.next()
    if (done) throw new Error('pymodbus has ended')
    return JSON.parse(value)
  }
  await next()
  const run = requests => {
    child.stdin.write(`${requests}\n`)
    return next()
  }
  const close = () => {
    child.stdin.end()
    return ended
  }
  return { run, close }
}

/** All that are there; ours first. @returns {Record<string, Client>} */
const clients = () => {
  const python = findPython()
  return { ours, 'modbus-serial': modbusSerial, jsmodbus: jsModbus, ...(python ? { pymodbus: pymodbus(python) } : {}) }
}

module.exports = { clients }
