'use strict'

/**
 * MODBUS stations made by others, with a way of their own to their registers. A slave is `{ line, get, set, refuse, log, absent, stop }`:
 * `line` are settings for our line; `log()` what was carried out since the last time, as `[station, function, base, count]`.
 */

const { spawn } = require('node:child_process')
const fs = require('node:fs')
const path = require('node:path')
const readline = require('node:readline')
const ServerSerial = require('modbus-serial').ServerSerial
const { until } = require('../support/node-red.js')
const { root } = require('../support/source.js')
const { temporary } = require('./support.js')

const BAUD = 115200

/** The Python that has pymodbus: .ci/run makes it. */
const python = () => process.env.SERIAL_PLC_PYTHON || path.join(root, '.cache', 'python', 'bin', 'python')

const ended = child => new Promise(resolve => child.once('exit', resolve).once('error', resolve))

/** Two virtual serial ports with a wire between them. */
async function socatPair() {
  const folder = temporary('pair-')
  const [ours, theirs] = ['ours', 'theirs'].map(name => path.join(folder, name))
  const child = spawn('socat', [`pty,raw,echo=0,link=${ours}`, `pty,raw,echo=0,link=${theirs}`], { stdio: 'inherit' })
  let failed = null
  child.once('error', error => (failed = error))
  const over = ended(child)
  await until(() => failed || (fs.existsSync(ours) && fs.existsSync(theirs)), { what: () => 'socat' })
  if (failed) throw failed
  return {
    ours,
    theirs,
    stop: async () => {
      child.kill('SIGTERM')
      await over
    }
  }
}

/** A process that answers each JSON line with one. */
function talkTo(command, args) {
  const child = spawn(command, args, { stdio: ['pipe', 'pipe', 'pipe'] })
  const over = ended(child)
  const waiting = []
  let errors = ''
  child.stderr.on('data', bytes => (errors = (errors + bytes).slice(-2000)))
  child.stdin.on('error', () => {})
  readline.createInterface({ input: child.stdout }).on('line', text => waiting.shift()?.resolve(JSON.parse(text)))
  const next = () => new Promise((resolve, reject) => waiting.push({ resolve, reject }))
  over.then(code => {
    for (const { reject } of waiting.splice(0)) reject(new Error(`${command} ended (${code}): ${errors}`))
  })
  return {
    first: next(),
    ask: async order => {
      const answer = next()
      child.stdin.write(`${JSON.stringify(order)}\n`)
      const { is, error } = await answer
      if (error) throw new Error(error)
      return is
    },
    stop: () => {
      child.stdin.end()
      return over
    }
  }
}

/** pymodbus as one or more stations, RTU or ASCII, on a virtual serial port or behind TCP. */
async function startPymodbus({ framer, tcp, stations }) {
  const pair = tcp ? null : await socatPair()
  const where = pair ? ['--port', pair.theirs] : ['--tcp']
  const script = path.join(__dirname, 'pymodbus_slave.py')
  const child = talkTo(python(), [script, '--framer', framer, '--stations', stations.join(','), ...where])
  const { ready } = await child.first
  return {
    line: pair ? { path: pair.ours, baudRate: BAUD } : { host: '127.0.0.1', port: ready, baudRate: BAUD },
    get: (station, table, base, count) => child.ask({ do: 'get', station, table, base, count }),
    set: (station, table, base, values) => child.ask({ do: 'set', station, table, base, values }),
    refuse: refusal => child.ask({ do: 'refuse', ...refusal }),
    absent: silent => child.ask({ do: 'absent', silent }),
    log: () => child.ask({ do: 'log' }),
    stop: async () => {
      await child.stop()
      await pair?.stop()
    }
  }
}

const emptyStation = () => ({
  co: new Array(65536).fill(false),
  di: new Array(65536).fill(false),
  hr: new Array(65536).fill(0),
  ir: new Array(65536).fill(0)
})

/** The callbacks that modbus-serial's server asks, one value at a time. A station that is not there never calls back. */
function vectorOf(memory, refusalOf) {
  const reader = table => (at, unit, done) => {
    const station = memory.get(unit)
    if (!station) return
    const code = refusalOf(unit, at)
    if (code) done({ modbusErrorCode: code })
    else done(null, station[table][at])
  }
  const writer = table => (at, value, unit, done) => {
    if (unit === 0) return void [...memory.values()].forEach(station => (station[table][at] = value))
    const station = memory.get(unit)
    if (!station) return
    const code = refusalOf(unit, at)
    if (code) return done({ modbusErrorCode: code })
    station[table][at] = value
    done(null)
  }
  return {
    getCoil: reader('co'),
    getDiscreteInput: reader('di'),
    getHoldingRegister: reader('hr'),
    getInputRegister: reader('ir'),
    setCoil: writer('co'),
    setRegister: writer('hr')
  }
}

/** modbus-serial's server (RTU alone), in this process, on a pair of socat's ports. */
async function startServerSerial({ stations }) {
  const pair = await socatPair()
  const memory = new Map(stations.map(station => [station, emptyStation()]))
  const refusals = []
  let log = []
  const refusalOf = (unit, at) => {
    const row = refusals.find(({ station, base, times }) => station === unit && base === at && times > 0)
    if (row) row.times--
    return row?.code
  }
  // all units; what one read gives is one request
  const settings = { path: pair.theirs, baudRate: BAUD, unitID: 255, interval: 10 }
  const server = new ServerSerial(vectorOf(memory, refusalOf), settings)
  await new Promise(resolve => server.once('initialized', resolve))
  server._server.on('data', bytes => {
    const [station, fn] = bytes
    const count = fn === 5 || fn === 6 ? 1 : bytes.readUInt16BE(4)
    log.push([station, fn, bytes.readUInt16BE(2), count])
  })
  return {
    line: { path: pair.ours, baudRate: BAUD },
    get: async (station, table, base, count) => memory.get(station)[table].slice(base, base + count),
    set: async (station, table, base, values) =>
      values.forEach((value, n) => (memory.get(station)[table][base + n] = value)),
    refuse: async refusal => void refusals.push({ times: 1, ...refusal }),
    absent: null,
    log: async () => {
      const was = log
      log = []
      return was
    },
    stop: async () => {
      await new Promise(resolve => server.close(resolve))
      await pair.stop()
    }
  }
}

const SLAVES = [
  {
    name: 'pymodbus, RTU, serial',
    protocol: 'rtu',
    start: own => startPymodbus({ framer: 'rtu', tcp: false, ...own })
  },
  { name: 'pymodbus, RTU, TCP', protocol: 'rtu', start: own => startPymodbus({ framer: 'rtu', tcp: true, ...own }) },
  {
    name: 'pymodbus, ASCII, serial',
    protocol: 'ascii',
    start: own => startPymodbus({ framer: 'ascii', tcp: false, ...own })
  },
  {
    name: 'pymodbus, ASCII, TCP',
    protocol: 'ascii',
    start: own => startPymodbus({ framer: 'ascii', tcp: true, ...own })
  },
  { name: 'modbus-serial’s server, RTU, serial', protocol: 'rtu', start: startServerSerial }
]

module.exports = { SLAVES, python }
