'use strict'
const assert = require('node:assert/strict')
const fs = require('node:fs')
const path = require('node:path')
const { PROPERTIES } = require('../../nodes/properties')
const { ROOT, TYPES } = require('./dialogs')

const text = fs.readFileSync(path.join(ROOT, 'docs', 'nodes.md'), 'utf8')
const section = type => text.split(`\n## ${type}\n`)[1].split('\n## ')[0]

describe('docs/nodes.md', () => {
  for (const type of TYPES) {
    it(`${type}: every property with its default and its choices`, () => {
      const rows = section(type)
        .split('\n')
        .filter(line => line.startsWith('| `'))
      for (const [name, { fallback, known, needed }] of Object.entries(PROPERTIES[type])) {
        const row = rows.find(line => line.split('|')[1].includes(`\`${name}\``))
        assert.ok(row, name)
        const shown = row.split('|')[2]
        const wanted = known ? `\`${fallback}\`` : Array.isArray(fallback) ? '[]' : String(fallback)
        assert.ok(needed ? shown.includes('needed') : shown.includes(wanted), `${name}: ${shown}`)
        for (const choice of known ?? []) assert.ok(row.includes(`\`${choice}\``), `${name}: ${choice}`)
      }
    })
  }
})
