'use strict'

/** The list of codes is closed: the table, its page and the uses agree. */

const assert = require('node:assert/strict')
const { CODES, PlcError } = require('../lib/error.js')
const { filesBelow, read, strings } = require('./support/source.js')

const page = () => read('docs/errors.md')
const codes = Object.keys(CODES)

/** Codes as the sources name them: `PlcError('CODE'` and any string that is exactly a code. */
function uses() {
  const files = [...filesBelow('lib'), ...filesBelow('nodes')].filter(
    name => name.endsWith('.js') && name !== 'lib/error.js'
  )
  const found = new Set()
  const unknown = []
  for (const file of files) {
    for (const text of strings(file)) if (codes.includes(text)) found.add(text)
    for (const [, code] of read(file).matchAll(/PlcError\(\s*'(\w+)'/g))
      if (!CODES[code]) unknown.push(`${file}: ${code}`)
  }
  return { found, unknown }
}

describe('error codes', () => {
  /** @type {ReturnType<typeof uses>} */
  let used
  before(() => {
    used = uses()
  })

  it('docs/errors.md has a heading for each code, and for nothing else', () => {
    const headings = [...page().matchAll(/^### (.+)$/gm)].map(([, text]) => text.trim())
    assert.deepEqual(headings.toSorted(), codes.toSorted())
  })

  it('each of them says what it means, what may be the cause and what to do', () => {
    for (const section of page().split(/^### /m).slice(1)) {
      const [code] = section.split('\n')
      for (const part of ['**Means**', '**Causes**', '**Do**']) assert.ok(section.includes(part), `${code}: ${part}`)
    }
  })

  it('the sources use no code that is not in the list', () => assert.deepEqual(used.unknown, []))

  it('each code is used', () => {
    assert.deepEqual(
      codes.filter(code => !used.found.has(code)),
      []
    )
  })

  it('each text is a sentence with a remedy, and its placeholders are filled', () => {
    for (const [code, row] of Object.entries(CODES)) {
      assert.equal(row.length, 2, code)
      const names = row.flatMap(text => [...text.matchAll(/\{(\w+)\}/g)].map(([, name]) => name))
      const details = Object.fromEntries(names.map(name => [name, `<${name}>`]))
      const error = new PlcError(/** @type {any} */ (code), details)
      assert.equal(error.code, code)
      assert.ok(Object.hasOwn(error, 'code'))
      assert.doesNotMatch(error.message, /\{\w+\}|undefined/)
      for (const name of names) assert.ok(error.message.includes(`<${name}>`), `${code} ${name}`)
      assert.match(error.remedy, /\.$/, `${code}: the remedy ends with a full stop`)
    }
  })

  it('a code that is not in the list cannot be thrown', () => {
    assert.throws(() => new PlcError(/** @type {any} */ ('NO_SUCH_CODE')), TypeError)
  })
})
