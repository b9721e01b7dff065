'use strict'

const assert = require('node:assert/strict')
const { PlcError } = require('../../lib')
const { verifyWritten } = require('../../lib/device/verify')

const word = (address, values) => ({
  kind: 'word',
  address,
  count: values.length,
  values,
  text: `W${address}`,
  through: false
})
const bit = (address, value) => ({
  kind: 'bit',
  address,
  count: 1,
  values: [value],
  text: `B${address}`,
  through: false
})
const out = count => Array.from({ length: count }, () => ({ outcome: 'confirmed' }))

/** A reader of the test: what each point holds by its text, or an error. */
const readerOf = held => {
  const asked = []
  const read = async points => {
    asked.push(points.map(({ text }) => text))
    if (held instanceof Error) throw held
    return points.map(({ text }) => (held[text] instanceof Error ? { error: held[text] } : { raw: held[text] }))
  }
  return { asked, reader: { read } }
}
const verify = async (points, held, fates = out(points.length)) => {
  const { asked, reader } = readerOf(held)
  await verifyWritten({ reader, station: 1, points, fates })
  return { asked, fates }
}
const words = fates => fates.map(({ outcome, error }) => [outcome, error?.code])

describe('read-back of what was written', () => {
  it('what the station holds confirms it, or not', async () => {
    const points = [word(1, [7]), word(2, [8, 0xabcd]), bit(99, true)]
    const { fates, asked } = await verify(points, { W1: [7], W2: [8, 1], B99: [false] })
    assert.deepEqual(asked, [['W1', 'W2', 'B99']])
    assert.deepEqual(words(fates), [
      ['confirmed', undefined],
      ['failed', 'VERIFY_FAILED'],
      ['failed', 'VERIFY_FAILED']
    ])
    const { item, got, expected } = fates[1].error.details
    assert.deepEqual([item, got, expected], ['W2', '8h 1h', '8h ABCDh'])
    assert.deepEqual([fates[2].error.details.got, fates[2].error.details.expected], ['false', 'true'])
  })

  it('of what was unknown: held, so confirmed; not held, so still unknown', async () => {
    const cause = new PlcError('TIMEOUT', { station: 1, timeout: 9 })
    const unknown = () => ({ outcome: 'unknown', error: cause })
    const { fates } = await verify([word(1, [7]), word(2, [8])], { W1: [7], W2: [9] }, [unknown(), unknown()])
    assert.deepEqual(words(fates), [
      ['confirmed', undefined],
      ['unknown', 'VERIFY_FAILED']
    ])
    assert.equal(fates[1].error.cause, cause)
  })

  it('what did not go out is not read; if nothing did, nothing is', async () => {
    const refused = { outcome: 'refused', error: new PlcError('READ_ONLY', { item: 'x', station: 1 }) }
    const { fates, asked } = await verify([word(1, [7]), word(2, [8])], { W2: [8] }, [{ ...refused }, ...out(1)])
    assert.deepEqual(
      [asked, words(fates)],
      [
        [['W2']],
        [
          ['refused', 'READ_ONLY'],
          ['confirmed', undefined]
        ]
      ]
    )
    assert.deepEqual((await verify([word(1, [7])], {}, [{ ...refused }])).asked, [])
  })

  it('what a later one overwrites is not compared: words, bits, bits of words, words of bits', async () => {
    const asked = async points => (await verify(points, new Error('not now'))).asked[0]
    assert.deepEqual(await asked([word(1, [7]), word(1, [8])]), ['W1'])
    assert.deepEqual(await asked([word(1, [7, 8]), word(2, [8])]), ['W2'])
    assert.deepEqual(await asked([bit(16, true), bit(16, false)]), ['B16'])
    assert.deepEqual(await asked([word(1, [7]), bit(16, true)]), ['B16'])
    assert.deepEqual(await asked([word(1, [7]), bit(31, true)]), ['B31'])
    assert.deepEqual(await asked([bit(31, true), word(1, [7])]), ['W1'])
    assert.deepEqual(await asked([word(1, [7]), bit(32, true)]), ['W1', 'B32'])
    assert.deepEqual(await asked([bit(15, true), word(1, [7]), bit(16, true)]), ['B15', 'B16'])
  })

  it('a value that cannot be read, or a reader that fails: unknown, never a rejection', async () => {
    const lost = new PlcError('TIMEOUT', { station: 1, timeout: 9 })
    const one = await verify([word(1, [7])], { W1: lost })
    assert.deepEqual(words(one.fates), [['unknown', 'WRITE_UNKNOWN']])
    const { item, reason } = one.fates[0].error.details
    assert.deepEqual([item, reason, one.fates[0].error.cause], ['W1', 'it could not be read back: TIMEOUT', lost])
    const all = await verify([word(1, [7]), word(2, [8])], new Error('a plan that cannot be made'))
    assert.deepEqual(words(all.fates), [
      ['unknown', 'WRITE_UNKNOWN'],
      ['unknown', 'WRITE_UNKNOWN']
    ])
    assert.equal(all.fates[0].error.details.reason, 'it could not be read back: BAD_ANSWER')
  })

  it('a bit that is written through its word is read through it', async () => {
    const through = { ...bit(0x35, true), through: true }
    const reader = {
      read: async ([point]) => [(assert.deepEqual([point.kind, point.address], ['word', 3]), { raw: [0x20] })]
    }
    const fates = out(1)
    await verifyWritten({ reader, station: 1, points: [through], fates })
    assert.deepEqual(words(fates), [['confirmed', undefined]])
  })
})
