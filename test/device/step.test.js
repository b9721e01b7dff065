'use strict'

const assert = require('node:assert/strict')
const { PlcError } = require('../../lib')
const { checkSteps } = require('../../lib/device/step')
const { nxNotation } = require('../../lib/tag/nx-notation')
const { parseItem } = require('../../lib/tag/item')

/** What is read to compare a step, without a line: a joint read that is refused is asked for in parts. */
describe('largest step: reading', () => {
  const notation = nxNotation({
    tags: ['K0', 'K2', 'K4', 'K6'].map(address => ({ name: `t${address}`, address, maxStep: 5 }))
  })
  const steps = ['tK0', 'tK2', 'tK4', 'tK6'].map((name, at) => {
    const item = parseItem(name, notation)
    return {
      item,
      point: { kind: /** @type {'word'} */ ('word'), address: 2 * at, count: 1, text: name },
      raw: [10 * at + 5],
      text: name
    }
  })
  const refusal = code => new PlcError(code, { station: 1, address: '?' })
  /** All points in one request. */
  const joint = points => [
    { ask: 'readWords', addresses: points, points: points.map((_, at) => ({ point: at, at, count: 1 })) }
  ]
  const run = (plan, held) => {
    const asked = []
    const ask = function* ({ addresses }) {
      return yield addresses
    }
    const whole = { splits: new Set(['PLC_OUT_OF_RANGE']), simpler: () => false, reads: joint, ...plan }
    const dialog = checkSteps(steps, { plan: whole, ask })
    let next = dialog.next()
    while (!next.done) {
      asked.push(next.value.map(({ address }) => address))
      let answer
      try {
        answer = held(next.value)
      } catch (error) {
        next = dialog.throw(error)
        continue
      }
      next = dialog.next(answer)
    }
    return asked
  }
  const values = addresses => addresses.map(({ address }) => address * 5)

  it('in one request where that goes', () => {
    assert.deepEqual(run({}, values), [[0, 2, 4, 6]])
  })

  it('in halves where what lies between is refused', () => {
    const held = addresses => {
      if (addresses.length > 1) throw refusal('PLC_OUT_OF_RANGE')
      return values(addresses)
    }
    assert.deepEqual(run({}, held), [[0, 2, 4, 6], [0, 2], [0], [2], [4, 6], [4], [6]])
  })

  it('in the way that the station knows', () => {
    let simple = false
    const simpler = () => !simple && (simple = true)
    const reads = points =>
      simple
        ? points.flatMap((point, at) =>
            joint([point]).map(each => ({ ...each, points: [{ point: at, at: 0, count: 1 }] }))
          )
        : joint(points)
    const held = addresses => {
      if (!simple) throw refusal('PLC_WRONG_FUNCTION')
      return values(addresses)
    }
    assert.deepEqual(run({ simpler, reads }, held), [[0, 2, 4, 6], [0], [2], [4], [6]])
  })

  it('ends with the refusal of the one that stands alone, and with any other failure at once', () => {
    const missing = addresses => {
      if (addresses.some(({ address }) => address === 4)) throw refusal('PLC_OUT_OF_RANGE')
      return values(addresses)
    }
    assert.throws(() => run({}, missing), { code: 'PLC_OUT_OF_RANGE' })
    let count = 0
    const silent = () => {
      count++
      throw new PlcError('TIMEOUT', { station: 1, timeout: 100 })
    }
    assert.throws(() => run({}, silent), { code: 'TIMEOUT' })
    assert.equal(count, 1)
  })

  it('each is compared with its own', () => {
    const moved = addresses => addresses.map(({ address }) => (address === 4 ? 31 : address * 5))
    assert.throws(
      () => run({}, moved),
      error => error.code === 'STEP_TOO_LARGE' && error.details.item === 'tK4'
    )
  })
})
