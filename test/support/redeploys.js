'use strict'

/**
 * Redeploys and reconnects by the thousand, in a real Node-RED, on a real (virtual) serial port, over TCP and simulated: nothing may
 * be left behind, and values must flow again by themselves. Run by test/system and by `npm run endurance -- redeploys`.
 */

const assert = require('node:assert/strict')
const fs = require('node:fs')
const os = require('node:os')
const path = require('node:path')
const { createNxLine, serveOnPty, serveOnTcp } = require('../../lib/sim')
const { LISTENERS, listeningFlow, startListening } = require('./listening-redeploys.js')
const { placed, startNodeRed, until } = require('./node-red.js')

const LINES = ['serial', 'tcp', 'simulated']
const DEPLOY_MS = 2000
/** Messages that each device must get in each pause between the deploys. However fast these are: there must be something to look at. */
const MESSAGES = 6

const reading = (line, extra) => ({
  plc: `plc-${line}`,
  items: ['M0..M9', 'K0'],
  interval: 50,
  format: 'object',
  ...extra
})

/** Per line: the line, a PLC, a reader with a debug node, a writer. `turn` changes one property of each kind of node now and then. */
function flowOf(settings, { turn = 0, without = '' } = {}) {
  const tab = { id: 'tab', type: 'tab', label: 'endurance' }
  const each = LINES.flatMap(line => [
    { id: `line-${line}`, type: 'plc-line', name: line, ...settings[line], queueLimit: 500 + (turn & 2) },
    {
      id: `plc-${line}`,
      type: 'nx-config',
      name: line,
      line: `line-${line}`,
      station: 1,
      access: 'write',
      attempts: 3 - (turn & 1)
    },
    {
      id: `read-${line}`,
      type: 'nx-read',
      z: 'tab',
      ...reading(line, { interval: 50 + (turn & 4) }),
      wires: [[`debug-${line}`]]
    },
    { id: `write-${line}`, type: 'nx-write', z: 'tab', plc: `plc-${line}`, target: 'K0', wires: [[]] },
    {
      id: `inject-${line}`,
      type: 'inject',
      z: 'tab',
      repeat: '0.2',
      props: [{ p: 'payload', v: '7', vt: 'num' }],
      wires: [[`write-${line}`]]
    },
    {
      id: `debug-${line}`,
      type: 'debug',
      z: 'tab',
      active: true,
      tosidebar: true,
      complete: 'payload',
      targetType: 'msg',
      wires: []
    }
  ])
  const all = [tab, ...each, ...listeningFlow(settings, { turn })]
  return placed(all).map(node => (node.id === without ? { ...node, d: true } : node))
}

/** What one round does; the turn decides. */
const KINDS = [
  { type: 'full', change: _turn => ({}) },
  { type: 'nodes', change: turn => ({ turn }) },
  { type: 'flows', change: turn => ({ turn }) },
  { type: 'nodes', change: turn => ({ turn, without: `read-${LINES[turn % 3]}` }) },
  { type: 'nodes', change: turn => ({ turn, without: `node-${LISTENERS[turn % 2]}` }) },
  { type: 'reload', change: turn => ({ turn }) }
]

async function startLines({ baudRate }) {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'endurance-'))
  const made = [1, 2].map(() => createNxLine({ stations: [1], baudRate, quiet: true }))
  const wires = made.map(({ wire }) => wire)
  const connections = { tcp: 0 }
  const { connect } = wires[1]
  wires[1].connect = handlers => {
    connections.tcp++
    return connect(handlers)
  }
  const pty = serveOnPty({ wire: wires[0], link: path.join(folder, 'line') })
  const tcp = await serveOnTcp({ wire: wires[1] })
  const listening = await startListening(folder)
  const common = { baudRate, latenessBound: 20 }
  return {
    pty,
    tcp,
    listening,
    connections,
    queries: () => made.reduce((sum, { plcs: [{ counts }] }) => sum + counts.queries, 0),
    /** Bytes that the PLCs heard and could not make a frame of. */
    torn: () => made.reduce((sum, { plcs: [{ counts }] }) => sum + counts.strayBytes + counts.badCrc, 0),
    settings: {
      ...listening.settings,
      serial: { ...common, transport: 'serial', path: pty.path() },
      tcp: { ...common, transport: 'tcp', host: '127.0.0.1', port: tcp.port },
      simulated: { ...common, transport: 'simulated' }
    },
    async close() {
      pty.close()
      await tcp.close()
      await listening.close()
      fs.rmSync(folder, { recursive: true, force: true })
    }
  }
}

const total = counts => Object.values(counts).reduce((sum, number) => sum + number, 0)

/** Is more open than at the start? Our own keep-alive connections to the admin API come and go: they get time to end. */
const leftBehind = (now, start) =>
  total(now.resources) > total(start.resources) ||
  (now.resources.Timeout || 0) > (start.resources.Timeout || 0) ||
  now.descriptors.length > start.descriptors.length ||
  now.listeners > start.listeners

