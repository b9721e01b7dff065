'use strict'

const assert = require('node:assert/strict')
const { PlcError } = require('../../lib')
const { c24Bench } = require('./c24-bench')
const chino = require('./chino-bench')
const { inconBench } = require('./incon-bench')
const nx = require('./support')

const entry = (item, value) => ({ item, value })
const by = { node: 'n1', name: 'Set', message: 'm1' }

const listen = lease => {
  const events = []
  lease.on('event', event => event.event === 'audit' && events.push(event))
  return events
}

/** One event for each write and each refusal, once its outcome is known. */
describe('audit of writes, NX PLC', () => {
  const tags = [
    { name: 'valve', address: 'K12', maxStep: 5, min: 0, max: 100, writable: true },
    { name: 'pump', address: 'K127.12', writable: true }
  ]
  let b
  let events
  const start = (options = {}) => {
    b = nx.bench({ ...options, plc: { name: 'Oven', access: 'write', tags, ...options.plc } })
    events = listen(b.lease)
  }
  afterEach(async () => {
    await b.close()
    assert.equal(b.clock.pending(), 0, 'a timer is left')
  })
  const write = (entries, options) => b.run(b.device.write(entries, { by, ...options }))

  it('of a confirmed one: who, what, when it was asked for, and how long it took', async () => {
    start()
    await b.clock.advance(1234)
    const since = Math.round(b.clock.wall())
    const outcome = await write([entry('valve', '3'), entry('pump', 'on')])
    assert.deepEqual(events, [
      {
        event: 'audit',
        station: 1,
        since,
        device: 'Oven',
        by,
        outcome: 'confirmed',
        items: [
          { item: 'valve', name: 'valve', value: '3', outcome: 'confirmed' },
          { item: 'pump', name: 'pump', value: 'on', outcome: 'confirmed' }
        ],
        attempts: 1,
        ms: Math.round(outcome.ms)
      }
    ])
    assert.ok(!('error' in outcome))
  })

  it('of each other outcome: code, cause and remedy; of nobody in particular: by is null', async () => {
    start()
    const cases = [
      // what is done before, value, options, outcome, code, cause, attempts
      // the reading for the step comes first
      [() => b.faults.once('silent', { skip: 1 }), 1, {}, 'unknown', 'WRITE_UNKNOWN', /^it is not known whether/, 1],
      [() => b.station.set('K12', 50), 1, {}, 'refused', 'STEP_TOO_LARGE', /^valve was not written: it is 50 now/, 0],
      [() => {}, 101, {}, 'refused', 'VALUE_OUT_OF_RANGE', /^valve cannot take 101: allowed is 0 to 100$/, 0],
      [() => {}, null, {}, 'refused', 'BAD_VALUE', /valve/, 0],
      [() => b.station.setMode('program'), 50, {}, 'refused', 'PLC_NOT_PERFORMED', /./, 1],
      [() => b.station.setMode('run'), 50, { coalesce: true }, 'confirmed', undefined, /^$/, 1],
      [() => b.faults.once('silent', { times: 10 }), 50, {}, 'failed', 'TIMEOUT', /^station 1 /, 0]
    ]
    for (const [before, value, options, outcome, code, cause, attempts] of cases) {
      before()
      const given = await b.run(b.device.write([entry('valve', value)], options))
      const event = events.at(-1)
      const got = [event.outcome, event.code, event.attempts, event.by]
      assert.deepEqual(got, [outcome, code, attempts, null], `${value}: ${given.text}`)
      assert.deepEqual([given.outcome, given.code], [outcome, code])
      assert.match(event.cause ?? '', cause)
      if (code) assert.equal(`${event.cause}. ${event.remedy}`, given.text)
      assert.equal(event.items.length, 1)
    }
    assert.equal(events.length, cases.length)
  })

  it('of each one that is superseded, and of that which goes out', async () => {
    start()
    const busy = b.device.read(['M0..M127'])
    await b.run(Promise.all([1, 2, 3].map(value => b.device.write([entry('valve', value)], { by, coalesce: true }))))
    await b.run(busy)
    assert.deepEqual(
      events.map(({ code, outcome, items }) => [items[0].value, code ?? outcome]),
      [
        [1, 'SUPERSEDED'],
        [2, 'SUPERSEDED'],
        [3, 'confirmed']
      ]
    )
  })

  it('read-only, not writable, too soon: each refusal', async () => {
    start({ plc: { writeInterval: 1000 } })
    const reader = b.make({ access: 'read', name: 'Reader' })
    await b.run(reader.write([entry('valve', 1)], { by }))
    await write([entry('K0', 1)])
    await write([entry('pump', 1)])
    await write([entry('pump', 0)])
    await write([])
    await write(undefined)
    assert.deepEqual(
      events.map(({ device, code, outcome }) => [device, code ?? outcome]),
      [
        ['Reader', 'READ_ONLY'],
        ['Oven', 'NOT_WRITABLE'],
        ['Oven', 'confirmed'],
        ['Oven', 'WRITE_TOO_SOON'],
        ['Oven', 'NOTHING_TO_WRITE'],
        ['Oven', 'NOTHING_TO_WRITE']
      ]
    )
    reader.close()
  })

  it('of what its owner refuses: told, and nothing else', async () => {
    start()
    const error = new PlcError('RETAINED_REFUSED', { item: 'valve' })
    const outcome = b.device.refused([entry('valve', 7)], error, { by })
    assert.deepEqual([outcome.outcome, outcome.code, outcome.attempts], ['refused', 'RETAINED_REFUSED', 0])
    const [{ since, ...event }] = events
    assert.equal(since, Math.round(b.clock.wall()))
    assert.deepEqual(event, {
      event: 'audit',
      station: 1,
      device: 'Oven',
      by,
      outcome: 'refused',
      code: 'RETAINED_REFUSED',
      cause: 'a retained MQTT message was not written to valve',
      remedy: 'Publish set values without retain, or accept retained messages in the node.',
      items: [{ item: 'valve', name: 'valve', value: 7, outcome: 'notSent' }],
      attempts: 0,
      ms: 0
    })
    b.device.refused([], new PlcError('BAD_VALUE', { item: 'pump', value: null, reason: 'it is empty' }))
    assert.deepEqual(events[1].items, [{ item: 'pump', name: 'pump', value: null, outcome: 'notSent' }])
    assert.equal(b.station.counts.queries, 0)
  })

  it('what a message brings is shortened and shown without control characters, and stays plain data', async () => {
    start()
    const loop = []
    loop.push(loop)
    const odd = new Proxy([1], {
      get() {
        throw new Error('do not look')
      }
    })
    const values = ['a\u001b[31m\n\u0000b', 'x'.repeat(500), NaN, 10n, () => 1, { a: 1 }, loop, odd, undefined, '온도']
    const entries = values.map(value => entry('K0\u0007', value))
    b.device.refused(entries, new PlcError('RETAINED_REFUSED', { item: 'K\u0007' }), {
      by: { node: 'n\n', name: 'y'.repeat(200), message: { a: 1 } }
    })
    const [event] = events
    assert.deepEqual(
      event.items.map(({ value }) => value),
      [
        ...['a·[31m··b', `${'x'.repeat(79)}…`, 'NaN', '10', '(function)', '(object)', ['(array)'], '(object)', null],
        '온도'
      ]
    )
    assert.equal(event.items[0].item, 'K0·')
    assert.match(event.cause, /^[\x20-\x7e·]*$/)
    assert.deepEqual(event.by, { node: 'n·', name: `${'y'.repeat(79)}…`, message: '(object)' })
    assert.deepEqual(JSON.parse(JSON.stringify(event)), event)
  })

  it('at most 100 items, then how many more; a long range is shortened', async () => {
    start()
    const error = new PlcError('RETAINED_REFUSED', { item: 'many' })
    b.device.refused(new Array(130).fill(entry('K0', 1)), error)
    b.device.refused([entry('M0..M127', new Array(128).fill(3))], error)
    assert.deepEqual([events[0].items.length, events[0].more], [100, 30])
    assert.deepEqual([events[1].items[0].value.length, events[1].items[0].value.at(-1)], [101, '… 28 more'])
    assert.ok(!('more' in events[1]))
  })

  it('who listens and throws does not change what becomes of the write', async () => {
    start()
    b.lease.on('event', ({ event }) => {
      if (event === 'audit') throw new Error('a listener')
    })
    assert.equal((await write([entry('valve', 1)])).outcome, 'confirmed')
  })

  it('it is no disturbance: a poll may still be repeated by an RR alone', async () => {
    start({ plc: { soleMaster: true } })
    const read = () => b.run(b.device.read(['K0']))
    await read()
    await read()
    const { repeats } = b.device.stats
    assert.equal(repeats, 1)
    await write([entry('K0', 1)])
    assert.equal(events[0].code, 'NOT_WRITABLE')
    await read()
    assert.equal(b.device.stats.repeats, 2)
  })
})

