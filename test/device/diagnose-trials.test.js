'use strict'
const assert = require('node:assert/strict')
const { ascii, bench, nx, rtu, wrong } = require('./diagnose-bench')

const RTU = { protocol: 'rtu', station: 17 }
const VALUE_RTU = rtu(0x11, 3, 2, 0x02, 0x2b)
const VALUE_ASCII = ascii(0x11, 3, 2, 0x02, 0x2b)

/** A device that understands one framing; to others it says nothing, or garbage. */
const deviceAt = (framing, { answer = VALUE_RTU, garbage = null, ...options } = {}) => {
  const made = bench((_bytes, { reply }) => {
    const { baudRate, dataBits, parity } = made.opened.at(-1)
    if (`${baudRate} ${dataBits} ${parity}` === framing) reply(answer)
    else if (garbage) reply(garbage)
  }, options)
  return made
}
const speeds = opened => opened.map(({ baudRate, dataBits, parity }) => `${baudRate}${dataBits}${parity[0]}`)

describe('diagnose: other speeds, on request', () => {
  it('finds the speed at which the station answers', async () => {
    const { run, opened, end } = deviceAt('38400 8 none', RTU)
    const { ok, cause, seen, rows, row } = await run({ tryOtherSpeeds: true })
    assert.deepEqual([ok, cause.code, seen.framing], [false, 'OTHER_SPEED', '38400 8N1'])
    assert.match(cause.text, /answers at 38400 8N1, not at 19200 8N1/)
    assert.deepEqual(speeds(opened), ['192008n', '96008n', '384008n'])
    assert.deepEqual(wrong(rows), ['speed'])
    assert.deepEqual([row('speed').value, row('deviceSpeed').value, row('deviceSpeed').result], [19200, 38400, 'ok'])
    await end()
  })

  it('finds the parity, after garbage', async () => {
    const garbage = Buffer.from('f81c03', 'hex')
    const { run, end } = deviceAt('19200 8 even', { ...RTU, garbage })
    const { cause, seen, rows } = await run({ tryOtherSpeeds: true })
    assert.deepEqual([cause.code, seen.framing, wrong(rows)], ['OTHER_SPEED', '19200 8E1', ['parity']])
    assert.equal(seen.received, 'f81c03')
    await end()
  })

  it('finds both; a refusal is an answer, too', async () => {
    const { run, end } = deviceAt('1200 8 odd', { ...RTU, answer: rtu(0x11, 0x83, 2) })
    const { cause, seen, ms } = await run({ tryOtherSpeeds: true, trialTime: 60000 })
    assert.deepEqual([cause.code, seen.framing], ['OTHER_SPEED', '1200 8O1'])
    assert.ok(ms < 1000 + 1200 + 24 * 300, ms)
    await end()
  })

  it('ASCII has 7 data bits as well', async () => {
    const { run, end } = deviceAt('9600 7 even', { protocol: 'ascii', station: 17, answer: VALUE_ASCII })
    const { cause, seen, rows } = await run({ tryOtherSpeeds: true })
    assert.deepEqual([cause.code, seen.framing], ['OTHER_SPEED', '9600 7E1'])
    assert.deepEqual(wrong(rows), ['speed', 'dataBits', 'parity'])
    await end()
  })

  it('and 8, where 7 is configured', async () => {
    const made = deviceAt('19200 8 none', {
      protocol: 'ascii',
      station: 17,
      dataBits: 7,
      parity: 'even',
      answer: VALUE_ASCII
    })
    const { cause, seen } = await made.run({ tryOtherSpeeds: true, trialTime: 60000 })
    assert.deepEqual([cause.code, seen.framing], ['OTHER_SPEED', '19200 8N1'])
    await made.end()
  })

  it('NX: the answer to any of its master IDs', async () => {
    const made = bench((bytes, { reply }) => {
      if (made.opened.at(-1).baudRate === 9600) reply(nx(bytes[1], 1, 0xa3, 5, 0))
    })
    const { cause } = await made.run({ protocol: 'nx', station: 1, tryOtherSpeeds: true })
    assert.equal(cause.code, 'OTHER_SPEED')
    await made.end()
  })

  it('is not done unless asked for', async () => {
    const { run, opened, end } = deviceAt('9600 8 none', RTU)
    const { cause, seen } = await run()
    assert.deepEqual([cause.code, speeds(opened), seen.tried, seen.notTried], ['NO_BYTES', ['192008n'], [], ''])
    await end()
  })

  it('takes no longer than trialTime and one trial', async () => {
    const { run, opened, end } = bench(() => {}, RTU)
    const { cause, seen, ms } = await run({ tryOtherSpeeds: true, trialTime: 2000 })
    assert.equal(cause.code, 'NO_BYTES')
    assert.ok(ms < 1000 + 1200 + 2000 + 500, ms)
    assert.ok(opened.length > 5 && opened.length < 12, opened.length)
    assert.equal(seen.tried.length, opened.length - 1)
    await end()
  })

  it('tries 8 speeds with 3 parities at most, each once', async () => {
    const { run, opened, end } = bench(() => {}, RTU)
    await run({ tryOtherSpeeds: true, trialTime: 600000 })
    const all = speeds(opened)
    assert.deepEqual([all.length, new Set(all).size], [24, 24])
    await end()
  })

  it('leaves alone a line that others use, and says so', async () => {
    const { run, pool, base, clock, opened } = deviceAt('9600 8 none', RTU)
    const lease = pool.open({ transport: 'serial', path: base.path }, { id: 'a', name: 'a' })
    const { cause, seen } = await run({ tryOtherSpeeds: true })
    assert.deepEqual([cause.code, speeds(opened)], ['NO_BYTES', ['192008n']])
    assert.match(seen.notTried, /others use the line/)
    await clock.run(lease.release())
  })

  it('stops when somebody opens the line', async () => {
    const { run, pool, base, clock, opened } = bench(() => {}, RTU)
    const leases = []
    const open = () => void leases.push(pool.open({ transport: 'serial', path: base.path }, { id: 'a', name: 'a' }))
    clock.setTimer(open, 3000)
    await run({ tryOtherSpeeds: true })
    const others = speeds(opened).filter(framing => framing !== '192008n').length
    assert.ok(others > 0 && others < 6, others)
    await clock.run(leases[0].release())
  })

  it('of a serial server it cannot set the speed, and says so', async () => {
    const { run, opened, end } = bench(() => {}, { ...RTU, host: 'box', port: 4001 })
    const { seen } = await run({ tryOtherSpeeds: true })
    assert.equal(opened.length, 1)
    assert.match(seen.notTried, /serial server/)
    await end()
  })

  it('a station that has spoken is not asked at other speeds', async () => {
    const { run, opened, end } = bench((_bytes, { reply }) => reply(rtu(0x11, 0x83, 4)), RTU)
    const { cause } = await run({ tryOtherSpeeds: true, tryOtherModes: true })
    assert.deepEqual([cause.code, opened.length], ['MODBUS_DEVICE_FAILURE', 1])
    await end()
  })
})

