'use strict'

/**
 * `npm start`: two simulated NX PLCs and two regulators on one virtual serial line, a C24 and an INCON controller on lines of their own, an
 * MQTT broker, Node-RED with flow and dashboard.
 *   npm start -- --seconds 20    ends by itself; the last line is what flowed, as JSON; code 1 if not all did
 */

const { setTimeout: sleep } = require('node:timers/promises')
const { parseArgs } = require('node:util')
const { startBroker } = require('./broker')
const { demoFlow } = require('./flow')
const { freePort } = require('./ports')
const { startMachine, startPress } = require('./machines')
const { startRuntime } = require('./runtime')
const { startStations } = require('./stations')
const { watch } = require('./watcher')

const DEVICES = ['furnace', 'tank', 'zone1', 'zone2', 'press', 'machine']

const print = text => process.stdout.write(`${text}\n`)

/** What was started, last first; each closes once. */
function pile() {
  const parts = []
  return {
    add(part) {
      parts.push(part)
      return part
    },
    async close() {
      for (const part of parts.splice(0).reverse()) await part.close()
    }
  }
}

/** Starts all parts; what had been started is on the pile even if a later part fails. */
async function startAll(parts) {
  const stations = parts.add(await startStations())
  const press = parts.add(await startPress())
  const machine = parts.add(await startMachine())
  const mqttPort = await freePort(1883)
  const broker = parts.add(await startBroker(mqttPort))
  const watcher = parts.add(await watch(broker.url))
  const port = await freePort(1880)
  const flow = demoFlow({ stations, press, machine, mqttPort })
  const runtime = parts.add(await startRuntime({ port, flow }))
  return { stations, press, machine, broker, watcher, runtime }
}

function show({ stations, press, machine, broker, runtime }) {
  print('')
  print(`  Dashboard   ${runtime.url}/dashboard`)
  print(`  Editor      ${runtime.url}/`)
  print(
    `  MQTT        ${broker.url}   values: plant/#   set: plant/furnace/set/setpoint, plant/zone1/set/manual_output,`
  )
  print(`              plant/press/set/recipe, plant/machine/set/program   what happens on the line: line/#`)
  print(`  Line        ${stations.address}   simulated: NX PLCs 1 and 2, regulators 11 and 12, 38400 bit/s`)
  print(`  Press       ${press.address}   simulated: MELSEC-Q serial module (C24), 19200 bit/s`)
  print(`  Machine     ${machine.address}   simulated: INCON controller, 9600 bit/s`)
  print('')
}

/** From the first moment on: Ctrl-C while it still starts must clean up as well. */
function catchSignals() {
  const asked = new AbortController()
  for (const signal of /** @type {const} */ (['SIGINT', 'SIGTERM', 'SIGHUP'])) {
    process.on(signal, () => {
      if (asked.signal.aborted) process.exit(130) // asked twice: at once
      asked.abort()
    })
  }
  return asked.signal
}

/** Resolves when the time is over or somebody ends the program. `seconds` 0: never by itself. */
const untilEnd = (seconds, asked) =>
  sleep(seconds ? seconds * 1000 : 2 ** 31 - 1, undefined, { signal: asked }).catch(() => {})

function secondsFrom(args) {
  const { values } = parseArgs({ args, options: { seconds: { type: 'string' } } })
  if (values.seconds === undefined) return 0
  const seconds = Number(values.seconds)
  if (!(seconds > 0 && seconds <= 86400)) throw new Error('--seconds takes a number of seconds, 1 to 86400')
  return seconds
}

/**
 * A run with a time is a test: values of each device and a confirmed set value of each kind must have come through (the first one takes 3 s),
 * and what was sent to press and machine must have been answered by them.
 */
function flowed({ devices }, seconds) {
  const written = ['furnace', 'zone1'].every(name => devices[name]?.writesConfirmed > 0)
  const answered = ['press', 'machine'].every(name => devices[name]?.answered > 0)
  return DEVICES.every(name => devices[name]?.published > 0) && ((written && answered) || seconds < 5)
}

async function main() {
  const seconds = secondsFrom(process.argv.slice(2))
  const asked = catchSignals()
  const parts = pile()
  let counts
  try {
    print('starting: simulated devices, MQTT broker, Node-RED ...')
    const demo = await startAll(parts)
    show(demo)
    print(seconds ? `  ends by itself after ${seconds} s` : '  Ctrl-C ends it')
    await untilEnd(seconds, asked)
    counts = demo.watcher.counts()
  } finally {
    await parts.close()
  }
  print(JSON.stringify(counts))
  return seconds && !asked.aborted && !flowed(counts, seconds) ? 1 : 0
}

main().then(
  code => process.exit(code),
  error => {
    process.stderr.write(`the demo could not start: ${error.message}\n`)
    process.exit(1)
  }
)
