'use strict'

/** The demo's flow with real Mosquitto: it publishes there, and a set value of another MQTT client is written and confirmed. */

const assert = require('node:assert/strict')
const { execFileSync, spawn } = require('node:child_process')
const path = require('node:path')
const { demoFlow } = require('../../examples/demo/flow.js')
const { startMachine, startPress } = require('../../examples/demo/machines.js')
const { startStations } = require('../../examples/demo/stations.js')
const { startNodeRed, until } = require('../support/node-red.js')
const { root } = require('../support/source.js')
const { packedProduct, RUNTIMES, startMosquitto } = require('./support.js')

for (const { name, red, node } of RUNTIMES) {
  describe(`Mosquitto, ${name}`, function () {
    this.timeout(60000)
    let mosquitto, stations, press, machine, runtime, listener
    const heard = []

    before(async () => {
      mosquitto = await startMosquitto()
      stations = await startStations()
      press = await startPress()
      machine = await startMachine()
      listener = spawn('mosquitto_sub', [
        '-h',
        '127.0.0.1',
        '-p',
        String(mosquitto.port),
        '-t',
        'plant/#',
        '-F',
        '%t %p'
      ])
      let rest = ''
      listener.stdout.on('data', bytes => {
        const lines = (rest + bytes).split('\n')
        rest = lines.pop()
        for (const line of lines) {
          const [, topic, text] = /** @type {string[]} */ (/^(\S+) (.*)$/.exec(line))
          // what was sent to the devices comes as well, and need not be JSON
          if (!topic.includes('/set/')) heard.push([topic, JSON.parse(text)])
        }
      })
      const dashboard = '@flowfuse/node-red-dashboard'
      runtime = await startNodeRed({
        red,
        node,
        product: packedProduct(),
        modules: { [dashboard]: path.join(root, 'node_modules', dashboard) },
        flow: demoFlow({ stations, press, machine, mqttPort: mosquitto.port })
      })
    })
    after(async () => {
      await runtime?.stop()
      listener?.kill()
      for (const each of [machine, press, stations]) await each?.close()
      await mosquitto?.stop()
    })
    const hear = (topic, is) =>
      until(() => heard.find(([at, value]) => at === topic && is(value))?.[1], {
        what: () => `${topic}: ${JSON.stringify(heard.slice(-5))}\n${runtime.log()}`
      })
    const publish = (topic, text) =>
      execFileSync('mosquitto_pub', [
        '-h',
        '127.0.0.1',
        '-p',
        String(mosquitto.port),
        '-q',
        '1',
        '-t',
        topic,
        '-m',
        text
      ])

    it('the values of PLCs and regulators arrive, good and with units', async () => {
      const { value } = await hear('plant/furnace/temperature', it => it.quality === 'good' && it.unit === '°C')
      assert.ok(value > 0 && value < 400)
      for (const topic of ['furnace/heating', 'tank/level', 'tank/flow', 'tank/batches', 'tank/pump', 'tank/lowest']) {
        await hear(`plant/${topic}`, it => it.quality === 'good')
      }
      for (const zone of ['zone1', 'zone2']) {
        for (const [key, unit] of Object.entries({ temperature: '°C', load_current: 'A', load_power: 'kW' }))
          await hear(`plant/${zone}/${key}`, it => it.quality === 'good' && it.unit === unit && it.value > 0)
      }
    })

    it('a set value of another client is written once, confirmed and read back', async () => {
      const [furnace] = stations.line.stations
      const wrote = () => [...furnace.writes.values()].reduce((sum, times) => sum + times, 0)
      const before = wrote()
      publish('plant/furnace/set/setpoint', '266.5')
      const outcome = await hear('plant/furnace/outcome/setpoint', it => it.outcome === 'confirmed')
      assert.deepEqual([outcome.items[0].value, outcome.items[0].outcome], [266.5, 'confirmed'])
      await hear('plant/furnace/setpoint', it => it.value === 266.5)
      assert.equal(furnace.get('K0', 'int16'), 2665)
      assert.equal(wrote() - before, 1)
    })

    it('a set value for a regulator, too, and only for that one', async () => {
      const [, , zone1, zone2] = stations.line.stations
      const other = zone2.get('400001')
      publish('plant/zone1/set/manual_output', '37.5')
      const outcome = await hear('plant/zone1/outcome/manual_output', it => it.outcome === 'confirmed')
      assert.deepEqual([outcome.items[0].value, outcome.items[0].outcome], [37.5, 'confirmed'])
      await hear('plant/zone1/output', it => it.value === 37.5)
      assert.deepEqual([zone1.get('400001'), zone1.writes.get('hr0'), zone2.get('400001')], [375, 1, other])
    })

    it('one out of its limits is refused, and nothing is written', async () => {
      const [furnace] = stations.line.stations
      const held = furnace.get('K0')
      publish('plant/furnace/set/setpoint', '900')
      const outcome = await hear('plant/furnace/outcome/setpoint', it => it.outcome === 'refused')
      assert.equal(outcome.code, 'VALUE_OUT_OF_RANGE')
      assert.equal(furnace.get('K0'), held)
    })

    it('a recipe goes to the C24 as words, once, and comes back in its own', async () => {
      await hear('plant/press/state', it => it.quality === 'good' && it.recipe === 1 && it.set === 160)
      publish('plant/press/set/recipe', '{"recipe":258,"set":215.5}')
      const outcome = await hear('plant/press/outcome/recipe', it => it.outcome === 'sent')
      assert.deepEqual([outcome.bytes, outcome.value], [8, [258, 2155, 0, 0]])
      await hear('plant/press/state', it => it.recipe === 258 && it.set === 215.5 && it.temperature > 80)
      // low byte first: 0102H is 02 01, 086BH is 6B 08
      assert.deepEqual(
        press.device.messages.map(({ bytes }) => bytes.toString('hex')),
        ['02016b0800000000']
      )
      publish('plant/press/set/recipe', '{"recipe":3}')
      const { text } = await hear('plant/errors', it => it.text.includes('two numbers'))
      assert.ok(text)
      assert.equal(press.device.messages.length, 1)
    })

    it('the name of a program goes to the INCON controller, which answers; its events arrive', async () => {
      await hear('plant/machine/events', it => it.quality === 'good' && it.event === 'PART DONE')
      publish('plant/machine/set/program', 'O4711')
      await hear('plant/machine/outcome/program', it => it.outcome === 'sent' && it.value === 'O4711')
      await hear('plant/machine/events', it => it.event === 'PROGRAM O4711 SELECTED')
      assert.deepEqual(
        machine.device.messages.map(({ text }) => text),
        ['O4711']
      )
      publish('plant/machine/set/program', 'O가')
      const refused = await hear('plant/machine/outcome/program', it => it.outcome === 'refused')
      assert.equal(refused.code, 'BAD_VALUE')
    })
  })
}
