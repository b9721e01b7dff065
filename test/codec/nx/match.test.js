'use strict'
const assert = require('node:assert/strict')
const fc = require('fast-check')
const { answerTo } = require('../../../lib/codec/nx/match')
const { growth } = require('../../support/growth')
const { frame, hex, show } = require('../support/oracle')
const { receive } = require('../support/receiver')
const { EXCHANGES, QA, ERROR_2 } = require('../../vectors/nx')

const EMPTY = Buffer.alloc(0)
const WORDS = { ask: 'readWords', base: 0xc0, count: 2 }
const WRITE = { ask: 'writeWords', base: 0x140, values: [0x1234] }
const R = hex('E2 01 A3 04 34 12 CD AB 8D 13')
const ends = { station: 1, master: 0xe2 }
const match = (query = WORDS, options = {}) => answerTo(query, { ...ends, ...options })
const answered = EXCHANGES.filter(each => each.r).map(({ name, query, steps, r }) => ({
  name,
  bytes: hex(r),
  match: answerTo(query, { ...ends, steps, phase: steps === 4 ? 'request' : 'query' })
}))
const verdictOf = (options, bytes, query = WORDS) => match(query, options)(bytes)
const taken = (options, bytes, query = WORDS) => receive(match(query, options), [bytes]).take !== undefined

describe('NX match: the awaited answer', () => {
  for (const { name, bytes, match: look } of answered) {
    it(`${name}: whole, in two pieces at every place, and byte by byte`, () => {
      assert.deepEqual(look(EMPTY), { need: 7 })
      assert.deepEqual(look(bytes), { take: bytes.length })
      for (let at = 0; at <= bytes.length; at++) {
        const got = receive(look, [bytes.subarray(0, at), bytes.subarray(at)])
        assert.equal(got.take?.length, bytes.length)
      }
      const single = receive(
        look,
        [...bytes].map(byte => Buffer.of(byte))
      )
      assert.deepEqual([single.take, single.skipped], [bytes, 0])
    })

    it(`${name}: cut at each byte it waits for exactly the rest`, () => {
      for (let at = 0; at < bytes.length; at++) {
        const got = look(bytes.subarray(0, at))
        assert.deepEqual(got, at < 4 ? { need: 7 } : { need: bytes.length, ours: true })
      }
    })

    it(`${name}: any one bit turned is refused`, () => {
      for (let bit = 0; bit < bytes.length * 8; bit++) {
        const turned = Buffer.from(bytes)
        turned[bit >> 3] ^= 1 << (bit & 7)
        const got = receive(look, [turned])
        assert.equal(got.take, undefined, `bit ${bit}`)
        // from INFO on the header is whole: known at once as ours and damaged
        if (bit >= 32) assert.equal(got.bad, 'CRC', `bit ${bit}`)
      }
    })
  }

  it('noise before it is skipped, what follows is left', () => {
    const noise = fc.uint8Array({ maxLength: 40 })
    const index = fc.nat(answered.length - 1)
    fc.assert(
      fc.property(noise, index, noise, (before, i, after) => {
        const { bytes, match: look } = answered[i]
        const got = receive(look, [Buffer.from(before), Buffer.concat([bytes, Buffer.from(after)])])
        assert.equal(show(got.take ?? EMPTY), show(bytes))
        assert.equal(got.skipped, before.length)
        assert.deepEqual([...got.left], [...after])
      })
    )
  })

  it('noise made of pieces of the header does not hide it', () => {
    const pieces = ['E2', 'E2 01', 'E2 01 A3', 'E2 E2', '01 E2', 'E2 01 A3 05', 'E2 02 A3 04', 'E2 01 A4 04']
    for (const text of pieces) assert.ok(taken({}, Buffer.concat([hex(text), R])), text)
  })

  it('is found behind a false header whose CRC does not fit', () => {
    const got = receive(match(), [hex('E2 01 A3 04'), R])
    assert.deepEqual([got.take, got.skipped], [R, 4])
    const single = receive(
      match(),
      [...Buffer.concat([hex('E2 01 A3 04'), R])].map(byte => Buffer.of(byte))
    )
    assert.deepEqual([single.take, single.skipped], [R, 4])
    const late = receive(match(), [Buffer.concat([hex('E2 01 A3 04 34 12 CD AB 8D 12'), R])])
    assert.deepEqual([late.take, late.skipped], [R, 10])
  })

  it('two merged answers: the first is taken, exactly', () => {
    const got = receive(match(), [Buffer.concat([R, R])])
    assert.deepEqual([got.take, got.left], [R, R])
  })

  it('a damaged one ends at once, even if its last byte could begin another', () => {
    const damaged = frame([0xe2, 1, 0xa3], [0x34, 0x12, 0xcd, 0xab])
    damaged[9] = 0xe2
    assert.deepEqual(match()(damaged), { bad: 'CRC', length: 10 })
  })
})

