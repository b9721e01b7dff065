'use strict'
const assert = require('node:assert/strict')
const { masterIdList, masterIds, DEFAULT_IDS } = require('../../../lib/codec/nx/ids')

describe('NX master IDs: the setting', () => {
  it('takes a number, a list, a range', () => {
    assert.deepEqual([...masterIdList(undefined)], [0xe2, 0xe3, 0xe4, 0xe5, 0xe6, 0xe7, 0xe8, 0xe9])
    assert.equal(masterIdList(''), DEFAULT_IDS)
    assert.equal(masterIdList(null), DEFAULT_IDS)
    assert.deepEqual([...masterIdList([0, 254])], [0, 254])
    assert.equal(masterIdList('0..254').length, 255)
    assert.deepEqual([...masterIdList('226..226')], [226])
    assert.deepEqual([...masterIdList(226)], [226])
    assert.deepEqual([...masterIdList('226')], [226])
    assert.deepEqual([...masterIdList('$E2..$E4')], [226, 227, 228])
    assert.deepEqual([...masterIdList('0xe2 .. 0xe4, 192, 226')], [226, 227, 228, 192])
    assert.deepEqual([...masterIdList([254, 192])], [254, 192])
  })

  it('takes a number of a station only if no station has it', () => {
    assert.deepEqual([...masterIdList('191', { stations: [1, 2] })], [191])
    assert.throws(() => masterIdList('2', { stations: [1, 2] }), { code: 'BAD_MASTER_ID' })
    assert.throws(() => masterIdList('191', { stations: [255] }), { code: 'BAD_MASTER_ID' })
    assert.deepEqual([...masterIdList('192', { stations: [255] })], [192])
  })

  it('refuses the rest', () => {
    for (const bad of [
      255,
      256,
      -1,
      1.5,
      NaN,
      '255',
      'x',
      '226..',
      '..',
      '228..226',
      '1..2..3',
      '0..999999999',
      [],
      [null],
      {},
      true
    ]) {
      assert.throws(() => masterIdList(bad), { code: 'BAD_MASTER_ID' }, String(bad))
    }
  })

  it('says why', () => {
    const stations = [2, 255]
    const bare = Object.create(null)
    assert.throws(() => masterIdList([bare]), {
      details: { id: 'object', reason: 'it must be a whole number from 0 to 254' }
    })
    const cases = [
      [[], '', 'give 1 to 255 numbers'],
      [new Array(256).fill(226), new Array(256).fill(226).join(), 'give 1 to 255 numbers'],
      [255, '255', 'it must be a whole number from 0 to 254'],
      ['226, x1', 'x1', 'it is not a number'],
      ['1x, 226', '1x', 'it is not a number'],
      ['1$', '1$', 'it is not a number'],
      [' 228..226 ', '228..226', 'it is not a range'],
      ['250..256', '250..256', 'it is not a range'],
      ['250..255', '255', 'it must be a whole number from 0 to 254'],
      [2, '2', 'a station of this line has this number'],
      [3, '3', 'with station 255 the number of the PLC is not known']
    ]
    for (const [value, id, reason] of cases) {
      assert.throws(() => masterIdList(value, { stations }), { code: 'BAD_MASTER_ID', details: { id, reason } })
    }
  })
})

describe('NX master IDs: the allocator', () => {
  const ids = [1, 2, 3].map(n => 223 + n)
  it('gives each query another one, in turn', () => {
    const all = masterIds({ ids, start: 4 })
    assert.deepEqual([all.take(), all.take(), all.take(), all.take()], [225, 226, 224, 225])
  })

  it('lets a failed one rest until it is freed', () => {
    const all = masterIds({ ids })
    all.failed(all.take())
    assert.deepEqual(all.resting(), [224])
    assert.deepEqual([all.take(), all.take(), all.take()], [225, 226, 225])
    all.free(224)
    assert.deepEqual([all.take(), all.take()], [226, 224])
  })

  it('uses the only one that does not rest, again and again', () => {
    const all = masterIds({ ids })
    all.failed(all.take())
    all.failed(all.take())
    assert.deepEqual([all.take(), all.take(), all.take()], [226, 226, 226])
    all.free(999)
    assert.deepEqual(all.resting(), [224, 225])
  })

  it('uses the one that has rested longest if all rest', () => {
    const all = masterIds({ ids })
    for (let i = 0; i < 3; i++) all.failed(all.take())
    assert.equal(all.take(), 224)
    all.ok(224)
    assert.deepEqual(all.resting(), [225, 226])
    all.free()
    assert.deepEqual(all.resting(), [])
  })

  it('goes on in turn behind the one it had to use', () => {
    const all = masterIds({ ids })
    for (const id of [all.take(), all.take(), all.take()].reverse()) all.failed(id)
    assert.equal(all.take(), 226)
    all.free()
    assert.equal(all.take(), 224)
  })

  it('a single one never rests', () => {
    const all = masterIds({ ids: [226] })
    all.failed(all.take())
    assert.deepEqual([all.take(), all.resting()], [226, []])
  })

  it('goes on after a redeploy where it was, also with other IDs', () => {
    const memory = {}
    const before = masterIds({ ids, memory })
    before.failed(before.take())
    const after = masterIds({ ids, start: 0, memory: JSON.parse(JSON.stringify(memory)) })
    assert.deepEqual([after.take(), after.take(), after.take()], [225, 226, 225])
    assert.equal(masterIds({ ids: [200, 201], start: 1, memory: { ...memory } }).take(), 201)
  })
})
