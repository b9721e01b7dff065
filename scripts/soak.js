'use strict'

/**
 * Whole lines with devices, polls and simulated stations, in virtual time, from a seed; whatever the faults are, no value may be wrong.
 *   npm run soak -- --exchanges 1000000 --seed 1 --protocol nx|rtu|ascii [--mode safety|liveness]
 *   npm run soak -- … --segment 17                          one of its systems alone, as a failure names it
 *   npm run soak -- … --against modbus-serial|jsmodbus      the same lines and faults, asked by another library (rtu; ascii: modbus-serial)
 * safety: up to 30 % of all answers are hit. liveness: all of 30 %, and every 500 exchanges the faults stop, and all must be well within its bound.
 * The last line is JSON. Exit code 1: something was wrong, unsettled, doubled or not back in time; 2: a wrong command line.
 */

const path = require('node:path')
const { parseArgs } = require('node:util')

const test = path.join(__dirname, '..', 'test')
const print = text => process.stdout.write(`${text}\n`)

const OPTIONS = /** @type {const} */ ({
  exchanges: { type: 'string', default: '100000' },
  seed: { type: 'string' },
  protocol: { type: 'string', default: 'nx' },
  mode: { type: 'string', default: 'safety' },
  segment: { type: 'string' },
  against: { type: 'string' }
})

class Usage extends Error {}

const whole = (name, text, [least, most]) => {
  const number = Number(text)
  if (/^\d+$/.test(text) && number >= least && number <= most) return number
  throw new Usage(`--${name} ${text}: a whole number from ${least} to ${most} is needed`)
}

const oneOf = (name, text, known) => {
  if (known.includes(text)) return text
  throw new Usage(`--${name} ${text}: known are ${known.join(', ')}`)
}

function read(args, { modes, protocols, peers, freshSeed }) {
  let values
  try {
    values = parseArgs({ args, options: OPTIONS, strict: true }).values
  } catch (/** @type {any} */ error) {
    throw new Usage(error.message)
  }
  const { exchanges, seed, protocol, mode, segment, against } = values
  return {
    exchanges: whole('exchanges', exchanges, [1, 1e9]),
    seed: seed === undefined ? freshSeed() : whole('seed', seed, [0, 2 ** 32 - 1]),
    protocol: oneOf('protocol', protocol, protocols),
    mode: oneOf('mode', mode, modes),
    segment: segment === undefined ? undefined : whole('segment', segment, [0, 1e6]),
    against: against === undefined ? undefined : oneOf('against', against, peers)
  }
}

/** Where it is, every tenth of the way. */
function progress(exchanges) {
  let told = 0
  return ({ result }) => {
    const share = Math.floor((10 * result.exchanges) / exchanges)
    if (share > told && share < 10) print(`${result.exchanges} exchanges, ${result.wrong} wrong`)
    told = Math.max(told, share)
  }
}

async function run(options, { soak, isKept }) {
  const total = await soak({ ...options, tell: progress(options.exchanges) })
  const { result, failures, detail, ...more } = total
  const rounded = { ...detail, hours: Number(detail.hours.toFixed(2)) }
  print(JSON.stringify({ ...rounded, ...more }))
  const same = `--exchanges ${options.exchanges} --seed ${options.seed} --protocol ${options.protocol} --mode ${options.mode}`
  for (const failure of failures.slice(0, 10)) {
    print(JSON.stringify(failure).slice(0, 4000))
    print(`again: npm run soak -- ${same} --segment ${failure.segment}`)
  }
  print(JSON.stringify(result))
  if (!isKept(total)) process.exitCode = 1
}

async function main(args = process.argv.slice(2)) {
  const { freshSeed } = require('../lib/sim')
  const { MODES, PROTOCOLS, isKept, soak } = require(path.join(test, 'simulation', 'soak.js'))
  const { PEERS, against } = require(path.join(test, 'peers', 'against.js'))
  const known = { modes: MODES, protocols: Object.keys(PROTOCOLS), peers: Object.keys(PEERS), freshSeed }
  const options = read(args, known)
  if (!options.against) return run(options, { soak, isKept })
  oneOf('protocol', options.protocol, PEERS[options.against].protocols)
  print(JSON.stringify(await against({ ...options, peer: options.against, tell: progress(options.exchanges) })))
}

main().catch(error => {
  process.stderr.write(`${error instanceof Usage ? error.message : error.stack}\n`)
  process.exitCode = error instanceof Usage ? 2 : 1
})