describe('NX match: never a frame out of the middle of another', () => {
  const inner = hex('E2 01 A3 01 02 AD 99')
  const six = { ask: 'readWords', base: 0xc0, count: 6 }
  const outer = frame([0xe2, 1, 0xa3], [...inner, 0, 0, 0, 0, 0])

  it('an error frame inside the data waits for the whole answer, which wins', () => {
    for (let at = 4; at < outer.length; at++) {
      assert.deepEqual(verdictOf({}, outer.subarray(0, at), six), { need: 18, ours: true })
    }
    assert.deepEqual(receive(match(six), [outer]).take, outer)
  })

  it('nor is it taken out of a damaged answer', () => {
    const damaged = Buffer.from(outer)
    damaged[16] ^= 1
    assert.deepEqual(verdictOf({}, damaged, six), { bad: 'CRC', length: 18 })
  })

  it('nor out of a late answer to an older ID', () => {
    const late = frame([0xe3, 1, 0xa3], [...R, 0, 0])
    const got = receive(match(WORDS, { late: [0xe3] }), [late.subarray(0, 15), Buffer.concat([late.subarray(15), R])])
    assert.deepEqual([got.take, got.skipped], [R, late.length])
    assert.ok(taken({ late: [0xe3] }, Buffer.concat([hex('E3'), R])), 'one byte alone is no frame')
    assert.ok(taken({ late: [0xe3] }, Buffer.concat([hex('E3 01'), R])))
  })

  it('nor out of the echo of our own write, whole or damaged', () => {
    const ack = frame([0xe2, 1, 0xa4], [0])
    const query = { ask: 'writeWords', base: 0x140, values: [0x01e2, 0x01a4, ack.readUInt16LE(4), ack[6]] }
    const echo = frame([1, 0xe2, 0x24], [0x40, 0x01, ...ack, 0])
    assert.ok(taken({}, echo, query), 'without knowing what was sent it would be')
    assert.equal(taken({ sent: echo }, echo, query), false)
    const damaged = Buffer.from(echo)
    damaged[5] ^= 0x10
    assert.equal(taken({ sent: echo }, damaged, query), false)
    assert.ok(taken({ sent: echo }, Buffer.concat([damaged, ack]), query))
  })
})

