'use strict'
const assert = require('node:assert/strict')
const { helper, lineNode, load, openWire, plcNode, reader, statuses, tick, until, writer } = require('./bench')

const TAGS = [
  { name: 'setpoint', address: 'K0', type: 'int16', scale: 0.1, writable: true, min: 20, max: 400 },
  { name: 'limited', address: 'K5', min: 0, max: 10 },
  { name: 'fixedOnly', address: 'K9' }
]

describe('nx-write', () => {
  let wire
  before(() => helper.startServer())
  after(() => helper.stopServer())
  beforeEach(async () => {
    wire = await openWire({ stations: [1] })
  })
  afterEach(async () => {
    await helper.unload()
    try {
      // the simulator hears of it a moment later
      await until(() => wire.connections() === 0, 'the end of the connection')
    } finally {
      await wire.close()
    }
  })

  const writes = () => [...wire.plcs[0].writes.values()].reduce((sum, count) => sum + count, 0)

  const give = async (config, msg, plc = {}) => {
    const probes = await load([lineNode(wire), plcNode({ tags: TAGS, access: 'write', ...plc }), writer(config)])
    helper.getNode('write').receive(msg)
    return probes
  }
  const confirmed = async (config, msg, plc) => {
    const { out, failed, caught } = await give(config, msg, plc)
    await until(() => out.length + failed.length + caught.length > 0, 'a message')
    assert.deepEqual(
      [...failed.map(it => it.write), ...caught.map(({ error }) => error)],
      [],
      'expected to be confirmed'
    )
    return out[0]
  }
  const refused = async (config, msg, plc) => {
    const { out, failed, caught } = await give(config, msg, plc)
    await until(() => caught.length > 0, 'an error')
    await tick(10)
    assert.equal(caught.length, 1)
    assert.equal(out.length + failed.length, 0)
    return caught[0]
  }

  it('a fixed target: confirmed on the first output, everything kept', async () => {
    const msg = await confirmed({ target: 'K127.12' }, { payload: 'on', topic: 'button', own: 3 })
    assert.equal(wire.plcs[0].get('K127.12'), true)
    assert.equal(msg.payload, 'on')
    assert.equal(msg.own, 3)
    assert.equal(msg.topic, 'K127.12')
    const { ms, items, ...write } = msg.write
    assert.deepEqual(write, { outcome: 'confirmed', attempts: 1 })
    assert.equal(items[0].item, 'K127.12')
    assert.ok(Number.isInteger(ms))
    assert.equal(writes(), 1)
  })

  it('a scaled tag is converted back', async () => {
    await confirmed({ target: 'setpoint' }, { payload: '123.4' })
    assert.equal(wire.plcs[0].get('K0', 'int16'), 1234)
  })

  it('pairs of an object: tags that are writable, addresses in the writable ranges', async () => {
    const payload = { setpoint: 25, K20: 7, 'K21.3': true }
    const msg = await confirmed({}, { payload }, { writableRanges: 'K20..K29' })
    assert.deepEqual([250, 7, true], [wire.plcs[0].get('K0'), wire.plcs[0].get('K20'), wire.plcs[0].get('K21.3')])
    assert.equal(msg.topic, 'Oven')
  })

  it('the item in msg.topic', async () => {
    await confirmed({}, { topic: 'setpoint', payload: 30 })
    assert.equal(wire.plcs[0].get('K0'), 300)
  })

  it('a range takes an array', async () => {
    await confirmed({ target: 'K60..K62' }, { payload: [1, 2, 3] })
    assert.deepEqual(
      ['K60', 'K61', 'K62'].map(item => wire.plcs[0].get(item)),
      [1, 2, 3]
    )
  })

  for (const [topic, topicText, expected] of [
    ['item', '', 'setpoint'],
    ['keep', '', 'plant/1'],
    ['fixed', 'done', 'done']
  ]) {
    it(`topic ${topic}`, async () => {
      const msg = await confirmed({ target: 'setpoint', topic, topicText }, { payload: 20, topic: 'plant/1' })
      assert.equal(msg.topic, expected)
    })
  }

  for (const [what, config, msg, code, plc] of [
    ['no target, no topic', {}, { payload: 1 }, 'NOTHING_TO_WRITE'],
    ['an empty object', {}, { payload: {} }, 'NOTHING_TO_WRITE'],
    ['an empty text', { target: 'K1' }, { payload: '' }, 'BAD_VALUE'],
    ['null', { target: 'K1' }, { payload: null }, 'BAD_VALUE'],
    ['NaN', { target: 'K1' }, { payload: NaN }, 'BAD_VALUE'],
    ['no payload', { target: 'K1' }, {}, 'BAD_VALUE'],
    ['text', { target: 'K1' }, { payload: 'high' }, 'BAD_VALUE'],
    ['too large for the word', { target: 'K1' }, { payload: 65536 }, 'VALUE_OUT_OF_RANGE'],
    ['above max', { target: 'setpoint' }, { payload: 401 }, 'VALUE_OUT_OF_RANGE'],
    ['above max under its address', { target: 'K5' }, { payload: 11 }, 'VALUE_OUT_OF_RANGE'],
    ['a bit of a limited word', { target: 'K5.1' }, { payload: true }, 'NOT_WRITABLE'],
    ['a tag that is not writable, by a message', { target: '' }, { topic: 'fixedOnly', payload: 1 }, 'NOT_WRITABLE'],
    [
      'an address outside the ranges, by a message',
      {},
      { payload: { K30: 1 } },
      'NOT_WRITABLE',
      { writableRanges: 'K20' }
    ],
    ['one bad pair stops all', {}, { payload: { setpoint: 30, K99: 1 } }, 'NOT_WRITABLE'],
    ['a prototype as name', {}, { payload: JSON.parse('{"__proto__": 1}') }, 'BAD_ADDRESS'],
    ['a retained message', { target: 'K1' }, { payload: 1, retain: true }, 'RETAINED_REFUSED'],
    ['a read-only PLC, by a message', {}, { payload: { setpoint: 30 } }, 'READ_ONLY', { access: 'read' }]
  ]) {
    it(`refused before anything is sent: ${what}`, async () => {
      const { error, write } = await refused(config, msg, plc)
      assert.equal(error.code, code)
      assert.equal(write.outcome, 'refused')
      assert.equal(write.code, code)
      assert.equal(wire.plcs[0].counts.queries, 0)
    })
  }

  it('retained messages are written if the node accepts them', async () => {
    await confirmed({ target: 'K1', acceptRetained: true }, { payload: 4, retain: true })
    assert.equal(wire.plcs[0].get('K1'), 4)
  })

  it('a fixed target on a read-only PLC is refused at deploy, and each message', async () => {
    const { caught, out } = await load([lineNode(wire), plcNode({ tags: TAGS }), writer({ target: 'K1' })])
    await until(() => caught.length === 1, 'the error of the deploy')
    assert.equal(caught[0].error.code, 'READ_ONLY')
    helper.getNode('write').receive({ payload: 1 })
    await until(() => caught.length === 2)
    assert.equal(caught[1].error.code, 'READ_ONLY')
    assert.equal(out.length, 0)
    assert.equal(wire.plcs[0].counts.queries, 0)
  })

  it('no answer: unknown, sent exactly once, as an error', async () => {
    wire.wire.setOff(1, true)
    const { error, write } = await refused({ target: 'K1' }, { payload: 1 }, { timeout: '60' })
    assert.equal(write.outcome, 'unknown')
    assert.equal(error.code, 'WRITE_UNKNOWN')
    assert.equal(write.attempts, 1)
  })

  it('onFailure output: the second output and no error', async () => {
    const { out, failed, caught } = await give({ target: 'K1', onFailure: 'output' }, { payload: 'x', own: 1 })
    await until(() => failed.length > 0)
    await tick(10)
    assert.deepEqual([out.length, failed.length, caught.length], [0, 1, 0])
    assert.equal(failed[0].write.code, 'BAD_VALUE')
    assert.equal(failed[0].own, 1)
  })

  it('the PLC refuses: outcome refused with its error', async () => {
    wire.plcs[0].setMode('program')
    const { error, write } = await refused({ target: 'K1' }, { payload: 1 })
    assert.equal(write.outcome, 'refused')
    assert.equal(error.code, 'PLC_NOT_PERFORMED')
  })

  it('verify reads back', async () => {
    await confirmed({ target: 'K1', verify: true }, { payload: 5 })
    assert.equal(wire.plcs[0].counts.queries, 2)
  })

  it('coalesce: while the line is busy only the latest value of a target is written', async () => {
    const { out, caught } = await load([
      lineNode(wire),
      plcNode({ access: 'write' }),
      writer({ target: 'K1', coalesce: true })
    ])
    for (let value = 1; value <= 20; value++) helper.getNode('write').receive({ payload: value })
    await until(() => wire.plcs[0].get('K1') === 20)
    await until(() => out.at(-1)?.payload === 20)
    assert.ok(writes() < 10, `${writes()} writes`)
    assert.equal(out.length, writes())
    assert.equal(caught.length, 0)
  })

  it('without coalesce every value is written, in order', async () => {
    const { out } = await load([lineNode(wire), plcNode({ access: 'write' }), writer({ target: 'K1' })])
    for (let value = 1; value <= 8; value++) helper.getNode('write').receive({ payload: value })
    await until(() => out.length === 8)
    assert.deepEqual(
      out.map(({ payload }) => payload),
      [1, 2, 3, 4, 5, 6, 7, 8]
    )
    assert.equal(writes(), 8)
  })

  it('a faulty row of the tag table does not stop the reading of others, but no write is made', async () => {
    const tags = [...TAGS, { name: 'broken', address: 'K300', min: 1 }]
    const { out, caught } = await load([
      lineNode(wire),
      plcNode({ tags, access: 'write' }),
      reader({ items: ['setpoint'] }),
      writer({ target: 'setpoint' })
    ])
    await until(() => caught.length === 1)
    assert.equal(caught[0].error.code, 'BAD_TAG')
    helper.getNode('read').receive({})
    await until(() => out.length === 1)
    assert.deepEqual(out[0].payload, { setpoint: 0 })
    helper.getNode('write').receive({ payload: 30 })
    await until(() => caught.length === 2)
    assert.equal(writes(), 0)
  })

  it('status: writing, then what became of it', async () => {
    await load([lineNode(wire), plcNode({ access: 'write' }), writer({ target: 'K1' })])
    const seen = statuses('write')
    await tick(20)
    helper.getNode('write').receive({ payload: 1 })
    await until(() => seen.length > 1, 'the second status, a second later')
    assert.deepEqual(seen, [
      { fill: 'yellow', shape: 'ring', text: 'connecting' },
      { fill: 'green', shape: 'dot', text: 'written' }
    ])
  })
})
