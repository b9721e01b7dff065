'use strict'
const assert = require('node:assert/strict')
const { helper, lineNode, load, openMixedWire, regulator, statuses, tick, until, zoneNode } = require('./bench')
const { statusOf } = require('../../nodes/status')
const { sharedPool } = require('../../nodes/pool')

const TAGS = [
  { name: 'load_current', address: '300003', scale: '0.1', unit: 'A', label: '부하 전류', deadband: '1' },
  { name: 'energy', address: '300007', type: 'uint32' },
  { name: 'swapped', address: '400020', type: 'uint32', wordOrder: 'high' },
  { name: 'alarm', address: '101001' }
]

describe('chino-regulator, reading', () => {
  let wire
  before(() => helper.startServer())
  after(() => helper.stopServer())
  beforeEach(async () => {
    wire = await openMixedWire({ stations: [1, 2] })
    const [zone] = wire.stations
    zone.set('400108', 555)
    zone.set('400109', 0)
    zone.set('400110', 100)
    zone.set('401001', 0x8020)
    zone.set('300003', 123)
    zone.set('ir6', 0x5678)
    zone.set('ir7', 0x0001)
    zone.set('hr19', 0x0001)
    zone.set('hr20', 0x5678)
    zone.set('101001', true)
    zone.set('co19', true)
    zone.set('co22', true)
  })
  afterEach(async () => {
    await helper.unload()
    try {
      await until(() => wire.connections() === 0, 'the end of the connection')
    } finally {
      await wire.close()
    }
  })

  const ask = async (config, { zone = {}, msg = {} } = {}) => {
    const probes = await load([lineNode(wire), zoneNode({ tags: TAGS, ...zone }), regulator(config)])
    helper.getNode('regulator').receive(msg)
    return probes
  }
  const answers = async (config, options) => {
    const { out } = await ask(config, options)
    await until(() => out.length > 0, 'a message')
    await tick(20)
    return out
  }

  it('every kind of address and tag in one message; the incoming message is kept', async () => {
    const items = ['400108..400110', 'hr107', '401001.15', '401001.04', 'load_current', 'energy', 'swapped', 'alarm']
    const msg = { payload: 'asked', topic: 'old', own: { deep: 1 } }
    const [first, more] = await answers({ items: [...items, 'co19:uint16', '40110'] }, { msg })
    assert.deepEqual(first.payload, {
      _400108_400110: [555, 0, 100],
      hr107: 555,
      _401001_15: true,
      _401001_04: false,
      load_current: 12.3,
      energy: 0x15678,
      swapped: 0x15678,
      alarm: true,
      co19: 9,
      _400110: 100
    })
    assert.equal(first.topic, 'Zone')
    assert.equal(first.device, 'Zone')
    assert.equal(first.quality, 'good')
    assert.deepEqual(first.own, { deep: 1 })
    assert.equal(more, undefined)
  })

  it('in ASCII, too', async () => {
    await wire.close()
    wire = await openMixedWire({ stations: [1], protocol: 'ascii' })
    wire.stations[0].set('hr0', 4711)
    const [msg] = await answers({ items: ['400001'] }, { zone: { protocol: 'ascii' } })
    assert.deepEqual(msg.payload, { _400001: 4711 })
  })

  it('0-base: the printed number is the number on the wire', async () => {
    const [msg] = await answers({ items: ['400107', 'hr107'] }, { zone: { addressMode: '0-base' } })
    assert.deepEqual(msg.payload, { _400107: 555, hr107: 555 })
  })

  it('the word order of the configuration is that of a tag without one', async () => {
    const tags = [...TAGS, { name: 'plain', address: '400020', type: 'uint32' }]
    const [msg] = await answers({ items: ['plain', 'swapped'] }, { zone: { wordOrder: 'high', tags } })
    assert.deepEqual(msg.payload, { plain: 0x15678, swapped: 0x15678 })
  })

  /** The queries on the wire, without their check codes. */
  const sentFrames = () => {
    const lease = sharedPool().open(helper.getNode('line').settings, { id: 'look', name: 'look' })
    const frames = lease.line.trace().filter(({ dir }) => dir === 'out')
    lease.release()
    return frames.map(({ bytes }) => bytes.slice(0, -4).match(/../g).join(' '))
  }

  for (const [setting, count, items, frames] of [
    ['holdingRead', '2', ['400108..400111'], ['01 03 00 6b 00 02', '01 03 00 6d 00 02']],
    ['inputRead', '1', ['300003..300004'], ['01 04 00 02 00 01', '01 04 00 03 00 01']],
    ['coilRead', '8', ['co0..co15'], ['01 01 00 00 00 08', '01 01 00 08 00 08']],
    ['coilUnit', '16', ['co19'], ['01 01 00 13 00 10']],
    ['discreteUnit', '16', ['101001'], ['01 02 03 e8 00 10']],
    ['discreteRead', '4', ['di0..di7'], ['01 02 00 00 00 04', '01 02 00 04 00 04']]
  ]) {
    it(`${setting} ${count} is kept: ${frames.join(', ')}`, async () => {
      await answers({ items }, { zone: { [setting]: count } })
      assert.deepEqual(sentFrames(), frames)
    })
  }

  it('message: one for each item, with parts; envelope: with quality and unit; list', async () => {
    const [first, second] = await answers({ items: ['400108', 'load_current'], format: 'message' }, { msg: { own: 1 } })
    assert.deepEqual([first.topic, first.payload, first.own], ['_400108', 555, 1])
    assert.deepEqual([second.topic, second.payload, second.own], ['load_current', 12.3, 1])
    assert.equal(first.parts.id, second.parts.id)
    await helper.unload()
    const [{ payload }] = await answers({ items: ['load_current'], format: 'envelope' })
    assert.deepEqual([payload.value, payload.quality, payload.unit], [12.3, 'good', 'A'])
    await helper.unload()
    const [list] = await answers({ items: ['load_current'], format: 'list' })
    assert.deepEqual([list.payload[0].name, list.payload[0].label], ['load_current', '부하 전류'])
  })

  it('ranges as values, bits as numbers', async () => {
    const [msg] = await answers({ items: ['400108..400110', 'alarm'], ranges: 'values', booleans: 'number' })
    assert.deepEqual(msg.payload, { _400108: 555, _400109: 0, _400110: 100, alarm: 1 })
  })

  it('items from msg.items, which is removed', async () => {
    for (const items of [['400108', 'alarm'], '400108, alarm']) {
      const [msg] = await answers({ itemsType: 'msg', items: [] }, { msg: { items } })
      assert.deepEqual(msg.payload, { _400108: 555, alarm: true })
      assert.ok(!('items' in msg))
      await helper.unload()
    }
  })

  for (const [what, items] of [
    ['nothing', undefined],
    ['a number', 400108],
    ['numbers', [400108]],
    ['true without a list', true],
    ['far too many', new Array(5000).fill('400001')]
  ]) {
    it(`hostile msg.items: ${what} ends in done(err) with a code`, async () => {
      const { out, caught } = await ask({ itemsType: 'msg' }, { msg: { items } })
      await until(() => caught.length > 0, 'an error')
      assert.match(caught[0].error.code, /^(BAD_ITEMS|TOO_MANY)$/)
      assert.equal(out.length, 0)
    })
  }

  it('in the mode read nothing is written, whatever comes', async () => {
    const { out } = await ask(
      { mode: 'read', items: ['400108'], target: '400108' },
      { zone: { access: 'write' }, msg: { payload: 9, topic: '400108' } }
    )
    await until(() => out.length > 0)
    assert.deepEqual(out[0].payload, { _400108: 555 })
    assert.equal(wire.stations[0].writes.size, 0)
  })

  it('one bad item names itself and does not spoil the others', async () => {
    const { out, caught } = await ask({ items: ['400108', '1001', '401001.1'] })
    await until(() => out.length > 0)
    assert.deepEqual(out[0].payload, { _400108: 555 })
    assert.deepEqual(
      Object.values(out[0].bad).map(({ code }) => code),
      ['BAD_ADDRESS', 'BAD_ADDRESS']
    )
    await tick(20)
    assert.equal(caught.length, 2)
    assert.match(caught[0].error.message, /001001/)
  })

  it('an address that the regulator does not have is bad alone, with the code of exception 02', async () => {
    await wire.close()
    wire = await openMixedWire({ stations: [{ station: 1, tables: { hr: ['400001..400010', '400012'] } }] })
    wire.stations[0].set('400010', 7)
    const [msg] = await answers({ items: ['400010', '400011', '400012'] })
    assert.deepEqual(msg.payload, { _400010: 7, _400012: 0 })
    assert.equal(msg.bad._400011.code, 'MODBUS_ILLEGAL_ADDRESS')
    assert.equal(msg.quality, 'bad')
  })

  for (const [exception, code, key] of [
    [1, 'MODBUS_ILLEGAL_FUNCTION', 'rejected'],
    [2, 'MODBUS_ILLEGAL_ADDRESS', 'noAddress'],
    [3, 'MODBUS_ILLEGAL_VALUE', 'rejected'],
    [4, 'MODBUS_DEVICE_FAILURE', 'deviceFailure'],
    [5, 'MODBUS_ACKNOWLEDGE', 'deviceBusy'],
    [6, 'MODBUS_BUSY', 'deviceBusy'],
    [7, 'MODBUS_NEGATIVE_ACKNOWLEDGE', 'rejected'],
    [8, 'MODBUS_MEMORY_PARITY', 'deviceFailure'],
    [10, 'MODBUS_GATEWAY_PATH', 'gateway'],
    [11, 'MODBUS_GATEWAY_TARGET', 'gateway'],
    [77, 'MODBUS_EXCEPTION', 'rejected']
  ]) {
    it(`exception ${exception}: ${code} for a Catch node, and a status that says so`, async () => {
      const { out, caught } = await load([lineNode(wire), zoneNode(), regulator({ items: ['400108'] })])
      wire.faults.set('error', 1, exception)
      helper.getNode('regulator').receive({})
      await until(() => caught.length > 0)
      assert.equal(caught[0].error.code, code)
      assert.equal(out.length, 0)
      const { fill, shape, key: shown } = statusOf({ phase: 'failed', code })
      assert.deepEqual([fill, shape, shown], ['red', 'ring', key])
    })
  }

  it('answers come too late: the status says which timeout would do', () => {
    const late = statusOf({ phase: 'read', count: 2, bad: 2, code: 'TIMEOUT', advice: 1700 })
    assert.deepEqual([late.fill, late.key, late.values], ['red', 'raiseTimeout', { ms: 1700 }])
    assert.equal(statusOf({ phase: 'read', count: 2, bad: 2, code: 'CRC_ERROR', advice: 1700 }).key, 'damaged')
  })

  it('no answer: TIMEOUT; as envelope a message that says bad', async () => {
    wire.wire.setOff(1, true)
    const { out, caught } = await ask({ items: ['400108'] }, { msg: { own: 5 } })
    await until(() => caught.length > 0)
    assert.equal(caught[0].error.code, 'TIMEOUT')
    assert.match(caught[0].error.message, /station 1/)
    assert.equal(caught[0].own, 5)
    assert.equal(out.length, 0)
    await helper.unload()
    const [msg] = await answers({ items: ['400108'], format: 'envelope' })
    assert.deepEqual([msg.payload.quality, msg.payload.value], ['bad', null])
  })

  it('polls; report changed sends only what changed, beyond the deadband', async () => {
    const { out } = await load([
      lineNode(wire),
      zoneNode({ tags: TAGS }),
      regulator({ items: ['400108', 'load_current'], interval: '20', report: 'changed' })
    ])
    await until(() => out.length === 1)
    const [zone] = wire.stations
    zone.set('400108', 9)
    await until(() => out.length === 2)
    zone.set('300003', 130)
    const enough = zone.counts.executed + 6
    await until(() => zone.counts.executed >= enough, 'more polls')
    zone.set('300003', 200)
    await until(() => out.length === 3)
    assert.deepEqual(
      out.map(({ payload }) => payload),
      [{ _400108: 555, load_current: 12.3 }, { _400108: 9 }, { load_current: 20 }]
    )
  })

  it('a polled error is reported once, and it comes back by itself', async () => {
    const { out, caught } = await load([lineNode(wire), zoneNode(), regulator({ items: ['400108'], interval: '20' })])
    await until(() => out.length > 1)
    wire.faults.set('error', 1, 4)
    await until(() => caught.length > 0)
    const sent = out.length
    await until(() => wire.stations[0].counts.errors >= 5, 'more refused polls')
    assert.equal(caught.length, 1)
    assert.equal(caught[0].error.code, 'MODBUS_DEVICE_FAILURE')
    assert.equal(out.length, sent)
    wire.faults.clear()
    await until(() => out.length > sent, 'recovery')
  })

  it('an item longer than a request: bad beside others; alone, it is reported once and not in each cycle', async () => {
    const { out } = await ask({ items: ['400108', 'energy'], interval: '20' }, { zone: { inputRead: '1' } })
    await until(() => out.length > 1, 'values')
    assert.deepEqual([out[0].payload, out[0].bad.energy.code], [{ _400108: 555 }, 'FRAME_TOO_LONG'])
    await helper.unload()
    const { caught } = await ask({ items: ['energy'], interval: '10' }, { zone: { inputRead: '1' } })
    const seen = statuses('regulator')
    await tick(50)
    await tick(50)
    // one for the message, one for the polls
    assert.deepEqual(
      caught.map(({ error }) => error.code),
      ['FRAME_TOO_LONG', 'FRAME_TOO_LONG']
    )
    assert.ok(seen.length <= 1, JSON.stringify(seen))
  })

  it('status: a ring while connecting, a dot with the count', async () => {
    await load([lineNode(wire), zoneNode(), regulator({ items: ['400108', '400109'], interval: '20' })])
    const seen = statuses('regulator')
    await until(() => seen.length > 1, 'the second status, a second later')
    assert.deepEqual(seen, [
      { fill: 'yellow', shape: 'ring', text: 'connecting' },
      { fill: 'green', shape: 'dot', text: '2 values' }
    ])
  })

  it('several nodes of two regulators on one wire share one connection', async () => {
    wire.stations[1].set('400108', 2)
    const { out } = await load([
      lineNode(wire),
      zoneNode(),
      zoneNode({ id: 'zone2', name: 'Other', station: '2' }),
      regulator({ items: ['400108'], interval: '20' }),
      regulator({ id: 'more', items: ['400109'], interval: '30' }),
      regulator({ id: 'second', regulator: 'zone2', items: ['400108'], interval: '20' })
    ])
    const seen = () => new Set(out.map(({ topic, payload }) => JSON.stringify([topic, payload])))
    await until(() => seen().size === 3)
    assert.ok(seen().has('["Other",{"_400108":2}]'))
    assert.equal(wire.connections(), 1)
    assert.deepEqual(Object.keys(helper.getNode('zone').users).sort(), ['more', 'regulator'])
  })
})
