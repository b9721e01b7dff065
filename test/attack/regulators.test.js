'use strict'

const assert = require('node:assert/strict')
const { entriesOf } = require('../../lib')
const { bench } = require('../device/chino-bench')

describe('attack: an adapter that begins to hear itself when the regulator is unplugged', () => {
  // TX couples into an open RX: 05 and 06 then "succeed" with nobody on the line. 0B 06 00 00 00 01 came back as it went out
  for (const [own, item] of [
    [{ holdingFunction: '06' }, '400001'],
    [{ coilFunction: '05' }, '000001']
  ]) {
    it(`its echo does not confirm a write: ${Object.values(own)}`, async () => {
      const b = bench({ line: { echo: 'auto' }, device: { ...own, attempts: 1 } })
      await b.read(['400001'])
      assert.equal(b.lease.line.echo, 'absent')
      await b.clock.advance(600)
      b.wire.setEcho(true)
      b.wire.setOff(11, true)
      const { outcome, code } = await b.write([{ item, value: 1 }])
      assert.deepEqual([outcome, code], ['failed', 'TIMEOUT'])
      await b.close()
    })
  }

  it('what was proven by a poll a moment ago costs no further read; its own answers prove nothing', async () => {
    const b = bench({ line: { echo: 'auto' }, device: { holdingFunction: '06' } })
    await b.read(['400001'])
    const asked = () => b.slave.requests.splice(0).map(request => request.slice(2, 4))
    asked()
    for (let n = 0; n < 3; n++) {
      await b.clock.advance(200)
      assert.equal((await b.write([{ item: '400001', value: n }])).outcome, 'confirmed')
    }
    assert.deepEqual(asked(), ['06', '06', '03', '06'])
    await b.close()
  })
})

describe('attack: a range that is written in several frames, of which the second is refused', () => {
  it('is unknown, not refused: a part of it stands in the regulator', async () => {
    const b = bench({})
    b.slave.next.push({}, { exception: 2 })
    const value = new Array(200).fill(7)
    const { outcome, code, text, items } = await b.write([
      { item: '400001..400200', value },
      { item: '400301', value: 1 }
    ])
    assert.deepEqual(b.slave.values('hr', 122, 2), [7, 0])
    assert.deepEqual([outcome, code], ['unknown', 'WRITE_UNKNOWN'])
    assert.match(text, /123 of 200 values were written, then MODBUS_ILLEGAL_ADDRESS/)
    assert.deepEqual(
      items.map(item => item.outcome),
      ['unknown', 'notSent']
    )
    await b.close()
  })

  it('is refused where the first frame is', async () => {
    const b = bench({})
    b.slave.next.push({ exception: 2 })
    const { outcome, code } = await b.write([{ item: '400001..400200', value: new Array(200).fill(7) }])
    assert.deepEqual([outcome, code], ['refused', 'MODBUS_ILLEGAL_ADDRESS'])
    await b.close()
  })
})

describe('attack: an item that is longer than a frame of the regulator', () => {
  it('is bad alone, and does not stop the others', async () => {
    const b = bench({ device: { holdingRead: 1 } })
    b.slave.set('hr', 0, 5)
    for (let n = 0; n < 2; n++) {
      const results = await b.read(['400001', '400010:uint32', 'ir3:string[256]'])
      assert.deepEqual(
        results.map(({ value, code }) => [value, code]),
        [
          [5, undefined],
          [null, 'FRAME_TOO_LONG'],
          [null, 'FRAME_TOO_LONG']
        ]
      )
    }
    assert.equal(b.slave.requests.length, 2)
    await b.close()
  })
})

describe('attack: hostile values', () => {
  it('an array that is only long on paper is refused before it is copied', () => {
    const payload = []
    payload.length = 4e9
    for (const options of [{ target: '400001..400002' }, {}]) {
      assert.throws(() => entriesOf({ payload, topic: '400001' }, options), { code: 'TOO_MANY' })
    }
  })
})