describe('audit of writes, CHINO regulator', () => {
  it('confirmed, refused by the station, broadcast', async () => {
    const b = chino.bench({ device: { name: 'Zone' } })
    const events = listen(b.lease)
    await b.write([entry('400001', 5)], { by })
    b.slave.next.push({ exception: 3 })
    await b.write([entry('400001', 6)], { by })
    const all = b.make({ station: 0, broadcast: true, name: 'All' })
    await b.run(all.write([entry('400001', 7)], { by, fixed: true }))
    assert.deepEqual(
      events.map(({ station, device, outcome, code, attempts }) => [station, device, outcome, code, attempts]),
      [
        [11, 'Zone', 'confirmed', undefined, 1],
        [11, 'Zone', 'refused', 'MODBUS_ILLEGAL_VALUE', 1],
        [0, 'All', 'unknown', 'BROADCAST_UNCONFIRMED', 1]
      ]
    )
    assert.deepEqual(events[1].items, [
      { item: '400001', name: '_400001', value: 6, outcome: 'refused', code: 'MODBUS_ILLEGAL_VALUE' }
    ])
    all.close()
    await b.close()
  })
})

describe('audit of sent messages', () => {
  const short = ({ outcome, code, bytes, text, by: who }) => [outcome, code, bytes, text, who?.message]

  it('C24: sent, refused, not sent; acknowledged and not', async () => {
    const b = c24Bench({ port: { name: 'Press' } })
    const events = listen(b.lease)
    await b.run(b.device.send('AB\u0002C', { by }))
    await b.run(b.device.send({ a: 1 }, { by }))
    b.device.refused('x', new PlcError('SENDING_OFF', { node: 'Press' }), { by })
    b.device.close()
    await b.run(b.device.send(Buffer.from([0x41, 0, 0x42]), { by }))
    assert.deepEqual(events.map(short), [
      ['sent', undefined, 6, 'AB·C', 'm1'],
      ['refused', 'BAD_VALUE', 0, '(object)', 'm1'],
      ['refused', 'SENDING_OFF', 0, 'x', 'm1'],
      ['failed', 'LINE_CLOSED', 0, 'A·B', 'm1']
    ])
    const [{ since, ms, ...event }] = events
    assert.deepEqual(event, {
      ...{ event: 'audit', station: null, device: 'Press', by, outcome: 'sent' },
      ...{ items: [], bytes: 6, text: 'AB·C', attempts: 1 }
    })
    assert.ok(Number.isInteger(since) && Number.isInteger(ms))
    assert.match(events[2].cause, /Press sent nothing/)
    await b.close()
  })

  it('C24, bidirectional: confirmed by ACK, unknown without', async () => {
    let answer = [6]
    const b = c24Bench({
      port: { bidirectional: true, ackTimeout: 200 },
      onBytes: (_bytes, peer) => answer && peer.sayIn(20, answer)
    })
    const events = listen(b.lease)
    await b.run(b.device.send('ones', { by }))
    answer = null
    await b.run(b.device.send('twos', { by }))
    assert.deepEqual(
      events.map(({ outcome, code, text }) => [outcome, code, text]),
      [
        ['confirmed', undefined, 'ones'],
        ['unknown', 'TIMEOUT', 'twos']
      ]
    )
    assert.ok(events[1].cause && events[1].remedy)
    await b.clock.advance(3000)
    await b.close()
  })

  it('INCON: sent, refused', async () => {
    const b = inconBench()
    const events = listen(b.lease)
    await b.run(b.device.send('START', { by }))
    await b.run(b.device.send('two\nlines', { by }))
    b.device.refused(5, new PlcError('RETAINED_REFUSED', { item: 'INCON' }), { by })
    assert.deepEqual(
      events.map(({ station, outcome, text, attempts }) => [station, outcome, text, attempts]),
      [
        [null, 'sent', 'START', 1],
        [null, 'refused', 'two·lines', 0],
        [null, 'refused', '5', 0]
      ]
    )
    await b.close()
  })
})