describe('NX match: what is not ours is skipped', () => {
  const skips = (name, bytes, options, query) =>
    it(name, () => {
      assert.deepEqual(verdictOf(options, bytes, query), { skip: bytes.length })
      const own = query ? frame([0xe2, 1, 0xa4], [0]) : R
      assert.deepEqual(receive(match(query, options), [bytes, own]).take, own, 'the right one afterwards')
    })
  const data = [0x34, 0x12, 0xcd, 0xab]
  skips('an answer to an older master ID', frame([0xe3, 1, 0xa3], data))
  skips('another station', frame([0xe2, 2, 0xa3], data))
  skips('the global station for a station of its own', frame([0xe2, 255, 0xa3], data))
  skips('another function', frame([0xe2, 1, 0xa5], data))
  skips('the 4-step code', frame([0xe2, 1, 0x83], data))
  skips('another length', frame([0xe2, 1, 0xa3], [1, 2]))
  skips('LEN 0 = 256 for LEN 4', frame([0xe2, 1, 0xa3], new Array(256).fill(7)))
  skips('a QA in 2-step', hex(QA))
  skips('our own query', hex('01 E2 23 03 C0 00 02 58 3C'))
  skips('error number 0', frame([0xe2, 1, 0x83], [0]))
  skips('error number 6', frame([0xe2, 1, 0xa3], [6]))
  skips('an error of another function', frame([0xe2, 1, 0x84], [2]))
  skips('an error of another length', frame([0xe2, 1, 0x83], [2, 0]))
  skips('no service with another content', frame([0xe2, 1, 0x00], [9]))
  skips('$A2 for a word write, unless allowed', frame([0xe2, 1, 0xa2], [0]), {}, WRITE)
  skips(
    '$82 for a 2-step word write, even if $A2 is allowed',
    frame([0xe2, 1, 0x82], [0]),
    { nonStandardAck: true },
    WRITE
  )
  skips('error 2 of $A2 for a word write', frame([0xe2, 1, 0xa2], [2]), { nonStandardAck: true }, WRITE)
  skips('noise', hex('00 11 22 33 44 55 66 77 88 99'))

  it('a second QA after the RR', () => {
    assert.deepEqual(verdictOf({ steps: 4, phase: 'request' }, hex(QA)), { skip: 7 })
  })
  it('an R where the QA is due', () => {
    const bytes = frame([0xe2, 1, 0x83], data)
    assert.deepEqual(verdictOf({ steps: 4, phase: 'query' }, bytes), { skip: bytes.length })
  })
})

describe('NX match: what is taken besides', () => {
  it('error 1 to 5, as $8X and $AX, with the low nibble of the query or 0', () => {
    for (const steps of [2, 4]) {
      for (const fn of [0x83, 0xa3, 0x80, 0xa0]) {
        for (const error of [1, 2, 3, 4, 5]) {
          const bytes = frame([0xe2, 1, fn], [error])
          for (const phase of ['query', 'request'])
            assert.ok(taken({ steps, phase }, bytes), `${fn} ${error} ${steps} ${phase}`)
        }
      }
    }
    for (const text of ERROR_2) assert.ok(taken({}, hex(text)))
  })
  it('QA in 4-step, no service', () => {
    assert.ok(taken({ steps: 4 }, hex(QA)))
    for (const info of [0, 1, 5]) assert.ok(taken({}, frame([0xe2, 1, 0x00], [info])), `${info}`)
    assert.equal(taken({}, frame([0xe2, 1, 0x00], [6])), false)
  })
  it('$A2 ($82) for word and mixed writes, where allowed', () => {
    const mixed = { ask: 'writeMixed', writes: [{ kind: 'bit', address: 1, value: true }] }
    for (const query of [WRITE, mixed]) {
      assert.ok(taken({ nonStandardAck: true }, frame([0xe2, 1, 0xa2], [0]), query))
      assert.ok(taken({ nonStandardAck: true, steps: 4, phase: 'request' }, frame([0xe2, 1, 0x82], [0]), query))
    }
    assert.equal(taken({ nonStandardAck: true }, frame([0xe2, 1, 0xa2], [0])), false, 'not for a read')
  })
  it('for station 255 an answer from 255 or from the own number of the PLC', () => {
    const from = (id, options) => taken({ station: 255, ...options }, frame([0xe2, id, 0xa3], [1, 2, 3, 4]))
    for (const id of [0, 1, 7, 191, 255]) assert.ok(from(id), String(id))
    for (const id of [192, 226, 254]) assert.equal(from(id), false, String(id))
    assert.ok(from(7, { seenStation: 7 }))
    assert.equal(from(8, { seenStation: 7 }), false)
  })
})

