'use strict'
const assert = require('node:assert/strict')
const fc = require('fast-check')
const { bidirectionalFormat } = require('../../../lib/codec/melsec/format')
const melsec = require('../../../lib/codec/melsec/bidirectional')
const { Repeats } = require('../../../lib/codec/melsec/repeats')
const { FRAMES, TEXT, bytes } = require('../../vectors/melsec')

const { ACK_FRAME, NAK_CODES, OUR_NAK, bidirectionalFraming, encodeFrame, encodeNak, nakText } = melsec
const splitter = options => bidirectionalFraming(bidirectionalFormat(options)).create()
const encode = (body, options) => encodeFrame(Buffer.from(body), bidirectionalFormat(options))
const code = wanted => error => error.code === wanted

// independent of the codec: nothing but the manual's words
const frameOf = body => {
  const section = [(body.length / 2) & 255, (body.length / 2) >> 8, ...body]
  const sum = section.reduce((all, byte) => all + byte, 0) % 65536
  return Buffer.from([5, ...section, sum % 256, Math.floor(sum / 256)])
}

describe('MELSEC bidirectional protocol', () => {
  for (const { name, options, body, wire } of FRAMES) {
    it(`vector: ${name}`, () => {
      assert.deepEqual(encode(body, options), wire)
      assert.deepEqual(splitter(options).push(wire), [{ kind: 'data', bytes: body, complete: true }])
    })

    it(`every split: ${name}`, () => {
      for (let at = 0; at <= wire.length; at++) {
        const one = splitter(options)
        const got = [...one.push(wire.subarray(0, at)), ...one.push(wire.subarray(at))]
        assert.deepEqual(got, [{ kind: 'data', bytes: body, complete: true }])
        assert.equal(one.held, 0)
      }
    })

    it(`a damaged byte is never delivered: ${name}`, () => {
      for (let at = 0; at < wire.length; at++) {
        for (const flip of [0x01, 0x20, 0xff]) {
          const damaged = Buffer.from(wire)
          damaged[at] ^= flip
          const one = splitter(options)
          const got = [...one.push(damaged), ...one.flush()]
          assert.deepEqual(
            got.filter(({ kind }) => kind === 'data'),
            [],
            `byte ${at} ^ ${flip}`
          )
          assert.equal(one.held, 0)
        }
      }
    })

    it(`a lost byte is never delivered: ${name}`, () => {
      for (let at = 0; at < wire.length; at++) {
        const one = splitter(options)
        const rest = Buffer.concat([wire.subarray(0, at), wire.subarray(at + 1)])
        const got = [...one.push(rest), ...one.flush()]
        // without its additional code a byte is the same one: nothing is damaged then
        const harmless = wire[at] === options.transparent?.[0]
        assert.ok(got.length > 0 && got.every(({ kind }) => (kind === 'data') === harmless), `byte ${at}`)
        if (harmless) assert.deepEqual(got[0].bytes, body)
      }
    })
  }

  it('byte units, and no sum', () => {
    assert.deepEqual(encode(TEXT, { unit: 'byte' }).subarray(0, 3), bytes('05 0A 00'))
    const wire = encode('ABC', { unit: 'byte', sumCheck: false })
    assert.deepEqual(wire, bytes('05 03 00 41 42 43'))
    assert.deepEqual(splitter({ unit: 'byte', sumCheck: false }).push(wire)[0].bytes, Buffer.from('ABC'))
  })

  it('ACK and NAK', () => {
    const nak = (wire, options) => {
      const one = splitter(options)
      return [...one.push(bytes(wire)), ...one.flush()]
    }
    assert.deepEqual(nak('06'), [{ kind: 'ack', bytes: Buffer.alloc(0), complete: true }])
    assert.deepEqual(nak('15 24 7F'), [{ kind: 'nak', bytes: bytes('24 7F'), code: 0x7f24, complete: true }])
    // application manual, 13.5: '1234' is stored as 3412H
    assert.equal(nak('15 31 32 33 34', { asciiBinary: true })[0].code, 0x3412)
    assert.deepEqual(ACK_FRAME, bytes('06'))
    assert.deepEqual(encodeNak(0x22, bidirectionalFormat()), bytes('15 22 00'))
    assert.deepEqual(encodeNak(0x22, bidirectionalFormat({ asciiBinary: true })), bytes('15 32 32 30 30'))
    assert.match(nakText(0x7f24), /sum/)
    assert.match(nakText(0x1234), /not in the list/)
  })

  it('the codes of the manual, ch. 10, have words; ours are among those that are free, and none is a control code', () => {
    const listed = [0x7f01, 0x7f20, 0x7f21, 0x7f24, 0x7f25, 0x7f31, 0x7f40, 0x7f41, 0x7f67, 0x7f68, 0x7f69, 0x7f6a]
    assert.deepEqual([...NAK_CODES.keys()], listed)
    assert.equal(new Set(listed.map(nakText)).size, listed.length)
    for (const number of listed) assert.match(nakText(number), /^[\w-][\w :-]+$/)
    const own = Object.values(OUR_NAK)
    assert.deepEqual(Object.keys(OUR_NAK), ['sum', 'length', 'incomplete', 'notHex', 'other'])
    assert.ok(new Set(own).size === 5 && own.every(number => number >= 0x22 && number <= 0x5f))
  })

  it('behind stray bytes nothing is made of what follows, whatever came before', () => {
    const one = splitter()
    assert.equal(one.push(frameOf([1, 2])).length, 1)
    // as many bytes as were awaited last, and a sum that would fit
    assert.deepEqual(one.push(bytes('41 42 43 00 00 00 00 06')), [])
    assert.deepEqual(one.flush(), [
      { kind: 'damaged', bytes: bytes('41 42 43 00 00 00 00 06'), complete: false, reason: 'stray', began: false }
    ])
  })

  it('the reason is that of this frame, not of an earlier one', () => {
    const one = splitter({ asciiBinary: true })
    const told = wire => {
      const [{ kind, reason, began }] = [...one.push(bytes(wire)), ...one.flush()]
      return [kind, reason, began]
    }
    assert.deepEqual(told('05 30 32 30 30 31 78'), ['damaged', 'incomplete', true])
    assert.deepEqual(told('05 30 78 30 30'), ['damaged', 'notHex', true])
    assert.deepEqual(told('05 30'), ['damaged', 'incomplete', true])
    assert.deepEqual(told('41'), ['damaged', 'stray', false])
    assert.deepEqual(told('06 41'), ['damaged', 'stray', false])
    assert.deepEqual(told('15 32'), ['damaged', 'incomplete', false])
  })

  it('DC1 and DC3 are not made transparent here: a sum may contain them anyway', () => {
    assert.deepEqual(encode([0x11, 0x13], { transparent: bytes('10') }), bytes('05 01 00 11 13 25 00'))
  })

  it('the silence is four characters of a slow line, or what is set', () => {
    const times = options => {
      const { silence, ackSilence } = bidirectionalFormat(options)
      return [silence, ackSilence]
    }
    assert.deepEqual(times(), [50, 2])
    assert.deepEqual(times({ character: 10 }), [50, 40])
    assert.deepEqual(times({ character: 33.4 }), [134, 134])
    assert.deepEqual(times({ character: 33.4, gap: 7 }), [7, 134])
  })

  it('the key is that of this protocol and its settings', () => {
    const key = options => bidirectionalFraming(bidirectionalFormat(options)).key
    assert.match(key(), /^melsec bidirectional unit=word sumCheck=true most=16384 /)
    assert.notEqual(key({ transparent: bytes('10 02') }), key({ transparent: bytes('10 03') }))
    assert.equal(key({ transparent: bytes('10 02 03') }), key({ transparent: bytes('10 03 02') }))
    assert.match(key({ transparent: bytes('10 03 02') }), / additional=16 escaped=2 3 16 /)
  })

  it('after damage all is dropped until the line is silent, and told once', () => {
    const one = splitter()
    const wrong = bytes('05 01 00 41 42 00 00')
    assert.deepEqual(one.push(Buffer.concat([wrong, bytes('06 05 01 00'), frameOf([1, 2])])), [])
    const [message, ...more] = one.flush()
    assert.deepEqual(more, [])
    assert.equal(message.kind, 'damaged')
    assert.equal(message.reason, 'sum')
    assert.equal(message.began, true)
    assert.equal(one.push(frameOf([1, 2]))[0].kind, 'data')
  })

  it('an ACK counts when it stands alone or before a frame: it may be a damaged ENQ or NAK', () => {
    const one = splitter({ character: 1 })
    assert.deepEqual(one.push(ACK_FRAME), [])
    assert.deepEqual([one.held, one.silence], [1, 4])
    assert.equal(one.flush()[0].kind, 'ack')
    assert.ok(one.silence >= 50)
    const kinds = wire => {
      const fresh = splitter()
      return [...fresh.push(wire), ...fresh.flush()].map(({ kind }) => kind)
    }
    assert.deepEqual(kinds(Buffer.concat([ACK_FRAME, frameOf([1, 2])])), ['ack', 'data'])
    assert.deepEqual(kinds(Buffer.concat([ACK_FRAME, frameOf([1, 2]).subarray(1)])), ['damaged'])
    assert.deepEqual(kinds(bytes('06 24 7F')), ['damaged'])
    assert.deepEqual(kinds(bytes('06 06')), ['damaged'])
    one.push(ACK_FRAME)
    assert.equal(one.reset()[0].kind, 'ack')
  })

  it('stray bytes ask for no answer', () => {
    const one = splitter()
    assert.deepEqual(one.push(bytes('41 06 05')), [])
    const [{ reason, began }] = one.flush()
    assert.deepEqual({ reason, began }, { reason: 'stray', began: false })
  })

  it('a length that cannot be, a frame that stops, a port that closes', () => {
    const reasons = (wire, end) => {
      const one = splitter({ most: 100 })
      return [...one.push(bytes(wire)), ...one[end]()].map(({ reason, began }) => [reason, began])
    }
    assert.deepEqual(reasons('05 00 00', 'flush'), [['length', true]])
    assert.deepEqual(reasons('05 33 00', 'flush'), [['length', true]])
    assert.deepEqual(reasons('05 32 00', 'flush'), [['incomplete', true]])
    assert.deepEqual(reasons('05 32 00 41', 'reset'), [['closed', true]])
    assert.deepEqual(reasons('15 24', 'flush'), [['incomplete', false]])
    assert.deepEqual(reasons('', 'reset'), [])
  })

  it('refuses what it cannot say', () => {
    assert.throws(() => encode('ABC'), code('ODD_COUNT'))
    assert.deepEqual(encode('ABC', { padEven: true }).subarray(0, 7), bytes('05 02 00 41 42 43 00'))
    assert.throws(() => encode(''), code('BAD_VALUE'))
    assert.throws(() => encode('ABCD', { most: 3 }), code('FRAME_TOO_LONG'))
    assert.throws(() => bidirectionalFormat({ dc: true }), code('BAD_SETTING'))
    assert.throws(() => bidirectionalFormat({ most: 200000 }), code('BAD_SETTING'))
    assert.equal(encode('ABCD', { most: 4 }).length, 9)
    for (const [unit, most] of [
      ['word', 131070],
      ['byte', 65535]
    ]) {
      assert.equal(bidirectionalFormat({ unit, most }).most, most)
      assert.throws(() => bidirectionalFormat({ unit, most: most + 1 }), {
        details: { setting: 'most', value: most + 1, reason: `a whole number from 1 to ${most} is needed` }
      })
    }
    const says = (call, details) => assert.throws(call, { details })
    says(() => encode('ABCD', { most: 3 }), { what: 'the message', got: 4, most: 3 })
    says(() => encode(''), { item: 'the message', value: '', reason: 'it is empty' })
    says(() => encode('ABC'), { count: 3, reason: 'the length is counted in words' })
    const reason = 'sums and lengths contain DC1 and DC3; its acknowledgements are the flow control'
    says(() => bidirectionalFormat({ dc: true }), { setting: 'flow', value: 'dc', reason })
    const time = 'a whole number from 0 to 3600000 is needed'
    says(() => bidirectionalFormat({ gap: -1 }), { setting: 'gap', value: -1, reason: time })
  })

  it('any body, in any pieces, with any options', () => {
    const options = fc.record({
      unit: fc.constantFrom('word', 'byte'),
      sumCheck: fc.boolean(),
      asciiBinary: fc.boolean(),
      padEven: fc.constant(true),
      transparent: fc.constantFrom(...['', '10', '10 02 41', '00 30'].map(bytes))
    })
    const bodies = fc.array(fc.uint8Array({ minLength: 1, maxLength: 40 }), { minLength: 1, maxLength: 3 })
    fc.assert(
      fc.property(options, bodies, fc.array(fc.nat(200), { maxLength: 8 }), (given, list, cuts) => {
        const wire = Buffer.concat(list.map(body => encode(body, given)))
        const one = splitter(given)
        const ends = [...cuts.map(cut => cut % (wire.length + 1)).sort((a, b) => a - b), wire.length]
        const got = ends.flatMap((end, n) => one.push(wire.subarray(n ? ends[n - 1] : 0, end)))
        const padded = list.map(body => Buffer.concat([body, Buffer.alloc(body.length % 2)]))
        assert.deepEqual(
          got.map(({ bytes: body }) => body.toString('hex')),
          padded.map(body => body.toString('hex'))
        )
      }),
      { numRuns: 300 }
    )
  })

  it('wrong frames pass a sum of 16 bits as often as theory says, and one wrong byte never', () => {
    // two bytes changed: the sum stays if the changes cancel out
    let passed = 0
    let seed = 1
    const next = most => (seed = (seed * 48271) % 0x7fffffff) % most
    const wire = frameOf(Buffer.from('0123456789ABCDEF'))
    const rounds = 20000
    for (let n = 0; n < rounds; n++) {
      const damaged = Buffer.from(wire)
      const [a, b] = [3 + next(16), 3 + next(16)]
      if (a === b) continue
      damaged[a] = next(256)
      damaged[b] = next(256)
      if (damaged.equals(wire)) continue
      const one = splitter()
      const got = [...one.push(damaged), ...one.flush()]
      passed += got.filter(({ kind }) => kind === 'data').length
    }
    // the second change must be the negative of the first: about one in 256, less where that would leave 0 to 255
    assert.ok(passed > rounds / 1200 && passed < rounds / 200, `${passed} of ${rounds}`)
  })
})