describe('diagnose: other modes, on request', () => {
  const isAscii = bytes => bytes[0] === 0x3a

  it('RTU is configured, ASCII answers; the line is not opened again', async () => {
    const { run, opened, end } = bench((bytes, { reply }) => isAscii(bytes) && reply(VALUE_ASCII), RTU)
    const { cause, rows, row, seen } = await run({ tryOtherModes: true })
    assert.equal(cause.code, 'OTHER_MODE')
    assert.match(cause.remedy, /^Set the protocol to ASCII/)
    assert.equal(seen.sent, rtu(0x11, 3, 0, 0, 0, 1).toString('hex'))
    assert.deepEqual([opened.length, wrong(rows), row('speed').result], [1, ['protocol'], 'ok'])
    await end()
  })

  it('ASCII is configured, RTU answers', async () => {
    const answer = (bytes, { reply }) => !isAscii(bytes) && reply(VALUE_RTU)
    const { run, end } = bench(answer, { protocol: 'ascii', station: 17 })
    assert.match((await run({ tryOtherModes: true })).cause.remedy, /^Set the protocol to RTU/)
    await end()
  })

  it('with 7 data bits RTU is not asked', async () => {
    const { run, wire, end } = bench(() => {}, { protocol: 'ascii', station: 17, dataBits: 7 })
    const { cause } = await run({ tryOtherModes: true })
    assert.deepEqual([cause.code, wire.sent.length], ['NO_BYTES', 1])
    await end()
  })

  it('NX: a PLC that is silent to 2-step queries, and answers 4-step ones', async () => {
    const answer = (bytes, { reply }) => {
      if (bytes[2] === 0x03) reply(nx(bytes[1], 1, 0x80, 0))
      if (bytes[2] === 0x00) reply(nx(bytes[1], 1, 0x83, 5, 0))
    }
    const { run, end } = bench(answer, { protocol: 'nx', station: 1 })
    const { cause } = await run({ tryOtherModes: true })
    assert.deepEqual([cause.code, /to 4\./.test(cause.remedy)], ['WRONG_STEPS', true])
    await end()
  })

  it('NX: 4-step is configured, and the PLC answers 2-step queries', async () => {
    const answer = (bytes, { reply }) => bytes[2] === 0x23 && reply(nx(bytes[1], 1, 0xa3, 5, 0))
    const { run, end } = bench(answer, { protocol: 'nx', station: 1, steps: 4 })
    const { cause } = await run({ tryOtherModes: true })
    assert.deepEqual([cause.code, /to 2\./.test(cause.remedy)], ['WRONG_STEPS', true])
    await end()
  })

  it('NX: a PLC that is silent to both', async () => {
    const { run, wire, end } = bench(() => {}, { protocol: 'nx', station: 1 })
    const { cause, seen } = await run({ tryOtherModes: true })
    assert.equal(cause.code, 'NO_BYTES')
    assert.ok(seen.tried.some(({ what }) => what === '4-step method') && wire.sent.length > 2)
    await end()
    const over = bench(() => {}, { protocol: 'nx', station: 1 })
    const short = await over.run({ tryOtherModes: true, trialTime: 1 })
    assert.ok(short.seen.tried.length < seen.tried.length, 'no longer than it may')
    await over.end()
  })

  it('NX: a lost answer is no fixed master ID', async () => {
    const { run, end } = bench((bytes, { reply }, n) => n > 1 && reply(nx(bytes[1], 1, 0xa3, 5, 0)), {
      protocol: 'nx',
      station: 1
    })
    const { ok, cause, rows } = await run()
    assert.deepEqual([ok, cause.code, wrong(rows)], [false, 'UNSTEADY', ['cable']])
    await end()
  })

  it('on a line that others use, too', async () => {
    const { run, pool, base, clock } = bench((bytes, { reply }) => isAscii(bytes) && reply(VALUE_ASCII), RTU)
    const lease = pool.open({ transport: 'serial', path: base.path }, { id: 'a', name: 'a' })
    assert.equal((await run({ tryOtherModes: true })).cause.code, 'OTHER_MODE')
    await clock.run(lease.release())
  })

  it('before other speeds, and both end in time', async () => {
    const { run, wire, opened, end } = bench(() => {}, RTU)
    const { seen, ms } = await run({ tryOtherModes: true, tryOtherSpeeds: true, trialTime: 3000 })
    assert.equal(seen.tried[0].what, 'MODBUS ASCII')
    assert.ok(isAscii(wire.sent[1].bytes) && opened.length > 2)
    assert.ok(ms < 1000 + 1200 + 3000 + 1500, ms)
    await end()
  })
})
