'use strict'
const assert = require('node:assert/strict')
const fc = require('fast-check')
const { answerTo } = require('../../../lib/codec/modbus/match')
const { growth } = require('../../support/growth')
const { hex, show } = require('../support/oracle')
const { receive } = require('../support/receiver')
const { WIRES, framed } = require('./support')
const { STATION } = require('../../vectors/modbus')

const EMPTY = Buffer.alloc(0)
const PROTOCOLS = /** @type {const} */ (['rtu', 'ascii'])
const WORDS = { fn: 3, base: 107, count: 3 }
const WRITE = { fn: 16, base: 1, values: [0x000a, 0x0102] }
const BODY = '11 03 06 02 2B 00 00 00 64'
const R = framed('rtu', BODY)
const SHORTEST = { rtu: 5, ascii: 11 }
/** Bytes from which on it is known as ours. */
const HEADER = { rtu: { bits: 3, echo: 6 }, ascii: { bits: 7, echo: 13 } }

const match = (query = WORDS, options = {}) => answerTo(query, { station: STATION, ...options })
const wires = WIRES.map(each => ({ ...each, match: match(each.query, { protocol: each.protocol }) }))
const bytesOf = buffer => [...buffer].map(byte => Buffer.of(byte))
const taken = (bytes, query, options) => receive(match(query, options), [bytes]).take

describe('MODBUS match: the awaited answer', () => {
  for (const { name, protocol, query, r, match: look } of wires) {
    it(`${name}: whole, in two pieces at every place, and byte by byte`, () => {
      assert.deepEqual(look(EMPTY), { need: SHORTEST[protocol] })
      assert.deepEqual(look(r), { take: r.length })
      for (let at = 0; at <= r.length; at++) {
        const got = receive(look, [r.subarray(0, at), r.subarray(at)])
        assert.deepEqual([got.take, got.skipped], [r, 0])
      }
      const single = receive(look, bytesOf(r))
      assert.deepEqual([single.take, single.skipped], [r, 0])
    })

    it(`${name}: cut at each byte it waits for exactly the rest, and says when it is ours`, () => {
      const header = HEADER[protocol][query.fn < 5 ? 'bits' : 'echo']
      for (let at = 0; at < r.length; at++) {
        const got = look(r.subarray(0, at))
        if (at < header) assert.deepEqual(got, { need: Math.max(SHORTEST[protocol], at + 1) }, String(at))
        else assert.deepEqual(got, { need: r.length, ours: true }, String(at))
      }
    })

    it(`${name}: any one bit turned is refused`, () => {
      const header = HEADER[protocol][query.fn < 5 ? 'bits' : 'echo']
      for (let bit = 0; bit < r.length * 8; bit++) {
        const turned = Buffer.from(r)
        turned[bit >> 3] ^= 1 << (bit & 7)
        const got = receive(look, [turned])
        assert.equal(got.take, undefined, `bit ${bit}`)
        // with the header whole it is known at once as ours and damaged, unless it turned into the beginning of a frame
        if (bit >= header * 8 && !turned.subarray(header).includes(0x3a)) assert.ok(got.bad, `bit ${bit}`)
      }
    })

    it(`${name}: cut short, and the next one behind it: never taken together`, () => {
      for (let at = 1; at < r.length; at++) {
        const got = receive(look, [Buffer.concat([r.subarray(0, at), r])])
        if (got.take) assert.deepEqual(got.take, r, String(at))
      }
    })

    it(`${name}: two merged answers: the first is taken, exactly`, () => {
      const got = receive(look, [Buffer.concat([r, r])])
      assert.deepEqual([got.take, got.left], [r, r])
    })
  }

  it('exceptions of all numbers, in both protocols, to every function', () => {
    for (const protocol of PROTOCOLS) {
      for (const { query } of wires) {
        for (let number = 0; number < 256; number++) {
          const bytes = framed(protocol, [STATION, query.fn + 128, number])
          const look = match(query, { protocol })
          assert.deepEqual(look(bytes), { take: bytes.length })
          for (let at = 0; number === 2 && at <= bytes.length; at++) {
            assert.deepEqual(receive(look, [bytes.subarray(0, at), bytes.subarray(at)]).take, bytes)
          }
        }
      }
    }
  })

  it('any one bit of an exception turned is refused', () => {
    for (const protocol of PROTOCOLS) {
      const bytes = framed(protocol, [STATION, 0x83, 2])
      for (let bit = 0; bit < bytes.length * 8; bit++) {
        const turned = Buffer.from(bytes)
        turned[bit >> 3] ^= 1 << (bit & 7)
        assert.equal(taken(turned, WORDS, { protocol }), undefined, `${protocol} ${bit}`)
      }
    }
  })
})

