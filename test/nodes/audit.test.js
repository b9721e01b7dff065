'use strict'
const assert = require('node:assert/strict')
const {
  helper,
  lineNode,
  load,
  ON_TAB,
  openMixedWire,
  openWire,
  plcNode,
  regulator,
  until,
  writer,
  zoneNode
} = require('./bench')
const { sharedPool } = require('../../nodes/pool')

/** Each write and each refusal of a node is told on its line: which node, which message, what became of it. */

const TAGS = [
  { name: 'valve', address: 'K12', maxStep: 5, min: 0, max: 100, writable: true },
  { name: 'broken', address: 'K999' }
]
const GOOD = TAGS.slice(0, 1)

const listen = () => {
  const events = []
  sharedPool()
    .lines()[0]
    .line.on('event', event => event.event === 'audit' && events.push(event))
  return events
}

let count = 0
/** Gives a node a message, and waits for its audit. */
const give = async (id, msg, events) => {
  const known = events.length
  const _msgid = `m${++count}`
  helper.getNode(id).receive({ _msgid, ...msg })
  await until(() => events.length > known, 'an audit')
  assert.equal(events.length, known + 1)
  const event = events[known]
  assert.deepEqual(event.by, { node: id, name: `name of ${id}`, message: _msgid })
  assert.ok(Math.abs(event.since - Date.now()) < 5000)
  return event
}
const named = node => ({ ...node, name: `name of ${node.id}` })
const short = ({ device, outcome, code, items }) => [
  device,
  outcome,
  code,
  items.map(({ item, value }) => [item, value])
]

