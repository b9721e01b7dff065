'use strict'

const assert = require('node:assert/strict')
const { bench } = require('./chino-bench')

const tags = [{ name: 'mode', address: '400031.05', writable: true }]
const entry = (item, value) => ({ item, value })

describe('CHINO regulator: writing', () => {
  let b
  const start = options => (b = bench(options))
  afterEach(async () => {
    await b.close()
    assert.equal(b.clock.pending(), 0, 'a timer is left')
  })
  const writes = () => b.slave.requests.filter(hex => parseInt(hex.slice(2, 4), 16) > 4)
  const short = ({ outcome, code, attempts }) => [outcome, code, attempts]

  for (const protocol of ['rtu', 'ascii']) {
    it(`functions 0F and 10, as set at first (${protocol})`, async () => {
      start({ device: { protocol } })
      const entries = [
        entry('400001', 10),
        entry('40002', 0x102),
        entry('000020..000029', [1, 0, 1, 1, 0, 0, 1, 1, 1, 0].map(Boolean))
      ]
      const outcome = await b.write(entries)
      assert.deepEqual(short(outcome), ['confirmed', undefined, 2])
      assert.deepEqual(b.slave.requests, ['0b0f0013000a02cd01', '0b100000000204000a0102'])
      assert.deepEqual(b.slave.values('hr', 0, 2), [10, 0x102])
      assert.deepEqual(b.slave.values('co', 19, 10), [1, 0, 1, 1, 0, 0, 1, 1, 1, 0])
    })
  }

  it('functions 05 and 06: several values in several frames, one after the other', async () => {
    start({
      slaves: [{ station: 11 }, { station: 12 }],
      device: { coilFunction: '05', holdingFunction: '06', holdingWrite: 1 }
    })
    const outcome = await b.write([entry('400001:uint32', 0x00010002), entry('000001..000002', [true, false])])
    assert.deepEqual(short(outcome), ['confirmed', undefined, 2])
    assert.deepEqual(b.slave.requests, ['0b050000ff00', '0b0500010000', '0b0600000002', '0b0600010001'])
  })

  it('automatic: 05 and 06 for one value, 0F and 10 for several', async () => {
    start({ device: { coilFunction: 'auto', holdingFunction: 'auto' } })
    for (const each of [
      entry('400001', 3),
      entry('400001..400002', [1, 2]),
      entry('000173', true),
      entry('000001..000002', [1, 0])
    ]) {
      assert.equal((await b.write([each])).outcome, 'confirmed')
    }
    assert.deepEqual(b.slave.requests, ['0b0600000003', '0b10000000020400010002', '0b0500acff00', '0b0f000000020101'])
  })

  it('32-bit values in both orders; words of coils', async () => {
    start({
      device: {
        tags: [
          { name: 'turned', address: '400003:uint32', wordOrder: 'high' },
          { name: 'coils', address: '000003:uint32', wordOrder: 'high' }
        ]
      }
    })
    const outcome = await b.write([
      entry('400001:uint32', 0x12345678),
      entry('turned', 0x12345678),
      entry('400005:float32', 50),
      entry('000100:uint16', 0x8001),
      entry('coils', 0x00018000)
    ])
    assert.equal(outcome.outcome, 'confirmed')
    assert.deepEqual(b.slave.values('hr', 0, 6), [0x5678, 0x1234, 0x1234, 0x5678, 0, 0x4248])
    assert.deepEqual(b.slave.values('co', 99, 16), [1, ...new Array(14).fill(0), 1])
    // high word first: the first sixteen coils are the high word
    assert.deepEqual(b.slave.values('co', 2, 32), [1, ...new Array(30).fill(0), 1])
  })

  it('writes no more at once than the settings allow', async () => {
    start({ device: { coilWrite: 8, holdingWrite: 2 } })
    await b.write([entry('000001..000010', new Array(10).fill(true)), entry('400001..400003', [1, 2, 3])])
    assert.deepEqual(
      writes().map(hex => hex.slice(2, 12)),
      ['0f00000008', '0f00080002', '1000000002', '1000020001']
    )
  })

  it('maximum sizes: 1968 coils and 123 registers in one frame, more in several', async () => {
    start()
    await b.write([
      entry('000001..001968', new Array(1968).fill(true)),
      entry('400001..400124', new Array(124).fill(9))
    ])
    assert.deepEqual(
      writes().map(hex => [hex.slice(2, 12)]),
      [['0f000007b0'], ['100000007b'], ['10007b0001']]
    )
    assert.ok(b.slave.values('co', 0, 1968).every(Boolean) && b.slave.values('hr', 0, 124).every(value => value === 9))
  })

  it('one bit of a register: read, change, write, the other bits stay', async () => {
    start({ device: { tags } })
    b.slave.set('hr', 30, 0xa50f, 0)
    const outcome = await b.write([entry('mode', true), entry('400031.00', false), entry('400032.15', 1)])
    assert.deepEqual(short(outcome), ['confirmed', undefined, 2])
    assert.deepEqual(b.slave.requests, ['0b03001e0001', '0b10001e000102a52e', '0b03001f0001', '0b10001f0001028000'])
    const single = b.make({ holdingFunction: 'auto' })
    assert.equal((await b.run(single.write([entry('400031.05', false)], { fixed: true }))).outcome, 'confirmed')
    assert.deepEqual(b.slave.requests.slice(4), ['0b03001e0001', '0b06001ea50e'])
    single.close()
  })

  it('two writes of bits of one register at once do not lose each other; nothing of the station comes between', async () => {
    start({ slaves: [{ station: 11 }, { station: 12 }] })
    const other = b.make({})
    const reads = [b.device.read(['400031']), b.device.read(['400100'])]
    const both = [
      b.device.write([entry('400031.01', true)], { fixed: true }),
      other.write([entry('400031.02', true)], { fixed: true }),
      b.device.write([entry('400031', 0x8000)], { fixed: true }),
      other.write([entry('400031.03', true)], { fixed: true })
    ]
    const outcomes = await b.run(Promise.all(both))
    await b.run(Promise.all(reads))
    assert.ok(outcomes.every(({ outcome }) => outcome === 'confirmed'))
    assert.deepEqual(b.slave.values('hr', 30, 1), [0x8008])
    const order = b.slave.requests.map(hex => hex.slice(2, 8))
    const pairs = order.flatMap((each, at) => (each === '10001e' ? [order[at - 1]] : []))
    assert.deepEqual(pairs, ['03001e', '03001e', '10001e', '03001e'])
    other.close()
  })

  it('a lost read of a register whose bit is written is asked again; nothing was written if it stays silent', async () => {
    start({ device: { attempts: 2 } })
    b.slave.next.push({ lost: true })
    assert.deepEqual(short(await b.write([entry('400001.00', true)])), ['confirmed', undefined, 1])
    b.slave.next.push({ lost: true }, { lost: true })
    const silent = await b.write([entry('400001.01', true)])
    assert.deepEqual(short(silent), ['failed', 'TIMEOUT', 1])
    b.slave.next.push({ exception: 2 })
    const refused = await b.write([entry('400001.01', true)])
    assert.deepEqual(short(refused), ['refused', 'MODBUS_ILLEGAL_ADDRESS', 1])
    assert.match(refused.text, /it does not have 400001\.01\./)
    assert.equal(writes().length, 1)
  })

  it('a line that closes while the register of a bit is read has written nothing; after the write it is unknown', async () => {
    start()
    b.slave.next.push({ lost: true })
    const first = b.device.write([entry('400001.00', true)], { fixed: true })
    await b.clock.advance(60)
    b.lease.release()
    assert.deepEqual(short(await b.run(first)), ['failed', 'LINE_CLOSED', 1])
    assert.equal(writes().length, 0)
    await b.close()
    start()
    b.slave.next.push({}, { lost: true })
    const second = b.device.write([entry('400001.00', true)], { fixed: true })
    await b.clock.advance(60)
    b.lease.release()
    assert.deepEqual(short(await b.run(second)), ['unknown', 'WRITE_UNKNOWN', 1])
    assert.equal(writes().length, 1)
  })

  const outcomes = [
    // what the slave does, outcome, code
    [{ none: true }, 'unknown', 'WRITE_UNKNOWN'],
    [{ lost: true }, 'unknown', 'WRITE_UNKNOWN'],
    [{ turnaround: 350 }, 'unknown', 'WRITE_UNKNOWN'],
    [{ exception: 1 }, 'refused', 'MODBUS_ILLEGAL_FUNCTION'],
    [{ exception: 2 }, 'refused', 'MODBUS_ILLEGAL_ADDRESS'],
    [{ exception: 3 }, 'refused', 'MODBUS_ILLEGAL_VALUE'],
    [{ exception: 4 }, 'unknown', 'WRITE_UNKNOWN'],
    [{ exception: 5 }, 'unknown', 'WRITE_UNKNOWN'],
    [{ exception: 6 }, 'refused', 'MODBUS_BUSY'],
    [{ exception: 7 }, 'refused', 'MODBUS_NEGATIVE_ACKNOWLEDGE'],
    [{ exception: 10 }, 'refused', 'MODBUS_GATEWAY_PATH'],
    [{ exception: 11 }, 'unknown', 'WRITE_UNKNOWN'],
    [{ body: [12, 16, 0, 0, 0, 1] }, 'unknown', 'WRITE_UNKNOWN'],
    [{ body: [11, 16, 0, 1, 0, 1] }, 'unknown', 'WRITE_UNKNOWN'],
    [{ body: [11, 16, 0, 0, 0, 2] }, 'unknown', 'WRITE_UNKNOWN'],
    [{ body: [11, 6, 0, 0, 0, 5] }, 'unknown', 'WRITE_UNKNOWN'],
    [{ raw: '0b10000000010000' }, 'unknown', 'WRITE_UNKNOWN']
  ]
  for (const [fault, outcome, code] of outcomes) {
    it(`${JSON.stringify(fault)}: ${outcome}, and sent once`, async () => {
      start()
      b.slave.next.push(fault)
      const seen = await b.write([entry('400001', 5)])
      assert.deepEqual(short(seen), [outcome, code, 1])
      assert.equal(writes().length, 1)
      if (code === 'MODBUS_ILLEGAL_ADDRESS') assert.match(seen.text, /it does not have 400001\./)
      if (outcome === 'unknown') assert.match(seen.text, /the write of 400001/)
    })
  }

  it('06 with a wrong echo of value or address is unknown', async () => {
    for (const body of [
      [11, 6, 0, 0, 0, 6],
      [11, 6, 0, 1, 0, 5]
    ]) {
      start({ device: { holdingFunction: '06' } })
      b.slave.next.push({ body })
      assert.deepEqual(short(await b.write([entry('400001', 5)])), ['unknown', 'WRITE_UNKNOWN', 1])
      if (body[3] === 0) await b.close()
    }
  })

  it('on a line that hears itself the echo of 05 and 06 confirms nothing, known or not', async () => {
    for (const echo of ['auto', 'on']) {
      start({
        line: { echo },
        wire: { echo: true },
        device: { holdingFunction: '06', coilFunction: '05', attempts: 1 }
      })
      b.wire.setOff(11, true)
      assert.notEqual((await b.write([entry('400001', 5)])).outcome, 'confirmed', echo)
      assert.notEqual((await b.write([entry('000001', true)])).outcome, 'confirmed', echo)
      b.wire.setOff(11, false)
      await b.clock.advance(5000)
      assert.equal((await b.write([entry('400001', 5)])).outcome, 'confirmed', echo)
      assert.equal((await b.write([entry('000001', true)])).outcome, 'confirmed', echo)
      assert.deepEqual(b.slave.values('hr', 0, 1), [5])
      if (echo === 'auto') {
        assert.equal(b.slave.requests.filter(hex => hex.startsWith('0b03')).length, 1, 'one read tells it')
        await b.close()
      }
    }
  })

  it('in several frames, one that fails after others makes the whole unknown, and no more are sent', async () => {
    start({ device: { holdingFunction: '06' } })
    b.slave.next.push({}, { exception: 3 })
    const outcome = await b.write([entry('400001..400003', [1, 2, 3])])
    assert.deepEqual(short(outcome), ['unknown', 'WRITE_UNKNOWN', 1])
    assert.match(outcome.text, /1 of 3 frames was carried out, then MODBUS_ILLEGAL_VALUE/)
    assert.deepEqual(b.slave.values('hr', 0, 3), [1, 0, 0])
  })

  it('reading back: registers, bits of registers and words of coils', async () => {
    start()
    const entries = [
      entry('400001', 5),
      entry('400002.03', true),
      entry('400002.04', true),
      entry('000003:uint16', 0x8001),
      entry('000001', true)
    ]
    const good = await b.write(entries, { verify: true })
    assert.equal(good.outcome, 'confirmed')
    assert.deepEqual(b.slave.values('hr', 1, 1), [0x18])
    b.slave.before = body => {
      if (body[1] === 3) b.slave.set('hr', 1, 0x10)
      if (body[1] === 1) b.slave.set('co', 17, 0)
    }
    const bad = await b.write(entries, { verify: true })
    assert.deepEqual(
      bad.items.map(({ outcome, code }) => [outcome, code]),
      [
        ['confirmed', undefined],
        ['failed', 'VERIFY_FAILED'],
        ['confirmed', undefined],
        ['failed', 'VERIFY_FAILED'],
        ['confirmed', undefined]
      ]
    )
    assert.match(bad.items[1].text, /400002\.03 reads false after true/)
    b.slave.before = () => {}
    b.slave.next.push({ none: true })
    assert.equal((await b.write([entry('400001', 6)], { verify: true })).outcome, 'confirmed')
    assert.equal(b.slave.requests.filter(hex => hex === '0b1000000001020006').length, 1)
  })

  it('of a coil that a later number overlaps only the later one is compared', async () => {
    start()
    const outcome = await b.write(
      [
        entry('000005', true),
        entry('000001:uint16', 0),
        entry('000002', true),
        entry('400001.00', true),
        entry('400001', 4)
      ],
      {
        verify: true
      }
    )
    assert.equal(outcome.outcome, 'confirmed')
    assert.deepEqual(b.slave.values('co', 0, 5), [0, 1, 0, 0, 0])
    assert.deepEqual(b.slave.values('hr', 0, 1), [4])
  })

  it('coalesce: only the latest bit goes out', async () => {
    start()
    const busy = b.device.read(['400100'])
    const promises = [true, false, true].map(value =>
      b.device.write([entry('400001.07', value)], { fixed: true, coalesce: true })
    )
    const [first, second, third] = await b.run(Promise.all(promises))
    await b.run(busy)
    assert.deepEqual([first.code, second.code, third.outcome], ['SUPERSEDED', 'SUPERSEDED', 'confirmed'])
    assert.deepEqual(writes(), ['0b1000000001020080'])
  })
})