describe('MODBUS match: noise', () => {
  const index = fc.nat(wires.length - 1)
  const behind = fc.uint8Array({ maxLength: 20 })

  it('before it is skipped, what follows is left', () => {
    const noise = fc.uint8Array({ maxLength: 40 })
    fc.assert(
      fc.property(noise, index, behind, (before, i, after) => {
        const { r, match: look } = wires[i]
        // what looks like a frame of the station itself is another test
        const clean = Buffer.from(before).map(byte => (byte === STATION ? 0x99 : byte))
        const got = receive(look, [clean, Buffer.concat([r, Buffer.from(after)])])
        assert.equal(show(got.take ?? EMPTY), show(r))
        assert.equal(got.skipped, before.length)
        assert.deepEqual([...got.left], [...after])
      })
    )
  })

  it('of any kind never becomes an answer', () => {
    const near = fc.oneof(fc.constantFrom(0x11, 3, 6, 0x83, 0x10, 0x3a, 0x31, 0x30, 13, 10), fc.nat(255))
    const chunks = fc.array(fc.array(near, { maxLength: 40 }), { maxLength: 6 })
    fc.assert(
      fc.property(chunks, index, (parts, i) => {
        const got = receive(
          wires[i].match,
          parts.map(part => Buffer.from(part))
        )
        if (!got.take) return
        // by chance, then: a frame with every byte right
        const body =
          wires[i].protocol === 'rtu' ? got.take.subarray(0, -2) : hex(got.take.toString('latin1').slice(1, -4))
        assert.equal(show(got.take), show(framed(wires[i].protocol, [...body])))
      }),
      { numRuns: 500 }
    )
  })

  it('made of pieces of the header does not hide it', () => {
    const pieces = [
      '11',
      '11 03',
      '11 03 06',
      '11 11',
      '11 03 08',
      '11 04 06',
      '11 83',
      '11 83 02',
      '11 03 00',
      '12 03 06'
    ]
    for (const text of pieces) {
      const got = receive(match(), [Buffer.concat([hex(text), R])])
      assert.deepEqual([got.take, got.skipped], [R, hex(text).length], text)
      assert.deepEqual(receive(match(), bytesOf(Buffer.concat([hex(text), R]))).take, R, text)
    }
  })

  it('is stepped over where a false header goes before', () => {
    const got = receive(match(), [hex('11 03 06'), R])
    assert.deepEqual([got.take, got.skipped], [R, 3])
    const damaged = Buffer.from(R)
    damaged[5] ^= 4
    const late = receive(match(), [Buffer.concat([damaged, R])])
    assert.deepEqual([late.take, late.skipped], [R, R.length])
    assert.deepEqual(match()(damaged), { bad: 'CRC', length: R.length })
  })

  it('a damaged one ends at once, even if its last byte could begin another', () => {
    const damaged = Buffer.from(R)
    damaged[damaged.length - 1] = STATION
    assert.deepEqual(match()(damaged), { bad: 'CRC', length: R.length })
  })
})

