'use strict'

/** Every example of the import menu runs as it was imported, in a real Node-RED; only brokers' and databases' addresses are changed. */

const assert = require('node:assert/strict')
const fs = require('node:fs')
const path = require('node:path')
const mqtt = require('mqtt')
const { startBroker } = require('../../examples/demo/broker.js')
const { freePort } = require('../../examples/demo/ports.js')
const { startNodeRed, until } = require('../support/node-red.js')

const folder = path.join(__dirname, '..', '..', 'examples')
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

describe('examples', function () {
  this.timeout(40000)
  let red, broker, client, port
  const heard = []

  before(async () => {
    port = await freePort(0)
    broker = await startBroker(port)
    client = await mqtt.connectAsync(broker.url)
    client.on('message', (topic, bytes, packet) => {
      if (bytes.length) heard.push({ topic, value: JSON.parse(bytes.toString()), retain: packet.retain })
    })
    red = await startNodeRed()
  })
  after(async () => {
    await red?.stop()
    await client?.endAsync(true)
    await broker?.close()
  })
  beforeEach(async () => {
    await client.unsubscribeAsync(['plant/furnace/#', 'plant/furnace/answer/#', 'plant/furnace/state/#'])
    heard.length = 0
    red.forget()
  })

  /** Deploys an example alone. */
  const deploy = async (flow, edit = node => node) => {
    const ready = flow.map(node => (node.type === 'mqtt-broker' ? { ...node, port: String(port) } : node)).map(edit)
    await red.deploy(ready)
    await until(() => [...red.status].length > 0, { what: 'a status' })
    return ready
  }
  const hear = (topic, is = _value => true) =>
    until(() => heard.find(it => it.topic === topic && is(it.value)), {
      what: () => `${topic}: ${JSON.stringify(heard)}`
    })

  it('01 polls to MQTT: value, quality, time and unit, retained', async () => {
    await client.subscribeAsync('plant/furnace/#')
    const start = Date.now()
    await deploy(load('01'))
    for (const name of ['temperature', 'power', 'setpoint']) {
      const { value } = await hear(`plant/furnace/${name}`)
      assert.equal(value.quality, 'good')
      assert.equal(typeof value.value, 'number')
      assert.ok(value.timestamp >= start - 50 && value.timestamp <= Date.now() + 50)
      assert.equal(value.unit, name === 'power' ? '%' : '°C')
    }
    assert.equal(typeof (await hear('plant/furnace/running')).value.value, 'boolean')
    const late = await mqtt.connectAsync(broker.url)
    const first = new Promise(resolve => late.once('message', (_topic, _bytes, packet) => resolve(packet.retain)))
    await late.subscribeAsync('plant/furnace/temperature')
    assert.equal(await first, true)
    await late.endAsync(true)
  })

  it('02 writes a set value once, answers, refuses what is retained or out of limits', async () => {
    const flow = await deploy(load('02'))
    await client.subscribeAsync(['plant/furnace/answer/#', 'plant/furnace/state/#'])
    const connected = () => red.status.get(find(flow, 'mqtt in').id)?.fill === 'green'
    await until(connected, { what: 'the broker' })
    await client.publishAsync('plant/furnace/set/setpoint', '180.5')
    const { value: answer } = await hear('plant/furnace/answer/setpoint')
    assert.equal(answer.outcome, 'confirmed')
    await hear('plant/furnace/state/setpoint', value => value.value === 180.5)
    const answers = () => heard.filter(it => it.topic === 'plant/furnace/answer/setpoint')
    assert.equal(answers().length, 1)

    await client.publishAsync('plant/furnace/set/setpoint', '500')
    const { value: refused } = await hear('plant/furnace/answer/setpoint', value => value.outcome === 'refused')
    assert.equal(refused.code, 'VALUE_OUT_OF_RANGE')

    // a retained one is delivered as retained to who subscribes later: after a redeploy
    await client.publishAsync('plant/furnace/set/setpoint', '90', { retain: true })
    await hear('plant/furnace/state/setpoint', value => value.value === 90)
    heard.length = 0
    await deploy(flow)
    const { value: retained } = await hear('plant/furnace/answer/setpoint')
    assert.deepEqual([retained.outcome, retained.code], ['refused', 'RETAINED_REFUSED'])
    assert.equal(answers().length, 1)
    await client.publishAsync('plant/furnace/set/setpoint', '', { retain: true })
  })

  it('03 reads when asked, and what the message asks for', async () => {
    const flow = await deploy(load('03'))
    await red.inject(find(flow, 'inject', 'ask now').id)
    const values = await red.next(find(flow, 'debug', 'values').id)
    assert.deepEqual(Object.keys(values), ['temperature', 'M0_M3'])
    assert.equal(values.M0_M3.length, 4)
    await red.inject(find(flow, 'inject', 'ask for K0, M0.0').id)
    const items = await red.next(find(flow, 'debug', 'items').id)
    assert.deepEqual(
      items.map(it => [it.name, it.quality]),
      [
        ['K0', 'good'],
        ['M0_0', 'good']
      ]
    )
  })

  it('04 confirms what was written and read back, and tells why not', async () => {
    const flow = await deploy(load('04'))
    await red.inject(find(flow, 'inject', '215.5 °C').id)
    const yes = await red.next(find(flow, 'debug', 'confirmed').id)
    assert.equal(yes.outcome, 'confirmed')
    await red.inject(find(flow, 'inject', '500 °C').id)
    const no = await red.next(find(flow, 'debug', 'not confirmed').id)
    assert.deepEqual([no.outcome, no.code], ['refused', 'VALUE_OUT_OF_RANGE'])
  })

  it('05 writes and reads bits and words together', async () => {
    const flow = await deploy(load('05'))
    const values = find(flow, 'debug', 'values').id
    await red.inject(find(flow, 'inject', 'three values').id)
    const set = await red.next(values)
    assert.deepEqual([set.K10, set.K11_3, set.K12], [1234, true, 21.5])
    assert.equal(set.M0_M3.length, 4)
    red.forget()
    await red.inject(find(flow, 'inject', 'all off').id)
    const cleared = await red.next(values)
    assert.deepEqual([cleared.K10, cleared.K11_3, cleared.K12], [0, false, 0])
  })

  it('06 raises one alarm when the station stops, and one all-clear', async () => {
    const { startTcp } = require('./stations.js')
    const stations = await startTcp([1])
    try {
      const real = { transport: 'tcp', host: '127.0.0.1', port: stations.port }
      const quick = node => (node.type === 'nx-config' ? { ...node, timeout: 150, attempts: 1 } : node)
      const flow = await deploy(load('06'), node => quick(node.type === 'plc-line' ? { ...node, ...real } : node))
      const alarm = find(flow, 'debug', 'ALARM').id
      await red.next(find(flow, 'debug', 'values').id)
      await red.next(alarm, value => value.alarm === false)
      stations.silence(true)
      const on = await red.next(alarm, value => value.alarm === true)
      assert.equal(on.code, 'TIMEOUT')
      red.forget()
      stations.silence(false)
      await red.next(alarm, value => value.alarm === false, 20000)
      const states = red.debug.filter(it => it.id === alarm).map(it => it.value.alarm)
      assert.deepEqual(states, [false, true, false], 'one at the start, one alarm, one all-clear')
    } finally {
      await red.deploy([])
      await stations.close()
    }
  })

  it('07 makes points of numbers and booleans, never of nulls', async () => {
    const flow = await deploy(load('07').filter(node => !node.type.startsWith('influxdb')))
    const [fields, tags] = await red.next(find(flow, 'debug', 'point').id)
    assert.deepEqual(Object.keys(fields).toSorted(), ['power', 'running', 'setpoint', 'temperature', 'time'])
    assert.equal(typeof fields.temperature, 'number')
    assert.equal(typeof fields.running, 'boolean')
    assert.deepEqual(tags, { device: 'Furnace (station 1)' })
  })

  it('08 hands the row to SQLite as parameters', async () => {
    const sink = { type: 'debug', active: true, tosidebar: true, complete: 'params', targetType: 'msg' }
    const flow = await deploy(
      load('08')
        .filter(node => node.type !== 'sqlitedb')
        .map(node => (node.type === 'sqlite' ? { ...node, ...sink } : node))
    )
    const row = await red.next(find(flow, 'debug', 'one row').id)
    assert.deepEqual(Object.keys(row).length, 7)
    assert.equal(row.$quality, 'good')
    assert.equal(row.$running, Number(row.$running))
  })

  it('09 the program of the manual: OK, and FAIL if it could not write', async () => {
    const flow = await deploy(load('09'))
    const result = find(flow, 'debug', 'OK or FAIL').id
    const go = async writes => {
      red.forget()
      await red.inject(find(flow, 'inject', 'Fill M').id)
      if (writes) await red.next(find(flow, 'debug', 'filled').id, value => value.outcome === 'confirmed')
      await red.inject(find(flow, 'inject', 'Go').id)
      return red.next(result)
    }
    assert.equal(await go(true), 'OK')
    const wrongHalf = JSON.stringify(flow).replace('source[[64..127]]', 'source[[63..126]]')
    const other = JSON.parse(wrongHalf).find(node => node.name === 'second half')
    await deploy(flow, node => (node.id === other.id ? other : node))
    assert.equal(await go(true), 'FAIL', 'K64..K127 hold something else')
    await deploy(flow, node => (node.type === 'nx-config' ? { ...node, access: 'read' } : node))
    assert.equal(await go(false), 'FAIL', 'it may not write')
  })
})
