'use strict'

const assert = require('node:assert/strict')
const vm = require('node:vm')
const { entriesOf, itemsOf } = require('../../lib')

const code = expected => error => error.code === expected

describe('what a message writes', () => {
  it('the payload to the fixed target, whatever the topic says', () => {
    assert.deepEqual(entriesOf({ payload: '5', topic: 'K9' }, { target: ' K0 ' }), [{ item: 'K0', value: '5' }])
    assert.deepEqual(entriesOf({ payload: [1, 2] }, { target: 'K0..K1' }), [{ item: 'K0..K1', value: [1, 2] }])
  })

  it('the pairs of an object, also of one made in a function node', () => {
    const expected = [
      { item: 'K0', value: 5 },
      { item: 'K127.12', value: true }
    ]
    assert.deepEqual(entriesOf({ payload: { K0: 5, 'K127.12': true } }), expected)
    assert.deepEqual(entriesOf({ payload: vm.runInNewContext("({ K0: 5, 'K127.12': true })") }), expected)
  })

  it('the payload to the item that the topic names', () => {
    assert.deepEqual(entriesOf({ payload: 'on', topic: 'K0.1' }), [{ item: 'K0.1', value: 'on' }])
    assert.deepEqual(entriesOf({ payload: 0, topic: 'K0' }), [{ item: 'K0', value: 0 }])
  })

  const refused = [
    [{ payload: '', topic: 'K0' }, 'BAD_VALUE'],
    [{ payload: '  ', topic: 'K0' }, 'BAD_VALUE'],
    [{ payload: null, topic: 'K0' }, 'BAD_VALUE'],
    [{ topic: 'K0' }, 'BAD_VALUE'],
    [{ payload: NaN, topic: 'K0' }, 'BAD_VALUE'],
    [{ payload: Infinity, topic: 'K0' }, 'BAD_VALUE'],
    [{ payload: [], topic: 'K0' }, 'BAD_VALUE'],
    [{ payload: [1, null], topic: 'K0' }, 'BAD_VALUE'],
    [{ payload: Buffer.from('5'), topic: 'K0' }, 'BAD_VALUE'],
    [{ payload: new Date(0), topic: 'K0' }, 'BAD_VALUE'],
    [{ payload: () => 5, topic: 'K0' }, 'BAD_VALUE'],
    [{ payload: { K0: {} } }, 'BAD_VALUE'],
    [{ payload: { K0: null } }, 'BAD_VALUE'],
    [{ payload: {} }, 'NOTHING_TO_WRITE'],
    [{ payload: 5 }, 'NOTHING_TO_WRITE'],
    [{ payload: 5, topic: '' }, 'NOTHING_TO_WRITE'],
    [{ payload: 5, topic: {} }, 'NOTHING_TO_WRITE'],
    [{ payload: 5, topic: 'K'.repeat(1000) }, 'NOTHING_TO_WRITE'],
    [Object.create({ payload: { K0: 1 } }), 'NOTHING_TO_WRITE'],
    [null, 'NOTHING_TO_WRITE'],
    [{ payload: Object.fromEntries(Array.from({ length: 1001 }, (_, at) => [`K${at}`, 1])) }, 'TOO_MANY']
  ]
  refused.forEach(([msg, expected], at) => {
    it(`refuses number ${at}: ${expected}`, () => assert.throws(() => entriesOf(msg), code(expected)))
  })

  it('an address that came as a number has lost its zeros: write it in quotes', () => {
    const hinted = error => /the number 400108; write the address in quotes/.test(error.message)
    assert.throws(() => entriesOf({ payload: 5, topic: 400108 }), hinted)
    assert.throws(() => itemsOf(['400001', 400108]), hinted)
    assert.throws(() => itemsOf(['400001', {}]), /number 2 is no text/)
  })

  it('takes own properties only; a hostile key is a name like any other', () => {
    const payload = JSON.parse('{"__proto__": 5, "constructor": 6}')
    assert.deepEqual(entriesOf({ payload }), [
      { item: '__proto__', value: 5 },
      { item: 'constructor', value: 6 }
    ])
  })
})

describe('what a message reads', () => {
  it('an array of texts, or one text', () => {
    assert.deepEqual(itemsOf(['M0 ', 'W10:float32']), ['M0', 'W10:float32'])
    assert.deepEqual(itemsOf('M0..M3, K127.12\nW20:string[8];temp,'), ['M0..M3', 'K127.12', 'W20:string[8]', 'temp'])
  })

  for (const given of [
    undefined,
    null,
    5,
    {},
    [],
    '',
    ' , ',
    [5],
    [''],
    [null],
    new Array(3),
    ['M'.repeat(201)],
    'M'.repeat(100001)
  ]) {
    it(`refuses ${String(JSON.stringify(given)).slice(0, 30)}`, () =>
      assert.throws(() => itemsOf(given), code('BAD_ITEMS')))
  }

  it('too many are refused', () => {
    assert.throws(() => itemsOf(new Array(1001).fill('M0')), code('TOO_MANY'))
  })
})