describe('MODBUS match: never a frame out of the middle of another', () => {
  const inner = framed('rtu', '11 83 02')
  const many = { fn: 3, base: 0, count: 8 }
  const outer = framed('rtu', [...hex('11 03 10'), ...inner, ...new Array(11).fill(0)])

  it('an exception inside the data waits for the whole answer, which wins', () => {
    for (let at = 3; at < outer.length; at++) {
      assert.deepEqual(match(many)(outer.subarray(0, at)), { need: outer.length, ours: true })
    }
    assert.deepEqual(receive(match(many), [outer]).take, outer)
  })

  it('nor is it taken out of a damaged answer', () => {
    const damaged = Buffer.from(outer)
    damaged[outer.length - 4] ^= 1
    assert.deepEqual(match(many)(damaged), { bad: 'CRC', length: outer.length })
  })

  it('nor from its very end', () => {
    const damaged = Buffer.concat([hex('11 03 10'), Buffer.alloc(13), inner])
    assert.deepEqual(match(many)(damaged), { bad: 'CRC', length: damaged.length })
  })

  it('what begins behind a damaged one, or a stranger, is waited for', () => {
    assert.deepEqual(match()(Buffer.concat([hex('11 03 06'), R.subarray(0, 9)])), { need: 14, ours: true })
    assert.deepEqual(match()(Buffer.concat([hex('11 04 06'), R.subarray(0, 9)])), { skip: 3 })
  })

  it('nor out of an answer of this station to something else, whole, in pieces or damaged', () => {
    const inside = [...R, 0]
    const others = [
      framed('rtu', [17, 3, 12, ...inside]),
      framed('rtu', [17, 4, 12, ...inside]),
      framed('rtu', [17, 1, 12, ...inside]),
      framed('rtu', [17, 2, 250, ...inside, ...new Array(238).fill(0)])
    ]
    for (const bytes of others) {
      for (let at = 1; at <= bytes.length; at++) {
        const got = receive(match(), [bytes.subarray(0, at), Buffer.concat([bytes.subarray(at), R])])
        assert.deepEqual([got.take, got.skipped], [R, bytes.length], String(at))
      }
      const damaged = Buffer.from(bytes)
      damaged[bytes.length - 1] ^= 1
      assert.equal(receive(match(), [damaged]).take, undefined)
    }
  })

  it('nor out of an answer of another station', () => {
    const foreign = framed('rtu', [12, 3, 12, ...R, 0])
    assert.equal(taken(foreign), undefined)
    const got = receive(match(), [Buffer.concat([foreign, R])])
    assert.deepEqual([got.take, got.skipped], [R, foreign.length])
  })

  it('nor out of the echo of our own write, whole or damaged', () => {
    const ack = framed('rtu', '11 10 00 01 00 04')
    const query = { fn: 16, base: 1, values: [0, 2, 4, 6].map(i => ack.readUInt16BE(i)) }
    const echo = framed('rtu', [...hex('11 10 00 01 00 04 08'), ...ack])
    assert.ok(taken(echo, query), 'without knowing what was sent it would be')
    assert.equal(taken(echo, query, { sent: echo }), undefined)
    for (let bit = 0; bit < echo.length * 8; bit++) {
      const damaged = Buffer.from(echo)
      damaged[bit >> 3] ^= 1 << (bit & 7)
      assert.equal(taken(damaged, query, { sent: echo }), undefined, `bit ${bit}`)
      const both = receive(match(query, { sent: echo }), [Buffer.concat([damaged, ack])])
      assert.deepEqual([both.take, both.skipped], [ack, echo.length], `bit ${bit}`)
    }
  })
})

describe('MODBUS match: our own echo', () => {
  for (const { name, protocol, query, q, r } of wires) {
    if (query.fn === 5 || query.fn === 6) {
      it(`${name}: cannot be told from the answer; the line takes it away`, () => {
        assert.deepEqual(taken(r, query, { protocol, sent: q }), r)
        const checksum = protocol === 'rtu' ? 6 : 13
        for (let bit = checksum * 8; bit < r.length * 8; bit++) {
          const turned = Buffer.from(r)
          turned[bit >> 3] ^= 1 << (bit & 7)
          if (!turned.subarray(1).includes(0x3a))
            assert.ok(receive(match(query, { protocol, sent: q }), [turned]).bad, `bit ${bit}`)
        }
      })
      continue
    }
    it(`${name}: is stepped over, whole, in pieces, with any bit turned; the answer behind it is taken`, () => {
      const look = match(query, { protocol, sent: q })
      assert.equal(receive(look, [q]).take, undefined)
      for (let at = 0; at <= q.length; at++) {
        const got = receive(look, [q.subarray(0, at), Buffer.concat([q.subarray(at), r])])
        assert.deepEqual([got.take, got.skipped], [r, q.length], String(at))
      }
      for (let bit = 0; bit < q.length * 8; bit++) {
        const turned = Buffer.from(q)
        turned[bit >> 3] ^= 1 << (bit & 7)
        const got = receive(look, [turned, r])
        assert.ok(got.take === undefined || got.take.equals(r), `bit ${bit}`)
        assert.equal(got.bad, undefined, `bit ${bit}`)
      }
    })
  }

  it('a read whose request begins like its answer: base 06xxh, three registers', () => {
    const query = { fn: 3, base: 0x0600, count: 3 }
    for (const protocol of PROTOCOLS) {
      const q = framed(protocol, '11 03 06 00 00 03')
      const r = framed(protocol, BODY)
      const look = match(query, { protocol, sent: q })
      assert.deepEqual(look(q), { skip: q.length })
      assert.deepEqual(receive(look, [q, r]).take, r, protocol)
      assert.deepEqual(receive(look, [Buffer.concat([q, r])]).take, r, protocol)
      assert.deepEqual(receive(look, bytesOf(Buffer.concat([q, r]))).take, r, protocol)
      assert.deepEqual(receive(look, [r]).take, r, protocol)
      for (const data of ['00 00 03 00 00 00', '00 00 03 12 34 56']) {
        const alike = framed(protocol, `11 03 06 ${data}`)
        assert.deepEqual(receive(look, bytesOf(alike)).take, alike, `${protocol} ${data}`)
      }
    }
  })
})

