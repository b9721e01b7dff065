'use strict'

/** Runs examples of the import menu as they are imported, in a real Node-RED; only brokers' and databases' addresses are changed. */

const assert = require('node:assert/strict')
const fs = require('node:fs')
const path = require('node:path')
const mqtt = require('mqtt')
const { startBroker } = require('../../examples/demo/broker.js')
const { freePort } = require('../../examples/demo/ports.js')
const { startNodeRed, until } = require('../support/node-red.js')

const folder = path.join(__dirname, '..', '..', 'examples')

/** @param {string} number of the example */
const load = number => {
  const name = fs.readdirSync(folder).find(file => file.startsWith(`${number} `))
  return JSON.parse(fs.readFileSync(path.join(folder, name), 'utf8'))
}

/** The node of a type with that name (or any name). */
const find = (flow, type, name) => {
  const found = flow.filter(node => node.type === type && (name === undefined || node.name === name))
  assert.equal(found.length, 1, `${type} ${name}`)
  return found[0]
}

const mqttNodes = flow => flow.filter(({ type, d }) => /^mqtt (in|out)$/.test(type) && !d)

/** A broker, a client of it that hears what it has subscribed to, and a Node-RED. */
async function startBench() {
  const port = await freePort(0)
  const broker = await startBroker(port)
  const client = await mqtt.connectAsync(broker.url)
  const heard = []
  client.on('message', (topic, bytes, packet) => {
    if (bytes.length) heard.push({ topic, value: JSON.parse(bytes.toString()), retain: packet.retain })
  })
  const red = await startNodeRed()
  const subscribed = new Set()

  /** What Node-RED is to publish before that is lost. */
  const isConnected = ({ id }) => /common\.status\.connected$/.test(red.status.get(id)?.text ?? '')
  /** Deploys an example alone. */
  const deploy = async (flow, edit = node => node) => {
    const ready = flow.map(node => (node.type === 'mqtt-broker' ? { ...node, port: String(port) } : node)).map(edit)
    red.status.clear()
    await red.deploy(ready)
    await until(() => red.status.size > 0, { what: 'a status' })
    await until(() => mqttNodes(ready).every(isConnected), { what: 'the broker' })
    return ready
  }
  const subscribe = async topics => {
    for (const topic of topics) subscribed.add(topic)
    await client.subscribeAsync(topics)
  }
  /** The first message of a topic that satisfies `is`. */
  const hear = (topic, is = _value => true) =>
    until(() => heard.find(it => it.topic === topic && is(it.value)), {
      what: () => `${topic}: ${JSON.stringify(heard)}`
    })
  /** What came before is not seen any more. */
  const forget = async () => {
    if (subscribed.size) await client.unsubscribeAsync([...subscribed])
    subscribed.clear()
    heard.length = 0
    red.forget()
  }
  const stop = async () => {
    await red.stop()
    await client.endAsync(true)
    await broker.close()
  }
  return { broker, client, red, heard, deploy, subscribe, hear, forget, stop }
}

module.exports = { startBench, load, find }
