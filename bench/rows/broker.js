'use strict'

/**
 * From the line to the broker through Node-RED: nx-read (`message` format, 100 tags a cycle) → mqtt out, beside a source that does nothing but send as
 * many messages to mqtt out. Each in a Node-RED of its own, at the same time; broker and simulated PLC are other processes.
 */
const net = require('node:net')
const path = require('node:path')
const { Aedes } = require('aedes')
const { startNodeRed } = require('../../test/support/node-red')
const { startFarEnd } = require('../far-end')
const { median } = require('../measure')

const TAGS = 100
const INTERVAL = 100 // ms; the line needs 71
const BAUD = 38400
/** A gateway runs for months: what its JavaScript takes until the engine has translated it, after some thousand cycles, is not what a message costs. */
const SETTLE = 240000
const ROUNDS = 9
const ROUND = 6000
const MOST = 1.3

const pause = ms => new Promise(resolve => setTimeout(resolve, ms))

const tags = Array.from({ length: TAGS }, (_, n) => ({ name: `tag${n}`, address: `M${n}`, type: 'int16' }))
const names = tags.map(({ name }) => name)

const tab = { id: 'tab', type: 'tab', label: 'bench' }
const place = { z: 'tab', x: 100, y: 100 }
const outOf = port => [
  {
    id: 'mqtt',
    type: 'mqtt-broker',
    name: 'Broker',
    broker: '127.0.0.1',
    port: String(port),
    clientid: '',
    autoConnect: true,
    protocolVersion: '4',
    keepalive: '60',
    cleansession: true
  },
  { id: 'out', type: 'mqtt out', ...place, name: '', topic: '', qos: '1', retain: 'true', broker: 'mqtt', wires: [] }
]

const readingFlow = (port, link) => [
  tab,
  ...outOf(port),
  {
    id: 'line',
    type: 'plc-line',
    name: 'Line',
    transport: 'serial',
    path: link,
    baudRate: String(BAUD),
    latenessBound: '1'
  },
  { id: 'plc', type: 'nx-config', name: 'Oven', line: 'line', station: '1', tags },
  {
    id: 'read',
    type: 'nx-read',
    ...place,
    plc: 'plc',
    itemsType: 'list',
    items: names,
    interval: INTERVAL,
    format: 'message',
    wires: [['out']]
  },
  { id: 'none', type: 'bench-source', ...place, interval: 0, names: [], wires: [[]] }
]

const sendingFlow = port => [
  tab,
  ...outOf(port),
  { id: 'source', type: 'bench-source', ...place, interval: INTERVAL, names, wires: [['out']] }
]

/** A broker that counts what each client publishes. */
const startBroker = async () => {
  const broker = await Aedes.createBroker()
  const counts = new Map()
  broker.on('publish', (_packet, client) => client && counts.set(client.id, (counts.get(client.id) ?? 0) + 1))
  const server = net.createServer(broker.handle)
  await new Promise(resolve => server.listen(0, '127.0.0.1', () => resolve(undefined)))
  const { port } = /** @type {net.AddressInfo} */ (server.address())
  const close = async () => {
    await new Promise(resolve => broker.close(() => resolve(undefined)))
    await new Promise(resolve => server.close(resolve))
  }
  return { port, counts, close }
}

const startRuntime = async (flow, clientid) => {
  const own = flow.map(node => (node.type === 'mqtt-broker' ? { ...node, clientid } : node))
  const modules = { 'bench-nodes': path.join(__dirname, '..', 'red') }
  return startNodeRed({ flow: own, modules })
}

/** Processor of each runtime and messages at the broker, in some ms: microseconds for one message. */
const observe = async (runtimes, counts) => {
  const look = () =>
    Promise.all(
      Object.entries(runtimes).map(async ([name, runtime]) => {
        const { user, system } = await runtime.ask('GET', '/bench/processor')
        return { cpu: user + system, messages: counts.get(name) ?? 0 }
      })
    )
  const before = await look()
  await pause(ROUND)
  const after = await look()
  return after.map(({ cpu, messages }, at) => {
    const sent = messages - before[at].messages
    // in each round at least four fifths of what was asked for: else something else was measured
    if (sent < (0.8 * TAGS * ROUND) / INTERVAL) throw new Error(`${Object.keys(runtimes)[at]}: only ${sent} messages`)
    return (cpu - before[at].cpu) / sent
  })
}

async function* rows() {
  const far = await startFarEnd({ stations: [1], baudRate: BAUD, turnaround: 5, quiet: true })
  const broker = await startBroker()
  const runtimes = /** @type {Record<string, any>} */ ({})
  try {
    runtimes.reading = await startRuntime(readingFlow(broker.port, far.link), 'reading')
    runtimes.sending = await startRuntime(sendingFlow(broker.port), 'sending')
    await pause(SETTLE)
    const rounds = []
    for (let n = 0; n < ROUNDS; n++) rounds.push(await observe(runtimes, broker.counts))
    const name = `from the line to the broker, ${TAGS} tags, processor of a message`
    const limit = median(rounds.map(([, sending]) => sending))
    yield {
      name,
      value: median(rounds.map(([reading]) => reading)),
      unit: 'us',
      against: `a source that only sends, ${limit.toFixed(1)} us`,
      // both at the same time: what else the machine does concerns both
      ratio: median(rounds.map(([reading, sending]) => reading / sending)),
      goal: ['<=', MOST]
    }
  } finally {
    await Promise.all(Object.values(runtimes).map(runtime => runtime.stop()))
    await broker.close()
    await far.close()
  }
}

module.exports = { rows }
