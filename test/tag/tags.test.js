'use strict'

const assert = require('node:assert/strict')
const fc = require('fast-check')
const { tagsFromCsv, tagsToCsv } = require('../../lib/tag/csv')
const { nxNotation } = require('../../lib/tag/nx-notation')
const { readTags } = require('../../lib/tag/tags')

const notation = nxNotation()
const read = rows => readTags(rows, notation)
const badTag = reason => error => error.code === 'BAD_TAG' && reason.test(error.message)

describe('tag table', () => {
  it('fills in defaults and reads numbers as text', () => {
    const tag = read([{ name: 'temp', address: 'K0', scale: '0.1', min: '', max: 80, writable: 'true' }]).get('temp')
    assert.deepEqual(
      { ...tag },
      {
        ...{ name: 'temp', label: '', address: 'K0', type: '', wordOrder: '', byteOrder: '', scale: 0.1, offset: 0 },
        ...{ unit: '', deadband: 0, writable: true, min: null, max: 80, maxStep: null }
      }
    )
  })

  const wrong = [
    [[{ name: '1a', address: 'M0' }], /1a.*letters/],
    [[{ name: 'a b', address: 'M0' }], /a b/],
    [[{ name: '온도', address: 'M0' }], /letters/],
    [[{ address: 'M0' }], /in row 1/],
    [[null], /in row 1/],
    [['M0'], /row of fields/],
    [{}, /not an array/],
    [
      [
        { name: 'a', address: 'M0' },
        { name: 'a', address: 'M1' }
      ],
      /row 2 has the same name/
    ],
    [[{ name: 'constructor', address: 'M0' }], /reserved/],
    [[JSON.parse('{"name":"__proto__","address":"M0"}')], /reserved/],
    [[{ name: 'toString', address: 'M0' }], /reserved/],
    [[{ name: 'a', address: 'M999' }], /outside its area/],
    [[{ name: 'a' }], /a is not valid/],
    [[{ name: 'a', address: 'M0', type: 'int8' }], /no such type/],
    [[{ name: 'a', address: 'M0:int16', type: 'float32' }], /its address says int16/],
    [[{ name: 'a', address: 'M0', scale: 0 }], /scale is 0/],
    [[{ name: 'a', address: 'M0', scale: 'x' }], /scale is "x"/],
    [[{ name: 'a', address: 'M0', scale: Infinity }], /scale/],
    [[{ name: 'a', address: 'M0', min: 5, max: 4 }], /min 5 is larger/],
    [[{ name: 'a', address: 'M0', deadband: -1 }], /deadband/],
    [[{ name: 'a', address: 'M0', deadband: '-2%' }], /deadband/],
    [[{ name: 'a', address: 'M0', deadband: '101%' }], /100 % at most/],
    [[{ name: 'a', address: 'M0', deadband: '%' }], /deadband is "%", not a number/],
    [[{ name: 'a', address: 'M0.1', scale: 2 }], /cannot be scaled/],
    [[{ name: 'a', address: 'M0.1', max: 1 }], /no min and max/],
    [[{ name: 'a', address: 'M0.1', maxStep: 1 }], /no maxStep/],
    [[{ name: 'a', address: 'M0:string[4]', maxStep: 1 }], /no maxStep/],
    [[{ name: 'a', address: 'M0', maxStep: 0 }], /maxStep is 0; leave it empty/],
    [[{ name: 'a', address: 'M0', maxStep: '-2' }], /maxStep is -2/],
    [[{ name: 'a', address: 'M0', maxStep: 'x' }], /maxStep is "x", not a number/],
    [[{ name: 'a', address: 'M0', wordOrder: 'big' }], /wordOrder/],
    [[{ name: 'a', address: 'M0', writable: 'maybe' }], /writable/],
    [[{ name: 'K5', address: 'M0' }], /its name is the address K5/]
  ]
  for (const [rows, reason] of wrong) {
    it(`refuses ${JSON.stringify(rows)}`, () => assert.throws(() => read(rows), badTag(reason)))
  }

  it('a deadband may be a percentage', () => {
    const deadband = text => read([{ name: 'a', address: 'M0', deadband: text }]).get('a')?.deadband
    assert.deepEqual(['2%', ' 2.50 % ', '0%', '100%', '2'].map(deadband), ['2%', '2.5%', 0, '100%', 2])
    const [row] = tagsFromCsv('name;address;deadband\na;M0;2,5%')
    assert.equal(row.deadband, '2.5%')
  })

  it('may be called like the address that it stands for', () => {
    assert.equal(read([{ name: 'K5', address: 'K5' }]).size, 1)
  })

  it('takes own properties only', () => {
    const row = Object.assign(Object.create({ writable: true, address: 'K9' }), { name: 'a', address: 'M0' })
    assert.equal(read([row]).get('a').writable, false)
  })

  it('too many are refused', () => {
    assert.throws(
      () => read(new Array(10001).fill({})),
      error => error.code === 'TOO_MANY'
    )
  })
})

describe('tag table as CSV', () => {
  it('reads what a spreadsheet writes', () => {
    const text = '\uFEFFName,Address,type,LABEL,other\r\ntemp,K0,int16,"Boiler, ""hot""\nside",x\r\n\r\nb,M0.1,,,\r\n'
    assert.deepEqual(tagsFromCsv(text), [
      { name: 'temp', address: 'K0', type: 'int16', label: 'Boiler, "hot"\nside' },
      { name: 'b', address: 'M0.1', type: '', label: '' }
    ])
  })

  it('reads semicolons with decimal commas, and tabs', () => {
    const [tag] = tagsFromCsv('name;address;scale;min;MaxStep;label\na;K0;0,1;-1,5;2,5;1,5 bar\n')
    assert.deepEqual(tag, { name: 'a', address: 'K0', scale: '0.1', min: '-1.5', maxStep: '2.5', label: '1,5 bar' })
    assert.deepEqual(tagsFromCsv('name\taddress\na\tK0'), [{ name: 'a', address: 'K0' }])
  })

  it('says what is wrong', () => {
    assert.throws(() => tagsFromCsv('name,label\na,b'), badTag(/address is missing/))
    assert.throws(() => tagsFromCsv(''), badTag(/name is missing/))
    assert.throws(() => tagsFromCsv('name,address\na,"K0'), badTag(/line 2.*quote/))
    assert.throws(() => tagsFromCsv('name,address\na,"K0"x\n'), badTag(/quote/))
  })

  it('comes back as it went out', () => {
    const label = fc.string({ unit: fc.constantFrom('a', '"', ',', ';', '\t', '\n', '\r\n', ' ', '온', "'", '\\') })
    const scale = fc.double({ min: 0.001, max: 1000, noNaN: true })
    const row = fc.record({ label, scale, writable: fc.boolean(), maxStep: fc.option(scale) })
    fc.assert(
      fc.property(fc.array(row, { maxLength: 8 }), fc.constantFrom(',', ';', '\t'), (rows, separator) => {
        const tags = [...read(rows.map((each, at) => ({ ...each, name: `t${at}`, address: `K${at}` }))).values()]
        const back = [...read(tagsFromCsv(tagsToCsv(tags, { separator }))).values()]
        assert.deepEqual(back, tags)
      })
    )
  })
})
