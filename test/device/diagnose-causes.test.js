'use strict'
const assert = require('node:assert/strict')
const { PlcError, createPool, diagnose } = require('../../lib')
const { simulated } = require('../../lib/line/transports/memory')
const { createLine, createVirtualClock } = require('../../lib/sim')
const { ascii, bench, nx, rtu, wrong } = require('./diagnose-bench')

const RTU = { protocol: 'rtu', station: 17 }
const ASCII = { protocol: 'ascii', station: 17 }
const NX = { protocol: 'nx', station: 1 }
const VALUE_RTU = rtu(0x11, 3, 2, 0x02, 0x2b)

/** Bytes in answer to each query, or none. */
const says =
  (bytes, { after = 5 } = {}) =>
  (query, { reply }) =>
    reply(typeof bytes === 'function' ? bytes(query) : bytes, { after })

const other = master => nx(master, 3, 0xa3, 5, 0)

describe('diagnose: the likely cause, by the bytes that were seen', () => {
  // [what, settings, what comes back, cause, its text, rows that are wrong]
  const cases = [
    ['no bytes, NX', { ...NX, masterIds: 'E2' }, null, 'NO_BYTES', /not one byte .* station 1 /, []],
    ['no bytes, RTU', RTU, null, 'NO_BYTES', /station 17 within 12\d\d ms/, []],
    ['no bytes over TCP', { ...RTU, host: 'box', port: 4001 }, null, 'SERVER_SILENT', /box:4001 accepts the con/, []],
    ['our own echo alone', RTU, query => query, 'ECHO_ONLY', /only our own query .* station 17/, []],
    ['our echo, not expected', { ...RTU, echo: 'off' }, query => query, 'ECHO_ONLY', /only our own/, []],
    ['our echo, ASCII', ASCII, query => query, 'ECHO_ONLY', /only our own/, []],
    ['our echo, NX', { ...NX, echo: 'off', masterIds: 'E2' }, query => query, 'ECHO_ONLY', /only our own/, []],
    ['garbage', RTU, Buffer.from('f8e07f00c3', 'hex'), 'GARBAGE', /^5 bytes .*: F8 E0 7F 00 C3$/, []],
    ['a damaged frame of another', RTU, Buffer.from('0303020000ffff', 'hex'), 'GARBAGE', /^7 bytes/, []],
    ['a damaged answer', RTU, Buffer.from('1103020000ffff', 'hex'), 'CRC_ERROR', /damaged/, []],
    ['a damaged answer, ASCII', ASCII, Buffer.from(':1103020000FF\r\n'), 'CRC_ERROR', /damaged/, []],
    ['half an answer', RTU, VALUE_RTU.subarray(0, 5), 'INCOMPLETE', /stopped after 5 of 7 bytes/, []],
    ['another station, RTU', RTU, rtu(3, 3, 2, 0, 7), 'OTHER_STATION', /station 3 was heard/, ['prefixProject']],
    ['another station refuses', RTU, rtu(4, 0x83, 2), 'OTHER_STATION', /station 4 was heard/, ['prefixProject']],
    ['another station, ASCII', ASCII, ascii(9, 3, 2, 0, 7), 'OTHER_STATION', /station 9 was heard/, ['prefixProject']],
    ['another station, NX', NX, query => other(query[1]), 'OTHER_STATION', /station 3 was heard/, ['prefixProject']],
    ['another master, NX', NX, nx(0xc8, 3, 0xa3, 5, 0), 'OTHER_MASTER', /another master/, ['systemConfiguration']],
    ['another master asks, NX', NX, nx(3, 0xc8, 0x23, 1, 0xbf, 1, 1), 'OTHER_MASTER', /.*/, ['systemConfiguration']],
    ['another master asks, RTU', RTU, rtu(3, 3, 0, 1, 0, 9), 'OTHER_MASTER', /another master/, ['systemConfiguration']],
    ['ASCII on RTU', RTU, ascii(0x11, 3, 2, 0, 7), 'OTHER_MODE', /MODBUS ASCII was heard, RTU is/, ['protocol']],
    ['RTU on ASCII', ASCII, rtu(3, 4, 2, 0, 7), 'OTHER_MODE', /MODBUS RTU was heard, ASCII is/, ['protocol']],
    ['NX on MODBUS', RTU, nx(0xe2, 6, 0xa3, 1, 2, 3, 4), 'OTHER_PROTOCOL', /NX .* station 6/, ['driver', 'protocol']],
    ['MODBUS on NX', NX, rtu(3, 3, 4, 0, 7, 0, 8), 'OTHER_PROTOCOL', /MODBUS RTU .* station 3/, ['driver', 'protocol']],
    [
      'the answer to another question',
      RTU,
      rtu(0x11, 4, 2, 0, 7),
      'UNEXPECTED',
      /: 11 04 02 00 07/,
      ['systemConfiguration']
    ],
    ['the same, NX', NX, query => nx(query[1], 1, 0xa1, 1, 0), 'UNEXPECTED', /whole frame/, ['systemConfiguration']],
    [
      'the same, of the only PLC',
      { ...NX, station: 255 },
      query => nx(query[1], 9, 0xa1, 1, 0),
      'UNEXPECTED',
      /whole frame/,
      ['systemConfiguration']
    ],
    [
      'exception 01',
      { ...RTU, item: '400005' },
      rtu(0x11, 0x83, 1),
      'MODBUS_ILLEGAL_FUNCTION',
      /ion 01/,
      ['addressRange']
    ],
    [
      'exception 02',
      { ...RTU, item: '400005' },
      rtu(0x11, 0x83, 2),
      'WRONG_ADDRESS',
      /not have 400005/,
      ['addressRange']
    ],
    ['exception 04', RTU, rtu(0x11, 0x83, 4), 'MODBUS_DEVICE_FAILURE', /exception 04/, []],
    ['exception 0B', RTU, rtu(0x11, 0x83, 0x0b), 'MODBUS_GATEWAY_TARGET', /exception 0B/, []],
    ['error 2, NX', { ...NX, item: 'K5' }, query => nx(query[1], 1, 0x83, 2), 'WRONG_ADDRESS', /K5/, ['addressRange']],
    ['error 1, NX', NX, query => nx(query[1], 1, 0x83, 1), 'WRONG_STEPS', /the 2-step method/, ['protocol']],
    ['no service, NX', { ...NX, steps: 4 }, query => nx(query[1], 1, 0, 0), 'WRONG_STEPS', /4-step/, ['protocol']]
  ]
  for (const [what, options, bytes, code, text, rows] of /** @type {any[]} */ (cases)) {
    it(`${what}: ${code}`, async () => {
      const { run, end } = bench(bytes === null ? () => {} : says(bytes), options)
      const { ok, cause, rows: sheet } = await run()
      assert.deepEqual([ok, cause.code], [false, code])
      assert.match(cause.text, text)
      assert.match(cause.remedy, /\.$/)
      assert.doesNotMatch(`${cause.text} ${cause.remedy}`, /[{}]|undefined|\?/)
      assert.deepEqual(wrong(sheet), rows)
      await end()
    })
  }

  it('the station itself has spoken: the rows of the wire are proven; a gateway has not', async () => {
    for (const [number, expected] of /** @type {[number, any[]][]} */ ([
      [4, [true, 'ok']],
      [0x0a, [false, 'open']],
      [0x0b, [false, 'open']]
    ])) {
      const { run, end } = bench(says(rtu(0x11, 0x83, number)), RTU)
      const { seen, row } = await run()
      assert.deepEqual([seen.reached, row('speed').result], expected)
      await end()
    }
  })

  it('a tag was chosen by the user: its refusal is a failure', async () => {
    const { run, end } = bench(says(rtu(0x11, 0x83, 2)), RTU)
    assert.equal((await run({ tags: [{ name: 'output', address: '400005' }] })).cause.code, 'WRONG_ADDRESS')
    await end()
  })

  it('the number of another station is shown where it was heard, and is no set-up of ours', async () => {
    const { run, end } = bench(says(rtu(3, 3, 2, 0, 7)), RTU)
    const { row, seen } = await run()
    const { value, state, result } = row('devicePrefix')
    assert.deepEqual([value, state, result, seen.stations], [3, 'measured', 'open', [3]])
    assert.equal(row('prefixProject').value, 17)
    await end()
  })

  it('what was seen before is no evidence; nobody is left listening', async () => {
    const { pool, base, clock, run } = bench((_query, { reply }, n) => n === 1 && reply(rtu(3, 3, 2, 0, 7)), RTU)
    const lease = pool.open({ transport: 'serial', path: base.path }, { id: 'a', name: 'a' })
    assert.equal((await run()).cause.code, 'OTHER_STATION')
    await clock.advance(5)
    const listening = lease.line.listenerCount('event')
    assert.equal((await run()).cause.code, 'NO_BYTES')
    assert.equal((await run({ lease })).cause.code, 'NO_BYTES')
    assert.equal(lease.line.listenerCount('event'), listening)
    await clock.run(lease.release())
  })

  for (const [what, options, answer] of /** @type {any[]} */ ([
    ['RTU', RTU, () => VALUE_RTU],
    ['NX', NX, query => nx(query[1], 1, 0xa3, 5, 0)]
  ])) {
    it(`${what}: a station that answers others on this line, and not this query, is unsteady`, async () => {
      const { createChinoRegulator, createNxPlc } = require('../../lib')
      // words are answered, the bit that is asked for is not
      const isWord = query => (what === 'NX' ? query[2] === 0x23 : query[1] === 3)
      const poll = (query, { reply }) => isWord(query) && reply(answer(query), { after: 30 })
      const { pool, base, clock, run } = bench(poll, options)
      const lease = pool.open({ transport: 'serial', path: base.path }, { id: 'a', name: 'a' })
      const poller = (what === 'NX' ? createNxPlc : createChinoRegulator)({ ...options, lease, clock })
      poller.subscribe({ items: [what === 'NX' ? 'M5' : 'hr5'], interval: 20 }, () => {})
      // one of the polls is on its way now
      await clock.advance(1300)
      const { cause, seen } = await run({ item: what === 'NX' ? 'M0.0' : 'co0' })
      poller.close()
      assert.deepEqual([seen.code, cause.code], ['TIMEOUT', 'UNSTEADY'])
      // the query that is told is ours, and its time, though polls went out after it
      assert.equal(isWord(Buffer.from(seen.sent, 'hex')), false)
      assert.ok(seen.waited >= 200, String(seen.waited))
      await clock.run(lease.release())
    })
  }

  it('characters of 7 bits with parity, read as 8: ASCII, with what it is', async () => {
    const even = byte => byte | ((byte.toString(2).replaceAll('0', '').length % 2) << 7)
    const { run, end } = bench(says(Buffer.from(ascii(0x11, 3, 2, 0, 7).map(even))), ASCII)
    const { cause } = await run()
    assert.equal(cause.code, 'OTHER_MODE')
    assert.match(cause.remedy, /7 data bits/)
    await end()
  })

  it('exception 02 hints at the address mode; a number on the wire has none', async () => {
    const { run, end } = bench(says(rtu(0x11, 0x83, 2)), RTU)
    assert.match((await run({ item: '400005' })).cause.remedy, /0-base/)
    assert.match((await run({ item: '400005', addressMode: '0-base' })).cause.remedy, /1-base/)
    assert.doesNotMatch((await run({ item: 'hr4' })).cause.remedy, /-base/)
    await end()
  })

  it('what a station says to another, on a line that others use, is no evidence', async () => {
    const answer = query => query[0] === 3 && rtu(3, 3, 2, 0, 7)
    const { pool, base, clock, run } = bench((query, { reply }) => answer(query) && reply(answer(query)), RTU)
    const lease = pool.open({ transport: 'serial', path: base.path }, { id: 'a', name: 'a' })
    const { createChinoRegulator } = require('../../lib')
    const poller = createChinoRegulator({ lease, clock, station: 3, timeout: 200 })
    const polled = []
    poller.subscribe({ items: ['hr0'], interval: 20 }, ([{ value }]) => polled.push(value))
    const { cause, seen } = await run()
    poller.close()
    assert.deepEqual([cause.code, seen.stations, seen.shared], ['NO_BYTES', [], true])
    assert.ok(polled.length > 20)
    await clock.run(lease.release())
  })
})