describe('NX match: pieces of what is stepped over', () => {
  it('our own echo and a late answer are waited for until their header is there', () => {
    const sent = hex('01 E2 23 03 C0 00 02 58 3C')
    for (const at of [1, 2, 3]) assert.deepEqual(match(WORDS, { sent })(sent.subarray(0, at)), { need: 7 }, `${at}`)
    assert.deepEqual(match(WORDS, { sent })(sent.subarray(0, 4)), { need: 9, ours: false })
    const late = frame([0xe3, 1, 0xa3], [1, 2])
    for (const at of [1, 2, 3])
      assert.deepEqual(match(WORDS, { late: [0xe3] })(late.subarray(0, at)), { need: 7 }, `${at}`)
    assert.deepEqual(match(WORDS, { late: [0xe3] })(late.subarray(0, 4)), { need: 8, ours: false })
    assert.deepEqual(match(WORDS, { late: [0xe3] })(hex('E3 02')), { skip: 2 })
    assert.deepEqual(match(WORDS, { late: [0xe3] })(hex('E3 01 A4')), { skip: 3 })
    assert.deepEqual(match(WORDS, { late: [0xe3] })(hex('00 E3')), { skip: 1 }, 'it may begin with the last byte')
  })

  it('a header that is none is given up with its third byte', () => {
    assert.deepEqual(match()(hex('E2 01')), { need: 7 })
    assert.deepEqual(match()(hex('E2 01 A4')), { skip: 3 })
    assert.deepEqual(match()(hex('E2 02')), { skip: 2 })
  })

  it('our echo is known by its header, wherever it begins, and whatever its data are', () => {
    const ack = frame([0xe2, 1, 0xa4], [0])
    const query = { ask: 'writeWords', base: 0x140, values: [0x01e2, 0x01a4, ack.readUInt16LE(4), ack[6]] }
    const sent = frame([1, 0xe2, 0x24], [0x40, 0x01, ...ack, 0])
    const look = match(query, { sent })
    assert.deepEqual(look(sent), { skip: sent.length })
    assert.deepEqual(look(Buffer.concat([hex('00'), sent])), { skip: 1 })
    for (let at = 4; at < sent.length; at++) {
      const damaged = Buffer.from(sent)
      damaged[at] ^= 0xff
      assert.deepEqual(look(damaged), { skip: sent.length }, `byte ${at}`)
    }
  })

  it('what begins behind a damaged answer is waited for, as ours', () => {
    const damaged = hex('E2 01 A3 04 34 12 CD AB 8D 12')
    assert.deepEqual(match()(Buffer.concat([damaged, R.subarray(0, 4)])), { need: 20, ours: true })
    // its last seven bytes are an error frame, CRC and all
    const inner = frame([0xe2, 1, 0xa3], [2])
    const end = Buffer.concat([hex('E2 01 A3 08 00 00 00'), inner])
    assert.deepEqual(verdictOf({}, end, { ask: 'readWords', base: 0, count: 4 }), { bad: 'CRC', length: 14 })
  })
})

describe('NX match: bounded', () => {
  it('asks again only when it pays, and works through a flood', () => {
    const got = receive(
      answered[0].match,
      [...answered[0].bytes].map(byte => Buffer.of(byte))
    )
    assert.ok(got.calls <= 4, `${got.calls} calls for 262 bytes`)
    const floods = [
      size => Buffer.concat(new Array(size / 4).fill(hex('E2 01 A3 04'))),
      size => Buffer.alloc(size, 0xe2)
    ]
    for (const flood of floods) {
      const ratio = growth(size => receive(match(), [flood(size)]), 2048)
      assert.ok(ratio < 10, `four times the bytes take ${ratio.toFixed(1)} times as long`)
    }
  })

  it('takes nothing out of random bytes and always gives a usable verdict', () => {
    const near = fc.oneof(fc.constantFrom(0xe2, 1, 0xa3, 4, 0x83, 0x80), fc.nat(255))
    fc.assert(
      fc.property(fc.array(fc.array(near, { maxLength: 40 }), { maxLength: 6 }), chunks => {
        const got = receive(
          match(),
          chunks.map(chunk => Buffer.from(chunk))
        )
        if (got.take)
          assert.equal(show(got.take), show(frame([...got.take.subarray(0, 3)], [...got.take.subarray(4, -2)])))
      }),
      { numRuns: 300 }
    )
  })
})