describe('audit of what nodes write', () => {
  let wire
  before(() => helper.startServer())
  after(() => helper.stopServer())
  afterEach(async () => {
    await helper.unload()
    if (wire) {
      try {
        await until(() => wire.connections() === 0, 'the end of the connection')
      } finally {
        await wire.close()
        wire = null
      }
    }
    assert.deepEqual(sharedPool().lines(), [], 'a line is left open')
  })

  it('nx-write: each outcome and each refusal, with node and message; and none of it is a warning', async () => {
    wire = await openWire({ stations: [1] })
    const [plc] = wire.plcs
    const flow = [lineNode(wire), plcNode({ tags: GOOD, access: 'write' }), named(writer())]
    await load(flow)
    let warnings = 0
    helper.getNode('plc').on('call:warn', () => warnings++)
    const events = listen()
    const told = async (msg, before = () => {}) => {
      before()
      return short(await give('write', msg, events))
    }
    assert.deepEqual(await told({ payload: { valve: '3' } }), ['Oven', 'confirmed', undefined, [['valve', '3']]])
    assert.deepEqual(await told({ topic: 'valve', payload: 9 }), ['Oven', 'refused', 'STEP_TOO_LARGE', [['valve', 9]]])
    assert.deepEqual(await told({ payload: { valve: 101 } }), [
      'Oven',
      'refused',
      'VALUE_OUT_OF_RANGE',
      [['valve', 101]]
    ])
    assert.deepEqual(await told({ topic: 'K5', payload: 1 }), ['Oven', 'refused', 'NOT_WRITABLE', [['K5', 1]]])
    const empty = await told({ topic: 'valve', payload: null })
    assert.deepEqual([empty[2], empty[3][0][0]], ['BAD_VALUE', 'valve'])
    assert.deepEqual(await told({ payload: 1 }), ['Oven', 'refused', 'NOTHING_TO_WRITE', []])
    const retained = { topic: 'valve', payload: 4, retain: true }
    assert.deepEqual(await told(retained), ['Oven', 'refused', 'RETAINED_REFUSED', [['valve', 4]]])
    const silent = () => wire.faults.once('silent', { skip: 1 })
    assert.deepEqual(await told({ payload: { valve: 4 } }, silent), [
      'Oven',
      'unknown',
      'WRITE_UNKNOWN',
      [['valve', 4]]
    ])
    const program = () => plc.setMode('program')
    assert.equal((await told({ payload: { valve: 5 } }, program))[2], 'PLC_NOT_PERFORMED')
    assert.deepEqual([...plc.writes.values()], [2])
    assert.equal(warnings, 0)
  })

  it('nx-write: a write interval of the configuration; with "only the latest" the value waits', async () => {
    wire = await openWire({ stations: [1] })
    const patient = { ...named(writer({ id: 'patient', coalesce: true, target: 'K12' })) }
    const flow = [
      lineNode(wire),
      plcNode({ tags: GOOD, access: 'write', writeInterval: '150' }),
      named(writer()),
      patient
    ]
    const { out } = await load(flow)
    const events = listen()
    assert.equal((await give('write', { payload: { valve: 1 } }, events)).outcome, 'confirmed')
    assert.equal((await give('write', { payload: { valve: 2 } }, events)).code, 'WRITE_TOO_SOON')
    for (const payload of [3, 4]) helper.getNode('patient').receive({ payload })
    await until(() => out.length === 2, 'the value')
    assert.deepEqual(
      events.slice(2).map(({ outcome, code, by }) => [code ?? outcome, by.node]),
      [
        ['SUPERSEDED', 'patient'],
        ['confirmed', 'patient']
      ]
    )
    assert.equal(wire.plcs[0].get('K12'), 4)
    assert.ok(events.at(-1).ms >= 75, `it waited ${events.at(-1).ms} ms`)
  })

  it('a node that is refused at deploy, and one whose tag table is faulty: each message', async () => {
    wire = await openWire({ stations: [1] })
    await load([lineNode(wire), plcNode({ tags: GOOD }), named(writer({ target: 'K0' }))])
    let events = listen()
    assert.deepEqual(short(await give('write', { payload: 1 }, events)), ['Oven', 'refused', 'READ_ONLY', [['K0', 1]]])
    await helper.unload()
    await load([lineNode(wire), plcNode({ tags: TAGS, access: 'write' }), named(writer())])
    events = listen()
    const event = await give('write', { payload: { valve: 1 } }, events)
    assert.deepEqual(short(event), ['Oven', 'refused', 'BAD_TAG', [['valve', 1]]])
    assert.equal(wire.plcs[0].counts.queries, 0)
  })

  it('chino-regulator: written, refused as a question, refused for its tag table', async () => {
    wire = await openMixedWire({ stations: [1] })
    const zone = { tags: [{ name: 'output', address: '400001', writable: true }], access: 'write' }
    await load([lineNode(wire), zoneNode(zone), named(regulator({ mode: 'write' }))])
    let events = listen()
    const first = await give('regulator', { payload: { output: 5 } }, events)
    assert.deepEqual(short(first), ['Zone', 'confirmed', undefined, [['output', 5]]])
    const question = await give('regulator', { items: ['400001'], payload: 1 }, events)
    assert.deepEqual(short(question), ['Zone', 'refused', 'NOTHING_TO_WRITE', []])
    await helper.unload()
    const faulty = { tags: [...zone.tags, { name: 'broken', address: '4000' }], access: 'write' }
    await load([lineNode(wire), zoneNode(faulty), named(regulator({ mode: 'both', itemsType: 'msg' }))])
    events = listen()
    const event = await give('regulator', { payload: { output: 6 } }, events)
    assert.deepEqual(short(event), ['Zone', 'refused', 'BAD_TAG', [['output', 6]]])
  })

  it('incon-link and melsec-c24: sent, refused because it is retained, refused because they only receive', async () => {
    const line = { id: 'line', type: 'plc-line', transport: 'simulated', baudRate: '115200' }
    for (const [type, access] of [
      ['incon-link', 'write'],
      ['melsec-c24', 'write'],
      ['incon-link', 'read']
    ]) {
      await load([line, named({ id: 'link', type, ...ON_TAB, line: 'line', access, wires: [[], []] })])
      const events = listen()
      await until(() => sharedPool().lines()[0].line.state === 'open', 'the line')
      const told = async msg => {
        const { station, outcome, code, text, items } = await give('link', msg, events)
        return [station, outcome, code, text, items.length]
      }
      if (access === 'read') {
        assert.deepEqual(await told({ payload: 'GO' }), [null, 'refused', 'SENDING_OFF', 'GO', 0])
      } else {
        assert.deepEqual(await told({ payload: 'GO' }), [null, 'sent', undefined, 'GO', 0], type)
        const retained = { payload: 'GO', retain: true }
        assert.deepEqual(await told(retained), [null, 'refused', 'RETAINED_REFUSED', 'GO', 0], type)
      }
      await helper.unload()
    }
  })
})
