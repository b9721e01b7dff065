'use strict'

const assert = require('node:assert/strict')
const { PlcError, entriesOf, itemsOf, payloadOf } = require('../../lib')
const { c24Bench } = require('../device/c24-bench')
const { inconBench } = require('../device/incon-bench')
const { bench } = require('../device/support')
const { bench: regulatorBench } = require('../device/chino-bench')

/** Proxies and getters: what a message may hold that throws, or never ends, when it is looked at. */

const boom = () => {
  throw new Error('boom')
}
const traps = Object.fromEntries(Object.getOwnPropertyNames(Reflect).map(name => [name, boom]))
const revoked = target => {
  const { proxy, revoke } = Proxy.revocable(target, {})
  revoke()
  return proxy
}
/** Throws something that cannot be shown either. */
const nasty = new Proxy({}, { get: () => boom(), getPrototypeOf: boom })
const endless = values =>
  Object.assign(values, {
    *[Symbol.iterator]() {
      for (;;) yield 1
    }
  })
const growing = () => new Proxy([1], { get: (list, key) => (key === 'length' ? 3 : key === '0' ? 1 : boom()) })

const HOSTILE = {
  'a proxy whose traps throw': () => new Proxy({}, traps),
  'a proxy of a list whose traps throw': () => new Proxy([1, 2], traps),
  'a revoked proxy': () => revoked({}),
  'a revoked proxy of a list': () => revoked([]),
  'a list with a getter that throws': () => Object.defineProperty([1, 2], 1, { get: boom }),
  'an object with a getter that throws': () => Object.defineProperty({}, 'M0', { get: boom, enumerable: true }),
  'a text object that throws': () => Object.assign(Object.create({ toString: boom, valueOf: boom }), { toJSON: boom }),
  'a list longer than it is': growing,
  'a proxy that throws what cannot be shown': () =>
    new Proxy([1], {
      get: (list, key) => {
        if (key === 'length') return 1
        throw nasty
      }
    })
}

/** A refusal of what was given: never a word about a station, and a text that can be printed. */
const isRefusal = ({ code, text, message = text }) => {
  assert.match(code, /^(BAD_VALUE|BAD_ITEMS|BAD_ADDRESS|NOTHING_TO_WRITE|TOO_MANY|FRAME_TOO_LONG)$/, message)
  assert.doesNotMatch(message, /station/)
}
const refused = call =>
  assert.throws(call, error => {
    assert.ok(error instanceof PlcError, String(error))
    isRefusal(error)
    return true
  })

