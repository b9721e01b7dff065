'use strict'

/**
 * A flood of garbage at full rate, for a while, against each protocol and framing, over TCP and a pseudo-terminal: what it costs the process in memory
 * and in lag of its event loop.
 */

const { fork } = require('node:child_process')
const path = require('node:path')
const { monitorEventLoopDelay } = require('node:perf_hooks')
const { createC24Port, createChinoRegulator, createInconLink, createNxPlc, createPool } = require('../../lib')

const hex = text => Buffer.from(text, 'latin1').toString('hex')

const nx = own => lease => {
  const device = createNxPlc({ lease, station: 1, timeout: 200, ...own })
  device.subscribe({ items: ['M0..M15', 'K7'], interval: 50 }, () => {})
  return device
}
const chino = own => lease => {
  const device = createChinoRegulator({ lease, station: 1, timeout: 200, ...own })
  device.subscribe({ items: ['400001..400010', '300001'], interval: 50 }, () => {})
  return device
}
const listening = (make, own) => lease => {
  const device = make({ lease, ...own })
  let received = 0
  device.listen(() => received++)
  const sending = setInterval(() => void device.send('HELLO1'), 100)
  return {
    close: () => {
      clearInterval(sending)
      device.close()
    },
    received: () => received
  }
}

/** What is flooded: how it is opened, and what is worst for it beside noise, in hex. */
const TARGETS = {
  'NX, 2-step': { open: nx({}), worst: ['e001810f', 'c0'] },
  'NX, 4-step': { open: nx({ steps: 4 }), worst: ['e001810f'] },
  'MODBUS RTU': { open: chino({}), worst: ['0103140000', '01'] },
  'MODBUS ASCII': { open: chino({ protocol: 'ascii' }), worst: [hex(':'), hex(':010314')] },
  'C24, end code': { open: listening(createC24Port, {}), worst: [hex('A\r\n'), hex('A')] },
  'C24, frames': { open: listening(createC24Port, { first: '02', last: '03' }), worst: ['02', '024103'] },
  'C24, count': { open: listening(createC24Port, { framing: 'count', count: 2 }), worst: ['41'] },
  'C24, silence': { open: listening(createC24Port, { framing: 'gap', gap: 20 }), worst: ['41'] },
  'C24, ASCII-binary': { open: listening(createC24Port, { asciiBinary: true }), worst: [hex('410D0A')] },
  'C24, DC1/DC3': { open: listening(createC24Port, { flow: 'dc', room: 1000 }), worst: ['1311', '13'] },
  'C24, bidirectional': { open: listening(createC24Port, { bidirectional: true }), worst: ['0605', '05010041428400'] },
  INCON: { open: listening(createInconLink, {}), worst: [hex('A\n'), hex('\r')] },
  'INCON, UTF-8': { open: listening(createInconLink, { encoding: 'utf8' }), worst: ['ff0a'] },
  'INCON, checked': { open: listening(createInconLink, { checked: true }), worst: [hex('#01A*7F\n')] }
}

const collect = () => {
  require('node:v8').setFlagsFromString('--expose-gc')
  require('node:vm').runInNewContext('gc')()
  const { heapUsed, external } = process.memoryUsage()
  return heapUsed + external
}

const wait = ms => new Promise(resolve => setTimeout(resolve, ms))
const ms = nanoseconds => Math.round(nanoseconds / 1e4) / 100

/** Starts the flood in a process of its own. */
const startFlooder = async (transport, pattern) => {
  const child = fork(path.join(__dirname, 'flooder.js'), [transport, pattern], { stdio: 'inherit' })
  const where = await new Promise(resolve => child.once('message', resolve))
  const stop = async () => {
    const ended = new Promise(resolve => child.once('exit', resolve))
    child.kill()
    await ended
  }
  return { child, where, stop }
}

/**
 * @param {{ target: string, transport: 'tcp'|'pty', pattern: string, seconds: number }} options
 * @returns {Promise<{ lag: number, most: number, grown: number, rate: number, cpu: number, received?: number }>} lag: p99, ms; most: ms; grown: MB
 *   after the flood; peak: MB of heap and buffers while it lasted, above the start; rate: MB/s taken; cpu: share of a core
 */
const flood = async ({ target, transport, pattern, seconds }) => {
  const { child, where, stop } = await startFlooder(transport, pattern)
  const pool = createPool()
  const host =
    transport === 'tcp' ? { transport: 'tcp', host: '127.0.0.1', ...where } : { transport: 'serial', ...where }
  const lease = pool.open({ ...host, baudRate: 115200 }, { id: 'a', name: 'a' })
  const device = TARGETS[target].open(lease)
  while (lease.line.state === 'opening') await wait(5)
  const before = collect()
  const from = { bytes: lease.line.stats().bytesIn, cpu: process.cpuUsage(), at: performance.now() }
  const delay = monitorEventLoopDelay({ resolution: 1 })
  delay.enable()
  child.send('begin')
  let peak = 0
  const memory = setInterval(() => {
    const { heapUsed, external } = process.memoryUsage()
    peak = Math.max(peak, heapUsed + external - before)
  }, 100)
  await wait(seconds * 1000)
  clearInterval(memory)
  delay.disable()
  const took = performance.now() - from.at
  const cpu = process.cpuUsage(from.cpu)
  const rate = (lease.line.stats().bytesIn - from.bytes) / took / 1000
  const received = device.received?.()
  device.close()
  await lease.release()
  await stop()
  const grown = collect() - before
  const tenth = value => Math.round(value * 10) / 10
  return {
    lag: ms(delay.percentile(99)),
    most: ms(delay.max),
    grown: tenth(grown / 1e6),
    peak: tenth(peak / 1e6),
    rate: Math.round(rate * 100) / 100,
    cpu: tenth((cpu.user + cpu.system) / took / 1000),
    ...(received === undefined ? {} : { received })
  }
}

module.exports = { TARGETS, flood }
