'use strict'

/** What docs/architecture.md names is there, and what programs can hear or count stands in it. */

const assert = require('node:assert/strict')
const lib = require('../lib')
const { Stats } = require('../lib/line/stats.js')
const sim = require('../lib/sim')
const { filesBelow, read } = require('./support/source.js')

const page = () => read('docs/architecture.md')
const names = text =>
  [...text.matchAll(/`([^`\n]+)`/g)].flatMap(([, code]) => code.match(/[A-Za-z_]\w*(?:[-\w]*\.js)?/g) ?? [])
const sources = () =>
  [...filesBelow('lib'), ...filesBelow('nodes'), ...filesBelow('test')].filter(file => file.endsWith('.js'))

describe('docs/architecture.md', () => {
  it('names files and identifiers that exist', () => {
    const files = sources()
    const text = files.map(file => `${file}\n${read(file)}`).join('\n')
    const own = new Set(['NAME', 'unreadable'])
    const wrong = names(page()).filter(name => name.length > 3 && !own.has(name.split('.')[0]) && !text.includes(name))
    assert.deepEqual(wrong, [])
  })

  it('has whatever the door offers; docs/simulator.md what that of the simulator does', () => {
    const missing = (door, text) => Object.keys(door).filter(name => !new RegExp(`\\b${name}\\b`).test(text))
    assert.deepEqual(missing(lib, page()), [])
    assert.deepEqual(missing(sim, read('docs/simulator.md')), [])
  })

  it('has a row for each event of a line, and for nothing else', () => {
    const told = sources()
      .filter(file => file.startsWith('lib/'))
      .flatMap(file => [...read(file).matchAll(/\{ event: '(\w+)'/g)].map(([, name]) => name))
    const rows = page()
      .split('\n| `event` |')[1]
      .split('\n\n')[0]
      .matchAll(/^\| `(\w+)`/gm)
    assert.deepEqual([...rows].map(([, name]) => name).sort(), told.sort())
  })

  it('has every counter of a line', () => {
    const counters = page().split('`stats()`: ')[1].split('\n\n')[0]
    for (const name of Object.keys(new Stats().snapshot())) assert.ok(counters.includes(`\`${name}\``), name)
  })
})