describe('audit: whatever it is given', () => {
  const { createAudit } = require('../../lib/device/audit')
  const told = (outcome, facts, what = 'message') => {
    const events = []
    createAudit({ line: { report: event => events.push(event) }, device: 'D' })[what](
      { outcome: 'failed', attempts: 0, ms: 0.4, items: [], bytes: 0, ...outcome },
      { since: 7.6, ...facts }
    )
    return events[0]
  }

  it('a value that cannot be looked at, one that is none', () => {
    const trap = new Proxy([], {
      get: () => {
        throw new Error('trap')
      }
    })
    assert.equal(told({}, { value: trap }).text, '(object)')
    const gone = new Uint8Array(8)
    structuredClone(gone.buffer, { transfer: [gone.buffer] })
    assert.equal(told({}, { value: gone }).text, '(object)')
    assert.equal(told({}, { value: null }).text, '')
    assert.equal(told({}, { value: undefined }).text, '')
    assert.equal(told({}, { value: [1, 'a', true] }).text, '1 a true')
    assert.equal(told({}, { value: Buffer.from('A\x07B') }).text, 'A·B')
    assert.equal(told({}, { value: Buffer.alloc(100, 0x41) }).text, `${'A'.repeat(79)}…`)
  })

  it('who asked, as far as it is known', () => {
    assert.equal(told({}, {}).by, null)
    assert.deepEqual(told({}, { by: { node: 'n', message: 5 } }).by, { node: 'n', name: null, message: 5 })
    assert.deepEqual(told({}, { by: { name: 'x\n' } }).by, { node: null, name: 'x·', message: null })
  })

  it('why, by an error or by what the outcome says of it; the times are whole', () => {
    const plain = told({ code: 'X', text: 'why' }, {})
    assert.deepEqual([plain.code, plain.cause, plain.remedy, plain.since, plain.ms], ['X', 'why', undefined, 8, 0])
    const { code, cause, remedy } = told({}, { error: new PlcError('PORT_BUSY', { path: 'p' }) })
    assert.equal(code, 'PORT_BUSY')
    assert.ok(cause.length > 0 && remedy.length > 0)
    assert.equal('code' in told({}, {}), false)
  })

  it('a fault of who listens changes nothing', () => {
    const line = {
      report: () => {
        throw new Error('no')
      }
    }
    createAudit({ line, device: 'D' }).write({ outcome: 'failed', attempts: 0, ms: 0, items: [] }, { since: 0 })
  })
})
