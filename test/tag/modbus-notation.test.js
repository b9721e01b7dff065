'use strict'

const assert = require('node:assert/strict')
const { tagsFromCsv, tagsToCsv, csvWarnings } = require('../../lib/tag/csv')
const { distinctNames, parseItem } = require('../../lib/tag/item')
const { modbusNotation } = require('../../lib/tag/modbus-notation')
const { nxNotation } = require('../../lib/tag/nx-notation')
const { decodeValue, encodeValue } = require('../../lib/tag/value')

const notation = modbusNotation()
const item = (text, of = notation) => parseItem(text, of)
const code = expected => error => error.code === expected
const told = (expected, pattern) => error => error.code === expected && pattern.test(error.message)

describe('items of a MODBUS station', () => {
  // text, name, kind, absolute, values, type
  const known = [
    ['400108', '_400108', 'word', 107, 1, 'uint16'],
    ['40108', '_400108', 'word', 107, 1, 'uint16'],
    ['hr107', 'hr107', 'word', 107, 1, 'uint16'],
    ['hr107:float32', 'hr107', 'word', 107, 1, 'float32'],
    ['400108:string[8]', '_400108', 'word', 107, 1, 'string[8]'],
    ['300009', '_300009', 'word', 0x10008, 1, 'uint16'],
    ['001001', '_001001', 'bit', 0x2003e8, 1, 'bool'],
    ['101001', '_101001', 'bit', 0x2103e8, 1, 'bool'],
    ['401001.05', '_401001_05', 'bit', 16005, 1, 'bool'],
    ['hr0..hr9', 'hr0_hr9', 'word', 0, 10, 'uint16'],
    ['400001..400010:float32', '_400001_400010', 'word', 0, 5, 'float32'],
    ['001001..001016', '_001001_001016', 'bit', 0x2003e8, 16, 'bool'],
    ['401001.00..401001.15', '_401001_00_401001_15', 'bit', 16000, 16, 'bool'],
    ['001001:uint16', '_001001', 'bit', 0x2003e8, 1, 'uint16'],
    ['101001:int32', '_101001', 'bit', 0x2103e8, 1, 'int32'],
    ['co8..co39:uint16', 'co8_co39', 'bit', 0x200008, 2, 'uint16'],
    ['465535:int32', '_465535', 'word', 65534, 1, 'int32'],
    ['065521:uint16', '_065521', 'bit', 0x20fff0, 1, 'uint16'],
    ['065505:uint32', '_065505', 'bit', 0x20ffe0, 1, 'uint32']
  ]
  for (const [text, name, kind, address, count, type] of known) {
    it(text, () => {
      const each = item(text)
      assert.deepEqual(
        [each.name, each.kind, each.address, each.count, each.type.name, each.range],
        [name, kind, address, count, type, count > 1]
      )
      assert.equal(each.packed, kind === 'bit' && type !== 'bool')
      assert.equal(each.throughWord, /\d\.\d/.test(text))
      assert.equal(each.areaWritable, !/^[13]/.test(text))
      assert.match(each.name, /^[A-Za-z_]\w*$/)
      assert.equal(each.wordOrder, 'low')
    })
  }

  it('names each value of a range as the whole was written', () => {
    const elements = text => item(text).elements.map(({ name, text: of }) => `${name} ${of}`)
    assert.deepEqual(elements('hr8..hr10'), ['hr8 hr8', 'hr9 hr9', 'hr10 hr10'])
    assert.deepEqual(elements('40008..40009'), ['_400008 400008', '_400009 400009'])
    assert.deepEqual(elements('hr0..hr3:float32'), ['hr0 hr0', 'hr2 hr2'])
    assert.deepEqual(elements('401001.15..401002.00'), ['_401001_15 401001.15', '_401002_00 401002.00'])
    assert.deepEqual(elements('co8..co39:uint16'), ['co8 co8', 'co24 co24'])
    assert.deepEqual(parseItem('400000..400001', modbusNotation({ addressMode: '0-base' })).elements[1].text, '400001')
  })

  const wrong = [
    ['465536:int32', 'OUT_OF_AREA', /465536 has 1 words from there, int32 takes 2/],
    ['365536:float32', 'OUT_OF_AREA', /takes 2/],
    ['065522:uint16', 'OUT_OF_AREA', /15 bits from there, uint16 takes 16/],
    ['065506:uint32', 'OUT_OF_AREA', /31 bits from there, uint32 takes 32/],
    ['165522:int16', 'OUT_OF_AREA', /takes 16/],
    ['001001..001020:uint16', 'BAD_TYPE', /20 bits, which is no multiple of 16/],
    ['001001:string[2]', 'BAD_TYPE', /bool and all numbers/],
    ['401001.00:uint16', 'BAD_TYPE', /is a bit, which is bool/],
    ['401001:bool', 'BAD_TYPE', /needs a bit/],
    ['401001.1', 'BAD_ADDRESS', /two digits/],
    ['4001', 'BAD_ADDRESS', /zero in front/],
    ['M0', 'BAD_ADDRESS', /400108/],
    [400108, 'BAD_ITEMS', /not the number 400108: write the address in quotes/],
    ['', 'BAD_ITEMS', /400108/],
    [null, 'BAD_ITEMS', /400108/]
  ]
  for (const [text, expected, pattern] of wrong) {
    it(`refuses ${JSON.stringify(text)}: ${expected}`, () => assert.throws(() => item(text), told(expected, pattern)))
  }

  it('keeps keys apart: a number on coils is the typed one', () => {
    const names = (...texts) => distinctNames(texts.map(text => item(text))).map(each => each.name)
    assert.deepEqual(names('001001', '001001:uint16'), ['_001001', '_001001_uint16'])
    assert.deepEqual(names('400108', '400108:int16', '40108'), ['_400108', '_400108_int16', '_400108'])
    assert.deepEqual(names('400108', 'hr107'), ['_400108', 'hr107'])
  })

  it('numbers have their low word first, strings their high byte; settable', () => {
    assert.deepEqual(decodeValue(item('400001:uint32'), [0x5678, 0x1234]), { value: 0x12345678 })
    assert.deepEqual(encodeValue(item('400001:string[2]'), 'AB'), [[0x4142]])
    const other = modbusNotation({ wordOrder: 'high', byteOrder: 'low' })
    assert.deepEqual(decodeValue(item('400001:uint32', other), [0x1234, 0x5678]), { value: 0x12345678 })
    assert.deepEqual(encodeValue(item('400001:string[2]', other), 'AB'), [[0x4241]])
  })

  it('the address mode', () => {
    assert.equal(item('400108', modbusNotation({ addressMode: '0-base' })).address, 108)
    assert.equal(item('hr107', modbusNotation({ addressMode: '0-base' })).address, 107)
    assert.throws(() => modbusNotation({ addressMode: '2-base' }), told('BAD_SETTING', /1-base or 0-base/))
  })
})