/** Values of all lines, newer than now, and messages to the devices. */
async function allFlow(red, { listening }) {
  red.forget()
  const before = listening.heard()
  const values = LINES.map(line => red.next(`debug-${line}`, value => value.K0 !== undefined, 15000))
  const messages = LISTENERS.map(device => red.next(`debug-${device}`, value => /^[A-Z]+ /.test(value), 15000))
  const sent = () => LISTENERS.every(device => listening.heard()[device] >= before[device] + MESSAGES)
  const what = () => `messages to the devices: ${JSON.stringify({ before, now: listening.heard() })}`
  await Promise.all([...values, ...messages, until(sent, { what, patience: 15000 })])
}

/**
 * @param {{ rounds: number, calm?: boolean, baudRate?: number, red?: string, node?: string, product?: string, tell?: (text: string) => void }} options
 *   calm: no connection is dropped and nothing is unplugged, so no station may hear a torn frame and no port may be in use
 * @returns {Promise<{ rounds: number, drops: number, unplugs: number, connections: number, slowest: number, ms: number, heard: object, queries: number,
 *   torn: number, before: object, after: object }>} heard: messages that the devices of the listening lines got; queries: of the PLCs; torn: bytes that the PLCs heard and that were no frame
 * @throws {import('node:assert').AssertionError} if something is left behind, does not come back or takes longer than 2 s
 */
async function redeploys({ rounds, calm = false, baudRate = 115200, tell = _text => {}, ...which }) {
  const lines = await startLines({ baudRate })
  const red = await startNodeRed({ ...which, probe: true, flow: [] }).catch(async error => {
    await lines.close()
    throw error
  })
  try {
    await red.deploy(flowOf(lines.settings))
    await allFlow(red, lines)
    await red.deploy([])
    const before = await until(() => red.count(), { what: 'a count' })
    const done = await rounded({ red, lines, rounds, calm, tell })
    await allFlow(red, lines)
    await red.deploy([])
    const connected = () => lines.tcp.connections() + lines.listening.tcp.connections()
    assert.equal(await until(() => connected() === 0, { what: 'TCP connections to end' }), true)
    let after
    await until(async () => !leftBehind((after = await red.count()), before), {
      what: () => `everything to be closed: ${JSON.stringify({ before, after })}`,
      patience: 30000,
      every: 250
    })
    const ports = after.descriptors.filter(name => /pts|tty/.test(name))
    assert.deepEqual(ports, [], 'no serial port stays open')
    assert.ok(after.heap - before.heap < 40e6, `the heap grew from ${before.heap} to ${after.heap}`)
    assert.equal(await red.stop(), 'ended', 'Node-RED ends by itself when it is asked to')
    const heard = lines.listening.check()
    assert.ok(Math.min(...Object.values(heard)) > rounds / 10, `the devices got only ${JSON.stringify(heard)}`)
    const torn = lines.torn()
    if (calm) assertCalm(red, torn)
    return { ...done, heard, queries: lines.queries(), torn, before, after }
  } finally {
    if (red.child.exitCode === null) await red.stop()
    await lines.close()
  }
}

/** Nothing but deploys has happened: each frame was whole, and each port was free when it was opened again. */
function assertCalm(red, torn) {
  assert.equal(torn, 0, `the PLCs heard ${torn} bytes that were no frame`)
  assert.doesNotMatch(red.log(), /in use|locked|PORT_|CONNECT_FAILED|LINE_DOWN/)
}

/** The runtime answers before the new nodes are made: the log tells when they are. */
async function deployed(red, flow, type) {
  const started = () => red.log().match(/Started (modified )?(flows|nodes)/g)?.length ?? 0
  const before = started()
  await red.deploy(flow, type)
  await until(() => started() > before, { what: 'the flows to start', every: 5 })
}

const ptys = ({ pty, listening }) => [pty, listening.pty]
const replug = lines => ptys(lines).forEach(pty => pty.replug())
const unplug = (lines, done) => {
  done.unplugs++
  for (const pty of ptys(lines)) pty.unplug()
}
const drop = ({ tcp, listening }, done) => {
  done.drops++
  tcp.drop()
  listening.tcp.drop()
}

async function rounded({ red, lines, rounds, calm, tell }) {
  const start = Date.now()
  const done = { rounds: 0, drops: 0, unplugs: 0, slowest: 0, ms: 0 }
  for (let turn = 1; turn <= rounds; turn++) {
    const kind = KINDS[turn % KINDS.length]
    // else one deploy would follow the other before the first exchange
    if (calm) await new Promise(resolve => setTimeout(resolve, 100 + ((turn * 37) % 250)))
    const began = Date.now()
    if (!calm && turn % 7 === 0) drop(lines, done)
    if (!calm && turn % 25 === 0) unplug(lines, done)
    if (!calm && turn % 25 === 1) replug(lines)
    await deployed(red, flowOf(lines.settings, kind.change(turn)), kind.type)
    done.rounds = turn
    done.slowest = Math.max(done.slowest, Date.now() - began)
    assert.ok(done.slowest < DEPLOY_MS, `deploy ${turn} (${kind.type}) took ${done.slowest} ms`)
    if (turn % 50 === 0) {
      replug(lines)
      await red.deploy(flowOf(lines.settings))
      await allFlow(red, lines)
      if (turn % 100 === 0) tell(`${turn} deploys, slowest ${done.slowest} ms, all lines deliver`)
    }
  }
  replug(lines)
  await red.deploy(flowOf(lines.settings))
  return { ...done, connections: lines.connections.tcp, ms: Date.now() - start }
}

module.exports = { redeploys }
