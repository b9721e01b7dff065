'use strict'
const assert = require('node:assert/strict')
const { areaMap, AREAS } = require('../../../lib/codec/nx/areas')

const refused = (rows, reason) =>
  assert.throws(
    () => areaMap(rows),
    error => {
      assert.equal(error.code, 'BAD_AREA')
      assert.match(error.message, reason)
      return true
    }
  )

describe('NX areas', () => {
  it('has the map of the NX-CPU700p with the certainty of each row', () => {
    const rows = AREAS.map(({ area, base, words, as, certainty, writable }) => [
      area,
      base,
      words,
      as,
      certainty,
      writable
    ])
    assert.deepEqual(rows, [
      ['R', 0x000, 128, 'both', 'likely', true],
      ['L', 0x080, 64, 'both', 'likely', true],
      ['M', 0x0c0, 128, 'both', 'certain', true],
      ['K', 0x140, 128, 'both', 'certain', true],
      ['F', 0x1c0, 16, 'both', 'unconfirmed', false],
      ['TC', 0x1d0, 16, 'bits', 'unconfirmed', false],
      ['W', 0x200, 2048, 'words', 'unconfirmed', false],
      ['SV', 0xa00, 256, 'words', 'unconfirmed', false],
      ['PV', 0xb00, 256, 'words', 'unconfirmed', false],
      ['SR', 0xc00, 512, 'words', 'unconfirmed', false]
    ])
    assert.deepEqual(
      areaMap().list.map(row => row.area),
      ['R', 'L', 'M', 'K', 'F', 'TC', 'W', 'SV', 'PV', 'SR']
    )
  })

  it('says what each area is for', () => {
    for (const { area, note } of AREAS) assert.match(note, /^[a-z].{3,}$/i, area)
  })

  it('finds rows by name and by word address', () => {
    const areas = areaMap()
    assert.equal(areas.get('K').base, 0x140)
    assert.equal(areas.at(0x1bf).area, 'K')
    assert.equal(areas.at(0x1c0).area, 'F')
    assert.equal(areas.at(0x1e0), undefined)
    assert.equal(areas.get('Q'), undefined)
  })

  it('makes a confirmed row certain and writable', () => {
    const { certainty, writable, base, words } = areaMap([{ area: 'w', confirmed: true }]).get('W')
    assert.deepEqual(
      { certainty, writable, base, words },
      { certainty: 'certain', writable: true, base: 0x200, words: 2048 }
    )
    assert.equal(areaMap([{ area: 'W', confirmed: true, writable: false }]).get('W').writable, false)
    assert.equal(areaMap([{ area: 'M', writable: false }]).get('M').writable, false)
  })

  it('takes a changed or new row as unconfirmed and not writable', () => {
    const areas = areaMap([
      { area: 'M', base: '0xC0', words: '64' },
      { area: 'X', base: '$0E00', words: 16, as: 'bits', note: 'new' }
    ])
    assert.deepEqual({ ...areas.get('M') }, { ...AREAS[2], words: 64, certainty: 'unconfirmed', writable: false })
    assert.deepEqual(
      { ...areas.get('X') },
      { area: 'X', base: 0xe00, words: 16, as: 'bits', certainty: 'unconfirmed', writable: false, note: 'new' }
    )
  })

  it('keeps what a row with the same place knew', () => {
    assert.equal(areaMap([{ area: 'M', base: 0xc0, words: 128 }]).get('M').certainty, 'certain')
    assert.equal(areaMap([{ area: 'M', base: '', words: ' 128 ' }]).get('M').certainty, 'certain')
    assert.equal(areaMap([{ area: 'M', as: 'words' }]).get('M').certainty, 'unconfirmed')
    assert.equal(areaMap([{ area: 'M', base: 0xe00 }]).get('M').certainty, 'unconfirmed')
  })

  it('a row may reach to the last word, and one of contacts to the last bit', () => {
    assert.equal(areaMap([{ area: 'X', base: 0xe00, words: 0xf200 }]).at(0xffff).area, 'X')
    assert.equal(areaMap([{ area: 'X', base: 0xe00, words: 0x200, as: 'bits' }]).at(0xfff).area, 'X')
    const [first] = areaMap([
      ...AREAS.map(({ area }) => ({ area, remove: true })),
      { area: 'X', base: 0, words: 65536 }
    ]).list
    assert.equal(first.words, 65536)
  })

  it('has no note unless one is given; a long one is cut', () => {
    assert.equal(areaMap([{ area: 'X', base: 0xe00, words: 1 }]).get('X').note, '')
    assert.equal(areaMap([{ area: 'M', note: 'x'.repeat(101) }]).get('M').note, 'x'.repeat(100))
  })

  it('removes rows, so that another map fits', () => {
    const areas = areaMap([
      { area: 'SV', remove: true },
      { area: 'W', base: 0x200, words: 0x900, confirmed: true }
    ])
    assert.equal(areas.get('SV'), undefined)
    assert.equal(areas.at(0xaff).area, 'W')
  })

  it('does not change the standard map', () => {
    areaMap([{ area: 'M', base: 0x1000, words: 1 }])
    assert.equal(areaMap().get('M').base, 0xc0)
    assert.throws(() => {
      AREAS[0].base = 1
    }, TypeError)
  })

  it('refuses with the reason', () => {
    refused('M', /not a list/)
    refused([{ area: 'M', base: 0x0c0, words: 129 }], /K \(\$0140\.\.\$01BF\) overlaps M/)
    refused([{ area: 'X', base: 0x1df, words: 1 }], /overlaps/)
    refused([{ area: 'X', base: 0xffff, words: 2 }], /after the last word/)
    refused([{ area: 'X', base: 0x1000, words: 1, as: 'bits' }], /use "as": "words"/)
    refused([{ area: 'X', base: 0xe00, words: 0 }], /at least one word/)
    refused([{ area: 'X', base: 0xe00 }], /"words" must be/)
    refused([{ area: 'X', base: -1, words: 1 }], /"base" must be/)
    refused([{ area: 'X', base: 1.5, words: 1 }], /"base" must be/)
    refused([{ area: 'X', base: NaN, words: 1 }], /"base" must be/)
    refused([{ area: 'X', base: '0x', words: 1 }], /"base" must be/)
    refused([{ area: 'X', base: [0xe00], words: 1 }], /"base" must be/)
    refused([{ area: 'X', base: 0xe00, words: 1, as: 'all' }], /"as" must be/)
    refused([{ area: 'W', confirmed: 'yes' }], /"confirmed" must be true or false/)
    refused([{ area: 'W', writable: true }], /only if it is confirmed/)
    refused([{ area: 'X', remove: true }], /no such area/)
    refused([{ area: 'M' }, { area: 'm' }], /two rows/)
    refused([{ area: 'W', confirmd: true }], /unknown property confirmd/)
    refused([{ area: 'W', note: 5 }], /note/)
    refused(new Array(65).fill({ area: 'M' }), /at most 64/)
    refused(new Array(64).fill({ area: 'M' }), /two rows/)
    refused('M', /table/)
    refused(new Array(65), /table/)
    refused([7], /\?/)
    for (const base of ['0x1C0x', 'x0x1C0', '1C0', '0$1', '12.5'])
      refused([{ area: 'X', base, words: 1 }], /"base" must be/)
    refused([{ area: 'X', base: 0x10001, words: 1 }], /"base" must be/)
    refused([{ area: 'X', base: 0x10000, words: 1 }], /after the last word/)
    refused([{ area: 'X', base: '', words: 1 }], /"base" must be/)
  })

  it('refuses hostile rows', () => {
    for (const area of [
      '',
      'ABCDE',
      'M1',
      'M.',
      '@',
      '__proto__',
      'constructor',
      'Ｍ',
      7,
      null,
      undefined,
      {},
      ['M']
    ]) {
      refused([{ area, base: 0xe00, words: 1 }], /1 to 4 letters/)
    }
    for (const row of [null, undefined, 7, 'M', [], () => {}]) refused([row], /must be an object/)
    refused([JSON.parse('{"area":"M","__proto__":{"confirmed":true}}')], /unknown property __proto__/)
    refused([Object.create({ area: 'M', base: 0xe00, words: 1 })], /1 to 4 letters/)
    const inherited = areaMap([Object.assign(Object.create({ confirmed: true }), { area: 'W' })])
    assert.equal(inherited.get('W').writable, false)
  })
})
