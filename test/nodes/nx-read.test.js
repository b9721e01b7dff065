'use strict'
const assert = require('node:assert/strict')
const { helper, lineNode, load, openWire, plcNode, reader, statuses, tick, until } = require('./bench')

const TAGS = [
  { name: 'level', address: 'W10', type: 'float32', unit: 'mm', label: 'Level' },
  { name: 'speed', address: 'M5', type: 'int16', scale: '0.1', deadband: '1' }
]

describe('nx-read', () => {
  let wire
  before(() => helper.startServer())
  after(() => helper.stopServer())
  beforeEach(async () => {
    wire = await openWire({ stations: [1, 2] })
    const [plc] = wire.plcs
    plc.set('M0', 7)
    plc.set('M1', 8)
    plc.set('M5', 253)
    plc.set('W10', 21.5, 'float32')
    plc.set('K127.12', true)
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

  const ask = async (config, { plc = {}, msg = {} } = {}) => {
    const probes = await load([lineNode(wire), plcNode({ tags: TAGS, ...plc }), reader(config)])
    helper.getNode('read').receive(msg)
    return probes
  }
  const answers = async (config, options) => {
    const { out } = await ask(config, options)
    await until(() => out.length > 0, 'a message')
    await tick(20)
    return out
  }

  it('object: one message, topic = device, the incoming message is kept', async () => {
    const request = { payload: 'asked', topic: 'old', req: { url: '/' }, own: { deep: 1 } }
    const [msg, more] = await answers({ items: ['M0', 'K127.12', 'level', 'speed', 'M0..M1'] }, { msg: request })
    assert.deepEqual(msg.payload, { M0: 7, K127_12: true, level: 21.5, speed: 25.3, M0_M1: [7, 8] })
    assert.equal(msg.topic, 'Oven')
    assert.equal(msg.device, 'Oven')
    assert.equal(msg.quality, 'good')
    assert.ok(Math.abs(msg.timestamp - Date.now()) < 2000)
    assert.deepEqual(msg.own, { deep: 1 })
    assert.deepEqual(msg.req, { url: '/' })
    assert.ok(!('bad' in msg) && !('simulated' in msg))
    assert.equal(more, undefined)
  })

  it('message: one for each item, with parts; each keeps the incoming properties', async () => {
    const out = await answers({ items: ['M0', 'level'], format: 'message' }, { msg: { own: 1 } })
    assert.deepEqual(
      out.map(({ topic, payload, own }) => [topic, payload, own]),
      [
        ['M0', 7, 1],
        ['level', 21.5, 1]
      ]
    )
    assert.equal(out[0].parts.count, 2)
    assert.equal(out[0].parts.id, out[1].parts.id)
    assert.deepEqual(
      out.map(({ parts }) => parts.index),
      [0, 1]
    )
    assert.notEqual(out[0], out[1])
  })

  it('envelope: value, quality, timestamp, unit', async () => {
    const [msg] = await answers({ items: ['level'], format: 'envelope' })
    const { timestamp, ...rest } = msg.payload
    assert.deepEqual(rest, { value: 21.5, quality: 'good', unit: 'mm' })
    assert.equal(typeof timestamp, 'number')
    assert.equal(msg.topic, 'level')
  })

  it('list', async () => {
    const [msg] = await answers({ items: ['M0', 'level'], format: 'list' })
    assert.deepEqual(
      msg.payload.map(({ name, value }) => [name, value]),
      [
        ['M0', 7],
        ['level', 21.5]
      ]
    )
  })

  it('ranges as values, bits as numbers', async () => {
    const [msg] = await answers({ items: ['M0..M1', 'K127.12'], ranges: 'values', booleans: 'number' })
    assert.deepEqual(msg.payload, { M0: 7, M1: 8, K127_12: 1 })
  })

  it('items from msg.items, which is removed; the list does not count then', async () => {
    for (const items of [['M0', 'speed'], 'M0, speed']) {
      const [msg] = await answers({ itemsType: 'msg', items: ['M99'], interval: '1000' }, { msg: { items } })
      assert.deepEqual(msg.payload, { M0: 7, speed: 25.3 })
      assert.ok(!('items' in msg))
      await helper.unload()
    }
  })

  for (const [what, items] of [
    ['nothing', undefined],
    ['a number', 5],
    ['an empty list', []],
    ['numbers', [1, 2]],
    ['an object with a length', { length: 1e9 }],
    ['far too many', new Array(5000).fill('M0')]
  ]) {
    it(`hostile msg.items: ${what} ends in done(err) with a code`, async () => {
      const { out, caught } = await ask({ itemsType: 'msg' }, { msg: { items } })
      await until(() => caught.length > 0, 'an error')
      assert.match(caught[0].error.code, /^(BAD_ITEMS|TOO_MANY)$/)
      assert.equal(out.length, 0)
    })
  }

  it('an inherited msg.items does not count', async () => {
    const { caught } = await ask({ itemsType: 'msg' }, { msg: Object.create({ items: ['M0'] }) })
    await until(() => caught.length > 0, 'an error')
    assert.equal(caught[0].error.code, 'BAD_ITEMS')
  })

  it('one bad item names itself and does not spoil the others', async () => {
    const { out, caught } = await ask({ items: ['M0', 'Q7', 'K127.16'] })
    await until(() => out.length > 0)
    assert.deepEqual(out[0].payload, { M0: 7 })
    assert.equal(out[0].quality, 'bad')
    assert.equal(out[0].bad.Q7.code, 'UNKNOWN_AREA')
    assert.equal(out[0].bad.K127_16.code, 'BAD_BIT')
    assert.match(out[0].bad.Q7.text, /Q7/)
    await tick(20)
    assert.deepEqual(caught.map(({ error }) => error.code).sort(), ['BAD_BIT', 'UNKNOWN_AREA'])
  })

  it('badValues null', async () => {
    const [msg] = await answers({ items: ['M0', 'Q7'], badValues: 'null' })
    assert.deepEqual(msg.payload, { M0: 7, Q7: null })
  })

  it('no answer: an error with its code, no message; as envelope a message that says bad', async () => {
    wire.wire.setOff(1, true)
    const { out, caught } = await ask({ items: ['M0'] }, { msg: { own: 5 } })
    await until(() => caught.length > 0)
    assert.equal(caught[0].error.code, 'TIMEOUT')
    assert.match(caught[0].error.message, /station 1/)
    assert.equal(caught[0].own, 5)
    assert.equal(out.length, 0)
    await helper.unload()
    const [msg] = await answers({ items: ['M0'], format: 'envelope' })
    assert.equal(msg.payload.quality, 'bad')
    assert.equal(msg.payload.value, null)
  })

  /** At least this many polls begin and end from now on. */
  const polls = async (count, { counts } = wire.plcs[0]) => {
    // one may be under way, with values of before
    const enough = counts.executed + count + 1
    await until(() => counts.executed >= enough, `${count} polls`)
  }

  it('polls at its interval; report changed sends only what changed, beyond the deadband', async () => {
    const { out } = await load([
      lineNode(wire),
      plcNode({ tags: TAGS }),
      reader({ items: ['M0', 'speed'], interval: '20', report: 'changed' })
    ])
    await until(() => out.length === 1)
    wire.plcs[0].set('M0', 9)
    await until(() => out.length === 2)
    wire.plcs[0].set('M5', 255)
    await polls(2)
    wire.plcs[0].set('M5', 300)
    await until(() => out.length === 3)
    assert.deepEqual(
      out.map(({ payload }) => payload),
      [{ M0: 7, speed: 25.3 }, { M0: 9 }, { speed: 30 }]
    )
  })

  it('polled, message: those of one poll belong together, and to nothing else', async () => {
    const { out } = await load([
      lineNode(wire),
      plcNode(),
      reader({ items: ['M0', 'M1'], interval: '20', format: 'message' })
    ])
    await until(() => out.length >= 4)
    const [first, second, third, fourth] = out.map(({ _msgid, topic, payload, parts }) => ({
      text: `${topic} ${payload} ${parts.index}`,
      id: _msgid,
      sequence: parts.id
    }))
    assert.deepEqual([first.text, second.text, third.text, fourth.text], ['M0 7 0', 'M1 8 1', 'M0 7 0', 'M1 8 1'])
    assert.ok(first.id && first.id === second.id && third.id === fourth.id && first.id !== third.id)
    assert.ok(first.sequence === second.sequence && third.sequence === fourth.sequence)
  })

  it('report allOnChange sends everything, but only if something changed', async () => {
    const { out } = await load([
      lineNode(wire),
      plcNode(),
      reader({ items: ['M0', 'M1'], interval: '20', report: 'allOnChange' })
    ])
    await until(() => out.length === 1)
    await polls(2)
    assert.equal(out.length, 1)
    wire.plcs[0].set('M1', 1)
    await until(() => out.length === 2)
    assert.deepEqual(out[1].payload, { M0: 7, M1: 1 })
  })

  it('maxSilence: what has not changed is reported again', async () => {
    const quiet = { items: ['M0'], interval: '20', report: 'changed' }
    const { out } = await load([lineNode(wire), plcNode(), reader({ ...quiet, maxSilence: '60' })])
    await until(() => out.length >= 3)
    assert.deepEqual(
      out.slice(0, 3).map(({ payload }) => payload),
      Array(3).fill({ M0: 7 })
    )
    assert.ok(wire.plcs[0].counts.executed >= 5, String(wire.plcs[0].counts.executed))
  })

  it('asks for more than the line can do: who asks for most says so at deploy', async () => {
    const slow = lineNode(wire, { baudRate: '4800' })
    await load([
      slow,
      plcNode(),
      reader({ items: ['M0'], interval: '1000' }),
      reader({ id: 'read2', name: 'Much', items: ['W0..W127'], interval: '300' })
    ])
    const said = () => helper.log().args.filter(([{ msg }]) => /polls of this line want \d+ % of its time/.test(msg))
    await until(() => said().length > 0, 'the advice')
    assert.deepEqual(
      said().map(([{ id }]) => id),
      ['read2']
    )
    assert.match(said()[0][0].msg, /This node asks for most: 58\d ms every 300 ms, 19\d %. Poll every \d+ ms/)
  })

  it('a polled error is reported once, when the state changes', async () => {
    const { out, caught } = await load([
      lineNode(wire),
      plcNode({ attempts: '1' }),
      reader({ items: ['M0'], interval: '20' })
    ])
    await until(() => out.length > 1)
    const [plc] = wire.plcs
    plc.set('M0', 1)
    // the PLC refuses each poll: no quarantine between them, as after a silence
    wire.faults.set('error', 1, 4)
    await until(() => caught.length > 0)
    const sent = out.length
    await until(() => plc.counts.errors >= 5, 'more refused polls')
    assert.equal(caught.length, 1)
    assert.equal(caught[0].error.code, 'PLC_NOT_PERFORMED')
    assert.equal(out.length, sent)
    wire.faults.clear()
    await until(() => out.length > sent, 'recovery')
    assert.equal(out.at(-1).payload.M0, 1)
  })

  it('several readers of two PLCs on one wire share one connection', async () => {
    const { out } = await load([
      lineNode(wire),
      plcNode(),
      plcNode({ id: 'plc2', name: 'Press', station: 2 }),
      reader({ items: ['M0'], interval: '20' }),
      reader({ id: 'read2', items: ['M1'], interval: '30' }),
      reader({ id: 'read3', plc: 'plc2', items: ['M0'], interval: '20' })
    ])
    await until(() => new Set(out.map(({ topic, payload }) => topic + Object.keys(payload))).size === 3)
    assert.equal(wire.connections(), 1)
    assert.deepEqual(Object.keys(helper.getNode('line').users).sort(), ['read', 'read2', 'read3'])
    assert.deepEqual(Object.keys(helper.getNode('plc').users).sort(), ['read', 'read2'])
  })

  it('status: a ring while connecting, a dot with the count', async () => {
    await load([lineNode(wire), plcNode(), reader({ items: ['M0', 'M1'], interval: '20' })])
    const seen = statuses('read')
    await until(() => seen.length > 1, 'the second status, a second later')
    assert.deepEqual(seen, [
      { fill: 'yellow', shape: 'ring', text: 'connecting' },
      { fill: 'green', shape: 'dot', text: '2 values' }
    ])
  })

  it('late answers: the advice is given once, to the PLC that it concerns', async () => {
    // where a busy process takes its time a late answer is not always seen, and the station would be demoted
    const quick = { timeout: '30', demoteAfter: '0' }
    await load([
      lineNode(wire, { latenessBound: '60' }),
      plcNode(quick),
      plcNode({ id: 'plc2', name: 'Press', station: 2, ...quick }),
      reader({ items: ['M0'], interval: '60' }),
      reader({ id: 'read2', plc: 'plc2', items: ['M0'], interval: '60' })
    ])
    const warnings = { plc: [], plc2: [] }
    for (const id of Object.keys(warnings)) {
      helper.getNode(id).on('call:warn', call => warnings[id].push(call.args[0]))
    }
    const seen = statuses('read')
    wire.faults.set('late', 1, 40)
    await until(() => warnings.plc.length > 0 && warnings.plc2.length > 0, 'the advice')
    const told = () => helper.log().args.filter(([{ msg }]) => /Raise the timeout/.test(msg)).length
    await until(() => wire.faults.counts.late > 8, 'more late answers')
    assert.match(warnings.plc[0], /Station 1 answers \d+ ms after its timeout of 30 ms\. Raise the timeout to \d+00 ms/)
    assert.match(warnings.plc2[0], /Station 2 answers/)
    assert.equal(told(), 2)
    await until(() => seen.some(({ text }) => /^raise timeout: \d+/.test(text)), 'a status that gives the advice')
  })

  it('a simulated line marks its messages and its status', async () => {
    const line = { id: 'line', type: 'plc-line', transport: 'simulated' }
    const { out } = await load([
      line,
      plcNode({ name: '', timeout: '1000' }),
      reader({ items: ['M0', 'W10:float32'], interval: '20' })
    ])
    const seen = statuses('read')
    await until(() => out.length > 0)
    assert.equal(out[0].simulated, true)
    assert.equal(out[0].topic, 'NX PLC 1')
    await until(() => seen.some(({ text }) => text === 'SIM 2 values'), 'the status, a second later')
    assert.ok(seen.every(({ text }) => text.startsWith('SIM ')))
  })
})
