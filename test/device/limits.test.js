'use strict'

const assert = require('node:assert/strict')
const { exchange } = require('../../lib/device/modbus-exchange')
const { createMasterWatch } = require('../../lib/device/master-watch')
const { bench } = require('./support')

describe('a device at its limits', () => {
  let b
  afterEach(() => b?.close())
  const codes = results => results.map(({ code = 'good' }) => code)
  const outcome = ({ outcome: word, code }) => [word, code]

  it('a value that is longer than a request is bad alone; all the others are read', async () => {
    b = bench({ plc: { limits: { readWords: 8, readMixed: 8 } } })
    const { device, run } = b
    const long = 'M0:string[40]'
    assert.deepEqual(codes(await run(device.read([long, 'M1', 'K0:float32', 'K10..K15']))), [
      'FRAME_TOO_LONG',
      'good',
      'good',
      'good'
    ])
    await assert.rejects(run(device.read([long, 'M100:string[40]'])), { code: 'FRAME_TOO_LONG' })
  })

  it('one limit of a tag binds other writes to its word; the text has only that one', async () => {
    const tags = [
      { name: 'low', address: 'K1', min: 5, writable: true },
      { name: 'high', address: 'K2', max: 90, writable: true }
    ]
    b = bench({ plc: { access: 'write', tags } })
    const refusal = async (item, value) => (await b.run(b.device.write([{ item, value }], { fixed: true }))).text
    assert.match(await refusal('K1', 4), /allowed is 5 to any/)
    assert.match(await refusal('K2', 91), /allowed is any to 90/)
    assert.equal(await refusal('K1', 5), undefined)
    assert.equal(await refusal('K2', 90), undefined)
  })

  it('more values than a write may have are refused before anything is sent', async () => {
    b = bench({ plc: { access: 'write' } })
    const entry = { item: 'K0..K127', value: new Array(128).fill(1) }
    const got = await b.run(b.device.write(new Array(157).fill(entry), { fixed: true }))
    assert.deepEqual([outcome(got), b.queries.length], [['refused', 'TOO_MANY'], 0])
  })

  it('what a node refuses is told with whatever it knows', () => {
    b = bench({ plc: { access: 'write' } })
    for (const why of [new Error('odd'), null, undefined]) {
      const got = b.device.refused([], why, {})
      assert.deepEqual([outcome(got), got.items], [['refused', 'BAD_VALUE'], []])
    }
    const symbol = b.device.refused([{ item: Symbol('x'), value: 1 }], new Error('odd'), {})
    assert.equal(symbol.items[0].item, '(symbol)')
  })
})

describe('what modbus-serial makes nothing of', () => {
  it('is no answer', () => {
    const { read } = exchange({ fn: 3, base: 107, count: 3 }, 17)
    for (const frame of [Buffer.alloc(0), Buffer.from([17]), Buffer.from([17, 3, 6])]) {
      assert.throws(() => read(frame), { code: 'BAD_ANSWER' })
    }
  })
})

describe('the watch for a fixed master ID', () => {
  it('a read without an ID tells nothing; a memory of another version is taken as it is', () => {
    const found = []
    const memory = { good: 5, missed: true }
    const watch = createMasterWatch({ memory, found: id => found.push(id) })
    watch.note({ trial: true, code: 'TIMEOUT' })
    assert.deepEqual(memory, { good: 5, missed: true })
    assert.equal(watch.trial(), 5)
    for (let n = 0; n < 4; n++) watch.note({ id: 5, trial: true })
    assert.deepEqual([found, memory.proofs], [[5], 4])
    watch.note({ id: 5, trial: true, code: 'PLC_OUT_OF_RANGE' })
    assert.deepEqual([memory.good, memory.proofs], [null, 0])
    watch.note({ id: 6, trial: false, code: 'PLC_OUT_OF_RANGE' })
    assert.equal(memory.good, null)
  })
})
