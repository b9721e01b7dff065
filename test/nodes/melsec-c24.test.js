'use strict'
const assert = require('node:assert/strict')
const { ON_TAB, helper, load, until } = require('./bench')
const { sharedPool } = require('../../nodes/pool')

/** melsec-c24 on a simulated line: the module is lib/sim's. */

const line = (more = {}) => ({
  id: 'line',
  type: 'plc-line',
  name: 'L',
  transport: 'simulated',
  baudRate: '115200',
  ...more
})
const port = (more = {}) => ({
  id: 'c24',
  type: 'melsec-c24',
  name: 'press',
  ...ON_TAB,
  line: 'line',
  access: 'write',
  wires: [['out'], ['written'], ['failed']],
  ...more
})
const c24 = () => helper.getNode('line').wire.peer()
const send = msg => helper.getNode('c24').receive(msg)
const start = async (config, more) => {
  const probes = await load([line(more), port(config)])
  await until(() => sharedPool().lines()[0]?.line.state === 'open', 'the line')
  return probes
}
// the first message after the port was opened may lack its beginning: it says so
const OTHERS = ['_msgid', 'timestamp', 'afterOpen']
const without = msg => Object.fromEntries(Object.entries(msg).filter(([name]) => !OTHERS.includes(name)))

describe('melsec-c24', () => {
  before(() => helper.startServer())
  after(() => helper.stopServer())
  afterEach(async () => {
    await helper.unload()
    assert.deepEqual(sharedPool().lines(), [], 'a line is left open')
  })

  const common = { topic: 'press', complete: true, quality: 'good', device: 'press', simulated: true }
  // manual: "ABCDEFG123" is 4241H 4443H 4645H 3147H 3332H, count 5 or 10
  for (const [what, config, payload, count] of [
    ['text', {}, 'ABCDEFG123', 5],
    ['text, counted in bytes', { unit: 'byte' }, 'ABCDEFG123', 10],
    ['words', { format: 'words' }, [0x4241, 0x4443, 0x4645, 0x3147, 0x3332], 5],
    ['bytes', { format: 'bytes' }, Buffer.from('ABCDEFG123'), 5],
    ['a fixed number of bytes', { framing: 'count', count: '10' }, 'ABCDEFG123', 5],
    ['user frames', { first: '02', last: '03' }, 'ABCDEFG123', 5],
    ['ASCII-binary conversion', { asciiBinary: true }, 'ABCDEFG123', 5],
    ['the bidirectional protocol', { bidirectional: true }, 'ABCDEFG123', 5]
  ]) {
    it(`receives ${what}, and sends the same back`, async () => {
      const { out, written } = await start(config)
      c24().send('ABCDEFG123')
      const msg = await until(() => out.find(it => it.bytes === 10), 'the message')
      assert.deepEqual(without(msg), { ...common, payload, count, bytes: 10 })
      send({ payload, topic: 'mine' })
      const back = await until(() => written[0], 'the outcome')
      await until(() => c24().messages.length === 1, 'the module')
      assert.equal(c24().messages[0].bytes.toString(), 'ABCDEFG123')
      assert.deepEqual([back.payload, back.topic, back.device], [payload, 'mine', 'press'])
      assert.equal(back.write.outcome, config.bidirectional ? 'confirmed' : 'sent')
      assert.equal(back.write.attempts, 1)
    })
  }

  it('is called by its line where it has no name', async () => {
    const { out } = await start({ name: '' })
    c24().send('X')
    const { topic } = await until(() => out.find(({ payload }) => payload === 'X'), 'the message')
    assert.equal(topic, 'MELSEC C24 (L)')
  })

  it('a message that stops is marked, not glued to the next one', async () => {
    const { out } = await start({ gap: '25' })
    c24().send('SET 12', { end: false })
    const torn = await until(() => out.find(({ complete }) => !complete), 'the torn message')
    assert.deepEqual([torn.payload, torn.reason, torn.quality], ['SET 12', 'silence', 'bad'])
    c24().send('SET 125')
    await until(() => out.find(({ payload }) => payload === 'SET 125'), 'the next message')
  })

  for (const [what, config, msg, code] of [
    ['the end code inside', {}, { payload: 'A\r\nB' }, 'END_CODE_INSIDE'],
    ['a DC code with DC control', { flow: 'dc' }, { payload: 'A\x13B' }, 'FLOW_CODE_INSIDE'],
    ['an odd count with user frames', { first: '02', last: '03' }, { payload: 'ABC' }, 'ODD_COUNT'],
    ['text where words are meant', { format: 'words' }, { payload: 'ABC' }, 'BAD_VALUE'],
    ['no payload', {}, {}, 'BAD_VALUE'],
    ['a retained message', {}, { payload: 'A', retain: true }, 'RETAINED_REFUSED']
  ]) {
    it(`${what}: ${code} on the third output, and nothing is sent`, async () => {
      // slow enough for pieces that fit into what the module still takes
      const { failed, caught } = await start({ ...config, onFailure: 'output' }, { baudRate: '19200' })
      send(msg)
      const { write } = await until(() => failed[0], 'the output')
      assert.deepEqual([write.outcome, write.code, write.attempts, write.bytes], ['refused', code, 0, 0])
      assert.equal(c24().counts.bytesIn + caught.length, 0)
    })
  }

  it('a node that only receives sends nothing, not even to the third output', async () => {
    const { caught, failed } = await start({ access: 'read', onFailure: 'output' })
    send({ payload: 'A' })
    await until(() => caught.length === 1, 'the error')
    assert.deepEqual([caught[0].error.code, failed.length, c24().counts.bytesIn], ['SENDING_OFF', 0, 0])
  })

  it('bidirectional: what is not acknowledged is unknown, and not sent again', async () => {
    const { failed } = await start({ bidirectional: true, ackTimeout: '40', onFailure: 'output', padEven: true })
    c24().setRate({ rate: 0 })
    send({ payload: 'A' })
    const { write } = await until(() => failed[0], 'the output')
    assert.deepEqual([write.outcome, write.code, write.attempts], ['unknown', 'TIMEOUT', 1])
  })

  it('DTR on CTS stops what is sent, and lets it go on', async () => {
    const { written } = await start({ flow: 'driver' }, { flowControl: 'rtscts' })
    assert.equal(c24().settings.flow, 'dtr')
    send({ payload: 'A' })
    await until(() => written.length === 1, 'the outcome')
  })

  for (const [what, config, more] of [
    ['flow control of a line that has none', { flow: 'driver' }],
    ['DC control of the bidirectional protocol', { flow: 'dc', bidirectional: true }],
    ['no end code', { end: '' }],
    ['an end code that is no hex', { end: 'CR' }],
    ['an end code of three bytes', { end: '0D 0A 0A' }],
    ['a fixed number of 0', { framing: 'count' }],
    ['a pause of 0', { framing: 'gap' }],
    ['DC control too fast for what the module still takes', { flow: 'dc' }, { baudRate: '115200' }]
  ]) {
    it(`${what}: BAD_SETTING at deploy`, async () => {
      const { caught } = await load([line(more), port(config)])
      await until(() => caught.length === 1, 'the error')
      assert.equal(caught[0].error.code, 'BAD_SETTING')
    })
  }
})
