'use strict'
const assert = require('node:assert/strict')
const { ON_TAB, endsOf, helper, load, until } = require('./bench')
const { sharedPool } = require('../../nodes/pool')

/** incon-link on a simulated line: the controller is lib/sim's. */

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
  name: 'machine',
  ...ON_TAB,
  line: 'line',
  scan: '0',
  quiet: '20',
  wires: [['out'], ['written'], ['failed']],
  ...more
})
const sender = more => link({ access: 'write', ...more })
const controller = () => helper.getNode('line').wire.peer()

describe('incon-link', () => {
  before(() => helper.startServer())
  after(() => helper.stopServer())
  afterEach(async () => {
    await helper.unload()
    assert.deepEqual(sharedPool().lines(), [], 'a line is left open')
  })
  const opened = () => until(() => sharedPool().lines()[0]?.line.state === 'open', 'the line')

  it('delivers what the controller sends: text, time, name, simulated', async () => {
    const { out } = await load([line(), link()])
    await opened()
    const start = Date.now()
    controller().say('TOOL 7')
    const got = await until(() => out.find(({ payload }) => payload === 'TOOL 7'), 'the line')
    const { timestamp, ...rest } = got
    delete rest._msgid
    assert.deepEqual(rest, {
      topic: 'machine',
      payload: 'TOOL 7',
      count: 6,
      bytes: 6,
      complete: true,
      quality: 'good',
      device: 'machine',
      simulated: true
    })
    assert.ok(timestamp >= start - 5 && timestamp <= Date.now() + 5)
  })

  it('a torn line is marked, and what comes after it is not glued to it', async () => {
    const { out } = await load([line(), link({ silence: '30' })])
    await opened()
    controller().say(Buffer.from('TOR'))
    const torn = await until(() => out.find(({ complete }) => complete === false), 'the torn line')
    assert.deepEqual([torn.payload, torn.reason, torn.quality], ['TOR', 'silence', 'bad'])
    controller().say('N')
    await until(() => out.find(({ payload }) => payload === 'N'), 'the next line')
  })

  it('sends a line: sent on the second output, the message is kept', async () => {
    const { written, caught } = await load([line(), sender()])
    await opened()
    helper.getNode('link').receive({ payload: 'O1234', topic: 'mine', other: 7 })
    const msg = await until(() => written[0] || caught[0], 'the outcome')
    const { ms, ...write } = msg.write
    assert.deepEqual(write, { outcome: 'sent', attempts: 1, bytes: 7 })
    assert.ok(Number.isInteger(ms))
    assert.deepEqual(
      [msg.payload, msg.topic, msg.other, msg.device, msg.simulated],
      ['O1234', 'mine', 7, 'machine', true]
    )
    await until(() => controller().messages.length === 1, 'the controller')
    assert.equal(controller().messages[0].text, 'O1234')
  })

  it('two lines at once are two messages for the controller', async () => {
    const { written } = await load([line(), sender()])
    await opened()
    helper.getNode('link').receive({ payload: 'ONE' })
    helper.getNode('link').receive({ payload: 'TWO' })
    await until(() => written.length === 2 && controller().messages.length === 2, 'both')
    assert.deepEqual(
      controller().messages.map(({ text }) => text),
      ['ONE', 'TWO']
    )
  })

  it('checked lines carry their number, and how many were lost', async () => {
    const { out } = await load([line(), link({ checked: true })])
    await opened()
    controller().say('A')
    const first = await until(() => out.find(({ payload }) => payload === 'A'), 'the line')
    assert.deepEqual([typeof first.number, first.lost], ['number', 0])
  })

  it('acknowledged lines: confirmed, and each line of the controller comes once', async () => {
    const { out, written } = await load([line(), sender({ checked: true, acknowledge: true })])
    await opened()
    helper.getNode('link').receive({ payload: 'O1234' })
    const { write } = await until(() => written[0], 'the outcome')
    assert.deepEqual({ ...write, ms: 0 }, { outcome: 'confirmed', attempts: 1, ms: 0, bytes: 14 })
    assert.deepEqual(
      controller().messages.map(({ text }) => text),
      ['O1234']
    )
    const answer = await until(() => out.find(({ payload }) => payload === 'PROGRAM O1234 SELECTED'), 'the answer')
    assert.deepEqual([answer.number, answer.lost, answer.complete], [1, 0, true])
  })

  it('acknowledged lines need checked ones: a fault of the configuration', async () => {
    const { caught } = await load([line(), sender({ acknowledge: true })])
    await until(() => caught.length > 0, 'the error')
    assert.equal(caught[0].error.code, 'BAD_SETTING')
  })

  for (const [what, config, msg, code] of [
    ['a node that only receives', {}, { payload: 'X' }, 'SENDING_OFF'],
    ['a retained message', { access: 'write' }, { payload: 'X', retain: true }, 'RETAINED_REFUSED'],
    ['a letter beyond ASCII', { access: 'write' }, { payload: '가' }, 'BAD_VALUE'],
    ['no payload', { access: 'write' }, {}, 'BAD_VALUE'],
    ['a payload of the prototype', { access: 'write' }, Object.create({ payload: 'X' }), 'BAD_VALUE'],
    ['a line that is too long', { access: 'write' }, { payload: 'x'.repeat(254) }, 'FRAME_TOO_LONG']
  ]) {
    it(`${what}: ${code}, an error or on the third output, never both, and nothing is sent`, async () => {
      const first = await load([line(), link(config)])
      await opened()
      helper.getNode('link').receive(msg)
      await until(() => first.caught.length === 1, 'the error')
      assert.equal(first.caught[0].error.code, code)
      assert.equal(first.failed.length + first.written.length, 0)
      assert.equal(controller().counts.bytesIn, 0)
      if (config.access !== 'write') return
      await helper.unload()
      const second = await load([line(), link({ ...config, onFailure: 'output' })])
      await opened()
      helper.getNode('link').receive(msg)
      await until(() => second.failed.length === 1, 'the output')
      assert.deepEqual([second.failed[0].write.outcome, second.failed[0].write.code], ['refused', code])
      assert.equal(second.caught.length, 0)
    })
  }

  it('a retained message is sent where the node accepts it', async () => {
    const { written } = await load([line(), sender({ acceptRetained: true })])
    await opened()
    helper.getNode('link').receive({ payload: 'O1', retain: true })
    await until(() => written.length === 1, 'the outcome')
  })

  it('an undeploy while lines wait ends each message once', async () => {
    await load([line({ baudRate: '9600' }), sender({ quiet: '200' })])
    await opened()
    const { ends, forget } = endsOf('link')
    try {
      for (let n = 0; n < 5; n++) helper.getNode('link').receive({ payload: `L${n}` })
      await helper.setFlows([], 'full')
      await until(() => ends.size === 5, 'the end of each message')
      assert.deepEqual([...ends.values()], [1, 1, 1, 1, 1])
    } finally {
      forget()
    }
  })
})
