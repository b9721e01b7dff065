'use strict'
const assert = require('node:assert/strict')
const { diagnose } = require('../../lib')
const { ascii, bench, nx, rtu, wrong } = require('./diagnose-bench')

const RTU = { protocol: 'rtu', station: 17 }
const ASCII = { protocol: 'ascii', station: 17 }
const NX = { protocol: 'nx', station: 1 }

// the query of the first read: M0 = word 00C0h from $E2, hr0 of station 17
const ASK_NX = '01e22303c00001'
const ASK_RTU = rtu(0x11, 3, 0, 0, 0, 1)
const VALUE_RTU = rtu(0x11, 3, 2, 0x02, 0x2b)
const value = (master, low, high) => nx(master, 1, 0xa3, low, high)

// manual 3.3, "Communication diagnostics sheet", top to bottom
const SHEET = [
  'How to connect the system',
  'Connection cable name',
  'Version information',
  'Port in use',
  'Driver name',
  'Other detailed settings',
  'Relative prefix: project setting',
  'Relative prefix: communication diagnostics',
  'Transmission speed',
  'Data bit',
  'Stop bit',
  'Parity bit',
  'External device: CPU name',
  'External device: communication port name',
  'External device: protocol (mode)',
  'External device: set-up prefix',
  'External device: other detailed settings',
  'External device: transmission speed',
  'External device: data bit',
  'External device: stop bit',
  'External device: parity bit',
  'Check address range'
]

describe('diagnose: all is well', () => {
  it('NX: one read of M0, after the silence that a line keeps when it was opened', async () => {
    const { wire, run, end } = bench((bytes, { reply }) => reply(value(bytes[1], 0x67, 0x12)), NX)
    const { ok, cause, seen, ms, row } = await run()
    assert.deepEqual([ok, cause, seen.item, seen.value], [true, null, 'M0', 0x1267])
    assert.equal(wire.sent.length, 1)
    assert.ok(wire.hex()[0].startsWith(ASK_NX))
    assert.ok(ms >= 1000 && ms < 1050, ms)
    assert.equal(seen.received, value(0xe2, 0x67, 0x12).toString('hex'))
    assert.equal(seen.framing, '19200 8N1')
    assert.match(row('addressRange').text, /^function 23, word address 00C0h \(192\): 4711$/)
    await end()
  })

  it('RTU: hr0; ASCII: the same in characters', async () => {
    const one = bench((_bytes, { reply }) => reply(VALUE_RTU), RTU)
    assert.deepEqual([(await one.run()).seen.value, one.wire.hex()], [555, [ASK_RTU.toString('hex')]])
    await one.end()
    const other = bench((_bytes, { reply }) => reply(ascii(0x11, 3, 2, 0x02, 0x2b)), ASCII)
    const { seen } = await other.run()
    assert.deepEqual([seen.value, other.wire.sent[0].bytes.toString()], [555, ':110300000001EB\r\n'])
    await other.end()
  })

  it('a given item: the example of the manual, 40108 to 40110', async () => {
    const answer = rtu(0x11, 3, 6, 0x02, 0x2b, 0x00, 0x00, 0x00, 0x64)
    const { wire, run, end } = bench((_bytes, { reply }) => reply(answer), RTU)
    const { ok, seen } = await run({ item: '400108..400110' })
    assert.deepEqual([ok, seen.value], [true, [555, 0, 100]])
    assert.deepEqual(wire.hex(), ['1103006b00037687'])
    assert.equal(seen.goesOut, 'function 03, wire addresses 107–109 (006Bh–006Dh)')
    await end()
  })

  it('none of the tags can be used: what nearly every device has; a gap is that of the protocol', async () => {
    const { wire, run, end } = bench((_bytes, { reply }) => reply(VALUE_RTU), { ...RTU, gap: 7.5 })
    const tags = [{ name: 'a', address: 'hr99999' }, { name: 'b', address: 'hr1', type: 'none' }, { address: 'hr1' }]
    const { ok, seen } = await run({ tags })
    assert.deepEqual([ok, seen.item], [true, 'hr0'])
    assert.deepEqual(wire.hex(), [rtu(0x11, 3, 0, 0, 0, 1).toString('hex')])
    await end()
  })

  it('the first tag that can be used, whatever is wrong with the others', async () => {
    const { wire, run, end } = bench((_bytes, { reply }) => reply(VALUE_RTU), RTU)
    const tags = [null, { name: '2x', address: 'hr1' }, { name: 'bad', address: '9' }, { name: 'u', address: 'hr1' }]
    const { seen } = await run({ tags: [...tags, { name: 'later', address: 'hr2' }] })
    assert.deepEqual([seen.item, seen.value], ['u', 555])
    assert.deepEqual(wire.hex(), [rtu(0x11, 3, 0, 1, 0, 1).toString('hex')])
    await end()
  })

  it('the sheet has all items of the manual, in its order', async () => {
    const { run, end } = bench((_bytes, { reply }) => reply(VALUE_RTU), RTU)
    const { rows } = await run()
    assert.deepEqual(
      rows.map(({ item }) => item),
      SHEET
    )
    const byHand = rows.filter(({ state }) => state === 'byHand').map(({ id }) => id)
    assert.deepEqual(byHand, ['cable', 'version', 'cpuName', 'devicePort', 'deviceSettings', 'deviceStopBits'])
    assert.deepEqual(wrong(rows), [])
    for (const { id, state, value: said } of rows) if (state === 'measured') assert.notEqual(said, null, id)
    await end()
  })

  it('rows say what was measured: an answer proves speed and parity, not the stop bits', async () => {
    const { run, end } = bench((_bytes, { reply }) => reply(VALUE_RTU), RTU)
    const { row } = await run({ baudRate: 9600, parity: 'even' })
    assert.deepEqual(
      ['speed', 'parity', 'stopBits', 'deviceSpeed', 'deviceParity', 'protocol', 'devicePrefix'].map(id => {
        const { state, value: said, result } = row(id)
        return `${id} ${said} ${state} ${result}`
      }),
      [
        'speed 9600 measured ok',
        'parity even measured ok',
        'stopBits 1 configured open',
        'deviceSpeed 9600 measured ok',
        'deviceParity even measured ok',
        'protocol MODBUS RTU measured ok',
        'devicePrefix 17 measured ok'
      ]
    )
    await end()
  })

  for (const exception of [1, 2, 3]) {
    it(`exception 0${exception} to an address that the user did not choose proves the connection`, async () => {
      const { run, end } = bench((_bytes, { reply }) => reply(rtu(0x11, 0x83, exception)), RTU)
      const { ok, cause, seen, row } = await run()
      assert.deepEqual([ok, cause, seen.value, seen.reached], [true, null, null, true])
      assert.deepEqual([row('speed').result, row('addressRange').result], ['ok', 'open'])
      assert.match(row('addressRange').text, /refuses function 03, wire address 0 .* enter an address that it has/)
      await end()
    })
  }

  it('an adapter that hears itself is told in the sheet', async () => {
    const { run, end } = bench((bytes, { reply }) => reply(Buffer.concat([bytes, VALUE_RTU])), RTU)
    const { ok, seen, row } = await run()
    assert.deepEqual([ok, seen.echo], [true, true])
    assert.match(row('systemConfiguration').value, /hears itself/)
    await end()
  })

  it('shares a line that is in use, and leaves a lease to its owner', async () => {
    const { pool, base, clock, run, wire } = bench((_bytes, { reply }) => reply(VALUE_RTU), RTU)
    const lease = pool.open({ transport: 'serial', path: base.path }, { id: 'a', name: 'a' })
    assert.deepEqual([(await run()).seen.shared, wire.connects], [true, 1])
    const { ok, row } = await run({ lease })
    assert.deepEqual([ok, lease.released, row('port').value], [true, false, '/dev/ttyUSB0'])
    await clock.run(lease.release())
  })
})

