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

// the words of the driver's settings in the manual of the touch panel
const PANEL = {
  protocol: 'Protocol',
  station: 'Slave Equipment Address No',
  timeout: 'TimeOut',
  sendWait: 'SendWait',
  addressMode: 'Address Mode',
  coilRead: 'Max Read Count',
  coilUnit: 'ReadBitUnit',
  coilFunction: 'Write Function',
  coilWrite: 'Max Write Count',
  discreteRead: 'Max Read Count',
  discreteUnit: 'ReadBitUnit',
  inputRead: 'Read Boundary',
  holdingRead: 'Max Read Count',
  holdingFunction: 'Write Function',
  holdingWrite: 'Max Write Count'
}

describe('every setting of the panel, by its word there', () => {
  it('docs/chino.md: each with its default', () => {
    const page = fs.readFileSync(path.join(ROOT, 'docs', 'chino.md'), 'utf8')
    const rows = page.split('\n## Settings\n')[1].split('\n## ')[0].split('\n')
    for (const [name, word] of Object.entries(PANEL)) {
      const row = rows.find(line => line.startsWith(`| \`${name}\` |`))
      assert.ok(row?.split('|')[3].includes(word), `${name}: ${row}`)
      const { fallback, needed } = PROPERTIES['chino-config'][name]
      assert.equal(row.split('|')[2].replaceAll('`', '').trim(), needed ? 'needed' : String(fallback), name)
    }
  })

  for (const language of ['en-US', 'ko']) {
    it(`the help, ${language}`, () => {
      const file = path.join(ROOT, 'nodes', 'locales', language, 'chino-config.html')
      const help = fs
        .readFileSync(file, 'utf8')
        .replaceAll(/<[^>]+>/g, '')
        .replaceAll(/\s+/g, ' ')
      // but for the first one: a word like any other, translated
      const words = Object.values(PANEL).slice(1)
      for (const word of words) assert.ok(help.includes(word), word)
    })
  }
})
