'use strict'

/** The command line of the simulator: one table, from which it is read and its help is made. */

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
  mixed: 'both on one line',
  c24: 'a MELSEC-Q serial module with free messages (RS-232)',
  incon: 'an INCON-M84/M86/M86R with its serial link (RS-485)'
}
const POLLED = ['nx', 'chino', MIXED]
const SPEAKING = ['c24', 'incon']

/** All options: how they are read, what the help says, and which commands have them (all, if none is named). */
const OPTIONS = {
  pty: { type: 'string', argument: 'LINK', text: 'offer a virtual serial port under this name' },
  tcp: { type: 'string', argument: 'PORT', text: 'offer a serial server on this TCP port (0 = a free one, printed)' },
  host: { type: 'string', argument: 'ADDRESS', text: 'address to listen on (127.0.0.1: this machine alone)' },
  stations: {
    type: 'string',
    argument: 'LIST',
    text: `station numbers: nx ${span(NX)} (1), chino ${span(CHINO)} (1), mixed as in nx:1,chino:11`,
    only: POLLED
  },
  protocol: {
    type: 'string',
    argument: 'NAME',
    text: 'regulators: rtu or ascii (rtu); c24: non-procedure or bidirectional (non-procedure)',
    only: ['chino', MIXED, 'c24']
  },
  baud: { type: 'string', argument: 'N', text: 'speed of the line in bit/s (19200)' },
  turnaround: {
    type: 'string',
    argument: 'MS',
    text: 'time a station takes before it answers (2)',
    only: [...POLLED, 'c24']
  },
  fault: { type: 'string', argument: 'LIST', text: 'kind:rate or kind:rate:number, with commas; kinds below' },
  wear: { type: 'string', argument: 'LIST', text: 'rates of single bytes, both ways: damaged:0.001,lost:0.001' },
  protect: {
    type: 'string',
    argument: 'RANGE',
    text: 'memory that cannot be written, such as F0..F15,K0 (error 4) or 400010..400019,co5 (exception 03)',
    only: POLLED
  },
  unit: { type: 'string', argument: 'NAME', text: 'word or byte: of counts and lengths (word)', only: ['c24'] },
  end: {
    type: 'string',
    argument: 'HEX',
    text: 'receive complete code, up to 2 bytes ("0D 0A"; "" none)',
    only: ['c24']
  },
  count: { type: 'string', argument: 'N', text: 'receive data count in units (511)', only: ['c24'] },
  timer0: {
    type: 'string',
    argument: 'N',
    text: 'pause that ends a message, in bytes of 12 bits (0: none does)',
    only: ['c24']
  },
  flow: { type: 'string', argument: 'NAME', text: 'none or dc: DC1/DC3 (none)', only: ['c24'] },
  transparent: { type: 'string', argument: 'HEX', text: 'transparent code (none)', only: ['c24'] },
  'ascii-binary': { type: 'boolean', text: 'data are two hex characters a byte', only: ['c24'] },
  rate: { type: 'string', argument: 'N', text: 'messages/s that the sequence program takes (all)', only: ['c24'] },
  'byte-rate': { type: 'string', argument: 'N', text: 'the same in bytes/s', only: ['c24'] },
  scan: { type: 'string', argument: 'MS', text: 'from one scan of its PLC to the next (10)', only: ['incon'] },
  checked: { type: 'boolean', text: 'lines with number and check', only: ['incon'] },
  acknowledge: { type: 'boolean', text: 'these, acknowledged and repeated', only: ['incon'] },
  clears: {
    type: 'string',
    argument: 'NAME',
    text: 'what its sending program clears: finish, as the text says, or length, as the example does (finish)',
    only: ['incon']
  },
  echo: { type: 'boolean', text: 'the adapter hears itself (2-wire)', only: [...POLLED, 'incon'] },
  answer: {
    type: 'string',
    argument: 'NAME',
    text: 'what the program does with messages: none, echo (none)',
    only: SPEAKING
  },
  every: { type: 'string', argument: 'MS', text: 'from one message of its own to the next (1000)', only: SPEAKING },
  show: { type: 'boolean', text: 'print what the program takes', only: SPEAKING },
  seed: { type: 'string', argument: 'N', text: 'repeats a run of faults (else a new one, printed)' },
  quiet: {
    type: 'boolean',
    text: 'no live values: memory starts at 0 and holds what is written; no messages of its own'
  },
  help: { type: 'boolean', text: 'this text' }
}

function help() {
  const options = Object.entries(OPTIONS).map(([name, { argument, text, only }]) => [
    `--${name}${argument ? ` ${argument}` : ''}`,
    only ? `${text}; ${only.join(', ')} alone` : text
  ])
  const faults = sim.faultKinds().map(({ kind, text }) => [kind, text])
  const table = list => list.map(([left, right]) => `  ${left.padEnd(18)} ${right}`).join('\n')
  return `Usage: npm run simulate -- (${Object.keys(COMMANDS).join(' | ')}) (--pty LINK | --tcp PORT) [options]

Devices:
${table(Object.entries(COMMANDS))}

Options:
${table(options)}

Faults (of answers; c24 and incon: of messages):
${table(faults)}

Examples: npm run simulate -- nx --pty ./plc --stations 1,2 --baud 38400 --fault late:0.02,crc:0.01 --seed 7
          npm run simulate -- chino --tcp 4002 --stations 11,12 --protocol ascii
          npm run simulate -- mixed --pty ./line --stations nx:1,chino:11,chino:12
          npm run simulate -- c24 --pty ./c24 --flow dc --rate 5 --show
          npm run simulate -- incon --pty ./incon --scan 20 --answer echo`
}

const bad = (setting, value, reason) => new PlcError('BAD_SETTING', { setting, value, reason })

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

function whole(values, name, { standard, least, most }) {
  const text = values[name]
  if (text === undefined) return standard
  const value = /^\d{1,10}$/.test(text.trim()) ? Number(text) : NaN
  if (!(value >= least && value <= most))
    throw bad(`--${name}`, text, `it must be a whole number from ${least} to ${most}`)
  return value
}

function oneOf(values, name, list) {
  const text = values[name] ?? list[0]
  if (list.includes(text)) return text
  throw bad(`--${name}`, text, `it must be ${list.join(' or ')}`)
}

/** `damaged:0.001,lost:0.001` */
function wearOf(text) {
  if (text === undefined) return null
  const pairs = text.split(',').map(part => /^(damaged|lost):(0?\.\d+|[01])$/.exec(part.trim()))
  const wear = Object.fromEntries(pairs.map(pair => [pair?.[1], Number(pair?.[2])]))
  const { damaged = 0, lost = 0 } = wear
  if (pairs.every(Boolean) && damaged + lost <= 1) return { damaged, lost }
  throw bad('--wear', text, 'it must be damaged:RATE, lost:RATE or both; the rates are 0 to 1')
}

module.exports = { bad, checkCommand, DEVICES, help, MIXED, oneOf, parse, SPEAKING, wearOf, whole }
