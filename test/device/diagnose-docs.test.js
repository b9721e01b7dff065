'use strict'

/** docs/diagnosis.md: its lists are complete, and its program runs as it stands there. */

const assert = require('node:assert/strict')
const { CAUSES } = require('../../lib/device/diagnosis/causes')
const { ROWS } = require('../../lib/device/diagnosis/sheet')
const { createLine, serveOnTcp } = require('../../lib/sim')
const { read } = require('../support/source')

const page = () => read('docs/diagnosis.md')

describe('docs/diagnosis.md', () => {
  it('has a heading for each cause, and for nothing else', () => {
    const section = page().split('\n## The causes\n')[1]
    assert.deepEqual(
      [...section.matchAll(/^### (\w+)$/gm)].map(([, code]) => code),
      Object.keys(CAUSES)
    )
  })

  it('has each row of the sheet, in its order', () => {
    const section = page().split('\n## The sheet\n')[1].split('\n### ')[0]
    const ids = [...section.matchAll(/^\| (`[^|]*`) \|/gm)].flatMap(([, cell]) => cell.match(/\w+/g))
    assert.deepEqual(ids, [...ROWS.map(({ id }) => id), 'latencyTimer'])
  })

  it('the rows that a cause makes wrong are rows', () => {
    const ids = ROWS.map(({ id }) => id)
    for (const [code, [, , wrong]] of Object.entries(CAUSES)) for (const id of wrong) assert.ok(ids.includes(id), code)
  })

  it('its program works', async () => {
    const [, text] = /diagnose-docs\.test\.js as it stands here -->\n```js\n([\s\S]*?)```/.exec(page())
    const { wire } = createLine({ stations: [{ device: 'chino', station: 11 }], quiet: true })
    const server = await serveOnTcp({ wire })
    const printed = []
    const door = () => require('../..')
    const log = (...words) => printed.push(words.join(' '))
    const AsyncFunction = (async () => {}).constructor
    const place = `host: '127.0.0.1', port: ${server.port}, latenessBound: 1`
    try {
      const program = text.replace("path: '/dev/ttyUSB0'", place)
      await AsyncFunction('require', 'console', program)(door, { log })
    } finally {
      await server.close()
    }
    assert.match(printed[0], /^hr0 = 0 after \d+ ms$/)
    assert.equal(printed.length, 1 + ROWS.length)
  })
})
