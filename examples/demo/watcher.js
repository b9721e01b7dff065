'use strict'

const mqtt = require('mqtt')

/**
 * What the demo sets by itself, again and again, so that there is something to see: the first time so many ms after the device has delivered.
 * `answer`: nobody confirms what is sent to these, but the device then says so itself.
 */
const PROGRAMS = [
  { device: 'furnace', name: 'setpoint', values: [180, 240, 120, 300], first: 300 },
  { device: 'zone1', name: 'manual_output', values: [80, 45, 95, 20], first: 1300 },
  {
    device: 'press',
    name: 'recipe',
    values: [7, 3, 12, 5].map((recipe, n) => ({ recipe, set: [215, 180, 240, 150][n] })),
    first: 1500,
    answer: ({ recipe, set }, said) => said.recipe === recipe && said.set === set
  },
  {
    device: 'machine',
    name: 'program',
    values: ['O1234', 'O2500', 'O0042'],
    first: 900,
    answer: (program, said) => said.event === `PROGRAM ${program} SELECTED`
  }
]
const PERIOD = 20000

/**
 * Another MQTT client, as somebody else's program would be: it subscribes to everything, counts, and writes a set value now and
 * then. A write counts as confirmed only if the outcome says so **and** the value that is read back afterwards is the one sent; what is
 * sent without confirmation counts as answered only if the device itself then reports it.
 * @param {string} url of the broker
 * @returns {Promise<{ counts(): Counts, close(): Promise<void> }>}
 */
async function watch(url) {
  const client = await mqtt.connectAsync(url, { clientId: `demo-watcher-${process.pid}`, reconnectPeriod: 500 })
  const seen = newCounts()
  const stops = PROGRAMS.map(program => run(client, seen, program))
  client.on('message', (topic, bytes) => count(seen, topic, bytes))
  await client.subscribeAsync('plant/#', { qos: 1 })
  return {
    counts: () => summary(seen),
    close: () => {
      for (const stop of stops) stop()
      return client.endAsync(true)
    }
  }
}

/** Writes the values of a program, again and again, as soon as its device delivers. @returns {() => void} ends it */
function run(client, seen, { device, name, values, first, answer }) {
  let step = 0
  let timer
  const write = () => {
    const value = values[step++ % values.length]
    if (answer) seen.asked.set(device, { is: said => answer(value, said), after: Date.now(), sent: false, said: false })
    client.publish(`plant/${device}/set/${name}`, typeof value === 'object' ? JSON.stringify(value) : String(value), {
      qos: 1
    })
    timer = setTimeout(write, PERIOD)
  }
  seen.started.set(device, () => void (timer = setTimeout(write, first)))
  return () => clearTimeout(timer)
}

const newCounts = () => ({
  errors: 0,
  topics: new Set(),
  devices: {},
  /** by device: what begins when it delivers */
  started: new Map(),
  /** by topic: the value that has to be read back */
  awaited: new Map(),
  /** by device: what it was sent last, until it has answered */
  asked: new Map()
})

function deviceOf(seen, name) {
  if (!seen.devices[name]) {
    seen.devices[name] = { published: 0, writesConfirmed: 0, answered: 0 }
    seen.started.get(name)?.()
  }
  return seen.devices[name]
}

const summary = ({ topics, errors, devices }) => {
  const sum = key => Object.values(devices).reduce((all, device) => all + device[key], 0)
  return {
    published: sum('published'),
    topics: topics.size,
    writesConfirmed: sum('writesConfirmed'),
    answered: sum('answered'),
    errors,
    devices
  }
}

const parse = bytes => {
  try {
    return JSON.parse(bytes.toString())
  } catch {
    return undefined
  }
}

/** @returns {void} */
function count(seen, topic, bytes) {
  const [, device, kind, name] = topic.split('/')
  if (kind === 'set') return // what we, or somebody else, sent: not the demo's output
  const message = parse(bytes)
  if (device === 'errors') {
    seen.errors++
    return
  }
  seen.topics.add(topic)
  deviceOf(seen, device).published++
  if (kind === 'outcome') {
    outcome(seen, { device, name, message })
  } else {
    if (message?.quality !== 'good') seen.errors++
    readBack(seen, { topic, device, message })
    answered(seen, device, asked => {
      asked.said ||= message?.timestamp >= asked.after && asked.is(message)
    })
  }
}

function outcome(seen, { device, name, message }) {
  if (message?.outcome === 'confirmed') {
    seen.awaited.set(`plant/${device}/${name}`, { value: message.items[0].value, after: Date.now() })
  } else if (message?.outcome === 'sent') {
    answered(seen, device, asked => void (asked.sent = true))
  } else seen.errors++
}

/** The same value of the same item, read after the confirmation. */
function readBack(seen, { topic, device, message }) {
  const awaited = seen.awaited.get(topic)
  if (!awaited || !(message?.timestamp >= awaited.after) || message.value !== awaited.value) return
  seen.awaited.delete(topic)
  deviceOf(seen, device).writesConfirmed++
}

/** Both the outcome of the node and the report of the device are there; in any order, since the device may be fast. */
function answered(seen, device, note) {
  const asked = seen.asked.get(device)
  if (!asked) return
  note(asked)
  if (!asked.sent || !asked.said) return
  seen.asked.delete(device)
  deviceOf(seen, device).answered++
}

/**
 * @typedef {object} Counts
 * @property {number} published messages of devices that arrived at the subscribed client
 * @property {number} topics different topics among them
 * @property {number} writesConfirmed set values that were confirmed, and read back with the value that was written
 * @property {number} answered what was sent where nobody confirms it, and what the device then reported itself
 * @property {number} errors values without good quality, refused or failed writes, errors that reached a Catch node
 * @property {Record<string, { published: number, writesConfirmed: number, answered: number }>} devices the same by device
 */

module.exports = { watch }