describe('MODBUS match: chance', () => {
  it('an exception whose bytes are those of the request, but for its function', () => {
    let found = 0
    for (let station = 1; station <= 247; station++) {
      for (let number = 1; number <= 11; number++) {
        const bytes = framed('rtu', [station, 0x83, number])
        if (bytes[4] !== 0) continue
        found++
        const query = { fn: 3, base: number * 256 + bytes[3], count: 3 }
        const sent = framed('rtu', [station, 3, number, bytes[3], 0, 3])
        const look = answerTo(query, { station, sent })
        assert.deepEqual(look(bytes), { take: 5 })
        assert.deepEqual(look(bytes.subarray(0, 4)), { need: 5, ours: true })
        assert.deepEqual(receive(look, [sent, bytes]).take, bytes)
      }
    }
    assert.ok(found > 0)
  })

  it('an acknowledgement that the request begins with, by its checksum', () => {
    for (let base = 0; base < 0x10000; base++) {
      const ack = framed('rtu', [17, 16, base >> 8, base & 255, 0, 2])
      if (ack[6] !== 4) continue
      const query = { fn: 16, base, values: [ack[7] * 256, 1] }
      const look = match(query, { sent: framed('rtu', [...ack.subarray(0, 6), 4, ack[7], 0, 0, 1]) })
      for (let at = 6; at < 8; at++) assert.deepEqual(look(ack.subarray(0, at)), { need: 8, ours: true })
      return assert.deepEqual(look(ack), { take: 8 })
    }
    assert.fail('there is none')
  })
})

describe('MODBUS match: what is not ours is skipped', () => {
  const foreign = [
    ['another station', '12 03 06 02 2B 00 00 00 64'],
    ['another function', '11 04 06 02 2B 00 00 00 64'],
    ['another count', '11 03 04 02 2B 00 00'],
    ['a larger count', '11 03 08 02 2B 00 00 00 64 00 00'],
    ['a count of 0', '11 03 00'],
    ['bits', '11 01 06 02 2B 00 00 00 64'],
    ['an exception to another function', '11 84 02'],
    ['an exception of another station', '12 83 02'],
    ['an acknowledgement', '11 06 00 6B 00 03'],
    ['our own request', '11 03 00 6B 00 03'],
    ['the broadcast’s station', '00 03 06 02 2B 00 00 00 64'],
    ['noise', '00 22 33 44 55 66 77 88 99']
  ]
  const acks = [
    ['another address', '11 10 00 02 00 02'],
    ['another quantity', '11 10 00 01 00 03'],
    ['another function', '11 06 00 01 00 02'],
    ['another station', '12 10 00 01 00 02'],
    ['the request itself', '11 10 00 01 00 02 04 00 0A 01 02']
  ]
  const skips = (protocol, name, body, query = WORDS) =>
    it(`${protocol} ${query.fn}: ${name}`, () => {
      const bytes = framed(protocol, body)
      const right = framed(protocol, query === WORDS ? BODY : '11 10 00 01 00 02')
      const sent = framed(protocol, '11 10 00 01 00 02 04 00 0A 01 02')
      const look = match(query, { protocol, sent: query === WRITE ? sent : undefined })
      for (const chunks of [[bytes], bytesOf(bytes)]) {
        const alone = receive(look, chunks)
        assert.deepEqual([alone.take, alone.bad], [undefined, undefined])
        const got = receive(look, [...chunks, right])
        assert.deepEqual([got.take, got.skipped], [right, bytes.length], 'the right one afterwards')
      }
    })
  for (const protocol of PROTOCOLS) {
    for (const [name, body] of foreign) skips(protocol, name, body)
    for (const [name, body] of acks) skips(protocol, name, body, WRITE)
  }

  it('a wrong echo of 05 and 06: another address or value', () => {
    for (const protocol of PROTOCOLS) {
      for (const body of ['11 05 00 AC 00 00', '11 05 00 AD FF 00', '11 06 00 AC FF 00']) {
        assert.equal(taken(framed(protocol, body), { fn: 5, base: 172, value: true }, { protocol }), undefined, body)
      }
      for (const body of ['11 06 00 01 00 04', '11 06 00 02 00 03', '11 06 01 01 00 03']) {
        assert.equal(taken(framed(protocol, body), { fn: 6, base: 1, value: 3 }, { protocol }), undefined, body)
      }
    }
  })
})

