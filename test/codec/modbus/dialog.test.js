'use strict'
const assert = require('node:assert/strict')
const { readDialog, writeDialog } = require('../../../lib/codec/modbus/dialog')
const { PlcError } = require('../../../lib/error')
const { closed, hex, show } = require('../support/oracle')
const { play } = require('../support/receiver')
const { WIRES, framed } = require('./support')
const { STATION } = require('../../vectors/modbus')

const WORDS = { fn: 3, base: 107, count: 3 }
const R = framed('rtu', '11 03 06 02 2B 00 00 00 64')
const WRITE = { fn: 16, base: 1, values: [0x000a, 0x0102] }
const ACK = framed('rtu', '11 10 00 01 00 02')
const LOST = ['TIMEOUT', { sent: true }]
const CUT = ['INCOMPLETE', { got: 7, expected: 11, sent: true }]
const DAMAGED = Buffer.from(R)
DAMAGED[5] ^= 1

const rtu = body => framed('rtu', body)
const exception = (number, fn = 3) => closed([STATION, fn + 128, number])
const read = (script, options, query = WORDS) => play(readDialog(query, { station: STATION, ...options }), script)
const write = (script, options, frames = [WRITE]) =>
  play(writeDialog({ frames }, { station: STATION, ...options }), script)
const setBits = (script, options, bits, single) =>
  play(writeDialog({ bits, ...(single === undefined ? {} : { single }) }, { station: STATION, ...options }), script)
const sent = ({ steps }) => steps.map(step => show(step.send))
const refused = (run, code) => assert.throws(run, error => error.code === code)

/** Plays the line for a broadcast, which awaits nothing. */
function send(dialog) {
  const steps = []
  let turn = dialog.next()
  while (!turn.done) {
    steps.push(turn.value)
    turn = dialog.next(Buffer.alloc(0))
  }
  return { steps, result: turn.value }
}

describe('MODBUS conversation: as the manual draws it', () => {
  for (const { name, protocol, query, values, q, r } of WIRES) {
    it(name, () => {
      const options = { station: STATION, protocol }
      const dialog = query.fn < 5 ? readDialog(query, options) : writeDialog({ frames: [query] }, options)
      const { steps, result } = play(dialog, [r])
      assert.deepEqual(sent({ steps }), [show(q)])
      assert.deepEqual(result, { values, attempts: 1 })
    })
  }

  it('tells how long an answer without a fault is', () => {
    const usual = protocol => readDialog(WORDS, { station: STATION, protocol }).next().value.usual
    assert.deepEqual([usual('rtu'), usual('ascii')], [R.length, framed('ascii', R.subarray(0, -2)).length])
  })

  it('waits 1 s; timeout and gap are settable', () => {
    const times = options => read([R], options).steps.map(step => [step.gap, step.timeout])
    assert.deepEqual(times(), [[0, 1000]])
    assert.deepEqual(times({ gap: 20, timeout: 300 }), [[20, 300]])
  })
})

describe('MODBUS conversation: reads are repeated', () => {
  it('a missing, cut or damaged answer, busy and acknowledge: the same bytes again', () => {
    for (const failure of [LOST, CUT, DAMAGED, exception(6), exception(5)]) {
      const got = read([failure, R])
      assert.deepEqual(sent(got), ['11 03 00 6B 00 03 76 87', '11 03 00 6B 00 03 76 87'])
      assert.deepEqual(got.result, { values: [0x22b, 0, 0x64], attempts: 2 })
    }
  })

  it('three tries in all, then the last failure; settable', () => {
    assert.deepEqual(
      [read([LOST, CUT, LOST]).error.code, read([LOST, LOST, CUT]).error.code],
      ['TIMEOUT', 'INCOMPLETE']
    )
    assert.equal(read([LOST], { attempts: 1 }).error.code, 'TIMEOUT')
    assert.equal(read([LOST, LOST, LOST, LOST, R], { attempts: 5 }).result.attempts, 5)
    assert.equal(read([exception(6), exception(6), exception(6)]).error.code, 'MODBUS_BUSY')
  })

  it('every other exception ends it at once, with number, function and address', () => {
    for (const number of [1, 2, 3, 4, 7, 8, 9, 10, 11, 12, 255]) {
      const { error, steps } = read([exception(number)])
      assert.deepEqual([steps.length, error.details.station, error.details.function], [1, STATION, '03'])
      assert.match(error.code, /^MODBUS_/)
      assert.equal(error.details.exception, number.toString(16).toUpperCase().padStart(2, '0'))
      assert.match(error.details.address, /wire addresses 107–109/)
    }
    assert.equal(read([exception(2)], { names: () => '400108' }).error.details.address, '400108')
  })

  it('a failure of the line ends it', () => {
    for (const code of ['LINE_CLOSED', 'LINE_DOWN', 'PORT_GONE', 'LINE_JAMMED']) {
      assert.equal(read([[code, { sent: false }]]).error.code, code)
    }
  })

  it('a stranger between request and answer is stepped over', () => {
    const late = rtu('11 03 04 00 01 00 02')
    assert.equal(read([Buffer.concat([late, rtu('12 03 06 00 01 00 02 00 03'), R])]).result.attempts, 1)
  })

  it('keeps the facts, also when it fails', () => {
    const facts = { attempts: 99, exact: true }
    read([LOST, LOST, LOST], { facts })
    assert.deepEqual(facts, { attempts: 3, writes: 0, exact: false })
  })
})

