'use strict'

const mqtt = require('mqtt')

/** Set values that the demo writes by itself, one after the other, so that there is something to see. */
const PROGRAM = [180, 240, 120, 300]
const PERIOD = 20000
const FIRST = 2000

/**
 * Another MQTT client, as somebody else's program would be: it subscribes to everything, counts, and writes a set value now and
 * then. A write counts as confirmed only if the outcome says so **and** the value that is read back afterwards is the one sent.
 * @param {string} url of the broker
 * @returns {Promise<{ counts(): Counts, close(): Promise<void> }>}
 */
async function watch(url) {
  const client = await mqtt.connectAsync(url, { clientId: `demo-watcher-${process.pid}`, reconnectPeriod: 500 })
  const seen = { published: 0, errors: 0, writesConfirmed: 0, topics: new Set(), awaited: null }
  client.on('message', (topic, bytes) => count(seen, topic, bytes))
  await client.subscribeAsync('plant/#', { qos: 1 })
  let step = 0
  const write = () => {
    const value = PROGRAM[step++ % PROGRAM.length]
    client.publish('plant/furnace/set/setpoint', String(value), { qos: 1 })
    timer = setTimeout(write, PERIOD)
  }
  let timer = setTimeout(write, FIRST)
  return {
    counts: () => summary(seen),
    close: () => {
      clearTimeout(timer)
      return client.endAsync(true)
    }
  }
}

const summary = ({ published, topics, writesConfirmed, errors }) => ({
  published,
  topics: topics.size,
  writesConfirmed,
  errors
})

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
  seen.published++
  seen.topics.add(topic)
  const message = parse(bytes)
  if (device === 'errors') {
    seen.errors++
  } else if (kind === 'outcome') {
    if (message?.outcome !== 'confirmed') seen.errors++
    else seen.awaited = { topic: `plant/${device}/${name}`, after: Date.now() }
  } else if (message?.quality !== 'good') {
    seen.errors++
  }
  readBack(seen, topic, message)
}

/** The first value of the same item that was read after the confirmation. */
function readBack(seen, topic, message) {
  if (!seen.awaited || topic !== seen.awaited.topic || !(message?.timestamp >= seen.awaited.after)) return
  seen.awaited = null
  seen.writesConfirmed++
}

/**
 * @typedef {object} Counts
 * @property {number} published messages that arrived at the subscribed client
 * @property {number} topics different topics among them
 * @property {number} writesConfirmed set values that were confirmed and read back
 * @property {number} errors values without good quality, refused or failed writes, errors that reached the Catch node
 */

module.exports = { watch, count }
