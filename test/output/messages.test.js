'use strict'

const assert = require('node:assert/strict')
const { createReport, messagesOf } = require('../../lib')

const good = (name, value, more = {}) => ({
  name,
  item: name,
  value,
  quality: 'good',
  timestamp: 100,
  label: '',
  unit: '',
  deadband: 0,
  ...more
})
const bad = (name, more = {}) =>
  good(name, null, { quality: 'bad', code: 'TIMEOUT', text: 'no answer', timestamp: 120, ...more })
const element = (name, value) => ({ name, value, quality: 'good', timestamp: 100 })
const range = good('M0_M1', [1, true], { item: 'M0..M1', unit: 'V', elements: [element('M0', 1), element('M1', true)] })
const why = { code: 'TIMEOUT', text: 'no answer' }

describe('messages', () => {
  it('object: one message', () => {
    assert.deepEqual(messagesOf([good('a', 1), bad('b'), range], { device: 'press' }), [
      {
        payload: { a: 1, M0_M1: [1, true] },
        topic: 'press',
        timestamp: 120,
        quality: 'bad',
        device: 'press',
        bad: { b: why }
      }
    ])
  })

  it('object with null, numbers for booleans, single values', () => {
    const shape = { badValues: 'null', booleans: 'number', ranges: 'values', device: 'p' }
    const [message] = messagesOf([good('a', true), bad('b'), range], shape)
    assert.deepEqual(message.payload, { a: 1, b: null, M0: 1, M1: 1 })
  })

  it('no good value: nothing is sent, but as envelope or with null', () => {
    for (const format of ['object', 'message', 'list']) {
      assert.deepEqual(messagesOf([bad('b')], { format }), [])
      assert.equal(messagesOf([bad('b')], { format, badValues: 'null' }).length, 1)
    }
    const [message] = messagesOf([bad('b', { unit: '°C' })], { format: 'envelope' })
    assert.deepEqual(message.payload, { value: null, quality: 'bad', timestamp: 120, unit: '°C' })
    assert.deepEqual(message.bad, { b: why })
  })

  it('message: one per item, with parts for a join node', () => {
    const results = [good('a', 1, { label: '온도', unit: '°C' }), bad('b'), good('c', false)]
    const messages = messagesOf(results, { format: 'message', device: 'p', id: 'x' })
    assert.deepEqual(messages[0], {
      ...{ payload: 1, topic: 'a', timestamp: 100, quality: 'good', device: 'p', item: 'a', label: '온도', unit: '°C' },
      parts: { id: 'x', index: 0, count: 2, type: 'object', key: 'a' }
    })
    assert.equal(messages[1].payload, false)
    assert.deepEqual(messages[1].parts, { id: 'x', index: 1, count: 2, type: 'object', key: 'c' })
    assert.equal(messages.length, 2)
    assert.equal('bad' in messages[1], false)
  })

  it('list: what each value is stands beside it', () => {
    const [message] = messagesOf([good('a', 1, { unit: 'V' }), bad('b')], {
      format: 'list',
      badValues: 'null',
      device: 'p'
    })
    assert.deepEqual(message.payload, [
      { name: 'a', value: 1, quality: 'good', timestamp: 100, item: 'a', unit: 'V' },
      { name: 'b', value: null, quality: 'bad', timestamp: 120, item: 'b', ...why }
    ])
    assert.deepEqual([message.topic, message.quality], ['p', 'bad'])
  })

  it('a half bad range is left out as an array, and its good values are sent as values', () => {
    const half = { ...bad('M0_M1'), value: [1, null], elements: [element('M0', 1), { ...bad('M1') }] }
    assert.deepEqual(messagesOf([half]), [])
    assert.deepEqual(messagesOf([half], { badValues: 'null' })[0].payload, { M0_M1: [1, null] })
    const [message] = messagesOf([half], { ranges: 'values' })
    assert.deepEqual([message.payload, message.bad], [{ M0: 1 }, { M1: why }])
  })

  it('marks what is simulated, and has nothing to say about nothing', () => {
    assert.equal(messagesOf([good('a', 1)], { simulated: true })[0].simulated, true)
    assert.equal('simulated' in messagesOf([good('a', 1)])[0], false)
    for (const format of ['object', 'message', 'envelope', 'list']) assert.deepEqual(messagesOf([], { format }), [])
  })
})

