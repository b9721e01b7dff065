'use strict'
const assert = require('node:assert/strict')
const {
  TAB,
  endsOf,
  helper,
  lineNode,
  load,
  openMixedWire,
  plcNode,
  probe,
  reader,
  regulator,
  tick,
  until,
  writer,
  zoneNode
} = require('./bench')
const { sharedPool } = require('../../nodes/pool')

const NX = { device: 'nx', station: 1 }

describe('regulators: deploys, and lines with PLCs', () => {
  let wire
  before(() => helper.startServer())
  after(() => helper.stopServer())
  beforeEach(async () => {
    wire = await openMixedWire({ stations: [NX, 11, 12, 13] })
    const [plc, ...zones] = wire.stations
    plc.set('M0', 7)
    zones.forEach((zone, index) => zone.set('400001', 11 + index))
  })
  afterEach(async () => {
    await helper.unload()
    const lines = sharedPool().lines()
    await wire.close()
    assert.deepEqual(lines, [], 'a line is left open')
    delete process.env.TEST_STATION
  })

  const zone = more => zoneNode({ station: '11', ...more })
  const polling = more => regulator({ items: ['400001'], interval: '20', ...more })

  it('an NX PLC and three regulators on one wire: each gets its own values, over one connection', async () => {
    const { out, caught } = await load([
      lineNode(wire),
      plcNode({ access: 'write' }),
      ...[11, 12, 13].map(station => zone({ id: `z${station}`, name: `Z${station}`, station: String(station) })),
      reader({ items: ['M0'], interval: '20' }),
      writer({ target: 'K0' }),
      ...[11, 12, 13].map(station => polling({ id: `r${station}`, regulator: `z${station}` }))
    ])
    helper.getNode('write').receive({ payload: 5 })
    const count = topic => out.filter(msg => msg.topic === topic).length
    await until(() => ['Oven', 'Z11', 'Z12', 'Z13'].every(topic => count(topic) > 5), 'values of all', 8000)
    const values = new Set(out.filter(msg => !msg.write).map(({ topic, payload }) => JSON.stringify([topic, payload])))
    assert.deepEqual([...values].sort(), [
      '["Oven",{"M0":7}]',
      '["Z11",{"_400001":11}]',
      '["Z12",{"_400001":12}]',
      '["Z13",{"_400001":13}]'
    ])
    assert.equal(wire.stations[0].get('K0'), 5)
    assert.deepEqual(caught, [])
    assert.equal(wire.connections(), 1)
    assert.equal(Object.keys(helper.getNode('line').users).length, 5)
  })

  for (const [what, nodes, code, names] of [
    [
      'one number twice',
      () => [zone(), zone({ id: 'zone2', name: 'Copy' })],
      'DUPLICATE_STATION',
      /Zone.*Copy|Copy.*Zone/
    ],
    [
      'the number of a PLC',
      () => [plcNode(), zone({ id: 'zone2', station: '1' })],
      'DUPLICATE_STATION',
      /Oven.*Zone|Zone.*Oven/
    ],
    ['the only PLC', () => [plcNode({ station: '255' }), zone({ id: 'zone2' })], 'MIXED_LINE', /Oven.*255|255.*Oven/],
    ['NX station 0', () => [plcNode({ station: '0' }), zone({ id: 'zone2' })], 'MIXED_LINE', /Zone/],
    ['a broadcast', () => [plcNode(), zone({ id: 'zone2', station: '0', broadcast: true })], 'MIXED_LINE', /Oven/],
    ['a master ID', () => [plcNode(), zone({ id: 'zone2', station: '226' })], 'MIXED_LINE', /226/],
    [
      'a master ID that was set',
      () => [plcNode({ masterIds: '20' }), zone({ id: 'zone2', station: '20' })],
      'MIXED_LINE',
      /20/
    ]
  ]) {
    it(`${what}: ${code} at deploy for one of the two, the other goes on`, async () => {
      const devices = nodes()
      const users = devices.map(({ id, type }) =>
        type === 'nx-config'
          ? reader({ plc: id, items: ['M0'] })
          : regulator({ id: `of-${id}`, regulator: id, mode: 'write', target: '' })
      )
      const { caught } = await load([lineNode(wire), ...devices, ...users])
      await until(() => caught.length === 1, 'the error of the deploy')
      assert.equal(caught[0].error.code, code)
      assert.match(caught[0].error.message, names)
      await tick(10)
      assert.equal(caught.length, 1)
    })
  }

  it('a master ID that is no regulator’s does no harm', async () => {
    const { out, caught } = await load([
      lineNode(wire),
      plcNode({ masterIds: '20' }),
      zone(),
      reader({ items: ['M0'], interval: '20' }),
      polling()
    ])
    await until(() => new Set(out.map(({ topic }) => topic)).size === 2)
    assert.deepEqual(caught, [])
  })

  for (const [what, line, config, code] of [
    ['RTU on 7 data bits', { dataBits: '7' }, {}, 'BAD_SETTING'],
    ['no station', {}, { station: '' }, 'BAD_STATION'],
    ['a station above 247', {}, { station: '248' }, 'BAD_STATION'],
    ['a variable that is not set', {}, { station: '${TEST_STATION}' }, 'ENV_MISSING'],
    ['no line', {}, { line: '' }, 'NO_CONFIGURATION'],
    ['a protocol that is none', {}, { protocol: 'tcp' }, 'BAD_SETTING'],
    ['a count above the protocol’s', {}, { holdingRead: '126' }, 'BAD_SETTING'],
    ['a unit above the count', {}, { coilRead: '8', coilUnit: '16' }, 'BAD_SETTING'],
    ['a bad writable range', {}, { writableRanges: 'M0' }, 'BAD_ADDRESS']
  ]) {
    it(`${what}: ${code} at deploy for a Catch node, and for each message`, async () => {
      const { caught } = await load([lineNode(wire, line), zone(config), regulator({ items: ['400001'] })])
      await until(() => caught.length === 1)
      assert.equal(caught[0].error.code, code)
      helper.getNode('regulator').receive({ payload: 1 })
      await until(() => caught.length === 2)
      assert.equal(caught[1].error.code, code)
    })
  }

  it('ASCII on 7 data bits is possible', async () => {
    await load([lineNode(wire, { dataBits: '7' }), zone({ protocol: 'ascii' }), regulator({ items: ['400001'] })])
    assert.equal(helper.getNode('zone').fault, null)
  })

  it('a node without a regulator, with a PLC for one, without items, with a foreign mode', async () => {
    for (const [config, code] of [
      [{ regulator: '', items: ['400001'] }, 'NO_CONFIGURATION'],
      [{ regulator: 'plc', items: ['400001'] }, 'NO_CONFIGURATION'],
      [{ items: [] }, 'BAD_ITEMS'],
      [{ mode: 'both', items: [] }, 'BAD_ITEMS'],
      [{ items: ['M0'] }, 'BAD_ADDRESS'],
      [{ mode: 'all', items: ['400001'] }, 'BAD_SETTING'],
      [{ items: ['400001'], interval: '5' }, 'BAD_SETTING']
    ]) {
      const { caught } = await load([lineNode(wire), plcNode(), zone(), regulator(config)])
      await until(() => caught.length === 1, code)
      assert.equal(caught[0].error.code, code)
      await helper.unload()
    }
  })

  it('what a mode does not use may be wrong: it does not count', async () => {
    const { out, caught } = await load([
      lineNode(wire),
      zone({ access: 'write' }),
      regulator({ id: 'a', mode: 'write', target: '400002', interval: 'often', items: [] }),
      regulator({ id: 'b', mode: 'read', items: ['400001'], topic: 'nonsense', target: 'nonsense' })
    ])
    helper.getNode('a').receive({ payload: 3 })
    helper.getNode('b').receive({})
    await until(() => out.length === 2)
    assert.deepEqual(caught, [])
  })

  it('numbers and variables', async () => {
    process.env.TEST_STATION = '12'
    const { out } = await load([lineNode(wire), zone({ station: '${TEST_STATION}', name: '' }), polling()])
    await until(() => out.length > 0)
    assert.deepEqual([out[0].topic, out[0].payload], ['CHINO 12', { _400001: 12 }])
  })

  for (const type of ['full', 'flows', 'nodes']) {
    it(`deploy "${type}": a changed mode and a changed station go on, over one connection`, async () => {
      const flow = (own, config) => [lineNode(wire), zone(config), polling(own)]
      await load(flow())
      await until(() => wire.connections() === 1)
      await helper.setFlows([TAB, ...flow({}, { station: '13' }), probe('out')], type)
      const seen = []
      helper.getNode('out').on('input', msg => seen.push(msg))
      await until(() => seen.length > 2)
      assert.deepEqual(new Set(seen.map(({ payload }) => payload._400001)), new Set([13]))
      const written = { mode: 'write', target: '400001' }
      await helper.setFlows([TAB, ...flow(written, { station: '13', access: 'write' }), probe('out')], type)
      const outcomes = []
      helper.getNode('out').on('input', msg => outcomes.push(msg.write?.outcome))
      helper.getNode('regulator').receive({ payload: 99 })
      await until(() => outcomes.includes('confirmed'))
      const asked = wire.stations[3].counts.queries
      await tick(50)
      assert.equal(wire.stations[3].counts.queries, asked, 'nothing is polled any more')
      assert.equal(wire.connections(), 1)
      assert.equal(sharedPool().lines()[0].leases, 1)
    })
  }

  it('a deploy while exchanges are in flight ends each message once', async () => {
    await load([
      lineNode(wire),
      zone({ access: 'write' }),
      regulator({ mode: 'both', items: ['400001'], target: '400001' })
    ])
    const { ends, forget } = endsOf('regulator')
    try {
      const node = helper.getNode('regulator')
      for (let n = 0; n < 6; n++) node.receive(n % 2 ? { payload: n } : { payload: n, items: true })
      await tick()
      await helper.setFlows([TAB, probe('out')], 'full')
      await until(() => ends.size === 6, 'the end of each message')
      await tick(20)
      assert.deepEqual([...ends.values()], [1, 1, 1, 1, 1, 1])
    } finally {
      forget()
    }
  })

  it('a simulated line: regulators with a heater beside PLCs, each keeps its values while the line lives', async () => {
    const line = { id: 'line', type: 'plc-line', transport: 'simulated' }
    const flow = more => [
      line,
      plcNode({ name: '', timeout: '1000' }),
      zone({ name: '', access: 'write', timeout: '1000', ...more }),
      reader({ items: ['M2'], interval: '50' }),
      regulator({
        mode: 'both',
        items: ['400001', '300001', '300006:int16'],
        interval: '50',
        target: '400001',
        wires: [['out'], ['out'], ['failed']]
      })
    ]
    const { out } = await load(flow())
    await until(() => new Set(out.map(({ topic }) => topic)).size === 2, 'both')
    assert.deepEqual(new Set(out.map(({ topic }) => topic)), new Set(['NX PLC 1', 'CHINO 11']))
    assert.ok(out.every(({ simulated }) => simulated === true))
    helper.getNode('regulator').receive({ payload: 500 })
    await until(() => out.some(({ payload }) => payload._300001 === 500), 'the output follows the set value')
    await helper.setFlows([TAB, ...flow({ attempts: '2' }), probe('out'), probe('failed')], 'nodes')
    const seen = []
    helper.getNode('out').on('input', msg => msg.topic === 'CHINO 11' && seen.push(msg))
    await until(() => seen.length > 0)
    assert.equal(seen[0].payload._400001, 500)
  })

  it('a test with another protocol does not change the simulated regulator that is deployed', async () => {
    const line = { id: 'line', type: 'plc-line', transport: 'simulated' }
    const { out } = await load([line, zone({ station: '5', timeout: '1000' }), polling()])
    await until(() => out.length > 0)
    const undo = helper.getNode('line').plcs.visit({ type: 'chino-config', station: 5, protocol: 'ascii' })
    undo()
    const sent = out.length
    await until(() => out.length > sent + 1, 'more values')
  })

  // 255 is the simulated PLC 1: the test replaced the regulator 1, and left it without power until the next full deploy
  for (const [what, deployed, visitor] of [
    ['the only PLC, beside the regulator 1', () => [zone({ station: '1', timeout: '1000' }), polling()], 255],
    [
      'the only PLC, which is PLC 1',
      () => [plcNode({ timeout: '1000' }), reader({ items: ['M2'], interval: '20' })],
      255
    ],
    [
      'PLC 1, which is the only PLC',
      () => [plcNode({ station: '255', timeout: '1000' }), reader({ items: ['M2'], interval: '20' })],
      1
    ]
  ]) {
    it(`a test of ${what} leaves the simulated station that is deployed as it is`, async () => {
      const { out } = await load([{ id: 'line', type: 'plc-line', transport: 'simulated' }, ...deployed()])
      await until(() => out.length > 0)
      const undo = helper.getNode('line').plcs.visit({ type: 'nx-config', station: visitor })
      for (const leave of [() => {}, undo]) {
        leave()
        const sent = out.length
        await until(() => out.length > sent + 1, 'more values', 1500)
      }
    })
  }

  it('a simulated regulator that becomes ASCII, or a PLC, is another station', async () => {
    const line = { id: 'line', type: 'plc-line', transport: 'simulated' }
    await load([line, zone({ station: '5', timeout: '1000' }), polling()])
    await helper.setFlows(
      [TAB, line, zone({ station: '5', protocol: 'ascii', timeout: '1000' }), polling(), probe('out')],
      'nodes'
    )
    const seen = []
    helper.getNode('out').on('input', msg => seen.push(msg))
    await until(() => seen.length > 0, 'a value in ASCII')
    await helper.setFlows(
      [TAB, line, plcNode({ station: '5', timeout: '1000' }), reader({ items: ['M2'], interval: '50' }), probe('out')],
      'nodes'
    )
    const values = []
    helper.getNode('out').on('input', msg => values.push(msg))
    await until(() => values.some(({ topic }) => topic === 'Oven'), 'a value of the PLC')
  })
})