describe('MODBUS conversation: the bytes may be made by another', () => {
  const made = (bytes, answer) => (query, station) => ({
    send: bytes ?? rtu('11 03 00 6B 00 03'),
    read: () => answer(query, station)
  })

  it('it makes the request and reads the answer', () => {
    const seen = []
    const exchange = (query, station) => {
      seen.push([query, station])
      return { send: hex('11 03 00 6B 00 03 76 87'), read: frame => [...frame.subarray(3, 6)] }
    }
    assert.deepEqual(read([R], { exchange }).result.values, [2, 43, 0])
    assert.deepEqual(seen, [[WORDS, STATION]])
    const ascii = read([framed('ascii', '11 03 06 02 2B 00 00 00 64')], { exchange, protocol: 'ascii' })
    assert.deepEqual(ascii.result.values, [2, 43, 0])
    assert.equal(ascii.steps[0].send.toString('latin1'), ':1103006B00037E\r\n')
  })

  it('what it cannot read is no value', () => {
    const odd = [
      () => undefined,
      () => [1, 2],
      () => 'abc',
      () => {
        throw new Error('Unexpected data')
      }
    ]
    for (const answer of odd) {
      const { error } = read([R], { attempts: 1, exchange: made(null, answer) })
      assert.deepEqual([error.code, error.details.station], ['BAD_ANSWER', STATION])
    }
    const { error } = read([R], { attempts: 1, exchange: made(null, odd[1]) })
    assert.equal(error.details.reason, 'it has other values than were asked for')
    assert.equal(read([R, R], { exchange: made(null, odd[0]), attempts: 2 }).steps.length, 2)
  })

  it('its own refusal stays, and whatever else it throws has a text', () => {
    const throws = thrown => () => {
      throw thrown
    }
    const refusal = new PlcError('BAD_VALUE', { item: 'x', value: 1, reason: 'y' })
    assert.equal(read([R], { exchange: made(null, throws(refusal)) }).error, refusal)
    for (const thrown of ['Unexpected data', new Error('Unexpected data')]) {
      const { error } = read([R], { attempts: 1, exchange: made(null, throws(thrown)) })
      assert.deepEqual([error.details.reason, error.cause], ['Unexpected data', thrown])
    }
    assert.equal(read([R], { attempts: 1, exchange: made(null, throws(null)) }).error.details.reason, 'null')
  })

  it('an exception never reaches it', () => {
    const exchange = made(null, () => assert.fail('it was asked'))
    assert.equal(read([exception(2)], { exchange }).error.code, 'MODBUS_ILLEGAL_ADDRESS')
  })
})

