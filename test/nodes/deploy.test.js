'use strict'
const assert = require('node:assert/strict')
const {
  ON_TAB,
  TAB,
  endsOf,
  helper,
  lineNode,
  load,
  openWire,
  plcNode,
  probe,
  reader,
  statuses,
  tick,
  until,
  writer
} = require('./bench')
const { sharedPool } = require('../../nodes/pool')

describe('deploys and configurations', () => {
  let wire
  before(() => helper.startServer())
  after(() => helper.stopServer())
  beforeEach(async () => {
    wire = await openWire({ stations: [1, 2] })
    wire.plcs[0].set('M0', 7)
    wire.plcs[1].set('M0', 8)
  })
  afterEach(async () => {
    await helper.unload()
    const lines = sharedPool().lines()
    await wire.close()
    assert.deepEqual(lines, [], 'a line is left open')
    delete process.env.TEST_PORT
    delete process.env.TEST_STATION
  })

  const polling = () => [lineNode(wire), plcNode(), reader({ items: ['M0'], interval: '20' }), probe('out')]
  const errorsOf = id => {
    const seen = []
    helper.getNode(id).on('call:error', call => seen.push(call.args[0]))
    return seen
  }

  for (const type of ['full', 'flows', 'nodes']) {
    it(`deploy "${type}": a changed reader goes on, one connection, no double messages`, async () => {
      await load(polling())
      await until(() => wire.connections() === 1)
      for (let round = 0; round < (type === 'full' ? 2 : 5); round++) {
        const flow = [TAB, ...polling()]
        flow.find(({ id }) => id === 'read').items = [`M${round}`]
        await helper.setFlows(flow, type)
        const seen = []
        helper.getNode('out').on('input', msg => seen.push(Object.keys(msg.payload)[0]))
        await until(() => seen.length >= 3, 'messages after the deploy')
        assert.deepEqual([...new Set(seen)], [`M${round}`])
        assert.equal(wire.connections(), 1)
      }
      assert.equal(sharedPool().lines()[0].leases, 1)
    })

    it(`deploy "${type}": a changed line is opened anew`, async () => {
      await load(polling())
      await until(() => wire.connections() === 1)
      const flow = [TAB, ...polling()]
      Object.assign(
        flow.find(({ id }) => id === 'line'),
        { gap: '1' }
      )
      await helper.setFlows(flow, type)
      const seen = []
      helper.getNode('out').on('input', msg => seen.push(msg.payload))
      await until(() => seen.length > 1)
      assert.equal(wire.connections(), 1)
    })
  }

  it('removing or disabling the last user frees the port, its sibling goes on', async () => {
    const two = [...polling(), reader({ id: 'read2', items: ['M1'], interval: '20' })]
    await load(two)
    await until(() => wire.connections() === 1)
    const one = [TAB, ...two].map(node => (node.id === 'read' ? { ...node, d: true } : node))
    await helper.setFlows(one, 'nodes')
    const seen = []
    helper.getNode('out').on('input', msg => seen.push(Object.keys(msg.payload)[0]))
    await until(() => seen.length > 2)
    assert.deepEqual([...new Set(seen)], ['M1'])
    assert.deepEqual(Object.keys(helper.getNode('plc').users), ['read2'])
    await helper.setFlows([TAB, lineNode(wire), plcNode(), probe('out')], 'nodes')
    await until(() => wire.connections() === 0)
    assert.deepEqual(sharedPool().lines(), [])
  })

  it('a deploy while exchanges are in flight ends each message once', async () => {
    await load([lineNode(wire), plcNode({ access: 'write' }), writer({ target: 'K0' })])
    const { ends, forget } = endsOf('write')
    try {
      for (let n = 0; n < 5; n++) helper.getNode('write').receive({ payload: n })
      await tick()
      await helper.setFlows([TAB, probe('out')], 'full')
      await until(() => ends.size === 5, 'the end of each message')
      await tick(20)
      assert.deepEqual([...ends.values()], [1, 1, 1, 1, 1])
    } finally {
      forget()
    }
  })

  it('variables: numbers and texts, filled in when the flow starts', async () => {
    process.env.TEST_PORT = String(wire.port)
    process.env.TEST_STATION = '2'
    const { out } = await load([
      lineNode(wire, { port: '${TEST_PORT}' }),
      plcNode({ station: '${TEST_STATION}' }),
      reader({ items: ['M0'], interval: '20' })
    ])
    await until(() => out.length > 0)
    assert.equal(out[0].payload.M0, 8)
  })

  for (const [what, nodes, code] of [
    ['a variable that is not set', w => [lineNode(w, { port: '${TEST_PORT}' }), plcNode()], 'ENV_MISSING'],
    ['no line', () => [plcNode()], 'NO_CONFIGURATION'],
    ['a line without a path', () => [{ id: 'line', type: 'plc-line' }, plcNode()], 'BAD_SETTING'],
    ['a speed that is no number', w => [lineNode(w, { baudRate: 'fast' }), plcNode()], 'BAD_SETTING'],
    ['a station of masters', w => [lineNode(w), plcNode({ station: '192' })], 'BAD_STATION'],
    ['no station', w => [lineNode(w), plcNode({ station: '' })], 'BAD_STATION'],
    ['a bad area row', w => [lineNode(w), plcNode({ areas: [{ area: 'M', base: 'x' }] })], 'BAD_AREA'],
    ['a bad writable range', w => [lineNode(w), plcNode({ writableRanges: 'Q1' })], 'UNKNOWN_AREA']
  ]) {
    it(`${what}: ${code} at deploy for a Catch node, for each message, and in the status`, async () => {
      const { caught } = await load([...nodes(wire), reader({ items: ['M0'] })])
      await until(() => caught.length === 1)
      assert.equal(caught[0].error.code, code)
      helper.getNode('read').receive({ payload: 1 })
      await until(() => caught.length === 2)
      assert.equal(caught[1].error.code, code)
    })
  }

  it('a reader without a PLC, without items, with a foreign format', async () => {
    for (const [config, code] of [
      [{ plc: '', items: ['M0'] }, 'NO_CONFIGURATION'],
      [{ plc: 'gone', items: ['M0'] }, 'NO_CONFIGURATION'],
      [{ items: [] }, 'BAD_ITEMS'],
      [{ items: ['Q1'] }, 'UNKNOWN_AREA'],
      [{ items: ['M0'], format: 'xml' }, 'BAD_SETTING'],
      [{ items: ['M0'], interval: 'often' }, 'BAD_SETTING'],
      [{ items: ['M0'], interval: '5' }, 'BAD_SETTING']
    ]) {
      const { caught } = await load([lineNode(wire), plcNode(), reader(config)])
      await until(() => caught.length === 1, code)
      assert.equal(caught[0].error.code, code)
      await helper.unload()
    }
  })

  it('two configurations of one station on a line: the second one is refused, both are named', async () => {
    const { caught, out } = await load([
      lineNode(wire),
      plcNode(),
      plcNode({ id: 'plc2', name: 'Press' }),
      reader({ items: ['M0'], interval: '20' }),
      reader({ id: 'read2', plc: 'plc2', items: ['M0'] })
    ])
    await until(() => caught.length === 1 && out.length > 0)
    assert.equal(caught[0].error.code, 'DUPLICATE_STATION')
    assert.match(caught[0].error.message, /Oven.*Press|Press.*Oven/)
  })

  it('one wire, two lines with different settings: refused, both named; the first one goes on', async () => {
    const { caught, out } = await load([
      lineNode(wire),
      lineNode(wire, { id: 'line2', name: 'Other', baudRate: '9600' }),
      plcNode(),
      plcNode({ id: 'plc2', name: 'Press', line: 'line2', station: '2' }),
      reader({ items: ['M0'], interval: '20' }),
      reader({ id: 'read2', plc: 'plc2', items: ['M0'] })
    ])
    await until(() => caught.length === 1 && out.length > 0)
    assert.equal(caught[0].error.code, 'WIRE_CONFLICT')
    assert.match(caught[0].error.message, /Oven/)
    assert.match(caught[0].error.message, /Press/)
  })

  it('in a subflow, with a variable of the instance', async () => {
    const { out } = await load([
      { id: 'sub', type: 'subflow', name: 'sub', in: [], out: [{ x: 1, y: 1, wires: [{ id: 'inner', port: 0 }] }] },
      lineNode(wire),
      plcNode(),
      { ...reader({ id: 'inner', items: ['${ITEM}'], interval: '20' }), z: 'sub', wires: [] },
      {
        id: 'one',
        type: 'subflow:sub',
        ...ON_TAB,
        env: [{ name: 'ITEM', type: 'str', value: 'M0' }],
        wires: [['out']]
      },
      { id: 'two', type: 'subflow:sub', ...ON_TAB, env: [{ name: 'ITEM', type: 'str', value: 'M1' }], wires: [['out']] }
    ])
    await until(() => new Set(out.map(({ payload }) => Object.keys(payload)[0])).size === 2)
    assert.deepEqual(out.find(({ payload }) => 'M0' in payload).payload, { M0: 7 })
  })

  it('nothing listens: the status and the error say so, and it comes back by itself', async () => {
    const { port } = wire
    await wire.close()
    const { caught } = await load([{ ...lineNode({ port }) }, plcNode(), reader({ items: ['M0'], interval: '20' })])
    await until(() => caught.length > 0)
    assert.equal(caught[0].error.code, 'CONNECT_FAILED')
    const seen = statuses('read')
    const errors = errorsOf('read')
    await until(() => seen.length > 0)
    assert.deepEqual(seen[0], { fill: 'red', shape: 'ring', text: 'not connected' })
    assert.equal(errors.length, 0, 'no more errors while nothing changes')
    wire = await openWire({ stations: [1, 2] })
  })

  it('a config node can be asked for an error and a status without overflowing the stack', async () => {
    const { caught } = await load([lineNode(wire), plcNode(), reader({ items: ['M0'] })])
    helper.getNode('line').error(new Error('line'), {})
    helper.getNode('plc').error(new Error('plc'), {})
    helper.getNode('line').status({ text: 'x' })
    await until(() => caught.length === 2)
  })
})
