'use strict'

/** `npm run simulate -- nx --pty LINK`: simulated stations for any program that can open a serial port or a TCP connection. */

const sim = require('../lib/sim')
const { PlcError } = require('../lib/error')
const { bad, checkCommand, DEVICES, help, MIXED, oneOf, parse, SPEAKING, wearOf, whole } = require('./simulate-options')
const { describePeer, makePeer, readPeer } = require('./simulate-peers')

const MOST_STATIONS = 64

/** The rows of a line's stations, as lib/sim/line.js takes them. */
function stationsOf(text, command) {
  const rows = text.split(',').map(part => stationOf(part, command))
  const numbers = rows.map(({ station }) => station)
  if (new Set(numbers).size < numbers.length) throw bad('--stations', text, 'a number stands there twice')
  if (numbers.length > MOST_STATIONS) throw bad('--stations', text, `one network has at most ${MOST_STATIONS} stations`)
  return rows
}

function stationOf(part, command) {
  const [device, number, more] = command === MIXED ? part.trim().split(':') : [command, part]
  if (!Object.hasOwn(DEVICES, device) || number === undefined || more !== undefined) {
    throw bad('--stations', part, 'it must be nx:NUMBER or chino:NUMBER')
  }
  const { least, most } = DEVICES[device]
  return { device, station: whole({ stations: number }, 'stations', { standard: 1, least, most }) }
}

const isModbus = text => /^(\d|(co|di|ir|hr)\d)/i.test(text)

/** On a mixed line each station gets the ranges of its own notation. */
function protectionOf(text, rows, command) {
  const ranges = text.split(',').filter(Boolean)
  return rows.map(row => {
    const own = ranges.filter(range => command !== MIXED || isModbus(range.trim()) === (row.device === 'chino'))
    return { ...row, protect: own }
  })
}

/**
 * The settings that a command line asks for.
 * @param {string[]} args
 * @returns {any}
 * @throws {PlcError} BAD_SETTING
 */
function read(args) {
  const { values, positionals } = parse(args)
  if (values.help) return { help: true }
  const command = checkCommand(values, positionals)
  return {
    command,
    pty: values.pty,
    port: whole(values, 'tcp', { standard: 0, least: 0, most: 65535 }),
    host: values.host,
    baudRate: whole(values, 'baud', { standard: 19200, least: 300, most: 1000000 }),
    wear: wearOf(values.wear),
    seed: whole(values, 'seed', { standard: sim.freshSeed(), least: 0, most: 0xffffffff }),
    echo: values.echo ?? false,
    quiet: values.quiet ?? false,
    ...(SPEAKING.includes(command) ? readPeer(command, values) : readStations(command, values))
  }
}

function readStations(command, values) {
  const rows = stationsOf(values.stations ?? (command === MIXED ? 'nx:1,chino:11' : '1'), command)
  const errors = Math.min(...rows.map(({ device }) => DEVICES[device].errors))
  return {
    stations: protectionOf(values.protect ?? '', rows, command),
    protocol: oneOf(values, 'protocol', ['rtu', 'ascii']),
    turnaround: whole(values, 'turnaround', { standard: 2, least: 0, most: 60000 }),
    rates: sim.parseFaults(values.fault ?? '', { errors })
  }
}

/** `chino stations 11,12 (rtu) on pty ./line, 19200 bit/s, faults none, seed 7` */
function summary(settings, where) {
  const { baudRate, rates, seed } = settings
  const faults = rates.map(({ kind, rate, argument }) =>
    [kind, rate, argument].filter(each => each !== undefined).join(':')
  )
  const list = faults.join(',') || 'none'
  return `${described(settings)} on ${where}, ${baudRate} bit/s, faults ${list}, seed ${seed}`
}

function described(settings) {
  const { command, stations, protocol } = settings
  if (SPEAKING.includes(command)) return `${command} ${describePeer(settings)}`
  const numbers = stations.map(({ device, station }) => (command === MIXED ? `${device}:${station}` : station))
  return `${command} stations ${numbers.join(',')}${command === 'nx' ? '' : ` (${protocol})`}`
}

async function main(args) {
  const settings = /** @type {any} */ (read(args))
  if (settings.help) return void console.log(help())
  const { pty, port, host } = settings
  const { wire } = SPEAKING.includes(settings.command) ? makePeer(settings) : sim.createLine(settings)
  const server = pty === undefined ? await sim.serveOnTcp({ wire, port, host }) : sim.serveOnPty({ wire, link: pty })
  const where = 'port' in server ? `tcp ${server.host}:${server.port}` : `pty ${server.path()}`
  console.log(summary(settings, where))
  await new Promise(resolve => {
    for (const signal of ['SIGINT', 'SIGTERM', 'SIGHUP']) process.once(signal, resolve)
  })
  await server.close()
  process.exit(0)
}

if (require.main === module) {
  main(process.argv.slice(2)).catch(error => {
    console.error(error instanceof PlcError ? `${error.message}\nTry --help.` : error)
    process.exitCode = error instanceof PlcError ? 2 : 1
  })
}

module.exports = { read }
