'use strict'

/** `npm run simulate -- nx --pty LINK`: simulated stations for any program that can open a serial port or a TCP connection. */

const { parseArgs } = require('node:util')
const sim = require('../lib/sim')
const { PlcError } = require('../lib/error')

const OPTIONS = {
  pty: { type: 'string', argument: 'LINK', text: 'offer a virtual serial port under this name' },
  tcp: { type: 'string', argument: 'PORT', text: 'offer a serial server on this TCP port (0 = a free one, printed)' },
  host: { type: 'string', argument: 'ADDRESS', text: 'address to listen on (127.0.0.1: this machine alone)' },
  stations: { type: 'string', argument: 'LIST', text: 'station numbers, 0 to 191 (1)' },
  baud: { type: 'string', argument: 'N', text: 'speed of the line in bit/s (19200)' },
  turnaround: { type: 'string', argument: 'MS', text: 'time a station takes before it answers (2)' },
  fault: { type: 'string', argument: 'LIST', text: 'kind:rate or kind:rate:number, with commas; kinds below' },
  protect: { type: 'string', argument: 'RANGE', text: 'memory that cannot be written: error 4, such as F0..F15,K0' },
  seed: { type: 'string', argument: 'N', text: 'repeats a run of faults (else a new one, printed)' },
  echo: { type: 'boolean', text: 'the adapter hears itself (2-wire)' },
  quiet: { type: 'boolean', text: 'no live values: memory starts at 0 and holds what is written' },
  help: { type: 'boolean', text: 'this text' }
}
const MOST_STATIONS = 64

function help() {
  const rows = Object.entries(OPTIONS).map(([name, { argument, text }]) => [
    `--${name}${argument ? ` ${argument}` : ''}`,
    text
  ])
  const faults = sim.faultKinds().map(({ kind, text }) => [kind, text])
  const table = list => list.map(([left, right]) => `  ${left.padEnd(18)} ${right}`).join('\n')
  return `Usage: npm run simulate -- nx (--pty LINK | --tcp PORT) [options]\n\nOptions:\n${table(rows)}\n\nFaults:\n${table(faults)}\n
Example: npm run simulate -- nx --pty ./plc --stations 1,2 --baud 38400 --fault late:0.02,crc:0.01 --seed 7`
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

function stationsOf(text) {
  const numbers = text
    .split(',')
    .map(part => whole({ stations: part }, 'stations', { standard: 1, least: 0, most: 191 }))
  if (new Set(numbers).size < numbers.length) throw bad('--stations', text, 'a number stands there twice')
  if (numbers.length > MOST_STATIONS) throw bad('--stations', text, `one network has at most ${MOST_STATIONS} stations`)
  return numbers
}

/**
 * The settings that a command line asks for.
 * @param {string[]} args
 * @throws {PlcError} BAD_SETTING
 */
function read(args) {
  const options = Object.fromEntries(Object.entries(OPTIONS).map(([name, { type }]) => [name, { type }]))
  let parsed
  try {
    parsed = parseArgs({ args, options: /** @type {any} */ (options), allowPositionals: true })
  } catch (/** @type {any} */ error) {
    throw bad('the command line', args.join(' '), error.message)
  }
  const { values, positionals } = /** @type {{ values: Record<string, any>, positionals: string[] }} */ (parsed)
  if (values.help) return { help: true }
  if (positionals.length !== 1 || positionals[0] !== 'nx') {
    throw bad('the device', positionals.join(' ') || 'missing', 'it must be nx')
  }
  if ((values.pty === undefined) === (values.tcp === undefined)) {
    throw bad('--pty, --tcp', values.pty === undefined ? 'missing' : 'both', 'give one of them')
  }
  if (values.pty === '') throw bad('--pty', '', 'it needs a name')
  return {
    pty: values.pty,
    port: whole(values, 'tcp', { standard: 0, least: 0, most: 65535 }),
    host: values.host,
    stations: stationsOf(values.stations ?? '1'),
    baudRate: whole(values, 'baud', { standard: 19200, least: 300, most: 1000000 }),
    turnaround: whole(values, 'turnaround', { standard: 2, least: 0, most: 60000 }),
    rates: sim.parseFaults(values.fault ?? ''),
    seed: whole(values, 'seed', { standard: sim.freshSeed(), least: 0, most: 0xffffffff }),
    protect: (values.protect ?? '').split(',').filter(Boolean),
    echo: values.echo ?? false,
    quiet: values.quiet ?? false
  }
}

async function main(args) {
  const settings = read(args)
  if (settings.help) return void console.log(help())
  const { stations, pty, port, host, baudRate, seed, rates = [] } = settings
  const { protect } = settings
  const { wire } = sim.createNxLine({ ...settings, stations: stations.map(station => ({ station, protect })) })
  const server = pty === undefined ? await sim.serveOnTcp({ wire, port, host }) : sim.serveOnPty({ wire, link: pty })
  const where = 'port' in server ? `tcp ${server.host}:${server.port}` : `pty ${server.path()}`
  const faults = rates.map(({ kind, rate, argument }) =>
    [kind, rate, argument].filter(each => each !== undefined).join(':')
  )
  console.log(
    `nx stations ${stations.join(',')} on ${where}, ${baudRate} bit/s, faults ${faults.join(',') || 'none'}, seed ${seed}`
  )
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
