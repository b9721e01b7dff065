'use strict'
const assert = require('node:assert/strict')
const { Lists } = require('../../lib/device/lists')
const { parseItem } = require('../../lib/tag/item')
const { nxNotation } = require('../../lib/tag/nx-notation')

const notation = nxNotation({})

/** Lists of an NX PLC that tell how many were taken apart. */
const create = () => {
  const bench = { parsed: 0 }
  const lists = new Lists(items => {
    bench.parsed++
    return /** @type {any[]} */ (items).map(item => parseItem(item, notation))
  })
  return Object.assign(bench, { of: items => lists.of(items) })
}

describe('lists of items that are read', () => {
  it('are taken apart once, and keep their points: plans are known by them', () => {
    const bench = create()
    const list = bench.of(['M0', 'K127.12'])
    assert.equal(bench.of(['M0', 'K127.12']), list)
    assert.deepEqual(
      list.points.map(({ kind, address, count }) => [kind, address, count]),
      [
        ['word', 0xc0, 1],
        ['bit', 16 * (0x140 + 127) + 12, 1]
      ]
    )
    assert.equal(bench.parsed, 1)
  })

  it('of other items, or in another order, are others', () => {
    const bench = create()
    const lists = [['M0', 'M1'], ['M1', 'M0'], ['M0'], ['M0', 'M0']]
    assert.deepEqual(
      lists.map(items => bench.of(items).points.map(({ address }) => address)),
      [[192, 193], [193, 192], [192], [192, 192]]
    )
    assert.equal(bench.parsed, 4)
  })

  it('that cannot be read are refused each time', () => {
    const bench = create()
    for (let n = 0; n < 2; n++) assert.throws(() => bench.of(['nothing']), { code: 'BAD_ADDRESS' })
    for (const items of [[7], 'M0', undefined, [['M0']]]) assert.throws(() => bench.of(items))
    assert.equal(bench.parsed, 6)
  })

  it('do not pile up: those of long ranges go', () => {
    const bench = create()
    const list = n => ['M0..M127', 'K0..K127', `M${n}`]
    for (let n = 0; n < 128; n++) bench.of(list(n))
    bench.of(list(127))
    assert.equal(bench.parsed, 128, 'the last ones are kept')
    bench.of(list(0))
    assert.equal(bench.parsed, 129)
  })
})
