'use strict'
const assert = require('node:assert/strict')
const {
  TAB,
  catcher,
  helper,
  load,
  openMixedWire,
  lineNode,
  ON_TAB,
  probe,
  until,
  zoneNode,
  regulator
} = require('./bench')
const { createLine, serveOnTcp } = require('../../lib/sim')
const { sharedPool } = require('../../nodes/pool')
const { statusOf } = require('../../nodes/status')

/** Who may listen on a line, and what a deploy does to those who do. */

const line = (more = {}) => ({
  id: 'line',
  type: 'plc-line',
  name: 'L',
  transport: 'simulated',
  baudRate: '115200',
  ...more
})
const link = (more = {}) => ({
  id: 'link',
  type: 'incon-link',
  name: 'one',
  ...ON_TAB,
  line: 'line',
  wires: [['out']],
  ...more
})
const controller = () => helper.getNode('line').wire.peer()
const isOpen = () => until(() => sharedPool().lines()[0]?.line.state === 'open', 'the line')
const heard = () => {
  const seen = []
  helper.getNode('out').on('input', msg => seen.push(msg.payload))
  return seen
}

describe('listening nodes and their line', () => {
  before(() => helper.startServer())
  after(() => helper.stopServer())
  afterEach(async () => {
    await helper.unload()
    assert.deepEqual(sharedPool().lines(), [], 'a line is left open')
    delete process.env.TEST_LINE
  })

  for (const [what, nodes, names] of [
    ['a regulator and a listener', [zoneNode(), link()], /one.*Zone/],
    [
      'a C24 and a controller',
      [link(), { ...link({ id: 'c24', name: 'two' }), type: 'melsec-c24' }],
      /one.*two|two.*one/
    ],
    [
      'two listeners that cut in different ways',
      [link(), link({ id: 'link2', name: 'two', most: '100' })],
      /two.*one.*most/
    ],
    [
      'two listeners, of which one reads checked lines',
      [link(), link({ id: 'link2', name: 'two', checked: true })],
      /checked/
    ]
  ]) {
    it(`${what} cannot share a line: LINE_USE at deploy, both are named, the first one goes on`, async () => {
      const { caught, out } = await load([line(), ...nodes])
      await until(() => caught.length === 1, 'the error')
      assert.equal(caught[0].error.code, 'LINE_USE')
      assert.match(caught[0].error.message, names)
      if (nodes[0].type !== 'incon-link') return
      await isOpen()
      controller().say('ON')
      await until(() => out.some(({ payload }) => payload === 'ON'), 'the line')
    })
  }

  it('two listeners with the same settings, as number and as text, both get every line', async () => {
    const { out, written } = await load([
      line(),
      link({ most: 200 }),
      link({ id: 'link2', name: 'two', most: '200', wires: [['written']] })
    ])
    await isOpen()
    controller().say('ALL')
    await until(() => [out, written].every(seen => seen.some(({ payload }) => payload === 'ALL')), 'both')
    assert.equal(sharedPool().lines()[0].leases, 2)
  })

  for (const type of ['full', 'flows', 'nodes']) {
    it(`deploy "${type}": a changed node goes on; one port, no message twice`, async () => {
      await load([line(), link()])
      await isOpen()
      for (let round = 0; round < 3; round++) {
        await helper.setFlows([TAB, line(), link({ acceptRetained: round % 2 === 0 }), probe('out')], type)
        const seen = heard()
        await isOpen()
        controller().say(`R${round}`)
        await until(() => seen.includes(`R${round}`), 'a line after the deploy')
        assert.equal(seen.filter(payload => payload === `R${round}`).length, 1)
        assert.equal(sharedPool().lines()[0].leases, 1)
      }
    })
  }

  it('what comes while a deploy makes the node anew is neither lost nor torn', async () => {
    const slow = line({ baudRate: '9600' })
    const { out } = await load([slow, link()])
    await isOpen()
    const module = controller()
    const text = n => `LINE ${n} ${'x'.repeat(20)}`
    for (let n = 0; n < 4; n++) module.say(text(n))
    await until(() => module.counts.lines === 2, 'the second line on its way')
    const before = helper.getNode('link')
    await helper.setFlows([TAB, slow, link({ access: 'write' }), probe('out')], 'nodes')
    assert.notEqual(helper.getNode('link'), before, 'it was made anew')
    assert.equal(controller(), module)
    const lines = () => out.map(({ payload }) => payload).filter(payload => /x/.test(payload))
    await until(() => lines().includes(text(3)), 'the last line')
    assert.deepEqual(lines(), [0, 1, 2, 3].map(text))
  })

  it('two listeners that get other settings in one deploy do not stand in each other’s way', async () => {
    const both = more => [link(more), link({ id: 'link2', name: 'two', ...more })]
    const { caught } = await load([line(), ...both({})])
    await isOpen()
    await helper.setFlows([TAB, line(), ...both({ most: '100' }), probe('out'), probe('caught'), catcher], 'nodes')
    const seen = heard()
    await isOpen()
    controller().say('BOTH')
    await until(() => seen.filter(payload => payload === 'BOTH').length === 2, 'it of both')
    assert.equal(caught.length, 0)
  })

  it('other settings: the port is opened anew with them', async () => {
    await load([line(), link()])
    await isOpen()
    const before = controller()
    await helper.setFlows([TAB, line(), link({ checked: true }), probe('out')], 'nodes')
    const seen = heard()
    await isOpen()
    assert.notEqual(controller(), before)
    controller().say('CHECKED')
    await until(() => seen.includes('CHECKED'), 'the line')
  })

  it('a deploy may turn a polled line into one that is listened to, and back', async () => {
    const polled = [zoneNode({ line: 'line' }), regulator({ items: ['400001'], interval: '20' })]
    const quick = line({ latenessBound: '1' })
    await load([quick, ...polled])
    await isOpen()
    for (const round of [1, 2]) {
      await helper.setFlows([TAB, quick, link(), probe('out')], 'nodes')
      const seen = heard()
      await until(() => controller() && sharedPool().lines()[0]?.line.state === 'open', 'the controller')
      controller().say(`T${round}`)
      await until(() => seen.includes(`T${round}`), 'a line')
      await helper.setFlows([TAB, quick, ...polled, probe('out')], 'nodes')
      const values = heard()
      await until(() => values.length > 1, 'values')
      assert.equal(controller(), null, 'no simulated controller without a listener')
    }
  })

  it('removing the last listener frees the port', async () => {
    await load([line(), link()])
    await isOpen()
    await helper.setFlows([TAB, line(), probe('out')], 'nodes')
    await until(() => sharedPool().lines().length === 0, 'the line to be closed')
  })

  it('variables of numbers, and one that is not set', async () => {
    process.env.TEST_LINE = '100'
    const { caught } = await load([
      line(),
      link({ silence: '${TEST_LINE}' }),
      link({ id: 'link2', most: '${NOWHERE_SET}' })
    ])
    await until(() => caught.length === 1, 'the error')
    assert.equal(caught[0].error.code, 'ENV_MISSING')
    assert.equal(helper.getNode('line').listeners.names().length, 1)
  })

  it('no line, a foreign node as line', async () => {
    for (const config of [{ line: '' }, { line: 'gone' }, { line: 'out' }]) {
      const { caught } = await load([link(config)])
      await until(() => caught.length === 1, 'the error')
      assert.equal(caught[0].error.code, 'NO_CONFIGURATION')
      await helper.unload()
    }
  })

  it('over TCP: the connection is lost and comes back, the line goes on', async () => {
    let wire = await openMixedWire({ stations: [] })
    const { port } = wire
    const { caught } = await load([lineNode({ port }), link()])
    await until(() => wire.connections() === 1, 'the connection')
    await wire.close()
    await until(() => sharedPool().lines()[0].line.state === 'waiting', 'the loss')
    wire = await serveOnTcp({ wire: createLine({ stations: [] }).wire, port })
    await until(() => wire.connections() === 1, 'the connection again')
    await helper.unload()
    await wire.close()
    assert.equal(caught.length, 0)
  })

  it('what stands under the node', () => {
    const open = { line: { state: 'open' } }
    const shown = state => {
      const { fill, shape, key, values } = statusOf({ ...open, ...state })
      return [fill, shape, key, ...Object.values(values)]
    }
    assert.deepEqual(shown({ phase: 'listening' }), ['grey', 'dot', 'listening'])
    assert.deepEqual(shown({ phase: 'received', received: 12, complete: true }), ['green', 'dot', 'received', 12])
    assert.deepEqual(shown({ phase: 'received', received: 12, complete: false }), ['yellow', 'ring', 'incomplete'])
    assert.deepEqual(shown({ phase: 'sending' }), ['blue', 'ring', 'sending'])
    for (const [outcome, code, ...expected] of [
      ['sent', undefined, 'green', 'dot', 'sent'],
      ['confirmed', undefined, 'green', 'dot', 'acknowledged'],
      ['unknown', 'TIMEOUT', 'red', 'ring', 'unknown'],
      ['refused', 'SENDING_OFF', 'yellow', 'ring', 'sendingOff'],
      ['refused', 'C24_NAK', 'yellow', 'ring', 'rejected'],
      ['refused', 'END_CODE_INSIDE', 'yellow', 'ring', 'notWritten'],
      ['failed', 'WRITE_STALLED', 'red', 'ring', 'held']
    ])
      assert.deepEqual(shown({ phase: 'sent', outcome, code }), expected)
    const waiting = { state: 'waiting', reason: { code: 'PORT_BUSY' } }
    assert.deepEqual(shown({ phase: 'received', line: waiting }), ['red', 'ring', 'busy'])
  })
})