describe('tags of a MODBUS station', () => {
  const table = tags => modbusNotation({ tags })
  const of = tag => item(tag.name, table([tag]))

  it('have addresses, types, scale and limits as everywhere', () => {
    const output = of({ name: 'output', address: '400001', type: 'int16', scale: 0.1, min: 0, max: 100, unit: '%' })
    assert.deepEqual([output.address, output.unit, output.elements[0].text], [0, '%', 'output'])
    assert.deepEqual(encodeValue(output, 12.3), [[123]])
    assert.throws(() => encodeValue(output, 100.1), code('VALUE_OUT_OF_RANGE'))
  })

  it('a range of a tag is numbered', () => {
    assert.deepEqual(
      of({ name: 'zone', address: 'hr4..hr5' }).elements.map(each => each.name),
      ['zone_0', 'zone_1']
    )
  })

  it('a number on coils may be scaled and limited', () => {
    const stage = of({ name: 'stage', address: '001001', type: 'uint16', scale: 0.5, max: 10 })
    assert.deepEqual([stage.packed, encodeValue(stage, 4)], [true, [[8]]])
  })

  it('a name that is an address of another place is refused', () => {
    assert.throws(() => table([{ name: 'co2', address: '400108' }]), told('BAD_TAG', /its name is the address co2/))
    assert.equal(table([{ name: 'co2', address: '000003' }]).tags?.size, 1)
  })

  it('a writable tag on a table that is only read stays what it is: its item says so', () => {
    assert.equal(of({ name: 'a', address: '300001', writable: true }).areaWritable, false)
    assert.equal(of({ name: 'a', address: '400001.05', writable: true }).areaWritable, true)
    assert.equal(of({ name: 'a', address: '300001.05', writable: true }).areaWritable, false)
  })

  const wrong = [
    [{ name: 'a', address: '4001' }, /zero in front/],
    [{ name: 'a', address: '465536', type: 'float32' }, /takes 2/],
    [{ name: 'a', address: '' }, /empty/],
    [{ name: 'a', address: '401001.5' }, /two digits/]
  ]
  for (const [row, pattern] of wrong) {
    it(`refuses ${JSON.stringify(row)}`, () => assert.throws(() => table([row]), told('BAD_TAG', pattern)))
  }
})

