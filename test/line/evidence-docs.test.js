'use strict'

const assert = require('node:assert/strict')
const { crc16 } = require('../../lib/codec/crc16')
const { lineOf } = require('../../lib/line/evidence-text')
const { read } = require('../support/source.js')

/** What docs/diagnosis.md says of the file is what the file is like. */

const page = read('docs/diagnosis.md')
const block = page.split('test/line/evidence-docs.test.js -->\n```\n')[1].split('\n```')[0].split('\n')
const made = {
  frame: ({ t, dir, station, bytes, note }) => ({
    is: 'frame',
    row: { t: Date.parse(t), dir, station, bytes: Buffer.from(bytes, 'hex'), note }
  }),
  fault: ({ t, station, code }) => ({ is: 'fault', t: Date.parse(t), station, code })
}

describe('docs/diagnosis.md: the frames around each fault', () => {
  it('its rows are what is written', () => {
    assert.equal(block.length, 4)
    for (const line of block) {
      const row = JSON.parse(line)
      assert.equal(lineOf(made[row.is](row)), `${line}\n`)
    }
  })

  it('its frames have a good check', () => {
    const frames = block.map(line => JSON.parse(line).bytes).filter(Boolean)
    assert.equal(frames.length, 2)
    for (const bytes of frames.map(hex => Buffer.from(hex, 'hex'))) {
      assert.equal(crc16(bytes.subarray(0, -2)), bytes.readUInt16LE(bytes.length - 2))
    }
  })
})