describe('diagnose: a late answer', () => {
  for (const [what, options, bytes] of [
    ['NX', NX, query => nx(query[1], 1, 0xa3, 5, 0)],
    ['RTU', RTU, VALUE_RTU],
    ['ASCII', ASCII, ascii(0x11, 3, 2, 0, 7)]
  ]) {
    it(`${what}: says how late, and asks for a longer timeout`, async () => {
      const { wire, run, end } = bench(says(bytes, { after: 550 }), options)
      const { cause, seen, ms, rows, row } = await run()
      assert.equal(cause.code, 'LATE')
      // it has answered: all but the timeout is right
      assert.deepEqual([seen.reached, row('speed').result, row('protocol').result], [false, 'ok', 'ok'])
      assert.match(cause.text, /answered 350 ms after its 200 ms timeout/)
      assert.match(cause.remedy, /900 ms/)
      assert.deepEqual([seen.lateness, wire.sent.length, wrong(rows)], [350, 1, ['otherSettings']])
      // it has been heard: nothing more is waited for
      assert.ok(ms < 1000 + 600, ms)
      await end()
    })
  }

  it('listens for the bound of lateness and no longer', async () => {
    const { run, end } = bench(says(VALUE_RTU, { after: 1300 }), RTU)
    const { cause, ms } = await run()
    assert.equal(cause.code, 'NO_BYTES')
    assert.ok(ms > 2200 && ms < 2230, ms)
    await end()
  })
})