describe('MODBUS match: ASCII', () => {
  const own = framed('ascii', BODY)
  const text = own.toString('latin1')
  const look = match(WORDS, { protocol: 'ascii' })
  const of = latin1 => receive(look, [Buffer.from(latin1, 'latin1')])

  it('a colon in the middle begins anew', () => {
    for (let at = 1; at < own.length; at++) {
      const got = receive(look, [own.subarray(0, at), own])
      assert.deepEqual([got.take, got.skipped], [own, at], String(at))
    }
  })

  it('empty and odd frames are skipped', () => {
    for (const junk of [
      ':\r\n',
      '\r\n',
      ':',
      '::',
      ':1\r\n',
      ':11\r\n',
      ':110\r\n',
      ':1103\r\n',
      ':zz\r\n',
      ':\r\n:\r\n',
      ':1104\r'
    ]) {
      const got = of(junk + text)
      assert.deepEqual([got.take, got.skipped], [own, junk.length], JSON.stringify(junk))
      assert.equal(of(junk).take, undefined)
      assert.equal(of(junk).bad, undefined)
    }
  })

  it('is strict: small digits, a missing or another end, a lost or an added character are refused', () => {
    const wrong = [
      text.replace('2B', '2b'),
      text.replace('\r\n', '\n'),
      text.replace('\r\n', '\n\r'),
      text.replace('\r\n', '\r\r'),
      text.replace('2B', '2'),
      text.replace('2B', '2BB'),
      text.replace('2B', '2G')
    ]
    for (const each of wrong) {
      const got = of(`${each}          `)
      assert.equal(got.take, undefined, JSON.stringify(each))
      assert.ok(got.bad, JSON.stringify(each))
    }
    for (const each of [text.replace(':', ';'), text.replace('1103', '11 03'), text.slice(1)]) {
      assert.equal(of(each).take, undefined, JSON.stringify(each))
    }
  })

  it('a right checksum over another length than the header says is not ours', () => {
    for (const body of ['11 03 06 02 2B 00 00 00', '11 03 06 02 2B 00 00 00 64 00', '11 83 02 00']) {
      const got = receive(look, [framed('ascii', body), own])
      assert.deepEqual(got.take, own, body)
    }
  })
})