describe('MODBUS conversation: the read bit unit', () => {
  const coils = (base, count) => ({ fn: 1, base, count })
  const asked = ({ steps }) => steps.map(({ send: q }) => [q.readUInt16BE(2), q.readUInt16BE(4)])
  const answer = count => rtu([STATION, 1, Math.ceil(count / 8), ...new Array(Math.ceil(count / 8)).fill(0x55)])
  const unit = (query, options, count) => read([answer(count)], options, query)

  it('the count grows to a whole multiple, the start stays, and what was not asked for is left out', () => {
    const got = unit(coils(19, 5), { unit: 16 }, 16)
    assert.deepEqual(asked(got), [[19, 16]])
    assert.deepEqual(got.result.values, [true, false, true, false, true])
    assert.deepEqual(asked(unit(coils(19, 16), { unit: 16 }, 16)), [[19, 16]])
    assert.deepEqual(asked(unit(coils(19, 17), { unit: 16 }, 32)), [[19, 32]])
    assert.deepEqual(asked(unit(coils(19, 5), {}, 5)), [[19, 5]])
  })

  it('never past the last number, the limit of the function or that of the device', () => {
    assert.deepEqual(asked(unit(coils(65530, 5), { unit: 16 }, 5)), [[65530, 5]])
    assert.deepEqual(asked(unit(coils(65520, 5), { unit: 16 }, 16)), [[65520, 16]])
    assert.deepEqual(asked(unit(coils(0, 1999), { unit: 48 }, 1999)), [[0, 1999]])
    assert.deepEqual(asked(unit(coils(0, 1990), { unit: 16 }, 2000)), [[0, 2000]])
    assert.deepEqual(asked(unit(coils(0, 30), { unit: 16, most: 31 }, 30)), [[0, 30]])
    assert.deepEqual(asked(unit(coils(0, 30), { unit: 16, most: 32 }, 32)), [[0, 32]])
  })

  it('of registers there is none', () => {
    assert.deepEqual(asked(read([R], { unit: 16 })), [[107, 3]])
  })

  it('after exception 02 the exact range at once, and says so', () => {
    const facts = {}
    const got = read([exception(2, 1), answer(5)], { unit: 16, facts, attempts: 1 }, coils(19, 5))
    assert.deepEqual(asked(got), [
      [19, 16],
      [19, 5]
    ])
    assert.deepEqual([got.result.values.length, got.result.attempts], [5, 2])
    assert.equal(facts.exact, true)
    assert.equal(
      read([exception(2, 1), exception(2, 1)], { unit: 16 }, coils(19, 5)).error.code,
      'MODBUS_ILLEGAL_ADDRESS'
    )
    assert.equal(read([exception(2, 1)], { unit: 16 }, coils(16, 16)).steps.length, 1, 'it was exact already')
    assert.equal(read([exception(3, 1)], { unit: 16 }, coils(19, 5)).steps.length, 1)
  })

  it('the exact range has its own tries', () => {
    const got = read([LOST, exception(2, 1), LOST, answer(5)], { unit: 16, attempts: 2 }, coils(19, 5))
    assert.equal(got.result.attempts, 4)
  })
})

describe('MODBUS conversation: writes are never repeated', () => {
  const unknown = (got, cause, steps = 1) => {
    assert.deepEqual([got.error.code, got.error.cause.code, got.steps.length], ['WRITE_UNKNOWN', cause, steps])
  }

  it('no, a cut, a damaged or a wrong answer: outcome unknown', () => {
    unknown(write([LOST], { attempts: 3 }), 'TIMEOUT')
    unknown(write([CUT]), 'INCOMPLETE')
    unknown(write([rtu('11 10 00 01 00 02').fill(0x55, 7)]), 'CRC_ERROR')
    unknown(write([rtu('11 10 00 01 00 03')]), 'TIMEOUT')
    unknown(write([rtu('11 10 00 02 00 02')]), 'TIMEOUT')
    unknown(write([['PORT_GONE']]), 'PORT_GONE')
    const wrong = write([rtu('11 06 00 01 00 04')], {}, [{ fn: 6, base: 1, value: 3 }])
    unknown(wrong, 'TIMEOUT')
    assert.match(wrong.error.message, /holding register, wire address 1 \(0001h\): TIMEOUT/)
    assert.match(write([LOST], { item: '400002' }).error.message, /400002/)
  })

  it('never went out: the failure itself', () => {
    for (const code of ['LINE_JAMMED', 'DEADLINE', 'LINE_DOWN']) {
      assert.equal(write([[code, { sent: false }]]).error.code, code)
    }
  })

  it('exceptions are a refusal, but for 04, 05, 0B and those without a name', () => {
    const refusals = [1, 2, 3, 6, 7, 8, 10]
    for (const number of refusals) {
      const { error, steps } = write([exception(number, 16)])
      assert.match(error.code, /^MODBUS_/)
      assert.equal(steps.length, 1)
    }
    unknown(write([exception(4, 16)]), 'MODBUS_DEVICE_FAILURE')
    unknown(write([exception(5, 16)]), 'MODBUS_ACKNOWLEDGE')
    unknown(write([exception(11, 16)]), 'MODBUS_GATEWAY_TARGET')
    for (const number of [9, 77, 255]) unknown(write([exception(number, 16)]), 'MODBUS_EXCEPTION')
  })

  it('is not confirmed by what its own echo holds', () => {
    const ack = rtu('11 10 00 01 00 04')
    const query = { fn: 16, base: 1, values: [0, 2, 4, 6].map(i => ack.readUInt16BE(i)) }
    unknown(write([rtu([...hex('11 10 00 01 00 04 08'), ...ack])], {}, [query]), 'TIMEOUT')
  })
})