describe('diagnose: the line', () => {
  const failing = error => {
    const made = bench(() => {}, RTU)
    made.wire.refuse = error
    return made
  }
  for (const code of ['PORT_NOT_FOUND', 'PORT_BUSY', 'PORT_DENIED', 'PORT_ERROR', 'CONNECT_FAILED', 'WIRE_IN_USE']) {
    it(`${code}: its text and remedy, the row of the port`, async () => {
      const details = { path: '/dev/ttyUSB0', reason: 'nothing', other: 'x', owner: 'y' }
      const { run, end } = failing(new PlcError(/** @type {any} */ (code), details))
      const { cause, rows, row, ms } = await run()
      assert.equal(cause.code, code)
      assert.ok(cause.text.startsWith(code === 'CONNECT_FAILED' ? '/dev' : ''), cause.text)
      assert.ok(!cause.text.includes(cause.remedy))
      assert.deepEqual(wrong(rows), ['port'])
      assert.equal(row('port').state, 'measured')
      assert.ok(ms < 100, ms)
      await end()
    })
  }

  it('a line that is never silent: LINE_JAMMED, and nothing is sent', async () => {
    const { clock, wire, run, end } = bench(() => {}, RTU)
    let stop = false
    const flood = () => {
      if (stop) return
      wire.handlers?.data(Buffer.alloc(2, 0x55))
      clock.setTimer(flood, 1)
    }
    flood()
    const { cause, rows } = await run()
    stop = true
    assert.deepEqual([cause.code, wire.sent.length, wrong(rows)], ['LINE_JAMMED', 0, ['systemConfiguration']])
    await end()
  })

  it('a connection that breaks while the answer is awaited', async () => {
    const { run, end } = bench((_bytes, wire) => wire.unplug(), { ...RTU, host: 'box', port: 4001 })
    const { cause, rows } = await run()
    assert.deepEqual([cause.code, wrong(rows)], ['PORT_GONE', ['port']])
    await end()
  })

  it('a half-open connection takes no longer than the timeout and the bound of lateness', async () => {
    const { run, end } = bench(() => {}, { ...RTU, host: 'box', port: 4001 })
    const { cause, ms, row } = await run({ tryOtherSpeeds: true })
    assert.equal(cause.code, 'SERVER_SILENT')
    assert.ok(ms < 1000 + 200 + 1000 + 30, ms)
    assert.equal(row('port').result, 'ok')
    await end()
  })

  it('over TCP the speed is the server’s: no answer proves it', async () => {
    const { run, end } = bench(says(VALUE_RTU), { ...RTU, host: 'box', port: 4001 })
    const { ok, row, seen } = await run()
    assert.deepEqual([ok, row('speed').state, row('speed').result, seen.framing], [true, 'configured', 'open', null])
    assert.match(row('speed').text, /serial server/)
    assert.equal(row('deviceSpeed').value, null)
    await end()
  })
})