describe('attack: payloads that fight back', () => {
  for (const [name, make] of Object.entries(HOSTILE)) {
    it(`${name}: refused as a payload and as a list of items`, () => {
      refused(() => entriesOf({ payload: make(), topic: 'M0' }))
      refused(() => entriesOf({ payload: make() }, { target: 'M0' }))
      refused(() => entriesOf({ payload: { M0: make() } }))
      refused(() => itemsOf(make()))
    })
  }

  it('a getter that throws in place of the payload', () => {
    const msg = Object.defineProperty({ topic: 'M0' }, 'payload', { get: boom, enumerable: true })
    refused(() => entriesOf(msg))
    refused(() => payloadOf(msg))
    assert.equal(payloadOf({ payload: 0 }), 0)
    assert.equal(payloadOf(Object.create({ payload: 1 })), undefined)
  })

  it('a list that never ends counts by its length', () => {
    assert.deepEqual(entriesOf({ topic: 'M0..M1', payload: endless([1, 0]) }), [{ item: 'M0..M1', value: [1, 0] }])
    assert.deepEqual(itemsOf(endless(['M0'])), ['M0'])
  })

  const writers = {
    NX: { make: () => bench({ plc: { access: 'write' } }), items: ['K0', 'K0..K1', 'M0'] },
    MODBUS: { make: () => regulatorBench(), items: ['400001', '400001..400002', '000001'] }
  }
  for (const [name, { make, items }] of Object.entries(writers)) {
    it(`${name}: a program's write has an outcome, and nothing goes out`, async () => {
      const b = make()
      for (const [what, hostile] of Object.entries(HOSTILE)) {
        for (const item of items) {
          const { outcome, ...why } = await b.run(b.device.write([{ item, value: hostile() }], { fixed: true }))
          assert.equal(outcome, 'refused', what)
          isRefusal(why)
        }
        for (const entries of [[hostile()], [{ item: hostile(), value: 1 }], hostile()]) {
          const { outcome, ...why } = await b.run(b.device.write(entries, { fixed: true }))
          assert.equal(outcome, 'refused', what)
          isRefusal(why)
        }
      }
      assert.equal(b.lease.line.stats().bytesOut, 0)
      const list = endless([1, 2])
      assert.equal(
        (await b.run(b.device.write([{ item: items[1], value: list }], { fixed: true }))).outcome,
        'confirmed'
      )
      await b.close()
    })
  }

  const senders = {
    'C24, text': () => c24Bench(),
    'C24, words': () => c24Bench({ port: { format: 'words' } }),
    'C24, bidirectional': () => c24Bench({ port: { bidirectional: true, format: 'bytes' } }),
    INCON: () => inconBench(),
    'INCON, acknowledged': () => inconBench({ link: { checked: true, acknowledge: true } })
  }
  for (const [name, make] of Object.entries(senders)) {
    it(`${name}: what is sent has an outcome, and nothing goes out`, async () => {
      const b = make()
      await b.clock.advance(5)
      const before = b.lease.line.stats().bytesOut
      for (const [what, hostile] of Object.entries(HOSTILE)) {
        const { outcome, ...why } = await b.run(b.device.send(hostile()))
        assert.equal(outcome, 'refused', what)
        isRefusal(why)
      }
      assert.equal(b.lease.line.stats().bytesOut, before)
      await b.close()
    })
  }
})

describe('attack: texts of errors', () => {
  it('cannot begin a line of their own in a log, move the cursor or turn the text round', () => {
    const unruly = 'K0\r\n[error] forged\u001b[2J\u0007\u202e\u2028\u0085\ufeff'
    const { message } = new PlcError('BAD_ADDRESS', { address: unruly, reason: 'no' })
    assert.doesNotMatch(message, /[\p{Cc}\p{Zl}\p{Zp}\u202e\ufeff]/u)
    assert.match(message, /^"K0\\u000d\\u000a\[error\] forged\\u001b\[2J\\u0007\\u202e\\u2028\\u0085\\ufeff" is not/)
    const inside = new PlcError('BAD_VALUE', { item: 'M0', value: { '\u009b': ['\u2066'] }, reason: 'no' }).message
    assert.doesNotMatch(inside, /[\u009b\u2066]/)
  })

  it('Korean names and the marks of units stay as they are', () => {
    const { message } = new PlcError('BAD_VALUE', { item: '온도 °C', value: '20,5', reason: 'no' })
    assert.match(message, /온도 °C/)
  })

  it('are short whatever is shown, and made at once', () => {
    const many = Object.fromEntries(Array.from({ length: 5e4 }, (_, n) => [`key${n}`, n]))
    const nested = Array.from({ length: 40 }, () =>
      Array.from({ length: 40 }, () => Array.from({ length: 40 }, () => many))
    )
    const from = process.cpuUsage()
    for (const value of [many, nested, { many, nested }, 'x'.repeat(1e7)]) {
      const { message } = new PlcError('BAD_VALUE', { item: 'M0', value, reason: 'no' })
      assert.ok(message.length < 400, `${message.length} characters`)
    }
    const { user, system } = process.cpuUsage(from)
    assert.ok((user + system) / 1000 < 150, `${(user + system) / 1000} ms`)
  })
})
