'use strict'
const assert = require('node:assert/strict')
const { helper, lineNode, load, openMixedWire, regulator, statuses, tick, until, zoneNode } = require('./bench')
const { sharedPool } = require('../../nodes/pool')

const TAGS = [
  { name: 'manual_output', address: '400001', scale: 0.1, writable: true, min: 0, max: 80 },
  { name: 'limited', address: '400005', min: 0, max: 10 },
  { name: 'fixedOnly', address: '400009' },
  { name: 'remote', address: '401001.15', writable: true }
]

describe('chino-regulator, writing', () => {
  let wire
  before(() => helper.startServer())
  after(() => helper.stopServer())
  beforeEach(async () => {
    wire = await openMixedWire({ stations: [1, 2] })
  })
  afterEach(async () => {
    await helper.unload()
    try {
      await until(() => wire.connections() === 0, 'the end of the connection')
    } finally {
      await wire.close()
    }
  })

  const zone = more => zoneNode({ tags: TAGS, access: 'write', ...more })
  const writes = () => [...wire.stations[0].writes.values()].reduce((sum, count) => sum + count, 0)
  const give = async (config, msg, more) => {
    const probes = await load([lineNode(wire), zone(more), regulator({ mode: 'write', ...config })])
    helper.getNode('regulator').receive(msg)
    return probes
  }
  const confirmed = async (config, msg, more) => {
    const { out, failed, caught } = await give(config, msg, more)
    await until(() => out.length + failed.length + caught.length > 0, 'a message')
    assert.deepEqual([...failed.map(it => it.write), ...caught.map(({ error }) => error)], [])
    return out[0]
  }
  const refused = async (config, msg, more) => {
    const { out, failed, caught } = await give(config, msg, more)
    await until(() => caught.length > 0, 'an error')
    await tick(10)
    assert.equal(caught.length, 1)
    assert.equal(out.length + failed.length, 0)
    return caught[0]
  }
  /** The queries on the wire, without their check codes. */
  const sentFrames = () => {
    const lease = sharedPool().open(helper.getNode('line').settings, { id: 'look', name: 'look' })
    const frames = lease.line.trace().filter(({ dir }) => dir === 'out')
    lease.release()
    return frames.map(({ bytes }) => bytes.slice(0, -4).match(/../g).join(' '))
  }

  it('a fixed target, scaled back; confirmed on the first output, everything kept', async () => {
    const msg = await confirmed({ target: 'manual_output' }, { payload: '42.5', topic: 'slider', own: 3 })
    assert.equal(wire.stations[0].get('400001'), 425)
    assert.deepEqual([msg.payload, msg.own, msg.topic, msg.device], ['42.5', 3, 'manual_output', 'Zone'])
    const { ms, items, ...write } = msg.write
    assert.deepEqual(write, { outcome: 'confirmed', attempts: 1 })
    assert.equal(items[0].item, 'manual_output')
    assert.ok(Number.isInteger(ms))
    assert.equal(writes(), 1)
  })

  it('a message that asks is refused: with another mode its payload would become a set value', async () => {
    const { error } = await refused({ target: 'manual_output' }, { payload: '42.5', items: ['300001'] })
    assert.equal(error.code, 'NOTHING_TO_WRITE')
    assert.equal(writes(), 0)
  })

  it('pairs of an object, the item in msg.topic, a range with an array', async () => {
    const ranges = { writableRanges: '400020..400029, 001001' }
    const msg = await confirmed({}, { payload: { manual_output: 20, 400020: 7, '001001': true } }, ranges)
    const [station] = wire.stations
    assert.deepEqual([station.get('400001'), station.get('400020'), station.get('001001')], [200, 7, true])
    assert.equal(msg.topic, 'Zone')
    await helper.unload()
    await confirmed({}, { topic: 'manual_output', payload: 30 })
    assert.equal(station.get('400001'), 300)
    await helper.unload()
    await confirmed({ target: '400060..400062' }, { payload: [1, 2, 3] })
    assert.deepEqual(
      ['400060', '400061', '400062'].map(item => station.get(item)),
      [1, 2, 3]
    )
  })

  it('one bit of a register: the others stay, read and write in one go', async () => {
    wire.stations[0].set('401001', 0x0104)
    await confirmed({ target: 'remote' }, { payload: true })
    assert.equal(wire.stations[0].get('401001'), 0x8104)
    assert.deepEqual(sentFrames(), ['01 03 03 e8 00 01', '01 10 03 e8 00 01 02 81 04'])
  })

  for (const [settings, target, payload, frames] of [
    [{ holdingFunction: '10' }, '400002', 3, ['01 10 00 01 00 01 02 00 03']],
    [{ holdingFunction: '06' }, '400002', 3, ['01 06 00 01 00 03']],
    [{ holdingFunction: 'auto' }, '400002', 3, ['01 06 00 01 00 03']],
    [{ holdingFunction: 'auto' }, '400002..400003', [10, 258], ['01 10 00 01 00 02 04 00 0a 01 02']],
    [{ holdingFunction: '06' }, '400002..400003', [10, 258], ['01 06 00 01 00 0a', '01 06 00 02 01 02']],
    [{ holdingWrite: '1' }, '400002..400003', [1, 2], ['01 10 00 01 00 01 02 00 01', '01 10 00 02 00 01 02 00 02']],
    [{ coilFunction: '0F' }, 'co172', true, ['01 0f 00 ac 00 01 01 01']],
    [{ coilFunction: '05' }, 'co172', true, ['01 05 00 ac ff 00']],
    [{ coilFunction: 'auto' }, 'co172', false, ['01 05 00 ac 00 00']],
    [{ coilWrite: '2' }, 'co0..co3', [1, 0, 0, 1], ['01 0f 00 00 00 02 01 01', '01 0f 00 02 00 02 01 02']]
  ]) {
    it(`${JSON.stringify(settings)} ${target}: ${frames.join(', ')}`, async () => {
      await confirmed({ target }, { payload }, settings)
      // 05 and 06 are answered by their echo: a read before the first of them tells an adapter that hears itself
      const written = sentFrames().filter(frame => !/^01 0[1-4]/.test(frame))
      assert.deepEqual(written, frames)
    })
  }

  for (const [what, config, msg, code, more] of [
    ['no target, no topic', {}, { payload: 1 }, 'NOTHING_TO_WRITE'],
    ['an empty text', { target: '400002' }, { payload: '' }, 'BAD_VALUE'],
    ['null', { target: '400002' }, { payload: null }, 'BAD_VALUE'],
    ['NaN', { target: '400002' }, { payload: NaN }, 'BAD_VALUE'],
    ['too large for the register', { target: '400002' }, { payload: 65536 }, 'VALUE_OUT_OF_RANGE'],
    ['above max', { target: 'manual_output' }, { payload: 80.1 }, 'VALUE_OUT_OF_RANGE'],
    ['above max under its address', { target: 'hr4' }, { payload: 11 }, 'VALUE_OUT_OF_RANGE'],
    ['a bit of a limited register', { target: '400005.01' }, { payload: true }, 'NOT_WRITABLE'],
    ['a tag that is not writable, by a message', {}, { topic: 'fixedOnly', payload: 1 }, 'NOT_WRITABLE'],
    ['an address outside the ranges', {}, { payload: { 400030: 1 } }, 'NOT_WRITABLE', { writableRanges: '400020' }],
    ['one bad pair stops all', {}, { payload: { manual_output: 30, 400099: 1 } }, 'NOT_WRITABLE'],
    ['a number that lost its zeros', {}, { payload: { 1001: true } }, 'BAD_ADDRESS'],
    ['a retained message', { target: '400002' }, { payload: 1, retain: true }, 'RETAINED_REFUSED'],
    ['a read-only regulator, by a message', {}, { payload: { manual_output: 3 } }, 'READ_ONLY', { access: 'read' }]
  ]) {
    it(`refused before anything is sent: ${what}`, async () => {
      const { error, write } = await refused(config, msg, more)
      assert.equal(error.code, code)
      assert.deepEqual([write.outcome, write.code], ['refused', code])
      assert.equal(wire.stations[0].counts.queries, 0)
    })
  }

  for (const [target, code, more] of [
    ['400002', 'READ_ONLY', { access: 'read' }],
    ['300001', 'NOT_WRITABLE', {}],
    ['101001', 'NOT_WRITABLE', {}],
    ['301001.05', 'NOT_WRITABLE', {}]
  ]) {
    it(`the fixed target ${target} is refused at deploy: ${code}`, async () => {
      const { caught } = await load([lineNode(wire), zone(more), regulator({ mode: 'write', target })])
      await until(() => caught.length === 1, 'the error of the deploy')
      assert.equal(caught[0].error.code, code)
      helper.getNode('regulator').receive({ payload: 1 })
      await until(() => caught.length === 2)
      assert.equal(caught[1].error.code, code)
      assert.equal(wire.stations[0].counts.queries, 0)
    })
  }

  it('no answer: unknown, sent exactly once', async () => {
    wire.wire.setOff(1, true)
    const { error, write } = await refused({ target: '400002' }, { payload: 1 }, { timeout: '60' })
    assert.deepEqual([write.outcome, write.attempts, error.code], ['unknown', 1, 'WRITE_UNKNOWN'])
  })

  it('onFailure output: the second output and no error', async () => {
    const { out, failed, caught } = await give({ target: '400002', onFailure: 'output' }, { payload: 'x', own: 1 })
    await until(() => failed.length > 0)
    await tick(10)
    assert.deepEqual([out.length, failed.length, caught.length], [0, 1, 0])
    assert.deepEqual([failed[0].write.code, failed[0].own], ['BAD_VALUE', 1])
  })

  it('the regulator refuses a value: outcome refused with exception 03', async () => {
    await wire.close()
    wire = await openMixedWire({ stations: [{ station: 1, protect: ['400002'] }] })
    const { error, write } = await refused({ target: '400002' }, { payload: 1 })
    assert.deepEqual([write.outcome, error.code], ['refused', 'MODBUS_ILLEGAL_VALUE'])
  })

  it('exception 04 after a write: nobody knows', async () => {
    wire.faults.set('error', 1, 4)
    const { error, write } = await refused({ target: '400002' }, { payload: 1 })
    assert.deepEqual([write.outcome, error.code], ['unknown', 'WRITE_UNKNOWN'])
  })

  it('verify reads back', async () => {
    await confirmed({ target: '400002', verify: true }, { payload: 5 })
    assert.deepEqual(sentFrames(), ['01 10 00 01 00 01 02 00 05', '01 03 00 01 00 01'])
  })

  it('coalesce: while the line is busy only the latest value is written', async () => {
    const { out, caught } = await load([
      lineNode(wire),
      zone(),
      regulator({ mode: 'write', target: '400002', coalesce: true })
    ])
    for (let value = 1; value <= 20; value++) helper.getNode('regulator').receive({ payload: value })
    await until(() => out.at(-1)?.payload === 20)
    assert.equal(wire.stations[0].get('400002'), 20)
    assert.ok(writes() < 10, `${writes()} writes`)
    assert.equal(caught.length, 0)
  })

  it('in the mode write nothing is polled', async () => {
    const { out } = await load([
      lineNode(wire),
      zone(),
      regulator({ mode: 'write', items: ['400001'], interval: '20', target: '400002' })
    ])
    helper.getNode('regulator').receive({ payload: 6 })
    await until(() => out.length === 1)
    await tick(50)
    assert.deepEqual(sentFrames(), ['01 10 00 01 00 01 02 00 06'])
  })

  it('status: what became of it', async () => {
    await load([lineNode(wire), zone(), regulator({ mode: 'write', target: '400002' })])
    const seen = statuses('regulator')
    await tick(20)
    helper.getNode('regulator').receive({ payload: 1 })
    await until(() => seen.length > 1, 'the second status, a second later')
    assert.deepEqual(seen.at(-1), { fill: 'green', shape: 'dot', text: 'written' })
  })

  describe('mode both', () => {
    const both = more =>
      regulator({ mode: 'both', items: ['manual_output', '400002'], interval: '0', onFailure: 'output', ...more })
    const start = async (config, more) => load([lineNode(wire), zone(more), both(config)])

    it('polls on the first output, writes on the second, failures on the third', async () => {
      const { out, written, failed, caught } = await start({ interval: '20', target: 'manual_output' })
      await until(() => out.length > 0)
      helper.getNode('regulator').receive({ payload: 55, own: 1 })
      helper.getNode('regulator').receive({ payload: 99 })
      await until(() => written.length === 1 && failed.length === 1)
      await until(() => out.at(-1).payload.manual_output === 55, 'the new value')
      assert.deepEqual([written[0].write.outcome, written[0].own], ['confirmed', 1])
      assert.deepEqual([failed[0].write.outcome, failed[0].write.code], ['refused', 'VALUE_OUT_OF_RANGE'])
      assert.equal(caught.length, 0)
      assert.ok(out.every(msg => !('write' in msg)))
    })

    it('onFailure error: not confirmed goes to the Catch node', async () => {
      const { written, failed, caught } = await start({ onFailure: 'error', target: 'manual_output' })
      helper.getNode('regulator').receive({ payload: 99 })
      await until(() => caught.length === 1)
      assert.deepEqual([caught[0].error.code, written.length, failed.length], ['VALUE_OUT_OF_RANGE', 0, 0])
    })

    for (const [what, items, payload] of [
      ['true: the list of the node', true, { manual_output: 0, _400002: 0 }],
      ['an array', ['400003'], { _400003: 0 }],
      ['a text', '400003, manual_output', { _400003: 0, manual_output: 0 }]
    ]) {
      it(`msg.items ${what}`, async () => {
        const { out, written, failed } = await start()
        helper.getNode('regulator').receive({ items, payload: 5, topic: 'manual_output', own: 1 })
        await until(() => out.length === 1)
        assert.deepEqual([out[0].payload, out[0].own, 'items' in out[0]], [payload, 1, false])
        await tick(10)
        assert.deepEqual([written.length, failed.length, writes()], [0, 0, 0])
      })
    }

    for (const items of [undefined, 5, [], {}]) {
      it(`msg.items ${JSON.stringify(items)} is an error, and no write`, async () => {
        const { out, written, failed, caught } = await start({ target: 'manual_output' })
        helper.getNode('regulator').receive({ items, payload: 5 })
        await until(() => caught.length === 1)
        assert.equal(caught[0].error.code, 'BAD_ITEMS')
        assert.deepEqual([out.length, written.length, failed.length, writes()], [0, 0, 0, 0])
      })
    }

    it('an inherited msg.items does not count: the message writes', async () => {
      const { written } = await start({ target: 'manual_output' })
      helper.getNode('regulator').receive(Object.assign(Object.create({ items: true }), { payload: 5 }))
      await until(() => written.length === 1)
      assert.equal(wire.stations[0].get('400001'), 50)
    })

    it('without a list: msg.items true is an error', async () => {
      const { caught } = await start({ itemsType: 'msg', items: [] })
      helper.getNode('regulator').receive({ items: true })
      await until(() => caught.length === 1)
      assert.equal(caught[0].error.code, 'BAD_ITEMS')
    })

    it('a fixed target that cannot be written refuses the node, and leaves no poll behind', async () => {
      const { caught } = await start({ interval: '20', target: '300001' })
      await until(() => caught.length === 1)
      assert.equal(caught[0].error.code, 'NOT_WRITABLE')
      await tick(50)
      assert.equal(wire.stations[0].counts.queries, 0)
    })

    it('a faulty row of the tag table stops the writing only', async () => {
      const tags = [...TAGS, { name: 'broken', address: '1001', min: 1 }]
      const { out, written, caught } = await start({ interval: '20', target: 'manual_output' }, { tags })
      await until(() => out.length > 0)
      await until(() => caught.length === 1)
      helper.getNode('regulator').receive({ payload: 5 })
      await until(() => caught.length === 2)
      assert.deepEqual([...new Set(caught.map(({ error }) => error.code))], ['BAD_TAG'])
      assert.deepEqual([written.length, writes()], [0, 0])
    })
  })

  describe('broadcast', () => {
    const all = more => zone({ id: 'all', name: 'All', station: '0', broadcast: true, turnaround: '5', ...more })
    const sender = more => regulator({ mode: 'write', regulator: 'all', target: '400002', ...more })

    it('reaches all, is never confirmed, and is not called a fault', async () => {
      const { failed } = await load([lineNode(wire), all(), sender({ onFailure: 'output' })])
      const seen = statuses('regulator')
      helper.getNode('regulator').receive({ payload: 77 })
      await until(() => failed.length === 1)
      assert.deepEqual([failed[0].write.outcome, failed[0].write.code], ['unknown', 'BROADCAST_UNCONFIRMED'])
      await until(() => wire.stations.every(station => station.get('400002') === 77), 'both stations')
      await until(() => seen.some(({ text }) => text === 'sent to all'), 'the status')
      assert.equal(seen.at(-1).fill, 'yellow')
    })

    it('on a simulated line it is no station, and reaches those that are', async () => {
      const line = { id: 'line', type: 'plc-line', transport: 'simulated' }
      const { failed, caught } = await load([line, zone(), all(), sender({ onFailure: 'output' })])
      const heater = helper.getNode('line').wire.find(1)
      helper.getNode('regulator').receive({ payload: 77 })
      await until(() => failed.length + caught.length > 0)
      assert.equal(failed[0]?.write.code, 'BROADCAST_UNCONFIRMED')
      await until(() => heater.get('400002') === 77, 'the broadcast')
      assert.equal(helper.getNode('line').wire.find(0), undefined)
    })

    for (const [what, config, more, code] of [
      ['not allowed', {}, { broadcast: false }, 'BROADCAST_REFUSED'],
      ['reading', { mode: 'read', items: ['400001'] }, {}, 'BROADCAST_REFUSED'],
      ['reading and writing', { mode: 'both', items: ['400001'] }, {}, 'BROADCAST_REFUSED'],
      ['reading back', { verify: true }, {}, 'BROADCAST_REFUSED']
    ]) {
      it(`${what}: refused at deploy`, async () => {
        const { caught } = await load([lineNode(wire), all(more), sender(config)])
        await until(() => caught.length === 1)
        assert.equal(caught[0].error.code, code)
        assert.deepEqual(
          wire.stations.map(({ counts }) => counts.broadcasts),
          [0, 0]
        )
      })
    }

    it('one bit of a register cannot be broadcast', async () => {
      const { caught } = await load([lineNode(wire), all(), sender({ target: 'remote' })])
      helper.getNode('regulator').receive({ payload: true })
      await until(() => caught.length > 0)
      assert.equal(caught[0].error.code, 'BROADCAST_REFUSED')
    })
  })
})
