'use strict'

const assert = require('node:assert/strict')
const { Flow, flowDifference, flowOptions } = require('../../lib/line/flow')
const { createLateClock } = require('./support/late-clock')

const [DC1, DC3, DLE] = [0x11, 0x13, 0x10]
const LINE = { flowControl: 'none', baudRate: 9600 }

const create = (options = {}, settings = LINE) => {
  const clock = createLateClock()
  return { clock, flow: new Flow(flowOptions({ flow: 'dc', ...options }), { clock, settings }) }
}
/** What is left of bytes that came, and how often the other side said stop. */
const taken = (flow, ...bytes) => {
  const { bytes: left, stops } = flow.take(Buffer.from(bytes))
  return [[...left], stops]
}

describe('line: how messages flow', () => {
  it('options have defaults and bounds', () => {
    assert.deepEqual(flowOptions(), {
      flow: 'none',
      transparent: null,
      room: 64,
      latency: 16,
      stallLimit: 30000,
      torn: { wait: 0, first: null, apart: false }
    })
    const most = { flow: 'dc', transparent: 255, room: 1000000, latency: 3600000, stallLimit: 3600000 }
    const torn = { wait: 3600000, first: Buffer.from('\r'), apart: true }
    assert.deepEqual(flowOptions({ ...most, torn }), { ...most, torn })
    const least = { flow: 'dc', transparent: 0, room: 1, latency: 0, stallLimit: 1 }
    const none = flowOptions({ ...least, torn: { first: Buffer.alloc(0), apart: /** @type {any} */ (1) } })
    assert.deepEqual(none, { ...least, torn: { wait: 0, first: null, apart: false } })
    const wrong = /** @type {[any, string, string][]} */ ([
      [{ flow: 'x' }, 'flow', 'known are none, dc'],
      [{ transparent: DC1 }, 'transparent', 'DC1 and DC3'],
      [{ transparent: DC3 }, 'transparent', 'DC1 and DC3'],
      [{ transparent: 256 }, 'transparent', 'allowed is 0 to 255'],
      [{ room: 1000001 }, 'room', 'allowed is 1 to 1000000'],
      [{ latency: 3600001 }, 'latency', 'allowed is 0 to 3600000'],
      [{ stallLimit: 0 }, 'stallLimit', 'allowed is 1 to 3600000']
    ])
    for (const [options, setting, text] of wrong) {
      assert.throws(
        () => flowOptions(options),
        ({ code, details, message }) => code === 'BAD_SETTING' && details.setting === setting && message.includes(text)
      )
    }
  })

  it('two ways of using a line differ by their first option', () => {
    const difference = (one, other) => flowDifference(flowOptions(one), flowOptions(other))
    const first = Buffer.from('\r\n')
    assert.equal(difference({ torn: { first } }, { torn: { first: Buffer.from('\r\n') } }), '')
    assert.equal(difference({ torn: { first } }, {}), 'torn.first 0d0a and ')
    assert.equal(difference({ torn: { apart: true } }, {}), 'torn.apart true and false')
    assert.equal(difference({ room: 9 }, { latency: 1 }), 'room 9 and 64')
  })

  it('a piece is what the room leaves, and needs one byte, or a code and its byte', () => {
    const pieceOf = (options, settings) => create(options, settings).flow.pieceEnd(Buffer.alloc(99), 10) - 10
    // 64 - 2 - 0.96 x 16
    assert.equal(pieceOf({}), 46)
    assert.equal(pieceOf({ room: 19 }), 1)
    assert.equal(pieceOf({ room: 20, transparent: DLE }), 2)
    assert.equal(pieceOf({}, { ...LINE, flowControl: 'rtscts' }), 89)
    for (const options of [{ room: 18 }, { room: 19, transparent: DLE }]) {
      assert.throws(() => create(options), { code: 'BAD_SETTING', message: /room.*at 9600 bit\/s 16 ms pass/ })
    }
  })

  it('no piece ends between a code and its byte; a code without one goes out, too', () => {
    const { flow } = create({ room: 22, transparent: DLE })
    const ends = bytes => {
      const all = [0]
      while (all[all.length - 1] < bytes.length) all.push(flow.pieceEnd(Buffer.from(bytes), all[all.length - 1]))
      return all.slice(1)
    }
    assert.deepEqual(ends([DLE, 1, DLE, 2, DLE, 3]), [4, 6])
    assert.deepEqual(ends([0, DLE, 1, DLE, 2, 0, 0]), [3, 7])
    assert.deepEqual(ends([0, DLE]), [2])
  })

  it('stops and goes are taken out and counted, the time of the first stop is kept', () => {
    const { clock, flow } = create({ transparent: DLE })
    clock.wake(5)
    assert.deepEqual(taken(flow, 1, DC1, 2), [[1, 2], 0])
    assert.deepEqual([taken(flow, DC3), flow.stoppedAt, flow.stopped], [[[], 1], 5, true])
    clock.wake(9)
    assert.deepEqual([taken(flow, DC3, DC3), flow.stoppedAt], [[[], 2], 5])
    assert.deepEqual([taken(flow, DC1), flow.stopped], [[[], 0], false])
    assert.deepEqual(taken(flow, DLE, DC3, DLE), [[DLE, DC3, DLE], 0])
    flow.reset()
    assert.deepEqual([taken(flow, DC3), flow.stopped], [[[], 1], true])
    flow.reset()
    assert.equal(flow.stopped, false)
  })
})