describe('MODBUS conversation: several frames', () => {
  const one = { fn: 6, base: 1, value: 3 }
  const two = { fn: 6, base: 2, value: 4 }
  const A = rtu('11 06 00 01 00 03')
  const B = rtu('11 06 00 02 00 04')

  it('one after the other, in order', () => {
    const got = write([A, B], {}, [one, two])
    assert.deepEqual(sent(got), [show(A), show(B)])
    assert.deepEqual(got.result, { values: true, attempts: 2 })
  })

  it('the first one refused: refused, and the others are not sent', () => {
    assert.equal(write([exception(2, 6)], {}, [one, two]).error.code, 'MODBUS_ILLEGAL_ADDRESS')
    const { error } = write([LOST], {}, [one, two])
    assert.deepEqual([error.code, error.details.done, error.details.frames], ['WRITE_UNKNOWN', 0, 2])
  })

  it('a later one not confirmed, refused or never sent: unknown, and it says how far it came', () => {
    for (const failure of [LOST, exception(2, 6), exception(4, 6), ['LINE_DOWN', { sent: false }]]) {
      const { error } = write([A, failure], {}, [one, two])
      assert.deepEqual([error.code, error.details.done, error.details.frames], ['WRITE_UNKNOWN', 1, 2])
      assert.match(error.message, /1 of 2 frames was carried out/)
      assert.equal(error.cause instanceof PlcError, true)
    }
    const three = { fn: 6, base: 3, value: 5 }
    assert.match(
      write([A, B, LOST], {}, [one, two, three]).error.message,
      /2 of 3 frames were carried out, then TIMEOUT/
    )
  })

  it('all are looked at before the first goes out', () => {
    for (const bad of [
      { fn: 6, base: 2, value: -1 },
      { fn: 3, base: 2, count: 1 },
      { fn: 8, base: 1, value: 1 }
    ]) {
      const got = write([], {}, [one, bad])
      assert.equal(got.steps.length, 0)
      assert.ok(['BAD_VALUE', 'FUNCTION_REFUSED'].includes(got.error.code))
    }
    assert.equal(write([], {}, []).error.code, 'NOTHING_TO_WRITE')
  })
})

describe('MODBUS conversation: bits of a register', () => {
  const bits = { base: 107, mask: 0x0020, value: 0x0020 }
  const OLD = rtu('11 03 02 12 04')
  const ACKED = rtu('11 10 00 6B 00 01')

  it('read, change, write: the other bits stay', () => {
    const got = setBits([OLD, ACKED], {}, bits)
    assert.deepEqual(sent(got), [show(rtu('11 03 00 6B 00 01')), show(rtu('11 10 00 6B 00 01 02 12 24'))])
    assert.deepEqual(got.result, { values: true, attempts: 2 })
    const off = setBits([OLD, ACKED], {}, { base: 107, mask: 0x1200, value: 0 })
    assert.equal(show(off.steps[1].send), show(rtu('11 10 00 6B 00 01 02 00 04')))
    const all = setBits([OLD, ACKED], {}, { base: 107, mask: 0xffff, value: 0x8001 })
    assert.equal(show(all.steps[1].send), show(rtu('11 10 00 6B 00 01 02 80 01')))
    const outside = setBits([OLD, ACKED], {}, { base: 107, mask: 0x00f0, value: 0xffff })
    assert.equal(show(outside.steps[1].send), show(rtu('11 10 00 6B 00 01 02 12 F4')), 'only those of the mask')
  })

  it('with 06 where the device wants it', () => {
    const got = setBits([OLD, rtu('11 06 00 6B 12 24')], {}, bits, true)
    assert.equal(show(got.steps[1].send), show(rtu('11 06 00 6B 12 24')))
    assert.equal(got.result.values, true)
  })

  it('the read is repeated, the write is not', () => {
    assert.equal(setBits([LOST, OLD, ACKED], {}, bits).result.attempts, 3)
    const { error, steps } = setBits([OLD, LOST], {}, bits)
    assert.deepEqual([error.code, error.cause.code, steps.length], ['WRITE_UNKNOWN', 'TIMEOUT', 2])
  })

  it('a read that fails has written nothing, and says so', () => {
    for (const [script, code] of [
      [[LOST, LOST, LOST], 'TIMEOUT'],
      [[exception(2)], 'MODBUS_ILLEGAL_ADDRESS'],
      [[exception(4)], 'MODBUS_DEVICE_FAILURE']
    ]) {
      const facts = {}
      const { error } = setBits(script, { facts }, bits)
      assert.deepEqual([error.code, error.details.sent, facts.writes], [code, false, 0])
    }
    const facts = {}
    setBits([OLD, LOST], { facts }, bits)
    assert.equal(facts.writes, 1)
  })
})

