'use strict'

/** Every example for PLCs runs as it was imported. */

const assert = require('node:assert/strict')
const mqtt = require('mqtt')
const { until } = require('../support/node-red.js')
const { find, load, startBench } = require('./bench.js')
const { startTcp } = require('./stations.js')

describe('examples', function () {
  this.timeout(40000)
  /** @type {Awaited<ReturnType<typeof startBench>>} */
  let bench
  before(async () => (bench = await startBench()))
  after(() => bench?.stop())
  beforeEach(() => bench.forget())

  it('01 polls to MQTT: value, quality, time and unit, retained', async () => {
    await bench.subscribe(['plant/furnace/#'])
    const start = Date.now()
    await bench.deploy(load('01'))
    for (const name of ['temperature', 'power', 'setpoint']) {
      const { value } = await bench.hear(`plant/furnace/${name}`)
      assert.equal(value.quality, 'good')
      assert.equal(typeof value.value, 'number')
      assert.ok(value.timestamp >= start - 50 && value.timestamp <= Date.now() + 50)
      assert.equal(value.unit, name === 'power' ? '%' : '°C')
    }
    assert.equal(typeof (await bench.hear('plant/furnace/running')).value.value, 'boolean')
    const late = await mqtt.connectAsync(bench.broker.url)
    const first = new Promise(resolve => late.once('message', (_topic, _bytes, packet) => resolve(packet.retain)))
    await late.subscribeAsync('plant/furnace/temperature')
    assert.equal(await first, true)
    await late.endAsync(true)
  })

  it('02 writes a set value once, answers, refuses what is retained or out of limits', async () => {
    const flow = await bench.deploy(load('02'))
    await bench.subscribe(['plant/furnace/answer/#', 'plant/furnace/state/#'])
    const connected = () => bench.red.status.get(find(flow, 'mqtt in').id)?.fill === 'green'
    await until(connected, { what: 'the broker' })
    await bench.client.publishAsync('plant/furnace/set/setpoint', '180.5')
    const { value: answer } = await bench.hear('plant/furnace/answer/setpoint')
    assert.equal(answer.outcome, 'confirmed')
    await bench.hear('plant/furnace/state/setpoint', value => value.value === 180.5)
    const answers = () => bench.heard.filter(it => it.topic === 'plant/furnace/answer/setpoint')
    assert.equal(answers().length, 1)

    await bench.client.publishAsync('plant/furnace/set/setpoint', '500')
    const { value: refused } = await bench.hear('plant/furnace/answer/setpoint', value => value.outcome === 'refused')
    assert.equal(refused.code, 'VALUE_OUT_OF_RANGE')

    // a retained one is delivered as retained to who subscribes later: after a redeploy
    await bench.client.publishAsync('plant/furnace/set/setpoint', '90', { retain: true })
    await bench.hear('plant/furnace/state/setpoint', value => value.value === 90)
    bench.heard.length = 0
    await bench.deploy(flow)
    const { value: retained } = await bench.hear('plant/furnace/answer/setpoint')
    assert.deepEqual([retained.outcome, retained.code], ['refused', 'RETAINED_REFUSED'])
    assert.equal(answers().length, 1)
    await bench.client.publishAsync('plant/furnace/set/setpoint', '', { retain: true })
  })

  it('03 reads when asked, and what the message asks for', async () => {
    const flow = await bench.deploy(load('03'))
    await bench.red.inject(find(flow, 'inject', 'ask now').id)
    const values = await bench.red.next(find(flow, 'debug', 'values').id)
    assert.deepEqual(Object.keys(values), ['temperature', 'M0_M3'])
    assert.equal(values.M0_M3.length, 4)
    await bench.red.inject(find(flow, 'inject', 'ask for K0, M0.0').id)
    const items = await bench.red.next(find(flow, 'debug', 'items').id)
    assert.deepEqual(
      items.map(it => [it.name, it.quality]),
      [
        ['K0', 'good'],
        ['M0_0', 'good']
      ]
    )
  })

  it('04 confirms what was written and read back, and tells why not', async () => {
    const flow = await bench.deploy(load('04'))
    await bench.red.inject(find(flow, 'inject', '215.5 °C').id)
    const yes = await bench.red.next(find(flow, 'debug', 'confirmed').id)
    assert.equal(yes.outcome, 'confirmed')
    await bench.red.inject(find(flow, 'inject', '500 °C').id)
    const no = await bench.red.next(find(flow, 'debug', 'not confirmed').id)
    assert.deepEqual([no.outcome, no.code], ['refused', 'VALUE_OUT_OF_RANGE'])
  })

  it('05 writes and reads bits and words together', async () => {
    const flow = await bench.deploy(load('05'))
    const values = find(flow, 'debug', 'values').id
    await bench.red.inject(find(flow, 'inject', 'three values').id)
    const set = await bench.red.next(values)
    assert.deepEqual([set.K10, set.K11_3, set.K12], [1234, true, 21.5])
    assert.equal(set.M0_M3.length, 4)
    bench.red.forget()
    await bench.red.inject(find(flow, 'inject', 'all off').id)
    const cleared = await bench.red.next(values)
    assert.deepEqual([cleared.K10, cleared.K11_3, cleared.K12], [0, false, 0])
  })

  it('06 raises one alarm when the station stops, and one all-clear', async () => {
    const stations = await startTcp([1])
    try {
      const real = { transport: 'tcp', host: '127.0.0.1', port: stations.port }
      const quick = node => (node.type === 'nx-config' ? { ...node, timeout: 150, attempts: 1 } : node)
      const flow = await bench.deploy(load('06'), node => quick(node.type === 'plc-line' ? { ...node, ...real } : node))
      const alarm = find(flow, 'debug', 'ALARM').id
      await bench.red.next(find(flow, 'debug', 'values').id)
      await bench.red.next(alarm, value => value.alarm === false)
      stations.silence(true)
      const on = await bench.red.next(alarm, value => value.alarm === true)
      assert.equal(on.code, 'TIMEOUT')
      bench.red.forget()
      stations.silence(false)
      await bench.red.next(alarm, value => value.alarm === false, 20000)
      const states = bench.red.debug.filter(it => it.id === alarm).map(it => it.value.alarm)
      assert.deepEqual(states, [false, true, false], 'one at the start, one alarm, one all-clear')
    } finally {
      await bench.red.deploy([])
      await stations.close()
    }
  })

  it('07 makes points of numbers and booleans, never of nulls', async () => {
    const flow = await bench.deploy(load('07').filter(node => !node.type.startsWith('influxdb')))
    const [fields, tags] = await bench.red.next(find(flow, 'debug', 'point').id)
    assert.deepEqual(Object.keys(fields).toSorted(), ['power', 'running', 'setpoint', 'temperature', 'time'])
    assert.equal(typeof fields.temperature, 'number')
    assert.equal(typeof fields.running, 'boolean')
    assert.deepEqual(tags, { device: 'Furnace (station 1)' })
  })

  it('08 hands the row to SQLite as parameters', async () => {
    const sink = { type: 'debug', active: true, tosidebar: true, complete: 'params', targetType: 'msg' }
    const flow = await bench.deploy(
      load('08')
        .filter(node => node.type !== 'sqlitedb')
        .map(node => (node.type === 'sqlite' ? { ...node, ...sink } : node))
    )
    const row = await bench.red.next(find(flow, 'debug', 'one row').id)
    assert.deepEqual(Object.keys(row).length, 7)
    assert.equal(row.$quality, 'good')
    assert.equal(row.$running, Number(row.$running))
  })

  it('09 the program of the manual: OK, and FAIL if it could not write', async () => {
    const flow = await bench.deploy(load('09'))
    const result = find(flow, 'debug', 'OK or FAIL').id
    const go = async writes => {
      bench.red.forget()
      await bench.red.inject(find(flow, 'inject', 'Fill M').id)
      if (writes) await bench.red.next(find(flow, 'debug', 'filled').id, value => value.outcome === 'confirmed')
      await bench.red.inject(find(flow, 'inject', 'Go').id)
      return bench.red.next(result)
    }
    assert.equal(await go(true), 'OK')
    const wrongHalf = JSON.stringify(flow).replace('source[[64..127]]', 'source[[63..126]]')
    const other = JSON.parse(wrongHalf).find(node => node.name === 'second half')
    await bench.deploy(flow, node => (node.id === other.id ? other : node))
    assert.equal(await go(true), 'FAIL', 'K64..K127 hold something else')
    await bench.deploy(flow, node => (node.type === 'nx-config' ? { ...node, access: 'read' } : node))
    assert.equal(await go(false), 'FAIL', 'it may not write')
  })

  it('15 watches a line: records of writes and statistics to MQTT, and the evidence', async () => {
    const flow = await bench.deploy(load('15'))
    await bench.subscribe(['plant/line/#'])
    const press = name => bench.red.inject(find(flow, 'inject', name).id)
    await press('150 °C')
    const audit = outcome => bench.hear('plant/line/events/audit', value => value.outcome === outcome)
    const { value: confirmed } = await audit('confirmed')
    assert.deepEqual([confirmed.items[0].value, confirmed.by.name], [150, 'setpoint'])
    await press('500 °C: over the limit')
    const { value: refused } = await audit('refused')
    assert.equal(refused.code, 'VALUE_OUT_OF_RANGE')
    await press('statistics now')
    const { value: all } = await bench.hear('plant/line/statistics')
    assert.deepEqual([all.state, all.stations[1].health, all.timeouts], ['open', 'online', 0])
    bench.red.forget()
    await press('evidence')
    const { rows, file } = await bench.red.next(find(flow, 'debug', 'statistics, or evidence').id, value => value.rows)
    assert.deepEqual(rows, [])
    assert.match(file, /serial-plc/)
    await bench.client.publishAsync('plant/line/statistics', '', { retain: true })
  })
})
