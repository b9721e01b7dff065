'use strict'

const assert = require('node:assert/strict')
const { PRIORITY, PlcError } = require('../../lib')
const { bench } = require('./support')

const code = expected => error => error.code === expected
const values = results => Object.fromEntries(results.map(({ name, value, code: why }) => [name, why ?? value]))

describe('NX PLC: reading', () => {
  let b
  const start = options => (b = bench(options))
  afterEach(async () => {
    await b.close()
    assert.equal(b.clock.pending(), 0, 'a timer is left')
  })
  const read = (items, options) => b.run(b.device.read(items, options))

  for (const steps of [2, 4]) {
    it(`any mix of items, in one request (${steps}-step)`, async () => {
      start({
        plc: { steps, tags: [{ name: 'temp', address: 'W12', type: 'int16', scale: 0.1, unit: '°C', label: '온도' }] }
      })
      b.station.set('M1', 7)
      b.station.set('K127.12', true)
      b.station.set('W10', -1.5, 'float32')
      b.station.set('W12', 0xffff - 9)
      b.station.set('W20', 0x4142)
      const results = await read(['M0..M2', 'K127.12', 'K127', 'W10:float32', 'temp', 'W20:string[2]', 'W12.0', 'M1'])
      assert.deepEqual(values(results), {
        ...{ M0_M2: [0, 7, 0], K127_12: true, K127: 0x1000, W10: -1.5, temp: -1, W20: 'BA', W12_0: false, M1: 7 }
      })
      assert.deepEqual(
        results.map(({ quality }) => quality),
        new Array(8).fill('good')
      )
      const temp = results[4]
      assert.deepEqual([temp.unit, temp.label, temp.item], ['°C', '온도', 'temp'])
      assert.ok(temp.timestamp > Date.UTC(2024, 0, 1) && temp.timestamp < Date.UTC(2024, 0, 2))
      assert.deepEqual(
        b.queries.map(({ ask }) => ask),
        ['readMixed']
      )
    })
  }

  it('a bit of an area that has only words is that bit of its word, in ranges too', async () => {
    start()
    b.station.set('W3', 0x8020)
    b.station.set('W4', 0x0001)
    const results = await read(['W3.5', 'W3.6', 'W3.4..W3.6', 'W3.14..W4.1'])
    assert.deepEqual(
      results.map(({ value }) => value),
      [true, false, [false, true, false], [false, true, true, false]]
    )
  })

  it('the manual’s program: M0..M127 is one request', async () => {
    start()
    for (let at = 0; at < 128; at++) b.station.set(`M${at}`, at * 3)
    const [result] = await read(['M0..M127'])
    assert.deepEqual(
      result.value,
      Array.from({ length: 128 }, (_, at) => at * 3)
    )
    assert.deepEqual(b.queries, [{ ask: 'readWords', base: 0xc0, count: 128 }])
  })

  it('the gap before a query is 10 ms, or what is set', async () => {
    for (const [gap, silence] of [
      [undefined, 10],
      [0, 10],
      [3, 3],
      [25, 25]
    ]) {
      start({ plc: { gap } })
      await read(['M0'])
      const from = b.clock.now()
      await read(['M0'])
      const wire = ((9 + 8) * 10) / 38.4 // query and answer of one word
      const took = b.clock.now() - from - wire - 2 // the stations' turnaround
      assert.ok(Math.abs(took - silence) < 0.1, `${gap}: ${took}`)
      if (gap !== 25) await b.close()
    }
  })

  it('a float on the border of two frames is not torn', async () => {
    start()
    b.station.set('W127', 1.25, 'float32')
    const results = await read(['W0..W126', 'W127:float32', 'W129..W300'])
    assert.equal(results[1].value, 1.25)
    for (const { ask, base, count } of b.queries) {
      assert.equal(ask, 'readWords')
      const first = 0x200 + 127
      assert.ok(base > first || base + count <= first || base + count >= first + 2, `torn by ${base} ${count}`)
    }
  })

  it('one bad address names itself and spoils nothing', async () => {
    // this CPU has only 1000 words of W; the configuration believes in 2048
    start({ sim: { stations: [{ station: 1, areas: [{ area: 'W', words: 1000 }] }] } })
    b.station.set('W999', 5)
    const results = await read(['M0', 'W990..W1003', 'K1.2', 'W999', 'W2000:float32'])
    assert.equal(results[0].quality, 'good')
    assert.equal(results[2].quality, 'good')
    assert.equal(results[3].value, 5)
    assert.deepEqual(results[1].value, [...new Array(9).fill(0), 5, null, null, null, null])
    assert.equal(results[1].code, 'PLC_OUT_OF_RANGE')
    assert.match(results[1].text, /W1000 is out of range/)
    assert.deepEqual(
      results[1].elements.map(({ code: why }) => why),
      [...new Array(10).fill(undefined), ...new Array(4).fill('PLC_OUT_OF_RANGE')]
    )
    assert.match(results[4].text, /W2000 is out of range/)
  })

  it('a poll leaves a bad address alone for a while, an ask does not', async () => {
    start({ sim: { stations: [{ station: 1, areas: [{ area: 'SR', remove: true }] }] } })
    const poll = async () => {
      const before = b.station.counts.queries
      const results = await read(['M0', 'SR1', 'K5'], { priority: PRIORITY.POLL })
      assert.deepEqual(values(results), { M0: 0, SR1: 'PLC_OUT_OF_RANGE', K5: 0 })
      return b.station.counts.queries - before
    }
    assert.ok((await poll()) > 1)
    assert.equal(await poll(), 1)
    const before = b.station.counts.queries
    await read(['M0', 'SR1', 'K5'])
    assert.equal(b.station.counts.queries - before, 2)
    await b.clock.advance(31000)
    assert.equal(await poll(), 2)
    assert.equal(await poll(), 1)
  })

  it('a CPU without mixed reads is read in blocks from then on', async () => {
    start()
    const { run } = b.lease
    let mixed = 0
    b.lease.run = (make, options) => {
      if (!options.label.startsWith('readMixed')) return run.call(b.lease, make, options)
      mixed++
      return Promise.reject(new PlcError('PLC_WRONG_FUNCTION', { station: 1 }))
    }
    assert.deepEqual(values(await read(['M0', 'K5', 'K9.1'])), { M0: 0, K5: 0, K9_1: false })
    assert.deepEqual(values(await read(['M0', 'K5', 'K9.1'])), { M0: 0, K5: 0, K9_1: false })
    assert.equal(mixed, 1)
    delete b.lease.run
  })

  it('a stricter CPU (error 5) is asked for less', async () => {
    start({ sim: { stations: [{ station: 1, limits: { readWords: 32 } }] } })
    b.station.set('M100', 9)
    const [result] = await read(['M0..M127'])
    assert.equal(result.quality, 'good')
    assert.equal(result.value[100], 9)
  })

  it('a silent station costs one request, not one for each part of the read', async () => {
    start()
    b.wire.setOff(1, true)
    const results = await read(['M0..M127', 'K0..K127', 'W0..W500'])
    assert.deepEqual(
      results.map(({ code: why }) => why),
      ['TIMEOUT', 'TIMEOUT', 'TIMEOUT']
    )
    assert.equal(b.lease.line.stats().timeouts, 3)
    assert.match(results[0].text, /station 1 did not answer within 200 ms/)
  })

  it('a damaged answer spoils only its own request, if asking again does not help', async () => {
    start({ plc: { attempts: 1 } })
    b.faults.once('crc')
    const results = await read(['M0..M127', 'K0..K127'])
    assert.deepEqual(
      results.map(({ code: why }) => why),
      ['CRC_ERROR', undefined]
    )
  })

  it('a lost or damaged answer is asked for again', async () => {
    start()
    b.station.set('M0', 3)
    for (const fault of ['silent', 'crc', 'truncated', 'lost', 'duplicated', 'foreign', 'before', 'after']) {
      b.faults.once(fault)
      assert.deepEqual(values(await read(['M0'])), { M0: 3 }, fault)
    }
  })

  it('a late answer is never taken for a later one', async () => {
    start({ plc: { attempts: 1 } })
    for (let at = 0; at < 20; at++) b.station.set(`M${at}`, 100 + at)
    b.faults.once('late', { argument: 350 })
    const seen = []
    for (let at = 0; at < 20; at++) seen.push(...(await read([`M${at}`])))
    assert.deepEqual(
      seen.map(({ value, code: why }) => why ?? value),
      seen.map((_, at) => (at === 0 ? 'TIMEOUT' : 100 + at))
    )
  })

  it('no master ID is used twice in a row', async () => {
    start()
    const masters = []
    const b2 = bench({ sim: { stations: [{ station: 1, onExecute: ({ master }) => masters.push(master) }] } })
    for (let n = 0; n < 10; n++) await b2.run(b2.device.read(['M0']))
    await b2.close()
    assert.equal(new Set(masters).size, 8)
    masters.forEach((master, at) => assert.ok(master >= 0xe2 && master <= 0xe9 && master !== masters[at - 1]))
  })

  it('repeats a poll by an RR alone only as the sole master, and not after another query', async () => {
    start({ plc: { soleMaster: true } })
    for (let n = 0; n < 4; n++) await read(['M0'])
    assert.equal(b.device.stats.repeats, 3)
    b.station.set('M0', 8)
    assert.deepEqual(values(await read(['M0'])), { M0: 8 })
    await read(['M1'])
    await read(['M0'])
    assert.equal(b.device.stats.repeats, 4)
  })

  it('does not repeat by an RR after bytes from nowhere, or a reconnect', async () => {
    start({ plc: { soleMaster: true } })
    for (let n = 0; n < 2; n++) await read(['M0'])
    assert.equal(b.device.stats.repeats, 1)
    b.wire.noise(Buffer.from([0x55]))
    await b.clock.advance(100)
    await read(['M0'])
    assert.equal(b.device.stats.repeats, 1)
    b.wire.unplug()
    b.wire.plug()
    await b.clock.advance(20000)
    assert.deepEqual(values(await read(['M0'])), { M0: 0 })
    assert.equal(b.device.stats.repeats, 1)
  })

  it('a master ID whose answer failed is used again later', async () => {
    const masters = []
    start({
      plc: { attempts: 1 },
      sim: { stations: [{ station: 1, onExecute: ({ master }) => masters.push(master) }] }
    })
    b.faults.once('silent')
    await read(['M0'])
    const [failed] = masters.splice(0)
    for (let n = 0; n < 8; n++) await read(['M0'])
    assert.equal(masters.includes(failed), true)
  })

  it('keeps what was read before the line broke in the middle of the search for a bad address', async () => {
    start({ sim: { stations: [{ station: 1, areas: [{ area: 'W', words: 100 }] }] } })
    const { run } = b.lease
    let count = 0
    b.lease.run = (make, options) => {
      if (++count < 3) return run.call(b.lease, make, options)
      return Promise.reject(new PlcError('LINE_DOWN', { line: 'x', reason: 'y' }))
    }
    const [first, last] = await read(['W0..W50', 'W51..W101'])
    delete b.lease.run
    assert.equal(first.quality, 'good')
    assert.equal(last.code, 'LINE_DOWN')
    assert.equal(count, 3)
  })

  it('values that mean nothing are bad, not numbers', async () => {
    start()
    b.station.set('W1', 0x7fc0)
    b.station.set('K0', 0xabcd)
    const results = await read(['W0:float32', 'K0:bcd16', 'K1:bcd16'])
    assert.deepEqual(values(results), { W0: 'NOT_A_VALUE', K0: 'NOT_A_VALUE', K1: 0 })
    assert.equal(results[0].value, null)
  })

  it('what is wrong with the request itself is refused before anything is sent', async () => {
    start()
    const wrong = [
      [['M0', 'M128'], 'OUT_OF_AREA'],
      [['X1'], 'UNKNOWN_AREA'],
      [['K1.16'], 'BAD_BIT'],
      [[], 'BAD_ITEMS'],
      ['M0', 'BAD_ITEMS'],
      [[{}], 'BAD_ITEMS'],
      [undefined, 'BAD_ITEMS'],
      [new Array(1001).fill('M0'), 'TOO_MANY'],
      [new Array(20).fill('W0..W2000'), 'TOO_MANY']
    ]
    for (const [items, expected] of wrong) await assert.rejects(b.device.read(items), code(expected), expected)
    assert.equal(b.station.counts.queries, 0)
  })

  it('a line that is down, or closed, is said at once', async () => {
    start()
    await read(['M0'])
    b.wire.unplug()
    const [down] = await read(['M0'])
    assert.match(down.code, /^(LINE_DOWN|PORT_GONE)$/)
    b.wire.plug()
    await b.clock.advance(10000)
    assert.deepEqual(values(await read(['M0'])), { M0: 0 })
    const waiting = b.device.read(['M0'])
    await b.run(b.lease.release())
    assert.equal((await b.run(waiting))[0].code, 'LINE_CLOSED')
  })

  it('refuses impossible settings', () => {
    start()
    const wrong = [
      [{ station: 192 }, 'BAD_STATION'],
      [{ station: 254 }, 'BAD_STATION'],
      [{ station: 256 }, 'BAD_STATION'],
      [{ station: -1 }, 'BAD_STATION'],
      [{ station: 1.5 }, 'BAD_STATION'],
      [{ station: '' }, 'BAD_STATION'],
      [{ station: undefined }, 'BAD_STATION'],
      [{ steps: 3 }, 'BAD_SETTING'],
      [{ timeout: 0 }, 'BAD_SETTING'],
      [{ attempts: 'many' }, 'BAD_SETTING'],
      [{ access: 'admin' }, 'BAD_SETTING'],
      [{ masterIds: '5', stations: [5] }, 'BAD_MASTER_ID'],
      [{ masterIds: '255' }, 'BAD_MASTER_ID'],
      [{ limits: { readWords: 129 } }, 'BAD_SETTING'],
      [{ areas: [{ area: '?' }] }, 'BAD_AREA'],
      [{ tags: [{ name: 'a', address: 'M999' }] }, 'BAD_TAG'],
      [{ writableRanges: 'K0..K200' }, 'OUT_OF_AREA']
    ]
    for (const [own, expected] of wrong) assert.throws(() => b.make(own), code(expected), JSON.stringify(own))
    for (const own of [{ station: '255' }, { masterIds: 'E2..E9' }, { masterIds: '0xF0' }, { steps: '4' }])
      b.make(own).close()
  })

  it('describes what goes out', () => {
    start()
    assert.equal(b.device.describe('W10:float32').goesOut, 'function 23, word addresses 020Ah–020Bh (522–523)')
    assert.equal(b.device.describe('K127.12').goesOut, 'function 21, bit address 1BFCh')
  })
})
