'use strict'

/** Our requests beside those of modbus-serial, which knows nothing of ours. */

const assert = require('node:assert/strict')
const { EventEmitter } = require('node:events')
const fc = require('fast-check')
const ModbusRTU = require('modbus-serial')
const { encodeQuery } = require('../../../lib/codec/modbus/query')
const { toAscii } = require('../../../lib/codec/modbus/ascii')
const { show } = require('../support/oracle')

/** A port that keeps what is written to it. */
class Paper extends EventEmitter {
  isOpen = true
  /** @type {Buffer[]} */
  pages = []
  open(done) {
    done()
  }
  write(bytes) {
    this.pages.push(Buffer.from(bytes))
  }
}

const CALLS = {
  1: ['writeFC1', ({ base, count }) => [base, count]],
  2: ['writeFC2', ({ base, count }) => [base, count]],
  3: ['writeFC3', ({ base, count }) => [base, count]],
  4: ['writeFC4', ({ base, count }) => [base, count]],
  5: ['writeFC5', ({ base, value }) => [base, value]],
  6: ['writeFC6', ({ base, value }) => [base, value]],
  15: ['writeFC15', ({ base, values }) => [base, values]],
  16: ['writeFC16', ({ base, values }) => [base, values]]
}

function theirs(query, station) {
  const paper = new Paper()
  const client = new ModbusRTU(/** @type {any} */ (paper))
  client.open(() => {})
  const [name, args] = CALLS[query.fn]
  client[name](station, ...args(query), () => {})
  assert.equal(paper.pages.length, 1)
  return paper.pages[0]
}

const station = fc.integer({ min: 1, max: 247 })
const base = fc.nat(0xffff - 2000)
const block = (fn, most) => fc.record({ fn: fc.constant(fn), base, count: fc.integer({ min: 1, max: most }) })
const several = (fn, value, most) =>
  fc.record({ fn: fc.constant(fn), base, values: fc.array(value, { minLength: 1, maxLength: most }) })

const QUERIES = {
  1: block(1, 2000),
  2: block(2, 2000),
  3: block(3, 125),
  4: block(4, 125),
  5: fc.record({ fn: fc.constant(5), base, value: fc.boolean() }),
  6: fc.record({ fn: fc.constant(6), base, value: fc.nat(0xffff) }),
  15: several(15, fc.boolean(), 1968),
  16: several(16, fc.nat(0xffff), 123)
}

describe('MODBUS requests beside modbus-serial', () => {
  for (const [fn, queries] of Object.entries(QUERIES)) {
    it(`function ${fn}: the same bytes`, () => {
      fc.assert(
        fc.property(queries, station, (query, to) => {
          assert.equal(show(encodeQuery(query, to)), show(theirs(query, to)))
        })
      )
    })
  }

  it('ASCII as its own buffered port writes it', () => {
    // its encoder is not exported: the frame of its documentation, :010300000001 with LRC FB
    assert.equal(toAscii(theirs({ fn: 3, base: 0, count: 1 }, 1)).toString('latin1'), ':010300000001FB\r\n')
  })
})