describe('MODBUS conversation: an adapter that may hear itself', () => {
  const five = { fn: 5, base: 172, value: true }
  const six = { fn: 6, base: 1, value: 3 }
  const coil = rtu('11 01 01 00')
  const register = rtu('11 03 02 00 00')

  it('a write whose answer equals it is preceded by a read of the same address', () => {
    const first = write([coil, rtu('11 05 00 AC FF 00')], { probe: true }, [five])
    assert.deepEqual(sent(first), [show(rtu('11 01 00 AC 00 01')), show(rtu('11 05 00 AC FF 00'))])
    const second = write([register, rtu('11 06 00 01 00 03')], { probe: true }, [six])
    assert.deepEqual(sent(second)[0], show(rtu('11 03 00 01 00 01')))
    assert.equal(
      write([register, rtu('11 06 00 01 00 03'), rtu('11 06 00 01 00 03')], { probe: true }, [six, six]).steps.length,
      3
    )
  })

  it('a bit of a register needs none: its word was read just before', () => {
    const bits = { base: 107, mask: 1, value: 1 }
    const got = setBits([rtu('11 03 02 00 00'), rtu('11 06 00 6B 00 01')], { probe: true }, bits, true)
    assert.equal(got.steps.length, 2)
  })

  it('any answer will do, an exception too', () => {
    assert.equal(write([exception(1, 1), rtu('11 05 00 AC FF 00')], { probe: true }, [five]).result.values, true)
  })

  it('without one nothing is written', () => {
    const { error, steps } = write([LOST, LOST, LOST], { probe: true }, [five])
    assert.deepEqual([error.code, error.details.sent, steps.length], ['TIMEOUT', false, 3])
  })

  it('others need none: their answer is another', () => {
    assert.equal(write([ACK], { probe: true }).steps.length, 1)
    const many = { fn: 15, base: 19, values: new Array(10).fill(true) }
    assert.equal(write([rtu('11 0F 00 13 00 0A')], { probe: true }, [many]).steps.length, 1)
  })

  it('but where the answer equals the beginning of the request by its checksum', () => {
    // searched here: a base whose acknowledgement ends in the byte count 04, and a value that begins with the other half of its CRC
    let found
    for (let base = 0; base < 0x10000 && !found; base++) {
      const ack = closed([STATION, 16, base >> 8, base & 255, 0, 2])
      if (ack[6] === 4) found = { query: { fn: 16, base, values: [ack[7] << 8, 1] }, ack }
    }
    const { query, ack } = found
    const got = write([rtu([STATION, 3, 2, 0, 0]), ack], { probe: true }, [query])
    assert.deepEqual([got.steps.length, got.steps[0].send[1]], [2, 3])
  })
})

