'use strict'

/** The examples for databases, with real ones: what is stored equals what the simulator held. */

const assert = require('node:assert/strict')
const fs = require('node:fs')
const path = require('node:path')
const { createNxLine, serveOnTcp } = require('../../lib/sim')
const { startNodeRed, until } = require('../support/node-red.js')
const { packedProduct, RUNTIMES, modules, startInflux, temporary } = require('./support.js')

const example = (product, number) => {
  const folder = path.join(product, 'examples')
  const name = fs.readdirSync(folder).find(file => file.startsWith(`${number} `))
  return JSON.parse(fs.readFileSync(path.join(folder, name), 'utf8'))
}

// raw words of the simulated PLC, and the values that the tags of the examples make of them
const HELD = [
  {
    M10: 2155,
    M11: 487,
    'M0.0': true,
    K0: 2200,
    is: { temperature: 215.5, power: 48.7, running: true, setpoint: 220 }
  },
  { M10: 65486, M11: 0, 'M0.0': false, K0: 200, is: { temperature: -5, power: 0, running: false, setpoint: 20 } },
  { M10: 1, M11: 1000, 'M0.0': true, K0: 4000, is: { temperature: 0.1, power: 100, running: true, setpoint: 400 } }
]

const same = (row, is) => Object.keys(is).every(name => Number(row[name]) === Number(is[name]))

for (const { name, red, node } of RUNTIMES) {
  describe(`databases, ${name}`, function () {
    this.timeout(120000)
    let product, line, server, runtime, influx

    before(async () => {
      product = packedProduct()
      influx = await startInflux()
      line = createNxLine({ stations: [1], baudRate: 38400, quiet: true })
      server = await serveOnTcp({ wire: line.wire })
      const names = ['node-red-contrib-influxdb', 'node-red-node-sqlite']
      const extra = Object.fromEntries(names.map(it => [it, path.join(modules, it)]))
      runtime = await startNodeRed({ red, node, product, modules: extra, flow: [] })
    })
    after(async () => {
      await runtime?.stop()
      await server?.close()
      await influx?.stop()
    })
    const hold = ({ is: _is, ...words }) => Object.entries(words).forEach(([at, value]) => line.plcs[0].set(at, value))
    const pointed = flow =>
      flow.map(it => (it.type === 'plc-line' ? { ...it, transport: 'tcp', host: '127.0.0.1', port: server.port } : it))

    it('InfluxDB holds what the PLC held', async () => {
      await influx.query('CREATE DATABASE plant')
      hold(HELD[0])
      const flow = pointed(example(product, '07')).map(it =>
        it.type === 'influxdb' ? { ...it, port: String(influx.port), credentials: { username: '', password: '' } } : it
      )
      await runtime.deploy(flow)
      for (const held of HELD) {
        hold(held)
        const began = Date.now()
        const rows = async () => {
          const { series } = await influx.query('SELECT * FROM furnace', 'plant')
          if (!series) return false
          const [{ columns, values }] = series
          return values.map(value => Object.fromEntries(columns.map((column, n) => [column, value[n]])))
        }
        const row = await until(async () => ((await rows()) || []).find(it => same(it, held.is)), {
          what: JSON.stringify(held.is)
        })
        assert.equal(row.device, 'Furnace (station 1)')
        assert.deepEqual(typeof row.running, 'boolean')
        assert.ok(Math.abs(row.time - began) < 15000, 'the time is the time of the reading')
      }
      // and nothing else: each point is one of those that were held, whole
      const { series } = await influx.query('SELECT temperature, power, running, setpoint FROM furnace', 'plant')
      for (const [, temperature, power, running, setpoint] of series[0].values) {
        const row = { temperature, power, running, setpoint }
        assert.ok(
          Object.values(row).every(value => value !== null),
          JSON.stringify(row)
        )
      }
      await runtime.deploy([])
    })

    it('SQLite holds what the PLC held', async () => {
      hold(HELD[0])
      const file = path.join(temporary('sqlite-'), 'plant.sqlite')
      await runtime.deploy(
        pointed(example(product, '08')).map(it => (it.type === 'sqlitedb' ? { ...it, db: file } : it))
      )
      const sqlite = require(path.join(modules, 'sqlite3'))
      const rows = () =>
        new Promise(resolve => {
          const db = new sqlite.Database(file, sqlite.OPEN_READONLY, error => {
            if (error) return resolve([])
            db.all('SELECT * FROM readings', (failed, found) => db.close(() => resolve(failed ? [] : found)))
          })
        })
      for (const held of HELD) {
        hold(held)
        const began = Date.now()
        const row = await until(async () => (await rows()).find(it => same(it, held.is)), {
          what: JSON.stringify(held.is)
        })
        assert.deepEqual([row.device, row.quality], ['Furnace (station 1)', 'good'])
        assert.ok(Math.abs(row.time - began) < 15000)
      }
      await runtime.deploy([])
    })
  })
}