describe('report by exception', () => {
  const names = results => results.map(({ name }) => name)

  it('all: everything each time', () => {
    const report = createReport()
    assert.deepEqual(names(report([good('a', 1)])), ['a'])
    assert.deepEqual(names(report([good('a', 1)])), ['a'])
  })

  it('changed: what changed, quality and code too', () => {
    const report = createReport({ report: 'changed' })
    assert.deepEqual(names(report([good('a', 1), good('b', 1)])), ['a', 'b'])
    assert.deepEqual(names(report([good('a', 1), good('b', 2)])), ['b'])
    assert.deepEqual(names(report([bad('a'), good('b', 2)])), ['a'])
    assert.deepEqual(names(report([bad('a'), good('b', 2)])), [])
    assert.deepEqual(names(report([bad('a', { code: 'CRC_ERROR' }), good('b', 2)])), ['a'])
    assert.deepEqual(names(report([good('a', 1), good('b', 2)])), ['a'])
    report.reset()
    assert.deepEqual(names(report([good('a', 1), good('b', 2)])), ['a', 'b'])
  })

  it('allOnChange: everything, if something changed', () => {
    const report = createReport({ report: 'allOnChange' })
    report([good('a', 1), good('b', 1)])
    assert.deepEqual(names(report([good('a', 1), good('b', 1)])), [])
    assert.deepEqual(names(report([good('a', 1), good('b', 2)])), ['a', 'b'])
  })

  it('a deadband counts from what was reported last: a slow drift is seen', () => {
    const report = createReport({ report: 'changed' })
    const seen = [10, 10.4, 10.8, 10.5, 11.1, 11.2, 9.9].filter(
      value => report([good('a', value, { deadband: 1 })]).length > 0
    )
    assert.deepEqual(seen, [10, 11.1, 9.9])
  })

  it('a deadband in percent is of the value that was reported last', () => {
    const report = createReport({ report: 'changed' })
    const seen = [100, 101.9, 98.1, 102.1, 104.1, 104.2, -100, -101.9, -102.1, 0, 0.001].filter(
      value => report([good('a', value, { deadband: '2%' })]).length > 0
    )
    assert.deepEqual(seen, [100, 102.1, 104.2, -100, -102.1, 0, 0.001])
  })

  it('maxSilence: what has not changed is reported again, at the cycle nearest to it', () => {
    const report = createReport({ report: 'changed', maxSilence: 1000 })
    const seen = []
    for (let now = 0; now <= 4000; now += 300) {
      seen.push(...report([good('a', 1), good('b', now < 600 ? 1 : 2)], now).map(({ name }) => `${name} ${now}`))
    }
    assert.deepEqual(
      seen.filter(each => each.startsWith('a')),
      ['a 0', 'a 900', 'a 1800', 'a 2700', 'a 3600']
    )
    assert.deepEqual(
      seen.filter(each => each.startsWith('b')),
      ['b 0', 'b 600', 'b 1500', 'b 2400', 'b 3300']
    )
  })

  it('maxSilence with allOnChange: everything again; a longer cycle reports each time', () => {
    const report = createReport({ report: 'allOnChange', maxSilence: 1000 })
    const at = now => names(report([good('a', 1), good('b', 1)], now))
    assert.deepEqual([0, 400, 800, 1200, 1600].map(at), [['a', 'b'], [], ['a', 'b'], [], ['a', 'b']])
    const slow = createReport({ report: 'changed', maxSilence: 100 })
    assert.deepEqual(
      [0, 5000, 10000].map(now => slow([good('a', 1)], now).length),
      [1, 1, 1]
    )
    const never = createReport({ report: 'changed' })
    assert.deepEqual(
      [0, 1e9].map(now => never([good('a', 1)], now).length),
      [1, 0]
    )
  })

  it('judges arrays value by value, and single values alone', () => {
    const at = value => ({ ...range, value: [1, value], elements: [element('M0', 1), element('M1', value)] })
    const arrays = createReport({ report: 'changed' })
    arrays([at(1)])
    assert.deepEqual(names(arrays([at(1)])), [])
    assert.deepEqual(names(arrays([at(2)])), ['M0_M1'])
    const values = createReport({ report: 'changed', ranges: 'values' })
    values([at(1)])
    assert.deepEqual(names(values([at(2)])), ['M1'])
  })
})
