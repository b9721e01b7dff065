'use strict'

const mqtt = require('mqtt')

/** Set values that the demo writes by itself, one after the other, so that there is something to see. */
const PROGRAMS = [
  { topic: 'plant/furnace/set/setpoint', values: [180, 240, 120, 300], first: 2000 },
  { topic: 'plant/zone1/set/manual_output', values: [80, 45, 95, 20], first: 4000 }
]
const PERIOD = 20000

/**
 * Another MQTT client, as somebody else's program would be: it subscribes to everything, counts, and writes a set value now and
 * then. A write counts as confirmed only if the outcome says so **and** the value that is read back afterwards is the one sent.
 * @param {string} url of the broker
 * @returns {Promise<{ counts(): Counts, close(): Promise<void> }>}
 */
async function watch(url) {
  const client = await mqtt.connectAsync(url, { clientId: `demo-watcher-${process.pid}`, reconnectPeriod: 500 })
  const seen = newCounts()
  client.on('message', (topic, bytes) => count(seen, topic, bytes))
  await client.subscribeAsync('plant/#', { qos: 1 })
  const stops = PROGRAMS.map(program => run(client, program))
  return {
    counts: () => summary(seen),
    close: () => {
      for (const stop of stops) stop()
      return client.endAsync(true)
    }
  }
}

/** Writes the values of a program, again and again. @returns {() => void} ends it */
function run(client, { topic, values, first }) {
  let step = 0
  const write = () => {
    client.publish(topic, String(values[step++ % values.length]), { qos: 1 })
    timer = setTimeout(write, PERIOD)
  }
  let timer = setTimeout(write, first)
  return () => clearTimeout(timer)
}

const newCounts = () => ({ errors: 0, topics: new Set(), devices: {}, awaited: new Map() })

const deviceOf = (seen, name) => (seen.devices[name] ??= { published: 0, writesConfirmed: 0 })

const summary = ({ topics, errors, devices }) => {
  const sum = key => Object.values(devices).reduce((all, device) => all + device[key], 0)
  return { published: sum('published'), topics: topics.size, writesConfirmed: sum('writesConfirmed'), errors, devices }
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
    if (message?.outcome !== 'confirmed') seen.errors++
    else seen.awaited.set(`plant/${device}/${name}`, { value: message.items[0].value, after: Date.now() })
  } else {
    if (message?.quality !== 'good') seen.errors++
    readBack(seen, { topic, device, message })
  }
}

/** The same value of the same item, read after the confirmation. */
function readBack(seen, { topic, device, message }) {
  const awaited = seen.awaited.get(topic)
  if (!awaited || !(message?.timestamp >= awaited.after) || message.value !== awaited.value) return
  seen.awaited.delete(topic)
  deviceOf(seen, device).writesConfirmed++
}

/**
 * @typedef {object} Counts
 * @property {number} published messages of devices that arrived at the subscribed client
 * @property {number} topics different topics among them
 * @property {number} writesConfirmed set values that were confirmed, and read back with the value that was written
 * @property {number} errors values without good quality, refused or failed writes, errors that reached a Catch node
 * @property {Record<string, { published: number, writesConfirmed: number }>} devices the same by device
 */

module.exports = { watch }
