'use strict'
const assert = require('node:assert/strict')
const fs = require('node:fs')
const os = require('node:os')
const path = require('node:path')
const {
  ON_TAB,
  TAB,
  collect,
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
const { keepEvidence, sharedPool } = require('../../nodes/pool')
const { statusOf } = require('../../nodes/status')

const monitor = (more = {}) => ({
  id: 'monitor',
  type: 'plc-monitor',
  ...ON_TAB,
  line: 'line',
  interval: '0',
  wires: [['events'], ['statistics'], ['frames']],
  ...more
})
const OUTPUTS = ['events', 'statistics', 'frames']

/** With probes at the outputs of the monitor. */
const loadWatched = async nodes => {
  const probes = await load([...nodes, ...OUTPUTS.map(probe)])
  return { ...probes, ...Object.fromEntries(OUTPUTS.map(id => [id, collect(id)])) }
}
const topics = messages => messages.map(({ topic }) => topic)

describe('plc-monitor', () => {
  let wire
  before(() => helper.startServer())
  after(() => helper.stopServer())
  beforeEach(async () => {
    wire = await openWire({ stations: [1, 2] })
    wire.plcs[0].set('M0', 7)
  })
  afterEach(async () => {
    await helper.unload()
    const lines = sharedPool().lines()
    await wire.close()
    assert.deepEqual(lines, [], 'a line is left open')
  })
  const polling = (more = {}) => [lineNode(wire), plcNode(), reader({ items: ['M0'], interval: '20', ...more })]
  const ask = msg => helper.getNode('monitor').receive(msg)

  it('statistics now: for any message, which goes on as it came', async () => {
    const { out, statistics } = await loadWatched([...polling(), monitor()])
    await until(() => out.length > 0, 'a value')
    const { ends, forget } = endsOf('monitor')
    ask({ payload: 'how', res: 'kept', topic: 'mine' })
    const [msg] = await until(() => statistics.length > 0 && statistics, 'the statistics')
    const { payload } = msg
    assert.deepEqual([msg.topic, msg.device, msg.res, msg.simulated], ['Line', 'Line', 'kept', undefined])
    assert.deepEqual([payload.line, payload.state, payload.reason, payload.demoted], ['Line', 'open', null, []])
    assert.ok(payload.queries > 0 && payload.answers > 0 && payload.bytesIn > 0)
    assert.deepEqual(Object.keys(payload.stations), ['1'])
    assert.ok(payload.stations[1].latency.mean >= 0)
    assert.ok(payload.busyPercent >= 0 && payload.busyPercent <= 100)
    const { predicted } = payload
    assert.ok(predicted.percent > predicted.busyPercent && predicted.busyPercent > 0, JSON.stringify(predicted))
    assert.equal(predicted.asksMost, 'read')
    await until(() => ends.size === 1, 'the end of the message')
    forget()
  })

  it('statistics in intervals, also of a line that nobody uses', async () => {
    const seen = await loadWatched([lineNode(wire), monitor({ interval: '100', name: 'M' })])
    const shown = statuses('monitor')
    await until(() => seen.statistics.length >= 2, 'two statistics')
    assert.deepEqual(shown, [{ fill: 'grey', shape: 'ring', text: 'not in use' }])
    const [{ payload, topic }] = seen.statistics
    assert.deepEqual([topic, payload.state, payload.queries], ['M', 'closed', 0])
    assert.deepEqual(sharedPool().lines(), [], 'watching opens no line')
  })

  it('events of the line, as messages: down once, up', async () => {
    const { out, events } = await loadWatched([...polling(), monitor()])
    await until(() => out.length > 0, 'a value')
    wire.drop()
    await until(() => events.length >= 2, 'both events')
    assert.deepEqual(topics(events), ['lineDown', 'lineUp'])
    const [down, up] = events.map(({ payload }) => payload)
    assert.deepEqual(
      [down.event, down.station, typeof down.since, typeof down.code],
      ['lineDown', null, 'number', 'string']
    )
    assert.ok(down.cause && down.remedy && !down.cause.includes(down.remedy))
    assert.ok(up.downFor > 0)
    assert.equal(events[0].device, 'Line')
  })

  it('what devices notice, whatever it is; the node chooses', async () => {
    const chosen = ['all', 'faults', 'audit', 'none']
    const monitors = chosen.map(id => monitor({ id, events: id, wires: [[`of ${id}`], [], []] }))
    await load([...polling(), ...monitors, ...chosen.map(id => probe(`of ${id}`))])
    const heard = Object.fromEntries(chosen.map(id => [id, collect(`of ${id}`)]))
    await until(() => sharedPool().lines()[0]?.line.state === 'open', 'the line')
    const { line } = sharedPool().lines()[0]
    for (const event of ['stationDemoted', 'audit', 'somethingNew']) line.report({ event, station: 1, cause: 'c' })
    await until(() => heard.all.length === 3, 'the last one')
    assert.deepEqual(
      chosen.map(id => topics(heard[id])),
      [['stationDemoted', 'audit', 'somethingNew'], ['stationDemoted', 'somethingNew'], ['audit'], []]
    )
    const [one] = heard.all
    const [other] = heard.faults
    assert.notEqual(one.payload, other.payload, 'each monitor gives an object of its own')
  })

  it('frames, if they are wanted', async () => {
    const two = [monitor({ trace: true }), monitor({ id: 'quiet', wires: [[], [], ['written']] })]
    const { frames, written } = await loadWatched([...polling({ interval: '0' }), ...two])
    helper.getNode('read').receive({})
    await until(() => frames.length === 2, 'query and answer')
    const [{ topic, payload, device }, answer] = frames
    assert.deepEqual([topic, device, payload.dir, payload.station], ['frame', 'Line', 'out', 1])
    assert.match(payload.bytes, /^([0-9a-f]{2})+$/)
    assert.equal(answer.payload.dir, 'in')
    assert.deepEqual(written, [])
  })

  it('status: how the line is, now', async () => {
    const { out } = await loadWatched(polling())
    await until(() => out.length > 0, 'a value')
    await helper.setFlows([TAB, ...polling(), monitor(), ...OUTPUTS.map(probe)], 'nodes')
    const { status } = helper.getNode('monitor')
    assert.ok(status.calledWith({ fill: 'green', shape: 'dot', text: 'line open' }))
  })

  it('status of each state', () => {
    const watching = more => statusOf({ phase: 'watching', ...more })
    const of = ({ fill, shape, key, values }) => [fill, shape, key, values.count]
    assert.deepEqual(of(watching({})), ['grey', 'ring', 'unused', undefined])
    assert.deepEqual(of(watching({ line: { state: 'closed' } })), ['grey', 'ring', 'unused', undefined])
    assert.deepEqual(of(watching({ line: { state: 'opening' } })), ['yellow', 'ring', 'connecting', undefined])
    assert.deepEqual(of(watching({ line: { state: 'jammed' }, demoted: 1 })), ['red', 'ring', 'jammed', undefined])
    const reason = { code: 'PORT_BUSY' }
    assert.deepEqual(of(watching({ line: { state: 'waiting', reason } })), ['red', 'ring', 'busy', undefined])
    assert.deepEqual(of(watching({ line: { state: 'open' }, demoted: 0 })), ['green', 'dot', 'open', undefined])
    assert.deepEqual(of(watching({ line: { state: 'open' }, demoted: 2 })), ['yellow', 'ring', 'stationsDemoted', 2])
  })

  it('a line that cannot be used: check settings, an error for each message', async () => {
    const { caught } = await loadWatched([lineNode(wire, { baudRate: 'fast' }), monitor()])
    await until(() => caught.length > 0, 'the report')
    ask({ payload: 1 })
    await until(() => caught.some(({ payload }) => payload === 1), 'the error of the message')
    assert.ok(caught.every(({ error }) => error.code === 'BAD_SETTING'))
  })

  it('without a line: NO_CONFIGURATION', async () => {
    const { caught } = await loadWatched([monitor({ line: '' })])
    await until(() => caught.length > 0, 'the report')
    assert.equal(caught[0].error.code, 'NO_CONFIGURATION')
  })

  describe('evidence', () => {
    let userDir
    beforeEach(() => {
      userDir = fs.mkdtempSync(path.join(os.tmpdir(), 'monitor-'))
      helper.settings({ userDir })
    })
    afterEach(async () => {
      await helper.unload()
      helper.settings({ userDir: undefined })
      keepEvidence(undefined)
      fs.rmSync(userDir, { recursive: true, force: true })
    })

    it('the frames around a fault, below the user directory; an undeploy has written them', async () => {
      const nodes = [lineNode(wire), plcNode({ station: '9', timeout: '20' }), reader({ items: ['M0'], interval: '0' })]
      const { statistics, caught } = await loadWatched([...nodes, monitor()])
      helper.getNode('read').receive({})
      await until(() => caught.length > 0, 'the timeout')
      ask({ payload: 'evidence', res: 'kept' })
      const [{ topic, payload, res }] = await until(() => statistics.length > 0 && statistics, 'the answer')
      assert.deepEqual(
        [topic, res, payload.error, path.dirname(payload.file)],
        ['evidence', 'kept', null, path.join(userDir, 'serial-plc')]
      )
      const [query, silence, fault] = payload.rows
      assert.deepEqual([query.dir, query.station, silence.note], ['out', 9, 'TIMEOUT'])
      assert.deepEqual([fault.is, fault.station, fault.code], ['fault', 9, 'TIMEOUT'])
      ask({ payload: 'other' })
      await until(() => statistics.length > 1, 'statistics')
      assert.equal(statistics[1].payload.evidence.written, payload.written)
      const { line } = sharedPool().lines()[0]
      line.report({ event: 'stationDemoted', station: 9, cause: 'c', remedy: 'r' })
      await helper.setFlows([], 'full')
      const lines = fs.readFileSync(payload.file, 'utf8').trim().split('\n')
      assert.equal(JSON.parse(lines.at(-1)).event, 'stationDemoted')
    })
  })

  it('a folder that cannot be made stops nothing: counted, the error stands in the statistics', async () => {
    const file = path.join(os.tmpdir(), `monitor-file-${process.pid}`)
    fs.writeFileSync(file, '')
    helper.settings({ userDir: file })
    try {
      const { out, statistics } = await loadWatched([...polling(), monitor()])
      await until(() => out.length > 0, 'a value')
      wire.drop()
      const before = out.length
      await until(() => out.length > before + 2, 'values after the fault')
      ask({ payload: 'evidence' })
      await until(() => statistics.length > 0, 'the answer')
      const { rows, lost, error } = statistics[0].payload
      assert.deepEqual([rows, lost > 0, error.code], [[], true, 'ENOTDIR'])
    } finally {
      helper.settings({ userDir: undefined })
      fs.rmSync(file)
    }
  })

  it('without a user directory no evidence is kept', async () => {
    const { statistics } = await loadWatched([lineNode(wire), monitor()])
    ask({ payload: 'evidence' })
    await until(() => statistics.length > 0, 'the answer')
    assert.deepEqual([statistics[0].payload.file, statistics[0].payload.rows], [null, []])
  })

  it('simulated lines and lines that are listened to', async () => {
    const line = { id: 'line', type: 'plc-line', name: 'S', transport: 'simulated', baudRate: '115200' }
    const link = { id: 'link', type: 'incon-link', ...ON_TAB, line: 'line', wires: [['out']] }
    const { out, frames, statistics } = await loadWatched([line, link, monitor({ trace: true })])
    await until(() => sharedPool().lines()[0]?.line.state === 'open', 'the line')
    helper.getNode('line').wire.peer().say('HELLO')
    await until(() => out.length > 0 && frames.length > 0, 'the line and its frame')
    assert.equal(Buffer.from(frames[0].payload.bytes, 'hex').toString(), 'HELLO')
    ask({})
    await until(() => statistics.length > 0, 'statistics')
    assert.deepEqual([statistics[0].simulated, statistics[0].payload.messagesIn], [true, 1])
  })

  for (const type of ['full', 'flows', 'nodes']) {
    it(`deploy "${type}": goes on with the line of then, hears it once, leaves nothing behind`, async () => {
      await loadWatched([...polling(), monitor()])
      await until(() => wire.connections() === 1, 'the connection')
      for (let round = 1; round <= 3; round++) {
        const flow = [
          TAB,
          lineNode(wire, { gap: String(round) }),
          ...polling().slice(1),
          monitor(),
          ...OUTPUTS.map(probe)
        ]
        await helper.setFlows(flow, type)
      }
      const events = collect('events')
      await until(() => sharedPool().lines()[0]?.line.state === 'open', 'the line')
      const { line } = sharedPool().lines()[0]
      await tick(20)
      line.report({ event: 'late', station: 2, cause: 'c', remedy: 'r' })
      await until(() => events.length > 0, 'the event')
      await tick(20)
      assert.deepEqual(topics(events), ['late'])
      const listeners = line.listenerCount('event')
      await helper.setFlows([TAB, lineNode(wire, { gap: '3' }), ...polling().slice(1)], type)
      await until(() => sharedPool().lines()[0]?.line.state === 'open', 'the line')
      assert.equal(sharedPool().lines()[0].line.listenerCount('event'), listeners - 1)
    })
  }

  it('a record of each write that goes over the line', async () => {
    const nodes = [lineNode(wire), plcNode({ access: 'write' }), writer({ target: 'K0' }), monitor({ events: 'audit' })]
    const { events, out } = await loadWatched(nodes)
    await until(() => sharedPool().lines()[0]?.line.state === 'open', 'the line')
    helper.getNode('write').receive({ payload: 5, _msgid: 'm1' })
    await until(() => out.length > 0 && events.length > 0, 'the write and its record')
    const { by, outcome, items } = events[0].payload
    assert.deepEqual(
      [by.node, by.message, outcome, items[0].item, items[0].value],
      ['write', 'm1', 'confirmed', 'K0', 5]
    )
  })

  it('a station that is demoted and comes back: events, statistics, status', async () => {
    wire.wire.setOff(1, true)
    const dead = plcNode({ timeout: '20', demoteAfter: '2', probeFirst: '100' })
    const { events, statistics } = await loadWatched([
      lineNode(wire),
      dead,
      reader({ items: ['M0'], interval: '20' }),
      monitor()
    ])
    await until(() => topics(events).includes('stationDemoted'), 'the end of asking')
    const { station, code, cause, remedy, nextProbe } = events[0].payload
    assert.deepEqual([station, code, typeof nextProbe], [1, 'TIMEOUT', 'number'])
    assert.ok(cause && remedy)
    ask({})
    await until(() => statistics.length > 0, 'statistics')
    assert.deepEqual([statistics[0].payload.demoted, statistics[0].payload.stations[1].health], [['1'], 'demoted'])
    wire.wire.setOff(1, false)
    await until(() => topics(events).includes('stationBack'), 'the station')
    assert.ok(events.find(({ topic }) => topic === 'stationBack').payload.downFor > 0)
  })
})