describe('MELSEC repeated frames', () => {
  const [one, other] = [Buffer.from('one'), Buffer.from('other')]
  const filter = (options = {}) => new Repeats({ after: 1000, within: 5000, ...options })

  it('only equal bytes, only in the time in which they can be a repetition', () => {
    const repeats = filter()
    assert.equal(repeats.accept(one, 0), false)
    assert.equal(repeats.accept(one, 999), false, 'the other side was still waiting for its ACK: it had come')
    assert.equal(repeats.accept(one, 1999), true)
    assert.equal(repeats.accept(other, 3500), false)
    assert.equal(repeats.accept(one, 5000), false)
    assert.equal(repeats.accept(one, 10001), false)
  })

  it('what counts is the time since our ACK, whatever the clock says', () => {
    const repeats = filter()
    assert.equal(repeats.accept(one, 1e6), false)
    assert.equal(repeats.accept(one, 1e6 + 1000), true)
    assert.equal(repeats.accept(one, 1e6 + 1999), false)
    assert.equal(repeats.accept(one, 1e6 + 1999 + 5000), true, 'within: that late still')
    assert.equal(repeats.accept(one, 1e6 + 6999 + 5001), false)
  })

  it('a frame behind our NAK began with its first attempt', () => {
    const repeats = filter()
    repeats.accept(one, 0)
    repeats.refuse(100)
    repeats.refuse(1500)
    assert.equal(repeats.accept(one, 1700), false, 'a new message, damaged at first')
    repeats.refuse(3000)
    assert.equal(repeats.accept(one, 3100), true, 'a repetition, damaged at first')
  })

  it('can be off', () => {
    const repeats = filter({ within: 0 })
    repeats.accept(one, 0)
    assert.equal(repeats.accept(one, 2000), false)
  })
})