describe('what a spreadsheet ate', () => {
  const warned = row => csvWarnings([{ name: 'a', ...row }], notation)
  const doubts = [
    [{ address: '10197' }, /10197 may have been 010197/],
    [{ address: '40108' }, /may have been 040108/],
    [{ address: '1001' }, /1001 may have been 001001/],
    [{ address: '1' }, /1 may have been 000001/],
    [{ address: '1001:uint16' }, /001001/],
    [{ address: '1001..1016' }, /001001/],
    [{ address: 1001 }, /001001/],
    [{ address: '401001.1' }, /401001\.1 may have been 401001\.10/],
    [{ address: '40108.1' }, /40108\.1 may have been 40108\.10/],
    [{ address: '401001', type: 'bool' }, /may have been the bit 401001\.00/],
    [{ address: '401001:bool' }, /may have been the bit 401001\.00/]
  ]
  for (const [row, pattern] of doubts) {
    it(`warns of ${JSON.stringify(row)}`, () => {
      const [first] = warned(row)
      assert.deepEqual([first.name, first.address], ['a', String(row.address)])
      assert.match(first.text, pattern)
    })
  }

  it('warns of each end of a range', () => {
    assert.deepEqual(
      warned({ address: '1001..1016' }).map(({ text }) => text.slice(0, 4)),
      ['1001', '1016']
    )
  })

  it('is silent about what is whole', () => {
    for (const address of [
      '400108',
      '001001',
      '401001.10',
      '401001.05',
      'hr107',
      'hr107.05',
      '00020',
      '90001',
      '70000',
      '',
      'x',
      undefined
    ]) {
      assert.deepEqual(warned({ address }), [], String(address))
    }
    assert.deepEqual(warned({ address: '400108', type: 'float32' }), [])
    assert.deepEqual(csvWarnings([null, {}], notation), [])
  })

  it('of an NX PLC there is nothing to eat', () => {
    assert.deepEqual(
      csvWarnings(
        [
          { name: 'a', address: 'K5' },
          { name: 'b', address: '1001' }
        ],
        nxNotation()
      ),
      []
    )
  })

  it('addresses survive the way through a CSV', () => {
    const rows = [
      { name: 'a', address: '010197' },
      { name: 'b', address: '401001.10' }
    ]
    assert.deepEqual(
      tagsFromCsv(tagsToCsv(rows)).map(({ address }) => address),
      ['010197', '401001.10']
    )
  })
})
