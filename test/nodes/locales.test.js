'use strict'
const assert = require('node:assert/strict')
const fs = require('node:fs')
const path = require('node:path')
const { CAUSES } = require('../../lib/device/diagnosis/causes')
const { CODES } = require('../../lib/error')
const { statusOf } = require('../../nodes/status')
const { LANGUAGES, NODES, ROOT, TYPES, catalogue, html, loadDialogs, lookUp } = require('./dialogs')

const ON_TABS = ['nx-read', 'nx-write', 'chino-regulator', 'melsec-c24', 'incon-link', 'plc-monitor']

const leaves = (tree, prefix = '') =>
  Object.entries(tree).flatMap(([key, value]) =>
    typeof value === 'string' ? [prefix + key] : leaves(value, `${prefix}${key}.`)
  )

const sources = folder =>
  fs
    .readdirSync(path.join(ROOT, folder))
    .filter(name => name.endsWith('.js'))
    .map(name => fs.readFileSync(path.join(ROOT, folder, name), 'utf8'))
    .join('\n')

const quoted = (text, pattern) => [...text.matchAll(pattern)].map(([, found]) => found)

/** Keys of the node's own dialog. */
const ownKeys = type => [
  ...quoted(html(type), /data-i18n="(?:\[\w+\])?([^"]+)"/g),
  ...quoted(html(type), /_\(\s*'([\w-]+\.[\w.]+)'/g),
  ...quoted(html(type), /'((?:nx-write|chino-regulator|melsec-c24|incon-link|plc-monitor)\.port\.\w+)'/g)
]

/** Keys of what the dialogs share. */
const sharedKeys = () => {
  const editor = sources('scripts/editor')
  const columns = quoted(editor, /\b(?:cell|pick|tick)\('(\w+)'/g)
  const problems = quoted(sources('nodes'), /problem: '(\w+)'/g)
  return [
    ...quoted(editor, /'((?:tab|editor|problem|template|test)\.\w+)'/g),
    ...columns.flatMap(name => [`column.${name}`, `tooltip.${name}`]),
    ...problems.map(name => `problem.${name}`)
  ]
}

/** Every status that there can be. */
const statusKeys = () => {
  const codes = [undefined, ...Object.keys(CODES)]
  const states = [
    {},
    { phase: 'writing' },
    { phase: 'read', count: 1 },
    { phase: 'read', count: 3 },
    { phase: 'read', count: 3, bad: 1 },
    { phase: 'read', count: 3, bad: 3, code: 'TIMEOUT', advice: 1700 },
    ...codes.flatMap(code => [
      { fault: { code } },
      { phase: 'read', count: 2, bad: 2, code },
      { phase: 'failed', code },
      { line: { state: 'waiting', reason: { code } } },
      ...['confirmed', 'unknown', 'refused', 'failed'].map(outcome => ({ phase: 'written', outcome, code }))
    ]),
    { phase: 'listening' },
    { phase: 'sending' },
    { phase: 'received', received: 3, complete: true },
    { phase: 'received', received: 3, complete: false },
    ...[undefined, 'SENDING_OFF', 'WRITE_STALLED'].flatMap(code =>
      ['sent', 'confirmed', 'unknown', 'refused', 'failed'].map(outcome => ({ phase: 'sent', outcome, code }))
    ),
    ...['opening', 'jammed', 'waiting'].map(state => ({ line: { state } })),
    { phase: 'watching' },
    { phase: 'watching', line: { state: 'open' } },
    { phase: 'watching', line: { state: 'open' }, demoted: 2 }
  ]
  return states.map(state => `status.${statusOf(state).key}`)
}

describe('locales', () => {
  for (const type of TYPES) {
    for (const language of LANGUAGES) {
      it(`${type}, ${language}: every key that is used is there, and every key that is there is used`, () => {
        const used = type === 'plc-line' ? [...ownKeys(type), ...sharedKeys(), ...statusKeys()] : ownKeys(type)
        const known = leaves(catalogue(language, type)).filter(key => !/^(error|why|cause)\./.test(key))
        assert.deepEqual([...new Set(used)].sort(), known.sort())
      })

      it(`${type}, ${language}: help with its sections`, () => {
        const help = fs.readFileSync(path.join(NODES, 'locales', language, `${type}.html`), 'utf8')
        assert.match(help, new RegExp(`data-help-name="${type}"`))
        assert.match(help, />\s*<p>[^<]{20,}/, 'the first paragraph is the tooltip')
        const wanted = ON_TABS.includes(type) ? 4 : 2
        assert.equal([...help.matchAll(/<h3>/g)].length, wanted)
      })
    }

    it(`${type}: both languages fill in the same values`, () => {
      const [english, korean] = LANGUAGES.map(language => catalogue(language, type))
      const marks = text => [...text.matchAll(/__\w+__/g)].map(String).sort()
      for (const key of leaves(english)) {
        // a message says its number only where the language needs it
        assert.deepEqual(marks(lookUp(korean, key)), marks(lookUp(english, key)), key)
      }
    })
  }

  it('errors in Korean have a row in the list of codes, and use its details', () => {
    const { error = {} } = catalogue('ko', 'plc-line')
    for (const [code, text] of Object.entries(error).filter(([key]) => !key.endsWith('_MODBUS'))) {
      assert.ok(CODES[code], code)
      for (const [, name] of text.matchAll(/__(\w+)__/g))
        assert.match(CODES[code].join(' '), new RegExp(`\\{${name}\\}`), code)
    }
  })

  it('each likely cause is there in Korean, and uses its details', () => {
    const { cause } = catalogue('ko', 'plc-line')
    assert.deepEqual(Object.keys(cause).sort(), Object.keys(CAUSES).sort())
    for (const [code, text] of Object.entries(cause)) {
      for (const [, name] of text.matchAll(/__(\w+)__/g)) {
        assert.match(CAUSES[code].flat().join(' '), new RegExp(`\\{${name}\\}`), code)
      }
    }
  })

  const wrongAddresses = {
    empty: '',
    backwards: '400002..400001',
    form: 'M0',
    digits: '4000011',
    zeroLost: '1001',
    firstDigit: '201001',
    bitOfBit: '001001.05',
    bitDigits: '401001.1',
    outside: '465537'
  }
  for (const [why, address] of Object.entries(wrongAddresses)) {
    it(`a wrong address of a regulator is explained in the language, without the notation of PLCs: ${why}`, () => {
      const said = LANGUAGES.map(language => {
        const { types } = loadDialogs({ language })
        const { validate } = types['chino-config'].defaults.writableRanges
        return validate.call({ id: 'z' }, address || '..')
      })
      for (const text of said) assert.doesNotMatch(text, /M0\.\.|K127|__/)
      if (address) assert.doesNotMatch(said[1].replaceAll(address, ''), /[a-z]{4,}(?!32|\d)\b/, said[1])
    })
  }

  it('no reason in Korean is too many', () => {
    const { why } = catalogue('ko', 'plc-line')
    assert.deepEqual(
      Object.keys(why).sort(),
      Object.keys(wrongAddresses)
        .filter(key => key !== 'outside')
        .sort()
    )
  })

  it('a status is shorter than 20 characters in both languages, with SIM before it', () => {
    const { fitted } = require('../../nodes/status')
    for (const language of LANGUAGES) {
      for (const [key, text] of Object.entries(catalogue(language, 'plc-line').status)) {
        const filled = text.replace(/__\w+__/g, '12')
        assert.ok(filled.length < 20, `${language} ${key}: ${filled}`)
        assert.ok(fitted(filled, true).length < 20)
      }
    }
  })
})
