'use strict'
const assert = require('node:assert/strict')
const { describeAddress } = require('../../lib/codec/modbus/address')
const { cause } = require('../../lib/device/diagnosis/causes')
const { PlcError } = require('../../lib/error')
const { sentences } = require('../../scripts/editor/device')
const { outputRole } = require('../../scripts/editor/flow')
const { describe: describeItem, notationWithTags, parseItem } = require('../../scripts/editor/model')
const { areaFault } = require('../../scripts/editor/areas')
const { merged } = require('../../scripts/editor/table')
const { doubtOf, missingRows } = require('../../scripts/editor/tags')
const { offersFor } = require('../../scripts/editor/widgets')
const { translator } = require('./dialogs')

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

describe('what goes out for an address of a regulator', () => {
  const chino = more => ({ type: 'chino-config', addressMode: '1-base', ...more })
  const inLanguage = (language, run) => {
    const before = globalThis.RED
    globalThis.RED = { _: translator(language) }
    try {
      return run()
    } finally {
      globalThis.RED = before
    }
  }
  const said = (text, { language = 'en-US', write, ...more } = {}) =>
    inLanguage(language, () => describeItem(parseItem(text, notationWithTags(chino(more))), chino(more), { write }))

  for (const [text, options, expected] of [
    ['400108', {}, 'function 03, wire address 107 (006Bh)'],
    ['400107', { addressMode: '0-base' }, 'function 03, wire address 107 (006Bh)'],
    ['hr107', { addressMode: '0-base' }, 'function 03, wire address 107 (006Bh)'],
    ['40108..40111', {}, 'function 03, wire addresses 107–110 (006Bh–006Eh)'],
    ['400108:float32', {}, 'function 03, wire addresses 107–108 (006Bh–006Ch)'],
    ['300009', {}, 'function 04, wire address 8 (0008h)'],
    ['010197', {}, 'function 01, wire address 10196 (27D4h)'],
    ['110197', {}, 'function 02, wire address 10196 (27D4h)'],
    ['401001.15', {}, 'function 03, wire address 1000 (03E8h), bit 15'],
    ['001001:uint16', {}, 'function 01, wire addresses 1000–1015 (03E8h–03F7h)'],
    ['001001:uint32', { write: true }, 'function 0F, wire addresses 1000–1031 (03E8h–0407h)'],
    ['400108', { write: true }, 'function 10, wire address 107 (006Bh)'],
    ['400108', { write: true, holdingFunction: '06' }, 'function 06, wire address 107 (006Bh)'],
    ['400108', { write: true, holdingFunction: 'auto' }, 'function 06, wire address 107 (006Bh)'],
    ['400108:uint32', { write: true, holdingFunction: 'auto' }, 'function 10, wire addresses 107–108 (006Bh–006Ch)'],
    ['co19', { write: true, coilFunction: '05' }, 'function 05, wire address 19 (0013h)'],
    ['co19..co20', { write: true, coilFunction: 'auto' }, 'function 0F, wire addresses 19–20 (0013h–0014h)'],
    ['401001.15', { write: true }, 'functions 03 and 10, read-modify-write of wire address 1000 (03E8h)']
  ]) {
    it(`${text} ${JSON.stringify(options)}: ${expected}`, () => {
      assert.equal(said(text, options), expected)
      const { addressText } = parseItem(text, notationWithTags(chino(options)))
      const place = notationWithTags(chino(options)).parse(addressText)
      // without a type the library says the same
      if (!text.includes(':')) assert.equal(describeAddress(place, options), expected)
    })
  }

  it('in Korean', () => {
    assert.equal(said('400108', { language: 'ko' }), '기능 코드 03, 통신 주소 107 (006Bh)')
  })

  it('the tags of a regulator are known by their names, faulty ones left out', () => {
    const tags = [
      { name: 'empty', address: '' },
      { name: 'current', address: '300003' }
    ]
    assert.deepEqual([...notationWithTags({ type: 'chino-config', tags }).tags.keys()], ['current'])
  })

  it('the template adds only the rows that are not there, without an address', () =>
    inLanguage('en-US', () => {
      const rows = missingRows([{ name: 'gradient', address: '400002' }])
      assert.deepEqual(
        rows.map(({ name }) => name),
        ['manual_output', 'elevation', 'load_voltage', 'load_current', 'load_power', 'load_resistance', 'alarm']
      )
      assert.ok(rows.every(({ address, label }) => address === '' && /^[A-Z]/.test(label)))
    }))

  it('the import says what a spreadsheet may have eaten', () =>
    inLanguage('en-US', () => {
      const notation = notationWithTags({ type: 'chino-config' })
      assert.match(doubtOf([{ name: 'run', address: '10197' }], notation), /run: 10197 may have been 010197/)
      assert.equal(doubtOf([{ name: 'run', address: '010197' }], notation), '')
      assert.equal(doubtOf([{ name: 'm', address: 'M10' }], notationWithTags({ type: 'nx-config' })), '')
    }))

  it('each output of each mode has its role', () => {
    const roles = mode => [0, 1, 2].map(index => outputRole(mode, index))
    assert.deepEqual(roles('read'), ['values', undefined, undefined])
    assert.deepEqual(roles('write'), ['confirmed', 'failed', undefined])
    assert.deepEqual(roles('both'), ['values', 'confirmed', 'failed'])
    assert.deepEqual(roles('${MODE}'), roles('read'))
  })
})

describe('what Test says', () => {
  const saysIn = (language, answer) => {
    const before = globalThis.RED
    globalThis.RED = { _: translator(language) }
    try {
      return sentences(answer).join('\n')
    } finally {
      globalThis.RED = before
    }
  }
  const says = answer => saysIn('en-US', answer)
  const failure = (code, details, more) => {
    const { message } = new PlcError(code, details)
    return { ok: false, error: { code, message, details }, ...more }
  }
  const silent = (found, facts) => failure('TIMEOUT', { station: 12, timeout: 400 }, { cause: cause(found, facts) })

  it('the value', () =>
    assert.equal(
      says({ ok: true, station: 11, ms: 7, item: 'hr0', value: 35 }),
      'Station 11 answers in 7 ms: hr0 = 35.'
    ))

  it('connected, but it does not have what nobody asked for', () => {
    const said = says({ ok: true, station: 11, ms: 7, item: 'hr0', value: null })
    assert.match(said, /^Connected: station 11 answers, but it does not have hr0\./)
  })

  it('the cause brings its own remedy, the general one is left out', () => {
    const said = says(silent('NO_BYTES', { station: 12, waited: 1408, hint: '' }))
    const [first, likely, ...more] = said.split('\n')
    assert.equal(first, 'Station 12 did not answer within 400 ms.')
    assert.match(likely, /^Likely cause: Not one byte came back from station 12 within 1408 ms\. Check power/)
    assert.deepEqual(more, [])
  })

  it('a cause that is the error itself is said once', () => {
    const answer = failure('PORT_NOT_FOUND', { path: '/dev/ttyUSB7' })
    const { message, code } = answer.error
    const said = says({ ...answer, cause: { code, text: message.split('. ')[0], remedy: 'x' } })
    assert.equal(said, message.replace(/^the/, 'The'))
  })

  it('in Korean all of it', () => {
    const said = saysIn('ko', silent('OTHER_MODE', { station: 12, found: 'RTU', mode: 'ASCII', bits: '' }))
    assert.match(said, /^국번 12.*\n가능한 원인: MODBUS RTU/)
    assert.doesNotMatch(said, /[a-z]{3,}/)
  })
})