describe('MODBUS match: the beginning of another answer of the station', () => {
  it('is waited for before its byte count has come', () => {
    assert.deepEqual(match()(hex('11 01')), { need: 5 })
    assert.deepEqual(match()(hex('11 01 02')), { need: 7, ours: false })
    assert.deepEqual(match()(hex('12 01')), { skip: 2 })
  })

  it('its length follows from function and byte count; a count that cannot be is none', () => {
    const cases = [
      ['11 84', { need: 5, ours: false }],
      ['11 06', { need: 8, ours: false }],
      ['11 01 01', { need: 6, ours: false }],
      ['11 01 03', { need: 8, ours: false }],
      ['11 01 FA', { need: 255, ours: false }],
      ['11 04 FA', { need: 255, ours: false }],
      ['11 01 00', { skip: 3 }],
      ['11 01 FB', { skip: 3 }],
      ['11 04 03', { skip: 3 }],
      ['11 07 02', { skip: 3 }]
    ]
    for (const [bytes, verdict] of cases) assert.deepEqual(match()(hex(bytes)), verdict, bytes)
  })

  it('of another station only a whole one counts: what else looks like one hides nothing', () => {
    const around = (station, data) => framed('rtu', [station, 1, data.length, ...data])
    const filled = size => [...R, ...new Array(size - R.length).fill(0)]
    for (const station of [1, 18, 247]) {
      assert.equal(taken(around(station, [...R])), undefined, `${station}`)
      assert.equal(taken(around(station, filled(250))), undefined)
      const damaged = around(station, [...R])
      damaged[damaged.length - 1] ^= 1
      assert.deepEqual(taken(damaged), R, `${station}, damaged`)
      assert.deepEqual(taken(damaged.subarray(0, -1)), R, `${station}, cut`)
    }
    // no such station, no such count
    for (const station of [0, 248, 255]) assert.deepEqual(taken(around(station, [...R])), R, `${station}`)
    assert.deepEqual(taken(around(18, filled(251))), R)
  })

  it('two damaged answers in a row are two', () => {
    const damaged = Buffer.from(R)
    damaged[5] ^= 1
    assert.deepEqual(match()(Buffer.concat([damaged, damaged])), { bad: 'CRC', length: R.length })
  })
})

describe('MODBUS match: noise is no echo', () => {
  for (const protocol of PROTOCOLS) {
    it(`${protocol}: what differs from the request in more than a quarter hides no answer`, () => {
      const q = framed(protocol, '11 03 00 6B 00 03')
      const r = framed(protocol, BODY)
      const look = match(WORDS, { protocol, sent: q })
      for (let length = 1; length < 20; length++) {
        for (const byte of [0xaa, 0x41]) {
          const got = receive(look, [Buffer.concat([Buffer.alloc(length, byte), r])])
          assert.deepEqual([got.take, got.skipped], [r, length], `${length} × ${byte}`)
        }
      }
    })
  }

  it('RTU: nor a short one: an exception, or the acknowledgement of a write', () => {
    const asked = [
      [WORDS, '11 03 00 6B 00 03', ['11 83 02', BODY]],
      [WRITE, '11 10 00 01 00 02 04 00 0A 01 02', ['11 90 02', '11 10 00 01 00 02']],
      [{ fn: 1, base: 19, count: 1 }, '11 01 00 13 00 01', ['11 81 02', '11 01 01 01']]
    ]
    for (const [query, request, answers] of /** @type {[any, string, string[]][]} */ (asked)) {
      const look = match(query, { sent: framed('rtu', request) })
      for (const body of answers) {
        const r = framed('rtu', body)
        for (let length = 1; length < 16; length++) {
          for (const byte of [0xaa, 0x41, 0xff]) {
            const noise = Buffer.alloc(length, byte)
            for (const chunks of [[Buffer.concat([noise, r])], bytesOf(Buffer.concat([noise, r]))]) {
              const got = receive(look, chunks)
              assert.deepEqual([got.take, got.skipped], [r, length], `${body} behind ${length} × ${byte}`)
            }
          }
        }
      }
    }
  })

  it('RTU: a quarter of the echo may be damaged, not one byte more: then an exception is looked for in it', () => {
    // 11 83 stands where the request names its address
    const query = { fn: 3, base: 0x1183, count: 3 }
    const sent = framed('rtu', '11 03 11 83 00 03')
    const look = match(query, { sent })
    // not its function, which makes another request of it
    for (const places of [[0], [4], [7], [0, 4], [0, 7], [5, 6], [0, 4, 5], [0, 6, 7], [0, 4, 5, 6]]) {
      const heard = Buffer.from(sent)
      for (const at of places) heard[at] ^= 0x55
      const got = receive(look, [heard])
      const few = places.length <= 2
      assert.deepEqual([got.skipped, got.bad], few ? [8, undefined] : [2, 'CRC'], `${places}`)
    }
  })

  it('RTU: the echo of a write, damaged in its values, with the acknowledgement behind it', () => {
    const q = framed('rtu', '11 10 00 01 00 02 04 00 0A 01 02')
    const ack = framed('rtu', '11 10 00 01 00 02')
    const look = match(WRITE, { sent: q })
    for (const places of [[8], [9, 10], [8, 9, 10], [9, 11, 12], [7, 8, 9], [6, 8, 9]]) {
      const heard = Buffer.from(q)
      for (const at of places) heard[at] ^= 0x55
      for (const chunks of [[heard, ack], [Buffer.concat([heard, ack])], bytesOf(Buffer.concat([heard, ack]))]) {
        const got = receive(look, chunks)
        assert.deepEqual([got.take, got.skipped, got.bad], [ack, q.length, undefined], `${places}`)
      }
    }
  })

  // the request 11 03 06 00 00 03 begins as its answer does
  const query = { fn: 3, base: 0x0600, count: 3 }
  it('ASCII: up to a quarter of it may be damaged, and not one more', () => {
    // 17 characters: four
    const q = framed('ascii', '11 03 06 00 00 03')
    assert.equal(q.length, 17)
    const look = match(query, { protocol: 'ascii', sent: q })
    for (const count of [1, 2, 3, 4, 5, 6]) {
      const heard = Buffer.from(q)
      for (let i = 0; i < count; i++) heard[8 + i] = heard[8 + i] === 0x39 ? 0x38 : 0x39
      assert.deepEqual(look(heard), count <= 4 ? { skip: 17 } : { bad: 'LRC', length: 17 }, `${count}`)
    }
  })

  it('ASCII: of an echo that has not ended the rest is waited for; behind it the answer is taken', () => {
    const q = framed('ascii', '11 03 06 00 00 03')
    const r = framed('ascii', BODY)
    const look = match(query, { protocol: 'ascii', sent: q })
    const heard = Buffer.from(q)
    heard[9] = 0x39
    const got = receive(look, bytesOf(Buffer.concat([heard, r])))
    assert.deepEqual([got.take, got.skipped], [r, q.length])
    // longer than the answer, and begins like it: its end is still to come
    const write = framed('ascii', '11 10 00 01 00 02 04 00 0A 01 02')
    const end = match(WRITE, { protocol: 'ascii', sent: write })
    for (let length = 17; length < write.length - 1; length++) {
      assert.deepEqual(end(write.subarray(0, length)), { need: write.length }, `${length}`)
    }
  })

  it('RTU: a damaged answer that is not like the request is one', () => {
    const answer = framed('rtu', '11 03 06 12 34 56 78 9A BC')
    answer[6] ^= 1
    const sent = framed('rtu', '11 03 06 00 00 03')
    assert.deepEqual(match(query, { sent })(answer), { bad: 'CRC', length: 11 })
  })
})

