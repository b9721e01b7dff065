'use strict'

const assert = require('node:assert/strict')
const { PRIORITY } = require('../../lib')
const { bench } = require('./chino-bench')

const values = results => results.map(({ value }) => value)
const codes = results => results.map(({ code = 'good' }) => code)

describe('CHINO regulator: reading', () => {
  let b
  const start = options => (b = bench(options))
  afterEach(async () => {
    await b.close()
    assert.equal(b.clock.pending(), 0, 'a timer is left')
  })

  for (const protocol of ['rtu', 'ascii']) {
    it(`all four tables, in as few requests as there are tables (${protocol})`, async () => {
      start({ device: { protocol } })
      b.slave.set('co', 19, 1, 0, 1, 1)
      b.slave.set('di', 196, 0, 0, 1, 1)
      b.slave.set('ir', 8, 0x000a, 0xfff6)
      b.slave.set('hr', 107, 555, 0, 100)
      const items = [
        '000020..000023',
        '10197..10198',
        '30009',
        '300010:int16',
        '40108..40110',
        'hr107',
        'co19',
        'di198'
      ]
      const results = await b.read(items)
      assert.deepEqual(values(results), [
        [1, 0, 1, 1].map(Boolean),
        [false, false],
        10,
        -10,
        [555, 0, 100],
        555,
        true,
        true
      ])
      assert.deepEqual(b.slave.requests.sort(), ['0b0100130004', '0b0200c40003', '0b03006b0003', '0b0400080002'])
    })
  }

  it('0-base: the address is the number on the wire', async () => {
    start({ device: { addressMode: '0-base' } })
    b.slave.set('hr', 107, 1)
    assert.deepEqual(values(await b.read(['400107', 'hr107'])), [1, 1])
    assert.deepEqual(b.slave.requests, ['0b03006b0001'])
  })

  it('32-bit values, low and high word first', async () => {
    start({ device: { tags: [{ name: 'turned', address: '400001:uint32', wordOrder: 'high' }] } })
    b.slave.set('hr', 0, 0x5678, 0x1234)
    const results = await b.read(['400001:uint32', 'turned', '400001:int32'])
    assert.deepEqual(values(results), [0x12345678, 0x56781234, 0x12345678])
    b.slave.set('ir', 0, 0x0000, 0x4248)
    assert.deepEqual(values(await b.read(['300001:float32'])), [50])
    const high = b.make({ wordOrder: 'high' })
    assert.deepEqual(values(await b.run(high.read(['400001:uint32']))), [0x56781234])
    high.close()
  })

  it('words of coils: the lowest coil is bit 0 of the low word; no alignment', async () => {
    start({ device: { tags: [{ name: 'turned', address: '001001:uint32', wordOrder: 'high' }] } })
    b.slave.set('co', 1000, 1, 0, 1)
    b.slave.set('co', 1016, 0, 1)
    b.slave.set('co', 1031, 1)
    const items = ['001001:uint16', '001001:uint32', 'turned', '001003:uint16', '001001:int32', '001001..001032:uint16']
    assert.deepEqual(values(await b.read(items)), [5, 0x80020005, 0x00058002, 0x8001, 0x80020005 | 0, [5, 0x8002]])
    assert.deepEqual(b.slave.requests, ['0b0103e80020'])
    b.slave.set('di', 20, 1)
    assert.deepEqual(values(await b.read(['100006:uint16'])), [0x8000])
  })

  it('bits of registers come with their register', async () => {
    start()
    b.slave.set('hr', 0, 0x8005)
    b.slave.set('ir', 0, 2)
    const items = ['400001.00', '400001.01', '400001.15', '300001.01', '400001.00..400001.02']
    assert.deepEqual(values(await b.read(items)), [true, false, true, true, [true, false, true]])
    assert.deepEqual(b.slave.requests.sort(), ['0b0300000001', '0b0400000001'])
  })

  it('asks for no more at once than the settings allow', async () => {
    start({ device: { holdingRead: 10, inputRead: 4, coilRead: 20, discreteRead: 16 } })
    await b.read(['400001..400025', '300001..300006', '000001..000030', '100001..100017'])
    assert.deepEqual(
      b.slave.requests.map(hex => [hex.slice(2, 4), parseInt(hex.slice(8), 16)]),
      [
        // 2 and 2 bytes, where 20 and 10 would be 3 and 2
        ['01', 16],
        ['01', 14],
        ['02', 16],
        ['02', 1],
        ['04', 4],
        ['04', 2],
        ['03', 10],
        ['03', 10],
        ['03', 5]
      ]
    )
  })

  it('maximum sizes, in one request each', async () => {
    start()
    for (let at = 0; at < 2000; at++) b.slave.set('co', at, at % 3 === 0 ? 1 : 0)
    for (let at = 0; at < 125; at++) b.slave.set('ir', at, at * 500)
    const [coils, words] = values(await b.read(['000001..002000', '300001..300125']))
    assert.ok(coils.length === 2000 && coils.every((value, at) => value === (at % 3 === 0)))
    assert.deepEqual(
      words,
      Array.from({ length: 125 }, (_, at) => at * 500)
    )
    assert.equal(b.slave.requests.length, 2)
  })

  it('read bit unit: whole multiples, never beyond the max read count', async () => {
    start({ device: { coilUnit: 16, coilRead: 40, discreteUnit: 8 } })
    b.slave.set('co', 0, 1, 1)
    assert.deepEqual(values(await b.read(['000001..000002'])), [[true, true]])
    await b.read(['000001..000040'])
    await b.read(['100003'])
    assert.deepEqual(b.slave.requests, ['0b0100000010', '0b0100000020', '0b0100200010', '0b0200020008'])
  })

  it('after exception 02 on a range that was rounded up the exact one is asked, from then on first', async () => {
    start({ slaves: [{ has: (table, address) => address < 10 }], device: { coilUnit: 16 } })
    b.slave.set('co', 9, 1)
    assert.deepEqual(values(await b.read(['000009..000010'])), [[false, true]])
    assert.deepEqual(b.slave.requests, ['0b0100080010', '0b0100080002'])
    assert.deepEqual(values(await b.read(['000009..000010'])), [[false, true]])
    const again = b.make({})
    assert.deepEqual(values(await b.run(again.read(['000009..000010']))), [[false, true]])
    again.close()
    assert.deepEqual(b.slave.requests.slice(2), ['0b0100080002', '0b0100080002'])
  })

  it('one bad address names itself as it was written, spoils nothing, and rests for 30 s in polls', async () => {
    const tags = [{ name: 'gone', address: '400051' }]
    start({ slaves: [{ has: (table, address) => address !== 50 }], device: { tags } })
    b.slave.set('hr', 49, 7, 0, 8)
    const items = ['40050', 'gone', 'hr50', '400051.03', '400052']
    const results = await b.read(items)
    assert.deepEqual(values(results), [7, null, null, null, 8])
    assert.deepEqual(codes(results).slice(1, 4), new Array(3).fill('MODBUS_ILLEGAL_ADDRESS'))
    assert.match(results[1].text, /station 11 answers exception 02: it does not have gone\./)
    assert.match(results[2].text, /it does not have hr50\./)
    assert.match(results[3].text, /it does not have 400051\.03\./)
    b.slave.requests.length = 0
    const poll = await b.run(b.device.read(items, { priority: PRIORITY.POLL }))
    assert.deepEqual(values(poll), [7, null, null, null, 8])
    assert.match(poll[2].text, /it does not have hr50\./)
    assert.equal(b.slave.requests.length, 2)
    await b.clock.advance(30000)
    await b.run(b.device.read(items, { priority: PRIORITY.POLL }))
    assert.equal(b.slave.requests.length, 5)
  })

  it('reads over addresses that nobody asked for; one that the device lacks is found, remembered and left out', async () => {
    start({ slaves: [{ has: (table, address) => address !== 5 }] })
    for (const at of [0, 3, 8, 10, 12]) b.slave.set('hr', at, at + 1)
    const items = ['hr0', 'hr3', 'hr8', 'hr10', 'hr12']
    assert.deepEqual(values(await b.read(items)), [1, 4, 9, 11, 13])
    assert.equal(b.slave.requests[0], '0b030000000d', 'all at once')
    b.slave.requests.length = 0
    assert.deepEqual(values(await b.read(items)), [1, 4, 9, 11, 13])
    assert.deepEqual(b.slave.requests.sort(), ['0b0300000004', '0b0300080005'])
  })

  it('a range that is longer than the device allows is split', async () => {
    start()
    b.slave.before = body => {
      if (body[1] === 3 && body[5] > 32) b.slave.next.unshift({ exception: 3 })
    }
    for (let at = 0; at < 100; at++) b.slave.set('hr', at, at)
    const [result] = await b.read(['400001..400100'])
    assert.deepEqual(
      result.value,
      Array.from({ length: 100 }, (_, at) => at)
    )
  })

  it('each exception is the word of the request that it answers; busy is asked again', async () => {
    start()
    b.slave.set('hr', 0, 5)
    b.slave.next.push({ exception: 6 }, { exception: 5 }, {})
    assert.deepEqual(values(await b.read(['400001'])), [5])
    for (const [exception, code] of [
      [1, 'MODBUS_ILLEGAL_FUNCTION'],
      [4, 'MODBUS_DEVICE_FAILURE'],
      [7, 'MODBUS_NEGATIVE_ACKNOWLEDGE'],
      [8, 'MODBUS_MEMORY_PARITY'],
      [99, 'MODBUS_EXCEPTION']
    ]) {
      b.slave.requests.length = 0
      b.slave.next.push({ exception })
      const results = await b.read(['300001', '400001'])
      assert.deepEqual(codes(results), [code, 'good'])
      assert.equal(b.slave.requests.length, 2)
    }
    b.slave.next.push({ exception: 6 }, { exception: 6 }, { exception: 6 })
    assert.deepEqual(codes(await b.read(['400001'])), ['MODBUS_BUSY'])
    assert.equal(b.device.stats.exceptions, 6)
  })

  it('behind a gateway that finds nobody not each address is tried', async () => {
    start()
    b.slave.next.push(...new Array(5).fill({ exception: 11 }))
    const results = await b.read(['400001', '300001', '000001'])
    assert.deepEqual(codes(results), new Array(3).fill('MODBUS_GATEWAY_TARGET'))
    assert.equal(b.slave.requests.length, 1)
  })

  it('lost, damaged and foreign answers are asked again, and none becomes a value', async () => {
    for (const fault of [
      { lost: true },
      { raw: '0b0302000500ff' },
      { body: [12, 3, 2, 0, 9] },
      { body: [11, 4, 2, 0, 9] },
      { body: [11, 3, 4, 0, 9, 0, 9] },
      { body: [11, 3, 2, 0], last: true }
    ]) {
      start()
      b.slave.set('hr', 0, 5)
      b.slave.next.push(fault)
      assert.deepEqual(values(await b.read(['400001'])), [5], JSON.stringify(fault))
      assert.equal(b.slave.requests.length, 2)
      if (!fault.last) await b.close()
    }
  })

  it('a late answer is no answer to the next request, and is reported', async () => {
    start({ device: { attempts: 1 } })
    const events = []
    b.lease.on('event', event => events.push(event))
    b.slave.set('hr', 0, 111, 222)
    b.slave.next.push({ turnaround: 350 })
    assert.deepEqual(codes(await b.read(['400001'])), ['TIMEOUT'])
    for (let n = 0; n < 5; n++) assert.deepEqual(values(await b.read(['400002'])), [222])
    assert.deepEqual(
      events.map(({ event, station }) => [event, station]),
      [['late', 11]]
    )
  })

  it('two regulators: the silence of one holds up the other no longer than its timeout', async () => {
    start({ slaves: [{ station: 11 }, { station: 12 }], device: { attempts: 1 } })
    const other = b.make({ station: 12 })
    b.slaves[1].set('hr', 0, 12)
    b.wire.setOff(11, true)
    const began = b.clock.now()
    const [dead, alive] = await b.run(Promise.all([b.device.read(['400001']), other.read(['400001'])]))
    assert.deepEqual([codes(dead), values(alive)], [['TIMEOUT'], [12]])
    assert.ok(b.clock.now() - began < 300)
    other.close()
  })

  it('a gap of at least 3.5 characters, also where the line’s is shorter; sendWait makes it longer', async () => {
    const cases = [
      // baud rate, sendWait, least gap
      [9600, 0, 35 / 9.6],
      [19200, 0, 35 / 19.2],
      [38400, 0, 1.75],
      [115200, 0, 1.75],
      [38400, 20, 20]
    ]
    for (const [baudRate, sendWait, least] of cases) {
      start({ line: { baudRate, gap: 0.1 }, device: { sendWait } })
      const ends = []
      const begins = []
      const byte = 10000 / baudRate
      b.slave.before = () => begins.push(b.clock.now() - 8 * byte)
      await b.run(
        Promise.all(
          ['400001', '400003', '400005'].map(item => b.device.read([item]).then(() => ends.push(b.clock.now())))
        )
      )
      for (const [at, begin] of begins.slice(1).entries()) {
        assert.ok(begin - ends[at] >= least - 0.01, `${baudRate}: ${begin - ends[at]}`)
        assert.ok(begin - ends[at] <= least + 1, `${baudRate}: ${begin - ends[at]}`)
      }
      if (sendWait === 0) await b.close()
    }
  })

  it('the same read that still waits is not sent twice', async () => {
    start()
    b.slave.set('hr', 0, 5)
    const busy = b.device.read(['400100'])
    const twice = [b.device.read(['400001']), b.device.read(['400001'])]
    assert.deepEqual((await b.run(Promise.all(twice))).map(values), [[5], [5]])
    await b.run(busy)
    assert.equal(b.slave.requests.length, 2)
  })

  it('polls, and says what goes out', async () => {
    start({ device: { tags: [{ name: 'output', address: '400001', scale: 0.1, unit: '%' }] } })
    b.slave.set('hr', 0, 505)
    const seen = []
    const polling = b.device.subscribe({ items: ['output', '000001:uint16'], interval: 100 }, results =>
      seen.push(values(results))
    )
    await b.clock.advance(450)
    polling.stop()
    assert.equal(seen.length, 5)
    assert.deepEqual(seen[0], [50.5, 0])
    assert.deepEqual(b.device.stats, {
      requests: 10,
      answers: 10,
      exceptions: 0,
      broadcasts: 0,
      overruns: 0,
      subscriptions: 0
    })
    assert.equal(b.device.describe('output').goesOut, 'function 03, wire address 0 (0000h)')
    assert.equal(b.device.describe('001001:uint32').goesOut, 'function 01, wire addresses 1000–1031 (03E8h–0407h)')
    assert.match(b.device.describe('400001.05', { write: true }).goesOut, /^functions 03 and 10, read-modify-write/)
    const single = b.make({ holdingFunction: 'auto', coilFunction: '05' })
    assert.equal(single.describe('400001', { write: true }).goesOut, 'function 06, wire address 0 (0000h)')
    assert.equal(
      single.describe('400001:float32', { write: true }).goesOut,
      'function 10, wire addresses 0–1 (0000h–0001h)'
    )
    single.close()
    b.device.close()
  })

  it('what is wrong with the request itself is refused before anything is sent', async () => {
    start({ device: { holdingRead: 1 } })
    for (const [items, code] of [
      [['40'], 'BAD_ADDRESS'],
      [[400001], 'BAD_ITEMS'],
      [['400001.1'], 'BAD_ADDRESS'],
      [['400001.16'], 'BAD_BIT'],
      [['465536:uint32'], 'OUT_OF_AREA'],
      [['065522:uint16'], 'OUT_OF_AREA'],
      [['200001'], 'BAD_ADDRESS'],
      [['400001:bool'], 'BAD_TYPE'],
      [['400001:float32'], 'FRAME_TOO_LONG'],
      [[], 'BAD_ITEMS']
    ]) {
      await assert.rejects(b.run(b.device.read(items)), error => error.code === code, JSON.stringify(items))
    }
    assert.equal(b.slave.requests.length, 0)
  })
})
