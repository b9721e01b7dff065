'use strict'

/** `npm run simulate -- nx --pty LINK`: simulated stations for any program that can open a serial port or a TCP connection. */

const { parseArgs } = require('node:util')
const sim = require('../lib/sim')
const { PlcError } = require('../lib/error')

const DEVICES = Object.fromEntries(sim.simulatedDevices().map(({ device, ...row }) => [device, row]))
const MIXED = 'mixed'
const [NX, CHINO] = Object.values(DEVICES)
const span = ({ least, most }) => `${least} to ${most}`

/** The devices of the command line, for the help. */
const COMMANDS = {
  nx: 'OE MAX NX PLCs',
  chino: 'CHINO thyristor regulators (MODBUS), each with a heater',
  mixed: 'both on one line'
}

/** All options: how they are read, what the help says, and which commands have them (all, if none is named). */
const OPTIONS = {
  pty: { type: 'string', argument: 'LINK', text: 'offer a virtual serial port under this name' },
  tcp: { type: 'string', argument: 'PORT', text: 'offer a serial server on this TCP port (0 = a free one, printed)' },
  host: { type: 'string', argument: 'ADDRESS', text: 'address to listen on (127.0.0.1: this machine alone)' },
  stations: {
    type: 'string',
    argument: 'LIST',
    text: `station numbers: nx ${span(NX)} (1), chino ${span(CHINO)} (1), mixed as in nx:1,chino:11`
  },
  protocol: {
    type: 'string',
    argument: 'NAME',
    text: 'what regulators speak: rtu or ascii (rtu)',
    only: ['chino', MIXED]
  },
  baud: { type: 'string', argument: 'N', text: 'speed of the line in bit/s (19200)' },
  turnaround: { type: 'string', argument: 'MS', text: 'time a station takes before it answers (2)' },
  fault: { type: 'string', argument: 'LIST', text: 'kind:rate or kind:rate:number, with commas; kinds below' },
  protect: {
    type: 'string',
    argument: 'RANGE',
    text: 'memory that cannot be written, such as F0..F15,K0 (error 4) or 400010..400019,co5 (exception 03)'
  },
  seed: { type: 'string', argument: 'N', text: 'repeats a run of faults (else a new one, printed)' },
  echo: { type: 'boolean', text: 'the adapter hears itself (2-wire)' },
  quiet: { type: 'boolean', text: 'no live values: memory starts at 0 and holds what is written' },
  help: { type: 'boolean', text: 'this text' }
}
const MOST_STATIONS = 64

function help() {
  const options = Object.entries(OPTIONS).map(([name, { argument, text, only }]) => [
    `--${name}${argument ? ` ${argument}` : ''}`,
    only ? `${text}; ${only.join(' and ')} alone` : text
  ])
  const faults = sim.faultKinds().map(({ kind, text }) => [kind, text])
  const table = list => list.map(([left, right]) => `  ${left.padEnd(18)} ${right}`).join('\n')
  return `Usage: npm run simulate -- (${Object.keys(COMMANDS).join(' | ')}) (--pty LINK | --tcp PORT) [options]

Devices:
${table(Object.entries(COMMANDS))}

Options:
${table(options)}

Faults:
${table(faults)}

Examples: npm run simulate -- nx --pty ./plc --stations 1,2 --baud 38400 --fault late:0.02,crc:0.01 --seed 7
          npm run simulate -- chino --tcp 4002 --stations 11,12 --protocol ascii
          npm run simulate -- mixed --pty ./line --stations nx:1,chino:11,chino:12`
}

const bad = (setting, value, reason) => new PlcError('BAD_SETTING', { setting, value, reason })

function whole(values, name, { standard, least, most }) {
  const text = values[name]
  if (text === undefined) return standard
  const value = /^\d{1,10}$/.test(text.trim()) ? Number(text) : NaN
  if (!(value >= least && value <= most))
    throw bad(`--${name}`, text, `it must be a whole number from ${least} to ${most}`)
  return value
}

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

function parse(args) {
  const options = Object.fromEntries(Object.entries(OPTIONS).map(([name, { type }]) => [name, { type }]))
  try {
    return /** @type {{ values: Record<string, any>, positionals: string[] }} */ (
      parseArgs({ args, options: /** @type {any} */ (options), allowPositionals: true })
    )
  } catch (/** @type {any} */ error) {
    throw bad('the command line', args.join(' '), error.message)
  }
}

function checkCommand(values, positionals) {
  const [command] = positionals
  if (positionals.length !== 1 || !Object.hasOwn(COMMANDS, command)) {
    const known = Object.keys(COMMANDS)
    throw bad(
      'the device',
      positionals.join(' ') || 'missing',
      `it must be ${known.slice(0, -1).join(', ')} or ${known.at(-1)}`
    )
  }
  for (const [name, { only }] of Object.entries(OPTIONS)) {
    if (only && !only.includes(command) && values[name] !== undefined)
      throw bad(`--${name}`, values[name], `${command} has no such option`)
  }
  if ((values.pty === undefined) === (values.tcp === undefined)) {
    throw bad('--pty, --tcp', values.pty === undefined ? 'missing' : 'both', 'give one of them')
  }
  if (values.pty === '') throw bad('--pty', '', 'it needs a name')
  return command
}

function protocolOf(text = 'rtu') {
  if (text === 'rtu' || text === 'ascii') return text
  throw bad('--protocol', text, 'it must be rtu or ascii')
}

/**
 * The settings that a command line asks for.
 * @param {string[]} args
 * @throws {PlcError} BAD_SETTING
 */
function read(args) {
  const { values, positionals } = parse(args)
  if (values.help) return { help: true }
  const command = checkCommand(values, positionals)
  const rows = stationsOf(values.stations ?? (command === MIXED ? 'nx:1,chino:11' : '1'), command)
  const errors = Math.min(...rows.map(({ device }) => DEVICES[device].errors))
  return {
    command,
    pty: values.pty,
    port: whole(values, 'tcp', { standard: 0, least: 0, most: 65535 }),
    host: values.host,
    stations: protectionOf(values.protect ?? '', rows, command),
    protocol: protocolOf(values.protocol),
    baudRate: whole(values, 'baud', { standard: 19200, least: 300, most: 1000000 }),
    turnaround: whole(values, 'turnaround', { standard: 2, least: 0, most: 60000 }),
    rates: sim.parseFaults(values.fault ?? '', { errors }),
    seed: whole(values, 'seed', { standard: sim.freshSeed(), least: 0, most: 0xffffffff }),
    echo: values.echo ?? false,
    quiet: values.quiet ?? false
  }
}

/** `chino stations 11,12 (rtu) on pty ./line, 19200 bit/s, faults none, seed 7` */
function summary({ command, stations, protocol, baudRate, rates, seed }, where) {
  const numbers = stations.map(({ device, station }) => (command === MIXED ? `${device}:${station}` : station))
  const spoken = command === 'nx' ? '' : ` (${protocol})`
  const faults = rates.map(({ kind, rate, argument }) =>
    [kind, rate, argument].filter(each => each !== undefined).join(':')
  )
  const list = faults.join(',') || 'none'
  return `${command} stations ${numbers.join(',')}${spoken} on ${where}, ${baudRate} bit/s, faults ${list}, seed ${seed}`
}

async function main(args) {
  const settings = /** @type {any} */ (read(args))
  if (settings.help) return void console.log(help())
  const { pty, port, host } = settings
  const { wire } = sim.createLine(settings)
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
