'use strict'
const assert = require('node:assert/strict')
const { notationWithTags, parseItem } = require('../../scripts/editor/model')
const { areaFault } = require('../../scripts/editor/areas')
const { merged } = require('../../scripts/editor/table')
const { offersFor } = require('../../scripts/editor/widgets')

/** What the dialogs decide without a page. */

describe('suggestions while typing', () => {
  const tags = [
    { value: 'temperature', hint: 'M10 · °C' },
    { value: 'M1_load', hint: 'W3' }
  ]
  const values = (text, usable) => offersFor(text, tags, () => usable).map(({ value }) => value)

  it('an address that is complete comes first, since Tab and Enter take the first offer', () => {
    assert.deepEqual(values('M1', true), ['M1', 'temperature', 'M1_load'])
    assert.deepEqual(values(' M10 ', true), ['M10', 'temperature'])
  })

  it('what is no address yet is completed', () => assert.deepEqual(values('temp', false), ['temperature']))

  it('nothing is offered for what needs no help', () => {
    assert.deepEqual(values('temperature', true), [])
    assert.deepEqual(values('K0', true), [])
  })

  it('an empty field offers all', () => assert.deepEqual(values('', true), ['temperature', 'M1_load']))
})

describe('rows of a table', () => {
  const saved = { address: 'K0', name: 'sp', scale: 0.1, offset: 0, min: '', writable: false, byteOrder: 'high' }
  const cells = { name: 'sp', address: 'K0', scale: '0.1', offset: '0', min: '', max: '', unit: '', writable: false }

  it('looked at, not touched: the very same row, numbers, order and unknown columns too', () => {
    assert.equal(JSON.stringify(merged(saved, cells)), JSON.stringify(saved))
  })

  it('a flag that was saved as a text is no change', () => {
    assert.deepEqual(merged({ name: 'a', writable: 'true' }, { name: 'a', writable: true }), {
      name: 'a',
      writable: 'true'
    })
  })

  it('what changes, changes alone', () => {
    assert.deepEqual(merged(saved, { ...cells, scale: '0.5', writable: true }), {
      ...saved,
      scale: '0.5',
      writable: true
    })
  })

  it('a cell made empty goes, a new row has no empty cells', () => {
    const { scale, ...rest } = saved
    assert.equal(scale, 0.1)
    assert.deepEqual(merged(saved, { ...cells, scale: '' }), rest)
    assert.deepEqual(merged({}, cells), { name: 'sp', address: 'K0', scale: '0.1', offset: '0' })
  })
})

describe('the area table', () => {
  const w = { area: 'W', words: '512' }
  const d = { area: 'D', base: '0x600', words: '512', as: 'words' }

  it('a row is judged with the others: D fits where W was made shorter', () => {
    assert.equal(areaFault(d, [w, d]), null)
    assert.equal(areaFault(w, [w, d]), null)
  })

  it('an overlap is said at the rows that overlap, not at others', () => {
    const k = { area: 'K', confirmed: true }
    const m = { area: 'M', base: '0x1C8' }
    assert.equal(areaFault(d, [k, d])?.code, 'BAD_AREA')
    assert.equal(areaFault(k, [k, d]), null)
    // the error names F, a standard area; the row that moved says it
    const r = { area: 'R', base: '0x1B8' }
    assert.equal(areaFault(r, [r, m])?.code ?? areaFault(m, [r, m])?.code, 'BAD_AREA')
  })
})

describe('items in the dialogs of the flow', () => {
  it('a faulty tag does not hide the others, as at run time', () => {
    const tags = [
      { name: '1st', address: 'M0' },
      { name: 'level', address: 'W10', type: 'float32' },
      { name: 'level', address: 'W20' },
      null
    ]
    const notation = notationWithTags({ areas: [], tags })
    assert.equal(parseItem('level', notation).address, 0x20a)
    assert.deepEqual([...notation.tags.keys()], ['level'])
  })

  it('a faulty area table counts as the standard one', () => {
    const plc = { areas: [{ area: 'M', base: '0x1C8' }], tags: [{ name: 'level', address: 'M10' }] }
    assert.equal(parseItem('level', notationWithTags(plc)).address, 0x0ca)
  })

  it('no PLC, no table', () => {
    assert.equal(notationWithTags(null).tags.size, 0)
    assert.equal(notationWithTags({ tags: 'x', areas: 7 }).tags.size, 0)
  })
})