describe('MODBUS match: bounded', () => {
  it('asks again only when it pays', () => {
    const most = { fn: 3, base: 0, count: 125 }
    for (const protocol of PROTOCOLS) {
      const bytes = framed(protocol, [17, 3, 250, ...new Array(250).fill(0)])
      const got = receive(match(most, { protocol }), bytesOf(bytes))
      assert.deepEqual(got.take, bytes)
      assert.ok(got.calls <= 5, `${got.calls} calls for ${bytes.length} bytes`)
    }
  })

  it('works through a flood', () => {
    const floods = [
      size => Buffer.concat(new Array(size / 4).fill(hex('11 03 06 11'))),
      size => Buffer.concat(new Array(size / 4).fill(hex('12 01 FA 12'))),
      size => Buffer.concat(new Array(size / 4).fill(hex('11 01 FA 11'))),
      size => Buffer.alloc(size, 0x11),
      size => Buffer.alloc(size, 0x01),
      size => Buffer.alloc(size, 0x3a),
      size => Buffer.from(':110306\r\n:1103'.repeat(size).slice(0, size), 'latin1')
    ]
    for (const protocol of PROTOCOLS) {
      for (const [at, flood] of floods.entries()) {
        // a busy machine may spoil one measurement, not three
        const measure = () => growth(size => receive(match(WORDS, { protocol, sent: R }), [flood(size)]), 2048)
        let ratio = measure()
        for (let again = 0; again < 2 && ratio >= 10; again++) ratio = Math.min(ratio, measure())
        assert.ok(ratio < 10, `${protocol} ${at}: four times the bytes take ${ratio.toFixed(1)} times as long`)
      }
    }
  })
})