describe('diagnose: the latency timer of an FTDI adapter', () => {
  const files = text => ({
    realpath: path => Promise.resolve(path === '/dev/serial/by-id/usb-FTDI' ? '/dev/ttyUSB3' : path),
    readFile: path =>
      path === '/sys/bus/usb-serial/devices/ttyUSB3/latency_timer'
        ? Promise.resolve(text)
        : Promise.reject(new Error(path))
  })
  const answering = (_bytes, { reply }) => reply(VALUE_RTU)

  it('16 ms are a row with what to do, no failure', async () => {
    const { run, end } = bench(answering, { ...RTU, path: '/dev/serial/by-id/usb-FTDI', files: files('16\n') })
    const { ok, row } = await run()
    const { value: said, state, result, text } = row('latencyTimer')
    assert.deepEqual([ok, said, state, result], [true, 16, 'measured', 'open'])
    assert.ok(text.includes('echo 1 > /sys/bus/usb-serial/devices/ttyUSB3/latency_timer'), text)
    await end()
  })

  for (const [text, path, expected] of [
    ['1\n', '/dev/serial/by-id/usb-FTDI', 'ok'],
    ['rubbish', '/dev/serial/by-id/usb-FTDI', undefined],
    ['16\n', '/dev/ttyS0', undefined]
  ]) {
    it(`${JSON.stringify(text)} at ${path}: ${expected ?? 'no row'}`, async () => {
      const { run, end } = bench(answering, { ...RTU, path, files: files(text) })
      const { row } = await run()
      assert.equal(row('latencyTimer')?.result, expected)
      await end()
    })
  }
})

describe('diagnose: settings that cannot be used', () => {
  for (const [what, options, code] of [
    ['no protocol', { station: 1 }, 'BAD_SETTING'],
    ['an unknown protocol', { protocol: 'modbus', station: 1 }, 'BAD_SETTING'],
    ['no station', { protocol: 'rtu' }, 'BAD_STATION'],
    ['a station of masters', { protocol: 'nx', station: 200 }, 'BAD_STATION'],
    ['no port', { ...RTU, path: '' }, 'BAD_SETTING'],
    ['RTU with 7 data bits', { ...RTU, dataBits: 7 }, 'BAD_SETTING'],
    ['an item that is no address', { ...RTU, item: 'x9' }, 'BAD_ADDRESS'],
    ['a timeout that is none', { ...RTU, timeout: 'soon' }, 'BAD_SETTING'],
    ['a broadcast, which nobody answers', { ...RTU, station: 0, broadcast: true }, 'BROADCAST_REFUSED'],
    ['ranges that are none', { ...RTU, writableRanges: 'x' }, 'BAD_ADDRESS']
  ]) {
    it(`${what}: ${code}, and nothing is sent`, async () => {
      const { clock, base, wire, end } = bench()
      await clock.run(assert.rejects(diagnose(/** @type {any} */ ({ ...base, ...options })), { code }))
      assert.equal(wire.sent.length, 0)
      await end()
    })
  }

  it('another configuration of the same wire: WIRE_CONFLICT', async () => {
    const { clock, base, pool } = bench()
    const lease = pool.open({ transport: 'serial', path: base.path, baudRate: 9600 }, { id: 'a', name: 'Oven' })
    await clock.run(assert.rejects(diagnose({ ...base, ...RTU }), { code: 'WIRE_CONFLICT' }))
    await clock.run(lease.release())
  })
})
