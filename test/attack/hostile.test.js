'use strict'

const assert = require('node:assert')
const { bench } = require('../device/support')
const { entriesOf } = require('../../lib')

const MB = 1e6

/** Far more than any of these calls needs, and far less than the seconds that each of them once took. */
const MOST = 1000

/** ms of processor time that a call takes: a busy machine does not lengthen it. */
const blocked = call => {
  const start = process.cpuUsage()
  call()
  const { user, system } = process.cpuUsage(start)
  return (user + system) / 1000
}

/** Codes of what a call throws. */
const codeOf = call => {
  try {
    call()
    return ''
  } catch (error) {
    return error.code
  }
}

describe('attack: hostile messages', () => {
  let plc
  beforeEach(() => (plc = bench({ plc: { access: 'write' } })))
  afterEach(() => plc.close())

  // quadratic recognisers took 5 s for a tenth of it
  it('a payload of a megabyte of digits that is no number is refused at once', async () => {
    const [entry] = entriesOf({ topic: 'K0', payload: '1'.repeat(MB) + 'x' })
    let outcome
    assert.ok(blocked(() => (outcome = plc.device.write([entry], { fixed: true }))) < MOST)
    assert.equal((await outcome).code, 'BAD_VALUE')
  })

  for (const text of ['M' + ' '.repeat(MB) + 'x', 'M0:a' + '['.repeat(MB), ':'.repeat(MB), 'M0' + '..'.repeat(MB)]) {
    it(`an item of a megabyte is refused at once: ${text.slice(0, 6)}…`, () => {
      const ms = blocked(() =>
        assert.equal(
          codeOf(() => plc.device.item(text)),
          'BAD_ADDRESS'
        )
      )
      assert.ok(ms < MOST, `${ms} ms`)
    })
  }

  // 1000 ranges of 4096 addresses are four million elements: 3 s and 400 MB before they were counted
  it('a thousand of the longest ranges are counted before they are made', () => {
    const items = Array.from({ length: 1000 }, (_, n) => `@${n}..@${n + 4095}`)
    const ms = blocked(() => {
      for (const text of items) assert.equal(plc.device.item(text).count, 4096)
      assert.equal(
        codeOf(() => plc.device.items(items)),
        'TOO_MANY'
      )
    })
    assert.ok(ms < MOST, `${ms} ms`)
    assert.deepEqual(
      plc.device.item('M0..M1').elements.map(({ name }) => name),
      ['M0', 'M1']
    )
  })
})

describe('attack: a write that cannot be read back', () => {
  // five words fit into a write, but into no read that the CPU allows
  for (const coalesce of [false, true]) {
    it(`has an outcome, ${coalesce ? 'the latest only' : 'each'}`, async () => {
      const plc = bench({ plc: { access: 'write', limits: { readWords: 4, readMixed: 4 } } })
      const entries = [{ item: 'K0:string[10]', value: 'setpoint 7' }]
      const { outcome, items } = await plc.run(plc.device.write(entries, { fixed: true, verify: true, coalesce }))
      assert.deepEqual([outcome, items[0].code], ['unknown', 'WRITE_UNKNOWN'])
      assert.equal(plc.queries.filter(({ ask }) => ask === 'writeWords').length, 1)
      await plc.close()
    })
  }
})