describe('diagnose: simulated stations', () => {
  const onSim = async (stations, options) => {
    const clock = createVirtualClock()
    const { wire } = createLine({ clock, stations, quiet: true })
    const transports = { simulated: (settings, time) => simulated(settings, time) }
    const pool = createPool({ clock, random: () => 0.5, transports })
    const base = { transport: 'simulated', path: 'sim', wire, pool, clock, random: () => 0, timeout: 200 }
    return clock.run(diagnose(/** @type {any} */ ({ ...base, ...options })))
  }
  const chino = more => [{ device: 'chino', station: 17, ...more }]

  it('a regulator, RTU and ASCII', async () => {
    assert.equal((await onSim(chino({}), RTU)).seen.value, 0)
    assert.equal((await onSim(chino({ protocol: 'ascii' }), ASCII)).ok, true)
  })

  it('a regulator that has other registers only', async () => {
    const sheet = await onSim(chino({ tables: { hr: ['400101..400110'] } }), RTU)
    assert.deepEqual([sheet.ok, sheet.seen.code], [true, 'MODBUS_ILLEGAL_ADDRESS'])
  })

  it('a PLC of the 4-step method asked by the other one', async () => {
    for (const more of [{}, { noService: true }, { errorForm: 'function' }]) {
      const { cause } = await onSim([{ station: 1, steps: 4, ...more }], NX)
      assert.equal(cause.code, 'WRONG_STEPS')
      assert.match(cause.remedy, /to 4\./)
    }
  })

  it('a PLC that answers the first configured master ID only', async () => {
    const { cause, seen } = await onSim([{ station: 1, onlyMaster: 0xe2 }], { ...NX, random: () => 0.5 })
    assert.equal(cause.code, 'FIXED_MASTER_ID')
    assert.match(cause.remedy, /to 0xE2 \(226\) alone/)
    assert.deepEqual(
      seen.tried.map(({ what, answered }) => `${what} ${answered}`),
      ['master ID 0xE2 (226) true', 'master ID 0xE6 (230) false']
    )
  })

  it('… or another one of them, if all are to be tried', async () => {
    const stations = [{ station: 1, onlyMaster: 0xe9 }]
    assert.equal((await onSim(stations, NX)).cause.code, 'NO_BYTES')
    const { cause } = await onSim(stations, { ...NX, tryOtherModes: true })
    assert.deepEqual([cause.code, /0xE9/.test(cause.remedy)], ['FIXED_MASTER_ID', true])
  })
})