describe('MODBUS conversation: broadcast', () => {
  const options = { station: 0, broadcast: { turnaround: 250 } }

  it('nothing is awaited but the turnaround', () => {
    const { steps, result } = send(
      writeDialog({ frames: [WRITE, { fn: 5, base: 1, value: true }] }, { ...options, gap: 7 })
    )
    assert.deepEqual(sent({ steps }), [show(rtu('00 10 00 01 00 02 04 00 0A 01 02')), show(rtu('00 05 00 01 FF 00'))])
    assert.ok(steps.every(step => step.match === null && step.turnaround === 250 && step.gap === 7))
    assert.deepEqual(result, { values: true, attempts: 2 })
  })

  it('100 ms if nothing is said; in ASCII too; a probe makes no sense', () => {
    const frames = [{ fn: 6, base: 1, value: 3 }]
    const { steps } = send(writeDialog({ frames }, { station: 0, broadcast: {}, protocol: 'ascii', probe: true }))
    assert.deepEqual([steps.length, steps[0].turnaround], [1, 100])
    assert.equal(steps[0].send.toString('latin1'), framed('ascii', '00 06 00 01 00 03').toString('latin1'))
  })

  it('reads, bits of registers, and whatever is not allowed: refused before anything is sent', () => {
    refused(() => readDialog(WORDS, { station: 0, broadcast: {} }).next(), 'BROADCAST_REFUSED')
    refused(() => writeDialog({ bits: { base: 1, mask: 1, value: 1 } }, options).next(), 'BROADCAST_REFUSED')
    refused(() => writeDialog({ frames: [WRITE] }, { station: 0 }).next(), 'BROADCAST_REFUSED')
  })

  it('refused also where another makes the bytes, with the reason', () => {
    const exchange = () => assert.fail('it was asked')
    const begin = dialog => () => dialog.next()
    const bits = { base: 1, mask: 1, value: 1 }
    const says = (dialog, what, reason) =>
      assert.throws(begin(dialog), { code: 'BROADCAST_REFUSED', details: { what, reason } })
    says(readDialog(WORDS, { station: 0, broadcast: {}, exchange }), 'a read', 'no station may answer it')
    const why = 'the register would have to be read first'
    says(writeDialog({ bits }, { ...options, exchange }), 'a bit of a register', why)
    says(writeDialog({ frames: [WRITE] }, { station: 0, exchange }), 'a write', 'it is not allowed here')
  })

  it('one that went out cannot be taken back', () => {
    const dialog = writeDialog({ frames: [WRITE, WRITE] }, options)
    dialog.next()
    dialog.next(Buffer.alloc(0))
    assert.throws(
      () => dialog.throw(new PlcError('LINE_DOWN', { sent: false })),
      error => error.code === 'WRITE_UNKNOWN' && /1 of 2 frames went out/.test(error.message)
    )
  })
})

describe('MODBUS conversation: what a line must not do', () => {
  const fault = new TypeError('boom')
  const bits = { bits: { base: 107, mask: 1, value: 1 } }
  const begun = dialog => {
    dialog.next()
    return dialog
  }

  it('bytes that are no ASCII frame are no answer', () => {
    const dialog = begun(readDialog(WORDS, { station: STATION, protocol: 'ascii', attempts: 1 }))
    const details = { station: STATION, reason: 'it is no frame' }
    assert.throws(() => dialog.next(Buffer.from(':1103\r\n')), { code: 'BAD_ANSWER', details })
  })

  it('a fault of the program is passed on; of a write that went out it makes the outcome unknown', () => {
    assert.throws(() => begun(readDialog(WORDS, { station: STATION })).throw(fault), fault)
    const unknown = error => error.code === 'WRITE_UNKNOWN' && error.details.reason === 'boom' && error.cause === fault
    assert.throws(() => begun(writeDialog({ frames: [WRITE] }, { station: STATION })).throw(fault), unknown)
    assert.throws(() => begun(writeDialog(bits, { station: STATION })).throw(fault), fault)
  })
})

describe('MODBUS conversation: refused before anything is sent', () => {
  it('with the reason', () => {
    const says = (dialog, details) => assert.throws(() => dialog.next(), { details })
    const reason = 'it must be 1 to 247, or 0 for a broadcast'
    says(readDialog(WORDS, { station: 248 }), { station: 248, reason })
    says(readDialog(WRITE, { station: 1 }), { function: '16 as a read' })
    says(writeDialog({ frames: [WRITE, WORDS] }, { station: 1 }), { function: '3 as a write' })
    says(writeDialog({ frames: [] }, { station: 1 }), { reason: 'there is no frame' })
  })

  it('stations and functions', () => {
    for (const station of [1, 247]) assert.equal(readDialog(WORDS, { station }).next().value.send[0], station)
    for (const station of [-1, 248, 255, 1.5, '1', undefined]) {
      refused(() => readDialog(WORDS, { station }).next(), 'BAD_STATION')
      refused(() => writeDialog({ frames: [WRITE] }, { station }).next(), 'BAD_STATION')
    }
    refused(() => readDialog(WRITE, { station: 1 }).next(), 'FUNCTION_REFUSED')
    refused(() => writeDialog({ frames: [WORDS] }, { station: 1 }).next(), 'FUNCTION_REFUSED')
    refused(() => readDialog({ fn: 3, base: 65535, count: 2 }, { station: 1 }).next(), 'BAD_ADDRESS')
    refused(() => writeDialog({ bits: { base: 65536, mask: 1, value: 1 } }, { station: 1 }).next(), 'BAD_ADDRESS')
  })
})
