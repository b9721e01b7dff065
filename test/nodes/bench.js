'use strict'
const path = require('node:path')
const helper = require('node-red-node-test-helper')
const { createLine, createNxLine, serveOnTcp } = require('../../lib/sim')
const { TYPES, translator } = require('./dialogs')

/** Flows in Node-RED's test helper, on a simulator behind TCP whose memory and faults the test holds in its hands. */

const RED = process.env.SERIAL_PLC_RED
  ? path.join(process.env.SERIAL_PLC_RED, 'lib/red.js')
  : require.resolve('node-red')
helper.init(RED)
const texts = translator('en-US')

// the helper stubs the catalogue: here the nodes speak
const speaking = type => red => {
  red._ = texts
  return require(`../../nodes/${type}`)(red)
}
const NODES = TYPES.map(speaking)

const tick = (ms = 5) => new Promise(resolve => setTimeout(resolve, ms))

/** @param {() => any} check @param {string} [what] @param {number} [patience] ms */
const until = async (check, what = 'something', patience = 4000) => {
  const end = Date.now() + patience
  for (;;) {
    const found = check()
    if (found) return found
    if (Date.now() > end) throw new Error(`waited in vain for ${what}`)
    await tick()
  }
}

const QUICK = { quiet: true, baudRate: 115200, turnaround: 1 }

/** A simulated line behind TCP. `quiet`: nothing moves by itself. */
const openWire = async (settings = {}) => {
  const line = createNxLine({ ...QUICK, ...settings })
  const server = await serveOnTcp({ wire: line.wire })
  return { ...line, ...server }
}

/** The same with stations of any kind, as `stations`; a number is a regulator. */
const openMixedWire = async (settings = {}) => {
  const line = createLine({ ...QUICK, device: 'chino', ...settings })
  const server = await serveOnTcp({ wire: line.wire })
  return { ...line, ...server }
}

// a node without a place would count as a config node
const ON_TAB = { z: 'tab', x: 1, y: 1 }
const TAB = { id: 'tab', type: 'tab', label: 'test' }

const lineNode = (wire, more = {}) => ({
  id: 'line',
  type: 'plc-line',
  name: 'Line',
  transport: 'tcp',
  host: '127.0.0.1',
  port: String(wire.port),
  baudRate: '115200',
  // the simulator has no past: nobody asked before
  latenessBound: '1',
  ...more
})

const plcNode = (more = {}) => ({
  id: 'plc',
  type: 'nx-config',
  name: 'Oven',
  line: 'line',
  station: '1',
  timeout: '150',
  attempts: '1',
  ...more
})

const reader = (more = {}) => ({
  id: 'read',
  type: 'nx-read',
  ...ON_TAB,
  plc: 'plc',
  interval: '0',
  wires: [['out']],
  ...more
})
const writer = (more = {}) => ({
  id: 'write',
  type: 'nx-write',
  ...ON_TAB,
  plc: 'plc',
  wires: [['out'], ['failed']],
  ...more
})
const zoneNode = (more = {}) => ({
  id: 'zone',
  type: 'chino-config',
  name: 'Zone',
  line: 'line',
  station: '1',
  timeout: '150',
  attempts: '1',
  ...more
})
/** A chino-regulator; its first wires are those of its mode. */
const regulator = (more = {}) => ({
  id: 'regulator',
  type: 'chino-regulator',
  ...ON_TAB,
  regulator: 'zone',
  interval: '0',
  wires: more.mode === 'both' ? [['out'], ['written'], ['failed']] : [['out'], ['failed']],
  ...more
})
const probe = id => ({ id, type: 'helper', ...ON_TAB, wires: [] })
const catcher = { id: 'catch', type: 'catch', ...ON_TAB, scope: null, uncaught: false, wires: [['caught']] }

/** Messages that arrive at a helper node. */
const collect = id => {
  const messages = []
  helper.getNode(id).on('input', (msg, _send, done) => {
    messages.push(msg)
    done()
  })
  return messages
}

/**
 * Loads a flow with the probes `out`, `written`, `failed` and `caught`.
 * @param {any[]} nodes
 */
const load = async nodes => {
  const probes = ['out', 'written', 'failed', 'caught']
  await helper.load(NODES, [TAB, ...nodes, catcher, ...probes.map(probe)])
  return Object.fromEntries(probes.map(id => [id, collect(id)]))
}

/** Statuses of a node from now on. */
const statuses = id => {
  const seen = []
  helper.getNode(id).on('call:status', call => seen.push(call.args[0]))
  return seen
}

/** The ends of each message that a node is given from now on: how often `done` was called for it, by its payload. */
const endsOf = id => {
  const { hooks } = require(RED)
  const ends = new Map()
  hooks.add('onComplete.test', ({ node, msg }) => {
    if (node.id === id) ends.set(msg.payload, (ends.get(msg.payload) ?? 0) + 1)
  })
  return { ends, forget: () => hooks.remove('*.test') }
}

module.exports = {
  NODES,
  ON_TAB,
  TAB,
  catcher,
  collect,
  endsOf,
  helper,
  lineNode,
  load,
  openMixedWire,
  openWire,
  plcNode,
  probe,
  reader,
  regulator,
  statuses,
  tick,
  until,
  writer,
  zoneNode
}
