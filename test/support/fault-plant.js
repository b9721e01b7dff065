'use strict'

/**
 * A plant on real (virtual) serial ports and TCP, for runs with faults in real time: an NX PLC and two regulators on one port, an NX PLC behind a
 * serial server, a C24 on a port of its own, an INCON controller behind TCP; and the flow that reads and writes them all.
 */

const fs = require('node:fs')
const os = require('node:os')
const path = require('node:path')
const { createLine, serveOnPty, serveOnTcp } = require('../../lib/sim')
const { LISTENERS, listeningFlow, startListening } = require('./listening-redeploys.js')
const { placed } = require('./node-red.js')
const { createTcpProxy } = require('./tcp-proxy.js')
const { startVersions } = require('./versions.js')

const BAUD = 38400
const CHANGE = 200 // ms
const REMEMBERED = 3000

/** Reading device -> how it is configured and what of it is read and written. */
const nx = (line, station) => ({
  line,
  station,
  first: 'M',
  config: { type: 'nx-config', line: `line-${line}`, station, access: 'write', timeout: 500 },
  read: { type: 'nx-read', link: 'plc', items: ['M0..M9'] },
  write: { type: 'nx-write', link: 'plc', target: 'K0' },
  item: 'K0'
})
const chino = (line, station) => ({
  line,
  station,
  first: 'hr',
  config: { type: 'chino-config', line: `line-${line}`, station, access: 'write', timeout: 500 },
  read: { type: 'chino-regulator', link: 'regulator', mode: 'read', items: ['hr0..hr9'] },
  write: { type: 'chino-regulator', link: 'regulator', mode: 'write', target: 'hr20' },
  item: 'hr20'
})
/** @type {Record<string, any>} */
const DEVICES = {
  'plc-serial': nx('serial', 1),
  'zone-11': chino('serial', 11),
  'zone-12': chino('serial', 12),
  'plc-tcp': nx('tcp', 2)
}
const NAMES = Object.keys(DEVICES)

const rowsOf = line => NAMES.map(name => DEVICES[name]).filter(device => device.line === line)
const simulated = (line, options) => {
  const stations = rowsOf(line).map(({ config, station }) => ({ device: config.type.split('-')[0], station }))
  return createLine({ stations, baudRate: BAUD, quiet: true, turnaround: 3, ...options })
}

const debugOf = name => ({
  id: `debug-${name}`,
  type: 'debug',
  z: 'tab',
  active: true,
  tosidebar: true,
  complete: 'payload',
  targetType: 'msg',
  wires: []
})

const injectOf = (name, seconds) => ({
  id: `inject-${name}`,
  type: 'inject',
  z: 'tab',
  repeat: String(seconds),
  props: [{ p: 'payload', v: '$floor($random() * 1000)', vt: 'jsonata' }],
  wires: [[`write-${name}`]]
})

/** Nodes of one device: its configuration, a reader with a debug node, a writer with an inject node. */
function deviceFlow(name, { turn, interval, writing }) {
  const { config, read, write } = DEVICES[name]
  const { link: readLink, ...reading } = read
  const { link: writeLink, ...writer } = write
  return [
    { id: name, name: `device ${name}`, attempts: 3 - (turn & 1), ...config },
    {
      id: `read-${name}`,
      z: 'tab',
      [readLink]: name,
      ...reading,
      interval: interval + (turn & 4),
      wires: [[`debug-${name}`]]
    },
    { id: `write-${name}`, z: 'tab', [writeLink]: name, ...writer, wires: [[]] },
    injectOf(name, writing / 1000),
    debugOf(name)
  ]
}

/**
 * @param {any} settings of the lines
 * @param {{ turn?: number, interval?: number, writing?: number }} [options] turn: changes one property of each kind of node now and then; ms
 *   between two polls and between two writes
 */
function flowOf(settings, { turn = 0, interval = 250, writing = 1000 } = {}) {
  const lines = ['serial', 'tcp'].map(line => ({
    id: `line-${line}`,
    type: 'plc-line',
    name: line,
    ...settings[line],
    queueLimit: 500 + (turn & 2)
  }))
  const listening = listeningFlow(settings, { turn }).map(node =>
    node.type === 'inject' ? { ...node, repeat: String(writing / 1000) } : node
  )
  const monitors = ['serial', 'tcp'].map(line => ({
    id: `monitor-${line}`,
    type: 'plc-monitor',
    z: 'tab',
    line: `line-${line}`,
    interval: 2000 + (turn & 4),
    wires: [['debug-events'], [], []]
  }))
  const tab = { id: 'tab', type: 'tab', label: 'plant' }
  return placed([
    tab,
    ...lines,
    ...monitors,
    debugOf('events'),
    ...NAMES.flatMap(name => deviceFlow(name, { turn, interval, writing })),
    ...listening
  ])
}

/**
 * @param {{ rates?: any[], seed?: number }} [options] rates: faults of the answers of both polled lines
 */
async function startPlant({ rates = [], seed = 1 } = {}) {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'plant-'))
  const lines = { serial: simulated('serial', { rates, seed }), tcp: simulated('tcp', { rates, seed: seed + 1 }) }
  const stations = [...lines.serial.stations, ...lines.tcp.stations]
  const held = startVersions(
    NAMES.map((name, n) => ({ memory: stations[n], number: DEVICES[name].station, first: DEVICES[name].first })),
    { every: CHANGE, most: REMEMBERED }
  )
  const pty = serveOnPty({ wire: lines.serial.wire, link: path.join(folder, 'line') })
  const server = await serveOnTcp({ wire: lines.tcp.wire })
  const proxy = await createTcpProxy(server.port)
  const listening = await startListening(folder)
  return {
    ...{ folder, lines, stations, held, pty, proxy, listening },
    settings: {
      ...listening.settings,
      serial: { transport: 'serial', path: pty.path(), baudRate: BAUD },
      tcp: { transport: 'tcp', host: '127.0.0.1', port: proxy.port, baudRate: BAUD }
    },
    /** Whether a device can have held these words within so many ms up to now. */
    isHeld: (name, words, ms) => held.isHeld(NAMES.indexOf(name), words, performance.now() - ms, performance.now()),
    async close() {
      held.stop()
      pty.close()
      await proxy.stop()
      await server.close()
      await listening.close()
      fs.rmSync(folder, { recursive: true, force: true })
    }
  }
}

module.exports = { BAUD, DEVICES, LISTENERS, NAMES, flowOf, startPlant }
