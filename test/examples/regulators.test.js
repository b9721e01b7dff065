'use strict'

/** The examples for regulators and for lines that are listened to run as they were imported. */

const assert = require('node:assert/strict')
const { until } = require('../support/node-red.js')
const { find, load, startBench } = require('./bench.js')

describe('examples for regulators and free messages', function () {
  this.timeout(40000)
  /** @type {Awaited<ReturnType<typeof startBench>>} */
  let bench
  before(async () => (bench = await startBench()))
  after(() => bench?.stop())
  beforeEach(() => bench.forget())

  it('10 polls two regulators to MQTT, each with its own values', async () => {
    await bench.subscribe(['plant/zone1/#', 'plant/zone2/#'])
    await bench.deploy(load('10'))
    const units = { output: '%', load_voltage: 'V', load_current: 'A', load_power: 'W', load_resistance: 'Ω' }
    for (const zone of ['zone1', 'zone2']) {
      for (const [name, unit] of Object.entries({ ...units, manual_output: '%', temperature: '°C', energy: 'Wh' })) {
        const { value, retain } = await bench.hear(`plant/${zone}/${name}`)
        assert.deepEqual([value.quality, value.unit, typeof value.value, retain], ['good', unit, 'number', false], name)
      }
      assert.equal((await bench.hear(`plant/${zone}/alarm`)).value.value, false)
    }
    const at = async name => (await bench.hear(`plant/zone1/${name}`)).value.value
    const power = (await at('load_voltage')) * (await at('load_current'))
    assert.ok(power > 0 && Math.abs(power - (await at('load_power'))) < power / 100, 'values of one heater')
  })

  it('11 sets an output, reads it back, refuses what is over the limit, answers at once', async () => {
    const flow = await bench.deploy(load('11'))
    const node = (type, name) => find(flow, type, name).id
    const press = async (name, output) => {
      bench.red.forget()
      await bench.red.inject(node('inject', name))
      return bench.red.next(node('debug', output))
    }
    const { outcome, items } = await press('output 40 %', 'confirmed')
    assert.deepEqual([outcome, items[0].name, items[0].value], ['confirmed', 'manual_output', 40])
    const values = await press('all values now', 'values')
    assert.deepEqual([values.manual_output, values.run, values.output], [40, true, 40])
    const refused = await press('output 95 %: over the limit', 'not confirmed')
    assert.deepEqual([refused.outcome, refused.code, refused.attempts], ['refused', 'VALUE_OUT_OF_RANGE', 0])
    assert.equal((await press('three values at once', 'confirmed')).items.length, 3)
    const three = await press('all values now', 'values')
    assert.deepEqual([three.manual_output, three.gradient, three.elevation, three.output], [60, 80, -2.5, 45.5])
    assert.equal((await press('switch off', 'confirmed')).outcome, 'confirmed')
    bench.red.forget()
    await bench.red.inject(node('inject', 'current and power now'))
    const two = await bench.red.next(node('debug', 'values'), value => Object.keys(value).length === 2)
    assert.deepEqual(two, { load_current: 0, load_power: 0 })
  })

  it('12 what the PLC commands the regulators do, and the PLC gets what they measure', async () => {
    const flow = await bench.deploy(load('12'))
    const node = (type, name) => find(flow, type, name).id
    const inPlc = (zone, is) => value => value.items.some(it => it.name === `current_${zone}` && is(it.value))
    const there = node('debug', 'in the PLC')
    // the command is 0 at first
    for (const zone of [1, 2])
      await bench.red.next(
        there,
        inPlc(zone, value => value === 0)
      )
    await bench.red.inject(node('inject', '60 %'))
    await bench.red.next(node('debug', 'the PLC has it'), value => value.outcome === 'confirmed')
    const done = node('debug', 'done')
    const isSixty = value => value.outcome === 'confirmed' && value.items[0].value === 60
    await bench.red.next(done, isSixty)
    await until(() => bench.red.debug.filter(it => it.id === done && isSixty(it.value)).length === 2, {
      what: 'both zones'
    })
    for (const zone of [1, 2]) {
      const { outcome } = await bench.red.next(
        there,
        inPlc(zone, value => value > 30)
      )
      assert.equal(outcome, 'confirmed')
    }
    const errors = bench.red.debug.filter(it => it.id === node('debug', 'errors'))
    assert.deepEqual(errors, [])
  })

  it('12 refuses a regulator with a number that the PLC configuration sends as', async () => {
    const flow = load('12')
    const zone = find(flow, 'chino-config', 'Zone 2 (station 12)').id
    await bench.deploy(flow, node => (node.id === zone ? { ...node, station: 0xe2 } : node))
    const said = await bench.red.next(find(flow, 'debug', 'errors').id, value => value.code === 'MIXED_LINE')
    assert.match(said.message, /Zone 2.*PLC \(station 1\)/)
  })

  const connected = flow =>
    until(() => bench.red.status.get(find(flow, 'mqtt in').id)?.fill === 'green', { what: 'the broker' })

  it('13 words of the C24 to MQTT, a recipe from MQTT or a button to the C24', async () => {
    const flow = await bench.deploy(load('13'))
    await bench.subscribe(['plant/press/#'])
    const { value } = await bench.hear('plant/press/state')
    assert.deepEqual(Object.keys(value), ['pieces', 'recipe', 'temperature', 'set', 'timestamp'])
    assert.deepEqual([value.recipe, value.set], [1, 180])
    await connected(flow)
    await bench.client.publishAsync('plant/press/recipe/set', '{ "recipe": 7, "set": 215 }')
    const { value: answer } = await bench.hear('plant/press/recipe/answer')
    assert.deepEqual([answer.outcome, answer.bytes], ['sent', 8])
    await bench.hear('plant/press/state', ({ recipe, set }) => recipe === 7 && set === 215)
    await bench.client.publishAsync('plant/press/state', '', { retain: true })
  })

  it('14 events of the machine to MQTT, a program name to the machine', async () => {
    const flow = await bench.deploy(load('14'))
    await bench.subscribe(['plant/machine/#'])
    const { value } = await bench.hear('plant/machine/events')
    assert.equal(typeof value.timestamp, 'number')
    await connected(flow)
    await bench.red.inject(find(flow, 'inject', 'O1234').id)
    const { value: answer } = await bench.hear('plant/machine/program/answer')
    assert.equal(answer.outcome, 'sent')
    await bench.hear('plant/machine/events', ({ event }) => event === 'PROGRAM O1234 SELECTED')
    await bench.red.inject(find(flow, 'inject', 'a name with a Hangul letter: refused').id)
    const refused = await bench.hear('plant/machine/program/answer', ({ outcome }) => outcome === 'refused')
    assert.equal(refused.value.code, 'BAD_VALUE')
  })
})
